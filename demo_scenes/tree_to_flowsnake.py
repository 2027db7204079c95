"""Tree to flowsnake: two shapes that have nothing in common, joined by one press of Morph.

Hata's tree has two maps, which both reflect, and Gosper's flowsnake has seven, of which none does. Map by map in the
given order the tree falls to pieces. Split, listed again and turned by symmetries of the shapes the maps correspond,
and the straight path is in one piece.
"""

from .stage import BACKGROUND, BY_MATCHING, add_morph, color_maps, place

TITLE = "Tree to flowsnake"
BUTTONS = BY_MATCHING
TREE = ((0.2, 0.6, 0.12), (0.05, 0.34, 0.2))
PETALS = (
    (0.95, 0.2, 0.3),
    (1.0, 0.5, 0.12),
    (1.0, 0.78, 0.25),
    (0.6, 0.8, 0.2),
    (0.1, 0.6, 0.55),
    (0.15, 0.4, 0.95),
    (0.5, 0.25, 0.85),
)


def build(frames: int, size: int):
    """Build the scene and return the morph object; its path is still to be planned."""
    owner = add_morph("IMAGE", "Hata tree", "Gosper flowsnake", frames, size)
    place(owner.ifs_morph.final, 0.8, (-0.45, 0.73))
    color_maps(owner, TREE, PETALS)
    # A gap is narrower than a pixel then.
    owner.ifs_morph.gap_resolution = 1000
    owner.ifs_morph.output.mode = "ATTRACTORLET"
    # Twice the pixels of the render: its own samples do for antialiasing.
    owner.ifs_morph.output.resolution = 2 * size, 2 * size
    owner.ifs_morph.output.antialiasing = 1
    owner.ifs_morph.output.background = *BACKGROUND, 1.0
    return owner
