"""Data sets of plants: thousands of them in shards, on one process, several, or the machines of a Ray cluster.

>>> import burgeon as bg
>>> bg.dataset.generate("birch", 1000, "birches", formats=("cloud", "mtg"), vary={"age": (8, 30)})  # doctest: +SKIP

A data set is a folder: ``shard-00000.tar`` and so on (WebDataset: the files of a plant share a stem), a ``.json`` next to each,
``manifest.json`` with the SHA-256 of all, ``plants.csv`` with seed and digest of each plant, ``croissant.json`` for tools that
read data sets, ``datasheet.md`` for people. The same recipe gives the same bytes wherever it runs. An interrupted run can be
continued: only missing shards are made.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
import random
import sys
import tarfile
import time
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from ._datasheet import datasheet
from ._files import inside, write_whole
from ._given import STRUCTURES, beyond, flag, keys, number, table, whole, word, wrong
from ._workers import results

__all__ = ["FORMATS", "export", "generate", "plant_seed", "read", "verify"]

RECIPE = "burgeon.dataset/1"
CLOUD = ("points", "stations", "elevation", "noise", "seed", "beam", "pulse", "path")
"""Arguments of clouds."""
MAKERS = ("grow", "bloom", "leaf", "grove", "scene")
"""Makers of plants; a plant of ``grove`` is a tile of trees, one of ``scene`` a few plants on soil or in pots."""
FORMATS = ("glb", *STRUCTURES, "burgeon", "cloud", "laz", "drawing", "picture", "labels")
"""Meshes, structure, cylinders, project of the Studio, labelled cloud (``.cloud.npz``; ``.laz`` with laspy), line drawing
(``.svg``), picture with masks and depth (``.png``, ``.masks.npz``), pictures by calibrated cameras with all labels
(``.view0.png``, ``.view0.albedo.png``, ``.view0.npz``, ``.view0.json``; docs/datasets.md)."""


GROVES = ("glb", "cloud", "laz", "picture", "labels")
"""Formats for tiles of trees and for scenes; their clouds and masks also give the ``tree``."""


def plant_seed(seed: int, index: int) -> int:
    """Returns the seed of a plant of a data set: by its number, whichever shard, process or machine makes it."""
    return int.from_bytes(hashlib.sha256(f"{RECIPE}:{seed}:{index}".encode()).digest()[:8], "little")


def generate(
    spec: "str | Mapping[str, Any] | None",
    n: int,
    out: "str | os.PathLike[str]",
    *,
    maker: str = "grow",
    seed: int = 1,
    formats: "Sequence[str]" = ("glb",),
    fields: "Optional[Mapping[str, Any]]" = None,
    vary: "Optional[Mapping[str, Any]]" = None,
    cloud: "Optional[Mapping[str, Any]]" = None,
    picture: "Optional[Mapping[str, Any]]" = None,
    views: "Optional[Mapping[str, Any]]" = None,
    shard: int = 100,
    ray: bool = False,
    workers: "Optional[int]" = None,
    progress: bool = True,
) -> "Dict[str, Any]":
    """Makes ``n`` plants of different seeds; returns the manifest.

    ``spec``, ``maker``: arguments of ``burgeon.grow``, ``bloom``, ``leaf`` or ``grove`` (a preset, a TOML file, a dict);
    ``fields``: their keyword arguments, the same for all plants (``detail=0.3``, ``leaves={...}``); ``vary``: arguments that
    differ: ``{"age": (8, 30)}`` is uniform between the two (whole if both are), a list is a choice; ``cloud``: arguments of
    ``Plant.cloud``; ``picture``: those of ``Plant.render``; ``views``: settings of the pictures with labels (``dataset.VIEWS``);
    ``formats``: some of ``FORMATS``; ``shard``: plants of each file; ``workers``: number of processes (1: this one; default as
    many as the machine has cores); ``ray``: tasks of the Ray cluster that ``ray.init`` has joined, or of one on this machine. All
    its machines must see the folder ``out``.

    A killed worker is replaced. Ctrl-C, a full disk or an error leave only complete shards; the same call continues. Raises
    ValueError for a folder that holds another data set, and the errors of the maker.
    """
    recipe = _recipe(spec, n, maker, seed, formats, fields, vary, cloud, picture, views, shard)
    out = os.path.abspath(os.fspath(out))
    os.makedirs(out, exist_ok=True)
    _claim(out, recipe)
    missing = [k for k in range(_count(recipe)) if not _is_made(out, recipe, k)]
    bar = _Bar(_count(recipe), _count(recipe) - len(missing), progress)
    try:
        for _ in results(make_shard, (recipe, out), missing, workers=workers, ray=ray):
            bar.step()
    finally:
        bar.end()
    return _finish(out, recipe)


def read(out: "str | os.PathLike[str]") -> "Iterator[Dict[str, Any]]":
    """Yields the plants of a data set in their order: ``seed``, ``fields``, ``digest``, ``measures``, and the contents of its
    formats.

    Clouds and masks as dicts of arrays, all else as bytes.
    """
    import numpy as np

    with open(os.path.join(out, "manifest.json"), encoding="utf-8") as file:
        manifest = json.load(file)
    for entry in manifest["shards"]:
        with tarfile.open(inside(out, entry["file"])) as archive:
            plant: "Dict[str, Any]" = {}
            for member in archive:
                stem, _, kind = member.name.partition(".")
                if plant and plant["key"] != stem:
                    yield plant
                    plant = {}
                plant.setdefault("key", stem)
                handle = archive.extractfile(member)
                data = handle.read() if handle else b""
                if kind == "json":
                    plant.update(json.loads(data))
                elif kind.endswith("npz"):
                    with np.load(io.BytesIO(data)) as arrays:
                        plant[kind.split(".")[0]] = {name: arrays[name] for name in arrays.files}
                else:
                    plant[kind] = data
            if plant:
                yield plant


def verify(out: "str | os.PathLike[str]") -> None:
    """Reads every shard and compares its SHA-256 with the manifest's; raises ValueError with the names of those that differ."""
    with open(os.path.join(out, "manifest.json"), encoding="utf-8") as file:
        manifest = json.load(file)
    bad = [e["file"] for e in manifest["shards"] if _sha256_of(inside(out, e["file"])) != e["sha256"]]
    if bad:
        raise ValueError(f"{out}: not what the manifest says: {', '.join(bad)}; delete them and generate again")


