"""Properties to core objects and back; the only place that knows both.

What was built from equal properties is kept, so that a frame costs no more than its own attractor.
"""

import hashlib
from functools import lru_cache

import numpy as np

from ..core.affine import from_parameters, to_parameters
from ..core.connectedness import Connectedness, connectedness
from ..core.ifs import IFS, Contractivity, IFSError
from ..core.matching import Pair, morph_of_pairs
from ..core.morph import SCHEMES, Morph, spread
from ..core.raster import fit_window as fitted_window
from ..core.shading import attractorlet_colors
from ..core.space.ifs import SpaceIFS
from ..core.space.lifting import FLIPS, in_one_space, morph_between
from . import fcurves, pairs, preparation

FIT_SAMPLES = 33
"""Places along the path whose attractors the window must hold."""

BOX_MARGIN = 0.05
"""Room on each side of a shape in space, relative to the longest side of its box."""

NORM_SAMPLES = 129
"""Places along the path that the norms of the maps are taken over."""

MOST_RECURRENT = 32
"""Maps of a recurrent shape at most: the longest row of numbers that a property of Blender holds."""


NO_PICTURE = "A shape in space has no picture: show it as a point cloud (Add > IFS Morph > Point Cloud)."


def identifier(name: str) -> str:
    """Blender's identifier of an enumeration item that core knows by a lower-case name."""
    return name.upper().replace("-", "_").replace(" ", "_")


def core_name(item: str, names: tuple[str, ...]) -> str:
    """Core's name of an enumeration item: the inverse of `identifier`."""
    return next(name for name in names if identifier(name) == item)


def shape_maps(shape) -> np.ndarray:
    """Maps (N, 2, 3) of a shape, or (N, 3, 4) of one in space."""
    stored, rows, columns = ("matrix_in_space", 3, 4) if shape.in_space else ("matrix", 2, 3)
    flat = np.empty(rows * columns * len(shape.maps), dtype=np.float32)
    shape.maps.foreach_get(stored, flat)
    return flat.reshape(-1, rows, columns).astype(float)


def shape_colors(shape) -> np.ndarray:
    """Colors (N, 3) of a shape's maps."""
    flat = np.empty(3 * len(shape.maps), dtype=np.float32)
    shape.maps.foreach_get("color", flat)
    return flat.reshape(-1, 3)


def frame_colors(settings) -> np.ndarray:
    """Color and alpha (N, 4) of each attractorlet at the settings' u, between those of the two shapes.

    Raises
    ------
    IFSError
        If there is no morph.
    """
    start, end = shape_colors(settings.initial), shape_colors(settings.final)
    if has_pairs(settings):
        # A piece has the color of the map that it is a part of.
        paired = current_pairs(settings)
        start, end = start[[pair.initial[0] for pair in paired]], end[[pair.final[0] for pair in paired]]
    share = np.float32(min(max(settings.uv[0], 0.0), 1.0))
    colors = np.ones((len(start), 4), dtype=np.float32)
    # Colors that both shapes share stay the same to the bit, so that nothing is written anew for them.
    colors[:, :3] = np.where(start == end, start, (1 - share) * start + share * end)
    return colors[morph_of(settings).part_of]


def shape_ifs(shape) -> IFS:
    """A shape as an IFS; raises IFSError."""
    weights = np.empty(len(shape.maps), dtype=np.float32)
    shape.maps.foreach_get("weight", weights)
    transitions = shape_transitions(shape)
    chances = None if transitions is None else transitions.tobytes()
    opacity = shape_opacity(shape).tobytes()
    return _ifs(shape_maps(shape).tobytes(), weights.tobytes(), shape.name, chances, opacity, shape.in_space)


def shape_opacity(shape) -> np.ndarray:
    """Opacities (N,) of a shape's maps."""
    opacity = np.empty(len(shape.maps), dtype=np.float32)
    shape.maps.foreach_get("opacity", opacity)
    return opacity.astype(float)


def shape_transitions(shape) -> np.ndarray | None:
    """Transitions (N, N) of a recurrent shape, None of a plain one; raises IFSError."""
    count = len(shape.maps)
    if not shape.recurrent or shape.in_space:
        return None
    if count > MOST_RECURRENT:
        raise IFSError(
            f"The shape has {count} maps, and a recurrent one {MOST_RECURRENT} at most; "
            "remove some or turn Recurrent off."
        )
    flat = np.empty(MOST_RECURRENT * count, dtype=np.float32)
    shape.maps.foreach_get("transitions", flat)
    return flat.reshape(-1, MOST_RECURRENT)[:, :count].astype(float)


