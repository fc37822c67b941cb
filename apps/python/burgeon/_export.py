"""Labels of a data set in the formats of other programs: COCO, YOLO, and pictures of numbers."""

from __future__ import annotations

import io
import json
import os
import random
import shutil
import tempfile
from typing import TYPE_CHECKING, Any, Dict, Iterator, Mapping, Sequence, Tuple

from . import labels
from ._given import beyond, flag, number, whole, wrong
from ._npz import npz
from ._outlines import regions
from ._png import png_of
from .camera import Camera
from .model import Masks
from .plant import PARTS

if TYPE_CHECKING:
    import numpy as np

KINDS = ("coco", "panoptic", "keypoints", "yolo", "depth", "normals", "albedo", "semantic", "instance", "cloud")
"""The kinds of labels."""
SPLITS = ("train", "val")
"""Folders of pictures: for training, and held out for validation."""


def export(
    out: "str | os.PathLike[str]",
    folder: "str | os.PathLike[str]",
    kinds: "Sequence[str]",
    *,
    segments: bool,
    held_out: float,
    least_pixels: int,
) -> "Dict[str, Any]":
    """Writes the folder: see ``burgeon.dataset.export``."""
    wanted = [kinds] if isinstance(kinds, str) else list(kinds)
    for kind in wanted:
        if kind not in KINDS:
            raise beyond("kinds", repr(kind), f"some of {', '.join(KINDS)}")
    if not wanted:
        raise beyond("kinds", "none", f"some of {', '.join(KINDS)}")
    held_out, segments = number("held_out", held_out, 0, 0.9), flag("segments", segments)
    least_pixels = whole("least_pixels", least_pixels, 1, 1 << 26)
    out, folder = os.fspath(out), os.path.abspath(os.fspath(folder))
    if os.path.lexists(folder) and not (os.path.isdir(folder) and not os.listdir(folder)):
        raise ValueError(f"{folder} is there already; choose another folder or delete it")
    if os.path.dirname(folder) and not os.path.isdir(os.path.dirname(folder)):
        raise FileNotFoundError(f"{os.path.dirname(folder)} is no folder")
    recipe = _recipe(out, wanted)
    draft = tempfile.mkdtemp(prefix=f".{os.path.basename(folder)}-", suffix=".draft", dir=os.path.dirname(folder))
    try:
        written = _Folder(draft, wanted, segments, least_pixels).fill(out, recipe, held_out)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(draft, 0o777 & ~mask)
        if os.path.isdir(folder):
            os.rmdir(folder)
        os.rename(draft, folder)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        raise
    return written


def _recipe(out: str, kinds: "Sequence[str]") -> "Mapping[str, Any]":
    try:
        with open(os.path.join(out, "manifest.json"), encoding="utf-8") as file:
            recipe = json.load(file)["recipe"]
    except FileNotFoundError:
        line = f"{out} holds no data set that is whole: it has no manifest.json; generate it to its end"
        raise ValueError(line) from None
    needs_labels = [kind for kind in kinds if kind != "cloud"]
    for name, needed in (("labels", needs_labels), ("cloud", [kind for kind in kinds if kind == "cloud"])):
        if needed and name not in recipe["formats"]:
            line = f"{needed[0]} needs a data set with the format {name!r}, and this one has {', '.join(recipe['formats'])}"
            raise wrong(line, "kinds", needed[0], "what the data set has")
    return recipe


class _Rows:
    """A list of a JSON file that grows row by row: a data set's annotations need not fit into memory."""

    def __init__(self, folder: str) -> None:
        # Open until the folder is complete; the folder closes it.
        self.file = tempfile.TemporaryFile("w+", encoding="utf-8", dir=folder)  # noqa: SIM115
        self.count = 0

    def add(self, row: "Mapping[str, Any]") -> None:
        self.file.write((",\n" if self.count else "") + json.dumps(row))
        self.count += 1

    def pour(self, into: io.TextIOBase) -> None:
        self.file.seek(0)
        shutil.copyfileobj(self.file, into)


