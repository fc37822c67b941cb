"""Regions of pictures as run lengths, boxes and outlines: all regions of a picture at once, to the pixel."""

from __future__ import annotations

from typing import TYPE_CHECKING, Dict, List, NamedTuple, Tuple

if TYPE_CHECKING:
    import numpy as np

MOST_GROUPS = 7
"""Most groups of five bits of a run length in a 32-bit picture."""


class Regions(NamedTuple):
    """Regions of a picture of numbers: one for each number above 0, in ascending order."""

    number: "np.ndarray"
    """(n,) int64."""
    area: "np.ndarray"
    """(n,) int64: pixels."""
    box: "np.ndarray"
    """(n, 4) int64: left, top, width, height, pixels."""


def regions(numbers: "np.ndarray") -> Regions:
    """Returns the regions of a picture (height, width) of whole numbers; 0 and less is none."""
    import numpy as np

    rows, columns = np.nonzero(numbers > 0)
    found, which = np.unique(numbers[rows, columns], return_inverse=True)
    which = which.reshape(-1)
    area = np.bincount(which, minlength=len(found))
    low, high = np.full((len(found), 2), 1 << 30), np.full((len(found), 2), -1)
    for k, places in enumerate((columns, rows)):
        np.minimum.at(low[:, k], which, places)
        np.maximum.at(high[:, k], which, places)
    box = np.concatenate([low, high - low + 1], axis=1) if len(found) else np.empty((0, 4), np.int64)
    return Regions(found.astype(np.int64), area.astype(np.int64), box.astype(np.int64))


def run_lengths(numbers: "np.ndarray") -> "Dict[int, np.ndarray]":
    """Returns the run lengths of each region in the form of COCO: down the columns, alternately outside and inside."""
    import numpy as np

    flat = np.ascontiguousarray(numbers.T).reshape(-1)
    if not len(flat):
        return {}
    start = np.concatenate([[0], np.flatnonzero(flat[1:] != flat[:-1]) + 1])
    end = np.concatenate([start[1:], [len(flat)]])
    inside = flat[start] > 0
    start, end, number = start[inside], end[inside], flat[start][inside]
    order = np.argsort(number, kind="stable")
    start, end, number = start[order], end[order], number[order]
    found, first = np.unique(number, return_index=True)
    out = {}
    for one, begin, stop in zip(found.tolist(), first.tolist(), [*first[1:].tolist(), len(number)]):
        places = np.stack([start[begin:stop], end[begin:stop]], axis=1).reshape(-1)
        counts = np.diff(np.concatenate([[0], places, [len(flat)]]))
        # A region that ends with the picture has nothing after it.
        out[one] = counts if counts[-1] else counts[:-1]
    return out


def packed(counts: "np.ndarray") -> str:
    """Encodes run lengths as the text of COCO: each as its difference from the last but one, five bits a letter."""
    import numpy as np

    left = np.array(counts, np.int64)
    left[3:] -= np.asarray(counts, np.int64)[1:-2]
    letters = np.zeros((len(left), MOST_GROUPS), np.uint8)
    used = np.zeros((len(left), MOST_GROUPS), bool)
    going = np.ones(len(left), bool)
    for k in range(MOST_GROUPS):
        used[:, k] = going
        group = left & 0x1F
        left = left >> 5
        more = going & np.where(group & 0x10, left != -1, left != 0)
        letters[:, k] = 48 + group + np.where(more, 0x20, 0)
        going = more
    return letters[used].tobytes().decode("ascii")


def unpacked(text: str) -> "np.ndarray":
    """Decodes the run lengths of ``packed``."""
    import numpy as np

    counts: "List[int]" = []
    value = shift = 0
    for letter in text.encode("ascii"):
        group = letter - 48
        value |= (group & 0x1F) << shift
        shift += 5
        if not group & 0x20:
            if group & 0x10:
                value -= 1 << shift
            counts.append(value + (counts[-2] if len(counts) > 2 else 0))
            value = shift = 0
    return np.array(counts, np.int64)


def mask_of(counts: "np.ndarray", height: int, width: int) -> "np.ndarray":
    """Returns the mask of run lengths, (height, width) bool."""
    import numpy as np

    inside = np.arange(len(counts)) % 2 == 1
    return np.repeat(inside, counts).reshape(width, height).T