@lru_cache(maxsize=64)
def _ifs(maps: bytes, weights: bytes, name: str, transitions: bytes | None, opacity: bytes, in_space: bool) -> IFS:
    weights = np.frombuffer(weights, dtype=np.float32).astype(float)
    if transitions is not None:
        transitions = np.frombuffer(transitions).reshape(len(weights), -1)
    kind, rows = (SpaceIFS, 3) if in_space else (IFS, 2)
    opacity = np.frombuffer(opacity)
    ifs = kind(np.frombuffer(maps).reshape(-1, rows, rows + 1), None, name, transitions, opacity)
    if not weights.any():
        return ifs
    # A weight of zero stands for the share that the map has by default.
    return kind(ifs.maps, np.where(weights == 0, ifs.weights, weights), name, transitions, opacity)


def morph_of(settings) -> Morph:
    """The morph between an object's two shapes, made of its pairs if it has any; raises IFSError."""
    initial, final = shapes_of(settings)
    if has_pairs(settings):
        return _paired_morph(initial, final, settings.scheme, current_pairs(settings), flip_of(settings))
    if initial.count != final.count:
        raise IFSError(
            f"The initial shape has {initial.count} maps and the final one {final.count}; press Morph to pair them. "
            "Without pairs both must have as many."
        )
    winding = np.zeros(final.count, dtype=np.int32)
    settings.final.maps.foreach_get("winding", winding)
    return _morph(initial, final, settings.scheme, winding.tobytes(), flip_of(settings))


def shapes_of(settings) -> tuple[IFS, IFS]:
    """The two shapes of an object, one of the plane put into space beside one of space; raises IFSError."""
    return _in_one_space(shape_ifs(settings.initial), shape_ifs(settings.final))


@lru_cache(maxsize=16)
def _in_one_space(initial: IFS, final: IFS) -> tuple[IFS, IFS]:
    return in_one_space(initial, final)


def flip_of(settings) -> str:
    """What becomes of a map that reflects at one end only: among points the user's choice, a picture has no height."""
    return core_name(settings.flip, FLIPS) if settings.kind == "POINTS" else "projected"


@lru_cache(maxsize=16)
def _morph(initial: IFS, final: IFS, scheme: str, winding: bytes, flip: str) -> Morph:
    return morph_between(initial, final, core_name(scheme, SCHEMES), np.frombuffer(winding, dtype=np.int32), flip)


@lru_cache(maxsize=16)
def _paired_morph(initial: IFS, final: IFS, scheme: str, paired: tuple[Pair, ...], flip: str) -> Morph:
    return morph_of_pairs(initial, final, paired, core_name(scheme, SCHEMES), flip)


def frame_of(settings, morph: Morph) -> IFS:
    """The IFS of a morph at the settings' (u,v), swell and offsets."""
    return morph.at(*spread(fcurves.place_of(settings), morph.count))


def is_in_space(settings) -> bool:
    """Whether one of an object's shapes lies in space."""
    return settings.initial.in_space or settings.final.in_space


def has_pairs(settings) -> bool:
    """Whether an object's maps are paired otherwise than map k with map k."""
    return len(settings.matching.pairs) > 0


def current_pairs(settings) -> tuple[Pair, ...]:
    """The pairs that an object's morph is made of: those stored, or map k with map k where they do not fit.

    Raises
    ------
    IFSError
        If a shape is none.
    """
    initial, final = shapes_of(settings)
    found = pairs.fitted(initial, final, settings.matching) if has_pairs(settings) else None
    return found or pairs.in_order(initial, final)


def pairs_problem(settings) -> str:
    """What is wrong with an object's pairs, in a few sentences; empty if nothing is."""
    try:
        initial, final = shapes_of(settings)
    except IFSError:
        return ""  # Said of the shapes.
    problem = pairs.problem(initial, final, settings.matching) if has_pairs(settings) else ""
    return f"{pairs.UNFIT} {problem}" if problem else ""


def state_sentence(settings) -> str:
    """Whether the attractor at the settings' (u,v) and swell is in one piece, in one sentence."""
    if preparation.is_running():
        return preparation.message()
    try:
        return _state_sentence(morph_of(settings), tuple(fcurves.place_of(settings)), tolerance(settings))
    except IFSError as error:
        return str(error)


