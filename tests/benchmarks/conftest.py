"""Figures that benchmarks find: one table at the end, and the same as JSON in ``out/benchmarks.json``.

A figure may have a bar. The table says which were missed, and then the session fails.
"""

import json
import platform
from dataclasses import asdict, dataclass
from itertools import groupby

import numpy as np
import pytest

from core import parallel
from tests.benchmarks.measuring import ROOT

FIGURES = pytest.StashKey[list]()
RESULT = ROOT / "out" / "benchmarks.json"


@dataclass
class Figure:
    """What a benchmark found.

    Attributes
    ----------
    file, subject, name : str
        The benchmark's file and name, and what was measured.
    value : float
    unit : str
    at_least, at_most : float or None
        The bar.
    """

    file: str
    subject: str
    name: str
    value: float
    unit: str
    at_least: float | None
    at_most: float | None

    @property
    def reached(self) -> bool:
        """Whether the value is within the bar."""
        low = -np.inf if self.at_least is None else self.at_least
        high = np.inf if self.at_most is None else self.at_most
        return low <= self.value <= high

    @property
    def bar(self) -> str:
        """The bar in words; empty where there is none."""
        limits = (("at least", self.at_least), ("at most", self.at_most))
        return ", ".join(f"{word} {limit:g}{self.unit}" for word, limit in limits if limit is not None)


def pytest_configure(config):
    config.stash[FIGURES] = []


@pytest.fixture
def figure(request):
    """Return ``keep(name, value, unit="", at_least=None, at_most=None)``, which keeps a figure and its bar.

    For example ``figure("times as fast", slow / fast, at_least=150)``.
    """
    subject = request.node.originalname.removeprefix("test_").replace("_", " ")
    if hasattr(request.node, "callspec"):
        subject += f": {', '.join(map(str, request.node.callspec.params.values()))}"

    def keep(name, value, unit="", at_least=None, at_most=None):
        found = Figure(request.node.path.stem, subject, name, float(value), unit, at_least, at_most)
        request.config.stash[FIGURES].append(found)

    return keep


@pytest.hookimpl(tryfirst=True)
def pytest_sessionfinish(session):
    """Write the figures down, and fail where one missed its bar."""
    figures = session.config.stash[FIGURES]
    if not figures:
        return
    machine = {
        "processors": parallel.thread_count(),
        "system": platform.platform(),
        "python": platform.python_version(),
    }
    rows = [{**asdict(each), "reached": each.reached if each.bar else None} for each in figures]
    RESULT.parent.mkdir(exist_ok=True)
    RESULT.write_text(json.dumps({"machine": machine, "figures": rows}, indent=1) + "\n")
    if not all(each.reached for each in figures):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter, config):
    figures = config.stash[FIGURES]
    if not figures:
        return
    missed = [each for each in figures if not each.reached]
    widths = [max(len(getattr(each, column)) for each in figures) for column in ("subject", "name", "bar")]
    for file, group in groupby(sorted(figures, key=lambda each: each.file), key=lambda each: each.file):
        terminalreporter.section(file.removeprefix("bench_"))
        subject = None
        for each in group:
            shown = "" if each.subject == subject else each.subject
            subject = each.subject
            verdict = "" if not each.bar else "reached" if each.reached else "MISSED"
            value = f"{_digits(each.value):>8}{each.unit:3}"
            line = f"{shown:{widths[0]}}  {each.name:{widths[1]}} {value} {each.bar:{widths[2]}}"
            terminalreporter.write(f"{line}  ")
            terminalreporter.line(verdict, red=verdict == "MISSED", green=verdict == "reached")
    terminalreporter.section("bars")
    count = sum(bool(each.bar) for each in figures)
    terminalreporter.line(f"{count - len(missed)} of {count} reached; all figures are in {RESULT.relative_to(ROOT)}")
    for each in missed:
        value = f"{_digits(each.value)}{each.unit}"
        terminalreporter.line(f"MISSED: {each.subject}, {each.name}: {value}, {each.bar}", red=True)


def _digits(value) -> str:
    """A number with three digits at least, and no exponent."""
    if value == 0 or not np.isfinite(value):
        return f"{value:g}"
    return f"{value:,.{max(0, 2 - int(np.floor(np.log10(abs(value)))))}f}"
