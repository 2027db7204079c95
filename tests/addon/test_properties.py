"""Properties and operators are what core, files and Blender's interface take them for."""

import bpy
import numpy as np
import pytest

from core.morph import SCHEMES, Morph
from core.path import METHODS
from core.raster import MODES
from core.shading import CURVES
from core.shapes import SHAPES
from tests.addon.support import activate, add

EDITED = ("rotation", "scale", "shear", "translation")
"""Properties of a map that are its matrix in other words."""


def settings():
    return bpy.types.Object.bl_rna.properties["ifs_morph"].fixed_type.properties


def test_properties_have_tooltips_and_can_be_overridden(extension):
    groups = [bpy.types.Object.bl_rna.properties["ifs_morph"].fixed_type]
    seen = 0
    while groups:
        group = groups.pop()
        for item in group.properties:
            if item.identifier in ("rna_type", "name"):
                continue
            seen += 1
            assert item.is_overridable or item.identifier in EDITED, f"{group.identifier}.{item.identifier}"
            pointed = getattr(item, "fixed_type", None)
            if pointed is not None and pointed.identifier.startswith("IFSMorph"):
                groups.append(pointed)
            else:
                assert item.description, f"{group.identifier}.{item.identifier}"
                assert not item.description.endswith("."), f"{group.identifier}.{item.identifier}"
    assert seen > 40


def test_operators_have_tooltips(extension):
    operators = [getattr(bpy.ops.ifs_morph, name) for name in dir(bpy.ops.ifs_morph)]
    for operator in (*operators, bpy.ops.object.ifs_morph_add):
        described = operator.get_rna_type()
        assert described.description, described.identifier
        assert not described.description.endswith("."), described.identifier
        for item in described.properties:
            # Blender's own operator for presets has hidden properties that nobody sees the tooltip of.
            assert item.description or item.identifier == "rna_type" or item.is_hidden, (
                f"{described.identifier}.{item.identifier}"
            )


def test_place_is_animatable_and_shapes_are_not(extension):
    assert settings()["uv"].is_animatable
    assert settings()["uv"].array_length == 2
    assert settings()["swell"].is_animatable
    maps = settings()["initial"].fixed_type.properties["maps"].fixed_type.properties
    assert not any(maps[name].is_animatable for name in ("matrix", "weight", "winding", *EDITED))


@pytest.mark.parametrize(
    ("group", "name", "known"),
    [(None, "scheme", SCHEMES), ("path", "method", METHODS), ("output", "mode", MODES), ("output", "curve", CURVES)],
)
def test_choices_are_those_of_core(extension, group, name, known):
    group = settings()[group].fixed_type.properties if group else settings()
    identifier = extension.ifs_morph_addon.conversion.identifier
    assert {item.identifier for item in group[name].enum_items} == {identifier(each) for each in known}


def test_winding_turns_maps(scene, extension):
    settings = add("IMAGE").ifs_morph
    settings.final.maps[2].winding = -1
    morph = extension.ifs_morph_addon.conversion.morph_of(settings)
    expected = Morph(SHAPES["turned gasket"], SHAPES["gasket"], winding=[0, 0, -1])
    np.testing.assert_allclose(morph.at(0.4, 0.4).maps, expected.at(0.4, 0.4).maps, atol=1e-6)


def test_operators_need_a_morph(scene):
    owner = add("IMAGE")
    activate(scene.camera)
    names = [name for name in dir(bpy.ops.ifs_morph) if name not in ("show_locus", "import_shapes")]
    assert len(names) >= 10
    assert not any(getattr(bpy.ops.ifs_morph, name).poll() for name in names)
    activate(owner)
    assert bpy.ops.ifs_morph.load_shape.poll()
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.object.ifs_morph_add.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
