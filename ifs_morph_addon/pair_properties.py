"""What is stored about the matching: the pairs, and how long to search for them."""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatVectorProperty,
    IntProperty,
    StringProperty,
)

from .pairs import no_symmetry
from .property_options import LEAF, LIST, STILL, refit

BUDGETS = (
    ("QUICK", "Quick", "Search for a few seconds"),
    ("THOROUGH", "Thorough", "Search several times as long, for shapes that are hard to match"),
)


def _word(end):
    return StringProperty(
        name=end,
        description=f"Map of the {end.lower()} shape, counted from 1. “3 1” is the part of map 3 that map 1 makes: "
        "then map 3 is split, and all its parts must be in pairs",
        options=STILL,
        override=LEAF,
        update=refit,
    )


def _symmetry(end, dimension):
    return FloatVectorProperty(
        name=f"{end} Symmetry",
        description=f"Turn or mirroring that takes the {end.lower()} shape to itself, made before the map"
        + (", for shapes in space" if dimension == 3 else ""),
        size=(dimension, dimension + 1),
        default=no_symmetry(dimension),
        options=STILL,
        override=LEAF,
        update=refit,
    )


class IFSMorphPair(bpy.types.PropertyGroup):
    """A map of the initial shape, and the map of the final shape that it becomes."""

    initial: _word("Initial")
    final: _word("Final")
    initial_symmetry: _symmetry("Initial", 2)
    final_symmetry: _symmetry("Final", 2)
    initial_symmetry_in_space: _symmetry("Initial", 3)
    final_symmetry_in_space: _symmetry("Final", 3)
    winding: IntProperty(
        name="Winding",
        description="Whole turns that the map makes on its way, on top of the shorter way",
        default=0,
        soft_min=-3,
        soft_max=3,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    locked: BoolProperty(
        name="Locked",
        description="Keep this pair as it is when the shapes are matched again",
        default=False,
        options=STILL,
        override=LEAF,
    )


class IFSMorphMatchSettings(bpy.types.PropertyGroup):
    """How the shapes are matched, and which map becomes which. Without pairs map k becomes map k."""

    pairs: CollectionProperty(type=IFSMorphPair, name="Pairs", override=LIST)
    active_index: IntProperty(
        name="Active Pair", description="The pair that is edited", default=0, options=STILL, override=LEAF
    )
    budget: EnumProperty(
        name="Budget",
        description="How long to search for the best match",
        items=BUDGETS,
        default="QUICK",
        options=STILL,
        override=LEAF,
    )
    choose_scheme: BoolProperty(
        name="Choose Scheme",
        description="Morph with the scheme, Polar or Log-Polar, that swells less. Otherwise the one chosen stays, "
        "and Elementwise always does",
        default=True,
        options=STILL,
        override=LEAF,
    )


CLASSES = (IFSMorphPair, IFSMorphMatchSettings)