def _recipe(
    spec: Any,
    n: int,
    maker: str,
    seed: int,
    formats: "Sequence[str]",
    fields: "Optional[Mapping[str, Any]]",
    vary: "Optional[Mapping[str, Any]]",
    cloud: "Optional[Mapping[str, Any]]",
    picture: "Optional[Mapping[str, Any]]",
    views: "Optional[Mapping[str, Any]]",
    shard: int,
) -> "Dict[str, Any]":
    """Returns all settings that determine the data set, checked: they go into the manifest."""
    from . import __version__

    n, shard, seed = whole("n", n, 1, 10**9), whole("shard", shard, 1, 10**6), whole("seed", seed, 0, 2**64 - 1)
    if not isinstance(maker, str) or maker not in MAKERS:
        raise beyond("maker", repr(maker), f"one of {', '.join(MAKERS)}")
    if isinstance(formats, str):
        formats = (formats,)
    if not isinstance(formats, (list, tuple)):
        raise TypeError(f"formats must be words, not {formats!r}")
    fields, vary = table("fields", fields), table("vary", vary)
    cloud, picture = table("cloud", cloud), table("picture", picture)
    keys("cloud", cloud, CLOUD)
    keys("picture", picture, ("size", "view", "azimuth", "elevation", "background", "shadow", "supersample", "seed"))
    known = GROVES if maker in ("grove", "scene") else FORMATS
    unknown = [f for f in formats if f not in known]
    if unknown or not formats:
        raise wrong(f"formats are {', '.join(known)}, not {unknown or 'none'}", "formats", unknown, ", ".join(known))
    if isinstance(spec, (str, os.PathLike)) and os.fspath(spec).endswith(".toml"):
        # The machines of a cluster need not have the file.
        spec = {"toml": _text(os.fspath(spec)), "file": os.path.basename(os.fspath(spec))}
    ranges = {}
    for name, range_ in vary.items():
        if not isinstance(range_, (tuple, list)):
            raise TypeError(f"vary: {name} must be (least, most) or a list of choices, not {range_!r}")
        range_ = list(range_) if isinstance(range_, tuple) else {"choice": list(range_)}
        if isinstance(range_, list) and (len(range_) != 2 or not range_[0] <= range_[1]):
            line = f"vary: {name} must be (least, most) or a list of choices, not {tuple(range_)}"
            raise wrong(line, f"vary.{name}", tuple(range_), "(least, most) or a list of choices")
        if isinstance(range_, dict) and not range_["choice"]:
            raise wrong(f"vary: {name} has no choices", f"vary.{name}", [], "a list of choices")
        ranges[name] = range_
    recipe = {
        "schema": RECIPE,
        "burgeon": __version__,
        "maker": maker,
        "spec": spec,
        "n": n,
        "seed": seed,
        "formats": sorted(set(formats), key=FORMATS.index),
        "fields": fields,
        "vary": ranges,
        "cloud": cloud,
        "picture": picture,
        "shard": shard,
    }
    if "labels" in formats:
        recipe["views"] = _views(views)
    elif views is not None:
        raise wrong("views are of the format labels, which is not asked for", "views", "given", "left out")
    # In the form that a file gives: tuples are lists.
    return json.loads(json.dumps(recipe, default=_plain))


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a {type(value).__name__} cannot be part of a recipe")


