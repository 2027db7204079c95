"""Shapes from files, from the clipboard and dropped onto the viewport; and into files again."""

import bpy
import numpy as np
import pytest

from core.formats import read_file, read_text, write_shapes
from core.shapes import SHAPES
from tests.addon.interface import reason
from tests.addon.support import add, content, show

LEVY = "Levy {; The Levy Dragon\n 0.5, -0.5,  0.5,  0.5,  0,  0\n 0.5,  0.5, -0.5,  0.5,  0.5,  0.5\n}"

FLAME = """<flames>
<flame name="bent"><xform weight="1" spherical="1" coefs="0.5 0 0 0.5 0 0"/></flame>
<flame name="flat"><xform weight="1" color="0" linear="1" coefs="0.5 0 0 0.5 0 0"/>\
<xform weight="3" color="1" linear="1" coefs="0.5 0 0 0.25 0.5 -0.5"/>\
<palette count="2" format="RGB">FF00000000FF</palette></flame>
<flame name="tiles"><xform weight="1" linear="1" chaos="0 1" coefs="0.5 0 0 0.5 0 0"/>\
<xform weight="1" linear="1" coefs="0.5 0 0 0.5 1 0"/></flame>
<flame name="broad"><xform weight="1" linear="1" coefs="0.5 0 0 0.5 1e7 0"/></flame>
</flames>"""


@pytest.fixture
def owner(scene):
    return add("IMAGE")


@pytest.fixture
def flame(tmp_path):
    path = tmp_path / "some.flame"
    path.write_text(FLAME)
    return str(path)


@pytest.fixture
def library(tmp_path):
    path = tmp_path / "library.ifs"
    write_shapes(path, SHAPES)
    return str(path)


def matrices(shape):
    """Maps (N, 2, 3) of a shape."""
    return np.array([[list(row) for row in item.matrix] for item in shape.maps])


def state(owner):
    """All that an import may change, as text."""
    settings = owner.ifs_morph
    shapes = settings.initial, settings.final
    return repr(
        [
            (shape.name, [(i.name, matrices(shape).tolist(), i.weight, tuple(i.color)) for i in shape.maps])
            for shape in shapes
        ]
    )


def problems(operator, **options):
    """What an operator that fails says."""
    with pytest.raises(RuntimeError) as error:
        operator(**options)
    return str(error.value)


# ---- in --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("target", "changed"), [("INITIAL", "initial"), ("FINAL", "final")])
def test_a_shape_of_a_file_becomes_an_end_of_the_morph(owner, library, target, changed):
    kept = {"initial": "final", "final": "initial"}[changed]
    before, picture = matrices(getattr(owner.ifs_morph, kept)).tolist(), content(owner)
    owner.ifs_morph.uv = (0, 0) if target == "INITIAL" else (1, 1)
    assert bpy.ops.ifs_morph.import_shapes(filepath=library, entry="Koch snowflake", target=target) == {"FINISHED"}
    shape = getattr(owner.ifs_morph, changed)
    assert shape.name == "Koch snowflake"
    np.testing.assert_array_equal(matrices(shape), SHAPES["Koch snowflake"].maps.astype(np.float32))
    assert matrices(getattr(owner.ifs_morph, kept)).tolist() == before
    bpy.ops.ifs_morph.import_shapes(filepath=library, entry="Koch snowflake", target="INITIAL")
    bpy.ops.ifs_morph.import_shapes(filepath=library, entry="Koch snowflake", target="FINAL")
    show()
    assert content(owner) != picture


def test_imported_shape_is_the_shape_of_the_library(owner, library):
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
    loaded = state(owner)
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="square")
    bpy.ops.ifs_morph.import_shapes(filepath=library, entry="Barnsley fern", target="INITIAL")
    assert state(owner) == loaded


def test_first_shape_is_taken_without_a_name(owner, library):
    bpy.ops.ifs_morph.import_shapes(filepath=library, target="FINAL")
    assert owner.ifs_morph.final.name == next(iter(SHAPES))


