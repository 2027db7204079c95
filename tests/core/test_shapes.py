"""The library of shapes: closed forms, symmetries, joints and connectedness, on points found by plain subdivision."""

import inspect
from functools import cache
from itertools import combinations, pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from core import shapes
from core.affine import transform
from core.connectedness import Connectedness, connectedness
from core.ifs import IFS, Contractivity
from core.shapes import SHAPES, chain, similarity, towards, turn

GOLDEN_RATIO = (1 + 5**0.5) / 2
SQUARE_ROOT_3 = 3**0.5

NAMES = (
    "gasket",
    "turned gasket",
    "gasket relative",
    "pentigasket",
    "hexagasket",
    "square",
    "Sierpinski carpet",
    "Vicsek cross",
    "Cantor dust",
    "Koch curve",
    "Koch snowflake",
    "Lévy curve",
    "Heighway dragon",
    "twindragon",
    "terdragon",
    "Gosper flowsnake",
    "Rauzy fractal",
    "pentigree",
    "spiral",
    "Hata tree",
    "Barnsley tree",
    "Pythagoras tree",
    "Barnsley fern",
    "maple leaf",
)

every_shape = pytest.mark.parametrize("name", NAMES)


def subdivide(maps, norm):
    """Return the shortest words (M, 2, 3) of at most a norm, and the first letter (M,) of each."""
    words, letters = maps, np.arange(len(maps))
    found = []
    while len(words):
        short = np.linalg.norm(words[:, :, :2], 2, axis=(1, 2)) <= norm
        found.append((words[short], letters[short]))
        linear = words[~short, None, :, :2] @ maps[None, :, :, :2]
        translation = words[~short, None, :, :2] @ maps[None, :, :, 2:] + words[~short, None, :, 2:]
        words = np.concatenate([linear, translation], axis=-1).reshape(-1, 2, 3)
        letters = np.repeat(letters[~short], len(maps))
    return tuple(np.concatenate(parts) for parts in zip(*found, strict=True))


@cache
def dense(name, norm=1 / 80):
    """Return points (M, 2) of the attractor, their attractorlet (M,), their |det| (M,) and a spacing.

    No point of the attractor is further than the spacing from its piece's point.
    """
    maps = SHAPES[name].maps
    start = np.linalg.solve(np.eye(2) - maps[-1, :, :2], maps[-1, :, 2])
    words, _ = subdivide(maps, 1 / 2)
    shrink = np.linalg.norm(words[:, :, :2], 2, axis=(1, 2))
    reach = np.linalg.norm(transform(words, start) - start, axis=1)
    words, letters = subdivide(maps, norm)
    areas = np.abs(np.linalg.det(words[:, :, :2]))
    return transform(words, start), letters, areas, norm * (reach / (1 - shrink)).max()


def test_names_are_those_of_the_menu():
    assert tuple(SHAPES) == NAMES
    assert all(name == shape.name for name, shape in SHAPES.items())


def test_every_shape_has_a_function_that_names_its_source():
    functions = [f for _, f in inspect.getmembers(shapes, inspect.isfunction) if f.__annotations__.get("return") is IFS]
    assert sorted(f().name for f in functions) == sorted(NAMES)
    for function in functions:
        source = inspect.getdoc(function).partition("Source: ")[2]
        assert len(source) > 15, function.__name__


@every_shape
def test_every_shape_has_an_attractor(name):
    assert SHAPES[name].contractivity == Contractivity.CONTRACTIVE


def test_similarity_is_complex_arithmetic():
    multiplier, offset, z = 0.3 - 0.4j, 2 + 1j, -1.5 + 0.25j
    point = np.array([z.real, z.imag])
    assert complex(*transform(similarity(multiplier, offset), point)) == pytest.approx(multiplier * z + offset)
    reflected = transform(similarity(multiplier, offset, reflects=True), point)
    assert complex(*reflected) == pytest.approx(multiplier * z.conjugate() + offset)
    np.testing.assert_allclose(transform(towards(multiplier, z), point), point)


def test_chain_takes_the_ends_to_the_ends_of_each_edge():
    forward, backward = chain([2, 2j], backwards={1})
    ends = np.array([[0, 0], [1, 0]])
    np.testing.assert_allclose(transform(forward, ends), [[0, 0], [0.5, -0.5]], atol=1e-15)
    np.testing.assert_allclose(transform(backward, ends), [[1, 0], [0.5, -0.5]], atol=1e-15)


