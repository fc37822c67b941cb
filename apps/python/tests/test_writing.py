"""Files in addition to the plain model, and plants of other settings: the bytes and digests of the command line."""

import os

import numpy as np
import pytest

import burgeon as bg

SMALL = {"seed": 3, "age": 4, "detail": 0.2}
ASKED = ("--seed", 3, "--age", 4, "--detail", 0.2)


@pytest.mark.parametrize(
    "name, how, words",
    [
        ("a.glb", {"lods": 2}, ["--lods", 2]),
        ("a.glb", {"lods": 1, "one_file": True, "instances": True}, ["--lods", 1, "--lod-file", "one", "--instances"]),
        ("a.glb", {"pack": "meshopt", "impostor": 128}, ["--pack", "meshopt", "--impostor", 128]),
        ("a.glb", {"sway": True}, ["--sway"]),
        ("a.obj", {"lods": 1, "up": "z", "unit": "cm"}, ["--lods", 1, "--up", "z", "--unit", "cm"]),
        ("a.glb", {"engine": "unity"}, ["--for", "unity"]),
        ("a.glb", {"engine": "godot"}, ["--for", "godot"]),
        ("a.usda", {"engine": "unreal"}, ["--for", "unreal"]),
        ("a.glb", {"engine": "three", "lods": 0}, ["--for", "three", "--lods", 0]),
        ("a.glb", {"engine": "blender"}, ["--for", "blender"]),
        ("a.usda", {"engine": "isaac"}, ["--for", "isaac"]),
        ("a.stl", {"engine": "print"}, ["--for", "print"]),
        ("a.glb", {"triangles": 4000, "lods": 1}, ["--triangles", 4000, "--lods", 1]),
        ("a.glb", {"megabytes": 0.5, "instances": True}, ["--megabytes", 0.5, "--instances"]),
        ("a.glb", {"megabytes": 0.4, "engine": "unity"}, ["--megabytes", 0.4, "--for", "unity"]),
        ("a.obj", {"megabytes": 0.6}, ["--megabytes", 0.6]),
    ],
)
def test_files_are_those_of_the_command_line(cli, tmp_path, name, how, words):
    mine, theirs = tmp_path / "mine", tmp_path / "theirs"
    mine.mkdir()
    theirs.mkdir()
    bg.grow("hazel", **SMALL).save(mine / name, **how)
    cli("grow", "hazel", *ASKED, *words, "-o", theirs / name)
    names = sorted(p.name for p in theirs.iterdir())
    assert sorted(p.name for p in mine.iterdir()) == names and name in names
    for file in names:
        assert (mine / file).read_bytes() == (theirs / file).read_bytes(), file


def test_a_budget_is_kept_and_an_impossible_one_names_the_least(tmp_path):
    tree = bg.grow("hazel", **SMALL)
    path = tmp_path / "a.glb"
    assert tree.save(path, megabytes=900, triangles=900_000) == ()
    whole = path.stat().st_size
    told = tree.save(path, megabytes=0.5)
    assert path.stat().st_size <= 500_000 < whole and told[-1].startswith("to keep within the budget, "), told
    with pytest.raises(bg.SpecError, match="at least") as few:
        tree.save(tmp_path / "b.glb", triangles=100)
    least = int(str(few.value).split("at least ")[1].split(" ")[0])
    assert tree.save(path, triangles=least)
    with pytest.raises(bg.SpecError, match="at least"):
        tree.save(path, triangles=least - 1)
    with pytest.raises(bg.SpecError, match=r"at least 0\.\d+ megabytes"):
        tree.save(path, megabytes=0.001)


