"""The same plants as the command line makes; what is asked for, checked by the same schemas."""

import json
import subprocess

import numpy as np
import pytest

import burgeon as bg

TREES, FLOWERS = bg.presets()


@pytest.fixture(scope="module")
def expected(root):
    """Digests of what the native program makes, which `cargo xtask test` compares on its own."""
    return json.loads((root / "fixtures/digests.json").read_text())


@pytest.mark.parametrize("word", TREES)
def test_trees_are_those_of_the_native_program(expected, cli, word):
    made = bg.grow(word, seed=1, detail=0.1, textures=False)
    counts = made.report["counts"]
    if f"tree {word}" in expected:
        assert f"{made.digest} {counts['vertices']} {counts['triangles']}" == expected[f"tree {word}"]
    else:
        assert made.digest == cli("grow", word, "--detail", "0.1", "--no-textures", "--png", "x.png", "--size", "16x16")["digest"]


def test_all_of_the_repository_has_the_digests_of_the_native_program(expected, root, program, tmp_path):
    """Drawings, leaves and projects; trees and flowers have tests of their own."""
    drawings = {p.stem: p for p in (root / "fixtures/sketches").glob("**/*.svg")}
    compared = 0
    for name, digest in expected.items():
        kind, _, word = name.partition(" ")
        if kind == "drawing":
            made = bg.sketch(drawings[word]).digest
        elif name in ("leaf1.csv", "leaf2.csv", "leaf3.csv"):
            made = bg.leaf(root / "fixtures/leaves" / name).digest
        elif name in ("palmate.csv", "parallel.csv"):
            asked = [program, "leaf", "--venation", name[:-4], "--marks", str(tmp_path / name), "--quiet"]
            subprocess.run(asked, check=True)
            made = bg.leaf(tmp_path / name).digest
        elif kind == "project":
            version, _, plant = word.partition(" ")
            made = {p.name: p.digest for p in bg.open(root / f"fixtures/projects/{version}.burgeon")}[plant]
        else:
            continue
        assert made == digest, name
        compared += 1
    assert compared >= 40


@pytest.mark.parametrize("seed, age", [(2, 9), (77, 14)])
def test_seeds_and_ages_are_those_of_the_command_line(cli, seed, age):
    mine = bg.grow("oak", seed=seed, age=age, detail=0.1)
    theirs = cli("grow", "oak", "--seed", seed, "--age", age, "--detail", "0.1", "--json")
    assert mine.digest == theirs["digest"]
    assert mine.report["counts"] == theirs["counts"]
    assert mine.measures() == theirs["plant"]


@pytest.mark.parametrize("word", FLOWERS)
def test_flowers_are_those_of_the_command_line(cli, tmp_path, word):
    out = tmp_path / "flower.glb"
    theirs = cli("bloom", "run", word, "--day", 3, "-o", out)
    mine = bg.bloom(word, 3.0)
    assert mine.digest == theirs["digest"] == mine.model.digest
    assert mine.to_bytes("glb") == out.read_bytes()


def test_seeds_of_drawings_are_those_of_the_command_line(cli, root):
    path = sorted((root / "fixtures/sketches").glob("**/*.svg"))[0]
    assert bg.sketch(path, seed=9).digest == cli("sketch", path, "--seed", 9, "--json")["digest"]


def test_leaves_are_those_of_the_command_line(cli, root):
    path = root / "fixtures/leaves/leaf1.csv"
    assert bg.leaf(path, seed=4).digest == cli("leaf", path, "--seed", 4, "--json")["digest"]


def test_control_balls_of_a_leaf_are_moved_as_on_the_command_line(cli, root):
    path = root / "fixtures/leaves/leaf1.csv"
    ball = {"row": 5, "mark": 1, "by_m": [0, 0, 0.08], "thickness": 3}
    made = bg.leaf(path, surface="approximate", balls=[ball, {"row": 0, "by_m": [0, 0.05, 0.02]}])
    asked = ("--surface", "approximate", "--ball", "5,1,0,0,0.08,3", "--ball", "0,4,0,0.05,0.02")
    assert made.digest == cli("leaf", path, *asked, "--json")["digest"]
    assert made.digest != bg.leaf(path, surface="approximate").digest
    with pytest.raises(bg.BurgeonError, match="no control ball 4 in row 11"):
        bg.leaf(path, balls=[{"row": 11}])


