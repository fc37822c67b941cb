"""The file that people install: Blender's own checker takes it, and Blender installs it and uses the wheel that is in it."""

import importlib.util
import os
import pathlib
import subprocess
import sys

import pytest

FILE = os.environ.get("BURGEON_EXTENSION")
pytestmark = pytest.mark.skipif(not FILE, reason="BURGEON_EXTENSION names no file: `cargo xtask test-blender` does")

INSTALLED = """
import importlib.machinery, os, sys
import bpy

class OfTheExtension:
    "Of all places only that where Blender puts the wheels of extensions."
    def find_spec(name, path=None, target=None):
        if name == "burgeon":
            return importlib.machinery.PathFinder.find_spec(name, [p for p in sys.path if ".local" in p])

sys.meta_path.insert(0, OfTheExtension)
bpy.ops.preferences.addon_enable(module="bl_pkg")
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", enable_on_install=True)
import burgeon
assert ".local" in burgeon.__file__, burgeon.__file__
assert bpy.ops.burgeon.add_tree(species="hazel", seed=3, age=4, detail=0.2) == {"FINISHED"}
print("triangles", len(bpy.context.active_object.data.polygons))
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.burgeon_plants")
assert not hasattr(bpy.types.Object, "burgeon")
print("installed, used and disabled")
sys.stdout.flush()
os._exit(0)
"""


def test_blender_finds_nothing_wrong_with_it():
    root = pathlib.Path(importlib.util.find_spec("bpy").origin).parent
    checker = next(root.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    asked = [sys.executable, checker, "validate", FILE]
    done = subprocess.run(asked, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_blender_installs_it_with_its_wheel(tmp_path):
    script = tmp_path / "installed.py"
    script.write_text(INSTALLED, encoding="utf-8")
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(tmp_path / "user")}
    done = subprocess.run(
        [sys.executable, script, FILE], env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert "installed, used and disabled" in done.stdout, done.stdout + done.stderr
