"""Every keyword argument of every maker, file and picture: it changes what comes out, or it is an error that names it.

What says how work is done (`budget`) and the seed of what has no chance in it are taken without a word.
"""

import inspect
import json
import re

import numpy as np
import pytest

import burgeon as bg
from burgeon.errors import SpecError

#: Steers how work is done; a seed goes with everything that is made.
RUNNING = {"budget", "seed", "trust_paths"}
#: The rest: fields of a spec, which have a test of their own.
REST = {"self", "fields", "how"}

SMALL = {
    "method": {
        "kind": "colonization",
        "points": 60,
        "envelope": {"shape": "sphere", "centre": [0.0, 1.0, 0.0], "radius_m": 0.5},
        "steps": {"attraction_m": 0.8, "kill_m": 0.3},
    }
}
BARE = {**SMALL, "bare": True}
PETAL = np.array([[0.0, 0.0], [0.3, 0.5], [0.0, 1.0], [-0.3, 0.5], [0.0, 0.0]])
LINES = [
    [(0.0, 0.0), (0.02, 0.6), (0.0, 1.2)],
    *(PETAL @ np.array([[c, s], [-s, c]]) + (0.0, 1.2) for c, s in ((np.cos(a), np.sin(a)) for a in np.linspace(0, 5.2, 6))),
]


def blade(bend=0.0, colours=False):
    """A sheet of points in the form of a leaf."""
    u, v = np.meshgrid(np.linspace(0, 1, 60), np.linspace(-0.5, 0.5, 20))
    half = 0.12 * u * (1 - u) + 0.002
    points = np.stack([2 * v * half, 0.1 * u, bend * u * u], axis=-1).reshape(-1, 3)
    paint = np.tile([30.0, 160.0, 40.0], (len(points), 1))
    return np.hstack([points, paint]) if colours else points


def trunk():
    """A bare stem of 2 m on the ground, +z up, and a second one next to it."""
    angle, height = np.meshgrid(np.linspace(0, 6.1, 24), np.linspace(0, 3, 160))
    stem = np.stack([0.1 * np.cos(angle), 0.1 * np.sin(angle), height], axis=-1).reshape(-1, 3)
    ground = np.stack([*np.meshgrid(np.linspace(-2, 6, 80), np.linspace(-2, 2, 40)), np.zeros((40, 80))], axis=-1).reshape(-1, 3)
    other = stem * (1.3, 1.3, 0.9) + (4.0, 0.0, 0.0)
    return np.vstack([ground, stem, other])


@pytest.fixture(scope="module")
def files(tmp_path_factory, root):
    """Files that are read, by their names."""
    folder = tmp_path_factory.mktemp("options")
    np.savetxt(folder / "scan.xyz", trunk(), fmt="%.4f")
    np.savetxt(folder / "blade.xyz", blade(), fmt="%.5f")
    bg.sketch(LINES).drawing().save(folder / "drawn.svg")
    (folder / "marks.csv").write_bytes((root / "fixtures/leaves/leaf1.csv").read_bytes())
    (folder / "several.burgeon").write_bytes((root / "fixtures/projects/version-3.burgeon").read_bytes())
    return folder


def tree(**more):
    return {"detail": 0.3, "sides": 5, "textures": False, "wind": True, "foliage": "cards", "texture_size": 128, **more}


