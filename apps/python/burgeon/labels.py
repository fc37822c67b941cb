"""Pictures with all labels for training: masks, boxes, outlines, points, depth, normals and albedo, organ by organ.

>>> import burgeon as bg
>>> rose = bg.bloom("rose", seed=2)
>>> eye = bg.Camera.around(rose, azimuth=20, elevation=30, size=64)
>>> shot = bg.labels.take(rose, eye, supersample=1)
>>> shot.masks.instance.shape, len(shot.instances) > 3
((64, 64), True)

An **instance** is an axis or an organ. Its number is the same in every picture and cloud of a plant or grove: in a plant, 1 and
more for the rows of ``plant.axes``, then for the rows of ``plant.organs``; in a grove the plants follow one another. A flower has
the same numbers on every day. 0 stands for all else: soil, stones, pots, nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Optional, Tuple

from ._given import number, wrong
from ._outlines import joined, mask_of, outlines, packed, regions, run_lengths, unpacked
from .camera import Camera
from .plant import PARTS, Plant

if TYPE_CHECKING:
    import numpy as np

    from ._grove import Grove
    from .model import Masks

__all__ = ["CATEGORIES", "KEYPOINTS", "Instances", "Shot", "decode", "encode", "instances", "take"]

KEYPOINTS = ("insertion", "tip")
"""Points of every instance: its origin on its bearer (for a branch, the branch point), and its end. The tip of an organ is its
vertex farthest from its insertion."""
HIDDEN, VISIBLE = 1, 2
"""Visibility of a point in the picture, in the numbers of COCO; 0 is a point outside the picture."""
GROUND = ("soil", "stone", "pot")
"""Parts that are not instances: COCO calls them stuff."""
CATEGORIES = {name: row + 1 for row, name in enumerate(PARTS)}
"""Numbers of categories in COCO files: a row of ``burgeon.PARTS``, from 1."""
MOST_SEGMENTS = 1 << 24
"""Largest number in a panoptic picture, which has three bytes for it."""
NEAR_RADII = 1.5
"""A point on the middle line of wood is visible if its surface is: up to this number of radii in front of it."""
NEAR_PIXELS = 2.0
"""And up to this number of pixels, as surfaces continue within a pixel."""


class Instances(NamedTuple):
    """The axes and organs of a plant or grove; row k is instance k + 1."""

    tree: "np.ndarray"
    """(n,) int32: row of ``grove.places``; 0 for a plant."""
    is_organ: "np.ndarray"
    """(n,) bool: whether it is an organ, else an axis."""
    row: "np.ndarray"
    """(n,) int32: row of the ``organs`` or ``axes`` of its plant."""
    part: "np.ndarray"
    """(n,) uint8: row of ``burgeon.PARTS``."""
    insertion: "np.ndarray"
    """(n, 3) float64: its insertion, metres."""
    tip: "np.ndarray"
    """(n, 3) float64: its end, metres."""
    reach: "np.ndarray"
    """(n, 2) float64: distance from the surface to either point, metres: the radius of the wood in which it lies."""


def instances(what: "Plant | Grove") -> Instances:
    """Returns all instances of a plant or grove, visible or not."""
    import numpy as np

    if isinstance(what, Plant):
        return _of_plant(what)
    own = [_of_plant(plant) for plant in what.plants]
    places = what.places
    stood = [
        _standing(own[row], tree, at, yaw, scale)
        for tree, (row, at, yaw, scale) in enumerate(
            zip(places["plant"].tolist(), places["position"], places["yaw_deg"].tolist(), places["scale"].tolist())
        )
    ]
    return Instances(*(np.concatenate(columns) for columns in zip(*stood)))


def _of_plant(plant: Plant) -> Instances:
    import numpy as np

    nodes, axes, organs = plant.nodes, plant.axes, plant.organs
    count = len(axes) + len(organs)
    first, last = axes.first.astype(np.int64), axes.end.astype(np.int64) - 1
    bearer = np.where(axes.bearer >= 0, axes.bearer, first)
    borne = np.maximum(organs.bearer, 0)
    at_organ = np.where(organs.bearer >= 0, nodes.radius[borne], 0.0) if len(nodes) else np.zeros(len(organs))
    reach = np.zeros((count, 2))
    reach[:, 0] = np.concatenate([nodes.radius[bearer], at_organ])
    reach[: len(axes), 1] = nodes.radius[last]
    return Instances(
        tree=np.zeros(count, np.int32),
        is_organ=np.arange(count) >= len(axes),
        row=np.concatenate([np.arange(len(axes)), np.arange(len(organs))]).astype(np.int32),
        part=np.concatenate([axes.part, organs.part]),
        insertion=np.concatenate([nodes.position[first], organs.position]),
        tip=np.concatenate([nodes.position[last], _tips(plant)]),
        reach=reach,
    )


def _tips(plant: Plant) -> "np.ndarray":
    """Returns for each organ its vertex farthest from its root; the root itself for an organ without a surface."""
    import numpy as np

    tips = np.array(plant.organs.position, np.float64).reshape(-1, 3)
    farthest = np.zeros(len(tips))
    for part, label in zip(plant.model.parts, plant.labels()):
        organ, corners = label[:, 2], part.faces
        own = organ >= 0
        if not own.any():
            continue
        which, vertex = np.repeat(organ[own], 3), corners[own].reshape(-1)
        place = part.vertices[vertex].astype(np.float64)
        away = np.square(place - plant.organs.position[which]).sum(axis=1)
        order = np.lexsort((-away, which))
        found, first = np.unique(which[order], return_index=True)
        best = order[first]
        farther = away[best] > farthest[found]
        tips[found[farther]] = place[best][farther]
        farthest[found[farther]] = away[best][farther]
    return tips


def _standing(own: Instances, tree: int, at: "np.ndarray", yaw: float, scale: float) -> Instances:
    import math

    import numpy as np

    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return own._replace(
        tree=np.full_like(own.tree, tree),
        insertion=own.insertion @ turn.T * scale + at,
        tip=own.tip @ turn.T * scale + at,
        reach=own.reach * scale,
    )


class Shot(NamedTuple):
    """A picture and its labels."""

    image: "np.ndarray"
    """(height, width, 4) uint8: sRGB and alpha, rows from the top."""
    masks: "Masks"
    """Labels of each pixel: see ``Plant.masks``."""
    depth: "np.ndarray"
    """(height, width) float32: metres along the view, as depth cameras give them; infinite for nothing."""
    albedo: "np.ndarray"
    """(height, width, 4) uint8: colour of the surfaces without light, sRGB, and as alpha the share of the pixel that they
    cover."""
    camera: Camera
    """The camera of the picture."""
    instances: "np.ndarray"
    """(n,) int64: the visible instances, ascending."""
    area: "np.ndarray"
    """(n,) int64: pixels of each."""
    box: "np.ndarray"
    """(n, 4) int64: left, top, width and height of each, pixels."""
    part: "np.ndarray"
    """(n,) uint8: row of ``burgeon.PARTS`` of each."""
    tree: "np.ndarray"
    """(n,) int32: plant of each."""
    keypoints: "np.ndarray"
    """(n, 2, 3) float64: insertion and tip of each instance: pixels from the left, from the top, and 2 if visible, 1 if hidden, 0
    if outside the picture (then all are 0)."""

    def runs(self) -> "Dict[int, np.ndarray]":
        """Returns the mask of each instance as run lengths: down the columns, outside first."""
        return run_lengths(self.masks.instance)

    def outlines(self) -> "Dict[int, List[np.ndarray]]":
        """Returns the rings of the mask of each instance along the edges of pixels: filling them gives exactly the mask."""
        return outlines(self.masks.instance)


def take(
    what: "Plant | Grove",
    camera: Camera,
    *,
    of: "Optional[Instances]" = None,
    **how: Any,
) -> Shot:
    """Takes a picture of a plant or grove by a camera, with its labels.

    ``of``: ``instances(what)``, for several pictures; ``how``: ``background``, ``shadow``, ``supersample``, ``sun``,
    ``sunshine``, ``skylight`` and ``seed`` of ``Plant.render``.
    """
    if not isinstance(camera, Camera):
        raise TypeError(f"camera must be a burgeon.Camera, not {camera!r}")
    image = what.render(camera=camera, **how)
    masks: Any = what.masks(camera=camera, **how)
    found = regions(masks.instance)
    known = instances(what) if of is None else of
    row = found.number - 1
    return Shot(
        image=image,
        masks=masks,
        depth=camera.depth_along_view(masks.depth),
        albedo=what.albedo(camera=camera, **how),
        camera=camera,
        instances=found.number,
        area=found.area,
        box=found.box,
        part=known.part[row],
        tree=known.tree[row],
        keypoints=_keypoints(known, row, camera, masks),
    )


def _keypoints(known: Instances, row: "np.ndarray", camera: Camera, masks: Any) -> "np.ndarray":
    import numpy as np

    points = np.zeros((len(row), len(KEYPOINTS), 3))
    for k, place in enumerate((known.insertion, known.tip)):
        column, line, away = camera.project(place[row]).T
        inside = (away > 0) & (column >= 0) & (column < camera.width) & (line >= 0) & (line < camera.height)
        x, y = (np.where(inside, np.floor(p), 0).astype(np.int64) for p in (np.nan_to_num(column), np.nan_to_num(line)))
        distance = np.sqrt(np.square(place[row] - np.array(camera.position)).sum(axis=1))
        slack = NEAR_RADII * known.reach[row, k] + NEAR_PIXELS * distance / min(camera.fx, camera.fy)
        is_free = (masks.depth[y, x] >= distance - slack) | (masks.instance[y, x] == row + 1)
        points[:, k, 0], points[:, k, 1] = np.where(inside, column, 0.0), np.where(inside, line, 0.0)
        points[:, k, 2] = np.where(inside, np.where(is_free, VISIBLE, HIDDEN), 0)
    return points


def encode(mask: Any) -> "Dict[str, Any]":
    """Encodes a boolean mask (height, width) as COCO's run lengths: ``size`` and ``counts``, in the form of
    ``pycocotools.mask``."""
    import numpy as np

    mask = np.asarray(mask)
    if mask.ndim != 2:
        raise wrong(f"a mask must be of shape (height, width), not {mask.shape}", "mask", mask.shape, "(height, width)")
    counts = run_lengths(mask.astype(bool).astype(np.int64)).get(1, np.array([mask.size]))
    return {"size": list(mask.shape), "counts": packed(counts)}


def decode(runs: "Mapping[str, Any]") -> "np.ndarray":
    """Decodes COCO's run lengths to a mask (height, width), bool."""
    height, width = runs["size"]
    counts = unpacked(runs["counts"])
    if (counts < 0).any() or counts.sum() != height * width:
        raise wrong("the run lengths are not those of a mask of this size", "counts", int(counts.sum()), str(height * width))
    return mask_of(counts, height, width)


