"""Plants that stand together: groves, orchards, tiles of them for data sets."""

from __future__ import annotations

import hashlib
import os
import random
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Sequence, Tuple, Union

from . import _burgeon
from ._files import write_whole
from ._given import axes as check_axes
from ._given import beyond, holds, keys, number, table, whole, wrong
from .makers import SpecText, grow
from .model import Model, cloud_bytes, look, save_cloud, seen, shown
from .plant import Plant

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Unpack

    from .model import View

__all__ = ["Grove", "GroveCloud", "GroveMasks", "grove"]


class GroveCloud(NamedTuple):
    """Points on a grove as a scanner sees it; ``axis`` and ``organ`` are rows of the tables of each point's own plant."""

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
    """(n,) uint8: from which place of the scanner it was seen."""
    distance: "np.ndarray"
    """(n,) float32: metres from the scanner, without noise."""
    tree: "np.ndarray"
    """(n,) uint32: row of ``grove.places``."""

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes it: see ``Cloud.save``."""
        save_cloud(self._asdict(), path)

    def to_bytes(self, extension: str = "npz") -> bytes:
        """The file of a format: see ``Cloud.to_bytes``."""
        return cloud_bytes(self._asdict(), extension)


class GroveMasks(NamedTuple):
    """What each pixel of a picture of a grove shows; ``axis`` and ``organ`` are rows of the tables of the pixel's own plant."""

    part: "np.ndarray"
    """(height, width) int32: row of ``burgeon.PARTS``; -1 for nothing."""
    axis: "np.ndarray"
    """(height, width) int32: row of the plant's ``axes``; -1 for none."""
    organ: "np.ndarray"
    """(height, width) int32: row of the plant's ``organs``; -1 for none."""
    depth: "np.ndarray"
    """(height, width) float32: metres from the eye; infinite for nothing."""
    tree: "np.ndarray"
    """(height, width) int32: row of ``grove.places``; -1 for nothing."""


class Grove:
    """Plants and the places at which copies of them stand. Nothing changes it."""

    __slots__ = ("_known", "_raw", "places", "plants", "seed")

    plants: "List[Plant]"
    """The different plants."""
    places: "Dict[str, np.ndarray]"
    """Columns, a row a tree: ``position`` (n, 3) metres, ``yaw_deg``, ``scale``, ``plant`` (row of ``plants``)."""

    def __init__(self, plants: "Sequence[Plant]", places: "Mapping[str, Any]", seed: int = 1) -> None:
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
            # No texts, truths, times or complex numbers; rows of plants are whole.
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
        self._raw = _burgeon.RawGrove([plant._raw for plant in self.plants], stand)
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
        """Its fingerprint: of its plants, and of where they stand."""
        digest = hashlib.sha256("".join(plant.digest for plant in self.plants).encode())
        for column in self.places.values():
            digest.update(column.astype(column.dtype.newbyteorder("<")).tobytes())
        return digest.hexdigest()[:32]

    def measures(self) -> "Dict[str, Any]":
        """What is measured of the stand: ``trees``, ``height_m`` (of the highest), ``wood_volume_m3``, ``leaf_area_m2``, and
        of each tree ``tree``: a list of its plant's row, place and height."""
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
        """All meshes where they stand, as one model: a copy for each tree."""
        if "model" not in self._known:
            self._known["model"] = Model(self._raw.model(self.name))
        return self._known["model"]

    def cloud(
        self,
        points: int = 200_000,
        stations: int = 4,
        elevation: float = 5.0,
        noise: float = 0.0,
        seed: "int | None" = None,
    ) -> GroveCloud:
        """The grove as a scanner sees it from around it: trees hide one another. See ``Plant.cloud``."""
        return GroveCloud(**seen(self, points, stations, elevation, noise, seed))

    def render(self, size: "Tuple[int, int] | int" = (1024, 768), **how: "Unpack[View]") -> "np.ndarray":
        """A picture: see ``Model.render``."""
        return self.model.render(size, **how)

    def masks(self, size: "Tuple[int, int] | int" = (1024, 768), **how: "Unpack[View]") -> GroveMasks:
        """What each pixel of ``render(size, **how)`` shows in its middle: part, axis, organ, depth, and which tree."""
        import numpy as np

        of_plants = [plant.labels() for plant in self.plants]
        labels = [rows for own in of_plants for rows in own]
        start = np.cumsum([0] + [len(rows) for rows in labels])
        first = np.cumsum([0] + [len(own) for own in of_plants])
        # The model has the parts of each tree, tree by tree.
        plant = self.places["plant"].tolist()
        parts = np.concatenate([np.arange(first[p], first[p + 1]) for p in plant])
        tree = np.repeat(np.arange(len(plant), dtype=np.int32), [len(of_plants[p]) for p in plant])
        at, *columns = shown(self.model._raw, labels, start[parts], look(size, **how))
        part, axis, organ, depth = columns
        return GroveMasks(part, axis, organ, depth, np.where(at < 0, np.int32(-1), tree[np.maximum(at, 0)]))

    def _repr_png_(self) -> bytes:
        return self.model._repr_png_()

    def to_bytes(self, extension: str, unit: str = "m", up: "str | None" = None) -> bytes:
        """The file of a format of models; in ``glb`` copies share their meshes."""
        extension = extension.lower().lstrip(".")
        check_axes(extension, unit, up)
        if holds(extension, "instances"):
            return bytes(self._raw.files(self.name, extension, "model")[0][1])
        return self.model.to_bytes(extension, unit, up or "y")

    def save(self, path: "str | os.PathLike[str]", unit: str = "m", up: "str | None" = None) -> None:
        """Writes a model, whole or not at all; in ``.glb`` copies share their meshes."""
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
    """Trees all over a rectangle: each at least ``spacing`` metres from the others, turned by chance.

    ``species``: what ``grow`` takes, or a list of it, or species with their shares: ``{"oak": 3, "birch": 1}``; ``area``:
    metres along x and z, 0.1 to 1000, or one for both; ``kinds``: different trees of each species, 1 to 100, of which the
    others are copies; ``vary``: trees are up to this share smaller or larger, 0 to 0.9; ``fields``: of ``grow``, for all
    of them. The same seed gives the same grove.

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
        # Of all that Python draws, only `random()` of a seed in text is the same in every version.
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
    """Species, and how often each is chosen."""
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