def test_weights_and_colors_of_a_flame(owner, flame):
    bpy.ops.ifs_morph.import_shapes(filepath=flame, entry="flat", target="FINAL")
    final = owner.ifs_morph.final
    np.testing.assert_allclose([item.weight for item in final.maps], [0.25, 0.75])
    np.testing.assert_allclose([tuple(item.color) for item in final.maps], [(1, 0, 0), (0, 0, 1)], atol=1e-4)
    np.testing.assert_array_equal(matrices(final)[1], [[0.5, 0, 0.5], [0, 0.25, 0.5]])


@pytest.mark.parametrize("kind", ["IMAGE", "POINTS"])
def test_a_shape_becomes_a_new_object(scene, library, kind):
    assert bpy.ops.ifs_morph.import_shapes(filepath=library, entry="terdragon", target=kind) == {"FINISHED"}
    owner = bpy.context.object
    assert (owner.name, owner.ifs_morph.kind) == ("terdragon", kind)
    for shape in (owner.ifs_morph.initial, owner.ifs_morph.final):
        assert shape.name == "terdragon"
        np.testing.assert_array_equal(matrices(shape), SHAPES["terdragon"].maps.astype(np.float32))
    show()
    assert len(set(content(owner))) > 1


def test_files_dropped_together_are_one_choice(owner, tmp_path, flame):
    (tmp_path / "levy.ifs").write_text(LEVY)
    files = [{"name": "some.flame"}, {"name": "levy.ifs"}]
    bpy.ops.ifs_morph.import_shapes(directory=str(tmp_path), files=files, entry="Levy", target="FINAL")
    assert owner.ifs_morph.final.name == "Levy"
    assert [item.weight for item in owner.ifs_morph.final.maps] == [0, 0], "left to the areas of the maps"


def test_a_dropped_file_that_cannot_be_read_leaves_the_others(owner, tmp_path, capfd):
    (tmp_path / "levy.ifs").write_text(LEVY)
    (tmp_path / "empty.ifs").write_text("")
    (tmp_path / "words.flame").write_text("nothing of the kind")
    names = ["empty.ifs", "words.flame", "gone.ifs", "levy.ifs"]
    bpy.ops.ifs_morph.import_shapes(directory=str(tmp_path), files=[{"name": name} for name in names], target="FINAL")
    assert owner.ifs_morph.final.name == "Levy"
    said = capfd.readouterr().out
    for name in names[:3]:
        assert f"“{name}”" in said
    files = [{"name": name} for name in names[:3]]
    said = problems(bpy.ops.ifs_morph.import_shapes, directory=str(tmp_path), files=files, target="FINAL")
    for name in names[:3]:
        assert f"“{name}”" in said


def test_what_is_wrong_with_a_file_is_said(owner, flame, capfd):
    bpy.ops.ifs_morph.import_shapes(filepath=flame, entry="flat", target="FINAL")
    said = capfd.readouterr().out
    assert "“bent”, map 1: spherical is not a linear variation" in said
    assert "“broad”, map 1: a map on an object has no numbers beyond" in said


def test_a_shape_without_an_attractor_is_loaded_and_said(owner, tmp_path, capfd):
    path = tmp_path / "wide.ifs"
    path.write_text("wide { 2 0 0 2 0 0 1 }")
    bpy.ops.ifs_morph.import_shapes(filepath=str(path), target="FINAL")
    assert owner.ifs_morph.final.name == "wide"
    assert "does not contract" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("contents", "options", "said"),
    [
        ("nothing", {}, "There are no shapes"),
        (LEVY, {"entry": "Koch"}, "There is no shape “Koch”; there are Levy."),
        (LEVY.replace("}", ""), {}, "ends without a closing brace"),
        (FLAME.replace("linear", "swirl"), {}, "“flat”, map 1: swirl is not a linear variation"),
        ("a { 1e7 0 0 1 0 0 }", {}, "no numbers beyond"),
        (None, {}, "cannot be read"),
    ],
)
def test_errors_change_nothing(owner, tmp_path, contents, options, said):
    path = tmp_path / "a.ifs"
    if contents is not None:
        path.write_text(contents)
    for target in ("INITIAL", "IMAGE"):
        before, objects = state(owner), len(bpy.data.objects)
        assert said in problems(bpy.ops.ifs_morph.import_shapes, filepath=str(path), target=target, **options)
        assert state(owner) == before
        assert len(bpy.data.objects) == objects


