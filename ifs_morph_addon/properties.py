"""What is stored on an object: the two shapes, the morph between them, and how it is computed and shown.

Properties hold data and nothing else. Those that make sense on an F-curve are animatable, the others are not, so that
a picture's window or an attractor's number of maps never changes with the frame.
"""

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

from . import conversion
from .conversion import MOST_RECURRENT, identifier
from .fcurves import MOST_OFFSETS
from .output_properties import IFSMorphOutputSettings
from .pair_properties import CLASSES as PAIR_CLASSES
from .pair_properties import IFSMorphMatchSettings
from .property_options import LEAF, LIST, STILL, redraw, refit, show_edited_shape

SCHEMES = {
    "elementwise": ("Elementwise", "Interpolate the matrices entry by entry; maps that turn become flat on the way"),
    "polar": ("Polar", "Turn by the angle and interpolate the stretch, so that shapes keep their size as they turn"),
    "log-polar": ("Log-Polar", "As Polar, with the stretch interpolated by ratios; needs maps that are not flat"),
}
FLIPS = {
    "turned": ("Turned", "It turns over through the space before and behind the plane"),
    "projected": ("Projected", "It stays in the plane and becomes a line half-way, as it does in an image"),
}
METHODS = {
    "planned": ("Planned", "Find a way through the connectedness locus, and swell only where there is none"),
    "per map": (
        "Per Map",
        "Give each map a path of its own, beside the straight line where the shape would break",
    ),
    "straight": ("Straight", "Go straight from the initial to the final shape and swell where it would break"),
    "straight unswollen": ("Straight, Unswollen", "Go straight and let the shape break"),
}


def _choices(texts):
    return [(identifier(name), *text) for name, text in texts.items()]


def _parameter(first, last=None):
    """Getter and setter of one or more of the numbers into which core takes a map apart."""
    wanted = slice(first, last) if last else first

    def get(self):
        return conversion.map_parameters(self)[wanted]

    def set_(self, value):
        parameters = conversion.map_parameters(self)
        parameters[wanted] = value
        conversion.set_map_parameters(self, parameters)

    return {"get": get, "set": set_, "options": STILL}


def _offsets(axis, what):
    return FloatVectorProperty(
        name=f"Offset {axis}",
        description=f"How much further than {axis} the map is {what}",
        size=MOST_OFFSETS,
        default=(0.0,) * MOST_OFFSETS,
        min=-10.0,
        max=10.0,
        soft_min=-1.0,
        soft_max=1.0,
        step=1,
        precision=4,
        override=LEAF,
        update=redraw,
    )


