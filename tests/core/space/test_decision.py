from dataclasses import replace

import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.locus import compute_locus
from core.morph import Morph
from core.path import plan_path
from core.report import check_frames
from core.shapes import SHAPES
from core.space.affine import turned
from core.space.ifs import SpaceIFS
from core.space.morph import SpaceMorph

from .reference import CORNERS, dense, in_space, longest_edge, random_ifs, similarities, tetrahedron

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = Connectedness

SPONGE = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if (i == 1) + (j == 1) + (k == 1) < 2]


@pytest.mark.parametrize("seed", range(30))
def test_verdicts_agree_with_points(seed):
    """Every gap lies between the one of many points and that less what may lie between these."""
    ifs = random_ifs(seed, 4 + seed % 2, 0.4, 0.75, 1.0)
    verdict = connectedness(ifs)
    points, letters, spacing = dense(ifs.maps)
    edge, diameter = longest_edge(points, letters, ifs.count), 2 * ifs.enclosing_ball[1]
    assert verdict.gap[0] * diameter <= edge + 1e-9
    assert verdict.gap[1] * diameter >= edge - 2 * spacing - 1e-9
    if verdict.state == CONNECTED:
        assert edge - 2 * spacing <= diameter / 300
    if edge - 2 * spacing > diameter / 300:
        assert verdict.state == DISCONNECTED
    assert verdict.state in (CONNECTED, DISCONNECTED, UNDECIDED)


def test_random_shapes_are_of_both_kinds_and_decided():
    states = [connectedness(random_ifs(seed, 4 + seed % 2, 0.4, 0.75, 1.0)).state for seed in range(30)]
    assert min(states.count(CONNECTED), states.count(DISCONNECTED)) >= 5
    assert states.count(UNDECIDED) <= 3


@pytest.mark.parametrize(
    ("scale", "state"), [(0.5, CONNECTED), (0.51, CONNECTED), (0.498, DISCONNECTED), (0.4, DISCONNECTED)]
)
def test_tetrahedra_are_connected_from_one_half_on(scale, state):
    verdict = connectedness(tetrahedron(scale), 1e-5)
    assert verdict.state == state
    if state == DISCONNECTED:
        gap = (1 - 2 * scale) / (2 * tetrahedron(scale).enclosing_ball[1])
        assert verdict.gap[0] <= gap * (1 + 1e-9)
        assert gap * (1 - 1e-9) <= verdict.gap[1] < 1.1 * gap


@pytest.mark.parametrize("seed", range(30))
def test_verdicts_on_what_is_drawn_agree_with_points(seed):
    ifs = random_ifs(seed, 4 + seed % 2, 0.5, 0.8, 1.0)
    drawn = np.random.default_rng(seed).random(ifs.count) < 0.5
    drawn[seed % ifs.count] = True
    whole, part = connectedness(ifs), connectedness(replace(ifs, opacity=drawn))
    points, letters, spacing = dense(ifs.maps)
    groups = np.cumsum(drawn)[letters] - 1
    shown = drawn[letters]
    edge = longest_edge(points[shown], groups[shown], drawn.sum()) if drawn.sum() > 1 else 0.0
    diameter = 2 * ifs.enclosing_ball[1]
    if whole.state != CONNECTED:
        assert part.state == whole.state
    elif part.state == CONNECTED:
        assert edge - 2 * spacing <= diameter / 300
        assert part.components.tolist() == np.where(drawn, drawn.argmax(), -1).tolist()
    elif part.state == DISCONNECTED:
        assert part.gap[0] > 0
        assert part.gap[0] * diameter <= edge + 1e-9
        assert part.gap[1] * diameter >= edge - 2 * spacing - 1e-9
    assert np.array_equal(part.components < 0, ~drawn)


def test_only_what_is_drawn_of_a_sponge_has_to_hang_together():
    """The corners of a cube, with the edges between them hidden; and one face, which is a carpet."""
    cells = np.array(SPONGE)
    sponge = similarities(1 / 3, cells / 2)
    corners, face = (cells != 1).all(axis=1), cells[:, 0] == 0
    for drawn, state in ((corners, DISCONNECTED), (face, CONNECTED), (face | corners, DISCONNECTED)):
        part = replace(sponge, opacity=drawn)
        assert connectedness(part).state == state
        locus = compute_locus(SpaceMorph(part, part), 2, domain=(0, 1))
        assert (locus.state == state).all()
        assert check_frames(SpaceMorph(part, sponge), np.array([[0, 0, 0], [1, 1, 0]])).state.tolist() == [
            state,
            CONNECTED,
        ]