def test_nothing_chosen(owner):
    assert "Choose" in problems(bpy.ops.ifs_morph.import_shapes, target="FINAL")


def test_an_end_needs_a_morph(scene, library):
    assert "Select an IFS Morph object" in problems(bpy.ops.ifs_morph.import_shapes, filepath=library, target="FINAL")


def test_a_new_object_needs_object_mode(owner, library):
    bpy.ops.object.mode_set(mode="EDIT")
    assert "Object Mode" in problems(bpy.ops.ifs_morph.import_shapes, filepath=library, target="IMAGE")
    bpy.ops.object.mode_set(mode="OBJECT")


def test_names_to_choose_from(flame, extension):
    """Those of shapes that an object can hold."""
    entries = extension.core.formats.read_file(flame).entries
    usable, problems = extension.ifs_morph_addon.operators.files._usable(entries, ["before"])
    assert list(usable) == ["flat", "tiles"]
    assert len(problems) == 2


# ---- the clipboard ---------------------------------------------------------------------------------------------------


@pytest.fixture
def clipboard(extension, monkeypatch):
    """Stand in for the clipboard, which Blender has in a window only; its text is the single item."""
    files = extension.ifs_morph_addon.operators.files
    held = [""]
    monkeypatch.setattr(files, "clipboard", lambda: held[0])
    monkeypatch.setattr(files, "set_clipboard", lambda text: held.__setitem__(0, text))
    return held


@pytest.mark.parametrize("form", ["IFS", "FLAME"])
def test_copy_and_paste(owner, clipboard, form):
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="maple leaf")
    assert bpy.ops.ifs_morph.copy_shape(end="INITIAL", format=form) == {"FINISHED"}
    assert list(read_text(clipboard[0]).shapes) == ["maple leaf"]
    assert bpy.ops.ifs_morph.paste_shape(end="FINAL") == {"FINISHED"}
    initial, final = owner.ifs_morph.initial, owner.ifs_morph.final
    assert final.name == "maple leaf"
    np.testing.assert_array_equal(matrices(final), matrices(initial))
    np.testing.assert_allclose([item.weight for item in final.maps], [item.weight for item in initial.maps], rtol=1e-6)


def test_paste_numbers(owner, clipboard):
    clipboard[0] = ".5\t0\t0\t.5\t0\t0\n.5\t0\t0\t.5\t.5\t0\n"
    bpy.ops.ifs_morph.paste_shape(end="FINAL")
    assert owner.ifs_morph.final.name == "Pasted"
    np.testing.assert_array_equal(matrices(owner.ifs_morph.final)[1], [[0.5, 0, 0.5], [0, 0.5, 0]])


def test_paste_one_of_several(owner, clipboard, library):
    clipboard[0] = FLAME + FLAME.replace("flat", "second")
    bpy.ops.ifs_morph.paste_shape(end="FINAL", entry="second")
    assert owner.ifs_morph.final.name == "second"


@pytest.mark.parametrize(
    ("text", "said"),
    [("", "There is no text"), ("hello", "There are no shapes"), ("a { 1 2 x }", "“x” is not a number")],
)
def test_what_cannot_be_pasted_changes_nothing(owner, clipboard, text, said):
    clipboard[0], before = text, state(owner)
    assert said in problems(bpy.ops.ifs_morph.paste_shape, end="FINAL")
    assert state(owner) == before


# ---- out -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".ifs", ".flame", ".flam3"])
@pytest.mark.parametrize("name", ["maple leaf", "Barnsley fern", "Koch curve"])
def test_export_reads_back_as_it_was(owner, tmp_path, suffix, name):
    for end, shape in (("INITIAL", name), ("FINAL", "square")):
        bpy.ops.ifs_morph.load_shape(end=end, shape=shape)
    path = tmp_path / f"out{suffix}"
    assert bpy.ops.ifs_morph.export_shapes(filepath=str(path), shapes={"INITIAL", "FINAL"}) == {"FINISHED"}
    assert list(read_file(path).shapes) == [name, "square"]
    before = state(owner)
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="gasket")
    bpy.ops.ifs_morph.import_shapes(filepath=str(path), entry=name, target="INITIAL")
    assert np.allclose(matrices(owner.ifs_morph.initial), SHAPES[name].maps, rtol=1e-6)
    after = state(owner)
    if suffix == ".ifs":
        assert after == before
    else:
        bpy.ops.ifs_morph.export_shapes(filepath=str(path), shapes={"INITIAL"})
        bpy.ops.ifs_morph.import_shapes(filepath=str(path), target="INITIAL")
        assert state(owner) == after