DIMENSIONS = {
    "gasket": np.log(3) / np.log(2),
    "turned gasket": np.log(3) / np.log(2),
    "gasket relative": np.log(3) / np.log(2),
    "pentigasket": np.log(5) / np.log(GOLDEN_RATIO**2),
    "hexagasket": np.log(6) / np.log(3),
    "square": 2,
    "Sierpinski carpet": np.log(8) / np.log(3),
    "Vicsek cross": np.log(5) / np.log(3),
    "Cantor dust": np.log(4) / np.log(3),
    "Koch curve": np.log(4) / np.log(3),
    "Koch snowflake": 2,
    "Lévy curve": 2,
    "Heighway dragon": 2,
    "twindragon": 2,
    "terdragon": 2,
    "Gosper flowsnake": 2,
    "Rauzy fractal": 2,
    "pentigree": np.log(6) / np.log(GOLDEN_RATIO**2),
}


@pytest.mark.parametrize("name", DIMENSIONS)
def test_similarity_dimension_solves_moran_equation(name):
    scales = np.linalg.svd(SHAPES[name].linear, compute_uv=False)
    np.testing.assert_allclose(scales[:, 0], scales[:, 1], rtol=1e-12)
    dimension = brentq(lambda s: (scales[:, 0] ** s).sum() - 1, 0.1, 3)
    assert dimension == pytest.approx(DIMENSIONS[name], rel=1e-10)


AREAS = {
    "square": 1,
    "Koch snowflake": 6 * SQUARE_ROOT_3 / 5,  # on the unit circle
    "Heighway dragon": 1 / 2,
    "twindragon": 1,
    "terdragon": 1 / (2 * SQUARE_ROOT_3),
    "Gosper flowsnake": SQUARE_ROOT_3 / 2,
}


@pytest.mark.parametrize("name", AREAS)
def test_tiles_have_their_area(name):
    """The pieces of a tile do not overlap, so that inside it the measure has the density 1/area."""
    points, _, areas, spacing = dense(name, 1 / 300)
    assert areas.sum() == pytest.approx(1)
    cell = 8 * spacing
    column, row = np.floor(points / cell).astype(int).T
    _, cells = np.unique(1000 * row + column, return_inverse=True)
    density = np.bincount(cells, weights=areas) / cell**2
    inside = np.quantile(density, 0.85)  # most of the other cells are cut by the edge
    assert 1 / inside == pytest.approx(AREAS[name], rel=0.03)


BOXES = {
    "gasket": (0, 0, 1, SQUARE_ROOT_3 / 2),
    "turned gasket": (0, 0, 1, SQUARE_ROOT_3 / 2),
    "pentigasket": (-np.sin(np.radians(72)), -np.cos(np.radians(36)), np.sin(np.radians(72)), 1),
    "hexagasket": (-SQUARE_ROOT_3 / 2, -1, SQUARE_ROOT_3 / 2, 1),
    "square": (0, 0, 1, 1),
    "Sierpinski carpet": (0, 0, 1, 1),
    "Vicsek cross": (0, 0, 1, 1),
    "Cantor dust": (0, 0, 1, 1),
    "Koch curve": (0, 0, 1, SQUARE_ROOT_3 / 6),
    "Koch snowflake": (-SQUARE_ROOT_3 / 2, -1, SQUARE_ROOT_3 / 2, 1),
    "Lévy curve": (-1 / 2, -1 / 4, 3 / 2, 1),
    "Heighway dragon": (-1 / 3, -1 / 3, 7 / 6, 2 / 3),
    "twindragon": (-1 / 3, -2 / 3, 4 / 3, 2 / 3),
    "Pythagoras tree": (-2, 0, 2, 3),
    "Barnsley fern": (-2.182, 0, 2.6558, 9.9983),  # as commonly given
}


@pytest.mark.parametrize("name", BOXES)
def test_bounding_box(name):
    points, _, _, spacing = dense(name)
    box = np.concatenate([points.min(axis=0), points.max(axis=0)])
    np.testing.assert_allclose(box, BOXES[name], atol=spacing)
    assert spacing < 0.02 * np.linalg.norm(box[2:] - box[:2])


