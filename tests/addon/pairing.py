"""Objects whose shapes are matched, and what they store of it."""

import bpy

from tests.addon.interface import keys
from tests.addon.support import add, show

FIRST, LAST = 3, 18
IDENTITY = ((1, 0, 0), (0, 1, 0))


def pair(initial, final, kind="IMAGE"):
    """Add a small object whose shapes are to be matched."""
    owner = add(kind)
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = FIRST, LAST
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape=initial)
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape=final)
    show()
    return owner


def listed(owner):
    """All that is stored about the pairs."""
    return [
        (
            item.initial,
            item.final,
            tuple(map(tuple, item.initial_symmetry)),
            tuple(map(tuple, item.final_symmetry)),
            item.winding,
            item.locked,
        )
        for item in owner.ifs_morph.matching.pairs
    ]


def set_pairs(owner, *pairs):
    """Store pairs as a person may write them."""
    stored = owner.ifs_morph.matching.pairs
    stored.clear()
    for initial, final in pairs:
        item = stored.add()
        item.initial, item.final = initial, final
    show()


def state(owner, extension):
    settings = owner.ifs_morph
    return (
        keys(owner, extension),
        listed(owner),
        settings.path.report,
        settings.path.inputs,
        tuple(settings.output.window),
        tuple(settings.uv),
    )


def morph_of(owner, extension):
    return extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)
