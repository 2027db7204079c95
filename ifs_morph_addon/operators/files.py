"""Shapes from files and into files, through the file browser, the clipboard, and files dropped onto the viewport."""

from functools import lru_cache
from pathlib import Path

import bpy
from bpy_extras.io_utils import ExportHelper, ImportHelper

from ...core.formats import SUFFIXES, Entry, FormatError, read_file, read_text, write_file, write_text
from ...core.formats.entry import with_unique_names
from ...core.ifs import IFSError
from .. import preparation
from ..conversion import NO_PICTURE, fit_window
from ..entries import frame_entry, require_storable, shape_entry, write_entry
from .poll import ENDS, any_morph, editable_morph, shape_of

FORMATS = (
    ("IFS", "Fractint (.ifs)", "Maps and their weights as plain numbers, for Fractint and most IFS programs"),
    ("FLAME", "Fractal Flame (.flame)", "Maps with weights and colors, for Apophysis, flam3, Fractorium and JWildfire"),
)

WRITTEN = (*ENDS, ("FRAME", "Current Frame", "The shape at the current (u,v) and swell"))

FILTER = ";".join(f"*{suffix}" for suffix in SUFFIXES)

UNSAVED = {"SKIP_SAVE", "HIDDEN"}
"""Of this press of the button alone: a file that was chosen before is no file that was dropped now."""

PROBLEMS_REPORTED = 20


def clipboard() -> str:
    """Text on the clipboard, which there is in a window only."""
    return bpy.context.window_manager.clipboard


def set_clipboard(text: str) -> None:
    """Put text on the clipboard."""
    bpy.context.window_manager.clipboard = text


def _report(operator, problems) -> None:
    """Report each problem, or the first of them."""
    for problem in problems[:PROBLEMS_REPORTED]:
        operator.report({"WARNING"}, problem)
    if len(problems) > PROBLEMS_REPORTED:
        operator.report({"WARNING"}, f"{len(problems) - PROBLEMS_REPORTED} more problems are not listed.")


def _usable(entries, problems) -> tuple[dict[str, Entry], list[str]]:
    """Entries that can be the shape of an object, by name, and all problems with the others."""
    usable, problems = [], list(problems)
    for entry in entries:
        try:
            require_storable(entry)
        except IFSError as error:
            problems.append(str(error))
        else:
            usable.append(entry)
    return {entry.name: entry for entry in with_unique_names(usable)}, problems


@lru_cache(maxsize=8)
def _file(path: str, changed: int):
    """Keep what was read, since Blender asks for the names at each letter that is typed."""
    return read_file(path)


def _picked(properties) -> list[Path]:
    """Files that were picked in the file browser or dropped."""
    if properties.directory and any(file.name for file in properties.files):
        return [Path(properties.directory, file.name) for file in properties.files]
    return [Path(properties.filepath)] if properties.filepath else []


def _read_picked(properties):
    """Usable entries of all picked files by name, and problems, files that cannot be read among them."""
    entries, problems = [], []
    for path in _picked(properties):
        try:
            changed = path.stat().st_mtime_ns
        except (OSError, ValueError):
            changed = 0  # Reading it will say what is wrong.
        try:
            found = _file(str(path), changed)
        except FormatError as error:
            problems.append(str(error))
            continue
        entries += found.entries
        problems += found.problems
    return _usable(entries, problems)


def _read_clipboard(properties):
    """Usable entries of the clipboard by name, and problems; raises FormatError."""
    try:
        found = read_text(clipboard(), "Pasted")
    except FormatError as error:
        raise FormatError(f"The clipboard has no shape. {error}") from error
    return _usable(found.entries, found.problems)


def _names(read, properties) -> list[str]:
    """Names to choose from; none while there is nothing to read."""
    try:
        return list(read(properties)[0])
    except FormatError:
        return []


def _entry_property(read):
    """A name to be chosen; Blender asks for the choices with an operator's properties, not with the operator."""
    return bpy.props.StringProperty(
        name="Shape",
        description="Which of several shapes to take; the first one if empty",
        search=lambda properties, context, text: _names(read, properties),
        options={"SKIP_SAVE"},
    )


