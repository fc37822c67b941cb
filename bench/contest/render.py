"""A tree in Cycles, seen from 20 m, 5 m and 1 m under one sun: `python render.py TREE.glb|TREE.json OUT [options]`.

A `.glb` is ours, a `.json` of ez-tree.mjs. Needs `bpy` and, for those, the folder in which ez-tree is installed (`--ez`).
Every tree is scaled to one height, so that the same camera sees the same share of each.
"""

import argparse
import json
import math
from pathlib import Path

import bpy
from mathutils import Vector

VIEWS = {"20m": (20.0, 0.5, 34.0), "5m": (5.0, 0.62, 42.0), "1m": (1.0, 0.5, 50.0)}


def image(path, color=True):
    made = bpy.data.images.load(str(path))
    if not color:
        made.colorspace_settings.name = "Non-Color"
    return made


def material(name, tint, maps, repeat=(1, 1), alpha=None):
    """A principled material with pictures, as a renderer that reads glTF makes one."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    place, uv = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeUVMap")
    links.new(uv.outputs["UV"], place.inputs["Vector"])
    place.inputs["Scale"].default_value = (*repeat, 1)

    def picture(path, color):
        node = nodes.new("ShaderNodeTexImage")
        node.image = image(path, color)
        links.new(place.outputs["Vector"], node.inputs["Vector"])
        return node

    color = picture(maps["color"], True)
    mix = nodes.new("ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs["Factor"].default_value = 1
    mix.inputs[7].default_value = (*tint, 1)
    links.new(color.outputs["Color"], mix.inputs[6])
    links.new(mix.outputs[2], shader.inputs["Base Color"])
    if "roughness" in maps:
        links.new(picture(maps["roughness"], False).outputs["Color"], shader.inputs["Roughness"])
    if "normal" in maps:
        bump = nodes.new("ShaderNodeNormalMap")
        links.new(picture(maps["normal"], False).outputs["Color"], bump.inputs["Color"])
        links.new(bump.outputs["Normal"], shader.inputs["Normal"])
    if alpha is not None:
        cut = nodes.new("ShaderNodeMath")
        cut.operation = "GREATER_THAN"
        cut.inputs[1].default_value = alpha
        links.new(color.outputs["Alpha"], cut.inputs[0])
        links.new(cut.outputs["Value"], shader.inputs["Alpha"])
    return made


def mesh(name, columns, made):
    at = columns["position"]
    # Y is up there.
    points = [(at[i], -at[i + 2], at[i + 1]) for i in range(0, len(at), 3)]
    index = columns["index"]
    shape = bpy.data.meshes.new(name)
    shape.from_pydata(points, [], [index[i : i + 3] for i in range(0, len(index), 3)])
    layer, uv = shape.uv_layers.new(name="UVMap"), columns["uv"]
    for loop in shape.loops:
        layer.data[loop.index].uv = uv[2 * loop.vertex_index : 2 * loop.vertex_index + 2]
    shape.materials.append(made)
    shape.shade_smooth()
    bpy.context.collection.objects.link(bpy.data.objects.new(name, shape))


def load(path, ez):
    if path.suffix == ".glb":
        bpy.ops.import_scene.gltf(filepath=str(path))
        return
    tree = json.loads(path.read_text())
    assets = ez / "node_modules/@dgreenheck/ez-tree/src/lib/assets"
    maps = {k: assets / "bark" / f"{tree['bark']}_{k}_1k.jpg" for k in ("color", "normal", "roughness")}
    mesh("branches", tree["branches"], material("bark", tree["branches"]["tint"], maps, tree["repeat"]))
    leaf = {"color": assets / "leaves" / f"{tree['leaf']}_color.png"}
    made = material("leaf", tree["leaves"]["tint"], leaf, alpha=tree["leaves"]["alphaTest"] or 0.5)
    mesh("leaves", tree["leaves"], made)


def scaled(height):
    """All meshes as one tree of this height, its origin on the ground; corners of what hangs in the crown."""
    objects = [o for o in bpy.context.scene.objects if o.type == "MESH"]
    corners = [o.matrix_world @ Vector(c) for o in objects for c in o.bound_box]
    high = max(c.z for c in corners)
    root = bpy.data.objects.new("tree", None)
    bpy.context.collection.objects.link(root)
    for o in objects:
        o.parent = root
    root.scale = [height / high] * 3
    bpy.context.view_layer.update()
    return [o.matrix_world @ v.co for o in objects for v in o.data.vertices]


def scene(samples, size):
    s = bpy.context.scene
    s.render.engine = "CYCLES"
    s.cycles.device, s.cycles.samples, s.cycles.use_denoising = "CPU", samples, True
    s.cycles.transparent_max_bounces = 32
    s.render.resolution_x = s.render.resolution_y = size
    s.render.image_settings.file_format, s.render.image_settings.quality = "JPEG", 88
    s.view_settings.view_transform = "AgX"
    s.world = bpy.data.worlds.new("sky")
    s.world.use_nodes = True
    sky = s.world.node_tree.nodes["Background"]
    sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (0.55, 0.72, 1.0, 1), 0.9
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.data.color = 4.0, 0.01, (1.0, 0.93, 0.82)
    sun.rotation_euler = (math.radians(48), 0, math.radians(40))
    s.collection.objects.link(sun)
    bpy.ops.mesh.primitive_plane_add(size=400)
    ground = bpy.data.materials.new("ground")
    ground.use_nodes = True
    ground.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.22, 0.24, 0.15, 1)
    bpy.context.object.data.materials.append(ground)
    s.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    s.collection.objects.link(s.camera)
    return s


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("tree", type=Path)
    ask.add_argument("out", type=Path)
    ask.add_argument("--ez", type=Path, default=Path("."))
    ask.add_argument("--height", type=float, default=10.0)
    ask.add_argument("--samples", type=int, default=24)
    ask.add_argument("--size", type=int, default=400)
    ask.add_argument("--threads", type=int, default=2)
    args = ask.parse_args()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    load(args.tree, args.ez)
    points = scaled(args.height)
    s = scene(args.samples, args.size)
    s.render.threads_mode, s.render.threads = "FIXED", args.threads
    for name, (far, share, angle) in VIEWS.items():
        # Towards the viewer, who stands at -Y: what is foremost at this height. At 20 m the tree as a whole.
        level = [p for p in points if abs(p.z - share * args.height) < 0.35 and abs(p.x) < 0.15 * args.height]
        front = min(level or points, key=lambda p: p.y)
        aim = Vector((0, 0, share * args.height)) if far > 10 else front
        from_height = 1.7 if far > 10 else aim.z - 0.25 * far
        s.camera.location = (aim.x + 0.15 * far, aim.y - far, from_height)
        s.camera.rotation_euler = (aim - s.camera.location).to_track_quat("-Z", "Y").to_euler()
        s.camera.data.angle = math.radians(angle)
        s.render.filepath = f"{args.out}-{name}.jpg"
        bpy.ops.render.render(write_still=True)


main()