POINTS = {
    "gasket": shapes.TRIANGLE,
    "turned gasket": shapes.TRIANGLE[1:],
    "gasket relative": [0, 0.5 + 0.5j],
    "pentigasket": [turn(90 + 72 * k) for k in range(5)],
    "hexagasket": [turn(90 + 60 * k) for k in range(6)],
    "square": [0, 1, 1j, 1 + 1j, 0.5 + 0.5j, 0.2 + 0.7j],
    "Sierpinski carpet": [0, 1 + 1j, 1 / 3 + 1j / 3, 0.5, 0.5 + 1j / 3],
    "Vicsek cross": [0.5 + 0.5j, 0.5, 0.5j, 0.5 + 1j, 1 + 0.5j],
    "Cantor dust": [0, 1, 1j, 1 + 1j, 1 / 4 + 3j / 4],  # 1/4 is 0.0202... in base 3
    "Koch curve": [0, 1 / 3, 0.5 + SQUARE_ROOT_3 / 6 * 1j, 2 / 3, 1],
    "Koch snowflake": [0, *(turn(30 + 60 * k) for k in range(6)), *(turn(60 * k) / SQUARE_ROOT_3 for k in range(6))],
    "Lévy curve": [0, 1, 0.5 + 0.5j, 1j, 1 + 1j, 0.5 + 1j],
    "Heighway dragon": [0, 1, 0.5 + 0.5j],
    "twindragon": [0, 1, 0.5],
    "terdragon": [0, 1, turn(-30) / SQUARE_ROOT_3],
    "Gosper flowsnake": [0, 1],
    "Rauzy fractal": [0, 1],
    "pentigree": [0, 1, 1 / GOLDEN_RATIO**2],  # the fourth edge ends on the way from 0 to 1
    "spiral": [0, 1, 0.93 * turn(20)],
    "Hata tree": [0, 1j, 1j / 3, (0.5 + SQUARE_ROOT_3 / 6 * 1j) * 1j],
    "Barnsley tree": [0, 0.2j],
    "Pythagoras tree": [0, 1j, -1 + 1j, 1 + 1j, 3j],
    "Barnsley fern": [0, 1.6j],
}


@pytest.mark.parametrize("name", POINTS)
def test_known_points_lie_on_the_attractor(name):
    points, _, _, spacing = dense(name)
    known = np.array([[z.real, z.imag] for z in map(complex, POINTS[name])])
    distance, _ = cKDTree(points).query(known)
    assert distance.max() <= spacing


SYMMETRIES = {  # order of the rotations, angle of an axis of reflection
    "gasket": (3, 90),
    "gasket relative": (1, 45),
    "pentigasket": (5, 90),
    "hexagasket": (6, 90),
    "square": (4, 90),
    "Sierpinski carpet": (4, 90),
    "Vicsek cross": (4, 90),
    "Cantor dust": (4, 90),
    "Koch curve": (1, 90),
    "Koch snowflake": (6, 90),
    "Lévy curve": (1, 90),
    "twindragon": (2, None),
    "terdragon": (2, None),
    "Gosper flowsnake": (6, None),
    "Rauzy fractal": (2, None),
    "Barnsley tree": (1, 90),
    "Pythagoras tree": (1, 90),
}


@pytest.mark.parametrize("name", SYMMETRIES)
def test_symmetries_leave_the_attractor_as_it_is(name):
    points, _, _, spacing = dense(name)
    maps = SHAPES[name].maps
    shares = np.abs(np.linalg.det(maps[:, :, :2]))
    mean = np.einsum("i,ijk->jk", shares / shares.sum(), maps)
    center = np.linalg.solve(np.eye(2) - mean[:, :2], mean[:, 2])  # of mass, where the areas are the weights
    tree = cKDTree(points)
    order, axis = SYMMETRIES[name]
    x, y = turn(360 / order).real, turn(360 / order).imag
    symmetries = [np.array([[x, -y], [y, x]])]
    if axis is not None:
        x, y = turn(2 * axis).real, turn(2 * axis).imag
        symmetries.append(np.array([[x, y], [y, -x]]))
    for linear in symmetries:
        distance, _ = tree.query((points - center) @ linear.T + center)
        assert distance.max() <= spacing


CURVES = {  # the edges run through backwards
    "Koch curve": (),
    "Lévy curve": (),
    "Heighway dragon": (1,),
    "terdragon": (),
    "Gosper flowsnake": (1, 2, 6),
    "pentigree": (),
    "spiral": (1,),
}


@pytest.mark.parametrize("name", CURVES)
def test_pieces_of_a_curve_meet_end_to_start(name):
    ends = transform(SHAPES[name].maps[:, None], np.array([[0, 0], [1, 0]]))
    backwards = list(CURVES[name])
    ends[backwards] = ends[backwards, ::-1]
    np.testing.assert_allclose(ends[0, 0], [0, 0], atol=1e-12)
    np.testing.assert_allclose(ends[-1, 1], [1, 0], atol=1e-12)
    for piece, following in pairwise(ends):
        np.testing.assert_allclose(piece[1], following[0], atol=1e-12)


