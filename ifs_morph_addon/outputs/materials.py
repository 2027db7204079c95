"""The materials that show outputs, and the slots that hold them."""

import bpy

from .. import compat

IMAGE_NODE = "IFS Morph Image"
"""Name of the node whose image is kept up to date; a material without it is left alone."""

POINT_COLOR = "point_color"
"""Attribute that the points' material reads. Cycles takes an attribute called ``color`` for a volume's."""


def image_material(name: str):
    """Make a material that glows in the colors of an image and is transparent where the image is."""
    material, nodes, links = _empty_material(name)
    texture = nodes.new("ShaderNodeTexImage")
    texture.name = texture.label = IMAGE_NODE
    texture.extension = "CLIP"
    emission = nodes.new("ShaderNodeEmission")
    transparent = nodes.new("ShaderNodeBsdfTransparent")
    mix = nodes.new("ShaderNodeMixShader")
    output = nodes.new("ShaderNodeOutputMaterial")
    for node, place in (
        (texture, (-500, 0)),
        (emission, (-150, -150)),
        (transparent, (-150, 0)),
        (mix, (80, 0)),
        (output, (300, 0)),
    ):
        node.location = place
    links.new(texture.outputs["Color"], emission.inputs["Color"])
    links.new(texture.outputs["Alpha"], mix.inputs[0])
    links.new(transparent.outputs[0], mix.inputs[1])
    links.new(emission.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def point_material(name: str):
    """Make a material in the colors of the points."""
    material, nodes, links = _empty_material(name)
    attribute = nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = POINT_COLOR
    shader = nodes.new("ShaderNodeBsdfPrincipled")
    output = nodes.new("ShaderNodeOutputMaterial")
    for node, place in ((attribute, (-300, 0)), (shader, (0, 0)), (output, (300, 0))):
        node.location = place
    shader.inputs["Roughness"].default_value = 0.6
    links.new(attribute.outputs["Color"], shader.inputs["Base Color"])
    links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def _empty_material(name):
    material = bpy.data.materials.new(name)
    compat.use_nodes(material)
    material.node_tree.nodes.clear()
    return material, material.node_tree.nodes, material.node_tree.links


def image_node(material):
    """Node of a material that shows the image; None if somebody took it out."""
    return material.node_tree.nodes.get(IMAGE_NODE) if material and material.node_tree else None


def set_image(material, image) -> None:
    """Have a material show an image, unless the node for it was taken out."""
    node = image_node(material)
    if node is not None and node.image != image:
        node.image = image


def fill_slot(owner, material, instead_of=None) -> None:
    """Put a material into the object's first slot where that is empty or holds `instead_of`.

    The slot belongs to the object and not to its data, which copies may share.
    """
    if not owner.material_slots:
        owner.data.materials.append(None)
    slot = owner.material_slots[0]
    if slot.material is None or slot.material == instead_of:
        slot.link = "OBJECT"
        slot.material = material
