"""Edit the list of pairs: which map becomes which, through which symmetry, in how many parts."""

from dataclasses import replace

import bpy

from ...core.ifs import IFSError
from ...core.matching.expansion import parts
from .. import pairs
from ..conversion import shapes_of
from ..property_options import window_held
from .poll import ENDS, editable_morph

MOST_PAIRS = 64
"""Beyond these a search or a locus takes too long."""


def _has_pairs(cls, context) -> bool:
    if not editable_morph(cls, context):
        return False
    if len(context.object.ifs_morph.matching.pairs) == 0:
        cls.poll_message_set("There are no pairs; press Morph or Match Pairs first")
        return False
    return True


class _PairOperator:
    bl_options = {"REGISTER", "UNDO"}

    poll = classmethod(_has_pairs)

    def execute(self, context):
        """Change the list of pairs, and have the picture follow."""
        owner = context.object
        matching = owner.ifs_morph.matching
        try:
            listed, locks = list(pairs.stored(matching)), [item.locked for item in matching.pairs]
            if not 0 <= matching.active_index < len(listed):
                raise IFSError("There is no active pair; choose one in the list.")
            active = self.change(owner.ifs_morph, listed, locks, matching.active_index)
            with window_held(owner):
                pairs.write(matching, listed, locks)
                matching.active_index = active
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class IFSMORPH_OT_pair_swap(_PairOperator, bpy.types.Operator):
    """Have the active pair and its neighbor become what the other became"""

    bl_idname = "ifs_morph.pair_swap"
    bl_label = "Swap Final Maps"

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Which neighbor to swap the final map with",
        items=(("UP", "Up", "The pair above"), ("DOWN", "Down", "The pair below")),
    )

    def change(self, settings, listed, locks, active):
        """Swap the final words with their symmetries; the other pair becomes the active one."""
        other = active + (-1 if self.direction == "UP" else 1)
        if not 0 <= other < len(listed):
            raise IFSError("The pair is at the end of the list already.")
        pair, neighbor = listed[active], listed[other]
        listed[active] = replace(pair, final=neighbor.final, final_symmetry=neighbor.final_symmetry)
        listed[other] = replace(neighbor, final=pair.final, final_symmetry=pair.final_symmetry)
        return other


class IFSMORPH_OT_pair_symmetry(_PairOperator, bpy.types.Operator):
    """Have the active pair make use of the next symmetry of the shape"""

    bl_idname = "ifs_morph.pair_symmetry"
    bl_label = "Next Symmetry"

    end: bpy.props.EnumProperty(name="End", description="Whose symmetry to change", items=ENDS)

    def change(self, settings, listed, locks, active):
        """Go on to the next symmetry, and from the last one to none."""
        shape, field = shapes_of(settings)[self.end == "FINAL"], f"{self.end.lower()}_symmetry"
        following = pairs.next_symmetry(shape, getattr(listed[active], field))
        listed[active] = replace(listed[active], **{field: following})
        return active


class IFSMORPH_OT_pair_split(_PairOperator, bpy.types.Operator):
    """Split a map of the active pair into its parts, each with a pair of its own"""

    bl_idname = "ifs_morph.pair_split"
    bl_label = "Split Map"

    end: bpy.props.EnumProperty(name="End", description="Which map of the pair to split", items=ENDS)

    def change(self, settings, listed, locks, active):
        """Put the pairs of the parts where the first pair of the map was."""
        shape = shapes_of(settings)[self.end == "FINAL"]
        field = self.end.lower()
        word = getattr(listed[active], field)
        pairs.require_word(shape, word)
        # Where the map is in several pairs, they share the parts.
        sharing = [k for k, pair in enumerate(listed) if getattr(pair, field) == word]
        words = parts(shape, word)
        if len(listed) + max(len(words) - len(sharing), 0) > MOST_PAIRS:
            raise IFSError(f"More than {MOST_PAIRS} pairs would come of it; split other maps.")
        split = [
            replace(
                listed[sharing[k % len(sharing)]],
                **{field: words[k % len(words)], f"{field}_symmetry": pairs.IDENTITY},
            )
            for k in range(max(len(words), len(sharing)))
        ]
        part_locks = [locks[sharing[k % len(sharing)]] for k in range(len(split))]
        for k in reversed(sharing):
            del listed[k], locks[k]
        first = sharing[0]
        listed[first:first], locks[first:first] = split, part_locks
        return first


class IFSMORPH_OT_pairs_lock(bpy.types.Operator):
    """Keep all pairs as they are when the shapes are matched again, or none"""

    bl_idname = "ifs_morph.pairs_lock"
    bl_label = "Lock Pairs"
    bl_options = {"REGISTER", "UNDO"}

    action: bpy.props.EnumProperty(
        name="Action",
        description="What to do with the locks",
        items=(("LOCK", "Lock All", "Keep all pairs"), ("UNLOCK", "Unlock All", "Leave all pairs open")),
    )

    poll = classmethod(_has_pairs)

    def execute(self, context):
        """Set all locks."""
        for item in context.object.ifs_morph.matching.pairs:
            item.locked = self.action == "LOCK"
        return {"FINISHED"}


class IFSMORPH_OT_clear_pairs(bpy.types.Operator):
    """Remove all pairs, so that map k becomes map k"""

    bl_idname = "ifs_morph.clear_pairs"
    bl_label = "Clear Pairs"
    bl_options = {"REGISTER", "UNDO"}

    poll = classmethod(_has_pairs)

    def execute(self, context):
        """Remove the pairs."""
        owner = context.object
        try:
            with window_held(owner):
                pairs.write(owner.ifs_morph.matching, (), ())
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (
    IFSMORPH_OT_pair_swap,
    IFSMORPH_OT_pair_symmetry,
    IFSMORPH_OT_pair_split,
    IFSMORPH_OT_pairs_lock,
    IFSMORPH_OT_clear_pairs,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
