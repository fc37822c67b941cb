"""Cameras by their place and intrinsics, in the convention of computer vision: x right, y down, z along the view."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Dict, Optional, Sequence, Tuple

from ._given import beyond, number, whole, wrong

if TYPE_CHECKING:
    import numpy as np

    from ._grove import Grove
    from .model import Model
    from .plant import Plant

__all__ = ["Camera"]

MOST_PIXELS = 8192
"""Most pixels along a side of a picture."""
FARTHEST_M = 1e6
"""Greatest distance of a camera from the origin."""
PLACES = 9
"""Decimals kept of results of angles, so that machines whose sines differ in the last bit give the same numbers."""
ROOM = 1.04
"""Distance of a camera around a plant, as a multiple of the least possible."""


class Camera:
    """A pinhole camera without distortion. A camera never changes.

    A point at (x, y, z) metres in the camera's frame appears at pixel (``fx * x / z + cx``, ``fy * y / z + cy``); (0, 0) is the
    upper left corner of the picture and (0.5, 0.5) the centre of its first pixel.

    >>> eye = Camera((640, 480), 800, position=(0, 1, 3), target=(0, 1, 0))
    >>> eye.project([[0, 1, 0], [0.3, 1, 0]]).tolist()
    [[320.0, 240.0, 3.0], [400.0, 240.0, 3.0]]
    """

    __slots__ = ("_down", "_forward", "_right", "cx", "cy", "fx", "fy", "height", "position", "width")

    width: int
    """Pixels across."""
    height: int
    """Pixels down."""
    fx: float
    """Focal length across, pixels."""
    fy: float
    """Focal length down, pixels."""
    cx: float
    """Principal point from the left edge, pixels."""
    cy: float
    """Principal point from the upper edge, pixels."""
    position: "Tuple[float, float, float]"
    """Position of the eye, metres, +y up."""

    def __init__(
        self,
        size: "Tuple[int, int] | int",
        focal: "Tuple[float, float] | float",
        principal: "Optional[Tuple[float, float]]" = None,
        *,
        position: "Sequence[float]",
        target: "Optional[Sequence[float]]" = None,
        up: "Sequence[float]" = (0.0, 1.0, 0.0),
        rotation: "Optional[Any]" = None,
    ) -> None:
        """Makes a camera. ``size``: pixels across and down, 1 to 8192; ``focal``: fx and fy in pixels, or one for both;
        ``principal``: cx and cy in pixels (the centre); ``position``: metres; ``target``: a point that the principal point shows,
        with ``up`` upwards; or ``rotation``: (3, 3), with rows for the camera's right, down and forward in the world.
        """
        sides = (size, size) if hasattr(size, "__index__") else size
        if isinstance(sides, (str, bytes)) or not hasattr(sides, "__len__") or len(sides) != 2:
            raise TypeError(f"size must be a whole number of pixels or two, 1 to {MOST_PIXELS}, not {size!r}")
        self.width, self.height = (whole("size", side, 1, MOST_PIXELS) for side in sides)
        lengths = focal if isinstance(focal, (tuple, list)) else (focal, focal)
        self.fx, self.fy = _numbers("focal", lengths, 2, 1e-3, 1e9, "pixels")
        middle = (0.5 * self.width, 0.5 * self.height)
        self.cx, self.cy = _numbers("principal", middle if principal is None else principal, 2, -1e9, 1e9, "pixels")
        x, y, z = _numbers("position", position, 3, -FARTHEST_M, FARTHEST_M, "m")
        self.position = (x, y, z)
        if (rotation is None) == (target is None):
            raise wrong("a camera needs a target or a rotation, not both", "target", target, "one of the two")
        if rotation is None:
            axes = _towards(self.position, _numbers("target", target, 3, -FARTHEST_M, FARTHEST_M, "m"), up)
        else:
            axes = _rows(rotation)
        self._right, self._down, self._forward = axes

    @classmethod
    def around(
        cls,
        what: "Plant | Grove | Model",
        azimuth: float = 31.5,
        elevation: float = 12.0,
        size: "Tuple[int, int] | int" = (640, 480),
        field_of_view: float = 40.0,
    ) -> "Camera":
        """Returns a camera that sees all of a plant, grove or model.

        ``azimuth``: degrees around it, 0 from the front (+z), 90 from the right (+x); ``elevation``: degrees above the horizon,
        -89 to 89; ``field_of_view``: degrees that the shorter side of the picture spans, 1 to 120.
        """
        import numpy as np

        azimuth = math.radians(number("azimuth", azimuth))
        elevation = math.radians(number("elevation", elevation, -89, 89, "deg"))
        half = math.radians(0.5 * number("field_of_view", field_of_view, 1, 120, "deg"))
        points = _seen(what)
        if not len(points):
            raise wrong("there is nothing to look at: the model has no surface", "what", "an empty model", "a plant")
        low, high = points.min(axis=0), points.max(axis=0)
        middle = [round(float(x), PLACES) for x in 0.5 * (low + high)]
        way = (math.sin(azimuth) * math.cos(elevation), math.sin(elevation), math.cos(azimuth) * math.cos(elevation))
        sides = (size, size) if hasattr(size, "__index__") else size
        width, height = (whole("size", side, 1, MOST_PIXELS) for side in sides)
        focal = round(0.5 * min(width, height) / math.tan(half), PLACES)
        right, down, forward = _towards(way, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
        x, y, z = (_along(points - middle, axis) for axis in (right, down, forward))
        # Far enough for each point to be within the picture, and in front of the camera.
        needed = np.maximum(np.abs(x) * (2 * focal / width), np.abs(y) * (2 * focal / height)) - z
        away = max(ROOM * float(needed.max()), ROOM * float(-z.min()), 1e-6)
        position = [round(m + away * w, PLACES) for m, w in zip(middle, way)]
        return cls(size, focal, position=position, target=middle)

    @property
    def size(self) -> "Tuple[int, int]":
        """Pixels across and down."""
        return self.width, self.height

    @property
    def matrix(self) -> "np.ndarray":
        """(3, 3) float64: the intrinsics K."""
        import numpy as np

        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    @property
    def pose(self) -> "np.ndarray":
        """(4, 4) float64: maps points of the world to the camera's frame (x right, y down, z forward)."""
        import numpy as np

        pose = np.eye(4)
        pose[:3, :3] = [self._right, self._down, self._forward]
        pose[:3, 3] = -pose[:3, :3] @ np.array(self.position)
        return pose

    def project(self, points: Any) -> "np.ndarray":
        """Projects points (n, 3) in metres; returns (n, 3) float64: pixels from the left and from the top, and metres along the
        view.

        Points that are not in front of the camera have no pixel: NaN.
        """
        import numpy as np

        away = np.asarray(points, np.float64).reshape(-1, 3) - np.array(self.position)
        x, y, z = (_along(away, axis) for axis in (self._right, self._down, self._forward))
        with np.errstate(divide="ignore", invalid="ignore"):
            column = np.where(z > 0, self.fx * x / z + self.cx, np.nan)
            row = np.where(z > 0, self.fy * y / z + self.cy, np.nan)
        return np.column_stack([column, row, z])

    def depth_along_view(self, distance: Any) -> "np.ndarray":
        """Converts distances from the eye (height, width), as in masks, to metres along the view, as depth cameras give."""
        import numpy as np

        x = (np.arange(self.width) + 0.5 - self.cx) / self.fx
        y = (np.arange(self.height) + 0.5 - self.cy) / self.fy
        longer = np.sqrt(1.0 + np.square(x)[None, :] + np.square(y)[:, None])
        return (np.asarray(distance, np.float64) / longer).astype(np.float32)

    def to_dict(self) -> "Dict[str, Any]":
        """Returns the camera for files: size, ``fx``, ``fy``, ``cx``, ``cy``, ``position`` and ``rotation`` (right, down,
        forward)."""
        intrinsics = {name: getattr(self, name) for name in ("width", "height", "fx", "fy", "cx", "cy")}
        rotation = [list(axis) for axis in (self._right, self._down, self._forward)]
        return {**intrinsics, "position": list(self.position), "rotation": rotation}

    @classmethod
    def of_dict(cls, given: "Dict[str, Any]") -> "Camera":
        """Returns the camera of a ``to_dict``."""
        size, focal = (given["width"], given["height"]), (given["fx"], given["fy"])
        principal = (given["cx"], given["cy"])
        return cls(size, focal, principal, position=given["position"], rotation=given["rotation"])

    def _eye(self) -> "Dict[str, Any]":
        """Returns the camera for the core."""
        return {
            "position": list(self.position),
            "right": list(self._right),
            "down": list(self._down),
            "focal": [self.fx, self.fy],
            "principal": [self.cx, self.cy],
        }

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Camera) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash((self.width, self.height, self.fx, self.position, self._right))

    def __repr__(self) -> str:
        x, y, z = self.position
        return f"<burgeon.Camera {self.width} x {self.height} at ({x:.3g}, {y:.3g}, {z:.3g}), focal length {self.fx:.4g} pixels>"