def test_a_sponge_is_connected_and_its_cells_pulled_apart_are_not():
    cells = np.array(SPONGE) / 2
    assert connectedness(similarities(1 / 3, cells)).state == CONNECTED
    assert connectedness(similarities(0.32, cells)).state == DISCONNECTED


def test_shapes_on_the_floor_are_decided_as_in_the_plane():
    for name in ("gasket", "terdragon", "Koch curve", "Cantor dust"):
        assert connectedness(in_space(SHAPES[name])).state == connectedness(SHAPES[name]).state


def test_two_pairs_apart_are_two_components():
    points = [(0, 0, 0), (0.5, 0, 0), (10, 0, 0), (10.5, 0, 0)]
    verdict = connectedness(similarities(0.4, points))
    assert verdict.state == DISCONNECTED
    assert len(set(verdict.components.tolist())) > 1


@pytest.mark.parametrize("seed", range(5))
def test_maps_that_cover_half_the_volume_each_are_connected(seed):
    ifs = random_ifs(seed, 2)
    linear = np.linalg.svd(ifs.linear)
    maps = np.concatenate([0.8 * linear[0] @ linear[2], 100 * ifs.maps[:, :, 3:]], axis=-1)
    assert connectedness(SpaceIFS(maps)).state == CONNECTED


def test_without_an_attractor_there_is_none():
    verdict = connectedness(tetrahedron(1.1))
    assert verdict.state == NO_ATTRACTOR
    assert np.isnan(verdict.gap).all()


def test_far_from_the_origin_nothing_is_lost():
    for scale, state in ((0.5, CONNECTED), (0.49, DISCONNECTED)):
        assert connectedness(similarities(scale, CORNERS + 1e6)).state == state


def test_a_locus_holds_the_states_of_its_attractors():
    morph = SpaceMorph(tilted(0.3), tetrahedron(0.5))
    locus = compute_locus(morph, 16, threads=1)
    for row, column in ((0, 0), (5, 5), (10, 10), (3, 12), (15, 15), (8, 2)):
        verdict = connectedness(morph.at(locus.u[column], locus.v[row]))
        assert locus.state[row, column] == verdict.state
        assert np.float32(verdict.gap[0]) == pytest.approx(locus.gap[row, column], rel=1e-5, abs=1e-9)


def test_a_locus_on_the_floor_is_that_of_the_plane():
    plane = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
    space = SpaceMorph(in_space(plane.initial), in_space(plane.final))
    of_plane, of_space = compute_locus(plane, 31, gap=False), compute_locus(space, 31, gap=False)
    decided = (of_space.state != UNDECIDED) & (of_plane.state != UNDECIDED)
    assert decided.mean() > 0.9
    # Thickness may join what is apart in the plane, where there is any: none is on the floor.
    assert (of_plane.state == of_space.state)[decided].mean() > 0.9


def tilted(angle):
    """Return the tetrahedron with its first quarter turned about its own middle and a corner that it touches."""
    maps = tetrahedron(0.5).maps.copy()
    axis = CORNERS[1] / np.linalg.norm(CORNERS[1])
    maps[0, :, :3] = 0.5 * turned(axis, np.array(angle))
    return SpaceIFS(maps)


def test_a_path_keeps_a_shape_in_space_in_one_piece():
    """The first quarter turns by a third about the long diagonal: at both ends it touches all others."""
    maps = tetrahedron(0.5).maps.copy()
    middle = CORNERS.mean(axis=0)
    axis = (middle - CORNERS[0]) / np.linalg.norm(middle - CORNERS[0])
    maps[0, :, :3] = 0.5 * turned(axis, np.array(2 * np.pi / 3))
    morph = SpaceMorph(SpaceIFS(maps), tetrahedron(0.5))
    straight = plan_path(morph, frames=40, method="straight unswollen", threads=1)
    assert straight.report.path.share_disconnected > 0.5
    swollen = plan_path(morph, frames=40, method="straight", threads=1)
    assert swollen.report.path.count(CONNECTED) == 40
    assert 0 < swollen.report.path.most_swell < 1
    for t in np.linspace(0, 1, 14):
        points, letters, spacing = dense(morph.at(*swollen.at(float(t))).maps)
        assert longest_edge(points, letters, 4) - 2 * spacing <= 2 / 300
    planned = plan_path(morph, compute_locus(morph, 31, gap=False, threads=1), frames=40, threads=1)
    assert check_frames(morph, planned.sample(np.linspace(0, 1, 40))).count(CONNECTED) == 40
