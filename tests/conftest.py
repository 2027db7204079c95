"""Puts the checkout on the import path, so that tests read ``from core.ifs import IFS`` as a program would.

Runs folders of tests in a process for each processor, and single files in one. Kernels are compiled before there are
several processes to do it, and are kept from session to session: once for the checkout, once for the extension.
"""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGES = ("core", "bl_ext.user_default.ifs_morph.core")

# Empty packages stand in for the parents of the extension's core, which need Blender.
COMPILE = """
import importlib, sys, types
package, folder = sys.argv[1:]
parents = package.split(".")[:-1]
for end in range(1, len(parents) + 1):
    module = types.ModuleType(".".join(parents[:end]))
    module.__path__ = [folder]
    sys.modules[module.__name__] = module
warm_up = importlib.import_module(package + ".warm_up")
warm_up.run(*warm_up.PARTS)
"""

sys.path.insert(0, str(ROOT))
os.environ.setdefault("NUMBA_CACHE_DIR", str(ROOT / "out" / "tests" / "kernels"))


def pytest_xdist_auto_num_workers(config):
    """No further processes for tests that are chosen by file: these are soon done, or are benchmarks."""
    are_files = all(Path(argument.partition("::")[0]).is_file() for argument in config.args)
    return 0 if are_files else None


def pytest_sessionstart(session):
    """Compile the kernels; what fails here fails in a test, too."""
    if session.config.option.numprocesses:
        commands = [[sys.executable, "-c", COMPILE, package, str(ROOT)] for package in PACKAGES]
        for process in [subprocess.Popen(command, cwd=ROOT) for command in commands]:
            process.wait()
