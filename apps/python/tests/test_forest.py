"""Stands of many trees: inventories, stands that grow, their tiles, and the same tiles by several workers."""

import json
import os
import pickle
import signal
import subprocess

import numpy as np
import pytest

import burgeon as bg

TREES = """x;y;species;DBH (cm);height_m
0;0;birch;14;11
8;1;hazel;;4
3;9;Betula pendula;9,5;
-6;5;birch;12;10
"""
QUICK = dict(variants=1, lods=1, impostor=None, detail=0.3, texture_size=64)
QUICK_WORDS = ["--variants", "1", "--lods", "1", "--impostor", "off", "--detail", "0.3", "--textures", "64"]
WOOD = {"area_m": [60, 50], "years": 15, "density_ha": 500, "species": [{"name": "birch"}, {"name": "hazel", "share": 2}]}


def files_of(folder):
    names = (os.path.join(at, name) for at, _, names in os.walk(folder) for name in names)
    return {os.path.relpath(name, folder): open(name, "rb").read() for name in names}


@pytest.fixture(scope="module")
def inventory(tmp_path_factory):
    path = tmp_path_factory.mktemp("inventory") / "trees.csv"
    path.write_text(TREES, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def wood():
    return bg.forest.grow(WOOD, seed=3)


@pytest.fixture(scope="module")
def whole(wood, tmp_path_factory):
    return wood.tiles(tmp_path_factory.mktemp("tiles") / "whole", **QUICK, tile_trees=8)


def test_an_inventory_is_columns(inventory):
    stand = bg.forest.read(inventory)
    assert len(stand) == 4 and stand.species_names == ["birch", "hazel"]
    assert stand.species.tolist() == [0, 1, 0, 0] and stand.row.tolist() == [1, 2, 3, 4]
    assert stand.height[[0, 1, 3]].tolist() == [11, 4, 10] and stand.dbh[[0, 2]].tolist() == [0.14, 0.095]
    # North is -z.
    assert stand.position[2].tolist() == [3.0, 0.0, -9.0]
    assert (stand.crown_width > 0.5).all() and (stand.age > 0).all() and stand.crown_offset.shape == (4, 3)
    assert stand.report["rows"] == 4 and stand.report["given"] == [3, 3, 0, 0]
    with pytest.raises(ValueError):
        stand.height[0] = 1.0


def test_bytes_and_data_frames_are_inventories_too(inventory):
    own = bg.forest.read(inventory)
    assert bg.forest.read(TREES.encode()).position.tolist() == own.position.tolist()
    pandas = pytest.importorskip("pandas")
    frame = pandas.read_csv(inventory, sep=";", decimal=",")
    assert np.array_equal(bg.forest.read(frame).dbh, own.dbh)
    again = pandas.DataFrame(own.table())
    assert list(again.columns[:5]) == ["row", "species", "x", "y", "z"] and len(again) == 4


def test_a_stand_grows_the_same_with_a_seed(wood):
    again, other = bg.forest.grow(WOOD, seed=3), bg.forest.grow(WOOD, seed=4)
    assert np.array_equal(wood.position, again.position) and wood.to_csv() == again.to_csv()
    assert not np.array_equal(wood.height[:20], other.height[:20])
    assert np.array_equal(pickle.loads(pickle.dumps(wood)).height, wood.height)
    assert [year for year, *_ in wood.report["history"]][-1] == 15
    assert len(bg.forest.grow(WOOD, seed=3, density_ha=100)) < len(wood)


@pytest.mark.parametrize("ending", ["csv", "toml"])
def test_tiles_are_those_of_the_command(program, inventory, tmp_path, ending):
    if ending == "csv":
        given, stand = inventory, bg.forest.read(inventory)
    else:
        given = tmp_path / "wood.toml"
        given.write_text(
            "area_m = [60, 50]\nyears = 15\ndensity_ha = 500\n"
            '[[species]]\nname = "birch"\n[[species]]\nname = "hazel"\nshare = 2\n'
        )
        stand = bg.forest.grow(given)
    words = [program, "forest", str(given), "-o", "own", *QUICK_WORDS, "--tile-trees", "8", "--glb", "-q"]
    subprocess.run(words, check=True, cwd=tmp_path)
    made = stand.tiles(tmp_path / "py", **QUICK, tile_trees=8, glb=True)
    own, ours = files_of(tmp_path / "own"), files_of(tmp_path / "py")
    assert sorted(own) == sorted(ours)
    assert [name for name in own if own[name] != ours[name]] == []
    assert made.manifest == json.loads(own["manifest.json"]) and made.report["tiles"] > 1


def test_tiles_are_kept_repaired_and_made_alone(wood, whole, tmp_path):
    before = files_of(whole.folder)
    tile = next(name for name in before if name.startswith(f"tiles{os.sep}"))
    os.remove(os.path.join(whole.folder, tile))
    with open(os.path.join(whole.folder, "models", os.listdir(os.path.join(whole.folder, "models"))[0]), "ab") as file:
        file.write(b"damaged")
    assert wood.tiles(whole.folder, **QUICK, tile_trees=8).manifest == whole.manifest
    assert files_of(whole.folder) == before
    depth, rest = tile.split(os.sep)[1], tile.split(os.sep)[2].removesuffix(".glb").split("-")
    wood.tiles(tmp_path / "one", **QUICK, tile_trees=8, tile=[int(depth), *map(int, rest)])
    alone = files_of(tmp_path / "one")
    assert alone[tile] == before[tile] and "tileset.json" not in alone


def test_four_workers_write_the_same(wood, whole, tmp_path):
    made = wood.tiles(tmp_path / "four", **QUICK, tile_trees=8, workers=4)
    assert made.manifest == whole.manifest
    assert files_of(tmp_path / "four") == files_of(whole.folder)


def _killed_once(made_of, form, folder, part):
    """A part, in the first process that asks for it only until that is killed."""
    mark = os.path.join(os.path.dirname(folder), "killed")
    if part[1] and not os.path.exists(mark):
        open(mark, "w").close()
        os.kill(os.getpid(), signal.SIGKILL)
    return REAL(made_of, form, folder, part)


REAL = bg.forest._make_part


@pytest.mark.skipif(os.name != "posix", reason="kills a process")
def test_a_worker_that_was_killed_is_replaced(wood, whole, tmp_path, monkeypatch):
    monkeypatch.setattr(bg.forest, "_make_part", _killed_once)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([os.path.dirname(__file__), os.environ.get("PYTHONPATH", "")]))
    made = wood.tiles(tmp_path / "tiles", **QUICK, tile_trees=8, workers=2)
    assert os.path.exists(tmp_path / "killed"), "one was killed"
    assert made.manifest == whole.manifest and files_of(tmp_path / "tiles") == files_of(whole.folder)