def coco_image(shot: Shot, number_of_image: int, file_name: str) -> "Dict[str, Any]":
    """Returns the row of a picture in a COCO file, with its camera in addition to the fields of COCO."""
    size = {"width": shot.camera.width, "height": shot.camera.height}
    return {"id": number_of_image, "file_name": file_name, **size, "camera": shot.camera.to_dict()}


def coco_annotations(
    shot: Shot, number_of_image: int, first: int = 1, least_pixels: int = 1, keypoints: bool = True
) -> "List[Dict[str, Any]]":
    """Returns the rows of a picture's instances in a COCO file, from number ``first``: mask, area, box, keypoints, instance,
    tree."""
    runs = shot.runs()
    size = [shot.camera.height, shot.camera.width]
    rows: "List[Dict[str, Any]]" = []
    columns = (shot.instances, shot.area, shot.box, shot.part, shot.tree, shot.keypoints)
    for one, area, box, part, tree, points in zip(*(column.tolist() for column in columns)):
        if area < least_pixels:
            continue
        row = {
            "id": first + len(rows),
            "image_id": number_of_image,
            "category_id": part + 1,
            "segmentation": {"size": size, "counts": packed(runs[one])},
            "area": area,
            "bbox": box,
            "iscrowd": 0,
            "instance": one,
            "tree": tree,
        }
        if keypoints:
            flat = [value for x, y, seen in points for value in (round(x, 2), round(y, 2), int(seen))]
            row.update(keypoints=flat, num_keypoints=sum(seen > 0 for _, _, seen in points))
        rows.append(row)
    return rows


