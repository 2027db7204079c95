"""The kernel's score is what the morph itself says, one sample after the other."""

import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.matching.expansion import split_to
from core.matching.pairs import morph_of_pairs
from core.matching.problem import End, Problem
from core.matching.scoring import LEVELS, NEVER, golden_samples
from core.matching.symmetry import symmetries
from core.shapes import SHAPES


def problem_of(initial, final):
    ends = [End(SHAPES[name], symmetries(SHAPES[name]), split_to(SHAPES[name], 0)) for name in (initial, final)]
    return Problem(*ends, 1 / 300)


@pytest.mark.parametrize(
    ("initial", "final"),
    [("terdragon", "gasket"), ("Hata tree", "spiral"), ("Barnsley fern", "maple leaf"), ("Barnsley tree", "gasket")],
)
def test_swells_are_those_of_the_morph(initial, final):
    problem = problem_of(initial, final)
    random = np.random.default_rng(5)
    times = np.linspace(0.07, 0.93, 7)
    for start in [problem.starts()[0], problem.shuffled(random), problem.shuffled(random)]:
        candidate = problem.evaluate([start])[0]
        morph = morph_of_pairs(SHAPES[initial], SHAPES[final], problem.pairs(candidate))
        for time, swell in zip(times, problem.swells(candidate, times), strict=True):
            if swell < NEVER:
                assert connectedness(morph.at(time, time, swell)).state == Connectedness.CONNECTED
            if swell > 0:
                assert connectedness(morph.at(time, time, 0.0)).state != Connectedness.CONNECTED
            assert swell in (*LEVELS, NEVER)


def test_a_bound_changes_no_score_below_it():
    problem = problem_of("terdragon", "gasket")
    random = np.random.default_rng(2)
    starts = [problem.shuffled(random) for _ in range(60)]
    whole = np.array([candidate.score for candidate in problem.evaluate(starts)])
    best = problem.evaluate(starts[:1])[0]
    found = problem.best_of(starts, best)
    assert found.score == pytest.approx(whole.min())


def test_scores_do_not_depend_on_threads():
    ends = problem_of("gasket", "Koch curve").ends
    found = []
    for threads in (1, 2, 5):
        problem = Problem(*ends, 1 / 300, (), threads)
        random = np.random.default_rng(2)
        starts = [problem.shuffled(random) for _ in range(30)]
        found.append(([candidate.score for candidate in problem.evaluate(starts)], problem.work))
    assert found[0] == found[1] == found[2]


def test_samples_are_even_however_many():
    for count in (5, 12, 40):
        gaps = np.diff(np.sort(np.concatenate([[0], golden_samples(count), [1]])))
        assert gaps.max() < 3 / count
