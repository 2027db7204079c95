"""Puts the checkout on the import path, so that tests read ``from core.ifs import IFS`` as a program would."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