#: A call that works, its function, and a value that is not the default for each of its keyword arguments.
def uses(files):
    one_leaf = bg.leaf()
    law = bg.Law.fit([0, 1, 2, 4, 6, 8], [0.01, 0.013, 0.02, 0.04, 0.05, 0.051])
    scans = {day: blade(0.03, colours=True) * ([size] * 3 + [1] * 3) for day, size in ((0, 1), (1, 1.6), (2, 1.9), (4, 2))}
    scanned = bg.Law.fit_scans(scans, single=True)
    leaf = {"venation": "palmate", "veins": 7, "length": 0.2, "depth": 0.2, "side_veins": 2, "unit": "cm", "wind": True}
    flower = {"day": 1.0, "law": law, "unit": "cm", "up": "z", "single": True, "wind": True}
    sketch = {
        "name": "mine",
        "y_up": False,
        "classes": {0: "axis"},
        "day": 1.0,
        "detail": 0.3,
        "sides": 5,
        "textures": False,
        "variation": 0.0,
        "petals": "blue",
        "wind": True,
    }
    scan = {
        "leaves": "oak",
        "at": (4.0, 0.0),
        "cell": 0.3,
        "gap": 0.0,
        "unit": "cm",
        "up": "y",
        "name": "mine",
        "detail": 0.3,
        "sides": 5,
        "textures": False,
        "wind": True,
    }
    grove = {"spacing": 2.0, "kinds": 1, "vary": 0.5}
    grow = tree(leaf=one_leaf, height=3.0, dbh=0.05)
    return [
        ("grow", bg.grow, (SMALL,), {}, grow),
        ("grow, of a species", bg.grow, ("grass",), {"age": 1}, grow),
        ("grow, bare", bg.grow, (BARE,), {}, grow),
        ("grow, without textures", bg.grow, (SMALL,), {"textures": False}, grow),
        ("bloom", bg.bloom, ("lily",), {}, flower),
        ("bloom, on a day", bg.bloom, ("lily",), {"day": 1.0}, flower),
        ("bloom, of scans", bg.bloom, (scans,), {"day": 0.5}, {**flower, "law": scanned}),
        ("bloom, of scans of an organ", bg.bloom, (scans,), {"single": True, "day": 0.5}, {**flower, "law": scanned}),
        ("leaf", bg.leaf, (), {}, leaf),
        ("leaf, palmate", bg.leaf, (), {"venation": "palmate"}, {**leaf, "venation": "parallel"}),
        ("leaf, parallel", bg.leaf, (), {"venation": "parallel"}, leaf),
        ("leaf, of marks", bg.leaf, (files / "marks.csv",), {}, leaf),
        ("leaf, of a scan", bg.leaf, (blade(),), {}, leaf),
        ("leaf, of a file of a scan", bg.leaf, (files / "blade.xyz",), {}, leaf),
        ("sketch", bg.sketch, (LINES,), {}, sketch),
        ("sketch, of a file", bg.sketch, (files / "drawn.svg",), {}, sketch),
        ("scan", bg.scan, (trunk(),), {}, scan),
        ("scan, of a file", bg.scan, (files / "scan.xyz",), {}, scan),
        ("open", bg.open, (files / "several.burgeon",), {}, {"only": 0, "wind": True}),
        ("grove", bg.grove, (SMALL, 9), {"textures": False}, {**grove, "area": 12}),
    ]


def named(function):
    """Its keyword arguments that may be left out."""
    given = inspect.signature(function).parameters.values()
    keyword = [p.name for p in given if p.kind in (p.KEYWORD_ONLY, p.POSITIONAL_OR_KEYWORD) and p.default is not p.empty]
    return [name for name in keyword if name not in RUNNING | REST]


#: What is made is named by its first argument, which each use has.
FIRST = {"spec", "species", "cloud", "strokes", "project"}

#: Works on such input, but finds nothing here that it could change.
NOTHING_TO_STEER = {
    # In full bloom after any law: it is for `plant.at`.
    ("bloom", "law"),
    # A stem without a branch has no gap, and a trunk its sides by its girth.
    *((use, name) for use in ("scan", "scan, of a file") for name in ("gap", "sides")),
}


def forget_times(value):
    if isinstance(value, dict):
        return {name: forget_times(v) for name, v in value.items() if "timings" not in name}
    return [forget_times(v) for v in value] if isinstance(value, list) else value


def seen(made):
    """All that a person can see of it."""
    if isinstance(made, list):
        return [seen(one) for one in made]
    if isinstance(made, bg.Grove):
        return made.digest, made.name
    parts = [
        (part.wind.tobytes(), part.material["base_color"], b"" if part.texture is None else part.texture.tobytes())
        for part in made.model.parts
    ]
    texts = json.dumps(forget_times(made.report)), json.dumps(made.spec) if made.maker != "scan" else ""
    return made.name, made.digest, made.model.digest, parts, texts, made.day