@lru_cache(maxsize=256)
def _state_sentence(morph: Morph, place: tuple[float, ...], tolerance: float) -> str:
    verdict = connectedness(morph.at(*spread(place, morph.count)), tolerance)
    if verdict.state == Connectedness.CONNECTED:
        return "Here the shape is in one piece."
    if verdict.state == Connectedness.DISCONNECTED:
        return f"Here the shape is in pieces; the gap is {100 * verdict.gap[0]:.2g} % of its size."
    if verdict.state == Connectedness.UNDECIDED:
        return "Here it could not be decided whether the shape is in one piece."
    return "Here there is no shape: the maps do not shrink enough."


def tolerance(settings) -> float:
    """Gaps below this share of the attractor's enclosing diameter count as none."""
    return 1 / settings.gap_resolution


def pixel(settings) -> float | None:
    """Length in the plane of the side of a pixel of an object's image; None if it has none."""
    if settings.kind != "IMAGE":
        return None
    left, _, right, _ = settings.output.window
    return max(right - left, 1e-12) / settings.output.resolution[0]


def fingerprint(settings, *more) -> str:
    """Short text that changes with the morph, the tolerance and `more`; tells whether a result is out of date."""
    digest = hashlib.sha1(usedforsecurity=False)
    for shape in (settings.initial, settings.final):
        digest.update(shape_maps(shape).tobytes())
        if shape.recurrent:
            digest.update(repr([tuple(item.transitions) for item in shape.maps]).encode())
        hidden = shape_opacity(shape) == 0
        if hidden.any():
            digest.update(hidden.tobytes())
    winding = [item.winding for item in settings.final.maps]
    digest.update(repr((settings.scheme, winding, settings.gap_resolution, more)).encode())
    if has_pairs(settings):
        digest.update(repr((pairs.plain(settings.matching), flip_of(settings))).encode())
    return digest.hexdigest()[:16]


def locus_fingerprint(settings) -> str:
    """Fingerprint of what the locus depends on."""
    return fingerprint(settings, settings.locus.resolution, tuple(settings.locus.domain))


def path_fingerprint(settings) -> str:
    """Fingerprint of what the report on a path depends on."""
    frames = range(settings.path.frame_start, settings.path.frame_end + 1)
    return fingerprint(settings, fcurves.sample_path(settings.id_data, frames).tolist())


def write_shape(shape, ifs: IFS) -> None:
    """Fill a shape with the maps of an IFS, its weights left to the areas of the maps where they are just that.

    Raises
    ------
    IFSError
        If the shape has more maps and will not let go of them: a library override keeps those of its library; or if
        the IFS is recurrent with more than `MOST_RECURRENT` maps, or lies in space while the object shows a picture.
    """
    if ifs.transitions is not None and ifs.count > MOST_RECURRENT:
        raise IFSError(
            f"The IFS “{ifs.name}” is recurrent and has {ifs.count} maps; an object can hold {MOST_RECURRENT} of such."
        )
    if ifs.DIMENSION == 3 and shape.id_data.ifs_morph.kind == "IMAGE":
        raise IFSError(NO_PICTURE)
    maps = shape.maps
    _resize(maps, ifs.count)
    by_area = np.allclose(type(ifs)(ifs.maps).weights, ifs.weights)
    for k, (item, color) in enumerate(zip(maps, attractorlet_colors(ifs.count), strict=True)):
        item.name = f"Map {k + 1}"
        item.color = color[:3]
        item.weight = 0.0 if by_area else float(ifs.weights[k])
        item.opacity = ifs.opacity[k]
        item.winding = 0
    shape.in_space = ifs.DIMENSION == 3
    maps.foreach_set("matrix_in_space" if shape.in_space else "matrix", ifs.maps.astype(np.float32).ravel())
    transitions = np.ones((ifs.count, MOST_RECURRENT), dtype=np.float32)
    shape.recurrent = ifs.transitions is not None
    if shape.recurrent:
        transitions[:, : ifs.count] = ifs.transitions
    maps.foreach_set("transitions", transitions.ravel())
    shape.name = ifs.name
    shape.active_index = 0


