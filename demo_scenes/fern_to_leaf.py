"""Fern to leaf: Barnsley's fern becomes a maple leaf, as a cloud of points that are lit and cast shadows.

Every point keeps its address from the first frame to the last, so the cloud flows and does not flicker.
"""

from .stage import BY_LOCUS, add_morph, color_maps, color_world

TITLE = "Fern to leaf"
BUTTONS = BY_LOCUS
COLORS = ((0.32, 0.16, 0.05), (0.06, 0.34, 0.07), (0.2, 0.5, 0.06), (0.62, 0.3, 0.03))


def build(frames: int, size: int):
    """Build the scene and return the morph object; its path is still to be planned."""
    owner = add_morph("POINTS", "Barnsley fern", "maple leaf", frames, size)
    color_maps(owner, COLORS, COLORS)
    owner.ifs_morph.output.point_count = 60_000
    # Flat on the floor: a map that turns over through space makes a locus in space, which takes long.
    owner.ifs_morph.flip = "PROJECTED"
    color_world((0.02, 0.024, 0.03))
    return owner
