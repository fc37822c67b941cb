"""Whatever crosses the boundary gives a result or an error that says what is wrong; the interpreter lives on."""

import inspect
import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import burgeon as bg
from burgeon import dataset

CALM = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
REFUSED = (ValueError, TypeError, OverflowError, MemoryError, IndexError, KeyError)

PLAIN = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=6) | st.binary(max_size=4)
NUMBERS = st.sampled_from(
    [0, -1, 1, 2.5, 1e308, -1e308, 2**31, 2**63, 2**64, np.inf, -np.inf, np.nan, np.float32(3), np.int8(-3)]
)
ODD = PLAIN | NUMBERS | st.lists(PLAIN | NUMBERS, max_size=4) | st.dictionaries(st.text(max_size=4), PLAIN, max_size=2)
ARRAYS = arrays.arrays(
    dtype=st.sampled_from(["f8", "f4", "f2", ">f8", "i8", "u1", "?", "c16", "U3", "M8[s]", "O"]),
    shape=arrays.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=7),
)


def told(call):
    """Calls; an error has words."""
    try:
        return call()
    except REFUSED as error:
        assert str(error), repr(error)
        return None


def any_of(names, values=ODD):
    return st.dictionaries(st.sampled_from(names), values, max_size=3)


@CALM
@given(ARRAYS | ODD)
def test_any_array_is_a_scan_or_is_refused(small, points):
    for make in (bg.scan, bg.leaf):
        made = told(lambda make=make: make(points)) if not isinstance(points, (str, dict, type(None))) else None
        assert made is None or len(made.nodes) > 0


@CALM
@given(any_of(["points", "stations", "elevation", "noise", "seed", "beam", "pulse", "path"]))
def test_any_scanner_sees_or_is_refused(small, how):
    cloud = told(lambda: small.cloud(**{"points": 50, **how}))
    assert cloud is None or np.isfinite(cloud.points).all()


@CALM
@given(any_of(["size", "view", "azimuth", "elevation", "background", "shadow", "supersample", "seed"]))
def test_any_picture_is_taken_or_refused(small, how):
    shown = told(lambda: small.render(**{"size": (8, 8), "supersample": 1, **how}))
    assert shown is None or shown.dtype == np.uint8
    seen = told(lambda: small.masks(**{"size": (8, 8), **how}))
    assert seen is None or seen.part.shape == seen.depth.shape


@CALM
@given(
    any_of(["lods", "one_file", "instances", "impostor", "pack", "sway", "unit", "up"]),
    st.sampled_from(["x.glb", "x.obj", "x.mtg"]),
)
def test_anything_is_written_whole_or_not_at_all(small, tmp_path_factory, how, name):
    folder = tmp_path_factory.mktemp("written")
    # Several coarser copies take a while, and are tried elsewhere.
    how = {k: v for k, v in how.items() if not (k in ("lods", "impostor") and isinstance(v, int) and v > 1)}
    told(lambda: small.save(folder / name, **how))
    left = os.listdir(folder)
    assert not [n for n in left if "draft" in n] and (not left or name in left)


@CALM
@given(any_of(["seed", "day", "detail", "sides", "textures", "wind", "age", "leaves", "look", "roots", "obstacles", "method"]))
def test_any_settings_make_another_plant_or_are_refused(small, how):
    how = {k: v for k, v in how.items() if not (k == "detail" and isinstance(v, (int, float)) and v > 1)}
    made = told(lambda: small.again(**how))
    assert made is None or len(made.nodes) > 0
    assert small.maker == "tree"


@CALM
@given(any_of(["species", "spacing", "seed", "kinds", "vary", "budget"]), ODD)
def test_any_grove_is_made_or_refused(how, area):
    area = area if not isinstance(area, (int, float)) else min(area, 8)
    plain = {"species": "grass", "spacing": 4.0, "kinds": 1, "age": 2, "detail": 0.1, "textures": False}
    if isinstance(how.get("species"), (dict, type(None))):
        how.pop("species", None)
    made = told(lambda: bg.grove(**{**plain, "area": area, **how}))
    assert made is None or len(made) > 0


@CALM
@given(st.fixed_dictionaries({name: ARRAYS | ODD for name in ("position", "yaw_deg", "scale", "plant")}))
def test_any_places_are_a_grove_or_are_refused(small, places):
    made = told(lambda: bg.Grove([small], places))
    assert made is None or np.isfinite(made.model.vertices).all()


@CALM
@given(ODD, ODD, any_of(["venation", "veins", "length", "depth", "side_veins", "seed"]))
def test_any_day_law_and_leaf_is_made_or_refused(day, values, how):
    made = told(lambda: bg.bloom("tulip", day))
    assert made is None or np.isfinite(made.model.vertices).all()
    law = told(lambda: bg.Law.fit([0.0, 1.0, 2.0, 4.0], [0.1, 0.2, 0.3, 0.35]))
    told(lambda: law(values))
    told(lambda: bg.leaf(**how))