def test_a_tree_grows_to_a_height_or_a_diameter_as_by_the_command_line(cli, tmp_path):
    for size in ({"height": 2.5}, {"dbh": 0.05}):
        ((name, value),) = size.items()
        mine = bg.grow("hazel", seed=3, detail=0.2, **size)
        theirs = cli("grow", "hazel", "--seed", 3, "--detail", 0.2, f"--{name}", value, "--json")
        assert mine.digest == theirs["digest"] != bg.grow("hazel", seed=3, detail=0.2).digest
    assert bg.grow("hazel", seed=3, detail=0.2, height=2.5).measures()["height_m"] == pytest.approx(2.5, abs=0.25)
    # A project keeps it, other settings do, and an age of one's own ends it.
    mine.save(tmp_path / "x.burgeon")
    (opened,) = bg.open(tmp_path / "x.burgeon")
    assert opened.digest == mine.digest == mine.again(detail=0.2).digest
    assert mine.again(age=2).digest == bg.grow("hazel", seed=3, detail=0.2, age=2).digest
    for wrong, words in [
        ({"height": 60}, "60 m is out of reach"),
        ({"dbh": 3}, "breast height is out of reach"),
        ({"height": 2, "dbh": 0.1}, "height and dbh exclude each other"),
        ({"height": 2, "age": 3}, "height and age exclude each other"),
        ({"height": -1}, "height must be 0.01 to 1000 m, not -1"),
        ({"height": 2, "obstacles": [{"shape": "sphere", "centre": [0, 9, 0], "radius_m": 0.5}]}, "obstacles"),
    ]:
        with pytest.raises(bg.SpecError, match=words):
            bg.grow("hazel", seed=3, **wrong)


def test_leaves_on_cards_are_those_of_the_command_line(cli):
    mine = bg.grow("hazel", **SMALL, foliage="cards", texture_size=64, look={"season": 0.5})
    words = ("--foliage", "cards", "--textures", 64, "--season", 0.5, "--png", "x.png", "--size", "16x16")
    assert mine.digest == cli("grow", "hazel", *ASKED, *words)["digest"] != bg.grow("hazel", **SMALL).digest


def test_a_leaf_of_ones_own_is_that_of_the_command_line(cli, root, shown, tmp_path):
    marks = root / "fixtures/leaves/leaf1.csv"
    mine = bg.grow("hazel", **SMALL, leaf=bg.leaf(marks, seed=3))
    theirs = cli("grow", "hazel", *ASKED, "--leaf-template", marks, "--json")["digest"]
    assert mine.digest == theirs != bg.grow("hazel", **SMALL).digest
    # A spec that names it does the same, and a project keeps it.
    (tmp_path / "leaf1.csv").write_bytes(marks.read_bytes())
    spec = tmp_path / "hazel.toml"
    spec.write_text(shown("hazel").replace("[blade]", '[blade]\nfile = "leaf1.csv"'))
    assert 'file = "leaf1.csv"' in spec.read_text()
    again = bg.grow(spec, **SMALL)
    assert again.digest == theirs
    again.save(tmp_path / "x.burgeon")
    (opened,) = bg.open(tmp_path / "x.burgeon")
    assert opened.digest == theirs
    with pytest.raises(bg.SpecError, match="leaf must be a leaf of marks"):
        bg.grow("hazel", leaf=mine)
    spec.write_text(spec.read_text().replace("leaf1.csv", "none.csv"))
    with pytest.raises(bg.SpecError, match=r"blade.file .none.csv"):
        bg.grow(spec)


def test_a_leaf_of_chief_veins_is_borne_as_by_the_command_line(cli, shown, tmp_path):
    veins = tmp_path / "maple.csv"
    own = cli("leaf", "--venation", "palmate", "--veins", 7, "-o", tmp_path / "m.glb", "--marks", veins)["digest"]
    theirs = cli("grow", "hazel", *ASKED, "--leaf-template", veins, "--json")["digest"]
    spec = tmp_path / "hazel.toml"
    spec.write_text(shown("hazel").replace("[blade]", '[blade]\nfile = "maple.csv"'))
    tree = bg.grow(spec, **SMALL)
    assert tree.digest == theirs != bg.grow("hazel", **SMALL).digest
    leaf = bg.leaf(veins)
    assert bg.grow("hazel", **SMALL, leaf=leaf).digest == theirs
    assert leaf.digest == cli("leaf", veins, "-o", tmp_path / "x.glb")["digest"] != own
    # A project keeps it.
    tree.save(tmp_path / "x.burgeon")
    (opened,) = bg.open(tmp_path / "x.burgeon")
    assert opened.digest == theirs