def test_turned_gasket_turns_the_lower_left_attractorlet_about_the_centre_of_its_box():
    points, attractorlet, _, spacing = dense("gasket")
    lower_left = points[attractorlet == 0]
    center = (lower_left.min(axis=0) + lower_left.max(axis=0)) / 2
    corners = np.array([[0, 0], [1, 0], [1 / 2, SQUARE_ROOT_3 / 2]])
    straight, turned = (transform(SHAPES[name].maps[:, None], corners) for name in ("gasket", "turned gasket"))
    np.testing.assert_allclose(turned[0], 2 * center - straight[0], atol=2 * spacing)
    np.testing.assert_array_equal(turned[1:], straight[1:])


@pytest.mark.parametrize("name", ["Hata tree", "Barnsley tree", "Pythagoras tree", "Barnsley fern"])
def test_plants_stand_on_their_root_at_the_origin(name):
    points, _, _, spacing = dense(name)
    assert points[:, 1].min() >= -1e-9
    root = points[points[:, 1] < spacing]
    assert np.abs(root[:, 0]).max() < 3 * spacing
    assert points[:, 1].max() > 20 * spacing


def test_rauzy_number_is_the_complex_tribonacci_number():
    first, second, third = SHAPES["Rauzy fractal"].maps
    a = complex(first[0, 0], first[1, 0])
    assert a**3 == pytest.approx(a**2 + a + 1)
    assert abs(a) < 1
    assert complex(second[0, 0], second[1, 0]) == pytest.approx(a**2)
    assert complex(third[0, 0], third[1, 0]) == pytest.approx(a**3)


def test_hexagasket_and_middle_make_the_snowflake():
    np.testing.assert_array_equal(SHAPES["Koch snowflake"].maps[1:], SHAPES["hexagasket"].maps)


TABLES = {  # a, b, c, d, e, f and the probability, as published
    "Barnsley fern": (
        (0, 0, 0, 0.16, 0, 0, 0.01),
        (0.85, 0.04, -0.04, 0.85, 0, 1.6, 0.85),
        (0.2, -0.26, 0.23, 0.22, 0, 1.6, 0.07),
        (-0.15, 0.28, 0.26, 0.24, 0, 0.44, 0.07),
    ),
    "Barnsley tree": (
        (0, 0, 0, 0.5, 0, 0, 0.05),
        (0.42, -0.42, 0.42, 0.42, 0, 0.2, 0.4),
        (0.42, 0.42, -0.42, 0.42, 0, 0.2, 0.4),
        (0.1, 0, 0, 0.1, 0, 0.2, 0.15),
    ),
    "maple leaf": (
        (0.14, 0.01, 0, 0.51, -0.08, -1.31, 0.1),
        (0.43, 0.52, -0.45, 0.5, 1.49, -0.75, 0.35),
        (0.45, -0.49, 0.47, 0.47, -1.62, -0.74, 0.35),
        (0.49, 0, 0, 0.51, 0.02, 1.62, 0.2),
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_published_tables(name):
    table = np.array(TABLES[name])
    np.testing.assert_allclose(SHAPES[name].linear.reshape(-1, 4), table[:, :4], atol=1e-15)
    np.testing.assert_allclose(SHAPES[name].translation, table[:, 4:6], atol=1e-15)
    np.testing.assert_allclose(SHAPES[name].weights, table[:, 6], rtol=1e-12)


def test_pentigree_starts_with_the_published_offsets():
    offsets = [[0, 0], [0.309, 0.225], [0.191, 0.588], [0.5, 0.363], [0.382, 0]]
    np.testing.assert_allclose(SHAPES["pentigree"].translation[:5], offsets, atol=6e-4)


@every_shape
def test_attractorlets_hang_together_except_in_cantor_dust(name):
    """Brute force: attractorlets that meet have points within two spacings; those further apart do not meet."""
    points, attractorlet, _, spacing = dense(name)
    trees = [cKDTree(points[attractorlet == i]) for i in range(SHAPES[name].count)]
    linked = np.eye(len(trees), dtype=bool)
    for i, j in combinations(range(len(trees)), 2):
        linked[i, j] = trees[i].query(trees[j].data)[0].min() <= 2 * spacing
    assert connected_components(linked)[0] == (4 if name == "Cantor dust" else 1)


@every_shape
def test_every_shape_but_cantor_dust_is_certified_connected(name):
    expected = Connectedness.DISCONNECTED if name == "Cantor dust" else Connectedness.CONNECTED
    assert connectedness(SHAPES[name]).state == expected
    assert connectedness(SHAPES[name], tolerance=1e-5).state == expected


def test_cantor_dust_has_a_gap_of_one_third():
    _, radius = SHAPES["Cantor dust"].enclosing_disc
    low, high = connectedness(SHAPES["Cantor dust"]).gap
    assert low <= 1 / 3 / (2 * radius) <= high