@pytest.mark.ray
def test_ray_writes_the_same_also_after_a_worker_was_killed(wood, whole, tmp_path, monkeypatch):
    ray = pytest.importorskip("ray")
    environment = {"PYTHONPATH": os.pathsep.join([os.path.dirname(__file__), os.environ.get("PYTHONPATH", "")])}
    ray.init(num_cpus=4, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": environment})
    try:
        assert wood.tiles(tmp_path / "a" / "tiles", **QUICK, tile_trees=8, ray=True).manifest == whole.manifest
        monkeypatch.setattr(bg.forest, "_make_part", _killed_once)
        made = wood.tiles(tmp_path / "b" / "tiles", **QUICK, tile_trees=8, ray=True)
    finally:
        ray.shutdown()
    assert os.path.exists(tmp_path / "b" / "killed"), "one was killed"
    assert made.manifest == whole.manifest
    assert files_of(tmp_path / "b" / "tiles") == files_of(whole.folder) == files_of(tmp_path / "a" / "tiles")


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda at: bg.forest.read(b"x;y;species\n1;2;brich\n"), "row 1, column `species`"),
        (lambda at: bg.forest.read(b"x;y;species\n"), "no trees"),
        (lambda at: bg.forest.read(at / "none.csv"), "none.csv"),
        (lambda at: bg.forest.read(TREES.encode(), crs="mars"), "crs must be"),
        (lambda at: bg.forest.read(TREES.encode(), lean=0.5), "lean is of a ground"),
        (lambda at: bg.forest.read(TREES.encode(), ground={"kind": "geotiff", "file": "no.tif"}), "no.tif"),
        (lambda at: bg.forest.read(TREES.encode(), ground={"kind": "swamp"}), "ground"),
        (lambda at: bg.forest.read(7), "an inventory is"),
        (lambda at: bg.forest.grow("oak"), "a TOML file"),
        (lambda at: bg.forest.grow({**WOOD, "yearz": 3}), "yearz"),
        (lambda at: bg.forest.grow({**WOOD, "species": [{"name": "brich"}]}), "birch"),
        (lambda at: bg.forest.grow({**WOOD, "masks": [{"file": "../mask.png"}]}), "trust_paths"),
        (lambda at: bg.forest.grow(WOOD).tiles(at, variants=0), "variants must be 1 to 64"),
        (lambda at: bg.forest.grow(WOOD).tiles(at, finest=4), "finest must be 0 to 3"),
        (lambda at: bg.forest.grow(WOOD).tiles(at, level=1), "level is of glb and usd"),
        (lambda at: bg.forest.grow(WOOD).tiles(at / "t", **QUICK, tile=(9, 9, 9, 9)), "there is no tile"),
        (lambda at: bg.forest.grow(WOOD).tiles(at, place=(200, 0, 0)), "longitude"),
        (lambda at: bg.forest.grow(WOOD).tiles(os.path.dirname(__file__), **QUICK), "other files in it"),
    ],
)
def test_what_is_wrong_is_told(tmp_path, call, words):
    with pytest.raises((ValueError, TypeError, OSError), match=words):
        call(tmp_path)


def test_a_stand_a_spec_and_an_inventory_become_tiles_in_one_call(wood, whole, inventory, tmp_path):
    assert bg.forest.tiles(WOOD, tmp_path / "spec", seed=3, **QUICK, tile_trees=8).manifest == whole.manifest
    assert bg.forest.tiles(wood, tmp_path / "stand", **QUICK, tile_trees=8).manifest == whole.manifest
    assert bg.forest.tiles(inventory, tmp_path / "inventory", **QUICK).report["trees"] == 4
