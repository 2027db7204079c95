"""How benchmarks take times and memory."""

import subprocess
import sys
import time
from pathlib import Path

MEMORY_IS_TOLD = Path("/proc/self/clear_refs").exists()
"""Whether the system tells a process its peak; Linux does."""

ROOT = Path(__file__).parents[2]

PEAK = """
from pathlib import Path

def kilobytes(field):
    return int(next(line for line in Path("/proc/self/status").read_text().splitlines() if field in line).split()[1])

{setup}
Path("/proc/self/clear_refs").write_text("5")  # Peak from here on.
before = kilobytes("VmRSS")
{work}
print(kilobytes("VmHWM") - before)
"""


def fastest(function, rounds=5, clock=time.perf_counter):
    """Return the least time of some calls, in seconds; one more is made before, to compile kernels.

    The processor's time, ``time.process_time``, is the fairer `clock` for one thread beside other programs.
    """
    function()
    times = []
    for _ in range(rounds):
        started = clock()
        function()
        times.append(clock() - started)
    return min(times)


def python(script, *arguments):
    """Run a script in a process of its own, at the root of the checkout; what it printed."""
    command = [sys.executable, "-c", script, *map(str, arguments)]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


def peak_memory(setup, work):
    """Return the bytes that some work takes at its peak, beyond what its process had before.

    Parameters
    ----------
    setup : str
        Lines of Python that import what is needed, and do the work once at a small size: that compiles the kernels.
    work : str
        Lines of Python.
    """
    return 1024 * int(python(PEAK.format(setup=setup, work=work)).split()[-1])