class IFSMorphMap(bpy.types.PropertyGroup):
    """One affine map of a shape."""

    name: StringProperty(name="Name", description="What to call the map in the list", options=STILL, override=LEAF)
    matrix: FloatVectorProperty(
        name="Matrix",
        description="The map as a matrix: x' = a x + b y + e and y' = c x + d y + f",
        size=(2, 3),
        # Blender would take the default of the subtype MATRIX by columns.
        default=((0.5, 0.0, 0.0), (0.0, 0.5, 0.0)),
        min=-1e6,
        max=1e6,
        precision=4,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    matrix_in_space: FloatVectorProperty(
        name="Matrix in Space",
        description="The map of a shape in space: a row each for x', y' and z', the last column is the translation",
        size=(3, 4),
        subtype="MATRIX",
        default=((0.5, 0.0, 0.0, 0.0), (0.0, 0.5, 0.0, 0.0), (0.0, 0.0, 0.5, 0.0)),
        min=-1e6,
        max=1e6,
        precision=4,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    weight: FloatProperty(
        name="Weight",
        description="Share of the points that this map gets; zero takes the share from the map's area",
        default=0.0,
        min=0.0,
        soft_max=1.0,
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    opacity: FloatProperty(
        name="Opacity",
        description="How visible the points of this map's attractorlet are. At zero the map belongs to the shape, "
        "but its attractorlet is not drawn",
        subtype="FACTOR",
        default=1.0,
        min=0.0,
        max=1.0,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    color: FloatVectorProperty(
        name="Color",
        description="Color of this map's attractorlet",
        subtype="COLOR",
        size=3,
        min=0.0,
        soft_max=1.0,
        default=(0.8, 0.8, 0.8),
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    transitions: FloatVectorProperty(
        name="Transitions",
        description="How often each map of a recurrent shape is applied next after this one, times its weight; "
        "never where it is zero",
        size=MOST_RECURRENT,
        default=(1.0,) * MOST_RECURRENT,
        min=0.0,
        soft_max=1.0,
        precision=2,
        step=10,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    winding: IntProperty(
        name="Winding",
        description="Whole turns that this map makes on its way from the initial shape, on top of the shorter way",
        default=0,
        soft_min=-3,
        soft_max=3,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    rotation: FloatProperty(
        name="Rotation", description="Angle by which the map turns", subtype="ANGLE", **_parameter(0)
    )
    scale: FloatVectorProperty(
        name="Scale",
        description="Stretch of the map's axes; a negative Y reflects",
        size=2,
        subtype="XYZ",
        precision=4,
        step=1,
        **_parameter(1, 3),
    )
    shear: FloatProperty(
        name="Shear", description="How far the map's Y axis leans over", precision=4, step=1, **_parameter(3)
    )
    translation: FloatVectorProperty(
        name="Location",
        description="Where the map takes the origin",
        size=2,
        subtype="XYZ",
        precision=4,
        step=1,
        **_parameter(4, 6),
    )


class IFSMorphShape(bpy.types.PropertyGroup):
    """An iterated function system: the initial or the final shape."""

    name: StringProperty(name="Name", description="What to call the shape in messages", options=STILL, override=LEAF)
    in_space: BoolProperty(
        name="In Space",
        description="Whether the maps act on space and not on the plane; such a shape is shown as points",
        default=False,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    maps: CollectionProperty(type=IFSMorphMap, name="Maps", override=LIST)
    recurrent: BoolProperty(
        name="Recurrent",
        description="Let the transitions say which map may be applied after which, and how often",
        default=False,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    active_index: IntProperty(
        name="Active Map", description="The map shown below the list", default=0, options=STILL, override=LEAF
    )


class IFSMorphLocusSettings(bpy.types.PropertyGroup):
    """How the connectedness locus is computed, and its picture."""

    resolution: IntProperty(
        name="Resolution",
        description="Nodes along a side of the locus; rounded so that 0 and 1 lie on nodes",
        default=511,
        min=16,
        soft_max=1021,
        max=4096,
        options=STILL,
        override=LEAF,
    )
    domain: FloatVectorProperty(
        name="Domain",
        description="Lowest and highest (u,v) of the locus",
        size=2,
        default=(-1.0, 2.0),
        min=-8.0,
        max=9.0,
        soft_min=-4.0,
        soft_max=5.0,
        options=STILL,
        override=LEAF,
    )
    image: PointerProperty(
        type=bpy.types.Image, name="Image", description="The picture of the locus", options=STILL, override=LEAF
    )
    live: BoolProperty(
        name="Live",
        description="Keep the picture up to date while maps change: a coarse one at once, the full one after a pause. "
        "It begins with the first Compute Locus",
        default=True,
        options=STILL,
        override=LEAF,
        update=redraw,
    )


class IFSMorphPathSettings(bpy.types.PropertyGroup):
    """How the path is planned and keyed, and what was found about it."""

    method: EnumProperty(
        name="Method",
        description="Which way to take from the initial to the final shape",
        items=_choices(METHODS),
        default=identifier("planned"),
        options=STILL,
        override=LEAF,
    )
    frame_start: IntProperty(
        name="Frame Start",
        description="Frame that shows the initial shape",
        default=1,
        options=STILL,
        override=LEAF,
    )
    frame_end: IntProperty(
        name="End", description="Frame that shows the final shape", default=120, options=STILL, override=LEAF
    )
    report: StringProperty(name="Report", description="What was found about the path", override=LEAF)
    inputs: StringProperty(description="Fingerprint of what the path was made for", options={"HIDDEN"}, override=LEAF)


class IFSMorphSettings(bpy.types.PropertyGroup):
    """A morph and its output, on an object."""

    kind: EnumProperty(
        name="Kind",
        description="What the object shows the attractor as",
        items=(
            ("NONE", "None", "The object is no IFS morph"),
            ("IMAGE", "Image Plane", "A plane with the attractor as its texture"),
            ("POINTS", "Point Cloud", "A point cloud of the attractor"),
        ),
        default="NONE",
        options=STILL,
        override=LEAF,
    )
    initial: PointerProperty(type=IFSMorphShape, name="Initial Shape", override=LEAF)
    final: PointerProperty(type=IFSMorphShape, name="Final Shape", override=LEAF)
    scheme: EnumProperty(
        name="Scheme",
        description="How the linear parts of the maps are interpolated",
        items=_choices(SCHEMES),
        default=identifier("polar"),
        options=STILL,
        override=LEAF,
        update=refit,
    )
    flip: EnumProperty(
        name="Flip",
        description="What becomes of a map that reflects at one end only, among points",
        items=_choices(FLIPS),
        default=identifier("turned"),
        options=STILL,
        override=LEAF,
        update=refit,
    )
    uv: FloatVectorProperty(
        name="UV",
        description="Place in the morph: u drives the linear parts of the maps and v their translations. "
        "(0, 0) is the initial shape, (1, 1) the final one",
        size=2,
        default=(0.0, 0.0),
        min=-10.0,
        max=10.0,
        soft_min=-1.0,
        soft_max=2.0,
        step=1,
        precision=4,
        override=LEAF,
        update=redraw,
    )
    swell: FloatProperty(
        name="Swell",
        description="Thickens the maps where (u,v) alone would let the shape break",
        default=0.0,
        min=0.0,
        max=1.0,
        step=1,
        precision=4,
        override=LEAF,
        update=redraw,
    )
    offset_u: _offsets("U", "in its turn and stretch")
    offset_v: _offsets("V", "on the way of its translation")
    edit_maps: BoolProperty(
        name="Edit Maps in Viewport",
        description="Show the maps as triangles whose corners can be dragged in the viewport",
        default=False,
        options=STILL,
        override=LEAF,
        update=show_edited_shape,
    )
    edited_end: EnumProperty(
        name="Edited Shape",
        description="Whose maps to show. While (u,v) has no keys it goes to that shape, so that you see what you drag; "
        "on a keyed path the shape of the current frame stays and follows",
        items=(
            ("INITIAL", "Initial", "The shape at the start of the morph"),
            ("FINAL", "Final", "The shape at the end of the morph"),
        ),
        default="INITIAL",
        options=STILL,
        override=LEAF,
        update=show_edited_shape,
    )
    gap_resolution: IntProperty(
        name="Gap Resolution",
        description="A gap counts from the diameter of the shape divided by this, as if it were drawn this many "
        "pixels wide",
        default=300,
        min=2,
        soft_max=4000,
        options=STILL,
        override=LEAF,
    )
    matching: PointerProperty(type=IFSMorphMatchSettings, name="Matching", override=LEAF)
    locus: PointerProperty(type=IFSMorphLocusSettings, name="Connectedness Locus", override=LEAF)
    path: PointerProperty(type=IFSMorphPathSettings, name="Path", override=LEAF)
    output: PointerProperty(type=IFSMorphOutputSettings, name="Output", override=LEAF)


class IFSMorphLocusPicture(bpy.types.PropertyGroup):
    """Where the nodes of a locus lie, kept on its picture so that (u,v) can be found on it."""

    lowest: FloatVectorProperty(
        name="Lowest", description="(u,v) of the lower left pixel's middle", size=2, options=STILL
    )
    spacing: FloatProperty(
        name="Spacing", description="Step of u and v from pixel to pixel; zero on other images", options=STILL
    )
    inputs: StringProperty(description="Fingerprint of what the picture shows", options={"HIDDEN"})


CLASSES = (
    IFSMorphMap,
    IFSMorphShape,
    *PAIR_CLASSES,
    IFSMorphLocusSettings,
    IFSMorphPathSettings,
    IFSMorphOutputSettings,
    IFSMorphSettings,
    IFSMorphLocusPicture,
)


def register():
    """Register the property groups and hang them on objects and images."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.ifs_morph = PointerProperty(type=IFSMorphSettings, name="IFS Morph", override=LEAF)
    bpy.types.Image.ifs_morph_locus = PointerProperty(type=IFSMorphLocusPicture, name="IFS Morph Locus")


def unregister():
    """Take them off again; what files hold stays in them."""
    del bpy.types.Image.ifs_morph_locus
    del bpy.types.Object.ifs_morph
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
