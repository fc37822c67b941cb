"""Stands of many trees: inventories, and stands that grow, as tables and as 3D Tiles (``burgeon forest``).

>>> import burgeon as bg
>>> wood = bg.forest.grow({"area_m": [60, 60], "years": 20, "species": [{"name": "birch"}]})
>>> len(wood) == len(wood.height) > 0
True

``read`` takes an inventory, ``grow`` a spec (docs/forests.md); both give a ``Stand``, whose columns are NumPy arrays and whose
``tiles`` are those of the command, with the same bytes (docs/tiles.md). Plants that stand together as meshes: ``burgeon.grove``.
"""

from __future__ import annotations

import json
import os
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from ._files import write_whole
from ._given import asked_of, beyond, flag, number, table, unused, whole, word, wrong
from ._given import path as path_of
from ._recipe import Recipe, recipe
from ._workers import results
from .makers import SpecText, _text
from .model import array

__all__ = ["Stand", "Tiles", "grow", "read", "tiles"]

COLUMNS = ("species", "row", "position", "height", "dbh", "crown_width", "age", "crown_offset", "yaw", "up")
"""Columns of a stand."""

MOST_BYTES = 1 << 30
"""Most bytes of an inventory."""

JOBS = 4
"""Parts of the work for each worker: more keep all of them busy to the end, fewer read fewer models again."""

Inventory = Union[str, "os.PathLike[str]", bytes, Any]
StandSpec = Union[str, "os.PathLike[str]", Mapping[str, Any], SpecText]


class Tiles(NamedTuple):
    """A written tileset."""

    folder: str
    """Folder of ``tileset.json``."""
    manifest: "Dict[str, Any]"
    """Contents of ``manifest.json``: ``key``, and ``files``, each with ``file``, ``digest``, ``bytes``; empty for one tile."""
    report: "Dict[str, Any]"
    """``variants``, ``tiles``, the largest errors of measures in metres, ``clipped``, ``warnings``."""