@pytest.mark.parametrize(
    "name, how, words",
    [
        ("x.glb", {"lods": 7}, "lods must be 0 to 6, not 7"),
        ("x.glb", {"impostor": 64}, "impostor must be 128 to 4096"),
        ("x.glb", {"pack": "zip"}, "pack must be quantized or meshopt"),
        ("x.glb", {"one_file": True}, "one_file is of coarser copies"),
        ("x.glb", {"sway": True, "pack": "meshopt"}, "sways"),
        ("x.glb", {"sway": True, "instances": True}, "do not move in the wind"),
        ("x.obj", {"sway": True}, "sway is of .glb or .gltf files"),
        ("x.stl", {"impostor": 128}, "of models with textures"),
        ("x.mtg", {"lods": 1}, "lods is of models, not of .mtg files"),
        ("x.mtg", {"triangles": 900}, "triangles is of models, not of .mtg files"),
        ("x.glb", {"triangles": 99}, "triangles must be 100 to"),
        ("x.glb", {"megabytes": 0}, "megabytes must be 0.001 to 4000"),
        ("x.stl", {"engine": "print", "triangles": 900}, "its size and walls"),
        ("x.usda", {"engine": "unreal", "megabytes": 9}, "Nanite"),
    ],
)
def test_what_nothing_uses_is_refused(small, tmp_path, name, how, words):
    with pytest.raises(ValueError, match=words):
        small.save(tmp_path / name, **how)
    assert not list(tmp_path.iterdir())


def test_what_was_set_for_a_program_is_told(small, tmp_path):
    told = small.save(tmp_path / "a.glb", engine="unity")
    assert told[0] == "lods 3" and "wind" in told and not (tmp_path / "a-lod3.glb").exists()
    assert small.save(tmp_path / "b.glb", engine="unity", lods=0, pack="quantized")[0].startswith("names")
    assert small.save(tmp_path / "c.glb") == ()
    told = small.save(tmp_path / "u.glb", engine="unreal")
    assert any("Pivot Painter 2" in line for line in told)
    assert {"u-pivots.exr", "u-axes.png"} <= {path.name for path in tmp_path.iterdir()}
    for how, words in [({"engine": "isaac"}, ".physics.usda, not .glb"), ({"engine": "maya"}, "unity")]:
        with pytest.raises(ValueError, match=words):
            small.save(tmp_path / "d.glb", **how)
    with pytest.raises(ValueError, match="Nanite"):
        small.save(tmp_path / "d.usda", engine="unreal", lods=1)
    with pytest.raises(ValueError, match="one body"):
        small.save(tmp_path / "d.stl", engine="print", lods=1)
    assert not list(tmp_path.glob("d*"))


def test_a_plant_is_used_after_it_was_written(tmp_path):
    """From other threads at the same time, too: writing takes nothing away."""
    import threading

    plant = bg.grow("hazel", **SMALL)
    before = (plant.digest, plant.nodes.position.copy(), plant.to_bytes("glb"))
    failed = []

    def write(k):
        try:
            plant.save(tmp_path / f"{k}.glb", lods=1)
            assert plant.to_bytes("glb") == (tmp_path / f"{k}.glb").read_bytes() == before[2]
            assert plant.at if k else plant.again(seed=8).digest != before[0]
        except BaseException as error:
            failed.append(error)

    threads = [threading.Thread(target=write, args=(k,)) for k in range(3)]
    [t.start() for t in threads]
    [t.join() for t in threads]
    assert not failed and plant.digest == before[0] and (plant.nodes.position == before[1]).all()


