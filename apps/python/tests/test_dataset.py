"""Data sets: the same bytes on one process, on several, after some were killed; only what is missing is made again."""

import contextlib
import hashlib
import io
import json
import os
import signal
import subprocess
import sys
import tarfile
import threading
import time

import numpy as np
import pytest

import burgeon as bg
from burgeon import dataset
from conftest import python

HOW = dict(
    formats=("glb", "mtg", "cloud", "picture"),
    fields={"detail": 0.1, "textures": False},
    vary={"age": (2, 4), "leaves": [{"leaf_keep": 0.5}, {"leaf_keep": 1.0}]},
    cloud={"points": 300, "noise": 0.002},
    picture={"size": (64, 64), "supersample": 1},
    shard=3,
    progress=False,
)


def sums(folder):
    names = sorted(n for n in os.listdir(folder) if n.endswith(".tar"))
    return {n: hashlib.sha256((folder / n).read_bytes()).hexdigest() for n in names}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    out = tmp_path_factory.mktemp("here")
    return out, dataset.generate("hazel", 8, out, workers=1, **HOW)


def test_a_data_set_holds_what_it_says(made):
    out, manifest = made
    assert manifest["plants"] == 8 and [e["plants"] for e in manifest["shards"]] == [3, 3, 2]
    assert sums(out) == {e["file"]: e["sha256"] for e in manifest["shards"]}
    dataset.verify(out)
    plants = list(dataset.read(out))
    assert len(plants) == 8 and len({p["digest"] for p in plants}) == 8
    for k, plant in enumerate(plants):
        assert plant["seed"] == dataset.plant_seed(1, k) and 2 <= plant["fields"]["age"] <= 4
        again = bg.grow("hazel", seed=plant["seed"], detail=0.1, textures=False, **plant["fields"])
        assert again.digest == plant["digest"] and again.measures() == plant["measures"]
        assert again.to_bytes("glb") == plant["glb"] and again.to_bytes("mtg") == plant["mtg"]
        assert plant["cloud"]["points"].shape == (300, 3) and plant["masks"]["part"].shape == (64, 64)
        assert plant["png"].startswith(b"\x89PNG")
    assert len({p["fields"]["age"] for p in plants}) > 1
    croissant = json.loads((out / "croissant.json").read_text())
    table = hashlib.sha256((out / "plants.csv").read_bytes()).hexdigest()
    assert [f["sha256"] for f in croissant["distribution"]] == [*(e["sha256"] for e in manifest["shards"]), table]


def test_several_processes_make_the_same_bytes(made, tmp_path):
    assert dataset.generate("hazel", 8, tmp_path, workers=2, **HOW) == made[1]
    assert sums(tmp_path) == sums(made[0])


def test_only_what_is_missing_is_made_again(made, tmp_path):
    dataset.generate("hazel", 8, tmp_path, workers=1, **HOW)
    times = {n: os.stat(tmp_path / n).st_mtime_ns for n in os.listdir(tmp_path) if n.endswith(".tar")}
    os.unlink(tmp_path / "shard-00001.tar")
    (tmp_path / "shard-00002.tar").write_bytes(b"half a shard")
    with pytest.raises(ValueError, match="shard-00001.tar, shard-00002.tar"):
        dataset.verify(tmp_path)
    assert dataset.generate("hazel", 8, tmp_path, workers=1, **HOW) == made[1]
    assert sums(tmp_path) == sums(made[0])
    assert os.stat(tmp_path / "shard-00000.tar").st_mtime_ns == times["shard-00000.tar"]


def test_a_folder_holds_one_data_set(made):
    with pytest.raises(ValueError, match=r"holds another data set \(n, seed differ\)"):
        dataset.generate("hazel", 9, made[0], seed=2, **HOW)


@pytest.mark.parametrize("wrong", [{"fields": {"age": 3, "leave": {}}}, {"vary": {"age": ["old"]}}, {"cloud": {"points": 0}}])
def test_a_recipe_that_made_nothing_gives_way_to_the_corrected_one(tmp_path, wrong):
    how = dict(formats=("mtg", "cloud"), fields={"age": 3}, cloud={"points": 50}, shard=1, workers=1, progress=False)
    with pytest.raises(ValueError):
        dataset.generate("grass", 1, tmp_path, **{**how, **wrong})
    assert dataset.generate("grass", 1, tmp_path, **how)["plants"] == 1
    dataset.verify(tmp_path)


