"""Frame checks and their words, recomputed from the verdicts one frame at a time."""

import threading

import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.ifs import IFS
from core.morph import Morph
from core.parallel import Cancelled
from core.path import plan_path
from core.report import CHUNK, FrameCheck, check_frames, check_frames_steps, family
from core.shapes import SHAPES

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = Connectedness

GASKETS = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
FERN = Morph(SHAPES["Barnsley fern"], SHAPES["square"])


def line(frames, swell=0.0):
    times = np.linspace(0, 1, frames)
    return np.stack([times, times, swell + 0 * times], axis=1)


@pytest.mark.parametrize("morph", [GASKETS, FERN])
@pytest.mark.parametrize("tolerance", [1 / 300, 1 / 50])
def test_a_check_is_the_verdict_of_each_frame(morph, tolerance):
    random = np.random.default_rng(2)
    frames = np.column_stack([random.uniform(-1, 2, (60, 2)), random.uniform(-0.5, 0.5, 60).clip(0)])
    check = check_frames(morph, frames, tolerance)
    verdicts = [connectedness(morph.at(*frame), tolerance) for frame in frames]
    assert check.state.tolist() == [verdict.state for verdict in verdicts]
    # To the last digits: many at once are not always rounded as one alone.
    np.testing.assert_allclose(check.gap, [verdict.gap for verdict in verdicts], rtol=1e-6, atol=1e-9)
    assert np.array_equal(check.uv_swell, frames)
    states = [verdict.state for verdict in verdicts]
    for state in Connectedness:
        assert check.count(state) == states.count(state)
    broken = sum(state in (DISCONNECTED, NO_ATTRACTOR) for state in states)
    assert check.share_disconnected == broken / 60
    gaps = [sum(verdict.gap) / 2 for verdict in verdicts if verdict.state == DISCONNECTED]
    assert check.worst_gap == pytest.approx(max(gaps))
    assert check.most_swell == frames[:, 2].max()
    assert check.mean_swell == pytest.approx(frames[:, 2].mean())


def test_one_piece_has_no_worst_gap():
    check = check_frames(Morph(SHAPES["gasket"], SHAPES["gasket"]), line(5))
    assert check.worst_gap == check.share_disconnected == check.most_swell == 0


@pytest.mark.parametrize("frames", [1, CHUNK - 1, CHUNK, CHUNK + 1, 5 * CHUNK + 3])
def test_any_number_of_frames_and_threads(frames):
    one = check_frames(GASKETS, line(frames) if frames > 1 else [[0.5, 0.5, 0]], threads=1)
    assert len(one.state) == frames
    for threads in (2, 3):
        other = check_frames(GASKETS, one.uv_swell, threads=threads)
        assert one.state.tobytes() == other.state.tobytes()
        assert one.gap.tobytes() == other.gap.tobytes()


def test_family_is_the_morph_frame_by_frame():
    frames = np.random.default_rng(0).uniform(0, 1, (9, 3))
    linear, translation, allowed = family(FERN, frames)
    assert allowed.shape == (9, 5, 4)
    assert allowed.all()
    assert linear.shape == (9, 4, 4)
    assert translation.shape == (9, 4, 2)
    for k, frame in enumerate(frames):
        ifs = FERN.at(*frame)
        assert linear[k].reshape(4, 2, 2) == pytest.approx(ifs.linear, abs=1e-14)
        assert translation[k] == pytest.approx(ifs.translation, abs=1e-15)


def test_progress_and_cancel():
    told = []
    check_frames(FERN, line(200), progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1
    before = threading.active_count()
    with pytest.raises(Cancelled):
        check_frames(FERN, line(2000), progress=lambda share: False)
    assert threading.active_count() == before
    assert 0 < next(check_frames_steps(FERN, line(50))) <= 1


# --- words


def of_states(states, gap=0.02, swell=0.0):
    states = np.array(states, dtype=np.uint8)
    gaps = np.where((states == DISCONNECTED)[:, None], [gap - 0.001, gap + 0.001], [0, 1 / 300])
    return FrameCheck(np.full((len(states), 3), swell), states, gaps, 1 / 300)


def test_words_for_all_in_one_piece():
    text = of_states([0] * 10).text()
    assert text == "The keyed path: 10 frames, all in one piece (100%), at 1/300 of the shape's size."


def test_words_for_what_is_wrong():
    text = of_states([0, 0, 0, 1, 2, 2, 3, 3], swell=0.25).text()
    for words in ("8 frames", "1 in pieces (12%", "widest gap 2.0%", "2 undecided", "2 without an attractor"):
        assert words in text
    assert "all in one piece" not in text
    assert "Swell: 0.25 at most, 0.250 on average." in text


def test_the_widest_gap_in_pixels_of_a_picture():
    check = check_frames(GASKETS, line(50))
    frame = int(np.argmax(np.where(check.state == DISCONNECTED, check.gap.mean(axis=1), 0)))
    _, radius = GASKETS.at(*check.uv_swell[frame]).enclosing_disc
    pixels = check.gap[frame].mean() * 2 * radius * 1000
    assert pixels > 10
    assert f"% of the shape's size or {pixels:.1f} pixels)" in check.text(1 / 1000)
    assert "pixels" not in check.text()
    assert "pixels" not in check_frames(GASKETS, line(50)[:1]).text(1 / 1000)


def test_report_numbers_are_those_of_the_frames():
    path = plan_path(GASKETS, frames=50, method="straight unswollen")
    states = [connectedness(GASKETS.at(t, t)).state for t in np.arange(50) / 49]
    broken = states.count(DISCONNECTED)
    assert path.report.path.count(DISCONNECTED) == path.report.straight.count(DISCONNECTED) == broken
    text = path.report.text()
    whole = 50 - broken
    expected = f"50 frames, {whole} in one piece ({2 * whole}%), {broken} in pieces ({2 * broken}%"
    assert expected in text
    assert text.count("in pieces") == 1
    assert "Swell" not in text


def test_report_says_which_maps_flip():
    mirrored = SHAPES["gasket"].maps.copy()
    mirrored[1, 0, :2] *= -1
    mirrored[2, 0, :2] *= -1
    report = plan_path(Morph(SHAPES["gasket"], IFS(mirrored)), frames=12, method="straight").report
    assert report.flips == (1, 2)
    assert "map 2, map 3." in report.text()
    assert "reflects: 1 to 2, 3 to 3." in report.text(names=["2 to 1", "1 to 2", "3 to 3"])