def test_other_settings_make_the_plant_that_has_them(small):
    plain = {"detail": 0.2, "textures": False}
    assert small.again().digest == small.digest
    assert small.again(seed=8).digest == bg.grow("hazel", seed=8, age=4, **plain).digest
    fewer = {"age": 6, "leaves": {"leaf_keep": 0.5}}
    assert small.again(**fewer).digest == bg.grow("hazel", seed=3, **fewer, **plain).digest
    assert small.again(detail=0.4).model.triangle_count > small.model.triangle_count
    assert len(small.again(wind=True).model.parts[0].wind) > 0
    rose = bg.bloom("rose", 1.0, seed=2)
    assert rose.again(day=3.0, stalk_m=0.4).digest == bg.bloom("rose", 3.0, seed=2, stalk_m=0.4).digest
    assert bg.leaf().again(form={"lobes": 0.4}).digest == bg.leaf(form={"lobes": 0.4}).digest
    box = {"shape": "box", "min": [0.2, 0, -1], "max": [1, 2, 1]}
    shapes = bg.schema("tree")["$defs"]["Obstacle"]["oneOf"]
    assert any(one["properties"]["shape"].get("const") == "box" for one in shapes if "shape" in one["properties"]), shapes
    around = small.again(obstacles=[box])
    assert around.digest == bg.grow("hazel", seed=3, age=4, obstacles=[box], **plain).digest != small.digest
    assert around.again(obstacles=[]).digest == small.digest


def test_other_settings_keep_what_was_done_by_hand(small, root):
    longest = max(small.branches(1), key=lambda b: b["length_m"])
    cut = small.shape([{"op": "prune", "axis": {"path": longest["path"]}, "at": 0.3}])
    other = cut.again(look={"leaf_color": "#804020"})
    assert len(other.nodes) == len(cut.nodes) < len(small.nodes) and other.digest != cut.digest
    assert other.report["edits"][0]["done"]
    for plant in bg.open(root / "fixtures/projects/version-5.burgeon"):
        assert plant.again().digest == plant.digest
        assert plant.again(seed=77).place == plant.place


@pytest.mark.parametrize(
    "how, words",
    [
        ({"day": 3}, "has no days"),
        ({"leave": {}}, "is `leaves` meant"),
        ({"detail": 99}, "detail must be 0.1 to 8"),
        ({"seed": -1}, "seed must be a whole number"),
        ({"age": float("inf")}, "age must be a finite number"),
    ],
)
def test_settings_that_are_none_are_told(small, how, words):
    with pytest.raises(ValueError, match=words):
        small.again(**how)


def test_flowers_have_no_fineness():
    with pytest.raises(ValueError, match="of trees and drawings"):
        bg.bloom("rose").again(detail=0.3)


@pytest.fixture(scope="module")
def oak():
    return bg.grow("oak", seed=2, age=12, detail=0.2, textures=False, bare=True)


def test_scanned_trees_are_those_of_the_command_line(cli, oak, tmp_path):
    pytest.importorskip("laspy")
    cloud = oak.cloud(60_000, stations=6)
    cloud.save(tmp_path / "oak.laz")
    mine = bg.scan(tmp_path / "oak.laz", leaves="hazel", detail=0.2, textures=False)
    theirs = cli("scan", tmp_path / "oak.laz", "--leaves", "hazel", "--detail", "0.2", "--no-textures", "-o", tmp_path / "x.glb")
    assert mine.digest == theirs["digest"] and mine.report["counts"] == theirs["counts"]
    assert mine.maker == "scan" and len(mine.organs) > 0 and mine.found["points"] == 60_000


