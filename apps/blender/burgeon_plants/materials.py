"""Materials of ``burgeon`` -> materials of Blender. Those that are alike are one: fifty oaks have one bark."""

import hashlib
import json

import bpy
import numpy as np

KEY = "burgeon_material"
"""Property of a material and of its pictures: what they were made from."""


def of_part(part):
    """The material of a part: one that is there already, else a new one."""
    about, pictures = part.material, dict(part.maps)
    if part.texture is not None:
        pictures["texture"] = part.texture
    # The relief is in the normals.
    pictures.pop("height", None)
    key = _key(about, pictures)
    for there in bpy.data.materials:
        if there.get(KEY) == key:
            return there
    made = bpy.data.materials.new(about["name"])
    made[KEY] = key
    _build(made, about, {name: _image(f"{about['name']} {name}", key, pixels, name) for name, pixels in pictures.items()})
    return made


def forget(materials):
    """Removes materials that plants had, and their pictures, where nothing uses them any more."""
    for material in materials:
        if material is None or KEY not in material or material.users:
            continue
        key = material[KEY]
        bpy.data.materials.remove(material)
        for image in [image for image in bpy.data.images if image.get(KEY) == key and not image.users]:
            bpy.data.images.remove(image)


def _key(about, pictures):
    plain = {name: about[name] for name in ("name", "kind", "base_color", "roughness", "translucency", "double_sided", "cut_out")}
    digest = hashlib.sha256(json.dumps(plain, sort_keys=True).encode())
    for name in sorted(pictures):
        digest.update(f"{name}{pictures[name].shape}".encode())
        digest.update(np.ascontiguousarray(pictures[name]))
    return digest.hexdigest()


def _image(name, key, pixels, kind):
    """A picture, kept in the file; rows of Blender are from the bottom."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True)
    image[KEY] = key
    # Alpha is a mask or a number of its own: colours are not multiplied with it.
    image.alpha_mode = "CHANNEL_PACKED"
    if kind != "texture":
        image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set((pixels[::-1].astype(np.float32) / 255.0).reshape(-1))
    image.pack()
    return image


def _build(made, about, pictures):
    """Nodes: texture, colour and tint of vertices -> Principled BSDF; a share of light passes through blades; holes."""
    if bpy.app.version < (5, 0, 0):
        # Later materials always have nodes.
        made.use_nodes = True
    made.use_backface_culling = not about["double_sided"]
    made.diffuse_color = (*about["base_color"], 1.0)
    made.roughness = about["roughness"]
    tree = made.node_tree
    tree.nodes.clear()
    place = iter(range(-1400, 10_000, 220))

    def node(kind, **fields):
        new = tree.nodes.new(kind)
        new.location = (next(place), 0 if kind.startswith("ShaderNodeBsdf") else -300 * (kind == "ShaderNodeTexImage"))
        for name, value in fields.items():
            setattr(new, name, value)
        return new

    def times(first, second):
        """The product of two colours."""
        mix = node("ShaderNodeMix", data_type="RGBA", blend_type="MULTIPLY")
        mix.inputs["Factor"].default_value = 1.0
        for socket, value in ((mix.inputs[6], first), (mix.inputs[7], second)):
            if isinstance(value, bpy.types.NodeSocket):
                tree.links.new(value, socket)
            else:
                socket.default_value = (*value, 1.0)
        return mix.outputs[2]

    shown = {}
    for name, image in pictures.items():
        shown[name] = node("ShaderNodeTexImage", image=image, label=name)
    shader = node("ShaderNodeBsdfPrincipled")
    shader.inputs["Roughness"].default_value = about["roughness"]
    colour = about["base_color"]
    if "texture" in shown:
        colour = shown["texture"].outputs["Color"] if min(colour) == 1.0 else times(colour, shown["texture"].outputs["Color"])
    colour = times(colour, node("ShaderNodeVertexColor", layer_name="tint").outputs["Color"])
    tree.links.new(colour, shader.inputs["Base Color"])
    normal = None
    if "normal" in shown:
        relief = node("ShaderNodeNormalMap", uv_map="UVMap")
        tree.links.new(shown["normal"].outputs["Color"], relief.inputs["Color"])
        normal = relief.outputs["Normal"]
        tree.links.new(normal, shader.inputs["Normal"])
    if "orm" in shown:
        parts = node("ShaderNodeSeparateColor")
        tree.links.new(shown["orm"].outputs["Color"], parts.inputs["Color"])
        rough = node("ShaderNodeMath", operation="MULTIPLY")
        tree.links.new(parts.outputs["Green"], rough.inputs[0])
        rough.inputs[1].default_value = about["roughness"]
        tree.links.new(rough.outputs["Value"], shader.inputs["Roughness"])
    surface = shader.outputs["BSDF"]
    if about["translucency"] > 0.0 and about["double_sided"]:
        behind = node("ShaderNodeBsdfTranslucent")
        tree.links.new(colour, behind.inputs["Color"])
        if normal:
            tree.links.new(normal, behind.inputs["Normal"])
        share = node("ShaderNodeMath", operation="MULTIPLY", label="translucency")
        share.inputs[0].default_value = share.inputs[1].default_value = 1.0
        share.inputs[0].default_value = about["translucency"]
        if "through" in shown:
            tree.links.new(shown["through"].outputs["Alpha"], share.inputs[1])
        mixed = node("ShaderNodeMixShader")
        tree.links.new(share.outputs["Value"], mixed.inputs["Fac"])
        tree.links.new(surface, mixed.inputs[1])
        tree.links.new(behind.outputs["BSDF"], mixed.inputs[2])
        surface = mixed.outputs["Shader"]
    if about["cut_out"] and "texture" in shown:
        whole = node("ShaderNodeMath", operation="GREATER_THAN", label="cut out")
        whole.inputs[1].default_value = 0.5
        tree.links.new(shown["texture"].outputs["Alpha"], whole.inputs[0])
        cut = node("ShaderNodeMixShader")
        tree.links.new(whole.outputs["Value"], cut.inputs["Fac"])
        tree.links.new(node("ShaderNodeBsdfTransparent").outputs["BSDF"], cut.inputs[1])
        tree.links.new(surface, cut.inputs[2])
        surface = cut.outputs["Shader"]
    tree.links.new(surface, node("ShaderNodeOutputMaterial").inputs["Surface"])
