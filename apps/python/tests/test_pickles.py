"""Plants, models and laws are copied, compared and sent to other processes."""

import copy
import multiprocessing
import pickle
import subprocess
import sys

import numpy as np
import pytest

import burgeon as bg

SMALL = {"seed": 3, "age": 4, "detail": 0.1, "textures": False}


def hazel(seed):
    return bg.grow("hazel", **{**SMALL, "seed": seed})


def makers():
    bent = np.array([[x, y, 0.02 * y * y] for y in np.linspace(0.0, 0.07, 40) for x in np.linspace(-0.01, 0.01, 15)])
    leaf = bg.leaf(form={"length_m": 0.08})
    strokes = [np.array([[0, 0], [0, 1], [0.1, 2]]), np.array([[0, 1], [0.6, 1.4], [0.9, 1.5]])]
    yield "tree", hazel(3)
    yield "tree with wind", bg.grow("hazel", wind=True, **SMALL)
    yield "tree with a leaf", bg.grow("hazel", leaf=leaf, **SMALL)
    yield "flower", bg.bloom("tulip", 4.0, seed=2)
    yield "leaf", leaf
    yield "leaf of a scan", bg.leaf(bent)
    yield "drawing", bg.sketch(strokes, seed=4)
    yield "again", hazel(3).again(seed=9)
    yield "shaped", hazel(3).shape([{"op": "prune", "axis": {"path": [0, 0]}, "at": 0.5}])
    yield "project", bg.open(hazel(3).to_bytes("burgeon"))[0]


@pytest.mark.parametrize("name, plant", list(makers()), ids=lambda x: x if isinstance(x, str) else "")
def test_a_plant_comes_back_as_it_was(name, plant):
    data = pickle.dumps(plant)
    back = pickle.loads(data)
    assert back == plant and hash(back) == hash(plant) and back is not plant
    assert back.digest == plant.digest and back.model.digest == plant.model.digest
    assert [np.array_equal(a.wind, b.wind) for a, b in zip(back.model.parts, plant.model.parts)]
    assert copy.copy(plant) is plant and copy.deepcopy([plant])[0] is plant


def test_other_plants_are_others():
    plant = hazel(3)
    assert plant == hazel(3) and plant is not hazel(3)
    assert plant != hazel(4) and plant != plant.again(detail=0.3) and plant != "hazel"
    assert len({plant, hazel(3), hazel(4)}) == 2


def test_models_and_laws():
    plant = hazel(3)
    for model in (plant.model, plant.level(1)):
        assert pickle.loads(pickle.dumps(model)) == model
    assert plant.model != plant.level(1)
    law = bg.Law.fit([0, 2, 4, 6, 8], [0.01, 0.02, 0.04, 0.055, 0.06])
    back = pickle.loads(pickle.dumps(law))
    assert back == law and back(3.0) == law(3.0)
    assert law != bg.Law.fit([0, 2, 4, 6, 8], [0.01, 0.02, 0.04, 0.055, 0.07])
    assert copy.deepcopy(law) is law


def test_lists_that_change_later_change_no_pickle():
    leaves = {"leaf_keep": 0.5}
    plant = bg.grow("hazel", leaves=leaves, **SMALL)
    leaves["leaf_keep"] = 1.0
    assert pickle.loads(pickle.dumps(plant)) == plant


def test_plants_are_made_by_a_pool():
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        made = pool.map(hazel, [3, 4])
    assert made == [hazel(3), hazel(4)]


def test_the_package_runs_as_a_command(tmp_path):
    def run(*arguments):
        command = [sys.executable, "-m", "burgeon", *arguments]
        return subprocess.run(command, check=False, capture_output=True, text=True)

    out = tmp_path / "hazel.glb"
    made = run("grow", "hazel", "--age", "4", "-o", str(out), "--png", str(tmp_path / "hazel.png"))
    assert made.returncode == 0 and out.read_bytes()[:4] == b"glTF", made.stderr
    assert (tmp_path / "hazel.png").read_bytes()[1:4] == b"PNG"
    assert "oak" in run("presets").stdout
    wrong = run("grow", "hazle", "-o", str(out))
    assert wrong.returncode == 2 and "hazel" in wrong.stderr and "Traceback" not in wrong.stderr
    assert run("grow", "hazel", "-o", str(tmp_path / "x.abc")).returncode == 2


def test_numbers_of_numpy_that_are_whole_count():
    assert bg.grow("hazel", **{**SMALL, "age": np.float64(4)}) == hazel(3)
    with pytest.raises(bg.SpecError) as refused:
        bg.grow("hazel", **{**SMALL, "age": 4.5})
    assert "u32" not in str(refused.value) and "whole number" in str(refused.value)
