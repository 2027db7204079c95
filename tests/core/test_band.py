"""A path for each map: what it closes that no common path does, and that it keeps to the ends."""

import numpy as np
import pytest

from core.band import WAYPOINTS, band_steps
from core.connectedness import Connectedness
from core.curve import Keys
from core.ifs import IFS
from core.morph import Morph
from core.parallel import finish
from core.path import plan_path
from core.report import check_frames
from core.shapes import SHAPES

from .reference import in_pieces

FRAMES = 120
TIMES = np.arange(FRAMES) / (FRAMES - 1)
ENDS = np.array([[0.0, 0.0], [1.0, 1.0]])
LINE = Keys(np.array([0.0, 1.0]), ENDS, ENDS * 2 / 3, 1 / 3 + ENDS * 2 / 3)
TERDRAGON = Morph(SHAPES["terdragon"], SHAPES["gasket"])
DRAGONS = Morph(SHAPES["twindragon"], SHAPES["twindragon"])
BANDS_OF = {}


def band_of(morph):
    if morph not in BANDS_OF:
        BANDS_OF[morph] = finish(band_steps(morph, LINE, FRAMES, 1 / 300))
    return BANDS_OF[morph]


def places(keys, times=TIMES):
    return np.column_stack([LINE.at(times), 0 * times, keys.at(times).reshape(len(times), -1)])


def test_it_closes_what_no_common_path_does():
    """Map k to map k, no path through the locus leads from the terdragon to the gasket."""
    check = check_frames(TERDRAGON, places(band_of(TERDRAGON)))
    straight = check_frames(TERDRAGON, np.column_stack([TIMES, TIMES, 0 * TIMES]))
    assert straight.share_disconnected > 0.4
    assert check.share_disconnected <= 0.025


def test_the_independent_reference_finds_it_closed():
    path = plan_path(TERDRAGON, frames=FRAMES, method="per map")
    maps = [TERDRAGON.at(*path.at(t)).maps for t in TIMES[::10]]
    assert not any(in_pieces(each, 1 / 300, 4000) for each in maps)


def test_it_begins_and_ends_where_the_path_does():
    keys = band_of(TERDRAGON)
    assert keys.value.shape == (WAYPOINTS + 2, 2, 3)
    assert not keys.at(np.array([0.0, 1.0])).any()
    assert np.array_equal(keys.time * (FRAMES - 1), np.round(keys.time * (FRAMES - 1)))


def test_where_nothing_breaks_all_maps_stay_together():
    assert not band_of(DRAGONS).value.any()


def test_ends_in_pieces_do_not_keep_it_from_ending():
    apart = IFS([[[0.3, 0, 0], [0, 0.3, 0]], [[0.3, 0, 1], [0, 0.3, 0]]])
    keys = finish(band_steps(Morph(apart, SHAPES["twindragon"]), LINE, 12, 1 / 300))
    assert np.isfinite(keys.value).all()


def test_it_is_the_same_again():
    assert finish(band_steps(TERDRAGON, LINE, FRAMES, 1 / 300)).value.tobytes() == band_of(TERDRAGON).value.tobytes()


@pytest.mark.parametrize("frames", [2, 3, 11, 12])
def test_few_frames(frames):
    keys = finish(band_steps(TERDRAGON, LINE, frames, 1 / 300))
    assert (np.diff(keys.time) > 0).all()
    assert (keys.time[0], keys.time[-1]) == (0, 1)
    assert keys.value[[0, -1]].tolist() == np.zeros((2, 2, 3)).tolist()


def test_it_is_drawn_tight():
    """Were each waypoint to lie in the middle of its neighbors, the band would be shorter: something would break."""
    keys = band_of(TERDRAGON)
    tighter = keys.value.copy()
    tighter[1:-1] *= 0.5
    half = Keys(keys.time, tighter, keys.handle_left / 2, keys.handle_right / 2)
    assert check_frames(TERDRAGON, places(half)).share_disconnected > 0.1


def test_a_path_by_maps_swells_less_than_one_for_all():
    by_maps = plan_path(TERDRAGON, frames=FRAMES, method="per map").report
    common = plan_path(TERDRAGON, frames=FRAMES, method="planned").report
    assert by_maps.path.count(Connectedness.CONNECTED) == FRAMES
    assert by_maps.path.most_swell < common.path.most_swell / 2
    assert by_maps.path.mean_swell < common.path.mean_swell / 2
    assert "a path of its own" in by_maps.text()