STEP = ((1, 0), (0, 1), (-1, 0), (0, -1))
"""Right, down, left, up: columns and rows."""
TURNS = (1, 0, 3)
"""To the right, straight on, to the left: so that pixels that touch only at a corner are separate rings."""


def outlines(numbers: "np.ndarray") -> "Dict[int, List[np.ndarray]]":
    """Returns the rings (n, 2) of each region: corners (x, y) along the edges of pixels, x from the left, y from the top.

    Outer rings are clockwise in the picture, rings of holes counter-clockwise: filling them gives exactly the region.
    """
    import numpy as np

    height, width = numbers.shape
    framed = np.zeros((height + 2, width + 2), np.int64)
    framed[1:-1, 1:-1] = np.maximum(numbers, 0)
    own = framed[1:-1, 1:-1]
    beside = (framed[:-2, 1:-1], framed[1:-1, 2:], framed[2:, 1:-1], framed[1:-1, :-2])
    corner = ((0, 0), (1, 0), (1, 1), (0, 1))
    parts = []
    # Each side of a pixel at the edge of its region, clockwise around the pixel.
    for way, (there, (dx, dy)) in enumerate(zip(beside, corner)):
        rows, columns = np.nonzero((own > 0) & (there != own))
        place = (rows + dy) * (width + 1) + columns + dx
        parts.append(np.stack([own[rows, columns], place, np.full(len(rows), way)], axis=1))
    edges = np.concatenate(parts)
    if not len(edges):
        return {}
    count = (height + 1) * (width + 1)
    key = (edges[:, 0] * count + edges[:, 1]) * 4 + edges[:, 2]
    order = np.argsort(key, kind="stable")
    edges, key = edges[order], key[order]
    ahead = np.array([dy * (width + 1) + dx for dx, dy in STEP])
    end = edges[:, 1] + ahead[edges[:, 2]]
    following = np.full(len(edges), -1)
    for turn in TURNS:
        wanted = (edges[:, 0] * count + end) * 4 + (edges[:, 2] + turn) % 4
        row = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
        following = np.where((following < 0) & (key[row] == wanted), row, following)
    bent = np.empty(len(edges), bool)
    bent[following] = edges[:, 2] != edges[following, 2]
    return _rings(edges, following, bent, width)


def _rings(edges: "np.ndarray", following: "np.ndarray", bent: "np.ndarray", width: int) -> "Dict[int, List[np.ndarray]]":
    import numpy as np

    ahead, is_corner, place = following.tolist(), bent.tolist(), edges[:, 1].tolist()
    seen = bytearray(len(ahead))
    out: "Dict[int, List[np.ndarray]]" = {}
    for first in range(len(ahead)):
        if seen[first]:
            continue
        ring, at = [], first
        while not seen[at]:
            seen[at] = 1
            if is_corner[at]:
                ring.append(place[at])
            at = ahead[at]
        corners = np.array(ring, np.int64)
        points = np.stack([corners % (width + 1), corners // (width + 1)], axis=1)
        out.setdefault(int(edges[first, 0]), []).append(points)
    return out


def joined(rings: "List[np.ndarray]") -> "np.ndarray":
    """Joins several rings to one (n, 2), for formats with a single polygon: bridges there and back join the others to the
    longest."""
    import numpy as np

    longest = max(range(len(rings)), key=lambda k: len(rings[k]))
    main = rings[longest]
    bridges: "List[Tuple[int, int, np.ndarray]]" = []
    for k, ring in enumerate(rings):
        if k != longest:
            away = np.square(main[:, None, :] - ring[None, :, :]).sum(axis=2)
            at, start = divmod(int(np.argmin(away)), away.shape[1])
            bridges.append((at, k, np.concatenate([ring[start:], ring[: start + 1]])))
    pieces, last = [], 0
    for at, _, ring in sorted(bridges, key=lambda bridge: bridge[:2]):
        pieces += [main[last : at + 1], ring, main[at : at + 1]]
        last = at + 1
    return np.concatenate([*pieces, main[last:]])
