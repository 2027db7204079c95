"""Any shape into any shape: the stages of a match, from the naive morph to the best that the budget finds."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import parallel
from ..connectedness import Connectedness
from ..ifs import IFS, IFSError
from ..joining import Word
from ..morph import Morph, spread
from ..path import Path, plan_path_steps
from ..report import check_frames_steps
from ..space.lifting import in_one_space
from .account import MatchReport
from .constraints import settled_words
from .pairs import Pair, morph_of_pairs, reversed_pairs
from .problem import Candidate, End, Problem
from .problems import problems
from .recurrent import problem_of
from .scoring import MEAN, WORST
from .search import GOOD, search_steps
from .symmetry import symmetries

BUDGET = 600_000
"""Work of the search, in shapes decided times their pairs of maps: a few seconds for shapes that are hard to match."""

ROUNDS = 8
"""How often the search goes on with more samples where a dense check found what the samples had missed."""

MISSED = 3
"""Samples added a round."""

PLANNED = 2
"""Candidates for which a path is planned where the straight line needs swell."""

DEFAULT_SCHEMES = ("polar", "log-polar")
"""Tried where none is asked for; the second with the best candidate only."""

PLANNED_MAPS = 9
"""With more maps than this a plan takes too long, and gains little over the straight line."""

RECURRENT_MAPS = 2
"""Maps that one of a recurrent morph counts for in that, for they take longer to decide."""

LENGTH_SAMPLES = 241
"""Times between which paths are measured as if straight."""

LONGER = 0.02
"""What a path twice as long as the straight line costs."""


@dataclass(frozen=True, eq=False)
class Match:
    """A morph between two shapes, with the path through it.

    Attributes
    ----------
    morph : Morph
        Its ends have the attractors of the shapes given, but maybe more maps, and others.
    path : Path
        ``morph.at(*path.at(t))`` is the IFS at the time t.
    report : MatchReport
    pairs : tuple of Pair
        What `morph` was made of; `morph_of_pairs` makes it again without a search.
    cost : float
        By which matches are compared: swell above all, then turning, flips and the length of the path.
    """

    morph: Morph
    path: Path
    report: MatchReport
    pairs: tuple[Pair, ...]
    cost: float


def match(
    initial: IFS,
    final: IFS,
    frames: int = 240,
    tolerance: float = 1 / 300,
    locked: Sequence[Pair] = (),
    initial_words: Sequence[Word] | None = None,
    final_words: Sequence[Word] | None = None,
    scheme: str | None = None,
    flip: str = "projected",
    budget: int = BUDGET,
    threads: int | None = None,
    progress: Callable[[float], bool | None] | None = None,
    found: Callable[[Match], None] | None = None,
) -> Match:
    """Find a morph from one shape to another that stays in one piece and swells as little as can be.

    Parameters
    ----------
    initial, final : IFS
        Any two with attractors, of the plane or of space; their numbers of maps and orientations may differ.
    frames : int
        Of the animation; each is checked.
    tolerance : float
        Relative to the enclosing diameter.
    locked : sequence of Pair
        Pairs that the result is to have. A symmetry or winding of None is left open.
    initial_words, final_words : sequence of tuple of int, optional
        The pieces of each shape to use, each once; by default its maps, split where that helps.
    scheme : str, optional
        Of the morph, see `morph.SCHEMES`; by default the polar one, or the log-polar where that swells less. The search
        itself goes by the polar one.
    flip : str
        What becomes of a map of the plane that reflects at one end only, where neither symmetries nor splits mend that,
        see `space.lifting.FLIPS`. The search itself goes by the projected one.
    budget : int
        Work of the search. It is counted, not timed: the result is the same on every machine, for any number of
        threads.
    threads : int, optional
        None for all processors.
    progress : callable, optional
        Told the share done; returning False cancels with `parallel.Cancelled`.
    found : callable, optional
        Given each match that is better than those before, the first after a moment, so that a caller who stops early
        has something to show.

    Returns
    -------
    Match

    Raises
    ------
    IFSError
        If an end has no attractor, or what is locked does not fit the shapes.
    ValueError
        If there are fewer than 2 frames or the tolerance is not above 0.
    """
    steps = match_steps(
        initial, final, frames, tolerance, locked, initial_words, final_words, scheme, flip, budget, threads, found
    )
    return parallel.finish(steps, progress)


def match_steps(
    initial: IFS,
    final: IFS,
    frames: int = 240,
    tolerance: float = 1 / 300,
    locked: Sequence[Pair] = (),
    initial_words: Sequence[Word] | None = None,
    final_words: Sequence[Word] | None = None,
    scheme: str | None = None,
    flip: str = "projected",
    budget: int = BUDGET,
    threads: int | None = None,
    found: Callable[[Match], None] | None = None,
) -> Generator[float, None, Match]:
    """`match` in steps, each yielding the share done."""
    if frames < 2:
        raise ValueError(f"A morph over {frames} frames cannot be matched; it needs 2 or more.")
    if not tolerance > 0:
        raise ValueError(f"The tolerance is {tolerance:g}; it must be above 0.")
    initial, final = in_one_space(initial, final)
    initial.require_attractor()
    final.require_attractor()
    settled = (
        settled_words(initial, "initial", initial_words, [pair.initial for pair in locked]),
        settled_words(final, "final", final_words, [pair.final for pair in locked]),
    )
    free = not locked and settled == (None, None)

    naive = tuple(Pair((k % initial.count,), (k % final.count,)) for k in range(max(initial.count, final.count)))
    naive_morph = morph_of_pairs(initial, final, naive, flip=flip)
    straight = yield from parallel.part(
        plan_path_steps(naive_morph, None, frames, tolerance, "straight", threads), 0.0, 0.05
    )
    times = np.arange(frames) / (frames - 1)
    line = np.column_stack([times, times, np.zeros(frames)])
    element_wise = yield from parallel.part(
        check_frames_steps(morph_of_pairs(initial, final, naive, "elementwise"), line, tolerance, threads), 0.05, 0.08
    )

    def as_match(pairs: tuple[Pair, ...], morph: Morph, path: Path, other: float, work: int) -> Match:
        report = MatchReport(
            path.report,
            element_wise,
            straight.report.straight,
            (straight.report.path.most_swell, straight.report.path.mean_swell),
            pairs,
            (initial.count, final.count),
            morph.count - len(pairs),
            work,
        )
        return Match(morph, path, report, pairs, path_cost(path) + other)

    ends = [
        End(ifs, symmetries(ifs), words or [(i,) for i in range(ifs.count)])
        for ifs, words in zip((initial, final), settled, strict=True)
    ]
    best = None
    if free and scheme in (None, DEFAULT_SCHEMES[0]):
        given = problem_of(*ends, tolerance, (), threads)
        start = given.evaluate(given.starts()[:1])[0]
        best = as_match(naive, naive_morph, straight, start.cost_beside_swell, 0)
        if found is not None:
            found(best)
    yield 0.1

    # The same search both ways, so that a morph and its reverse are made of the same pairs.
    backwards = free and _order(final) < _order(initial)
    fixed = [words is not None for words in settled]
    searches = problems(ends[::-1] if backwards else ends, fixed, locked, tolerance, threads)
    tops: list[tuple[float, int, Candidate]] = []
    for k, problem in enumerate(searches):
        start, share = 0.1 + 0.6 * k / len(searches), 0.6 / len(searches)
        # Half of what is left, and the last one all of it: the first is the simplest, and most often enough.
        left = budget - sum(other.work for other in searches)
        verifying = _verified_steps(problem, frames, left if problem is searches[-1] else left // 2)
        verified = yield from parallel.part(verifying, start, start + share)
        tops += [(cost, k, candidate) for cost, candidate in verified]
        if verified[0][0] < GOOD and verified[0][1].spotless:
            break
    tops.sort(key=lambda each: each[:2])
    work = sum(problem.work for problem in searches)
    # No path stays connected that begins or ends in pieces.
    whole = (straight.report.path.state[[0, -1]] == Connectedness.CONNECTED).all()
    schemes = DEFAULT_SCHEMES if scheme is None else (scheme,)
    plans = [
        (top, method, each)
        for method in ("straight", "planned", "per map")
        for each in schemes
        for top in tops[: PLANNED if each == schemes[0] else 1]
    ]
    for rank, ((_, k, candidate), method, chosen) in enumerate(plans):
        spotless = best is not None and best.report.spotless
        # What costs this much beside swell cannot be the best.
        if spotless and (method == "per map" or candidate.cost_beside_swell >= best.cost):
            continue
        pairs = searches[k].pairs(candidate)
        if backwards:
            pairs = reversed_pairs(final, initial, pairs)
        try:
            morph = morph_of_pairs(initial, final, pairs, chosen, flip)
        except IFSError:
            # Flat maps have no logarithm.
            if scheme is not None:
                raise
            continue
        plannable = whole and morph.count * (RECURRENT_MAPS if morph.is_recurrent else 1) <= PLANNED_MAPS
        # In space the rest takes too long.
        passed_by = morph.DIMENSION == 3 and (method == "per map" or chosen != schemes[0])
        if passed_by or (method != "straight" and not plannable):
            continue
        planning = plan_path_steps(morph, None, frames, tolerance, method, threads)
        at = 0.7 + 0.3 * rank / len(plans)
        path = yield from parallel.part(planning, at, at + 0.3 / len(plans))
        new = as_match(pairs, morph, path, candidate.cost_beside_swell, work)
        if best is None or (_no_worse(new, straight if free else None) and _before(new, best)):
            best = new
            if found is not None:
                found(best)
        yield at + 0.3 / len(plans)
    return best


def _order(ifs: IFS) -> tuple:
    return ifs.count, ifs.maps.tobytes()


def path_cost(path: Path) -> float:
    """What a path costs by swell and by going round, each map for itself."""
    maps = 1 if path.offset_keys is None else path.offset_keys.value.shape[2]
    u, v, _ = spread(path.sample(np.linspace(0, 1, LENGTH_SAMPLES)), maps)
    length = float(np.hypot(np.diff(u, axis=0), np.diff(v, axis=0)).sum(axis=0).mean())
    check = path.report.path
    return WORST * check.most_swell + MEAN * check.mean_swell + LONGER * (length / math.sqrt(2) - 1)


def _no_worse(new: Match, straight: Path | None) -> bool:
    """Whether a match is no worse than the naive straight one, in swell and in frames not in one piece."""
    if straight is None:
        return True
    check = straight.report.path
    broken = len(check.state) - check.count(Connectedness.CONNECTED)
    return (
        new.report.disconnected <= broken
        and new.report.most_swell <= check.most_swell
        and new.report.mean_swell <= check.mean_swell
    )


def _before(new: Match, best: Match) -> bool:
    return (new.report.disconnected, new.cost) < (best.report.disconnected, best.cost)


def _verified_steps(
    problem: Problem, frames: int, budget: int
) -> Generator[float, None, list[tuple[float, Candidate]]]:
    """Search, check densely, and search on with the times that the samples had missed; the best and their costs."""
    begun = problem.work
    checks = max(2, problem.scoring.CHECKS * (frames - 1))
    times = np.arange(1, checks) / checks
    kept: list[tuple[float, Candidate]] = []
    start = None
    for _ in range(ROUNDS):
        left = begun + budget - problem.work
        done = 1 - left / budget
        searching = search_steps(problem, left, start)
        found = yield from parallel.part(searching, done, 1.0)
        for candidate in found:
            swells = problem.swells(candidate, times)
            cost = WORST * float(swells.max()) + MEAN * float(swells.mean()) + candidate.cost_beside_swell
            kept.append((cost, replace(candidate, swells=swells)))
        missed = _missed(times, kept[-len(found)][1].swells - found[0].swells.max())
        if len(missed) == 0 or problem.work >= begun + budget:
            break
        problem.look_at(missed)
        start = found[0]
    kept.sort(key=lambda each: each[0])
    lean = [each for each in kept if each[1].rows.shape[1] == problem.least]
    return [kept[0]] if not lean or lean[0] is kept[0] else [kept[0], lean[0]]


def _missed(times: np.ndarray, excess: np.ndarray) -> np.ndarray:
    """Times of the greatest excess, above 0 and not close to each other."""
    found: list[float] = []
    for k in np.argsort(-excess, kind="stable"):
        if excess[k] <= 0 or len(found) == MISSED:
            break
        if all(abs(times[k] - other) > 0.02 for other in found):
            found.append(float(times[k]))
    return np.array(found)
