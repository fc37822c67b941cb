"""Requests -> plants. The same specs, ranges and defaults as the command line."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Tuple, Union, cast

from . import _burgeon
from ._given import asked_of, beyond, flag, number, unused, whole, word, wrong
from ._given import coloured as _coloured
from ._given import path as path_of
from ._given import points as _points
from ._recipe import recipe
from .errors import SpecError
from .law import Law, scans_of
from .plant import Plant

if TYPE_CHECKING:
    import numpy as np

    Strokes = Union[str, os.PathLike[str], Iterable[np.ndarray]]

__all__ = ["bloom", "grow", "leaf", "open", "presets", "scan", "schema", "sketch"]


class SpecText(NamedTuple):
    """Text of a TOML file."""

    toml: str
    file: str


Spec = Union[str, "os.PathLike[str]", Mapping[str, Any], SpecText, None]


def _base(spec: Spec, trust_paths: bool = False) -> "Tuple[Dict[str, Any], Dict[str, Any]]":
    """Returns the source of a spec, and its fields if it is a dict."""
    base: "Dict[str, Any]" = {"preset": None, "toml": None, "trust_paths": trust_paths}
    if spec is None:
        return base, {}
    if isinstance(spec, Mapping):
        return base, dict(spec)
    if isinstance(spec, SpecText):
        return {**base, "toml": (spec.toml, spec.file)}, {}
    path = path_of("spec", spec)
    if isinstance(spec, str) and not path.endswith(".toml"):
        return {**base, "preset": path}, {}
    return {**base, "toml": (_text(path), path)}, {}


def _text(path: str) -> str:
    import builtins

    with builtins.open(path, "rb") as file:
        data = file.read()
    foreign = _burgeon.foreign(data[:4096])
    if foreign is not None:
        raise SpecError(f"{path}: {foreign}")
    return data.decode("utf-8").replace("\r\n", "\n")


def grow(
    spec: Spec = None,
    *,
    seed: int = 1,
    detail: "Optional[float]" = None,
    sides: "Optional[int]" = None,
    textures: "Optional[bool]" = None,
    texture_size: "Optional[int]" = None,
    foliage: "Optional[str]" = None,
    leaf: "Optional[Plant]" = None,
    height: "Optional[float]" = None,
    dbh: "Optional[float]" = None,
    wind: "Optional[bool]" = None,
    budget: float = 1.0,
    trust_paths: bool = False,
    **fields: Any,
) -> Plant:
    """Grows a tree (``burgeon grow``).

    ``spec``: a species (``presets()[0]``), a TOML file, or a dict of fields; ``fields`` replace fields of it, tables by tables:
    ``grow("oak", seed=2, age=30, leaves={"leaf_keep": 0.5})``. All fields, with ranges and units: ``schema("tree")``,
    docs/trees.md.

    ``detail``: fineness of the meshes, 0.1 to 8; ``sides``: number of sides of an ordinary branch, 3 to 24; ``textures``: False
    for plain colours; ``texture_size``: pixels of a side, 64 to 4096; ``foliage``: leaves as ``outlines``, as ``cards`` from
    which they are cut out, or ``by-level`` of detail; ``leaf``: a result of ``leaf()`` that replaces the tree's own leaf;
    ``height``, ``dbh``: height, or diameter of the stem at 1.3 m, metres, within what its species reaches: the tree has the age
    at which it comes nearest, and is scaled by the rest;
    ``wind``: with columns for wind; ``budget``: factor by which the usual limits may be exceeded; ``trust_paths``: meshes, points
    and a leaf that a file names may lie outside of its folder. Ctrl-C stops it. Raises SpecError, BudgetError.
    """
    base, own = _base(spec, flag("trust_paths", trust_paths))
    skin = {"detail": detail, "sides": sides, "textures": textures, "texture_size": texture_size}
    asked = asked_of(seed, budget, {**own, **fields}, {**skin, "foliage": foliage, "wind": wind})
    if textures is False and texture_size is not None:
        raise unused("texture_size", texture_size, "is of textures, which textures=False leaves out")
    if textures is False and foliage not in (None, "outlines"):
        raise unused("foliage", foliage, "is cut out of pictures of leaves, which textures=False leaves out")
    if not isinstance(leaf, (Plant, type(None))):
        raise TypeError(f"leaf must be a plant of leaf(), not {leaf!r}")
    size = {
        "height": None if height is None else number("height", height, 0.01, 1000, "m"),
        "dbh": None if dbh is None else number("dbh", dbh, 0.001, 30, "m"),
    }
    told = [name for name, value in (("height", height), ("dbh", dbh), ("age", fields.get("age"))) if value is not None]
    if len(told) > 1:
        raise wrong(f"{told[0]} and {told[1]} exclude each other: give one", told[1], "given", "left out")
    plant = Plant(recipe("grow", base, asked, leaf, size))
    for name, value in (("leaf", leaf), ("foliage", foliage)):
        if value is not None and plant.spec.get("bare"):
            raise unused(name, value, "is of trees with leaves, and this one is bare")
    if leaf is not None and foliage is not None:
        raise unused("foliage", foliage, "is of leaves of the species: `leaf` gives another")
    return plant


def bloom(
    spec: "Union[Spec, Mapping[float, Any]]" = "lily",
    day: "Optional[float]" = None,
    *,
    seed: int = 1,
    law: "Optional[Law]" = None,
    unit: str = "m",
    up: str = "y",
    single: bool = False,
    wind: "Optional[bool]" = None,
    budget: float = 1.0,
    **fields: Any,
) -> Plant:
    """Makes a flower that opens, on a day (``burgeon bloom run``), or a plant of scans on any day, also outside of theirs.

    ``spec``: a flower (``presets()[1]``), a TOML file, or a dict; ``day``: 0 is the bud, default full bloom; ``law``: a
    fitted law that sets the pace; ``fields``: ``schema("flower")``, docs/bloom.md.

    For scans, ``spec`` is a dict from days to clouds of points, each a file (``.xyz``, ``.ply``, ``.pcd``, ``.las``) or an array
    (points, 3), or (points, 6) with red, green and blue from 0 to 255, in ``unit`` (m, cm, mm) with ``up`` (y, z); ``day``:
    default the last; ``single``: each is one organ, not a stem with leaves; ``law``: a result of ``Law.fit_scans``, default an
    even pace; ``texture``: ``scan`` (the colours of the clouds, if they have some; the default) or ``plain``.
    """
    if not isinstance(law, (Law, type(None))):
        raise TypeError(f"law must be a Law, not {law!r}")
    if isinstance(spec, Mapping) and spec and not any(isinstance(key, str) for key in spec):
        if wind is not None:
            raise unused("wind", wind, "is of flowers: a plant of scans has no columns for wind")
        texture = _scan_texture(fields, "flowers; a plant of scans has no fields but texture")
        days = scans_of("scan", cast("Mapping[float, Any]", spec), unit, up, single, seed, budget, texture)
        when = max(map(float, spec)) if day is None else number("day", day, -1e4, 1e4, "d")
        return Plant(recipe("plant", when, law, before=days))
    for name, value, usual in (("unit", unit, "m"), ("up", up, "y"), ("single", single, False)):
        if value != usual:
            raise wrong(f"{name} is of scans of several days: give a dict from days to clouds", name, value, "left out")
    base, own = _base(cast("Spec", spec))
    asked = asked_of(seed, budget, {**own, **fields}, {"wind": wind})
    day = None if day is None else number("day", day, 0, 100, "d")
    return Plant(recipe("bloom", base, asked, day, law))


CLOUDS = (".xyz", ".txt", ".ply", ".pcd", ".las", ".laz")
"""Extensions of files of points."""


def leaf(
    spec: "Union[Spec, np.ndarray]" = None,
    *,
    venation: "Optional[str]" = None,
    veins: "Optional[int]" = None,
    length: "Optional[float]" = None,
    depth: "Optional[float]" = None,
    side_veins: "Optional[int]" = None,
    unit: str = "m",
    seed: int = 1,
    wind: "Optional[bool]" = None,
    budget: float = 1.0,
    **fields: Any,
) -> Plant:
    """Makes a leaf (``burgeon leaf``): from measured marks or chief veins (``.csv``), from a vein graph (``.json``), from a scan
    (``.xyz``, ``.ply``, ``.pcd``, ``.las`` in ``unit``, or an array (points, 3) in metres, or (points, 6) with red, green and
    blue from 0 to 255), or from numbers. For a scan, ``texture`` is ``scan`` (its colours, if it has some; the default) or
    ``plain``.

    ``venation``: ``palmate`` or ``parallel``, a leaf of chief veins that start together: the number of ``veins`` (odd),
    ``length`` in metres, for palmate leaves the ``depth`` of the notches (0 to 0.9), and ``side_veins`` (0 to 12); ``fields``:
    ``schema("leaf")``, docs/leaves.md; for a leaf of numbers ``form={"length_m": 0.08, "lobes": 0.4}``.
    """
    file, toml, own = None, None, {}
    others = {"venation": venation, "veins": veins, "length": length, "depth": depth, "side_veins": side_veins, "wind": wind}
    if hasattr(spec, "ndim") or isinstance(spec, list):
        _only_of_files(unit, "an array is in metres")
        _not_of_scans(others)
        return _scanned("scan", None, spec, budget, fields)
    numbers = {
        "veins": None if veins is None else whole("veins", veins, 3, 31),
        "length_m": None if length is None else number("length", length, 0.001, 10, "m"),
        "depth": None if depth is None else number("depth", depth, 0, 0.9),
        "side_veins": None if side_veins is None else whole("side_veins", side_veins, 0, 12),
    }
    is_cloud = isinstance(spec, (str, os.PathLike)) and os.path.splitext(os.fspath(spec))[1].lower() in CLOUDS
    if not is_cloud:
        _only_of_files(unit, "none is given")
    if venation is not None:
        if spec is not None and not isinstance(spec, Mapping):
            raise wrong("venation makes a leaf of numbers: leave the file out", "spec", spec, "left out, or a dict")
        if venation == "parallel" and side_veins is not None:
            raise unused("side_veins", side_veins, "is of palmate leaves: parallel veins have none between them")
        asked = asked_of(seed, budget, {**dict(spec or {}), **fields}, {"wind": wind})
        return Plant(recipe("leaf_of_veins", {"venation": word("venation", venation), "file": None, **numbers}, asked))
    given = [name for name, value in numbers.items() if value is not None and name != "side_veins"]
    if given:
        option = given[0].replace("_m", "")
        line = f"{option} is of leaves with venation='palmate' or 'parallel'"
        raise wrong(line, option, numbers[given[0]], "left out")
    if is_cloud:
        _not_of_scans(others)
    if isinstance(spec, Mapping):
        own = dict(spec)
    elif isinstance(spec, SpecText):
        toml = spec.toml
    elif spec is not None:
        path = path_of("spec", spec)
        if path.endswith(".toml"):
            toml = _text(path)
        elif is_cloud:
            import builtins

            name, extension = os.path.splitext(os.path.basename(path))
            with builtins.open(path, "rb") as scan:
                return _scanned(name, (scan.read(), extension[1:].lower(), word("unit", unit)), None, budget, fields)
        else:
            file = (os.path.splitext(os.path.basename(path))[0], _text(path))
            if side_veins is not None and _burgeon.is_rays(file[1]):
                asked = asked_of(seed, budget, fields, {"wind": wind})
                return Plant(recipe("leaf_of_veins", {"venation": None, "file": file, **numbers}, asked))
    if side_veins is not None:
        raise unused("side_veins", side_veins, "is of leaves of chief veins: with venation, or of a file of them")
    return Plant(recipe("leaf", file, toml, asked_of(seed, budget, {**own, **fields}, {"wind": wind})))


def _only_of_files(unit: str, why: str) -> None:
    """Fails on a unit without a file of points."""
    if word("unit", unit) != "m":
        raise unused("unit", unit, f"is of a file of points ({', '.join(CLOUDS)}); {why}")


def _not_of_scans(given: "Mapping[str, Any]") -> None:
    """Fails on arguments that do not apply to a leaf of a scan."""
    for name, value in given.items():
        if value is not None:
            raise unused(name, value, "is of other leaves: that of a scan is as it was scanned")


def _scanned(name: str, file: Any, points: Any, budget: float, fields: "Mapping[str, Any]") -> Plant:
    """Makes the leaf of a cloud of points."""
    texture = _scan_texture(fields, "measured leaves; a leaf of a scan has no fields but texture")
    rows: "List[List[float]]" = []
    colors = b""
    if file is None:
        found, colors = _coloured(points)
        rows = found.tolist()
    return Plant(recipe("leaf_of_scan", name, file, (rows, colors), texture, number("budget", budget, 1, 1000)))


def _scan_texture(fields: "Mapping[str, Any]", others: str) -> str:
    """Returns the texture, the only field of scanned leaves and plants."""
    for field, value in fields.items():
        if field != "texture":
            raise wrong(f"{field} is of {others}", field, value, "left out")
    texture = word("texture", fields.get("texture", "scan"))
    if texture not in ("scan", "plain"):
        raise wrong(f"texture: {texture!r} is no texture of a scan", "texture", texture, "scan or plain")
    return texture


def scan(
    cloud: "Union[str, os.PathLike[str], np.ndarray]",
    *,
    leaves: Spec = None,
    at: "Optional[Tuple[float, float]]" = None,
    cell: "Optional[float]" = None,
    gap: "Optional[float]" = None,
    unit: str = "m",
    up: str = "z",
    seed: int = 1,
    name: "Optional[str]" = None,
    detail: "Optional[float]" = None,
    sides: "Optional[int]" = None,
    textures: "Optional[bool]" = None,
    wind: "Optional[bool]" = None,
    budget: float = 1.0,
    trust_paths: bool = False,
) -> Plant:
    """Finds the tree of a laser scan (``burgeon scan``): stem and branches with their radii.

    ``cloud``: a file (``.laz``, ``.las``, ``.ply``, ``.xyz``, ``.txt``, ``.pcd``, ``.obj``) or an array (points, 3), in ``unit``
    (m, cm, mm) with ``up`` (z, y); a ``Cloud`` of ours has ``up="y"``. ``leaves``: a species as for ``grow``, whose leaves it
    gets (default: bare); ``at``: place of the stem, in the two horizontal coordinates (default: the largest thing on the ground);
    ``cell``: edge of the cubes into which the cloud is divided, metres, 0.001 to 1; ``gap``: widest gap that is bridged, metres,
    0 to 5; ``trust_paths``: for ``leaves``, as in ``grow``. ``plant.found`` counts the points, ``plant.place`` is its place in
    the scan.
    """
    if at is not None:
        if isinstance(at, (str, bytes)) or not hasattr(at, "__len__") or len(at) != 2:
            raise TypeError(f"at must be two coordinates, not {at!r}")
        at = (number("at[0]", at[0], -1e8, 1e8), number("at[1]", at[1], -1e8, 1e8))
    how: "Dict[str, Any]" = {"file": None, "points": b"", "unit": word("unit", unit), "up": word("up", up), "at": at}
    how["cell"] = None if cell is None else number("cell", cell, 0.001, 1, "m")
    how["gap"] = None if gap is None else number("gap", gap, 0, 5, "m")
    if isinstance(cloud, (str, os.PathLike)):
        import builtins

        path = os.fspath(cloud)
        own_name, extension = os.path.splitext(os.path.basename(path))
        name = own_name if name is None else name
        with builtins.open(path, "rb") as file:
            how["file"] = (file.read(), extension[1:].lower())
    else:
        how["points"] = _points(cloud).tobytes()
        name = "scan" if name is None else name
    base, own = (None, {}) if leaves is None else _base(leaves, flag("trust_paths", trust_paths))
    skin = {"detail": detail, "sides": sides, "textures": textures, "wind": wind}
    return Plant(recipe("tree_of_scan", word("name", name), how, base, asked_of(seed, budget, own, skin)))


def sketch(
    strokes: "Strokes",
    *,
    seed: int = 1,
    name: "Optional[str]" = None,
    y_up: bool = True,
    classes: "Optional[Mapping[int, str]]" = None,
    day: "Optional[float]" = None,
    detail: "Optional[float]" = None,
    sides: "Optional[int]" = None,
    textures: "Optional[bool]" = None,
    variation: "Optional[float]" = None,
    petals: "Optional[str]" = None,
    wind: "Optional[bool]" = None,
    budget: float = 1.0,
    **fields: Any,
) -> Plant:
    """Makes the plant of a drawing (``burgeon sketch``).

    ``strokes``: a file (``.svg``, ``.inkml``, ``.ndjson``, ``.json``), or the strokes in the order of drawing, each an array
    (points, 2) of x and y in any unit, y upwards (``y_up=False``: downwards, as on a screen). ``classes``: classes of strokes, by
    number (``{0: "axis"}``); ``day``: the day if its flowers open, 0 to 100; ``petals``: a colour such as ``blue``, otherwise
    random; ``fields``: ``schema("sketch")``, such as ``height_m=0.3`` or ``read_as="tree"``.
    """
    asked = asked_of(
        seed,
        budget,
        fields,
        {"detail": detail, "sides": sides, "textures": textures, "variation": variation, "petals": petals, "wind": wind},
    )
    if isinstance(strokes, (str, os.PathLike)):
        import builtins

        if not y_up:
            raise unused("y_up", y_up, "is of arrays: a file says itself where up is")
        path = os.fspath(strokes)
        own_name, extension = os.path.splitext(os.path.basename(path))
        name = own_name if name is None else name
        with builtins.open(path, "rb") as file:
            ink: "Dict[str, Any]" = {"file": (file.read(), extension[1:]), "lines": []}
    else:
        ink = {"file": None, "lines": _lines(strokes, y_up)}
        name = "drawing" if name is None else name
    told = [(whole("classes: a stroke", row, 0, 10**6), word(f"classes[{row}]", kind)) for row, kind in (classes or {}).items()]
    day = None if day is None else number("day", day, 0, 100, "d")
    return Plant(recipe("sketch", word("name", name), ink, asked, told, day))


def _lines(strokes: "Iterable[Any]", y_up: bool) -> "List[List[List[float]]]":
    import numpy as np

    lines = []
    if not hasattr(strokes, "__iter__"):
        raise TypeError(f"strokes must be a file, or arrays of shape (points, 2), not {strokes!r}")
    for k, stroke in enumerate(strokes):
        points = np.asarray(stroke)
        if points.dtype.kind not in "fiu":
            raise TypeError(f"strokes[{k}] must be numbers, not {points.dtype}")
        if points.ndim != 2 or points.shape[1] != 2:
            raise beyond(f"strokes[{k}]", points.shape, "of shape (points, 2)")
        points = points.astype(np.float64)
        if not np.isfinite(points).all():
            row = int(np.argmin(np.isfinite(points).all(axis=1)))
            raise beyond(f"strokes[{k}][{row}]", points[row].tolist(), "finite")
        if not y_up:
            points[:, 1] *= -1.0
        lines.append(points.tolist())
    return lines


def open(
    project: "str | os.PathLike[str] | bytes",
    *,
    only: "Optional[int]" = None,
    wind: bool = False,
    budget: float = 1.0,
) -> "List[Plant]":
    """Makes the visible plants of a project of the Studio (``.burgeon``, or its bytes), each as it was made there.

    ``plant.place`` is the place of each; ``only``: one of them, by its row; ``wind``: with columns for wind.
    """
    import builtins

    only = None if only is None else whole("only", only, 0, 10**6)
    if not isinstance(project, bytes):
        with builtins.open(path_of("project", project), "rb") as file:
            project = file.read()
    asked = (project, number("budget", budget, 1, 1000), bool(wind))
    made = enumerate(_burgeon.open_project(*asked, only))
    return [Plant(recipe("open_project", *asked, row if only is None else only), raw) for row, raw in made]


def schema(maker: str) -> "Dict[str, Any]":
    """Returns the JSON Schema of a maker's options: meaning, unit (``x-unit``), range and default of each field.

    ``maker``: ``tree``, ``flower``, ``leaf``, ``sketch`` or ``skin``.
    """
    return json.loads(_burgeon.schema(word("maker", maker)))


def presets() -> "Tuple[List[str], List[str]]":
    """Returns the words of the trees and of the flowers that come with the program."""
    return _burgeon.presets()
