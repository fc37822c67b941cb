"""What a person would have drawn of a plant that stands before them: lines on a sheet."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Tuple

from . import _burgeon
from ._burgeon import PARTS
from ._files import write_whole
from ._given import wrong

if TYPE_CHECKING:
    import numpy as np

    from .plant import Plant

__all__ = ["Drawing", "Line"]

MOST_ORGANS = 60
"""Of a plant that shows more organs, nobody draws each."""
MOST_LIMBS = 12
"""Beside the trunk."""
THICK = 0.12
"""Of the radius of the foot of the trunk: thinner limbs are not drawn."""
BARE = 0.5
"""A limb is drawn of which more than this share is seen."""
LARGE = 0.0003
"""Of the picture: what is smaller is a detail that nobody draws."""
WIDE = 0.025
"""Of the plant's size: wood that is wider is drawn by its two edges."""
THIN = ("petiole", "stamen", "pistil", "thorn", "pedicel")
"""Organs that are drawn as a line along their middle."""
SEEN = 0.2
"""An organ of which less is seen than this share of its outline's area is behind others."""
SECTORS = 48
"""Directions in which the reach of a crown is looked for."""
SIZE = 768
"""Pixels across of the picture that says what is seen."""
AROUND = 0.9
"""A rim that reaches over this share of an organ, each way, goes around it."""
FINE = 0.002
"""Of the plant's size: lines are so true."""


class Line(NamedTuple):
    """A stroke of a drawing."""

    kind: str
    """``axis``, ``stalk`` (of organs that are thin), ``blade`` or ``crown``."""
    points: "np.ndarray"
    """(n, 2) float64: metres, x to the right, y upwards; the plant stands at the origin."""
    row: int
    """Of ``plant.axes`` or of ``plant.organs``; -1 for a crown."""


