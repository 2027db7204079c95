"""Chunks of work over a thread pool, with progress and cancel.

Work is cut into chunks whose kernels release the interpreter lock. No thread outlives a step, so a caller may stop
between two steps and leave nothing running; Blender needs that of its operators and handlers.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

Result = TypeVar("Result")

STEP_SECONDS = 0.05
"""After this time a thread begins no other chunk within a step, so that a window stays responsive."""


class Cancelled(Exception):
    """The caller's progress function asked for the work to stop."""


def thread_count(threads: int | None = None) -> int:
    """Threads to use: as many as asked for, or one for each processor that this process may run on."""
    if threads is not None:
        return max(1, int(threads))
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def steps(
    function: Callable[[Any], Result], chunks: Sequence[Any], threads: int | None = None
) -> Generator[float, None, list[Result]]:
    """Call `function` on every chunk, over threads that are joined before each yield.

    Parameters
    ----------
    function
        Called once for each chunk. Must release the interpreter lock to gain from threads.
    chunks
        The arguments, one for each call; each should take well under a tenth of a second. Else let the function be a
        generator that yields wherever it may pause, and returns the result.
    threads
        How many calls may run at once; None for all processors.

    Yields
    ------
    float
        The share of chunks done, in (0, 1], about every 50 milliseconds.

    Returns
    -------
    list
        The results in the order of `chunks`, whatever the number of threads.
    """
    workers = min(thread_count(threads), len(chunks))
    results: list[Result] = [None] * len(chunks)
    following = iter(range(len(chunks)))
    paused: list[tuple[int, Generator]] = []
    done = 0

    def work(deadline: float) -> int:
        """Take the next chunk that no other thread has, until the time is up; the number of chunks done."""
        finished = 0
        while True:
            try:
                index, result = paused.pop()
            except IndexError:
                index = next(following, None)
                if index is None:
                    return finished
                result = function(chunks[index])
            while isinstance(result, Generator):
                try:
                    next(result)
                except StopIteration as ended:
                    result = ended.value
                    break
                if time.perf_counter() >= deadline:
                    paused.append((index, result))
                    return finished
            results[index] = result
            finished += 1
            if time.perf_counter() >= deadline:
                return finished

    while done < len(chunks):
        deadlines = [time.perf_counter() + STEP_SECONDS] * workers
        done += sum(run(work, deadlines, workers))
        yield done / len(chunks)
    return results


def run(function: Callable[[Any], Result], chunks: Sequence[Any], threads: int | None = None) -> list[Result]:
    """`function` of every chunk in order, over threads, joined before it returns."""
    threads = min(thread_count(threads), len(chunks))
    if threads <= 1:
        return [function(chunk) for chunk in chunks]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(function, chunks))


def finish(generator: Generator[float, None, Result], progress: Callable[[float], bool | None] | None = None) -> Result:
    """Run a generator of steps to its end.

    Parameters
    ----------
    generator
        Yields the share of work done and returns the result.
    progress
        Told each share; returning False cancels.

    Raises
    ------
    Cancelled
        If `progress` returned False. Nothing keeps running.
    """
    while True:
        try:
            fraction = next(generator)
        except StopIteration as done:
            return done.value
        if progress is not None and progress(fraction) is False:
            generator.close()
            raise Cancelled


def part(generator: Generator[float, None, Result], start: float, end: float) -> Generator[float, None, Result]:
    """Pass on the steps of one part of some work, as shares from `start` to `end` of the whole."""
    while True:
        try:
            fraction = next(generator)
        except StopIteration as done:
            return done.value
        yield start + (end - start) * fraction