def tried(argument, function, given, fields):
    """Returns the result; None if it is refused with its name."""
    try:
        return seen(function(*given, **fields))
    except (SpecError, TypeError) as error:
        assert re.search(rf"\b{argument}\b", str(error)), f"{argument}: {error}"
        return None


def test_no_argument_is_ignored(files):
    ignored = []
    for use, function, given, plain, values in uses(files):
        known = [name for name in named(function) if name not in FIRST]
        assert sorted(set(known) - set(plain)) == sorted((set(values) & set(known)) - set(plain)), use
        usual = seen(function(*given, **plain))
        for name in known:
            if name in plain and use != "leaf, palmate":
                continue
            if (use, name) in NOTHING_TO_STEER:
                continue
            if tried(name, function, given, {**plain, name: values[name]}) == usual:
                ignored.append(f"{use}: {name}={values[name]!r}")
    assert not ignored, "\n".join(ignored)


def test_no_argument_of_files_is_ignored(tmp_path):
    plant = bg.grow(SMALL, textures=False)
    how = {
        "unit": "cm",
        "up": "z",
        "lods": 1,
        "one_file": True,
        "instances": True,
        "impostor": 128,
        "pack": "quantized",
        "sway": True,
        "engine": "isaac",
        "triangles": 600,
        "megabytes": 0.02,
    }
    assert sorted(how) == sorted(named(bg.Plant.save))
    ignored = []

    def written(name, **how):
        folder = tmp_path / f"{len(list(tmp_path.iterdir()))}"
        folder.mkdir()
        plant.save(folder / name, **how)
        return {file.name: file.read_bytes() for file in sorted(folder.iterdir())}

    for name in ("x.glb", "x.obj", "x.ply", "x.stl", "x.usda", "x.usdz", "x.mtg", "x.opf", "x.swc", "x.qsm.csv", "x.burgeon"):
        usual = written(name)
        for option, value in how.items():
            value = "y" if option == "up" and name in ("x.mtg", "x.opf", "x.swc", "x.qsm.csv") else value
            try:
                if written(name, **{option: value}) == usual:
                    ignored.append(f"{name}: {option}={value!r}")
            except SpecError as error:
                assert option in str(error), f"{name}: {option}: {error}"
    assert not ignored, "\n".join(ignored)


def test_no_argument_of_pictures_is_ignored():
    model = bg.grow(SMALL, textures=False).model
    how = {"azimuth": 90.0, "elevation": 40.0, "background": "white", "shadow": False, "supersample": 1}
    for view in ("three-quarter", "orbit"):
        usual = model.render(64, view=view).tobytes()
        for name, value in how.items():
            try:
                assert model.render(64, view=view, **{name: value}).tobytes() != usual, (view, name)
            except SpecError as error:
                assert name in str(error) and view != "orbit"


def test_no_field_of_an_age_beyond_life_is_ignored():
    for species, end in (("oak", 40), ("alder", 24), ("maize", 1)):
        with pytest.raises(SpecError, match=rf"age must be 1 to {end}, not 5000: the life of .* ends there") as error:
            bg.grow(species, age=5000)
        assert error.value.code == "age-beyond" and error.value.fields["end"] == str(end)
    with pytest.raises(SpecError, match=r"age must be 1 to \d+, not 500"):
        bg.grow(SMALL, age=500)


#: Words of the language that this is written in, of the command line, and of drafts: nobody who calls Python knows them.
FOREIGN_WORDS = r"\b[iu](8|16|32|64|size)\b|\bf(32|64)\b|Self::|\w::\w|\bstruct\b|\benum\b|untagged|serde|--\w|\.draft\b|\.part\b"
KINDS = ["text", True, -1, 1.5, [], {}, None, [1, 2], {"a": 1}, "#zz", 1e30]


