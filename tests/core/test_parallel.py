"""The thread pool: results in order, any number of threads, and nothing left running."""

import threading
import time
from itertools import pairwise

import pytest

from core import parallel
from core.parallel import Cancelled, finish, part, run, steps, thread_count

every_count = pytest.mark.parametrize("threads", [1, 2, 3, 7, None])


def uneven(k):
    """Square a number, the earlier ones slowest, so that a wrong order would show."""
    time.sleep(0.003 * (k % 4 == 0))
    return k * k


@every_count
def test_run_returns_results_in_the_order_of_the_chunks(threads):
    assert run(uneven, range(25), threads) == [k * k for k in range(25)]


@every_count
def test_steps_return_results_in_the_order_of_the_chunks(threads):
    assert finish(steps(uneven, range(25), threads)) == [k * k for k in range(25)]


@every_count
@pytest.mark.parametrize("chunks", [[], [3]])
def test_few_chunks(threads, chunks):
    assert run(uneven, chunks, threads) == [k * k for k in chunks]
    assert finish(steps(uneven, chunks, threads)) == [k * k for k in chunks]


@every_count
def test_every_chunk_is_done_once(threads):
    done = []
    finish(steps(done.append, range(40), threads))
    assert sorted(done) == list(range(40))


@every_count
def test_progress_rises_to_one(threads):
    told = []
    finish(steps(lambda k: time.sleep(0.005), range(40 * thread_count(threads)), threads), told.append)
    assert told[-1] == 1
    assert all(0 < share <= 1 for share in told)
    assert all(before < after for before, after in pairwise(told))
    assert len(told) > 1


@every_count
def test_cancel_leaves_nothing_running_and_no_more_is_done(threads):
    before = threading.active_count()
    done, told = [], []

    def work(k):
        time.sleep(0.01)
        done.append(k)

    def stop_at_once(share):
        told.append(share)
        return False

    with pytest.raises(Cancelled):
        finish(steps(work, range(1000), threads), stop_at_once)
    assert threading.active_count() == before
    assert len(told) == 1
    count = len(done)
    assert count < 1000
    time.sleep(0.05)
    assert len(done) == count


def test_cancel_closes_the_generator():
    closed = []

    def generator():
        try:
            yield 0.5
            yield 1.0
        finally:
            closed.append(True)

    with pytest.raises(Cancelled):
        finish(generator(), lambda share: False)
    assert closed == [True]


@pytest.mark.parametrize("answer", [None, True, 0])
def test_only_false_cancels(answer):
    assert finish(steps(uneven, range(3), 1), lambda share: answer) == [0, 1, 4]


@pytest.mark.parametrize("threads", [2, 5])
def test_no_thread_lives_between_two_steps(threads):
    before = threading.active_count()
    for _ in steps(lambda k: time.sleep(0.01), range(40), threads):
        assert threading.active_count() == before


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("way", [run, lambda *arguments: finish(steps(*arguments))])
def test_an_error_in_a_chunk_reaches_the_caller(threads, way):
    before = threading.active_count()

    def fail(k):
        if k == 5:
            raise ZeroDivisionError(k)
        return k

    with pytest.raises(ZeroDivisionError):
        way(fail, range(20), threads)
    assert threading.active_count() == before


def test_chunks_run_at_once_on_threads():
    meeting = threading.Barrier(3, timeout=10)
    run(lambda k: meeting.wait(), range(3), 3)
    finish(steps(lambda k: meeting.wait(), range(3), 3))


def test_thread_count(monkeypatch):
    assert thread_count(5) == 5
    assert thread_count(0) == thread_count(-3) == 1
    assert thread_count() >= 1
    monkeypatch.delattr(parallel.os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(parallel.os, "cpu_count", lambda: None)
    assert thread_count() == 1


def test_a_part_of_the_work_is_a_part_of_the_whole():
    def work():
        yield 0.5
        yield 1.0
        return "done"

    shares = []
    assert finish(part(work(), 0.2, 0.6), shares.append) == "done"
    assert shares == pytest.approx([0.4, 0.6])


@every_count
def test_chunks_may_pause_and_go_on(threads):
    def paused(k):
        for _ in range(k % 4):
            time.sleep(0.02)
            yield
        return k * k

    shares = []
    assert finish(steps(paused, range(12), threads), shares.append) == [k * k for k in range(12)]
    assert shares[-1] == 1
    assert sorted(shares) == shares


def test_a_long_chunk_does_not_hold_a_step_up():
    def paused(k):
        for _ in range(20):
            time.sleep(0.01)
            yield
        return k

    # Were it not paused, it would be one step.
    assert len(list(steps(paused, range(2), 1))) >= 4
