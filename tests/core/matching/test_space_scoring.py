"""In space, too, the score is what the morph says, one sample after the other."""

import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.matching.expansion import split_to
from core.matching.pairs import morph_of_pairs
from core.matching.problem import End, Problem
from core.matching.scoring import LEVELS, NEVER
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from core.space.lifting import lift
from core.space.shapes import SPACE_SHAPES

ALL = SPACE_SHAPES | {"gasket": lift(SHAPES["gasket"]), "terdragon": lift(SHAPES["terdragon"])}


def problem_of(initial, final, threads=None):
    ends = [End(ALL[name], symmetries(ALL[name]), split_to(ALL[name], 0)) for name in (initial, final)]
    return Problem(*ends, 1 / 300, (), threads)


@pytest.mark.parametrize("names", [("turned tetrahedron", "Sierpinski tetrahedron"), ("terdragon", "gasket")])
def test_swells_are_those_of_the_morph(names):
    problem = problem_of(*names)
    random = np.random.default_rng(5)
    times = np.linspace(0.07, 0.93, 5)
    for start in [problem.starts()[0], problem.shuffled(random), problem.shuffled(random)]:
        candidate = problem.evaluate([start])[0]
        morph = morph_of_pairs(*(ALL[name] for name in names), problem.pairs(candidate))
        for time, swell in zip(times, problem.swells(candidate, times), strict=True):
            assert swell in (*LEVELS, NEVER)
            if swell < NEVER:
                assert connectedness(morph.at(time, time, swell)).state == Connectedness.CONNECTED
            if swell > 0:
                assert connectedness(morph.at(time, time, 0.0)).state != Connectedness.CONNECTED


def test_scores_are_like_those_of_the_plane():
    """On the floor, where nothing reflects, but for the volumes that stand in for areas."""
    lifted = problem_of("terdragon", "gasket")
    plane = [End(SHAPES[name], symmetries(SHAPES[name]), [(0,), (1,), (2,)]) for name in ("terdragon", "gasket")]
    plane = Problem(*plane, 1 / 300)
    for problem in (plane, lifted):
        problem.look_at(np.linspace(0.05, 0.95, 30))
    start = np.array([[0, 1, 2], [0, 2, 1]])
    found = [
        problem.evaluate([(start * np.array([[size] for size in problem.sizes]), np.zeros(3, int))])[0]
        for problem in (plane, lifted)
    ]
    assert found[1].swells == pytest.approx(found[0].swells, abs=0.1)
    assert found[1].cost_beside_swell == pytest.approx(found[0].cost_beside_swell, abs=0.02)


def test_a_bound_changes_no_score_below_it_and_threads_none_at_all():
    scores = []
    for threads in (1, 3):
        problem = problem_of("turned tetrahedron", "pyramid", threads)
        random = np.random.default_rng(2)
        starts = [problem.shuffled(random) for _ in range(20)]
        whole = np.array([candidate.score for candidate in problem.evaluate(starts)])
        best = problem.evaluate(starts[:1])[0]
        assert problem.best_of(starts, best).score == pytest.approx(whole.min())
        scores.append((whole.tolist(), problem.work))
    assert scores[0] == scores[1]