def coco_categories(panoptic: bool = False) -> "List[Dict[str, Any]]":
    """Returns all categories of a COCO file; those of panoptic ones mark the things, the others name the keypoints."""
    rows = []
    for name, number_of_category in CATEGORIES.items():
        thing = name not in GROUND
        row: "Dict[str, Any]" = {"id": number_of_category, "name": name, "supercategory": "plant" if thing else "ground"}
        if panoptic:
            row["isthing"] = int(thing)
        elif thing:
            row.update(keypoints=list(KEYPOINTS), skeleton=[[1, 2]])
        if panoptic or thing:
            rows.append(row)
    return rows


def panoptic(shot: Shot, number_of_image: int, file_name: str, least_pixels: int = 1) -> "Tuple[np.ndarray, Dict[str, Any]]":
    """Returns the panoptic picture (height, width, 3) uint8 of COCO, whose colours are numbers of segments, and its row.

    A segment has the number of its instance; each kind of ground is one segment, numbered after all instances. Instances of fewer
    pixels than ``least_pixels`` become 0, nothing.
    """
    import numpy as np

    masks: Any = shot.masks
    segments = np.array(masks.instance, np.int64)
    small = shot.instances[shot.area < least_pixels]
    segments[np.isin(segments, small)] = 0
    after = int(shot.instances.max(initial=0)) + 1
    parts = {}
    for name in GROUND:
        own = (masks.part == PARTS.index(name)) & (masks.instance == 0)
        if own.any():
            parts[after] = PARTS.index(name)
            segments[own] = after
            after += 1
    if after >= MOST_SEGMENTS:
        line = f"a panoptic picture has numbers up to {MOST_SEGMENTS - 1:,}, and there are {after:,} instances: use fewer plants"
        raise wrong(line, "instances", after, f"up to {MOST_SEGMENTS - 1}")
    parts.update(zip(shot.instances.tolist(), shot.part.tolist()))
    found = regions(segments)
    rows = [
        {"id": one, "category_id": parts[one] + 1, "area": area, "bbox": box, "iscrowd": 0}
        for one, area, box in zip(found.number.tolist(), found.area.tolist(), found.box.tolist())
    ]
    colours = np.stack([segments >> (8 * k) & 0xFF for k in range(3)], axis=2).astype(np.uint8)
    return colours, {"image_id": number_of_image, "file_name": file_name, "segments_info": rows}


