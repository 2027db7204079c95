"""Terdragon to gasket: two shapes between which no connected path exists in (u,v), joined by a little swell.

With the maps paired as they stand, the locus is made of vertical bands with a gap between. The maps swell on the way
just enough to close it.
"""

from .stage import BACKGROUND, BY_LOCUS, add_morph

TITLE = "Terdragon to gasket"
BUTTONS = BY_LOCUS


def build(frames: int, size: int):
    """Build the scene and return the morph object; its path is still to be planned."""
    owner = add_morph("IMAGE", "terdragon", "gasket", frames, size)
    owner.ifs_morph.output.mode = "DENSITY"
    # Twice the pixels of the render: its own samples do for antialiasing.
    owner.ifs_morph.output.resolution = 2 * size, 2 * size
    owner.ifs_morph.output.antialiasing = 1
    owner.ifs_morph.output.background = *BACKGROUND, 1.0
    return owner