def _text(path: str) -> str:
    with open(path, encoding="utf-8") as file:
        return file.read()


def _count(recipe: "Mapping[str, Any]") -> int:
    return -(-recipe["n"] // recipe["shard"])


def _name(k: int) -> str:
    return f"shard-{k:05d}"


def _json(value: Any) -> bytes:
    return (json.dumps(value, indent=1, sort_keys=True) + "\n").encode()


def _claim(out: str, recipe: "Mapping[str, Any]") -> None:
    """Claims the folder for this data set. A recipe without any finished shard is replaced: it may have been wrong."""
    there = _claimed(out)
    if there == recipe:
        return
    if not any(name.endswith(".tar") for name in os.listdir(out)):
        write_whole(out, [("recipe.json", _json(recipe))])
        return
    if there is None:
        raise ValueError(f"{out} holds shards of something else; choose another folder")
    differ = [k for k in recipe if there.get(k) != recipe[k]]
    raise ValueError(f"{out} holds another data set ({', '.join(differ)} differ); choose another folder or delete it")


def _claimed(out: str) -> "Optional[Dict[str, Any]]":
    """Returns the recipe of the folder's data set."""
    try:
        with open(os.path.join(out, "recipe.json"), encoding="utf-8") as file:
            return json.load(file)
    except FileNotFoundError:
        return None


def _sha256_of(path: str) -> "Optional[str]":
    digest = hashlib.sha256()
    try:
        with open(path, "rb") as file:
            for block in iter(lambda: file.read(1 << 20), b""):
                digest.update(block)
    except FileNotFoundError:
        return None
    return digest.hexdigest()


def _is_made(out: str, recipe: "Mapping[str, Any]", k: int) -> bool:
    entry = _entry(out, k)
    return entry is not None and _sha256_of(inside(out, entry["file"])) == entry["sha256"]


def _entry(out: str, k: int) -> "Optional[Dict[str, Any]]":
    try:
        with open(os.path.join(out, f"{_name(k)}.json"), encoding="utf-8") as file:
            return json.load(file)
    except (FileNotFoundError, ValueError):
        return None


def make_shard(recipe: "Mapping[str, Any]", out: str, k: int) -> int:
    """Makes one shard and puts it in its place; the bytes do not depend on who makes it."""
    first = k * recipe["shard"]
    last = min(first + recipe["shard"], recipe["n"])
    tar, digests = io.BytesIO(), []
    with tarfile.open(fileobj=tar, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for index in range(first, last):
            digest, files = make_plant(recipe, index)
            digests.append(digest)
            for extension, data in files:
                member = tarfile.TarInfo(f"{index:08d}.{extension}")
                member.size, member.mode = len(data), 0o644
                archive.addfile(member, io.BytesIO(data))
    data = tar.getvalue()
    entry = {
        "file": f"{_name(k)}.tar",
        "first": first,
        "plants": last - first,
        "bytes": len(data),
        "sha256": hashlib.sha256(data).hexdigest(),
        "digests": digests,
    }
    # Another call may have taken the folder before it held a shard; data sets are not mixed.
    if _claimed(out) != recipe:
        raise ValueError(f"{out} was taken by another data set meanwhile; choose another folder")
    # The entry comes after its shard, because the first file of the list is renamed last.
    write_whole(out, [(f"{_name(k)}.json", _json(entry)), (f"{_name(k)}.tar", data)])
    return k


def make_plant(recipe: "Mapping[str, Any]", index: int) -> "Tuple[str, List[Tuple[str, bytes]]]":
    """Makes one plant of a recipe; returns its digest, and its files by their extensions."""
    import burgeon

    seed = plant_seed(recipe["seed"], index)
    drawn = {name: _drawn(range_, seed, name) for name, range_ in sorted(recipe["vary"].items())}
    fields = {**recipe["fields"], **drawn}
    make: "Callable[..., Any]" = _scene if recipe["maker"] == "scene" else getattr(burgeon, recipe["maker"])
    plant = make(_spec(recipe["spec"]), seed=seed, **fields)
    about = {"seed": seed, "index": index, "fields": drawn, "digest": plant.digest, "measures": plant.measures()}
    files = [("json", _json(about))]
    clouds = {"cloud": "cloud.npz", "laz": "laz"}
    cloud: Any = plant.cloud(**recipe["cloud"]) if any(kind in clouds for kind in recipe["formats"]) else None
    for kind in recipe["formats"]:
        if kind in clouds:
            files.append((clouds[kind], cloud.to_bytes(clouds[kind].split(".")[-1])))
        elif kind == "drawing":
            files.append(("svg", plant.drawing().to_svg()))
        elif kind == "labels":
            files += _labelled(plant, recipe["views"], seed)
        elif kind == "picture":
            from ._npz import npz

            how = dict(recipe["picture"])
            size = how.pop("size", (512, 512))
            size = tuple(size) if isinstance(size, list) else size
            files.append(("png", plant.model.to_png(size, **how)))
            files.append(("masks.npz", npz(plant.masks(size, **how)._asdict())))
        else:
            files.append(("qsm.csv" if kind == "qsm" else kind, plant.to_bytes(kind)))
    return plant.digest, files


VIEWS = {
    "count": 1,
    "size": [512, 512],
    "field_of_view": [35.0, 45.0],
    "elevation": [5.0, 45.0],
    "vary_light": True,
    "supersample": 2,
    "background": "sky",
    "shadow": True,
}
"""Defaults of the pictures with labels: number for each plant; pixels; degrees that the shorter side spans and degrees above the
horizon, each a number or (least, most); whether sun and sky differ from picture to picture; and arguments of ``Plant.render``.
The azimuth is random."""
LIGHT = {"azimuth": (0.0, 360.0), "elevation": (15.0, 75.0), "sunshine": (0.3, 1.2), "skylight": (0.7, 1.2)}
"""Direction of the sun (degrees) and brightness of sun and sky in pictures with different light: from overcast to clear."""
MOST_VIEWS = 64
"""Most pictures of one plant."""


def _views(given: "Optional[Mapping[str, Any]]") -> "Dict[str, Any]":
    """Returns the settings of pictures with labels, checked."""
    given = table("views", given)
    keys("views", given, VIEWS)
    views: "Dict[str, Any]" = {**VIEWS, **given}
    size = views["size"] if isinstance(views["size"], (tuple, list)) else (views["size"],) * 2
    if len(size) != 2:
        raise beyond("views.size", repr(views["size"]), "a whole number of pixels or two")
    bounds = {"field_of_view": (1.0, 120.0), "elevation": (-89.0, 89.0)}
    for name, (least, most) in bounds.items():
        range_ = views[name] if isinstance(views[name], (tuple, list)) else (views[name],) * 2
        if len(range_) != 2:
            raise beyond(f"views.{name}", repr(views[name]), "a number or (least, most)")
        views[name] = [number(f"views.{name}", value, least, most, "deg") for value in range_]
        if views[name][0] > views[name][1]:
            raise beyond(f"views.{name}", repr(views[name]), "(least, most)")
    return {
        **views,
        "count": whole("views.count", views["count"], 1, MOST_VIEWS),
        "size": [whole("views.size", side, 1, 8192) for side in size],
        "vary_light": flag("views.vary_light", views["vary_light"]),
        "supersample": whole("views.supersample", views["supersample"], 1, 6),
        "background": word("views.background", views["background"]),
        "shadow": flag("views.shadow", views["shadow"]),
    }


def _labelled(plant: Any, views: "Mapping[str, Any]", seed: int) -> "List[Tuple[str, bytes]]":
    """Returns pictures of a plant or grove with their labels, as files."""
    import numpy as np

    from . import _burgeon, labels
    from ._npz import npz
    from .camera import Camera

    known = labels.instances(plant)
    files = []
    for k in range(views["count"]):
        azimuth = 360.0 * random.Random(f"{seed}:view:{k}:azimuth").random()
        elevation, opening = (_between(views[name], f"{seed}:view:{k}:{name}") for name in ("elevation", "field_of_view"))
        camera = Camera.around(plant, azimuth, elevation, tuple(views["size"]), opening)
        how = {name: views[name] for name in ("supersample", "background", "shadow")}
        if views["vary_light"]:
            light = {name: _between(range_, f"{seed}:light:{k}:{name}") for name, range_ in LIGHT.items()}
            how.update(sun=(light["azimuth"], light["elevation"]), sunshine=light["sunshine"], skylight=light["skylight"])
        shot = labels.take(plant, camera, of=known, **how)
        masks: Any = shot.masks
        columns = {name: getattr(masks, name) for name in ("part", "axis", "organ", "tree", "instance") if hasattr(masks, name)}
        columns.update(depth=shot.depth, normal=masks.normal.astype(np.float16))
        seen = {"instances": shot.instances, "parts": shot.part, "trees": shot.tree, "keypoints": shot.keypoints}
        about = {"camera": camera.to_dict(), "keypoints": list(labels.KEYPOINTS), "light": how}
        stem = f"view{k}"
        for ending, pixels in (("png", shot.image), ("albedo.png", shot.albedo)):
            files.append((f"{stem}.{ending}", bytes(_burgeon.png(camera.width, camera.height, pixels.tobytes()))))
        files += [(f"{stem}.npz", npz({**columns, **seen})), (f"{stem}.json", _json(about))]
    return files


def _between(range_: "Sequence[float]", key: str) -> float:
    low, high = range_
    return low + random.Random(key).random() * (high - low)


def _scene(spec: Any, seed: int, kinds: int = 2, plant: "Optional[Mapping[str, Any]]" = None, **fields: Any) -> Any:
    """Makes a scene of a data set: ``kinds`` plants of a species, with fields ``plant`` of ``grow``, placed by
    ``burgeon.scene``."""
    import burgeon

    count = whole("kinds", kinds, 1, 100)
    plants = [burgeon.grow(spec, seed=plant_seed(seed, k), **table("plant", plant)) for k in range(count)]
    for name, range_ in (("count", fields.get("count")), ("spacing", fields.get("spacing")), ("pot", fields.get("pot"))):
        if isinstance(range_, list):
            fields[name] = tuple(range_)
    weeds = fields.pop("weeds", None)
    if weeds is not None:
        fields["weeds"] = [burgeon.grow(weed, seed=plant_seed(seed, count + k)) for k, weed in enumerate(weeds)]
    return burgeon.scene(plants, seed=seed, **fields)


def export(
    out: "str | os.PathLike[str]",
    folder: "str | os.PathLike[str]",
    kinds: "Sequence[str]" = ("coco", "panoptic", "keypoints", "yolo"),
    *,
    segments: bool = True,
    held_out: float = 0.2,
    least_pixels: int = 16,
) -> "Dict[str, Any]":
    """Writes the labels of a data set (format ``labels``) in the formats of other programs, into a new folder; returns counts.

    ``kinds``: ``coco`` (instances as run lengths), ``panoptic``, ``keypoints``, ``yolo`` (outlines as polygons, or boxes without
    ``segments``), ``depth``, ``normals``, ``albedo``, ``semantic``, ``instance``, ``cloud``; ``held_out``: the share of plants,
    0 to 0.9, of which all pictures go to ``val`` and not to ``train``; ``least_pixels``: smaller instances are left out. The
    folder is written completely or not at all.
    """
    from ._export import export as exported

    return exported(out, folder, kinds, segments=segments, held_out=held_out, least_pixels=least_pixels)


def _spec(spec: Any) -> Any:
    from .makers import SpecText

    return SpecText(**spec) if isinstance(spec, dict) and set(spec) == {"toml", "file"} else spec


def _drawn(range_: Any, seed: int, name: str) -> Any:
    # Of all random functions of Python, only `random()` with a text as seed is the same in every version.
    share = random.Random(f"{seed}:{name}").random()
    if isinstance(range_, dict):
        choices = range_["choice"]
        return choices[min(int(share * len(choices)), len(choices) - 1)]
    low, high = range_
    if isinstance(low, int) and isinstance(high, int):
        return low + min(int(share * (high - low + 1)), high - low)
    return low + share * (high - low)


def _finish(out: str, recipe: "Mapping[str, Any]") -> "Dict[str, Any]":
    entries = [_entry(out, k) for k in range(_count(recipe))]
    shards = [e for e in entries if e is not None]
    if len(shards) != len(entries):
        raise RuntimeError(f"{out}: shards are gone that were made a moment ago")
    whole = hashlib.sha256("".join(d for e in shards for d in e["digests"]).encode()).hexdigest()
    manifest = {"recipe": dict(recipe), "plants": recipe["n"], "digest": whole, "shards": shards}
    rows = _rows(recipe, shards)
    croissant = _json(_croissant(recipe, shards, rows))
    sheet = datasheet(recipe, shards)
    files = [("manifest.json", _json(manifest)), ("croissant.json", croissant), ("plants.csv", rows), ("datasheet.md", sheet)]
    write_whole(out, files)
    return manifest


def _croissant(recipe: "Mapping[str, Any]", shards: "Sequence[Mapping[str, Any]]", rows: bytes) -> "Dict[str, Any]":
    """Describes the data set in the vocabulary of Croissant 1.0 (MLCommons)."""
    spec = recipe["spec"] if isinstance(recipe["spec"], str) else "plants"
    files = [
        {
            "@type": "cr:FileObject",
            "@id": e["file"],
            "name": e["file"],
            "contentUrl": e["file"],
            "contentSize": f"{e['bytes']} B",
            "encodingFormat": "application/x-tar",
            "sha256": e["sha256"],
        }
        for e in shards
    ]
    table = {
        "@type": "cr:FileObject",
        "@id": "plants.csv",
        "name": "plants.csv",
        "contentUrl": "plants.csv",
        "contentSize": f"{len(rows)} B",
        "encodingFormat": "text/csv",
        "sha256": hashlib.sha256(rows).hexdigest(),
    }
    kinds = {"index": "sc:Integer", "file": "sc:Text", "seed": "sc:Text", "digest": "sc:Text", **_kinds(recipe)}
    return {
        "@context": {
            "@language": "en",
            "@vocab": "https://schema.org/",
            **{name: f"cr:{name}" for name in CROISSANT},
            "cr": "http://mlcommons.org/croissant/",
            "dct": "http://purl.org/dc/terms/",
            "sc": "https://schema.org/",
            "rai": "http://mlcommons.org/croissant/RAI/",
            "conformsTo": "dct:conformsTo",
            "data": {"@id": "cr:data", "@type": "@json"},
            "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
            "examples": {"@id": "cr:examples", "@type": "@json"},
        },
        "@type": "sc:Dataset",
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "name": f"burgeon-{spec}-{recipe['n']}",
        "description": f"{recipe['n']} plants ({spec}) made by Burgeon {recipe['burgeon']}; recipe.json says how.",
        "version": "1.0.0",
        "distribution": [*files, table],
        "recordSet": [
            {
                "@type": "cr:RecordSet",
                "@id": "plants",
                "name": "plants",
                "description": "What each plant was made from; its files are in the shard, their names begin with the index.",
                "field": [
                    {
                        "@type": "cr:Field",
                        "@id": f"plants/{name}",
                        "name": f"plants/{name}",
                        "dataType": kind,
                        "source": {"fileObject": {"@id": "plants.csv"}, "extract": {"column": name}},
                    }
                    for name, kind in kinds.items()
                ],
            }
        ],
    }


CROISSANT = (
    *("citeAs", "column", "equivalentProperty", "extract", "field", "fileObject", "fileProperty", "fileSet", "format"),
    *("includes", "isLiveDataset", "jsonPath", "key", "md5", "parentField", "path", "recordSet", "references", "regex"),
    *("repeated", "replace", "samplingRate", "separator", "source", "subField", "transform"),
)
"""Terms of Croissant 1.0 that need no prefix."""


def _kinds(recipe: "Mapping[str, Any]") -> "Dict[str, str]":
    """Returns the types of the arguments that differ from plant to plant; tables and lists are JSON."""
    kinds = {}
    for name, range_ in sorted(recipe["vary"].items()):
        values = range_["choice"] if isinstance(range_, dict) else range_
        found = {type(value) for value in values}
        whole_or_not = "sc:Float" if found == {int, float} else "sc:Text"
        one = {bool: "sc:Boolean", int: "sc:Integer", float: "sc:Float"}
        kinds[name] = one.get(found.pop(), "sc:Text") if len(found) == 1 else whole_or_not
    return kinds


def _rows(recipe: "Mapping[str, Any]", shards: "Sequence[Mapping[str, Any]]") -> bytes:
    """Returns a table of all plants, for choosing some of them, and for tools that read data sets."""
    import csv

    out = io.StringIO()
    table, kinds = csv.writer(out, lineterminator="\n"), _kinds(recipe)
    table.writerow(["index", "file", "seed", "digest", *kinds])
    for shard in shards:
        for k, digest in enumerate(shard["digests"]):
            seed = plant_seed(recipe["seed"], shard["first"] + k)
            drawn = [_drawn(recipe["vary"][name], seed, name) for name in kinds]
            drawn = [value if isinstance(value, str) else json.dumps(value, sort_keys=True) for value in drawn]
            table.writerow([shard["first"] + k, shard["file"], seed, digest, *drawn])
    return out.getvalue().encode()


class _Bar:
    """Shows the progress on the error output: by tqdm if that is installed, else as a line that is redrawn on a terminal, else
    (in files, in notebooks) as a line now and then."""

    def __init__(self, total: int, done: int, wanted: bool) -> None:
        self.total, self.done, self.wanted, self.bar = total, done, wanted, None
        self.on_terminal = sys.stderr.isatty()
        self.told_at = -EVERY_S
        if wanted:
            try:
                from tqdm.auto import tqdm
            except ImportError:
                self.show()
            else:
                self.bar = tqdm(total=total, initial=done, desc="shards", unit="shard", file=sys.stderr)

    def step(self) -> None:
        self.done += 1
        if self.bar is not None:
            self.bar.update()
        elif self.wanted:
            self.show()

    def show(self) -> None:
        if self.on_terminal:
            full = 30 * self.done // max(self.total, 1)
            line = f"\rshards [{'=' * full}{' ' * (30 - full)}] {self.done} of {self.total}"
            print(line, end="", file=sys.stderr, flush=True)
        elif self.done == self.total or time.monotonic() - self.told_at >= EVERY_S:
            self.told_at = time.monotonic()
            print(f"shards: {self.done} of {self.total}", file=sys.stderr, flush=True)

    def end(self) -> None:
        if self.bar is not None:
            self.bar.close()
        elif self.wanted and self.on_terminal:
            print(file=sys.stderr)


EVERY_S = 10.0
"""Seconds between two such lines."""