Axis = Tuple[float, float, float]


def _seen(what: Any) -> "np.ndarray":
    """Returns the corners (n, 3) of the subject of a camera; for a grove those of its plants, not of their ground."""
    import numpy as np

    model = getattr(what, "model", what)
    if getattr(what, "site", None) is None:
        return np.asarray(model.vertices, np.float64)
    plants = len(model.parts) - len(what._raw.site_labels())
    return np.concatenate([part.vertices for part in model.parts[:plants]]).astype(np.float64)


def _along(points: "np.ndarray", axis: Axis) -> "np.ndarray":
    # Not a product of matrices, because its last bits differ between machines.
    return points[:, 0] * axis[0] + points[:, 1] * axis[1] + points[:, 2] * axis[2]


def _numbers(name: str, given: Any, count: int, least: float, most: float, unit: str) -> "Tuple[float, ...]":
    if isinstance(given, (str, bytes)) or not hasattr(given, "__len__") or len(given) != count:
        raise beyond(name, repr(given), f"{count} numbers")
    return tuple(number(f"{name}[{k}]", value, least, most, unit) for k, value in enumerate(given))


def _unit(vector: "Sequence[float]") -> "Optional[Axis]":
    length = math.sqrt(sum(x * x for x in vector))
    if length < 1e-12:
        return None
    x, y, z = (c / length for c in vector)
    return x, y, z


def _cross(a: "Sequence[float]", b: "Sequence[float]") -> Axis:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _towards(position: "Sequence[float]", target: "Sequence[float]", up: "Sequence[float]") -> "Tuple[Axis, Axis, Axis]":
    forward = _unit([t - p for t, p in zip(target, position)])
    if forward is None:
        raise wrong("the camera stands on its target", "target", target, "another point than position")
    right = _unit(_cross(forward, _numbers("up", up, 3, -1e9, 1e9, "")))
    if right is None:
        raise wrong("up is along the view: give another direction, such as up=(0, 0, -1)", "up", up, "across the view")
    return right, _cross(forward, right), forward


def _rows(rotation: Any) -> "Tuple[Axis, Axis, Axis]":
    import numpy as np

    rows = np.asarray(rotation, np.float64)
    if rows.shape != (3, 3) or not np.allclose(rows @ rows.T, np.eye(3), atol=1e-7) or np.linalg.det(rows) < 0:
        bounds = "(3, 3), a rotation whose rows are right, down and forward"
        raise beyond("rotation", f"of shape {rows.shape}" if rows.shape != (3, 3) else "another matrix", bounds)
    right, down, forward = (tuple(row) for row in rows.tolist())
    return right, down, forward