@pytest.mark.parametrize("word, more", [("palmate", {"veins": 7, "depth": 0.4}), ("parallel", {"length": 0.2})])
def test_leaves_of_chief_veins_are_those_of_the_command_line(cli, word, more, tmp_path):
    args = [x for name, value in more.items() for x in (f"--{name}", value)]
    made = bg.leaf(venation=word, **more)
    assert made.digest == cli("leaf", "--venation", word, *args)["digest"]
    assert made.maker == "leaf" and made.measures()["leaf_area_m2"] > 0
    assert made.level(1).triangle_count < made.model.triangle_count
    with pytest.raises(bg.SpecError, match="no project"):
        made.save(tmp_path / "x.burgeon")


def test_files_of_chief_veins_are_those_of_the_command_line(cli, program, tmp_path):
    marks = tmp_path / "maple.csv"
    subprocess.run([program, "leaf", "--venation", "palmate", "--marks", str(marks), "--quiet"], check=True)
    assert bg.leaf(marks).digest == cli("leaf", marks)["digest"]


def test_leaves_of_scans_are_those_of_the_command_line(cli, tmp_path):
    v, u = np.meshgrid(np.linspace(0, 1, 60), np.linspace(-1, 1, 21), indexing="ij")
    half = 0.25 * 70 * (1 - (2 * v - 1) ** 2) + 0.3
    points = np.stack([u * half, v * 70, 0.002 * 70**2 * v * v * (1 - 0.2 * u * u)], -1).reshape(-1, 3)
    scan = tmp_path / "scan.xyz"
    np.savetxt(scan, points)
    made = bg.leaf(scan, unit="mm")
    assert made.digest == cli("leaf", "--scan", scan, "--unit", "mm")["digest"]
    # The same bits as the reader makes of millimetres: where sides of a leaf are exactly alike, the last bit decides.
    again = bg.leaf(points * 0.001)
    assert again.measures() == made.measures()


@pytest.mark.parametrize(
    "how, words",
    [
        ({"venation": "pinnate"}, "palmate or parallel"),
        ({"venation": "palmate", "veins": 4}, "odd number from 3 to 11"),
        ({"venation": "palmate", "depth": 2}, "depth must be 0 to 0.9"),
        ({"venation": "parallel", "depth": 0.5}, "of palmate leaves"),
        ({"venation": "palmate", "length": float("nan")}, "length must be"),
        ({"veins": 5}, "venation='palmate'"),
        ({"spec": np.zeros((5, 2))}, "shape"),
        ({"spec": np.full((9, 3), np.nan)}, "finite"),
        ({"spec": np.zeros((3, 3))}, "."),
        ({"spec": np.zeros((30, 3)), "curl": 0.3}, "of a scan has no fields"),
    ],
)
def test_what_makes_no_leaf_is_told(how, words):
    with pytest.raises(ValueError, match=words):
        bg.leaf(**how)


def test_structure_is_written_as_opf(small):
    text = small.to_bytes("opf").decode()
    leaves = sum(bg.PARTS[part] == "leaf" for part in small.organs.part)
    assert text.count('class="Leaf"') == leaves > 0 and "+Z up" in text


def test_structure_is_written_as_swc(small, tmp_path):
    small.save(tmp_path / "small.swc")
    rows = [line.split() for line in (tmp_path / "small.swc").read_text().splitlines() if not line.startswith("#")]
    borne = sum(axis >= 0 for axis in small.axes.bearer)
    assert len(rows) == len(small.nodes.radius) - borne
    assert all(int(row[6]) < int(row[0]) for row in rows), "bearers come first"