def pointers(value, path=()):
    """The ways to all fields of a spec."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield (*path, name)
            yield from pointers(inner, (*path, name))


def said(function, *given, **fields):
    """Returns the message of an error; nothing if there is none."""
    try:
        function(*given, **fields)
    except Exception as error:
        return str(error)
    return ""


def test_no_message_has_a_word_of_rust_or_of_the_command_line(tmp_path):
    told = set()
    makers = [
        (lambda **f: bg.grow("oak", detail="stop", **f), bg.grow("grass", age=1, detail=0.2).spec),
        (lambda **f: bg.bloom("lily", **f), bg.bloom("lily").spec),
        (bg.leaf, bg.leaf().spec),
        (lambda **f: bg.sketch(LINES, **f), bg.sketch(LINES).spec),
    ]
    for make, spec in makers:
        spec = spec.get("spec", spec)
        for path in pointers(spec):
            for kind in KINDS if len(path) < 3 else KINDS[:3]:
                fields = kind
                for name in reversed(path):
                    fields = {name: fields}
                told.add(said(make, **fields))
    edits = [{"op": "paint"}, {"op": "prune"}, {"op": "prune", "axis": 3}, {"op": "prune", "axis": {"path": "x"}, "at": True}, 7]
    plant = bg.grow(SMALL, textures=False)
    told |= {said(plant.shape, [edit]) for edit in edits}
    told |= {said(bg.scan, np.zeros((9, 3))), said(bg.scan, trunk() * 1000), said(bg.scan, trunk()[:, [0, 2, 1]])}
    told |= {said(bg.scan, trunk(), at=(9.5, 1.25)), said(bg.grow, SMALL, roots=[[k, 0, 0] for k in range(2000)])}
    told.add(said(plant.save, tmp_path / "none" / "x.glb"))
    bad = sorted(text for text in told if re.search(FOREIGN_WORDS, text))
    assert len(told) > 60 and not bad, "\n".join(bad)


def test_a_place_is_told_in_the_axes_of_the_scan():
    message = said(bg.scan, trunk(), at=(9.5, 1.25))
    assert "9.50,1.25" in message and "-1.25" not in message, message


def test_a_draft_is_nobodys_file(tmp_path):
    plant = bg.leaf()
    (tmp_path / "taken.glb").mkdir()
    for place in (tmp_path / "none" / "x.glb", tmp_path / "taken.glb"):
        with pytest.raises(OSError) as error:
            plant.save(place)
        assert any(str(p) in str(error.value) for p in (place, place.parent))
        assert ".draft" not in str(error.value)


FILES = {
    b"\x89PNG\r\n\x1a\n": "a picture (PNG)",
    b"%PDF-1.7\n": "a PDF document",
    b"\x1f\x8b\x08\x00": "compressed with gzip",
    b"PK\x03\x04" + b"\0" * 26 + b"mimetypeapplication/x-krita": "a Krita document",
    b"PK\x03\x04" + b"\0" * 26 + b"Document.archivebplist": "a Procreate document",
    b"PK\x03\x04" + b"\0" * 26 + b"word/document.xml": "a ZIP archive",
    b"ASTM-E57": "E57",
}


def test_files_of_other_programs_are_named(tmp_path):
    for data, name in FILES.items():
        for make, end in (
            (bg.sketch, "x"),
            (bg.sketch, "png"),
            (bg.scan, "las"),
            (bg.scan, "x"),
            (bg.leaf, "csv"),
            (bg.grow, "toml"),
        ):
            if name.startswith("compressed") and make is bg.sketch:
                continue  # a compressed drawing may be read
            file = tmp_path / f"given.{end}"
            file.write_bytes(data + b"\0" * 100)
            message = said(make, str(file))
            assert name in message, f"{make.__name__}, .{end}: {message}"
    other = tmp_path / "drawing.csv"
    other.write_text('{"type": "excalidraw", "version": 2}')
    assert "a drawing of Excalidraw" in said(bg.leaf, str(other))
