"""Edit the list of pairs: which map becomes which, through which symmetry, in how many parts."""

from dataclasses import replace

import bpy

from ...core.ifs import IFSError
from ...core.matching import word_text
from ...core.matching.expansion import parts
from .. import pairs
from ..conversion import shapes_of
from ..fcurves import rearrange_offsets
from ..property_options import window_held
from .poll import ENDS, editable_morph

MOST_PAIRS = 64
"""Beyond these a search or a locus takes too long."""


def _has_pairs(cls, context) -> bool:
    if not editable_morph(cls, context):
        return False
    if len(context.object.ifs_morph.matching.pairs) == 0:
        cls.poll_message_set("There are no pairs; add one, or press Morph or Match Pairs first")
        return False
    return True


class _ListOperator:
    bl_options = {"REGISTER", "UNDO"}

    poll = classmethod(_has_pairs)

    def execute(self, context):
        """Change the list of pairs, and have the picture follow."""
        owner = context.object
        try:
            with window_held(owner):
                self.edit(owner.ifs_morph)
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _require_active(matching) -> None:
    if not 0 <= matching.active_index < len(matching.pairs):
        raise IFSError("There is no active pair; choose one in the list.")


def _require_few(count: int) -> None:
    if count > MOST_PAIRS:
        raise IFSError(f"More than {MOST_PAIRS} pairs would come of it; split or double fewer maps.")


class _PairOperator(_ListOperator):
    def edit(self, settings):
        """Change the pairs by `change`; their locks and paths follow.

        It is given the pairs, the rows that they come from, and the number of the active one, changes both lists, and
        returns the number of the pair that is active then.
        """
        matching = settings.matching
        listed, locks = list(pairs.stored(matching)), [item.locked for item in matching.pairs]
        origins = list(range(len(listed)))
        _require_active(matching)
        active = self.change(settings, listed, origins, matching.active_index)
        pairs.write(matching, listed, [locks[origin] for origin in origins])
        rearrange_offsets(settings.id_data, origins)
        matching.active_index = active


class IFSMORPH_OT_pair_add(_ListOperator, bpy.types.Operator):
    """Add a pair of maps that are in none yet, or double the active pair. An empty list is filled in the order given"""

    bl_idname = "ifs_morph.pair_add"
    bl_label = "Add Pair"

    poll = classmethod(editable_morph)

    def edit(self, settings):
        """Append a pair and make it the active one."""
        initial, final = shapes_of(settings)
        matching = settings.matching
        if len(matching.pairs) == 0:
            listed = pairs.in_order(initial, final)
            _require_few(len(listed))
            pairs.write(matching, listed, [False] * len(listed))
            return
        _require_few(len(matching.pairs) + 1)
        rows = list(range(len(matching.pairs)))
        doubled = pairs.append(matching, initial, final)
        rearrange_offsets(settings.id_data, [*rows, doubled])


class IFSMORPH_OT_pair_remove(_ListOperator, bpy.types.Operator):
    """Remove the active pair"""

    bl_idname = "ifs_morph.pair_remove"
    bl_label = "Remove Pair"

    def edit(self, settings):
        """Remove the active pair; the one after it becomes active."""
        matching = settings.matching
        _require_active(matching)
        index, count = matching.active_index, len(matching.pairs)
        pairs.remove(matching, index)
        rearrange_offsets(settings.id_data, [k for k in range(count) if k != index])


class IFSMORPH_OT_pair_swap(_PairOperator, bpy.types.Operator):
    """Have the active pair and its neighbor become what the other became"""

    bl_idname = "ifs_morph.pair_swap"
    bl_label = "Swap Final Maps"

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Which neighbor to swap the final map with",
        items=(("UP", "Up", "The pair above"), ("DOWN", "Down", "The pair below")),
    )

    def change(self, settings, listed, origins, active):
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

    def change(self, settings, listed, origins, active):
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

    def change(self, settings, listed, origins, active):
        """Put the pairs of the parts where the first pair of the map was."""
        shape = shapes_of(settings)[self.end == "FINAL"]
        field = self.end.lower()
        word = getattr(listed[active], field)
        pairs.require_word(shape, word)
        # Where the map is in several pairs, they share the parts.
        sharing = [k for k, pair in enumerate(listed) if getattr(pair, field) == word]
        words = parts(shape, word)
        _require_few(len(listed) + max(len(words) - len(sharing), 0))
        split = [
            replace(
                listed[sharing[k % len(sharing)]],
                **{field: words[k % len(words)], f"{field}_symmetry": pairs.IDENTITY},
            )
            for k in range(max(len(words), len(sharing)))
        ]
        for k in reversed(sharing):
            del listed[k], origins[k]
        first = sharing[0]
        listed[first:first] = split
        origins[first:first] = [sharing[k % len(sharing)] for k in range(len(split))]
        return first


class IFSMORPH_OT_pair_join(_PairOperator, bpy.types.Operator):
    """Join this part of a split map with all its other parts; of pairs that are then equal one is left"""

    bl_idname = "ifs_morph.pair_join"
    bl_label = "Join Parts"

    end: bpy.props.EnumProperty(name="End", description="Which map of the pair to put together again", items=ENDS)

    def change(self, settings, listed, origins, active):
        """Put the whole map into the pairs of its parts."""
        field = self.end.lower()
        word = getattr(listed[active], field)
        whole = word[:-1]
        if not whole:
            raise IFSError(f"“{word_text(word)}” is no part of a map that was split, so there is nothing to join.")
        joined = [getattr(pair, field)[: len(whole)] == whole for pair in listed]
        unturned = {field: whole, f"{field}_symmetry": pairs.IDENTITY}
        changed = [replace(pair, **unturned) if part else pair for pair, part in zip(listed, joined, strict=True)]
        kept = [k for k, pair in enumerate(changed) if not (joined[k] and pair in changed[:k])]
        listed[:], origins[:] = [changed[k] for k in kept], kept
        return listed.index(changed[active])


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


class IFSMORPH_OT_clear_pairs(_ListOperator, bpy.types.Operator):
    """Remove all pairs, so that map k becomes map k"""

    bl_idname = "ifs_morph.clear_pairs"
    bl_label = "Clear Pairs"

    def edit(self, settings):
        """Remove the pairs, and the paths of their own that they had."""
        pairs.write(settings.matching, (), ())
        rearrange_offsets(settings.id_data, ())


CLASSES = (
    IFSMORPH_OT_pair_add,
    IFSMORPH_OT_pair_remove,
    IFSMORPH_OT_pair_swap,
    IFSMORPH_OT_pair_symmetry,
    IFSMORPH_OT_pair_split,
    IFSMORPH_OT_pair_join,
    IFSMORPH_OT_pairs_lock,
    IFSMORPH_OT_clear_pairs,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
