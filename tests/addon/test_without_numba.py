"""Without numba the extension says what is missing, and does nothing else."""

from tests.addon import another_blender

HIDE = "import sys\nsys.modules['numba'] = None\n"

SCRIPT = """
from types import SimpleNamespace
texts = []
column = SimpleNamespace(label=lambda text="", icon="NONE": texts.append(text))
panels = [cls for cls in bpy.types.Panel.__subclasses__() if "ifs_morph" in cls.__module__]
assert len(panels) == 1, panels
panels[0].draw(SimpleNamespace(layout=SimpleNamespace(column=lambda **_: column)), bpy.context)
print("PANEL", panels[0].bl_category, "|", " ".join(texts))
handlers = [
    function
    for event in dir(bpy.app.handlers)
    if isinstance(getattr(bpy.app.handlers, event), list)
    for function in getattr(bpy.app.handlers, event)
    if "ifs_morph" in function.__module__
]
assert not handlers, handlers
assert not hasattr(bpy.types.Object, "ifs_morph")
assert not [cls for cls in bpy.types.Operator.__subclasses__() if "ifs_morph" in cls.__module__]
assert not [name for name in sys.modules if "ifs_morph.core" in name]
bpy.ops.mesh.primitive_cube_add()
bpy.context.scene.frame_set(2)
for _ in range(2):
    addon_utils.disable("bl_ext.user_default.ifs_morph")
    assert not panels[0].is_registered
    addon_utils.enable("bl_ext.user_default.ifs_morph")
    assert panels[0].is_registered
"""


def test_panel_says_that_numba_is_missing(extension):
    printed = another_blender.run(SCRIPT, start=HIDE + another_blender.START)
    sentence = next(line for line in printed.splitlines() if line.startswith("PANEL"))
    assert sentence.startswith("PANEL IFS Morph |")
    assert "needs the Python module numba" in sentence
    assert sentence.count(".") == 1