def test_a_folder_that_was_taken_meanwhile_is_left_alone(tmp_path, monkeypatch):
    how = dict(formats="mtg", fields={"age": 3}, shard=1, workers=1, progress=False)
    real = dataset.make_plant

    def slow(recipe, index):
        if recipe["seed"] == 1:
            dataset.generate("grass", 1, tmp_path, seed=2, **how)
        return real(recipe, index)

    monkeypatch.setattr(dataset, "make_plant", slow)
    with pytest.raises(ValueError, match="taken by another data set"):
        dataset.generate("grass", 1, tmp_path, seed=1, **how)
    dataset.verify(tmp_path)
    assert [p["seed"] for p in dataset.read(tmp_path)] == [dataset.plant_seed(2, 0)]


def test_the_threads_of_the_program_stay_as_they_are(tmp_path):
    """The number of threads of the calling program: its own process computes with as many as it has set."""
    pytest.importorskip("psutil")
    how = dict(formats="mtg", fields={"detail": 0.1, "textures": False, "age": 3}, workers=1, progress=False)
    code = (
        "import burgeon as bg, numpy, psutil; bg.set_threads(3); before = psutil.Process().num_threads()\n"
        f"bg.dataset.generate('hazel', 2, {str(tmp_path)!r}, **{how!r})\n"
        "print(psutil.Process().num_threads() - before)"
    )
    assert python(code) == "3"


def test_specs_of_files_go_along(tmp_path):
    (tmp_path / "mine.toml").write_text('name = "mine"\n[leaves]\nleaf_keep = 0.3\n')
    how = dict(formats="mtg", fields={"detail": 0.1, "textures": False, "age": 3}, shard=1, progress=False)
    made = dataset.generate(tmp_path / "mine.toml", 2, tmp_path / "out", workers=2, **how)
    own = bg.grow(tmp_path / "mine.toml", seed=dataset.plant_seed(1, 1), **how["fields"])
    assert made["shards"][1]["digests"] == [own.digest]


@pytest.mark.parametrize(
    "how, words",
    [
        ({"n": 0}, "n must be"),
        ({"formats": ("docx",)}, "formats are"),
        ({"maker": "carve"}, "maker must be"),
        ({"vary": {"age": (5, 2)}}, "vary: age"),
        ({"vary": {"age": []}}, "no choices"),
        ({"fields": {"leave": 1}}, "unknown field"),
    ],
)
def test_bad_recipes_are_told_and_leave_no_shard(tmp_path, how, words):
    with pytest.raises(ValueError, match=words):
        dataset.generate("hazel", **{"n": 1, "out": tmp_path, "workers": 1, "progress": False, **how})
    assert not [n for n in os.listdir(tmp_path) if n.endswith(".tar") or "draft" in n]


def test_a_full_disk_leaves_whole_shards_and_no_drafts(tmp_path, monkeypatch):
    import burgeon._files as files

    real, left = os.fsync, [3]

    def full(handle):
        left[0] -= 1
        if left[0] < 0:
            raise OSError(28, "No space left on device")
        return real(handle)

    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        dataset.generate("hazel", 8, tmp_path, workers=1, **HOW)
    names = os.listdir(tmp_path)
    assert "shard-00000.tar" in names and "shard-00001.tar" not in names and not [n for n in names if "draft" in n]


class Killer(threading.Thread):
    """Kills one process that makes shards as soon as there is one that works."""

    def __init__(self, word, least_s):
        super().__init__()
        self.psutil = pytest.importorskip("psutil")
        self.word, self.least_s, self.killed = word, least_s, None
        self.start()

    def run(self):
        end = time.time() + 120
        while time.time() < end and self.killed is None:
            for child in self.psutil.process_iter(["cmdline"]):
                try:
                    line = " ".join(child.info["cmdline"] or [])
                    if self.word in line and child.cpu_times().user > self.least_s:
                        child.kill()
                        self.killed = child.pid
                        break
                except self.psutil.Error:
                    pass
            time.sleep(0.002)


# Plants that take a moment: so long that one is killed in the middle.
LONG = dict(formats="glb", fields={"detail": 1.0}, shard=2, progress=False)


def test_processes_that_are_killed_are_replaced(tmp_path):
    want = dataset.generate("hazel", 8, tmp_path / "a", workers=1, **LONG)
    killer = Killer("spawn_main", 0.3)
    got = dataset.generate("hazel", 8, tmp_path / "b", workers=2, **LONG)
    assert killer.killed, "no worker was killed"
    assert got == want and sums(tmp_path / "a") == sums(tmp_path / "b")