class Drawing(NamedTuple):
    """The lines of a drawing in the order in which they are drawn: wood and stems, then leaves and petals from behind."""

    name: str
    lines: "List[Line]"

    def to_svg(self) -> bytes:
        """The file; each line lies on the layer of its kind."""
        return _burgeon.drawing_svg(self.name, [(line.kind, line.points.tolist()) for line in self.lines])

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes ``.svg``, whole or not at all."""
        folder, name = os.path.split(os.fspath(path))
        if not name.lower().endswith(".svg"):
            raise wrong(f"drawings are written as .svg, not {name!r}", "path", name, "a name that ends with .svg")
        write_whole(folder, [(name, self.to_svg())])


def draw(plant: "Plant") -> Drawing:
    """A plant from the front, as a line drawing.

    Stems and branches are lines along their middle, thick wood is a line along both its edges. Organs that are seen are
    outlines; of a plant that shows many, trunk and those limbs that foliage does not hide are drawn, and around the foliage
    the outline of the crown.
    """
    import numpy as np

    masks = plant.masks(SIZE, view="front", supersample=1)
    organs, counts = np.unique(masks.organ[masks.organ >= 0], return_counts=True)
    axes, pixels = np.unique(masks.axis[(masks.axis >= 0) & (masks.organ < 0)], return_counts=True)
    wood = dict(zip(axes.tolist(), pixels.tolist()))
    large = counts >= LARGE * SIZE**2
    size = max(float(np.ptp(np.array(_bounds(plant)), axis=0).max()), 1e-9)
    if large.sum() <= MOST_ORGANS and 2 * counts[large].sum() >= counts.sum():
        seen = dict(zip(organs[large].tolist(), counts[large].tolist()))
        lines = _stems(plant, sorted(wood), size) + _organs(plant, seen, size)
    else:
        lines = [*_stems(plant, _limbs(plant, wood, size / SIZE), size), Line("crown", _crown(plant.organs.position), -1)]
    return Drawing(plant.name, lines)


def _stems(plant: "Plant", rows: "List[int]", size: float) -> "List[Line]":
    """Axes as lines from where they are borne to their tips; around those that are thick."""
    import numpy as np

    position, radius, axes, fine = plant.nodes.position, plant.nodes.radius, plant.axes, FINE * size
    lines = []
    for row in rows:
        nodes = list(range(int(axes.first[row]), int(axes.end[row])))
        if axes.bearer[row] >= 0:
            nodes.insert(0, int(axes.bearer[row]))
        points = position[nodes][:, :2]
        if len(points) > 1 and np.ptp(points, axis=0).max() > fine:
            wood = axes.part[row] == PARTS.index("branch")
            if wood and 2.0 * radius[nodes[len(nodes) // 4]] > WIDE * size:
                along = np.gradient(points, axis=0)
                along /= np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-12)[:, None]
                beside = np.column_stack([-along[:, 1], along[:, 0]]) * radius[nodes][:, None]
                points = np.concatenate([points + beside, (points - beside)[::-1]])
            lines.append(Line("axis", _fewer(points, fine), row))
    return lines


def _limbs(plant: "Plant", seen: "Dict[int, int]", pixel: float) -> "List[int]":
    """Trunks, and the longest of the thick limbs that foliage does not hide; ``seen``: pixels of each axis."""
    import numpy as np

    axes, radius, position = plant.axes, plant.nodes.radius, plant.nodes.position
    thick = THICK * max((radius[f] for f, o in zip(axes.first, axes.order) if o == 0), default=0.0)
    found = []
    for row in range(len(axes)):
        if axes.order[row] == 0:
            found.append((0, 0.0, row))
            continue
        nodes = slice(int(axes.first[row]), int(axes.end[row]))
        if axes.order[row] > 2 or radius[nodes.start] < thick:
            continue
        steps = np.diff(position[nodes], axis=0)
        length = np.sqrt((steps**2).sum(axis=1))
        whole = float((np.hypot(steps[:, 0], steps[:, 1]) * 2.0 * radius[nodes][1:]).sum())
        if seen.get(row, 0) * pixel**2 >= BARE * whole > 0.0:
            found.append((1, -float(length.sum()), row))
    found.sort()
    trunks = sum(not limb for limb, _, _ in found)
    return [row for _, _, row in found[: trunks + MOST_LIMBS]]


def _organs(plant: "Plant", seen: "Dict[int, int]", size: float) -> "List[Line]":
    """The organs that are seen, those behind first."""
    import numpy as np

    # Metres of a pixel: the picture holds the whole plant, and a little around it.
    pixel, part_of = size / SIZE, plant.organs.part
    thin = [PARTS.index(word) for word in THIN]
    found: "Dict[int, Tuple[float, Line]]" = {}
    for part, labels in zip(plant.model.parts, plant.labels()):
        rows = labels[:, 2]
        order = np.argsort(rows, kind="stable")
        starts = np.flatnonzero(np.diff(rows[order], prepend=-2))
        for start, end in zip(starts.tolist(), [*starts[1:].tolist(), len(order)]):
            row = int(rows[order[start]])
            if row not in seen:
                continue
            faces = part.faces[order[start:end]]
            points = part.vertices.astype(np.float64)
            depth = float(points[np.unique(faces), 2].mean())
            if part_of[row] in thin:
                # What is short and wide, such as the foot of a flower, is behind what it bears.
                middle = _middle(points[np.unique(faces), :2])
                if middle is not None:
                    found[row] = (depth, Line("stalk", middle, row))
                continue
            outline = _outline(points[:, :2], faces)
            if outline is None:
                continue
            area = abs(_area(outline))
            # An organ of two parts has the outline of the larger one.
            larger = row not in found or area > abs(_area(found[row][1].points))
            if larger and area > 0.0 and seen[row] * pixel**2 >= SEEN * area:
                found[row] = (depth, Line("blade", _fewer(outline, FINE * size), row))
    return [line for _, line in sorted(found.values(), key=lambda one: (one[0], one[1].row))]


def _middle(points: "np.ndarray") -> "Any":
    """A line through the middle of what is long and thin; None of what is not."""
    import numpy as np

    centre = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - centre, full_matrices=False)
    if len(sizes) < 2 or sizes[1] > 0.25 * sizes[0]:
        return None
    along = (points - centre) @ axes[0]
    steps = np.linspace(along.min(), along.max(), 7)
    bins = np.clip(np.searchsorted(steps, along, side="right") - 1, 0, 5)
    middles = [points[bins == k].mean(axis=0) for k in range(6) if (bins == k).any()]
    ends = [centre + axes[0] * along.min(), centre + axes[0] * along.max()]
    return np.array([ends[0], *middles[1:-1], ends[1]])


def _bounds(plant: "Plant") -> "Tuple[np.ndarray, np.ndarray]":
    import numpy as np

    boxes = [(p.vertices.min(axis=0), p.vertices.max(axis=0)) for p in plant.model.parts if len(p.vertices)]
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


def _outline(points: "np.ndarray", faces: "np.ndarray") -> "Any":
    """The longest loop of edges that one triangle has; of a body that its rim does not go around, the hull."""
    import numpy as np

    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64)
    # Vertices that lie at one place are one: a seam is no rim.
    used, where = np.unique(edges, return_inverse=True)
    _, same = np.unique(np.round(points[used], 9), axis=0, return_inverse=True)
    edges = same.reshape(-1)[where.reshape(-1)].reshape(-1, 2)
    place = np.zeros((int(edges.max()) + 1, 2))
    place[same.reshape(-1)] = points[used]
    edges = edges[edges[:, 0] != edges[:, 1]]
    _, back, counts = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    rim = edges[counts[back.reshape(-1)] == 1]
    after = {int(a): int(b) for a, b in rim}
    best: "List[int]" = []
    while after:
        start, loop = next(iter(after)), []
        at = start
        while at in after:
            loop.append(at)
            at = after.pop(at)
        if at == start and len(loop) > len(best):
            best = loop
    if len(best) >= 3:
        outline, own = place[[*best, best[0]]], points[used]
        # The open end of a tube is no outline of it.
        if (np.ptp(outline, axis=0) >= AROUND * np.ptp(own, axis=0)).all():
            return outline
    hull = _hull(points[used])
    return None if hull is None else np.concatenate([hull, hull[:1]])


def _hull(points: "np.ndarray") -> "Any":
    """The convex hull, counter-clockwise (Andrew 1979)."""
    import numpy as np

    rows = sorted(set(map(tuple, points.tolist())))
    if len(rows) < 3:
        return None

    def chain(rows: "List[Tuple[float, ...]]") -> "List[Tuple[float, ...]]":
        out: "List[Tuple[float, ...]]" = []
        for p in rows:
            while len(out) > 1 and _turn(out[-2], out[-1], p) <= 0.0:
                out.pop()
            out.append(p)
        return out[:-1]

    hull = chain(rows) + chain(rows[::-1])
    return np.array(hull) if len(hull) > 2 else None


def _turn(a: "Tuple[float, ...]", b: "Tuple[float, ...]", c: "Tuple[float, ...]") -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _area(loop: "np.ndarray") -> float:
    x, y = loop[:, 0], loop[:, 1]
    return float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum()) / 2.0


def _crown(points: "np.ndarray") -> "np.ndarray":
    """A closed line around foliage: how far it reaches in each direction from its middle, evened out."""
    import numpy as np

    flat = points[:, :2]
    middle = np.median(flat, axis=0)
    away = flat - middle
    sector = np.floor((np.arctan2(away[:, 1], away[:, 0]) + np.pi) / (2 * np.pi) * SECTORS).astype(int) % SECTORS
    reach = np.zeros(SECTORS)
    np.maximum.at(reach, sector, np.hypot(away[:, 0], away[:, 1]))
    empty = reach == 0.0
    if empty.any():
        there = np.flatnonzero(~empty)
        reach[empty] = np.interp(np.flatnonzero(empty), there, reach[there], period=SECTORS)
    reach = (np.roll(reach, 1) + 2.0 * reach + np.roll(reach, -1)) / 4.0
    angle = (np.arange(SECTORS) + 0.5) / SECTORS * 2 * np.pi - np.pi
    loop = middle + np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])
    return np.concatenate([loop, loop[:1]])


def _fewer(points: "np.ndarray", fine: float) -> "np.ndarray":
    """The points of a line that it needs to be true to ``fine`` (Douglas and Peucker 1973)."""
    import numpy as np

    keep = np.zeros(len(points), bool)
    keep[[0, -1]] = True
    # A closed line has no chord: it is cut where it is farthest from its start.
    spans = [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        if last - first < 2:
            continue
        inner, chord = points[first + 1 : last] - points[first], points[last] - points[first]
        length = float(np.hypot(*chord))
        if length < 1e-12:
            distance = np.hypot(inner[:, 0], inner[:, 1])
        else:
            distance = np.abs(inner[:, 0] * chord[1] - inner[:, 1] * chord[0]) / length
        worst = int(np.argmax(distance))
        if distance[worst] > fine:
            at = first + 1 + worst
            keep[at] = True
            spans += [(first, at), (at, last)]
    return points[keep]
