"""A tree of Blender's Sapling Tree Gen as a model that `render.py` takes: `python sapling.py FOLDER PRESET OUT.glb [options]`.

FOLDER is that of Sapling, with its `__init__.py`, `utils.py` and `presets`: version 0.3, as in `scripts/addons/add_curve_sapling`
of Blender up to 4.1, or in the archive of its extension. Nothing of it is here. The tree is that of the preset, with its own
seed unless `--seed`, all its levels and its leaves. Sapling has no materials, so bark and leaves have one colour each.
"""

import argparse
import importlib.util
import os
import re
import sys
import time
from pathlib import Path

import bpy


def sapling(folder, preset):
    """The extension as a package of its own name, whatever lies beside it, if it has this preset."""
    missing = [name for name in ("__init__.py", "utils.py", "presets") if not (folder / name).exists()]
    if missing:
        sys.exit(f"{folder} is not the folder of Sapling 0.3: it has no {', '.join(missing)}.")
    presets = sorted(p.stem for p in (folder / "presets").glob("*.py"))
    if preset not in presets:
        sys.exit(f"no preset {preset}; there are {', '.join(presets)}.")
    spec = importlib.util.spec_from_file_location(
        "add_curve_sapling", folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    made = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = made
    spec.loader.exec_module(made)
    if not hasattr(made, "ImportData"):
        sys.exit(f"{folder} has another Sapling than 0.3: it has no operator that loads a preset.")
    return made


def version(made, folder):
    """Of an add-on in its table, of an extension in its manifest."""
    manifest = folder / "blender_manifest.toml"
    if manifest.exists():
        return re.search(r'^version = "(.+)"', manifest.read_text(), re.M)[1]
    return ".".join(str(n) for n in made.bl_info["version"])


def color(text):
    """A colour of the web, `#rrggbb`, in linear light."""
    if not re.fullmatch("#[0-9a-fA-F]{6}", text):
        raise argparse.ArgumentTypeError(f"{text} is not a colour like #8a7a5c")
    at = [int(text[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    return [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in at]


def colored(name, rgb, roughness):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*rgb, 1)
    shader.inputs["Roughness"].default_value = roughness
    return made


def meshes(materials):
    """The stems, which are a curve, and the leaves as meshes of one material each; their triangles by name."""
    counts = {}
    graph = bpy.context.evaluated_depsgraph_get()
    for old in [o for o in bpy.context.scene.objects if o.type in ("CURVE", "MESH")]:
        shape = bpy.data.meshes.new_from_object(old.evaluated_get(graph))
        name = "stems" if old.type == "CURVE" else "leaves"
        shape.materials.clear()
        shape.materials.append(materials[name])
        if name == "stems":
            shape.shade_smooth()
        new = bpy.data.objects.new(name, shape)
        new.matrix_world = old.matrix_world
        bpy.context.collection.objects.link(new)
        bpy.data.objects.remove(old)
        shape.calc_loop_triangles()
        counts[name] = len(shape.loop_triangles)
    return counts


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("folder", type=Path)
    ask.add_argument("preset")
    ask.add_argument("out", type=Path)
    ask.add_argument("--seed", type=int, help="that of the preset if not given")
    ask.add_argument("--bark", type=color, default="#6b5d4d")
    ask.add_argument("--leaf", type=color, default="#5c7a33")
    args = ask.parse_args()
    folder = args.folder.resolve()
    made = sapling(folder, args.preset)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    made.register()
    bpy.ops.sapling.importdata(filename=f"{args.preset}.py")
    # Some presets were saved with the leaves off.
    made.settings["showLeaves"] = True
    if args.seed is not None:
        made.settings["seed"] = args.seed
    start = time.process_time()
    # By default it limits a preset to two levels without leaves.
    bpy.ops.curve.tree_add(limitImport=False)
    seconds = time.process_time() - start
    counts = meshes({"stems": colored("bark", args.bark, 0.9), "leaves": colored("leaf", args.leaf, 0.6)})
    bpy.ops.export_scene.gltf(filepath=str(args.out.resolve()), export_format="GLB")
    of = f"Sapling {version(made, folder)}, {args.preset}, seed {made.settings['seed']}"
    of_mesh = f"{counts['stems']} triangles of stems, {counts.get('leaves', 0)} of leaves"
    print(f"{of}: {seconds:.1f} s of processor, {of_mesh}: {args.out}")
    # Blender as a module may wait for ever when Python ends after an add-on was loaded.
    sys.stdout.flush()
    os._exit(0)


main()
