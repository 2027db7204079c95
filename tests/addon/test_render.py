"""The picture is core's to the bit, and Cycles shows the one that belongs to the frame."""

from itertools import pairwise
from pathlib import Path

import bpy
import numpy as np
import pytest

from tests.addon import another_blender
from tests.addon.support import add, picture, pixels, show

FRAMES = (1, 2, 3)


def _by_core(owner, extension, u, v):
    """The picture of an image plane, from the stored maps by core alone."""
    core, settings = extension.core, owner.ifs_morph
    shapes = [
        core.ifs.IFS([[list(row) for row in item.matrix] for item in shape.maps])
        for shape in (settings.initial, settings.final)
    ]
    morph = core.morph.Morph(*shapes)
    output, mode = settings.output, settings.output.mode.lower()
    factor = output.antialiasing
    norms = np.max([morph.at(t, t).norms for t in np.linspace(0, 1, 129)], axis=0)
    frame = morph.at(u, v)
    samples = core.raster.render(
        frame,
        (factor * output.resolution[0], factor * output.resolution[1]),
        tuple(output.window),
        mode,
        norms=np.maximum(norms, frame.norms),
    )
    if mode == "set":
        colors = np.float32(output.color)
    elif mode == "density":
        steps = np.linspace(0, 1, core.shading.RAMP_ENTRIES)
        colors = np.float32([output.ramp.color_ramp.evaluate(step) for step in steps])
    else:
        ends = [np.float32([item.color for item in shape.maps]) for shape in (settings.initial, settings.final)]
        colors = np.ones((len(ends[0]), 4), dtype=np.float32)
        colors[:, :3] = (1 - np.float32(u)) * ends[0] + np.float32(u) * ends[1]
    tone = output.curve.lower(), output.exposure, output.gamma
    return core.shading.shade(samples, mode, colors, tuple(output.background), factor, *tone, premultiplied=True)


@pytest.mark.parametrize("mode", ["SET", "DENSITY", "ATTRACTORLET"])
@pytest.mark.parametrize("place", [(0, 0), (1, 1), (0.25, 0.75)])
def test_picture_is_that_of_core(scene, extension, mode, place):
    owner = add("IMAGE")
    output = owner.ifs_morph.output
    output.mode, output.background, output.antialiasing = mode, (0.25, 0.5, 0.125, 0.5), 3
    output.curve, output.exposure, output.gamma = "GAMMA", 1.5, 1.5
    output.resolution = 48, 40
    owner.ifs_morph.final.maps[0].color = 1, 0, 1
    owner.ifs_morph.uv = place
    show()
    np.testing.assert_allclose(picture(owner), _by_core(owner, extension, *place), atol=1e-6)


def test_picture_follows_an_edited_ramp(scene, extension):
    owner = add("IMAGE")
    owner.ifs_morph.output.mode = "DENSITY"
    show()
    before = picture(owner)
    owner.ifs_morph.output.ramp.color_ramp.elements[2].color = 0, 1, 1, 1
    show()
    assert not np.array_equal(picture(owner), before)
    np.testing.assert_allclose(picture(owner), _by_core(owner, extension, 0, 0), atol=1e-6)


@pytest.fixture
def rendered(scene, tmp_path):
    """A morph that Cycles renders quickly, over a few frames; the folder for its frames."""
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.device, scene.cycles.use_denoising = 2, "CPU", False
    scene.render.image_settings.file_format = "PNG"
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    scene.render.filepath = str(tmp_path / "frame_")
    return tmp_path


def _frames(folder, prefix="frame_"):
    images = [bpy.data.images.load(str(folder / f"{prefix}{frame:04d}.png")) for frame in FRAMES]
    return [pixels(image) for image in images]


ALONE = """
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
scene = bpy.context.scene
scene.render.filepath = sys.argv[2]
for frame in map(int, sys.argv[3:]):
    scene.frame_start = scene.frame_end = frame
    bpy.ops.render.render(animation=True)
"""


def _render_alone(file, prefix):
    bpy.ops.wm.open_mainfile(filepath=str(file))
    scene = bpy.context.scene
    scene.render.filepath = str(prefix)
    for frame in reversed(FRAMES):
        scene.frame_start = scene.frame_end = frame
        bpy.ops.render.render(animation=True)


@pytest.mark.parametrize("kind", ["IMAGE", "POINTS"])
def test_cycles_renders_any_frame_as_in_the_whole_animation(rendered, scene, kind):
    owner = add(kind)
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = FRAMES[0], FRAMES[-1]
    bpy.ops.ifs_morph.key_straight()
    file = rendered / "morph.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    bpy.ops.render.render(animation=True)
    whole = _frames(rendered)
    assert 0.02 < np.mean(whole[0][..., :3].max(axis=2) > 0.2) < 0.9
    for earlier, later in pairwise(whole):
        assert np.mean(np.abs(earlier - later).max(axis=2) > 0.1) > 0.02
    if kind == "IMAGE":
        another_blender.run(ALONE, file, rendered / "alone_", *reversed(FRAMES))
    else:
        _render_alone(file, rendered / "alone_")
    for frame, together, alone in zip(FRAMES, whole, _frames(rendered, "alone_"), strict=True):
        np.testing.assert_array_equal(alone, together, err_msg=f"frame {frame}")


@pytest.mark.parametrize("kind", ["IMAGE", "POINTS"])
def test_persistent_data_changes_nothing(rendered, scene, kind):
    owner = add(kind)
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = FRAMES[0], FRAMES[-1]
    bpy.ops.ifs_morph.key_straight()
    bpy.ops.render.render(animation=True)
    scene.render.use_persistent_data = True
    scene.render.filepath = str(rendered / "kept_")
    bpy.ops.render.render(animation=True)
    for frame, plain, kept in zip(FRAMES, _frames(rendered), _frames(rendered, "kept_"), strict=True):
        np.testing.assert_array_equal(kept, plain, err_msg=f"frame {frame}")


def test_motion_blur_shows_the_frame(rendered, scene):
    owner = add("IMAGE")
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = FRAMES[0], FRAMES[-1]
    bpy.ops.ifs_morph.key_straight()
    bpy.ops.render.render(animation=True)
    scene.render.use_motion_blur = True
    scene.render.filepath = str(rendered / "blurred_")
    bpy.ops.render.render(animation=True)
    plain, blurred = _frames(rendered), _frames(rendered, "blurred_")
    for k, picture_of_frame in enumerate(blurred):
        distances = [np.abs(picture_of_frame - other).mean() for other in plain]
        assert np.argmin(distances) == k


def test_render_leaves_the_pictures_of_the_viewport(rendered, scene):
    owner = add("IMAGE")
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = FRAMES[0], FRAMES[-1]
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(2)
    before = picture(owner)
    bpy.ops.render.render(animation=True)
    assert scene.frame_current == 2
    show()
    np.testing.assert_array_equal(picture(owner), before)
    assert Path(rendered / "frame_0003.png").exists()
