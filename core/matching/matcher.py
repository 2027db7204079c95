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
from ..locus import compute_locus_steps
from ..morph import Morph, spread
from ..path import Path, plan_path_steps
from ..report import FrameCheck, check_frames_steps
from ..space.lifting import in_one_space
from .account import MatchReport
from .constraints import locks_of, settled_words
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

PLANNED_MAPS = {2: 16, 3: 9}
"""With more maps than this a plan takes too long, by dimensions."""

HARD = 0.1
"""Share of the frames of the naive morph that may be undecided; with more of them a plan in space takes too long."""

RECURRENT_MAPS = 2
"""Maps that one of a recurrent morph counts for in that, for they take longer to decide."""

LOCUS_RESOLUTION = {2: 130, 3: 31}
"""Nodes along u of the locus that paths are planned on, by dimensions; what is planned is tested far more densely."""

WORTH = 0.05
"""What another plan must be able to save, once nothing swells any more."""

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
        If there are fewer than 2 frames, or the tolerance or the budget is not above 0.
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
    if budget < 1:
        raise ValueError(f"A budget of {budget} allows no search; it must be 1 or more.")
    if not tolerance > 0:
        raise ValueError(f"The tolerance is {tolerance:g}; it must be above 0.")
    initial, final = in_one_space(initial, final)
    initial.require_attractor()
    final.require_attractor()
    settled = (
        settled_words(initial, "initial", initial_words, [pair.initial for pair in locked]),
        settled_words(final, "final", final_words, [pair.final for pair in locked]),
    )
    ends = [
        End(ifs, symmetries(ifs), words or [(i,) for i in range(ifs.count)])
        for ifs, words in zip((initial, final), settled, strict=True)
    ]
    naive = tuple(Pair((k % initial.count,), (k % final.count,)) for k in range(max(initial.count, final.count)))
    naive_morph = morph_of_pairs(initial, final, naive, flip=flip)
    unswollen = yield from parallel.part(
        plan_path_steps(naive_morph, None, frames, tolerance, "straight unswollen", threads), 0.0, 0.02
    )
    polar, straight, element_wise = unswollen.report.path, None, None
    free = not locked and settled == (None, None)
    best = None

    def swell_of(path: Path | None) -> tuple[float, float] | None:
        return None if path is None else (path.report.path.most_swell, path.report.path.mean_swell)

    def offer(pairs: tuple[Pair, ...], morph: Morph, path: Path, cost_beside: float, work: int = 0) -> Match:
        """Take what was found if it is the best yet, and tell of it."""
        nonlocal best
        report = MatchReport(
            path.report,
            polar,
            element_wise,
            swell_of(straight),
            len(naive_morph.flips + naive_morph.turned_over),
            pairs,
            (initial.count, final.count),
            morph.count - len(pairs),
            work,
        )
        new = Match(morph, path, report, pairs, path_cost(path) + cost_beside)
        if best is None or (_no_worse(new, straight if free else None) and _before(new, best)):
            best = new
            if found is not None:
                found(best)
        return new

    # The simplest that the user's choices allow, so that there is something at once.
    given = problem_of(*ends, tolerance, locks_of(locked, ends), threads)
    first, path = naive_morph, unswollen
    pairs, beside = given.first()
    if not free or scheme not in (None, DEFAULT_SCHEMES[0]):
        first = morph_of_pairs(initial, final, pairs, scheme or DEFAULT_SCHEMES[0], flip)
        path = yield from parallel.part(
            plan_path_steps(first, None, frames, tolerance, "straight unswollen", threads), 0.02, 0.04
        )
    offer(pairs, first, path, beside)
    straight = unswollen
    plain_morph = morph_of_pairs(initial, final, naive, "elementwise")
    checking = check_frames_steps(plain_morph, polar.uv_swell, tolerance, threads)
    element_wise = yield from parallel.part(checking, 0.04, 0.06)
    if unswollen.report.broken:
        straight = yield from parallel.part(
            plan_path_steps(naive_morph, None, frames, tolerance, "straight", threads), 0.06, 0.1
        )
        if first is naive_morph:
            offer(pairs, first, straight, beside)

    # The same search both ways, so that a morph and its reverse are made of the same pairs.
    backwards = free and _order(final) < _order(initial)
    fixed = [words is not None for words in settled]
    searches = problems(ends[::-1] if backwards else ends, fixed, locked, tolerance, threads)
    tops = yield from parallel.part(_searched_steps(searches, frames, budget), 0.1, 0.7)
    work = sum(problem.work for problem in searches)
    # No path stays connected that begins or ends in pieces.
    whole = (polar.state[[0, -1]] == Connectedness.CONNECTED).all()
    schemes = DEFAULT_SCHEMES if scheme is None else (scheme,)
    plans = [
        (top, method, each)
        for method in ("straight", "planned", "per map")
        for each in schemes
        for top in tops[: PLANNED if each == schemes[0] else 1]
    ]
    leading = None
    for rank, ((problem, candidate), method, chosen) in enumerate(plans):
        # What costs this much beside swell cannot be the best.
        dearest = candidate.cost_beside_swell + (0.0 if method == "straight" else WORTH)
        if best.report.spotless and dearest >= best.cost:
            continue
        pairs = problem.pairs(candidate)
        if backwards:
            pairs = reversed_pairs(final, initial, pairs)
        try:
            morph = morph_of_pairs(initial, final, pairs, chosen, flip)
        except IFSError:
            # Flat maps have no logarithm.
            if scheme is not None:
                raise
            continue
        if method != "straight" and not (whole and _is_plannable(morph, method, polar)):
            continue
        # In space only the best of the straight ones is planned for; the rest takes too long.
        if morph.DIMENSION == 3 and (chosen != schemes[0] or (method != "straight" and pairs != leading.pairs)):
            continue
        at = 0.7 + 0.3 * rank / len(plans)
        planning = _planned_steps(morph, frames, tolerance, method, threads)
        path = yield from parallel.part(planning, at, at + 0.3 / len(plans))
        tried = offer(pairs, morph, path, candidate.cost_beside_swell, work)
        if leading is None or _before(tried, leading):
            leading = tried
    if best.report.element_wise is None:
        # The first answer, which nothing could better.
        best = replace(best, report=replace(best.report, element_wise=element_wise, straight_swell=swell_of(straight)))
    return best