def test_a_spec_is_the_same_as_file_dict_and_keywords(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('name = "mine"\nage = 5\n[leaves]\nleaf_keep = 0.5\n')
    as_file = bg.grow(path, seed=4, detail=0.1)
    as_dict = bg.grow({"name": "mine", "age": 5, "leaves": {"leaf_keep": 0.5}}, seed=4, detail=0.1)
    as_words = bg.grow(None, seed=4, detail=0.1, name="mine", age=np.int64(5), leaves={"leaf_keep": np.float32(0.5)})
    assert as_file.digest == as_dict.digest == as_words.digest
    assert as_file.spec["leaves"]["leaf_keep"] == 0.5
    assert as_file.digest != bg.grow(path, seed=5, detail=0.1).digest


def test_strokes_are_a_drawing():
    stem = np.c_[np.sin(np.linspace(0, 1, 40)) * 3, np.linspace(0, 60, 40)]
    turn = np.linspace(0, 2 * np.pi, 30)
    leaves = [np.c_[x + 8 * np.cos(turn), 30 + 4 * np.sin(turn)] for x in (-9, 11)]
    plant = bg.sketch([stem, *leaves], seed=2)
    assert plant.maker == "sketch" and len(plant.axes) >= 1
    assert plant.digest == bg.sketch([s * [1, -1] for s in [stem, *leaves]], seed=2, y_up=False).digest
    one = bg.sketch([stem, *leaves], classes={1: "blade", 2: "blade"})
    assert sum(one.organs.part == bg.PARTS.index("leaf")) == 2


def test_edits_by_hand_are_those_of_the_command_line(cli, shown, tmp_path):
    tree = bg.grow("hazel", seed=3, age=4, detail=0.1)
    path = max(tree.branches(1), key=lambda b: b["length_m"])["path"]
    edits = {"schema": "burgeon.edits/1", "edits": [{"op": "prune", "axis": {"path": path}, "at": 0.3}]}
    spec, file = tmp_path / "hazel.toml", tmp_path / "edits.json"
    spec.write_text("age = 4\n" + shown("hazel"))
    file.write_text(json.dumps(edits))
    cut = tree.shape(file)
    assert cut.digest == tree.shape(edits).digest == tree.shape(edits["edits"]).digest != tree.digest
    theirs = cli("shape", spec, "--seed", 3, "--detail", "0.1", "--edits", file, "--json")
    assert cut.digest == theirs["digest"]
    assert len(cut.nodes) < len(tree.nodes) and cut.report["edits"][0]["done"]


def test_flowers_open_from_day_to_day():
    rose = bg.bloom("rose", 0.0, seed=2)
    opened = rose.at(rose.days[0])
    assert opened.digest == bg.bloom("rose", seed=2).digest != rose.digest
    assert opened.measures()["height_m"] > 0
    with pytest.raises(bg.SpecError, match="day must be 0 to 100 d, not 200"):
        rose.at(200.0)


def test_a_law_is_fitted_and_sets_the_pace(tmp_path):
    days = np.arange(0.0, 20.0, 2.0)
    sizes = 0.2 / (1 + 19 * np.exp(-0.5 * days))
    law = bg.Law.fit(days, sizes, name="petal")
    assert law.determined == [True]
    assert np.allclose(law(days), sizes, rtol=1e-3)
    law.save(tmp_path / "petal.law.json")
    again = bg.Law.read(tmp_path / "petal.law.json")
    assert again.to_dict() == law.to_dict() and again(3) == law(3.0)
    slow = bg.bloom("tulip", 2.0, law=law)
    assert slow.digest != bg.bloom("tulip", 2.0).digest


def test_projects_open_as_they_were_saved(tmp_path, root):
    tree = bg.grow("birch", seed=6, age=8, detail=0.2)
    tree.save(tmp_path / "birch.burgeon")
    (again,) = bg.open(tmp_path / "birch.burgeon")
    assert (again.digest, again.model.digest) == (tree.digest, tree.model.digest)
    assert len(bg.open(root / "fixtures/projects/version-5.burgeon")) == 3


def leaf_cloud(length):
    """The points of a bent leaf, metres."""
    v, u = np.meshgrid(np.linspace(0, 1, 60), np.linspace(-1, 1, 21), indexing="ij")
    half = 0.25 * length * (1.0 - (2.0 * v - 1.0) ** 2) + 0.0003
    return np.column_stack([(u * half).ravel(), (v * length).ravel(), (2.0 * length**2 * v**2 * (1.0 - 0.2 * u**2)).ravel()])


def test_a_plant_of_scans_of_several_days_is_the_command_lines(cli, tmp_path):
    first, last = tmp_path / "scan.xyz", tmp_path / "last.xyz"
    np.savetxt(first, 1e3 * leaf_cloud(0.024), fmt="%.17g")
    np.savetxt(last, 1e3 * leaf_cloud(0.041), fmt="%.17g")
    stages = [f'[[stage]]\nfile = "{name}.xyz"\nday = {day}\n' for name, day in (("scan", 0), ("last", 4))]
    (tmp_path / "scan.toml").write_text('unit = "mm"\nsplit = "none"\n' + "".join(stages))
    theirs = cli("bloom", "run", tmp_path / "scan.toml", "--day", 1.5, "--plant", "-o", tmp_path / "o.glb")
    mine = bg.bloom({4: last, 0: first}, 1.5, unit="mm", single=True)
    assert mine.digest == theirs["digest"] and "leaf" in {bg.PARTS[part] for part in mine.organs.part}
    # It grows from day to day, by the law where there is one.
    clouds = {0: leaf_cloud(0.024), 1: leaf_cloud(0.035), 2: leaf_cloud(0.041), 3: leaf_cloud(0.043)}
    law = bg.Law.fit_scans(clouds, single=True)
    assert set(law.organs) == {"organ"}
    high = [bg.bloom(clouds, day, law=law, single=True).measures()["leaf_area_m2"] for day in (0.0, 0.5, 1.5, 3.0)]
    assert high == sorted(high) and high[3] > 2 * high[0]
    assert bg.bloom(clouds, single=True).digest == bg.bloom(clouds, 3.0, single=True).digest


def test_what_is_made_of_a_scan_has_its_colours():
    cloud = leaf_cloud(0.03)
    brown = np.column_stack([cloud, np.tile([120, 80, 40], (len(cloud), 1))])

    def painted(plant):
        pictures = [part.texture for part in plant.model.parts if part.texture is not None]
        return [np.asarray(p)[..., :3].reshape(-1, 3).mean(axis=0).round().tolist() for p in pictures]

    for make in (bg.leaf, lambda scan, **fields: bg.bloom({0: scan}, single=True, **fields)):
        assert painted(make(brown)) == [[120, 80, 40]]
        assert make(brown, texture="plain").digest == make(cloud).digest and painted(make(cloud)) == []


@pytest.mark.parametrize(
    "call, field",
    [
        (lambda: bg.leaf(np.full((50, 6), 300.0)), "scan[0]"),
        (lambda: bg.leaf(leaf_cloud(0.02), texture="veins"), "texture"),
        (lambda: bg.bloom({0: leaf_cloud(0.02)}, stalk_m=0.2), "stalk_m"),
        (lambda: bg.bloom("rose", unit="mm"), "unit"),
        (lambda: bg.bloom({0: np.zeros((5, 2))}), "scans[0]"),
        (lambda: bg.bloom({0: np.full((50, 3), np.nan)}), "scans[0][0]"),
        (lambda: bg.bloom({float("nan"): leaf_cloud(0.02)}, 1.0), "scans: a day"),
        (lambda: bg.bloom({0: leaf_cloud(0.02)}, unit="inch"), "unit"),
        (lambda: bg.Law.fit_scans({}), "scans"),
    ],
)
def test_scans_that_cannot_be_used_are_named(call, field):
    with pytest.raises(bg.SpecError) as error:
        call()
    assert error.value.field == field, str(error.value)
    for few in ({0: leaf_cloud(0.02), 1: leaf_cloud(0.03)}, {0: leaf_cloud(0.02)[:4]}):
        with pytest.raises(bg.SpecError, match=r"\d"):
            bg.Law.fit_scans(few, single=True)
