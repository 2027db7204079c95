"""Puts the checkout on the import path, so that tests read ``from core.ifs import IFS`` as a program would.

Runs folders of tests in a process for each processor, and single files in one.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))


def pytest_xdist_auto_num_workers(config):
    """No further processes for tests that are chosen by file: these are soon done, or are benchmarks."""
    are_files = all(Path(argument.partition("::")[0]).is_file() for argument in config.args)
    return 0 if are_files else None
