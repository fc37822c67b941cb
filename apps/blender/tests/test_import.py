"""Files of the command in Blender's own importer."""

import os
import subprocess
import sys

import pytest

import burgeon as bg

# The importer goes through a set of names, whose order follows from the seed of Python's hashes.
HASH_SEEDS = range(10)

IMPORT = """
import os, sys, bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[1])
meshes = [o.data for o in bpy.context.scene.objects if o.type == "MESH"]
for mesh in meshes:
    assert {"_WIND", "_PIVOT"} <= set(mesh.attributes.keys()), list(mesh.attributes.keys())
print("faces", sum(len(m.polygons) for m in meshes), flush=True)
os._exit(0)
"""


@pytest.fixture(scope="module")
def blown(tmp_path_factory):
    """A tree with wind, its file, and its number of triangles."""
    path = tmp_path_factory.mktemp("wind") / "hazel.glb"
    plant = bg.grow("hazel", seed=3, age=4, detail=0.2, wind=True)
    plant.save(path)
    return path, plant.model.triangle_count


@pytest.mark.parametrize("seed", HASH_SEEDS)
def test_files_with_wind_are_imported_whatever_the_order_of_attributes(blown, seed):
    path, triangles = blown
    run = subprocess.run(
        [sys.executable, "-c", IMPORT, str(path)],
        env={**os.environ, "PYTHONHASHSEED": str(seed)},
        check=False,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr[-800:]
    assert f"faces {triangles}" in run.stdout
