import numpy as np
import pytest

from core.ifs import IFSError
from core.morph import SCHEMES, Morph
from core.shapes import SHAPES
from core.space.ifs import SpaceIFS
from core.space.morph import SWOLLEN, SpaceMorph

from .reference import in_space, random_ifs, similarities, tetrahedron


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("seed", range(6))
def test_the_ends_are_the_shapes(scheme, seed):
    initial, final = random_ifs(seed, 5), random_ifs(seed + 100, 5)
    morph = SpaceMorph(initial, final, scheme, winding=[0, 1, -1, 0, 2])
    assert morph.at(0, 0).maps == pytest.approx(initial.maps, abs=1e-12)
    assert morph.at(1, 1).maps == pytest.approx(final.maps, abs=1e-12)
    assert isinstance(morph.at(0.3, 0.4), SpaceIFS)
    signs = np.sign(np.linalg.det(initial.linear)), np.sign(np.linalg.det(final.linear))
    assert morph.flips == tuple(np.flatnonzero(signs[0] != signs[1]))


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize(
    "pair", [("turned gasket", "gasket"), ("terdragon", "gasket"), ("Heighway dragon", "Lévy curve")]
)
def test_shapes_on_the_floor_morph_as_in_the_plane(scheme, pair):
    plane = Morph(SHAPES[pair[0]], SHAPES[pair[1]], scheme)
    space = SpaceMorph(in_space(plane.initial), in_space(plane.final), scheme)
    for u in np.linspace(-1, 2, 13):
        assert space.linear(u)[:, :2, :2] == pytest.approx(plane.linear(u), abs=1e-9)
        assert space.translation(u)[:, :2] == pytest.approx(plane.translation(u))


@pytest.mark.parametrize("seed", range(6))
def test_maps_of_one_orientation_never_become_singular(seed):
    random = np.random.default_rng(seed)
    linear = 0.5 * np.linalg.qr(random.normal(size=(2, 4, 3, 3)))[0]
    linear *= np.sign(np.linalg.det(linear))[..., None, None]
    shapes = [SpaceIFS(np.concatenate([part, random.normal(size=(4, 3, 1))], axis=-1)) for part in linear]
    morph = SpaceMorph(*shapes)
    assert morph.flips == ()
    # Similarities of one ratio stay that on the shorter way round.
    assert np.linalg.det(morph.linear(np.linspace(0, 1, 9)[:, None])) == pytest.approx(0.125)
    assert (np.abs(morph.turning) <= np.pi).all()


def test_a_map_that_reflects_at_one_end_mirrors_without_a_needless_turn():
    initial, mirrored = tetrahedron(0.5), tetrahedron(0.5).maps.copy()
    mirrored[0, :, :3] = 0.5 * np.diag([1.0, -1.0, 1.0])
    morph = SpaceMorph(initial, SpaceIFS(mirrored))
    assert morph.flips == (0,)
    assert morph.turning == pytest.approx(np.zeros(4), abs=1e-12)
    assert morph.linear(0.5)[0] == pytest.approx(0.5 * np.diag([1.0, 0.0, 1.0]), abs=1e-12)


def test_half_a_turn_goes_counter_clockwise_whatever_the_rounding():
    for tilt in (0.0, 1e-12, -1e-12):
        maps = tetrahedron(0.5).maps.copy()
        maps[0, :, :3] = 0.5 * np.array([[-1, -tilt, 0], [tilt, -1, 0], [0, 0, 1]])
        quarter = SpaceMorph(tetrahedron(0.5), SpaceIFS(maps)).linear(0.5)[0]
        assert quarter == pytest.approx(np.array([[0, -0.5, 0], [0.5, 0, 0], [0, 0, 0.5]]), abs=1e-9)


def test_full_swell_makes_every_volume_one_half():
    morph = SpaceMorph(random_ifs(1, 4), random_ifs(2, 4))
    volumes = np.abs(np.linalg.det(morph.linear(np.array([[0.0], [1.0]]), 1.0)))
    assert volumes.min() >= SWOLLEN**3 * (1 - 1e-12) > 1 / 2
    assert morph.linear(0.3, 0.0) == pytest.approx(morph.linear(0.3), abs=0)


def test_a_flat_end_takes_the_orientation_of_the_other():
    flat = tetrahedron(0.5).maps.copy()
    flat[:, 2, :3] = 0
    mirrored = similarities(-0.5, np.eye(4, 3))
    morph = SpaceMorph(SpaceIFS(flat), mirrored)
    assert morph.flips == ()
    assert morph.at(0, 0).maps == pytest.approx(flat, abs=1e-12)
    with pytest.raises(IFSError, match="flat"):
        SpaceMorph(SpaceIFS(flat), mirrored, "log-polar")


def test_shapes_of_the_plane_and_of_space_do_not_mix():
    with pytest.raises(IFSError, match="dimensions"):
        SpaceMorph(tetrahedron(0.5), SHAPES["gasket"])
    with pytest.raises(IFSError, match="dimensions"):
        Morph(tetrahedron(0.5), tetrahedron(0.5))
