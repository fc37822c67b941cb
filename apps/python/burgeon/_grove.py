"""Plants that stand together: groves, orchards, tiles of them for data sets."""

from __future__ import annotations

import hashlib
import json
import os
import random
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Union

from . import _burgeon
from ._files import write_whole
from ._given import axes as check_axes
from ._given import beyond, holds, keys, number, table, whole, wrong
from ._light import Light, lit
from .makers import SpecText, grow
from .model import USUAL_SIZE, Model, cloud_bytes, look, save_cloud, seen, shown
from .plant import Plant

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Unpack

    from ._light import Lighting
    from .model import Path, View

__all__ = ["Grove", "GroveCloud", "GroveMasks", "grove", "scene"]


class GroveCloud(NamedTuple):
    """Points on a grove as a scanner measures them; ``axis`` and ``organ`` are rows of the tables of each point's own plant."""

    points: "np.ndarray"
    """(n, 3) float64: metres, +y up."""
    normals: "np.ndarray"
    """(n, 3) float32: unit vectors, towards the scanner."""
    part: "np.ndarray"
    """(n,) uint8: row of ``burgeon.PARTS``."""
    axis: "np.ndarray"
    """(n,) int32: row of the plant's ``axes``."""
    organ: "np.ndarray"
    """(n,) int32: row of the plant's ``organs``; -1 on wood."""
    order: "np.ndarray"
    """(n,) int32: branching order of the axis, 0 for the trunk."""
    station: "np.ndarray"
    """(n,) uint8: place of the scanner from which it was measured; on a path, the row of the point where its leg begins."""
    distance: "np.ndarray"
    """(n,) float32: metres from the scanner, without noise."""
    share: "np.ndarray"
    """(n,) float32: share of the echo that comes from this axis or organ; below 1 where a beam met several things at once."""
    echo: "np.ndarray"
    """(n,) uint8: number of the echo among those of its beam, from 0."""
    echoes: "np.ndarray"
    """(n,) uint8: number of echoes of its beam."""
    time: "np.ndarray"
    """(n,) float64: share of the path that lay behind the scanner, 0 to 1; 0 for one that stands."""
    tree: "np.ndarray"
    """(n,) int32: row of ``grove.places``; -1 on the ground."""
    instance: "np.ndarray"
    """(n,) int32: the axis or organ by its number in the grove (``burgeon.labels``); 0 for none."""

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes it: see ``Cloud.save``."""
        save_cloud(self._asdict(), path)

    def to_bytes(self, extension: str = "npz") -> bytes:
        """Returns the file of a format: see ``Cloud.to_bytes``."""
        return cloud_bytes(self._asdict(), extension)


class GroveMasks(NamedTuple):
    """Labels of each pixel of a picture of a grove; ``axis`` and ``organ`` are rows of the tables of the pixel's own plant."""

    part: "np.ndarray"
    """(height, width) int32: row of ``burgeon.PARTS``; -1 for nothing."""
    axis: "np.ndarray"
    """(height, width) int32: row of the plant's ``axes``; -1 for none."""
    organ: "np.ndarray"
    """(height, width) int32: row of the plant's ``organs``; -1 for none."""
    depth: "np.ndarray"
    """(height, width) float32: metres from the eye; infinite for nothing."""
    normal: "np.ndarray"
    """(height, width, 3) float32: unit vectors of the surface, towards the eye; 0 for nothing."""
    tree: "np.ndarray"
    """(height, width) int32: row of ``grove.places``; -1 for nothing and for the ground."""
    instance: "np.ndarray"
    """(height, width) int32: the axis or organ by its number in the grove (``burgeon.labels``); 0 for none."""


