"""Figures that a benchmark finds besides times are shown in a table of their own, and kept in the JSON."""

import pytest

FIGURES = pytest.StashKey[dict]()


def pytest_configure(config):
    config.stash[FIGURES] = {}


@pytest.fixture
def figure(request, benchmark):
    """Return a function that keeps a figure of a benchmark by name, such as how many times faster it was."""

    def keep(name, value, unit=""):
        benchmark.extra_info[name] = value
        request.config.stash[FIGURES].setdefault(request.node.name, []).append(f"{name}: {value:.4g}{unit}")

    return keep


def pytest_terminal_summary(terminalreporter, config):
    figures = config.stash[FIGURES]
    if figures:
        terminalreporter.section("figures, each from one run")
        for name, lines in figures.items():
            terminalreporter.write_line(f"{name.removeprefix('test_'):44s} {'   '.join(lines)}")