def yolo(shot: Shot, segments: bool = False, least_pixels: int = 1) -> str:
    """Returns the lines of YOLO: a row of ``burgeon.PARTS``, then the box (centre, width, height) or, with ``segments``, the
    outline as one polygon, all as shares of the picture's width and height."""
    width, height = shot.camera.width, shot.camera.height
    rings = shot.outlines() if segments else {}
    lines = []
    for one, area, box, part in zip(shot.instances.tolist(), shot.area.tolist(), shot.box.tolist(), shot.part.tolist()):
        if area < least_pixels:
            continue
        if segments:
            shares = (joined(rings[one]) / (width, height)).reshape(-1).tolist()
        else:
            left, top, wide, high = box
            shares = [(left + wide / 2) / width, (top + high / 2) / height, wide / width, high / height]
        lines.append(" ".join([str(part), *(f"{share:.6f}" for share in shares)]))
    return "".join(line + "\n" for line in lines)


def drawn_over(shot: Shot, strength: float = 0.55) -> "np.ndarray":
    """Returns the picture (height, width, 3) uint8 with each instance in a colour of its own, without boxes, for viewing."""
    import numpy as np

    strength = number("strength", strength, 0, 1)
    ids = np.asarray(shot.masks.instance).astype(np.uint64)
    mixed = ids * np.uint64(0x9E3779B97F4A7C15)
    colours = np.stack([(mixed >> np.uint64(shift)) & np.uint64(0xFF) for shift in (20, 32, 44)], axis=2).astype(np.float64)
    image = shot.image[:, :, :3].astype(np.float64)
    share = np.where(ids[:, :, None] > 0, strength, 0.0)
    return np.rint(image * (1 - share) + colours * share).astype(np.uint8)