def _resize(maps, count: int) -> None:
    while len(maps) > count:
        try:
            # Those of a library come first in an override, so that this fails before any is gone.
            maps.remove(count)
        except TypeError as error:
            raise IFSError(
                f"This library override has {len(maps)} maps from its library and cannot have {count}; "
                "make the object local first."
            ) from error
    while len(maps) < count:
        maps.add()


def map_parameters(item) -> np.ndarray:
    """Rotation, scale x, scale y, shear, and the two of the translation of one map."""
    return to_parameters(np.array(item.matrix))


def set_map_parameters(item, parameters) -> None:
    """Set a map's matrix from the numbers of `map_parameters`."""
    item.matrix = from_parameters(parameters)


def edited_shape(owner):
    """Shape whose maps are edited in the viewport."""
    settings = owner.ifs_morph
    return settings.initial if settings.edited_end == "INITIAL" else settings.final


def path_samples(owner, count: int = FIT_SAMPLES) -> np.ndarray:
    """Places, see `core.morph.spread`, along the keyed path, or along the straight one where none is keyed."""
    if fcurves.has_path(owner):
        frames = fcurves.key_frames(owner)
        return fcurves.sample_path(owner, np.linspace(frames[0], frames[-1], count))
    along = np.linspace(0, 1, count)
    return np.stack([along, along, 0 * along], axis=1)


def path_norms(owner, morph: Morph) -> np.ndarray:
    """Largest norm (N,) of each map along the path: what the renderer cuts by, so that no frame is cut differently."""
    samples = path_samples(owner, NORM_SAMPLES)
    return _path_norms(morph, samples.tobytes(), samples.shape[1])


@lru_cache(maxsize=16)
def _path_norms(morph: Morph, samples: bytes, width: int) -> np.ndarray:
    places = np.frombuffer(samples).reshape(-1, width)
    return np.max([morph.at(*spread(place, morph.count)).norms for place in places], axis=0)


def fit_window(owner) -> None:
    """Fit the window of an object to all shapes of its morph, if it is to be fitted and there are any."""
    settings = owner.ifs_morph
    output = settings.output
    if settings.kind == "NONE" or not output.fit_window or preparation.is_running():
        return
    try:
        morph = morph_of(settings)
        shapes = [morph.at(*spread(place, morph.count)) for place in path_samples(owner)]
        if morph.DIMENSION == 2:
            output.window, output.depth = fitted_window(shapes, tuple(output.resolution)), (0.0, 0.0)
        else:
            output.window, output.depth = _fitted_box(shapes, is_in_space(settings))
    except (IFSError, ImportError):
        return  # The panel shows what is wrong; the last window will do until it is mended.


def _fitted_box(shapes: list, in_space: bool) -> tuple[list[float], list[float]]:
    """Window and depth that hold all of some shapes in space; those that only pass through it stay on the floor."""
    bounds = np.array([ifs.bounds for ifs in shapes if ifs.contractivity == Contractivity.CONTRACTIVE])
    if len(bounds) == 0:
        raise IFSError("None of the shapes has an attractor.")
    low, high = bounds[:, :3].min(axis=0), bounds[:, 3:].max(axis=0)
    margin = BOX_MARGIN * (high - low).max()
    low, high = low - margin, high + margin
    if not in_space:
        high[2] = max(high[2], -low[2])
        low[2] = -high[2]
    return [*low[:2], *high[:2]], [low[2], high[2]]


def shape_problem(settings) -> str:
    """What keeps an object's shapes from being morphed as they are paired, in one sentence; empty if nothing does."""
    if preparation.is_running():
        return preparation.message()
    try:
        if settings.kind == "IMAGE" and is_in_space(settings):
            return NO_PICTURE
        morph_of(settings)
        _require_attractors(settings)
    except (IFSError, ImportError) as error:  # A numba that does not fit its numpy cannot be imported.
        return str(error)
    return ""


def match_problem(settings) -> str:
    """What keeps an object's shapes from being matched, in one sentence; empty if nothing does."""
    if preparation.is_running():
        return preparation.message()
    if settings.kind == "IMAGE" and is_in_space(settings):
        return NO_PICTURE
    try:
        _require_attractors(settings)
    except (IFSError, ImportError) as error:
        return str(error)
    return ""


def _require_attractors(settings) -> tuple[IFS, IFS]:
    shapes = shapes_of(settings)
    for ifs in shapes:
        ifs.require_attractor()
    return shapes
