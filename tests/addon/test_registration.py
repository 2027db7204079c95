"""Enabling and disabling leave nothing behind and lose nothing."""

import importlib

import bpy
import pytest

from tests.addon.interface import PACKAGE
from tests.addon.support import add

addon_utils = importlib.import_module("addon_utils")  # on the path since bpy was imported


def _handlers():
    return [
        function
        for event in dir(bpy.app.handlers)
        if isinstance(getattr(bpy.app.handlers, event), list)
        for function in getattr(bpy.app.handlers, event)
        if function.__module__.startswith(PACKAGE)
    ]


def _classes():
    kinds = (bpy.types.Operator, bpy.types.Panel, bpy.types.Menu, bpy.types.UIList, bpy.types.PropertyGroup)
    return sorted(
        cls.__name__
        for kind in kinds
        for cls in kind.__subclasses__()
        if cls.__module__.startswith(PACKAGE) and cls.is_registered
    )


def _left():
    """Whatever of the extension Blender knows."""
    properties = [
        (kind.__name__, name)
        for kind in (bpy.types.Object, bpy.types.Image)
        for name in dir(kind)
        if "ifs_morph" in name
    ]
    drawn = [
        function.__module__
        for function in bpy.types.VIEW3D_MT_add.draw._draw_funcs
        if function.__module__.startswith(PACKAGE)
    ]
    operators = [name for group in ("object", "ifs_morph") for name in dir(getattr(bpy.ops, group)) if "ifs" in name]
    if "ifs_morph" in dir(bpy.ops):
        operators += dir(bpy.ops.ifs_morph)
    return _handlers(), _classes(), properties, drawn, operators


@pytest.fixture
def enabled_again(extension):
    yield
    addon_utils.enable(PACKAGE)


def test_disabling_leaves_nothing(extension, enabled_again):
    handlers, classes, properties, drawn, operators = _left()
    assert len(handlers) >= 2
    assert len(classes) >= 20
    assert properties == [("Object", "ifs_morph"), ("Image", "ifs_morph_locus")]
    assert len(drawn) == 1
    assert operators
    before = _left()
    addon_utils.disable(PACKAGE)
    assert [len(part) for part in _left()] == [0, 0, 0, 0, 0]
    addon_utils.enable(PACKAGE)
    assert _left() == before


def test_enabling_twice_registers_once(extension):
    before = _left()
    addon_utils.enable(PACKAGE)
    assert _left() == before


def test_settings_outlive_disabling(scene, enabled_again):
    owner = add("IMAGE")
    owner.ifs_morph.uv = 0.25, 0.75
    owner.ifs_morph.initial.maps[1].matrix[0][2] = 0.125
    addon_utils.disable(PACKAGE)
    addon_utils.enable(PACKAGE)
    assert tuple(owner.ifs_morph.uv) == (0.25, 0.75)
    assert owner.ifs_morph.initial.maps[1].matrix[0][2] == 0.125


def test_handlers_stay_when_a_file_is_opened(scene):
    before = _handlers()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    assert before
    assert _handlers() == before