@pytest.mark.parametrize("as_file", [True, False])
def test_programs_need_no_guard(tmp_path, as_file):
    """Nor a file: what is typed or piped into Python uses several processes, too."""
    how = dict(formats="mtg", fields={"detail": 0.1, "textures": False, "age": 2}, shard=1, workers=2, progress=False)
    code = f"import burgeon as bg\nprint(bg.dataset.generate('grass', 3, {str(tmp_path / 'out')!r}, **{how!r})['plants'])"
    (tmp_path / "program.py").write_text(code)
    words = [sys.executable, tmp_path / "program.py"] if as_file else [sys.executable, "-"]
    given = None if as_file else code
    done = subprocess.run(words, input=given, capture_output=True, text=True, check=False, timeout=120)
    assert (done.returncode, done.stdout.strip()) == (0, "3"), done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_ctrl_c_stops_all_processes_at_once(tmp_path):
    """Also if the signal reaches only this process, and not all of its terminal."""
    psutil = pytest.importorskip("psutil")
    how = dict(formats="glb", fields={"detail": 4.0}, shard=200, workers=2, progress=False)
    code = f"import burgeon as bg\nbg.dataset.generate('oak', 400, {str(tmp_path)!r}, **{how!r})"
    program = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True)
    busy, end = [], time.time() + 120
    try:
        own = psutil.Process(program.pid)
        while len(busy) < 2 and time.time() < end:
            time.sleep(0.01)
            with contextlib.suppress(psutil.Error):
                busy = [c for c in own.children(recursive=True) if "spawn_main" in " ".join(c.cmdline())]
                busy = [c for c in busy if c.cpu_times().user > 1.0]
        assert len(busy) == 2, "the workers did not work"
        started = time.time()
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=60)
        alive = [c for c in busy if c.is_running() and c.status() != psutil.STATUS_ZOMBIE]
    finally:
        for process in (program, *busy):
            with contextlib.suppress(psutil.Error, OSError):
                process.kill()
    # A shard takes minutes.
    assert not alive
    assert time.time() - started < 20 and program.returncode not in (0, None)
    assert said.count("Traceback") == 1 and said.rstrip().endswith("KeyboardInterrupt"), said
    assert os.listdir(tmp_path) == ["recipe.json"]


def test_progress_is_told_in_files_too(tmp_path, monkeypatch, capsys):
    how = dict(formats="mtg", fields={"detail": 0.1, "textures": False, "age": 2}, shard=1, workers=1)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(dataset, "EVERY_S", 0.0)
    dataset.generate("grass", 3, tmp_path / "a", **how)
    assert capsys.readouterr().err == "".join(f"shards: {k} of 3\n" for k in range(4))
    monkeypatch.setattr(dataset, "EVERY_S", 1000.0)
    dataset.generate("grass", 3, tmp_path / "b", **how)
    assert capsys.readouterr().err == "shards: 0 of 3\nshards: 3 of 3\n"
    dataset.generate("grass", 3, tmp_path / "c", progress=False, **how)
    assert capsys.readouterr().err == ""


def test_progress_is_that_of_tqdm_where_it_is_installed(tmp_path, capsys):
    pytest.importorskip("tqdm")
    how = dict(formats="mtg", fields={"detail": 0.1, "textures": False, "age": 2}, shard=1, workers=1)
    dataset.generate("grass", 3, tmp_path, **how)
    said = capsys.readouterr().err
    assert "shards: 100%" in said and "3/3" in said


def test_numbers_of_numpy_are_numbers(tmp_path):
    how = dict(formats="mtg", fields={"detail": 0.1, "textures": False, "age": 2}, workers=1, progress=False)
    made = dataset.generate("grass", np.int64(2), tmp_path / "a", seed=np.uint8(3), shard=np.int32(1), **how)
    assert made == dataset.generate("grass", 2, tmp_path / "b", seed=3, shard=1, **how)
    with pytest.raises(bg.SpecError, match="n must be a whole number, 1 to 1000000000, not 2.5"):
        dataset.generate("grass", 2.5, tmp_path / "c", **how)


