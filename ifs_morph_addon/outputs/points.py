"""The attractor as points: a mesh of vertices, which a node group turns into a point cloud.

Meshes rather than point clouds, since these cannot be resized before Blender 5.1.
"""

import bpy
import numpy as np

from ...core.cloud import point_cloud
from ...core.ifs import IFSError
from ..conversion import frame_colors
from . import materials
from .placing import origin_and_unit

OWN_DATA = ("nodes", "material")
"""Datablocks of the output settings that no two objects may share; their mesh is one more."""

MODIFIER = "IFS Morph"
"""Name of the modifier that turns vertices into points."""

ATTRIBUTES = {
    "position": ("FLOAT_VECTOR", "vector"),
    "radius": ("FLOAT", "value"),
    "color": ("FLOAT_COLOR", "color"),
    "attractorlet": ("INT", "value"),
}
"""Attributes of a point: their type and the property to set."""


def add_mesh(name: str):
    """Make the mesh that `draw` fills."""
    return bpy.data.meshes.new(name)


def ensure(owner) -> None:
    """Make the datablocks that are missing, be it because the object is new or because somebody deleted them."""
    output = owner.ifs_morph.output
    if output.nodes and output.material:
        return
    output.nodes = output.nodes or _point_nodes(owner.name)
    output.material = output.material or materials.point_material(owner.name)
    connect(owner)


def repair(owner) -> None:
    """Give the object new nodes and put its modifier back."""
    output = owner.ifs_morph.output
    output.nodes = _point_nodes(owner.name)
    connect(owner)


def connect(owner) -> None:
    """Have the modifier use the node group, and both the node group and the object the material."""
    output = owner.ifs_morph.output
    modifier = owner.modifiers.get(MODIFIER)
    if modifier is None:
        modifier = owner.modifiers.new(MODIFIER, "NODES")
    modifier.node_group = output.nodes
    materials.fill_slot(owner, output.material)
    node = output.nodes.nodes.get("Set Material")
    if node is not None:
        node.inputs["Material"].default_value = output.material


def _point_nodes(name: str):
    """Node group: vertices to points, with their radius, color and material.

    One for each object, since points take no material from the object's slots and the ways to give a modifier a
    material of its own differ between Blender versions.
    """
    group = bpy.data.node_groups.new(f"{name} Points", "GeometryNodeTree")
    group.is_modifier = True
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes, links = group.nodes, group.links
    vertices = nodes.new("NodeGroupInput")
    radius = _named_attribute(nodes, "radius", "FLOAT")
    to_points = nodes.new("GeometryNodeMeshToPoints")
    color = _named_attribute(nodes, "color", "FLOAT_COLOR")
    store = nodes.new("GeometryNodeStoreNamedAttribute")
    store.data_type, store.domain = "FLOAT_COLOR", "POINT"
    store.inputs["Name"].default_value = materials.POINT_COLOR
    set_material = nodes.new("GeometryNodeSetMaterial")
    set_material.name = "Set Material"
    points = nodes.new("NodeGroupOutput")
    for node, place in (
        (vertices, (-600, 0)),
        (radius, (-600, -150)),
        (to_points, (-350, 0)),
        (color, (-350, -200)),
        (store, (-100, 0)),
        (set_material, (150, 0)),
        (points, (400, 0)),
    ):
        node.location = place
    links.new(vertices.outputs["Geometry"], to_points.inputs["Mesh"])
    links.new(radius.outputs["Attribute"], to_points.inputs["Radius"])
    links.new(to_points.outputs["Points"], store.inputs["Geometry"])
    links.new(color.outputs["Attribute"], store.inputs["Value"])
    links.new(store.outputs["Geometry"], set_material.inputs["Geometry"])
    links.new(set_material.outputs["Geometry"], points.inputs["Geometry"])
    return group


def _named_attribute(nodes, name, data_type):
    node = nodes.new("GeometryNodeInputNamedAttribute")
    node.data_type = data_type
    node.inputs["Name"].default_value = name
    return node


def target(owner):
    """Datablock that the attractor goes into; None while somebody edits it, when its data belong to the editor."""
    return None if owner.data.is_editmode else owner.data


def signature(owner, settings, morph, frame) -> tuple:
    """All that the points depend on; last what their letters and colors depend on, which most frames leave alone."""
    if frame is None:
        return ()
    output = settings.output
    chances = address_transitions(morph)
    chances = None if chances is None else chances.tobytes()
    shares = morph.weights_at(0.5).tobytes(), morph.opacity_at(0.5).tobytes(), frame.drawn.tobytes()
    still = output.point_count, *shares, chances, _colors(settings).tobytes()
    return frame.maps.tobytes(), (*output.window, *output.depth), output.point_radius, still


def draw(owner, settings, morph, frame, for_render: bool, before: tuple):
    """Put the points of the attractor, or none, into the mesh; the mesh. It shows what has the signature `before`."""
    mesh = owner.data
    if frame is None:
        mesh.clear_geometry()
        mesh.update_tag()
        return mesh
    output = settings.output
    if not np.isfinite((*output.window, *output.depth)).all():
        raise IFSError("The window holds NaN; fit it again, or give it four numbers.")
    points = point_cloud(
        frame,
        output.point_count,
        morph.weights_at(0.5),
        placing=origin_and_unit(output.window, output.depth),
        address_transitions=address_transitions(morph),
        address_opacity=morph.opacity_at(0.5),
    )
    count = len(points.position)
    if len(mesh.vertices) != count or len(mesh.edges):
        mesh.clear_geometry()
        mesh.vertices.add(count)
        before = ()
    _set(mesh, "position", points.position)
    _set(mesh, "radius", np.multiply(points.radius, np.float32(output.point_radius), out=points.radius))
    if before[-1:] != signature(owner, settings, morph, frame)[-1:] or not _has(mesh, "attractorlet", "color"):
        _set(mesh, "attractorlet", points.attractorlet)
        _set(mesh, "color", np.take(_colors(settings), points.attractorlet, axis=0))
    # Bounds are found anew and the object is evaluated again.
    mesh.update()
    mesh.update_tag()
    return mesh


def address_transitions(morph) -> np.ndarray | None:
    """Transitions (N, N) by which points keep their addresses all along the way; None if all follow all."""
    if morph.initial.transitions is morph.final.transitions is None:
        return None
    return morph.transitions_at(0.5)


def _has(mesh, *names) -> bool:
    """Whether a mesh has attributes as `ATTRIBUTES` says."""
    attributes = [mesh.attributes.get(name) for name in names]
    return all(
        attribute is not None and (attribute.data_type, attribute.domain) == (ATTRIBUTES[name][0], "POINT")
        for name, attribute in zip(names, attributes, strict=True)
    )


def _set(mesh, name, values) -> None:
    data_type, field = ATTRIBUTES[name]
    if not _has(mesh, name):
        if name in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[name])
        mesh.attributes.new(name, data_type, "POINT")
    mesh.attributes[name].data.foreach_set(field, values.ravel())


def _colors(settings) -> np.ndarray:
    """Color (N, 4) of each attractorlet's points."""
    colors = frame_colors(settings)
    if settings.output.point_color == "SINGLE":
        colors[:] = settings.output.color
    return colors
