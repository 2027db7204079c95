"""Runs scripts in a Blender of its own that has the extension of this session and the same user folder."""

import subprocess
import sys

PACKAGE = "bl_ext.user_default.ifs_morph"

START = f"import sys\nimport bpy\nimport addon_utils\naddon_utils.enable('{PACKAGE}')\n"

# Blender crashes or hangs at exit while a Python handler is registered.
END = f"\naddon_utils.disable('{PACKAGE}')\n"


def run(script, *arguments, start=START, end=END):
    """Run a script with the extension enabled, its arguments in `sys.argv`; what it printed."""
    process = subprocess.run(
        [sys.executable, "-c", start + script + end, *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert process.returncode == 0, process.stdout + process.stderr
    assert "Traceback" not in process.stderr, process.stderr
    return process.stdout