class _Choice:
    """Takes one of several entries: the first one unless `entry` names another."""

    def chosen(self):
        """Return the entry with the name it goes by, and all problems; raises FormatError."""
        usable, problems = self.read(self)
        if not usable and not problems:
            raise FormatError("Choose a file of shapes first.")
        if not usable:
            raise FormatError("\n".join(problems[:PROBLEMS_REPORTED]))
        name = self.entry or next(iter(usable))
        if name not in usable:
            raise FormatError(f"There is no shape “{name}”; there are {', '.join(list(usable)[:PROBLEMS_REPORTED])}.")
        return name, usable[name], problems

    def ask(self, context):
        """Ask which entry to take, with the first one filled in; an error instead if there is none."""
        try:
            self.entry = self.chosen()[0]
        except FormatError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, context):
        """Draw the choices."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        self.draw_more(layout, context)
        count = len(_names(self.read, self))
        if count:
            layout.prop(self, "entry", text="Shape" if count == 1 else f"Shape (1 of {count})")

    def draw_more(self, layout, context):
        """Draw what is chosen besides."""


class IFSMORPH_OT_import_shapes(_Choice, ImportHelper, bpy.types.Operator):
    """Take a shape from a Fractint .ifs file or from a fractal flame whose maps are affine"""

    bl_idname = "ifs_morph.import_shapes"
    bl_label = "Import Shape"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".ifs"
    filter_glob: bpy.props.StringProperty(description="Which files to list", default=FILTER, options={"HIDDEN"})
    filepath: bpy.props.StringProperty(description="File to read", subtype="FILE_PATH", options=UNSAVED)
    directory: bpy.props.StringProperty(description="Folder of the files", subtype="DIR_PATH", options=UNSAVED)
    files: bpy.props.CollectionProperty(
        description="Files to read together", type=bpy.types.OperatorFileListElement, options=UNSAVED
    )
    target: bpy.props.EnumProperty(
        name="Use As",
        description="What the shape becomes",
        items=(
            ("INITIAL", "Initial Shape", "The shape at the start of the active morph"),
            ("FINAL", "Final Shape", "The shape at the end of the active morph"),
            ("IMAGE", "New Image Plane", "Both ends of a new morph, shown on a plane"),
            ("POINTS", "New Point Cloud", "Both ends of a new morph, shown as points"),
        ),
        options={"SKIP_SAVE"},
    )

    entry: _entry_property(_read_picked)
    read = staticmethod(_read_picked)

    def invoke(self, context, event):
        """Ask for a file, or for what to do with those that were dropped."""
        if not self.properties.is_property_set("target"):
            self.target = "FINAL" if editable_morph(type(self), context) else "IMAGE"
        if _picked(self):
            return self.ask(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw_more(self, layout, context):
        """Draw what the shape becomes."""
        layout.prop(self, "target")

    def execute(self, context):
        """Set the shape, or add an object that has it at both ends."""
        try:
            name, entry, problems = self.chosen()
            if not self.entry and self.options.is_invoke and len(_names(self.read, self)) > 1:
                return self._ask_again()
            if entry.dimension == 3 and self.target == "IMAGE":
                raise IFSError(NO_PICTURE)
            owner, shapes = self._owner(context, name)
            for shape in shapes:
                write_entry(shape, entry)
                shape.name = name
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        fit_window(owner)
        owner.update_tag()
        _report(self, problems)
        _report_attractor(self, entry)
        return {"FINISHED"}

    def _ask_again(self):
        """After the file browser, ask for the shape by a dialog: a file browser can open none of its own."""
        files = [{"name": file.name} for file in self.files]
        bpy.ops.ifs_morph.import_shapes(
            "INVOKE_DEFAULT", filepath=self.filepath, directory=self.directory, files=files, target=self.target
        )
        return {"CANCELLED"}

    def _owner(self, context, name):
        """The object and those of its shapes that are to be set; raises IFSError and adds nothing then."""
        if self.target in ("INITIAL", "FINAL"):
            owner = context.object
            if not editable_morph(type(self), context):
                raise IFSError("Select an IFS Morph object that can be changed, or import the shape as a new object.")
            settings = owner.ifs_morph
            return owner, [settings.initial if self.target == "INITIAL" else settings.final]
        if not bpy.ops.object.ifs_morph_add.poll():
            raise IFSError("Objects cannot be added here; switch to Object Mode, in a collection that can be changed.")
        bpy.ops.object.ifs_morph_add(kind=self.target)
        owner = context.view_layer.objects.active
        owner.name = name
        return owner, [owner.ifs_morph.initial, owner.ifs_morph.final]


def _report_attractor(operator, entry: Entry) -> None:
    if preparation.is_running():
        return  # Kernels would have to tell; the panel does so later.
    try:
        entry.ifs().require_attractor()
    except IFSError as error:
        operator.report({"WARNING"}, str(error))


class IFSMORPH_OT_paste_shape(_Choice, bpy.types.Operator):
    """Replace the maps of this shape by a Fractint entry, a flame or rows of numbers from the clipboard"""

    bl_idname = "ifs_morph.paste_shape"
    bl_label = "Paste Shape"
    bl_options = {"REGISTER", "UNDO"}

    end: bpy.props.EnumProperty(name="End", description="Which shape to replace", items=ENDS)
    entry: _entry_property(_read_clipboard)
    read = staticmethod(_read_clipboard)

    poll = classmethod(editable_morph)

    def invoke(self, context, event):
        """Ask which shape to take if there are several."""
        if len(_names(self.read, self)) > 1:
            return self.ask(context)
        return self.execute(context)

    def execute(self, context):
        """Replace the maps."""
        try:
            name, entry, problems = self.chosen()
            shape = shape_of(self, context)
            write_entry(shape, entry)
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        shape.name = name
        fit_window(context.object)
        context.object.update_tag()
        _report(self, problems)
        _report_attractor(self, entry)
        return {"FINISHED"}


class IFSMORPH_OT_copy_shape(bpy.types.Operator):
    """Copy this shape to the clipboard as text for other programs"""

    bl_idname = "ifs_morph.copy_shape"
    bl_label = "Copy Shape"

    end: bpy.props.EnumProperty(name="End", description="Which shape to copy", items=ENDS)
    format: bpy.props.EnumProperty(name="Format", description="What kind of text to write", items=FORMATS)

    poll = classmethod(any_morph)

    def execute(self, context):
        """Put the shape on the clipboard."""
        try:
            entry = shape_entry(shape_of(self, context), self.end.title())
            text = write_text([entry], f".{self.format.lower()}")
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        set_clipboard(text)
        self.report({"INFO"}, f"Copied “{entry.name}”.")
        return {"FINISHED"}


class IFSMORPH_OT_export_shapes(ExportHelper, bpy.types.Operator):
    """Write shapes of the active morph into a file for Fractint or fractal flame programs"""

    bl_idname = "ifs_morph.export_shapes"
    bl_label = "Export Shapes"
    bl_options = {"REGISTER"}

    filename_ext = ".ifs"
    filter_glob: bpy.props.StringProperty(description="Which files to list", default=FILTER, options={"HIDDEN"})
    format: bpy.props.EnumProperty(name="Format", description="What kind of file to write", items=FORMATS)
    shapes: bpy.props.EnumProperty(
        name="Shapes",
        description="Which shapes to write, one after the other",
        items=WRITTEN,
        options={"ENUM_FLAG"},
        default={"INITIAL", "FINAL"},
    )

    poll = classmethod(any_morph)

    def invoke(self, context, event):
        """Ask for a file named after the object."""
        self.filepath = bpy.path.clean_name(context.object.name) + self._suffix()
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context):
        """Have the name of the file follow the format."""
        path = str(Path(self.filepath).with_suffix(self._suffix())) if Path(self.filepath).name else self.filepath
        changed, self.filepath = path != self.filepath, path
        return changed

    def execute(self, context):
        """Write the file."""
        path = Path(self.filepath)
        if path.suffix.lower() not in SUFFIXES:
            path = Path(f"{path}{self._suffix()}")
        try:
            entries = self._entries(context)
            write_file(path, entries)
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Wrote {' and '.join(f'“{entry.name}”' for entry in entries)}.")
        return {"FINISHED"}

    def _entries(self, context) -> list[Entry]:
        """The chosen shapes, under different names."""
        owner, entries = context.object, []
        for item, title, _ in WRITTEN:
            if item not in self.shapes:
                continue
            if item == "FRAME":
                entries.append(frame_entry(owner.ifs_morph, f"{owner.name} frame {context.scene.frame_current}"))
            else:
                entries.append(shape_entry(getattr(owner.ifs_morph, item.lower()), title))
        return list(with_unique_names(entries))

    def _suffix(self) -> str:
        return f".{self.format.lower()}"


class IFSMORPH_FH_shapes(bpy.types.FileHandler):
    """Files of shapes that are dropped onto the viewport."""

    bl_idname = "IFSMORPH_FH_shapes"
    bl_label = "Fractal Shapes"
    bl_import_operator = IFSMORPH_OT_import_shapes.bl_idname
    bl_file_extensions = ";".join(SUFFIXES)

    @classmethod
    def poll_drop(cls, context):
        """Take them in the viewport."""
        return context.area is not None and context.area.type == "VIEW_3D"


register, unregister = bpy.utils.register_classes_factory(
    (
        IFSMORPH_OT_import_shapes,
        IFSMORPH_OT_paste_shape,
        IFSMORPH_OT_copy_shape,
        IFSMORPH_OT_export_shapes,
        IFSMORPH_FH_shapes,
    )
)