@CALM
@given(
    st.binary(max_size=200),
    st.sampled_from(["xyz", "ply", "pcd", "las", "laz", "svg", "inkml", "ndjson", "csv", "json", "toml", "burgeon"]),
)
def test_any_bytes_are_a_file_or_are_refused(tmp_path_factory, data, extension):
    path = tmp_path_factory.mktemp("bytes") / f"x.{extension}"
    path.write_bytes(data)
    for read in (bg.scan, bg.leaf, bg.sketch, bg.open, bg.grow, bg.Law.read):
        told(lambda read=read: read(path))
    told(lambda: bg.open(data))


@CALM
@given(any_of(["n", "maker", "seed", "formats", "fields", "vary", "cloud", "picture", "shard", "spec"]))
def test_any_recipe_is_made_or_refused(tmp_path_factory, how):
    out = tmp_path_factory.mktemp("set")
    plain = {"spec": "grass", "n": 1, "formats": ("mtg",), "fields": {"detail": 0.1, "textures": False, "age": 2}}
    how = {k: v for k, v in how.items() if not (k == "n" and isinstance(v, int) and v > 2)}
    told(lambda: dataset.generate(out=out, workers=1, progress=False, **{**plain, **how}))
    assert not [n for n in os.listdir(out) if "draft" in n]


def methods(thing):
    return [(n, m) for n, m in vars(type(thing)).items() if not n.startswith("__") and callable(m)]


@CALM
@given(st.data())
def test_the_core_itself_refuses_what_is_none(small, data):
    """The private module, too: whatever it is called with, it ends in an error of Python."""
    from burgeon import _burgeon

    raws = (small._raw, small._raw.model(), _burgeon.RawLaw.fit("x", [("x", [0.0, 1.0, 2.0, 4.0], [0.1, 0.2, 0.3, 0.35])], 1.0))
    functions = [(n, f) for n, f in vars(_burgeon).items() if callable(f) and not inspect.isclass(f) and n != "set_threads"]
    _name, call = data.draw(st.sampled_from(functions + [(n, getattr(raw, n)) for raw in raws for n, _ in methods(raw)]))
    count = len(inspect.signature(call).parameters)
    values = data.draw(st.lists(ODD | ARRAYS, min_size=count, max_size=count))
    told(lambda: call(*values))


def test_huge_arrays_are_refused_before_they_are_copied():
    """Views of a thousandth of the memory that they claim."""
    wide = np.broadcast_to(np.zeros(3), (2**40, 3))
    with pytest.raises((MemoryError, ValueError)):
        bg.scan(wide)
    with pytest.raises((MemoryError, ValueError)):
        bg.sketch([np.broadcast_to(np.zeros(2), (2**40, 2))])


def test_shared_and_read_only_memory_is_left_as_it_is(small):
    line = np.c_[np.linspace(0, 3, 40), np.linspace(0, 60, 40)]
    line.setflags(write=False)
    before = line.copy()
    bg.sketch([line], y_up=False)
    assert (line == before).all()
    points = np.asarray(small.cloud(2000).points)
    kept = points.copy()
    told(lambda: bg.scan(points, up="y"))
    assert (points == kept).all()
    for array in (small.nodes.position, small.model.parts[0].faces, small.cloud(10).part):
        with pytest.raises(ValueError):
            array.setflags(write=True)


def test_ray_that_is_missing_is_told(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "ray", None)
    with pytest.raises(ImportError, match=r"pip install 'ray>=2'"):
        dataset.generate("grass", 1, tmp_path, ray=True, progress=False)
    assert not [n for n in os.listdir(tmp_path) if n.endswith(".tar") or "draft" in n]


@pytest.mark.skipif(sys.platform == "win32", reason="limits of Unix")
def test_a_disk_without_room_is_told_and_nothing_is_half_written(tmp_path):
    """A real limit of the system: files may have 20,000 bytes."""
    code = """
        import resource, signal, sys, burgeon as bg
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))
        try:
            bg.dataset.generate("hazel", 2, sys.argv[1], formats=("glb",), fields={"detail": 0.2, "age": 4}, shard=1,
                                workers=1, progress=False)
        except OSError as error:
            print("told:", error)
        try:
            bg.grow("hazel", age=4, detail=0.2).save(sys.argv[1] + "/x.glb", lods=1)
        except OSError as error:
            print("told:", error)
    """
    asked = [sys.executable, "-c", textwrap.dedent(code), str(tmp_path)]
    done = subprocess.run(asked, capture_output=True, text=True, check=True)
    assert done.stdout.count("told:") == 2, done.stderr
    assert os.listdir(tmp_path) == ["recipe.json"]
    # With room again, the same call makes it.
    how = dict(formats=("glb",), fields={"detail": 0.2, "age": 4}, shard=1, workers=1, progress=False)
    assert dataset.generate("hazel", 2, tmp_path, **how)["plants"] == 2