class Stand:
    """The trees of a forest, one row each. A stand never changes. Metres, +x east, +y up, +z south."""

    __slots__ = ("_columns", "_raw", "_recipe", "seed")

    def __init__(self, made_of: Recipe, seed: int) -> None:
        self._recipe = made_of
        self._raw = made_of.make()
        self._columns: "Dict[str, np.ndarray]" = {}
        self.seed = seed

    def __len__(self) -> int:
        return self._raw.count()

    def __repr__(self) -> str:
        return f"<burgeon.forest.Stand: {len(self)} trees of {', '.join(self.species_names)}>"

    def __reduce__(self) -> "Tuple[Any, ...]":
        return Stand, (self._recipe, self.seed)

    def _column(self, name: str) -> "np.ndarray":
        if name not in self._columns:
            self._columns[name] = array(self._raw.column(name))
        return self._columns[name]

    @property
    def species_names(self) -> "List[str]":
        """Words of presets, or names of specs, in the order of ``species``."""
        return self._raw.species()

    @property
    def origin(self) -> "Tuple[float, float, float]":
        """Easting, height and northing of the place of ``position`` zero."""
        east, up, north = self._raw.origin()
        return east, up, north

    @property
    def species(self) -> "np.ndarray":
        """(n,) uint32: row of ``species_names``."""
        return self._column("species")

    @property
    def row(self) -> "np.ndarray":
        """(n,) uint32: row of the inventory, from 1; in a grown stand the number of the tree."""
        return self._column("row")

    @property
    def position(self) -> "np.ndarray":
        """(n, 3) float64: foot of the trunk, metres from ``origin``."""
        return self._column("position")

    @property
    def height(self) -> "np.ndarray":
        """(n,) float64: metres."""
        return self._column("height")

    @property
    def dbh(self) -> "np.ndarray":
        """(n,) float64: diameter of the stem at 1.3 m, metres; 0 for lower trees."""
        return self._column("dbh")

    @property
    def crown_width(self) -> "np.ndarray":
        """(n,) float64: metres."""
        return self._column("crown_width")

    @property
    def age(self) -> "np.ndarray":
        """(n,) float64: years."""
        return self._column("age")

    @property
    def crown_offset(self) -> "np.ndarray":
        """(n, 3) float64: from the foot to the middle of the crown, horizontal, metres."""
        return self._column("crown_offset")

    @property
    def yaw(self) -> "np.ndarray":
        """(n,) float64: rotation about the vertical, radians."""
        return self._column("yaw")

    @property
    def up(self) -> "np.ndarray":
        """(n, 3) float64: direction of the trunk at its foot, a unit vector."""
        return self._column("up")

    def table(self) -> "Dict[str, np.ndarray]":
        """Returns columns for a data frame: ``pandas.DataFrame(stand.table())``; x, y and z are metres from ``origin``."""
        x, y, z = self.position.T
        names = np.array(self.species_names)[self.species]
        own = {"row": self.row, "species": names, "x": x, "y": y, "z": z}
        return {**own, **{name: self._column(name) for name in ("height", "dbh", "crown_width", "age")}}

    @property
    def report(self) -> "Dict[str, Any]":
        """Report of the reading or growth: ``rows``, ``skipped``, ``given`` and ``filled_log_interval`` of height, dbh, crown
        width and age, ``duplicates``, ``touching``; for a grown stand ``history`` (year, trees and basal area in square metres
        per hectare); ``warnings``."""
        return json.loads(self._raw.report())

    def to_csv(self) -> bytes:
        """Returns its table as CSV."""
        return bytes(self._raw.csv())

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes its table as ``.csv``, completely or not at all."""
        folder, name = os.path.split(path_of("path", path))
        if not name.lower().endswith(".csv"):
            raise beyond("path", repr(name), "a name that ends with .csv")
        write_whole(folder, [(name, self.to_csv())])

    def tiles(
        self,
        folder: "str | os.PathLike[str]",
        *,
        variants: int = 4,
        seed: "Optional[int]" = None,
        finest: int = 0,
        lods: int = 3,
        impostor: "Optional[int]" = 512,
        tile_trees: "Optional[int]" = None,
        pack: str = "meshopt",
        detail: "Optional[float]" = None,
        sides: "Optional[int]" = None,
        texture_size: "Optional[int]" = None,
        foliage: "Optional[str]" = None,
        glb: bool = False,
        usd: bool = False,
        level: "Optional[int]" = None,
        place: "Optional[Sequence[float]]" = None,
        tile: "Optional[Sequence[int]]" = None,
        workers: "Optional[int]" = 1,
        ray: bool = False,
        budget: float = 1.0,
    ) -> Tiles:
        """Writes it as 3D Tiles of grown plants (``burgeon forest -o FOLDER``), the same bytes with any number of workers.

        ``variants``: plants of each species and age, 1 to 64; ``seed``: that of the plants, by default that of the stand;
        ``finest``, ``lods``: levels of meshes, 0 to 6; ``impostor``: pixels of the pictures far away, 128 to 4096, or None;
        ``tile_trees``: most trees of a finest tile; ``pack``: ``meshopt`` or ``quantized``; ``detail``, ``sides``,
        ``texture_size``, ``foliage``: as for ``burgeon.grow``; ``glb``, ``usd``: also all trees in one file, at ``level``;
        ``place``: longitude, latitude and height of the origin, which sets it onto the earth; ``tile``: depth, column, row and
        level of one tile, which is written alone with its models.

        ``workers``: number of processes (1: this one; None: as many as the machine has cores); ``ray``: tasks of the Ray cluster
        that ``ray.init`` has joined, or of one on this machine. All its machines must see the folder.

        A killed worker is replaced. Ctrl-C, a full disk or an error leave only complete files; the same call continues. Raises
        ValueError for a folder with other contents, SpecError, BudgetError.
        """
        lods = whole("lods", lods, 0, 6)
        finest = whole("finest", finest, 0, lods)
        if level is not None and not (glb or usd):
            raise unused("level", level, "is of glb and usd")
        skin = {"detail": detail, "sides": sides, "texture_size": texture_size, "foliage": foliage}
        form = {
            "variants": whole("variants", variants, 1, 64),
            "seed": self.seed if seed is None else whole("seed", seed, 0, 2**64 - 1),
            "finest": finest,
            "lods": lods,
            "impostor": 0 if impostor is None else whole("impostor", impostor, 128, 4096),
            "tile_trees": None if tile_trees is None else whole("tile_trees", tile_trees, 1, 65_536),
            "pack": word("pack", pack),
            "skin": {name: value for name, value in skin.items() if value is not None},
            "glb": flag("glb", glb),
            "usd": flag("usd", usd),
            "level": min(finest + 1, lods) if level is None else whole("level", level, finest, lods),
            "place": None if place is None else _place(place),
            "budget": number("budget", budget, 1, 1000),
        }
        folder = os.path.abspath(path_of("folder", folder))
        raw = self._raw.plan(form)
        if tile is not None:
            for name, value in (("glb", glb), ("usd", usd), ("place", place), ("ray", ray)):
                if value:
                    raise unused(name, value, "is of whole tilesets: leave out tile")
            raw.tile(folder, _tile(tile))
            return Tiles(folder, {}, json.loads(raw.report()))
        if ray or workers != 1:
            self._make_parts(raw, form, folder, workers, ray)
        # Existing files stay; missing ones are made here.
        raw.write(folder)
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
            return Tiles(folder, json.load(file), json.loads(raw.report()))

    def _make_parts(self, raw: Any, form: "Dict[str, Any]", folder: str, workers: "Optional[int]", ray: bool) -> None:
        """Makes models and tiles on several workers. Only this process records the files."""
        raw.adopt(folder, [])
        count = (workers or os.cpu_count() or 1) * JOBS
        variants: "List[Part]" = [([one], []) for one in raw.variants()]
        # Models come first, because tiles name them.
        of_tiles: "List[Part]" = [([], part) for part in _parts(raw.tiles(), count)]
        for jobs in (variants, of_tiles):
            for files in results(_make_part, (self._recipe, form, folder), jobs, workers=workers, ray=ray):
                raw.adopt(folder, files)


Part = Tuple[List[int], List[Tuple[int, int, int, int]]]
"""Plants for their models, or tiles."""

_known: "Dict[str, Any]" = {}
"""The tiles on which this process worked last."""


def _make_part(made_of: Recipe, form: "Dict[str, Any]", folder: str, part: Part) -> "List[Tuple[str, str, int]]":
    """Writes a part of a tileset; returns its files with digests and sizes."""
    import hashlib
    import pickle

    key = hashlib.sha256(pickle.dumps((made_of, form))).hexdigest()
    if key not in _known:
        _known.clear()
        _known[key] = made_of.make().plan(form)
    return _known[key].part(folder, *part)


def _parts(all: "List[Any]", count: int) -> "List[List[Any]]":
    size = max(1, -(-len(all) // count))
    return [all[k : k + size] for k in range(0, len(all), size)]


def _place(place: "Sequence[float]") -> "List[float]":
    bounds = (("longitude", 180.0), ("latitude", 90.0), ("height", 1e5))
    numbers = list(place)
    if len(numbers) != len(bounds):
        raise beyond("place", repr(place), "longitude, latitude and height")
    return [number(f"place: {name}", value, -most, most) for (name, most), value in zip(bounds, numbers)]


def _tile(tile: "Sequence[int]") -> "Tuple[int, ...]":
    numbers = list(tile)
    if len(numbers) != 4:
        raise beyond("tile", repr(tile), "depth, column, row and level")
    most = (255, 2**32 - 1, 2**32 - 1, 255)
    return tuple(whole(f"tile[{k}]", value, 0, most[k]) for k, value in enumerate(numbers))


def read(
    inventory: Inventory,
    *,
    crs: "Optional[str]" = None,
    setting: str = "free",
    species: "Optional[str]" = None,
    bad_rows: str = "refuse",
    year: "Optional[int]" = None,
    ground: "Optional[Mapping[str, Any]]" = None,
    lean: float = 0.0,
    seed: int = 1,
    budget: float = 1.0,
) -> Stand:
    """Reads the stand of an inventory.

    ``inventory``: a file of CSV or GeoJSON, its bytes, or a data frame of pandas or polars, with the columns of docs/forests.md;
    ``crs``: ``metres``, ``local``, ``utm`` or a zone; ``setting``: surroundings of the trees, by which missing measures are
    filled (``free``, ``stand``); ``species``: that of rows with none, or with an unknown one; ``bad_rows``: ``refuse`` or
    ``skip``; ``year``: that of the inventory, for columns with the year of planting; ``ground``: a table as in specs, such as
    ``{"kind": "geotiff", "file": "hill.tif"}``; ``lean``: lean of trunks on slopes, 0 to 1. Raises SpecError with the row and
    column at fault.
    """
    data, path = _bytes(inventory)
    reading = {
        "crs": None if crs is None else word("crs", crs),
        "setting": word("setting", setting),
        "species": None if species is None else word("species", species),
        "bad_rows": word("bad_rows", bad_rows),
        "year": None if year is None else whole("year", year, 1, 9999),
        "ground": table("ground", ground) or {"kind": "flat"},
        "lean": number("lean", lean, 0, 1),
        "seed": whole("seed", seed, 0, 2**64 - 1),
        "budget": number("budget", budget, 1, 1000),
    }
    if ground is None and lean != 0:
        raise unused("lean", lean, "is of a ground")
    return Stand(recipe("read_stand", data, path, reading), seed)


def grow(spec: StandSpec, *, seed: int = 1, trust_paths: bool = False, budget: float = 1.0, **fields: Any) -> Stand:
    """Grows the stand of a spec (docs/forests.md): a TOML file, or a dict of its fields; ``fields`` replace some of them.

    The same spec and seed give the same trees as the command. Files that a spec names lie in its folder, or anywhere with
    ``trust_paths``. Raises SpecError, BudgetError.
    """
    base: "Dict[str, Any]" = {"preset": None, "toml": None, "trust_paths": flag("trust_paths", trust_paths)}
    own: "Dict[str, Any]" = {}
    if isinstance(spec, Mapping):
        own = table("spec", spec)
    elif isinstance(spec, SpecText):
        base["toml"] = (spec.toml, spec.file)
    else:
        path = path_of("spec", spec)
        if not path.endswith(".toml"):
            raise beyond("spec", repr(path), "a TOML file, or a dict of fields")
        base["toml"] = (_text(path), path)
    return Stand(recipe("grow_stand", base, asked_of(seed, budget, {**own, **fields}, {})), seed)


def tiles(forest: "Union[Stand, StandSpec, Inventory]", folder: "str | os.PathLike[str]", **how: Any) -> Tiles:
    """Writes tiles of a stand, of a spec (``.toml`` or dict) or of an inventory: see ``Stand.tiles``.

    ``seed`` and ``budget`` also apply to the stand.
    """
    shared = {name: how[name] for name in ("seed", "budget") if name in how}
    if isinstance(forest, Stand):
        stand = forest
    elif isinstance(forest, (Mapping, SpecText)) or (
        isinstance(forest, (str, os.PathLike)) and os.fspath(forest).endswith(".toml")
    ):
        stand = grow(forest, **shared)
    else:
        stand = read(forest, **shared)
    return stand.tiles(folder, **how)


def _is_toml(file: Any) -> bool:
    return isinstance(file, (str, os.PathLike)) and str(os.fspath(file)).endswith(".toml")


def _bytes(inventory: Any) -> "Tuple[bytes, str]":
    """Returns the bytes of an inventory, and the path to which file names are relative."""
    here = os.path.abspath("inventory.csv")
    if isinstance(inventory, (bytes, bytearray)):
        return bytes(inventory), here
    if isinstance(inventory, (str, os.PathLike)):
        path = path_of("inventory", inventory)
        with open(path, "rb") as file:
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise wrong(f"{path}: an inventory has at most 1 GiB", "inventory", path, "at most 1 GiB")
        return data, os.path.abspath(path)
    # A data frame of pandas or polars.
    if hasattr(inventory, "columns") and hasattr(inventory, "to_csv"):
        return inventory.to_csv(index=False).encode(), here
    if hasattr(inventory, "columns") and hasattr(inventory, "write_csv"):
        return inventory.write_csv().encode(), here
    raise TypeError(f"an inventory is a file, bytes or a data frame, not {inventory!r}")