class _Folder:
    """A folder that is being written."""

    def __init__(self, root: str, kinds: "Sequence[str]", segments: bool, least_pixels: int) -> None:
        self.root, self.kinds, self.segments, self.least = root, set(kinds), segments, least_pixels
        tables = [kind for kind in ("coco", "keypoints", "panoptic") if kind in self.kinds]
        self.images = {split: _Rows(root) for split in SPLITS}
        self.rows = {(kind, split): _Rows(root) for kind in tables for split in SPLITS}
        self.pictures = self.clouds = 0

    def fill(self, out: str, recipe: "Mapping[str, Any]", held_out: float) -> "Dict[str, Any]":
        from .dataset import read

        try:
            for plant in read(out):
                share = random.Random(f"{plant['seed']}:held out").random()
                split = SPLITS[1] if share < held_out else SPLITS[0]
                if self.kinds - {"cloud"}:
                    for name, shot, image, albedo in shots(plant):
                        self.picture(split, name, shot, image)
                        if "albedo" in self.kinds:
                            if not albedo:
                                line = f"{out} was made by a Burgeon without albedo: generate it again, or leave 'albedo' out"
                                raise wrong(line, "kinds", "albedo", "what the data set has")
                            self.put("albedo", split, f"{name}.png", data=albedo)
                if "cloud" in self.kinds:
                    self.cloud(split, plant)
            self.finish(recipe)
        finally:
            for rows in (*self.images.values(), *self.rows.values()):
                rows.file.close()
        annotations = max((self.rows[key].count for key in self.rows if key[0] != "panoptic"), default=0)
        totals = {"pictures": self.pictures, "clouds": self.clouds}
        if annotations:
            both = [kind for kind in ("coco", "keypoints") if kind in self.kinds]
            totals["annotations"] = sum(self.rows[both[0], split].count for split in SPLITS)
        return totals

    def put(self, *path: str, data: bytes) -> None:
        place = os.path.join(self.root, *path)
        os.makedirs(os.path.dirname(place), exist_ok=True)
        with open(place, "wb") as file:
            file.write(data)

    def picture(self, split: str, name: str, shot: labels.Shot, image: bytes) -> None:
        import numpy as np

        self.pictures += 1
        self.put("images", split, f"{name}.png", data=image)
        self.images[split].add(labels.coco_image(shot, self.pictures, f"{name}.png"))
        for kind in ("coco", "keypoints"):
            rows = self.rows.get((kind, split))
            if rows is not None:
                own = labels.coco_annotations(shot, self.pictures, rows.count + 1, self.least, kind == "keypoints")
                for row in own:
                    rows.add(row)
        if "panoptic" in self.kinds:
            colours, row = labels.panoptic(shot, self.pictures, f"{name}.png", self.least)
            self.put("annotations", f"panoptic_{split}", f"{name}.png", data=png_of(colours))
            self.rows["panoptic", split].add(row)
        if "yolo" in self.kinds:
            lines = labels.yolo(shot, self.segments, self.least)
            self.put("labels", split, f"{name}.txt", data=lines.encode())
        if "depth" in self.kinds:
            self.put("depth", split, f"{name}.npy", data=_npy(shot.depth))
        masks: Any = shot.masks
        if "normals" in self.kinds:
            # In the frame of the camera: x right, y up, z towards it, -1 to 1 as 0 to 255; nothing is black.
            turn = shot.camera.pose[:3, :3] * [[1.0], [-1.0], [-1.0]]
            own = masks.normal.astype(np.float64) @ turn.T
            there = np.square(own).sum(axis=2, keepdims=True) > 0
            self.put(
                "normals", split, f"{name}.png", data=png_of(np.where(there, np.rint(127.5 * (own + 1)), 0).astype(np.uint8))
            )
        if "semantic" in self.kinds:
            self.put("semantic", split, f"{name}.png", data=png_of((masks.part + 1).astype(np.uint8)))
        if "instance" in self.kinds:
            numbers = masks.instance.astype(np.int64)
            self.put(
                "instance", split, f"{name}.png", data=png_of(np.stack([numbers >> (8 * k) & 0xFF for k in range(3)], axis=2))
            )

    def cloud(self, split: str, plant: "Mapping[str, Any]") -> None:
        """Writes points with their labels: ``semantic`` as in pictures, a row of ``burgeon.PARTS`` plus 1; ``instance`` as
        there."""
        import numpy as np

        self.clouds += 1
        cloud = plant["cloud"]
        columns = {name: cloud[name] for name in ("points", "normals", "instance")}
        columns["semantic"] = (cloud["part"].astype(np.int64) + 1).astype(np.uint8)
        self.put("clouds", split, f"{plant['key']}.npz", data=npz(columns))

    def finish(self, recipe: "Mapping[str, Any]") -> None:
        about = {"description": f"{recipe['n']} plants made by Burgeon {recipe['burgeon']}", "version": "1.0"}
        for (kind, split), rows in self.rows.items():
            if not self.images[split].count:
                continue
            stem = {"coco": "instances", "keypoints": "keypoints", "panoptic": "panoptic"}[kind]
            place = os.path.join(self.root, "annotations", f"{stem}_{split}.json")
            os.makedirs(os.path.dirname(place), exist_ok=True)
            with open(place, "w", encoding="utf-8") as file:
                file.write(f'{{"info": {json.dumps(about)},\n"licenses": [],\n')
                file.write(f'"categories": {json.dumps(labels.coco_categories(kind == "panoptic"))},\n"images": [\n')
                self.images[split].pour(file)
                file.write('],\n"annotations": [\n')
                rows.pour(file)
                file.write("]}\n")
        names = "".join(f"  {row}: {name}\n" for row, name in enumerate(PARTS))
        if "yolo" in self.kinds:
            lines = f"path: .\ntrain: images/train\nval: images/val\nnames:\n{names}"
            self.put("data.yaml", data=lines.encode())
        classes = "".join(f"{number_of_class},{name}\n" for name, number_of_class in (("nothing", 0), *labels.CATEGORIES.items()))
        self.put("classes.csv", data=f"number,name\n{classes}".encode())


def shots(plant: "Mapping[str, Any]") -> "Iterator[Tuple[str, labels.Shot, bytes, bytes]]":
    """Returns the pictures of a plant from a data set: their names, themselves without pixels, and the files of picture and
    albedo."""
    import numpy as np

    k = 0
    while f"view{k}.png" in plant:
        columns = plant[f"view{k}"]
        about = json.loads(plant[f"view{k}.json"])
        masks = Masks(*(columns[name] for name in Masks._fields))
        found = regions(columns["instance"])
        shot = labels.Shot(
            image=np.empty((0, 0, 4), np.uint8),
            albedo=np.empty((0, 0, 4), np.uint8),
            masks=masks,
            depth=columns["depth"],
            camera=Camera.of_dict(about["camera"]),
            instances=columns["instances"],
            area=found.area,
            box=found.box,
            part=columns["parts"],
            tree=columns["trees"],
            keypoints=columns["keypoints"],
        )
        yield f"{plant['key']}-{k}", shot, plant[f"view{k}.png"], plant.get(f"view{k}.albedo.png", b"")
        k += 1


def _npy(values: "np.ndarray") -> bytes:
    import numpy as np

    out = io.BytesIO()
    np.lib.format.write_array(out, np.ascontiguousarray(values), allow_pickle=False)
    return out.getvalue()
