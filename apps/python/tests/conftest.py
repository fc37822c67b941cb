"""Shared fixtures of the tests: the repository, the command line, small plants."""

import os
import pathlib
import signal
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]

# A shell starts what runs in its background with Ctrl-C ignored, and so would be every program of these tests.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def root():
    return ROOT


@pytest.fixture(scope="session")
def program():
    """The command line, which `cargo xtask test` has built."""
    program = os.environ.get("BURGEON", str(ROOT / "target/debug/burgeon"))
    if not os.path.exists(program):
        pytest.skip(f"{program}: build it with `cargo build --package burgeon-cli`, or name another with BURGEON=")
    return program


@pytest.fixture(scope="session")
def shown(program):
    """The TOML of a preset."""

    def show(word):
        asked = [program, "presets", "--show", word]
        return subprocess.run(asked, capture_output=True, text=True, check=True).stdout

    return show


@pytest.fixture(scope="session")
def cli(program):
    """Runs the command line; returns its report's only item."""
    import json
    import tempfile

    def run(*args):
        with tempfile.TemporaryDirectory() as folder:
            report = os.path.join(folder, "report.json")
            words = [program, *map(str, args), "--quiet", "--report", report]
            subprocess.run(words, check=True, cwd=folder)
            with open(report) as file:
                return json.load(file)["items"][0]

    return run


@pytest.fixture(scope="session")
def small():
    """A small tree that grows in a moment."""
    import burgeon as bg

    return bg.grow("hazel", seed=3, age=4, detail=0.2, textures=False)


def python(code, **env):
    """Runs Python by itself; returns what it printed."""
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, check=True, capture_output=True, text=True, env={**os.environ, **env})
    return done.stdout.strip()
