"""Turned gasket to gasket: the example of the paper's Figures 3 and 4, led through the locus.

The lower left map turns by half a turn. Straight from (0,0) to (1,1) the shape is in pieces most of the way; the path
goes round through the connected part of the locus.
"""

from .stage import BACKGROUND, BY_LOCUS, add_morph, color_maps

TITLE = "Turned gasket to gasket"
BUTTONS = BY_LOCUS
COLORS = ((1.0, 0.32, 0.13), (0.16, 0.62, 1.0), (1.0, 0.8, 0.22))


def build(frames: int, size: int):
    """Build the scene and return the morph object; its path is still to be planned."""
    owner = add_morph("IMAGE", "turned gasket", "gasket", frames, size)
    color_maps(owner, COLORS, COLORS)
    owner.ifs_morph.output.mode = "ATTRACTORLET"
    # Twice the pixels of the render: its own samples do for antialiasing.
    owner.ifs_morph.output.resolution = 2 * size, 2 * size
    owner.ifs_morph.output.antialiasing = 1
    owner.ifs_morph.output.background = *BACKGROUND, 1.0
    return owner
