"""What an animator sees of a morph object beside its picture: keys, greyed-out buttons and the sidebar."""

from types import SimpleNamespace

import bpy

PACKAGE = "bl_ext.user_default.ifs_morph"


def keys(owner, extension):
    """Keys of u, v and swell: for each a list of (frame, value); empty without an F-curve."""
    curves = extension.ifs_morph_addon.fcurves.path_curves(owner)
    return [[] if curve is None else [tuple(key.co) for key in curve.keyframe_points] for curve in curves]


def reason(operator, **options):
    """Why an operator cannot be pressed; empty if it can be."""
    if operator.poll():
        return ""
    try:
        operator(**options)
    except RuntimeError as error:
        return str(error)
    raise AssertionError("The operator ran although its poll had failed.")


class Layout:
    """Stands in for a panel's layout, which Blender has in a window only, and keeps the texts that are drawn."""

    def __init__(self, texts=None):
        self.texts = [] if texts is None else texts

    def label(self, text="", **_):
        self.texts.append(text)

    def progress(self, factor, text):
        assert 0 <= factor <= 1
        self.texts.append(text)

    def prop(self, data, name, text=None, **_):
        assert name in data.bl_rna.properties, f"{data} has no property {name}"

    def operator(self, name, **_):
        group, function = name.split(".")
        names = {item.identifier for item in getattr(getattr(bpy.ops, group), function).get_rna_type().properties}
        return _Button(names)

    def operator_menu_enum(self, name, choice, **_):
        button = self.operator(name)
        assert choice in button.names
        return button

    def menu(self, name, **_):
        assert hasattr(bpy.types, name), f"There is no menu {name}"

    def template_list(self, name, identifier, data, collection, active_data, active, **_):
        assert collection in data.bl_rna.properties
        assert active in active_data.bl_rna.properties

    def template_color_ramp(self, data, name, **_):
        assert name in data.bl_rna.properties

    def separator(self, **_):
        pass

    def _part(self, **_):
        return Layout(self.texts)

    row = column = box = split = _part


class _Button:
    def __init__(self, names):
        object.__setattr__(self, "names", names)

    def __setattr__(self, name, value):
        assert name in self.names, f"The operator has no property {name}"


def sidebar(owner, extension):
    """All texts that the sidebar shows for an object, in one line."""
    context = SimpleNamespace(
        object=owner,
        scene=bpy.context.scene,
        region=SimpleNamespace(width=2000),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
    )
    layout = Layout()
    for panel in extension.ifs_morph_addon.ui.panels.CLASSES:
        if panel.poll(context):
            panel.draw(_panel(panel, layout), context)
    return " ".join(text for text in layout.texts if text)


def _panel(panel, layout):
    """Stand in for an instance of a panel, which only Blender makes."""
    members = {
        name: value
        for cls in reversed(panel.__mro__)
        if cls.__module__.startswith(PACKAGE)
        for name, value in vars(cls).items()
    }
    stand_in = type(panel.__name__, (), {name: value for name, value in members.items() if not name.startswith("__")})()
    stand_in.layout = layout
    return stand_in
