"""The node group that moves a mesh in the wind: the shader of docs/exports.md, in Blender's axes.

A mesh of a plant has its attributes: ``wind`` (sway of the plant, of the limb, flutter, phase) and ``pivot``.
"""

import bpy

from . import meshes

GROUP = "Burgeon Wind"
MODIFIER = "Wind"


def add(plant, gust):
    """Has wind blow on an object, ``gust`` metres at its top; what it has already is set."""
    modifier = plant.modifiers.get(MODIFIER) or plant.modifiers.new(MODIFIER, "NODES")
    modifier.node_group = group()
    modifier[_identifier(modifier.node_group, "Gust")] = gust
    return modifier


def can(object_):
    """Whether an object has what wind needs."""
    return object_ is not None and object_.type == "MESH" and meshes.WIND in object_.data.attributes


def _identifier(tree, name):
    return next(item.identifier for item in tree.interface.items_tree if item.name == name and item.in_out == "INPUT")


def group():
    """The node group; made where the file has none."""
    there = bpy.data.node_groups.get(GROUP)
    if there is not None and there.bl_idname == "GeometryNodeTree":
        return there
    tree = bpy.data.node_groups.new(GROUP, "GeometryNodeTree")
    tree.is_modifier = True
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    for name, kind, default, about in (
        ("Gust", "NodeSocketVector", (0.1, 0.0, 0.0), "Metres at the top of the plant"),
        ("Strength", "NodeSocketFloat", 1.0, "Share of all movement"),
        ("Speed", "NodeSocketFloat", 1.0, "1: as in nature"),
    ):
        socket = tree.interface.new_socket(name, in_out="INPUT", socket_type=kind)
        socket.default_value, socket.description = default, about
        if kind == "NodeSocketVector":
            socket.subtype = "TRANSLATION"
        else:
            socket.min_value, socket.max_value = 0.0, 1.0 if name == "Strength" else 10.0
    _build(tree)
    return tree


def _build(tree):
    column = iter(range(0, 10_000, 180))

    def node(kind, **fields):
        new = tree.nodes.new(kind)
        new.location = (next(column), 0)
        for name, value in fields.items():
            setattr(new, name, value)
        return new

    def put(value, socket):
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = value

    def number(operation, *values):
        made = node("ShaderNodeMath", operation=operation)
        for value, socket in zip(values, made.inputs):
            put(value, socket)
        return made.outputs[0]

    def vector(operation, *values):
        made = node("ShaderNodeVectorMath", operation=operation)
        for value, socket in zip(values, made.inputs):
            put(value, socket)
        return made.outputs["Value" if operation == "DOT_PRODUCT" else "Vector"]

    def scaled(of, by):
        made = node("ShaderNodeVectorMath", operation="SCALE")
        put(of, made.inputs[0])
        put(by, made.inputs["Scale"])
        return made.outputs["Vector"]

    def attribute(name, kind):
        made = node("GeometryNodeInputNamedAttribute", data_type=kind)
        made.inputs["Name"].default_value = name
        return next(socket for socket in made.outputs if socket.name == "Attribute" and socket.enabled)

    asked = node("NodeGroupInput").outputs
    parts = node("FunctionNodeSeparateColor")
    put(attribute(meshes.WIND, "FLOAT_COLOR"), parts.inputs["Color"])
    sway, limb, flutter, phase = (parts.outputs[name] for name in ("Red", "Green", "Blue", "Alpha"))
    pivot, place = attribute(meshes.PIVOT, "FLOAT_VECTOR"), node("GeometryNodeInputPosition").outputs[0]
    time = number("MULTIPLY", node("GeometryNodeInputSceneTime").outputs["Seconds"], asked["Speed"])
    turn = number("MULTIPLY", phase, 6.2832)
    # The whole plant leans and sways; each limb in its own time; each leaf in its own, about where it is fixed.
    lean = number("MULTIPLY", sway, number("MULTIPLY_ADD", number("SINE", number("MULTIPLY", time, 1.1)), 0.4, 0.6))
    swing = number("MULTIPLY", limb, number("SINE", number("MULTIPLY_ADD", time, 2.3, turn)))
    moved = scaled(asked["Gust"], number("ADD", lean, swing))
    own = number("MULTIPLY", number("ADD", phase, vector("DOT_PRODUCT", pivot, (7.1, -3.7, 5.3))), 6.2832)
    beat = number("MULTIPLY", number("SINE", number("MULTIPLY_ADD", time, 9.0, own)), number("MULTIPLY", flutter, 0.25))
    fluttered = scaled(vector("CROSS_PRODUCT", (0.60, -0.48, 0.64), vector("SUBTRACT", place, pivot)), beat)
    whole = scaled(vector("ADD", moved, fluttered), asked["Strength"])
    set_ = node("GeometryNodeSetPosition")
    put(asked["Geometry"], set_.inputs["Geometry"])
    put(whole, set_.inputs["Offset"])
    put(set_.outputs["Geometry"], node("NodeGroupOutput").inputs["Geometry"])