def test_a_tree_comes_back_from_its_cloud(oak, tmp_path):
    cloud = oak.cloud(60_000, stations=6)
    found = bg.scan(cloud.points, up="y", detail=0.2, textures=False)
    mine, theirs = found.measures(), oak.measures()
    assert mine["height_m"] == pytest.approx(theirs["height_m"], rel=0.02)
    assert np.abs(found.place[0]).max() < 0.05
    # Its place is reported, also far from the origin; the tree is the same but for the last bits of its coordinates.
    far = bg.scan(cloud.points[:, [0, 2, 1]] * [1, -1, 1] + [430_000.0, 5_600_000.0, 120.0], detail=0.2, textures=False)
    assert np.allclose(far.place[0], np.array([430_000, 120, -5_600_000]) + found.place[0], atol=0.02)
    assert far.measures()["height_m"] == pytest.approx(mine["height_m"], rel=0.01)
    found.save(tmp_path / "x.qsm.csv")
    found.save(tmp_path / "x.glb", lods=1)
    assert (tmp_path / "x-lod1.glb").exists()
    with pytest.raises(bg.SpecError, match="no project"):
        found.save(tmp_path / "x.burgeon")
    with pytest.raises(bg.SpecError, match="no edits by hand"):
        found.shape([])


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: bg.scan(np.zeros((9, 2))), r"shape \(points, 3\)"),
        (lambda: bg.scan(np.full((9, 3), np.nan)), "finite"),
        (lambda: bg.scan(np.array([["a", "b", "c"]])), "a scan is numbers"),
        (lambda: bg.scan(np.zeros((9, 3))), "scan: "),
        (lambda: bg.scan(np.zeros((0, 3))), "scan: "),
        (lambda: bg.scan(np.random.default_rng(1).random((500, 3)), cell=7), "cell must be 0.001 to 1 m, not 7"),
        (lambda: bg.scan(np.random.default_rng(1).random((500, 3)), gap=-1), "gap must be 0 to 5 m"),
        (lambda: bg.scan(np.zeros((9, 3)), leaves="dead-oak"), "bears no leaves"),
        (lambda: bg.scan(np.zeros((9, 3)), up="x"), "up must be y or z"),
        (lambda: bg.scan(np.zeros((9, 3)), budget=0), "budget must be 1 to 1000"),
    ],
)
def test_what_is_no_scan_is_told(call, words):
    with pytest.raises((ValueError, TypeError), match=words):
        call()


def test_what_a_spec_names_lies_below_it_or_is_trusted(root, shown, tmp_path):
    inner = tmp_path / "in"
    inner.mkdir()
    leaf = (root / "fixtures/leaves/leaf1.csv").read_text()
    (tmp_path / "leaf.csv").write_text(leaf)
    (inner / "leaf.csv").write_text(leaf)
    spec = inner / "hazel.toml"

    def name(file):
        spec.write_text(shown("hazel").replace("[blade]", f"[blade]\nfile = '{file}'"))

    name("leaf.csv")
    beside = bg.grow(spec, **SMALL).digest
    (inner / "link.csv").symlink_to("../leaf.csv")
    for file in ("../leaf.csv", "..\\leaf.csv", "link.csv", str(tmp_path / "leaf.csv")):
        name(file)
        with pytest.raises(bg.SpecError, match="trust_paths=True") as refused:
            bg.grow(spec, **SMALL)
        assert refused.value.code == "file-refused"
        assert bg.grow(spec, **SMALL, trust_paths=True).digest == beside
    (tmp_path / "box.obj").write_text("v 9 0 0\nv 9 1 0\nv 9 0 1\nf 1 2 3\n")
    spec.write_text(shown("hazel") + "\n[[obstacles]]\nshape = 'mesh'\nfile = '../box.obj'\n")
    with pytest.raises(bg.SpecError, match="box.obj.*not below its folder"):
        bg.grow(spec, **SMALL)
    assert bg.grow(spec, **SMALL, trust_paths=True).digest
    os.mkfifo(inner / "pipe.csv")
    name("pipe.csv")
    with pytest.raises(bg.SpecError, match="a pipe"):
        bg.grow(spec, **SMALL, trust_paths=True)
    with pytest.raises(TypeError, match="trust_paths"):
        bg.grow("hazel", trust_paths="yes")


def test_a_growth_table_that_is_too_long_is_refused_at_once():
    days = np.arange(60000.0)
    with pytest.raises(bg.BudgetError, match="comparisons of sizes"):
        bg.Law.fit(days, 1 + days)