def test_drawings_and_laz(tmp_path, program):
    laspy = pytest.importorskip("laspy")
    how = {**HOW, "formats": ("cloud", "laz", "drawing"), "picture": None}
    first = dataset.generate("hazel", 4, tmp_path / "a", workers=1, **how)
    assert dataset.generate("hazel", 4, tmp_path / "b", workers=2, **how)["shards"] == first["shards"]
    for plant in dataset.read(tmp_path / "a"):
        cloud, file = plant["cloud"], laspy.read(io.BytesIO(plant["laz"]))
        x, y, z = cloud["points"].T
        assert np.abs(np.array([file.x - x, file.y + z, file.z - y])).max() <= 0.000051
        for name in ("part", "axis", "organ", "order", "distance"):
            assert np.array_equal(file[name], cloud[name]) and file[name].dtype == cloud[name].dtype
        assert np.array_equal(file.point_source_id, cloud["station"])
        again = bg.grow("hazel", seed=plant["seed"], detail=0.1, textures=False, **plant["fields"])
        assert plant["svg"] == again.drawing().to_svg()
    # The command reads it, too.
    tree = bg.grow("oak", seed=2, age=12, detail=0.2, textures=False, bare=True)
    tree.cloud(60_000, stations=6).save(tmp_path / "oak.laz")
    report = tmp_path / "report.json"
    subprocess.run([program, "scan", tmp_path / "oak.laz", "-o", tmp_path / "oak.glb", "--report", report], check=True)
    assert json.loads(report.read_text())["items"]
    with pytest.raises(ValueError, match=r"written as \.npz, \.las or \.laz, not \.xyz"):
        tree.cloud(100).save(tmp_path / "oak.xyz")
    with pytest.raises(ValueError, match="formats are glb, cloud, laz"):
        dataset.generate("hazel", 1, tmp_path / "c", maker="grove", formats="drawing", progress=False)


def test_laspy_that_is_missing_is_told(monkeypatch):
    monkeypatch.setitem(sys.modules, "laspy", None)
    with pytest.raises(ImportError, match=r"pip install .laspy\[lazrs\]"):
        bg.leaf().cloud(100).to_bytes("laz")


def test_croissant_is_what_its_authors_check(made):
    croissant = pytest.importorskip("mlcroissant")
    own = croissant.Dataset(jsonld=str(made[0] / "croissant.json"))
    assert own.metadata.issues.errors == set()
    assert len(own.metadata.distribution) == 4
    records = {record["plants/index"]: record for record in own.records("plants")}
    assert sorted(records) == list(range(8))
    for plant in dataset.read(made[0]):
        record = records[plant["index"]]
        assert record["plants/digest"].decode() == plant["digest"] and int(record["plants/seed"]) == plant["seed"]
        assert record["plants/age"] == plant["fields"]["age"]
        assert json.loads(record["plants/leaves"]) == plant["fields"]["leaves"]
        with tarfile.open(made[0] / record["plants/file"].decode()) as shard:
            assert f"{plant['index']:08d}.glb" in shard.getnames()


@pytest.mark.ray
def test_four_workers_of_ray_make_the_same_bytes(made, tmp_path):
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=4, include_dashboard=False, log_to_driver=False)
    try:
        assert dataset.generate("hazel", 8, tmp_path / "ray", ray=True, **HOW) == made[1]
        assert sums(tmp_path / "ray") == sums(made[0])
        want = dataset.generate("hazel", 8, tmp_path / "one", workers=1, **LONG)
        # Workers that Ray keeps have worked before: their name says when they make a shard.
        killer = Killer("ray::make_shard", 0.0)
        got = dataset.generate("hazel", 8, tmp_path / "killed", ray=True, **LONG)
        assert killer.killed, "no worker was killed"
        assert got == want and sums(tmp_path / "killed") == sums(tmp_path / "one")
    finally:
        ray.shutdown()


def test_a_manifest_names_shards_beside_it_alone(made, tmp_path):
    import shutil

    out = tmp_path / "set"
    shutil.copytree(made[0], out)
    manifest = json.loads((out / "manifest.json").read_text())
    shard = manifest["shards"][0]["file"]
    (tmp_path / "x.tar").write_bytes((out / shard).read_bytes())
    (out / "link.tar").symlink_to("../x.tar")
    os.mkfifo(out / "pipe.tar")
    for name in ("../x.tar", "..\\x.tar", str(tmp_path / "x.tar"), "link.tar", "pipe.tar", ".", "", 7, None):
        manifest["shards"][0]["file"] = name
        (out / "manifest.json").write_text(json.dumps(manifest))
        for use in (lambda: list(dataset.read(out)), lambda: dataset.verify(out)):
            with pytest.raises(ValueError, match="data set|beside its manifest"):
                use()