class Grove:
    """Plants and the places of their copies. A grove never changes."""

    __slots__ = ("_known", "_raw", "places", "plants", "seed", "site")

    plants: "List[Plant]"
    """The different plants."""
    places: "Dict[str, np.ndarray]"
    """Columns, a row a tree: ``position`` (n, 3) metres, ``yaw_deg``, ``scale``, ``plant`` (row of ``plants``)."""

    site: "Optional[Dict[str, Any]]"
    """The ground, as requested; None for nothing."""

    def __init__(
        self,
        plants: "Sequence[Plant]",
        places: "Mapping[str, Any]",
        seed: int = 1,
        site: "Optional[Mapping[str, Any]]" = None,
    ) -> None:
        """Makes a grove. ``site``: the ground: ``soil`` (metres along x and z around the origin), ``relief`` (metres from its
        deepest hollow, at 0, to its highest clod, 0.02), ``stones`` (their number, 0), ``stone_size`` (radius of the largest,
        metres, 0.03), ``pots`` (rows of the centre of the soil in it, its radius and its height, metres) and ``seed``.
        """
        import numpy as np

        self.plants = list(plants)
        if not all(isinstance(plant, Plant) for plant in self.plants):
            raise TypeError("plants must be a list of plants")
        kinds = {"position": np.float64, "yaw_deg": np.float64, "scale": np.float64, "plant": np.int64}
        given = table("places", places)
        keys("places", given, kinds)
        columns = {}
        for name, kind in kinds.items():
            if name not in given:
                raise wrong(f"places has no {name!r}", f"places.{name}", "none", "a column")
            column = np.asarray(given[name])
            # No texts, truth values, times or complex numbers; rows of plants are whole.
            if column.dtype.kind not in ("iu" if name == "plant" else "iuf") and column.size:
                raise TypeError(f"places[{name!r}] must be {'whole ' if name == 'plant' else ''}numbers, not {column.dtype}")
            columns[name] = column.astype(kind)
        count = len(columns["plant"])
        for name, column in columns.items():
            shape = (count, 3) if name == "position" else (count,)
            if column.shape != shape:
                raise beyond(f"places[{name!r}]", column.shape, f"of shape {shape}")
            column.setflags(write=False)
        if (columns["plant"] < 0).any():
            line = "places['plant'] are rows of the plants, 0 and more"
            raise wrong(line, "places['plant']", int(columns["plant"].min()), "0 and more")
        self.places = columns
        self.seed = seed
        rows = zip(*(column.tolist() for column in columns.values()))
        stand = [(plant, at, yaw, scale) for at, yaw, scale, plant in rows]
        self.site = None if site is None else _site(site, seed)
        self._raw = _burgeon.RawGrove([plant._raw for plant in self.plants], stand, self.site)
        self._known: "Dict[str, Any]" = {}

    def __len__(self) -> int:
        return len(self.places["plant"])

    def __repr__(self) -> str:
        return f"<burgeon.Grove (seed {self.seed}): {len(self)} trees, {len(self.plants)} of them different>"

    @property
    def name(self) -> str:
        """Its name, for files."""
        return "grove"

    @property
    def digest(self) -> str:
        """Its fingerprint, from its plants and their places."""
        digest = hashlib.sha256("".join(plant.digest for plant in self.plants).encode())
        for column in self.places.values():
            digest.update(column.astype(column.dtype.newbyteorder("<")).tobytes())
        if self.site is not None:
            digest.update(json.dumps(self.site, sort_keys=True).encode())
        return digest.hexdigest()[:32]

    def measures(self) -> "Dict[str, Any]":
        """Measures of the stand: ``trees``, ``height_m`` (of the highest), ``wood_volume_m3``, ``leaf_area_m2``, and for each
        tree ``tree``: a list of its plant's row, place and height."""
        own = [plant.measures() for plant in self.plants]
        places = self.places
        trees, wood, leaves = [], 0.0, 0.0
        for row, at, scale in zip(places["plant"].tolist(), places["position"].tolist(), places["scale"].tolist()):
            measured = own[row]
            trees.append({"plant": row, "x_m": at[0], "z_m": at[2], "height_m": measured["height_m"] * scale})
            wood += (measured["wood_volume_m3"] or 0.0) * scale**3
            leaves += (measured["leaf_area_m2"] or 0.0) * scale**2
        return {
            "trees": len(trees),
            "height_m": max(tree["height_m"] for tree in trees),
            "wood_volume_m3": wood,
            "leaf_area_m2": leaves,
            "tree": trees,
        }

    @property
    def model(self) -> Model:
        """All meshes in their places, as one model: a copy for each tree."""
        if "model" not in self._known:
            self._known["model"] = Model(self._raw.model(self.name))
        return self._known["model"]

    def cloud(
        self,
        points: int = 200_000,
        stations: "Optional[int]" = None,
        elevation: "Optional[float]" = None,
        noise: float = 0.0,
        seed: "Optional[int]" = None,
        *,
        beam: float = 0.0,
        pulse: "Optional[float]" = None,
        path: "Optional[Path]" = None,
    ) -> GroveCloud:
        """Scans the grove from around it, or along a path: trees hide one another. See ``Plant.cloud``."""
        columns = seen(
            self,
            points=points,
            stations=stations,
            elevation=elevation,
            noise=noise,
            seed=seed,
            beam=beam,
            pulse=pulse,
            path=path,
        )
        return GroveCloud(**columns, instance=self._instance(columns["tree"], columns["axis"], columns["organ"]))

    def _instance(self, tree: "np.ndarray", axis: "np.ndarray", organ: "np.ndarray") -> "np.ndarray":
        """Returns numbers of instances (``burgeon.labels``) for rows of the tables of each one's own plant."""
        import numpy as np

        axes = np.array([len(plant.axes) for plant in self.plants])
        own = axes + [len(plant.organs) for plant in self.plants]
        row = self.places["plant"]
        first = np.cumsum([0, *own[row]])[:-1]
        if first[-1] + own[row[-1]] >= 1 << 31:
            line = "a grove has at most 2^31 axes and organs: use fewer or simpler plants"
            raise wrong(line, "places", len(row), "fewer rows")
        numbers = first[tree] + np.where(organ >= 0, organ + axes[row[tree]], axis) + 1
        return np.where((tree >= 0) & ((organ >= 0) | (axis >= 0)), numbers, 0).astype(np.int32)

    def light(self, **how: "Unpack[Lighting]") -> Light:
        """Computes the light that each axis and organ absorbs: plants shade one another, soil and pots cast no shade. See
        ``Plant.light``."""
        return lit(self._raw, **how)

    def render(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> "np.ndarray":
        """Renders a picture: see ``Model.render``."""
        return self.model.render(size, **how)

    def albedo(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> "np.ndarray":
        """Returns the colour of its surfaces without light: see ``Model.albedo``."""
        return self.model.albedo(size, **how)

    def masks(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> GroveMasks:
        """Returns the labels of each pixel of ``render(size, **how)`` at its centre: part, axis, organ, depth, and tree."""
        import numpy as np

        of_plants = [plant.labels() for plant in self.plants]
        labels = [rows for own in of_plants for rows in own]
        ground = zip(self._raw.site_labels(), self._raw.site_triangles())
        labels += [np.tile(np.array([[part, -1, -1]], np.int32), (count, 1)) for part, count in ground]
        start = np.cumsum([0] + [len(rows) for rows in labels])
        first = np.cumsum([0] + [len(own) for own in of_plants])
        # The model has the parts of each tree, tree by tree.
        plant = self.places["plant"].tolist()
        parts = np.concatenate([*(np.arange(first[p], first[p + 1]) for p in plant), np.arange(first[-1], len(labels))])
        trees = np.repeat(np.arange(len(plant), dtype=np.int32), [len(of_plants[p]) for p in plant])
        trees = np.concatenate([trees, np.full(len(labels) - first[-1], -1, np.int32)])
        at, *columns = shown(self.model._raw, labels, start[parts], look(size, **how))
        part, axis, organ, depth, normal = columns
        tree = np.where(at < 0, np.int32(-1), trees[np.maximum(at, 0)])
        return GroveMasks(part, axis, organ, depth, normal, tree, self._instance(tree, axis, organ))

    def _repr_png_(self) -> bytes:
        return self.model._repr_png_()

    def to_bytes(self, extension: str, unit: str = "m", up: "str | None" = None) -> bytes:
        """Returns the file of a format of models; in ``glb`` copies share their meshes."""
        extension = extension.lower().lstrip(".")
        check_axes(extension, unit, up)
        if holds(extension, "instances"):
            return bytes(self._raw.files(self.name, extension, "model")[0][1])
        return self.model.to_bytes(extension, unit, up or "y")

    def save(self, path: "str | os.PathLike[str]", unit: str = "m", up: "str | None" = None) -> None:
        """Writes a model, completely or not at all; in ``.glb`` copies share their meshes."""
        folder, name = os.path.split(os.fspath(path))
        stem, dotted = os.path.splitext(name)
        extension = dotted[1:].lower()
        if holds(extension, "instances"):
            check_axes(extension, unit, up)
            files = self._raw.files(self.name, extension, stem)
            write_whole(folder, [(name, files[0][1]), *files[1:]])
        else:
            self.model.save(path, unit, up or "y")


Species = Union[str, Mapping[str, Any], SpecText]


def grove(
    species: "Species | Sequence[Species] | Mapping[str, float]" = "oak",
    area: "Tuple[float, float] | float" = (20.0, 20.0),
    *,
    spacing: float = 5.0,
    seed: int = 1,
    kinds: int = 4,
    vary: float = 0.15,
    budget: float = 1.0,
    **fields: Any,
) -> Grove:
    """Places trees all over a rectangle: each at least ``spacing`` metres from the others, with a random rotation.

    ``species``: a species as for ``grow``, or a list of them, or species with their shares: ``{"oak": 3, "birch": 1}``; ``area``:
    metres along x and z, 0.1 to 1000, or one for both; ``kinds``: number of different trees of each species, 1 to 100, of which
    the others are copies; ``vary``: trees are up to this share smaller or larger, 0 to 0.9; ``fields``: those of ``grow``, for
    all of them. The same seed gives the same grove.

    Its trees grow alone. Trees that compete for space and light are one plant: ``grow("oak", roots=[...])``.
    """
    sides = area if isinstance(area, (tuple, list)) else (area, area)
    if len(sides) != 2:
        raise beyond("area", repr(area), "metres along x and z")
    area = (number("area[0]", sides[0], 0.1, 1000, "m"), number("area[1]", sides[1], 0.1, 1000, "m"))
    kinds = whole("kinds", kinds, 1, 100)
    seed = whole("seed", seed, 0, 2**64 - 1)
    spacing, vary = number("spacing", spacing, 0.05, 100, "m"), number("vary", vary, 0, 0.9)
    mixed = _shares(species)
    found = _burgeon.places(area, spacing, vary, seed)
    if not found:
        raise wrong(f"no tree has room: spacing is {spacing}, area {area}", "spacing", spacing, "less than area")
    total = sum(share for _, share in mixed)
    plants: "List[Plant]" = []
    rows: "Dict[Tuple[int, int], int]" = {}
    chosen = []
    for k in range(len(found)):
        # Of all random functions of Python, only `random()` with a text as seed is the same in every version.
        chance = random.Random(f"{seed}:{k}")
        left, which = chance.random() * total, 0
        while which + 1 < len(mixed) and left >= mixed[which][1]:
            left -= mixed[which][1]
            which += 1
        kind = min(int(chance.random() * kinds), kinds - 1)
        if (which, kind) not in rows:
            rows[which, kind] = len(plants)
            own = int.from_bytes(hashlib.sha256(f"burgeon.forest:{seed}:{which}:{kind}".encode()).digest()[:8], "little")
            plants.append(grow(mixed[which][0], seed=own, budget=budget, **fields))
        chosen.append(rows[which, kind])
    x, z, yaw, scale = zip(*found)
    places = {"position": list(zip(x, [0.0] * len(x), z)), "yaw_deg": yaw, "scale": scale, "plant": chosen}
    return Grove(plants, places, seed)


def _shares(species: Any) -> "List[Tuple[Species, float]]":
    """Returns species, and the share of each."""
    from . import presets

    trees = presets()[0]
    if isinstance(species, Mapping) and species and all(name in trees for name in species):
        mixed = list(species.items())
    elif isinstance(species, (list, tuple)) and not isinstance(species, SpecText):
        mixed = [(one, 1.0) for one in species]
    else:
        mixed = [(species, 1.0)]
    for name, share in mixed:
        if isinstance(share, bool) or not isinstance(share, (int, float)) or not 0 < share < 1e9:
            raise wrong(f"species: the share of {name!r} must be above 0, not {share!r}", f"species[{name!r}]", share, "above 0")
    if not mixed:
        raise wrong("species: give one", "species", species, "one or more")
    return mixed


def _site(site: "Mapping[str, Any]", seed: int) -> "Dict[str, Any]":
    """Returns the ground of plants for the core."""
    given = table("site", site)
    keys("site", given, ("soil", "relief", "stones", "stone_size", "pots", "seed"))
    if "soil" not in given:
        raise wrong("site has no 'soil': give its sides in metres along x and z", "site.soil", "none", "two lengths")
    soil = given["soil"] if isinstance(given["soil"], (tuple, list)) else (given["soil"],) * 2
    if len(soil) != 2:
        raise beyond("site.soil", repr(given["soil"]), "metres along x and z")
    pots = []
    for k, pot in enumerate(given.get("pots", ())):
        if not isinstance(pot, (tuple, list)) or len(pot) != 3 or not hasattr(pot[0], "__len__") or len(pot[0]) != 3:
            raise beyond(f"site.pots[{k}]", repr(pot), "the middle of its soil (x, y, z), its radius and its height")
        at = [number(f"site.pots[{k}][0]", x, -1e6, 1e6, "m") for x in pot[0]]
        pots.append(
            (at, number(f"site.pots[{k}][1]", pot[1], 0.005, 5, "m"), number(f"site.pots[{k}][2]", pot[2], 0.005, 5, "m"))
        )
    return {
        "soil": [number(f"site.soil[{k}]", side, 0.05, 1000, "m") for k, side in enumerate(soil)],
        "relief": number("site.relief", given.get("relief", 0.02), 0, 0.5, "m"),
        "stones": whole("site.stones", given.get("stones", 0), 0, 5000),
        "stone_size": number("site.stone_size", given.get("stone_size", 0.03), 0.001, 1, "m"),
        "pots": pots,
        "seed": whole("site.seed", given.get("seed", seed), 0, 2**64 - 1),
    }


LAYOUTS = ("rows", "pots", "plot")
"""Layouts of a scene."""
AROUND = 2.0
"""Margin of the soil around the plants, as a multiple of their spacing."""
FILLED = 0.9
"""Share of a pot's height that its soil fills, as in the core."""
JITTER = 0.12
"""Greatest distance of plants in rows from their places, as a share of their spacing."""


def scene(
    plants: "Plant | Sequence[Plant]",
    layout: str = "rows",
    count: "Tuple[int, int] | int" = (2, 3),
    spacing: "Tuple[float, float] | float" = (0.75, 0.25),
    *,
    seed: int = 1,
    vary: float = 0.1,
    jitter: float = JITTER,
    relief: float = 0.02,
    stones: int = 0,
    stone_size: float = 0.02,
    pot: "Tuple[float, float]" = (0.12, 0.2),
    weeds: "Sequence[Plant]" = (),
    weed_count: int = 0,
) -> Grove:
    """Places plants on soil: in rows of a field or orchard, in pots, or at random on a plot.

    ``plants``: those to choose from; ``count``: number of rows and of plants in each row, 1 to 200 each (``plot``: their
    product); ``spacing``: metres between rows and within a row, 0.01 to 100; ``vary``: plants are up to this share smaller or
    larger, 0 to 0.9; ``jitter``: greatest distance from their places, as a share of the spacing, 0 to 0.5; ``relief``,
    ``stones``, ``stone_size``: those of the soil, see ``Grove``; ``pot``: radius and height of pots, metres; ``weeds``: plants of
    which ``weed_count`` stand anywhere. The same seed gives the same scene.
    """
    chosen = [plants] if isinstance(plants, Plant) else list(plants)
    if not chosen:
        raise wrong("a scene needs a plant", "plants", "none", "one or more")
    if layout not in LAYOUTS:
        raise beyond("layout", repr(layout), f"one of {', '.join(LAYOUTS)}")
    rows, columns = (whole("count", n, 1, 200) for n in (count if isinstance(count, (tuple, list)) else (1, count)))
    apart = spacing if isinstance(spacing, (tuple, list)) else (spacing, spacing)
    between, within = (number("spacing", x, 0.01, 100, "m") for x in apart)
    relief = number("relief", relief, 0, 0.5, "m")
    seed, weed_count = whole("seed", seed, 0, 2**64 - 1), whole("weed_count", weed_count, 0, 2000)
    vary, jitter = number("vary", vary, 0, 0.9), number("jitter", jitter, 0, 0.5)
    if weed_count and not weeds:
        raise wrong("weed_count needs weeds: give plants for them", "weed_count", weed_count, "0")
    width, depth = columns * within, rows * between
    soil = (width + 2 * AROUND * max(within, between), depth + 2 * AROUND * max(within, between))
    radius, height = (number("pot", x, 0.005, 5, "m") for x in pot)
    stand: "List[Tuple[Tuple[float, float, float], float, float, int]]" = []
    for k in range(rows * columns):
        # Of all random functions of Python, only `random()` with a text as seed is the same in every version.
        chance = random.Random(f"{seed}:plant:{k}")
        place = ((k % columns + 0.5) * within - 0.5 * width, (k // columns + 0.5) * between - 0.5 * depth)
        if layout == "plot":
            place = ((chance.random() - 0.5) * width, (chance.random() - 0.5) * depth)
        elif layout == "rows":
            x, z = (p + (2 * chance.random() - 1) * jitter * s for p, s in zip(place, (within, between)))
            place = (x, z)
        level = 0.5 * relief + (FILLED * height if layout == "pots" else 0.0)
        stand.append(_stood(chance, place, level, vary, len(chosen)))
    pots = [(list(at), radius, height) for at, *_ in stand] if layout == "pots" else []
    for k in range(weed_count):
        chance = random.Random(f"{seed}:weed:{k}")
        place = ((chance.random() - 0.5) * soil[0], (chance.random() - 0.5) * soil[1])
        at, yaw, scale, row = _stood(chance, place, 0.5 * relief, vary, len(weeds))
        stand.append((at, yaw, scale, len(chosen) + row))
    names = ("position", "yaw_deg", "scale", "plant")
    places = {name: [row[k] for row in stand] for k, name in enumerate(names)}
    site = {"soil": soil, "relief": relief, "stones": stones, "stone_size": stone_size, "pots": pots}
    return Grove([*chosen, *weeds], places, seed, site)


def _stood(
    chance: random.Random, place: "Tuple[float, ...]", level: float, vary: float, kinds: int
) -> "Tuple[Tuple[float, float, float], float, float, int]":
    """Returns place, rotation, size and row of a plant of a scene."""
    row = min(int(chance.random() * kinds), kinds - 1)
    yaw, scale = 360.0 * chance.random(), 1.0 + vary * (2 * chance.random() - 1)
    return (place[0], level, place[1]), yaw, scale, row