def _searched_steps(
    searches: Sequence[Problem], frames: int, budget: int
) -> Generator[float, None, list[tuple[Problem, Candidate]]]:
    """Search one problem after the other until something good is found; what was found, the best first."""
    tops: list[tuple[float, int, Candidate]] = []
    spent = 0
    for k, problem in enumerate(searches):
        # Half of what is left, and the last one all of it: the first is the simplest, and most often enough.
        left = budget - spent
        verifying = _verified_steps(problem, frames, left if problem is searches[-1] else max(1, left // 2))
        verified = yield from parallel.part(verifying, k / len(searches), (k + 1) / len(searches))
        tops += [(cost, k, candidate) for cost, candidate in verified]
        spent = sum(other.work for other in searches)
        if spent >= budget or (verified[0][0] < GOOD and verified[0][1].spotless):
            break
    tops.sort(key=lambda each: each[:2])
    return [(searches[k], candidate) for _, k, candidate in tops]


def _is_plannable(morph: Morph, method: str, naive: FrameCheck) -> bool:
    """Whether a plan takes no longer than people wait."""
    maps = morph.count * (RECURRENT_MAPS if morph.is_recurrent else 1)
    if maps > PLANNED_MAPS[morph.DIMENSION]:
        return False
    hard = naive.count(Connectedness.UNDECIDED) > HARD * len(naive.state)
    return morph.DIMENSION == 2 or (method == "planned" and not hard)


def _planned_steps(
    morph: Morph, frames: int, tolerance: float, method: str, threads: int | None
) -> Generator[float, None, Path]:
    """A path, planned on a coarser locus than otherwise."""
    locus, begun = None, 0.0
    if method == "planned":
        resolution, begun = LOCUS_RESOLUTION[morph.DIMENSION], 0.4
        computing = compute_locus_steps(morph, resolution, tolerance, threads=threads, gap=False)
        locus = yield from parallel.part(computing, 0.0, begun)
    return (yield from parallel.part(plan_path_steps(morph, locus, frames, tolerance, method, threads), begun, 1.0))


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
    """Whether a match is no worse than the naive straight one, in swell and in broken frames."""
    if straight is None:
        return True
    check = straight.report.path
    return (
        new.report.broken <= straight.report.broken
        and new.report.most_swell <= check.most_swell
        and new.report.mean_swell <= check.mean_swell
    )


def _before(new: Match, best: Match) -> bool:
    return (new.report.broken, new.cost) < (best.report.broken, best.cost)


def _verified_steps(
    problem: Problem, frames: int, budget: int
) -> Generator[float, None, list[tuple[float, Candidate]]]:
    """Search, check densely, and search on with the times that the samples had missed; the best and their costs."""
    begun = problem.work
    checks = max(2, round(problem.scoring.CHECKS * (frames - 1)))
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
