"""Blender as a module of Python, without a window."""

import os
import pathlib
import sys

import pytest

pytest.importorskip("bpy")
ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "apps/blender"))

import bpy  # noqa: E402

import burgeon_plants  # noqa: E402


@pytest.fixture(autouse=True)
def empty():
    """A new file without objects, and the extension."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.preferences.edit.use_global_undo = True
    burgeon_plants.register()
    yield
    burgeon_plants.unregister()


def pytest_unconfigure(config):
    """Blender's own end, as a module, can wait for ever on what its threads still hold."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(getattr(config, "exit_code_of_tests", 1))


def pytest_sessionfinish(session, exitstatus):
    session.config.exit_code_of_tests = int(exitstatus)