def test_numbers_are_written_as_they_are_shown(owner, tmp_path):
    path = tmp_path / "fern.ifs"
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
    bpy.ops.ifs_morph.export_shapes(filepath=str(path), shapes={"INITIAL"})
    assert "  0.85 0.04 -0.04 0.85 0.0 1.6 " in path.read_text()


def test_colors_are_written_into_a_flame(owner, tmp_path):
    path = tmp_path / "a.flame"
    owner.ifs_morph.initial.maps[0].color = 1, 0, 0
    owner.ifs_morph.initial.maps[2].color = 0, 0, 1
    bpy.ops.ifs_morph.export_shapes(filepath=str(path), shapes={"INITIAL"})
    (entry,) = read_file(path).entries
    np.testing.assert_array_equal(entry.palette[[0, -1]], [[255, 0, 0], [0, 0, 255]])
    np.testing.assert_array_equal(entry.colors[[0, 2]], [0, 1])


def test_current_frame_is_the_shape_that_is_shown(owner, tmp_path, extension):
    path = tmp_path / "frame.ifs"
    bpy.context.scene.frame_set(7)
    owner.ifs_morph.uv = 0.25, 0.75
    owner.ifs_morph.swell = 0.125
    bpy.ops.ifs_morph.export_shapes(filepath=str(path), shapes={"FRAME"})
    (ifs,) = read_file(path).shapes.values()
    assert ifs.name == f"{owner.name} frame 7"
    shown = extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph).at(0.25, 0.75, 0.125)
    assert ifs.maps.tobytes() == shown.maps.tobytes()


def test_format_is_appended_to_a_bare_name(owner, tmp_path):
    bpy.ops.ifs_morph.export_shapes(filepath=str(tmp_path / "v1.0 leaf"), format="FLAME")
    assert (tmp_path / "v1.0 leaf.flame").exists()


def test_export_that_fails_leaves_the_file(owner, tmp_path):
    path = tmp_path / "a.flame"
    path.write_text("before")
    owner.ifs_morph.initial.name = "a\x01"
    assert "choose another" in problems(bpy.ops.ifs_morph.export_shapes, filepath=str(path))
    assert path.read_text() == "before"
    owner.ifs_morph.initial.maps.clear()
    assert "no maps" in problems(bpy.ops.ifs_morph.export_shapes, filepath=str(path))
    assert "There are no shapes" in problems(bpy.ops.ifs_morph.export_shapes, filepath=str(path), shapes=set())
    assert "cannot be written" in problems(
        bpy.ops.ifs_morph.export_shapes, filepath=str(tmp_path / "no" / "a.ifs"), shapes={"FINAL"}
    )


def test_export_needs_a_morph(scene):
    assert "Select an IFS Morph object" in reason(bpy.ops.ifs_morph.export_shapes)
    assert "Select an IFS Morph object" in reason(bpy.ops.ifs_morph.copy_shape)
    assert "Select an IFS Morph object" in reason(bpy.ops.ifs_morph.paste_shape)


# ---- where they are found --------------------------------------------------------------------------------------------


def test_dropped_files_are_handled(extension):
    handler = bpy.types.IFSMORPH_FH_shapes
    assert handler.bl_import_operator == "ifs_morph.import_shapes"
    assert handler.bl_file_extensions == ".ifs;.flame;.flam3"
    assert {"filepath", "directory", "files"} <= set(bpy.ops.ifs_morph.import_shapes.get_rna_type().properties.keys())


@pytest.mark.parametrize("menu", ["TOPBAR_MT_file_import", "TOPBAR_MT_file_export"])
def test_file_menus(extension, menu):
    entries = getattr(bpy.types, menu)._dyn_ui_initialize()
    assert extension.ifs_morph_addon.ui.files.__name__ in {entry.__module__ for entry in entries}
