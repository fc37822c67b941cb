"""Meshes, pictures and clouds."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

from . import _burgeon
from ._files import write_whole
from ._given import axes as check_axes
from ._given import beyond, flag, keys, number, unused, whole, word, wrong
from ._recipe import Recipe

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Literal, TypedDict, Unpack

    from .camera import Camera

    Path = Union[Sequence[Sequence[float]], np.ndarray]

    class View(TypedDict, total=False):
        """Settings of a picture."""

        view: Literal["front", "three-quarter", "side", "top", "turntable", "orbit"]
        azimuth: float
        elevation: float
        background: str
        shadow: bool
        supersample: int
        seed: int
        camera: Camera
        sun: Tuple[float, float]
        sunshine: float
        skylight: float


__all__ = ["Cloud", "Masks", "Model", "Part"]


def array(column: Any) -> "np.ndarray":
    """Returns the content of a column of the core, without a copy; read-only."""
    import numpy as np

    return np.asarray(column)


class Part:
    """One mesh of a model with one material. Its arrays use the memory of the core: no copy, read-only.

    An array keeps its memory alive; the plant and the model may go.
    """

    __slots__ = ("_raw", "_row", "material", "name")

    def __init__(self, raw: Any, row: int, name: str, material: "Dict[str, Any]") -> None:
        self._raw, self._row = raw, row
        self.name = name
        """Unique within the model, such as ``leaves``."""
        self.material = material
        """``name``, ``kind``, ``base_color`` (linear RGB), ``roughness``, ``translucency`` (share of light that passes),
        ``double_sided``, ``cut_out``; ``texture`` and the maps ``normal``, ``orm``, ``height``, ``through`` (``maps``)."""

    def _column(self, name: str) -> "np.ndarray":
        return array(self._raw.column(self._row, name))

    @property
    def vertices(self) -> "np.ndarray":
        """(n, 3) float32: metres, +y up."""
        return self._column("positions")

    @property
    def faces(self) -> "np.ndarray":
        """(m, 3) uint32: rows of ``vertices``, counter-clockwise from outside."""
        return self._column("triangles")

    @property
    def normals(self) -> "np.ndarray":
        """(n, 3) float32: unit vectors."""
        return self._column("normals")

    @property
    def uvs(self) -> "np.ndarray":
        """(n, 2) float32: texture coordinates, v down as in glTF; without rows if the part has none."""
        return self._column("uvs")

    @property
    def colors(self) -> "np.ndarray":
        """(n, 3) float32: linear RGB, multiplied with the material's colour; without rows if the part has none."""
        return self._column("colors")

    @property
    def wind(self) -> "np.ndarray":
        """(n, 4) float32, 0 to 1: sway of the plant, of the limb, flutter, phase; without rows unless ``wind=True``."""
        return self._column("wind")

    @property
    def pivots(self) -> "np.ndarray":
        """(n, 3) float32, metres: the points about which vertices rotate in the wind; without rows unless ``wind=True``."""
        return self._column("pivots")

    @property
    def texture(self) -> "Optional[np.ndarray]":
        """(height, width, 4) uint8: sRGB and alpha, rows from the top; None without one."""
        column = self.material["texture"]
        return None if column is None else array(column)

    @property
    def maps(self) -> "Dict[str, np.ndarray]":
        """The textures in addition to the colour, (height, width, 4) uint8 as in glTF: ``normal``, ``orm`` (occlusion,
        roughness), ``height``, ``through`` (in alpha, multiplied with the translucency)."""
        names = ("normal", "orm", "height", "through")
        return {name: array(self.material[name]) for name in names if self.material[name] is not None}

    def __repr__(self) -> str:
        return f"<burgeon.Part {self.name!r}: {len(self.vertices):,} vertices, {len(self.faces):,} triangles>"


class Masks(NamedTuple):
    """Labels of each pixel of a picture."""

    part: "np.ndarray"
    """(height, width) int32: row of ``burgeon.PARTS``; -1 for nothing."""
    axis: "np.ndarray"
    """(height, width) int32: row of ``plant.axes``; -1 for none."""
    organ: "np.ndarray"
    """(height, width) int32: row of ``plant.organs``; -1 for none."""
    depth: "np.ndarray"
    """(height, width) float32: metres from the eye; infinite for nothing."""
    normal: "np.ndarray"
    """(height, width, 3) float32: unit vectors of the surface, towards the eye, in the axes of the plant; 0 for nothing."""
    instance: "np.ndarray"
    """(height, width) int32: the axis or organ by its number (``burgeon.labels``); 0 for none."""


class Cloud(NamedTuple):
    """Points on a plant as a scanner measures them, with the labels of each."""

    points: "np.ndarray"
    """(n, 3) float64: metres, +y up."""
    normals: "np.ndarray"
    """(n, 3) float32: unit vectors, towards the scanner."""
    part: "np.ndarray"
    """(n,) uint8: row of ``burgeon.PARTS`` (``branch``, ``leaf``, ``petal``, ...)."""
    axis: "np.ndarray"
    """(n,) int32: row of ``plant.axes`` that the point lies on or that bears its organ; -1 for none."""
    organ: "np.ndarray"
    """(n,) int32: row of ``plant.organs``; -1 on wood."""
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
    instance: "np.ndarray"
    """(n,) int32: the axis or organ by its number, the same as in pictures (``burgeon.labels``); 0 for none."""

    def save(self, path: "str | os.PathLike[str]") -> None:
        """Writes all columns to a ``.npz`` file (NumPy), or points and labels to ``.las`` or ``.laz`` (laspy): completely or not
        at all."""
        save_cloud(self._asdict(), path)

    def to_bytes(self, extension: str = "npz") -> bytes:
        """Returns the file of a format, ``npz``, ``las`` or ``laz``: the same bytes for the same cloud."""
        return cloud_bytes(self._asdict(), extension)


def save_cloud(columns: "Dict[str, np.ndarray]", path: "str | os.PathLike[str]") -> None:
    """Writes the columns of a cloud, completely or not at all."""
    folder, name = os.path.split(os.fspath(path))
    write_whole(folder, [(name, cloud_bytes(columns, os.path.splitext(name)[1]))])


def cloud_bytes(columns: "Dict[str, np.ndarray]", extension: str) -> bytes:
    """Returns the file of a cloud in a format."""
    extension = extension.lower().lstrip(".")
    if extension == "npz":
        from ._npz import npz

        return npz(columns)
    if extension in ("las", "laz"):
        from ._las import las

        return las(columns, extension == "laz")
    line = f"clouds are written as .npz, .las or .laz, not .{extension}"
    raise wrong(line, "path", f".{extension}", ".npz, .las or .laz")


USUAL_SCAN = {"stations": 4, "elevation": 5.0, "pulse": 0.25}
"""What a scan takes where nothing is given and something else may make it needless."""


def seen(of: Any, **given: Any) -> "Dict[str, np.ndarray]":
    """Returns the columns of the cloud of a plant or of a forest; ``given``: the arguments of ``Plant.cloud``."""
    scan = {name: USUAL_SCAN.get(name) if value is None else value for name, value in given.items()}
    beam = number("beam", scan["beam"], 0, 50, "mrad")
    for name in ("stations", "elevation"):
        if scan["path"] is not None and given[name] is not None:
            raise unused(name, given[name], "is of a scanner that stands, and a path is given")
    if given["pulse"] is not None and not beam:
        raise unused("pulse", given["pulse"], "is of beams of a width: give beam, in milliradians")
    columns = of._raw.survey(
        {
            "points": whole("points", scan["points"], 1, 5_000_000),
            "stations": whole("stations", scan["stations"], 1, 64),
            "elevation": number("elevation", scan["elevation"], -80, 80, "deg"),
            "noise": number("noise", scan["noise"], 0, 1, "m"),
            "beam": beam,
            "pulse": number("pulse", scan["pulse"], 0, 5, "m"),
            "path": [] if scan["path"] is None else _path(scan["path"]),
            "seed": of.seed if scan["seed"] is None else whole("seed", scan["seed"], 0, 2**64 - 1),
        }
    )
    return {name: array(column) for name, column in columns.items()}


def _path(path: Any) -> "List[List[float]]":
    """Returns the points of a path: two to 256 rows of x, y and z."""

    def plain(value: Any) -> Any:
        return value.tolist() if hasattr(value, "tolist") else value

    rows = plain(path)
    rows = [plain(row) for row in rows] if isinstance(rows, (list, tuple)) else None
    if rows is None or not all(isinstance(row, (list, tuple)) and len(row) == 3 for row in rows):
        raise TypeError(f"path must be points (x, y, z), not {path!r}")
    if not 2 <= len(rows) <= MOST_LEGS + 1:
        raise beyond("path", f"{len(rows)} points", f"2 to {MOST_LEGS + 1} points")
    return [[number(f"path[{k}]", x, -1e5, 1e5, "m") for x in row] for k, row in enumerate(rows)]


MOST_LEGS = 255
"""Most legs of a path: their numbers are bytes."""


def shown(raw: Any, labels: "Sequence[np.ndarray]", start: "np.ndarray", how: "Look") -> "Tuple[np.ndarray, ...]":
    """Returns the labels of each pixel of a picture of a model: part of the model, then those of ``labels``, then depth and
    normal.

    ``labels``: tables (triangles, 3) one after another; ``start``: row of the first triangle of each part of the model.
    """
    import numpy as np

    parts, triangles, depth, normal = map(array, raw.masks(how))
    rows = np.concatenate([*labels, np.full((1, 3), -1, np.int32)])
    at = np.where(parts < 0, len(rows) - 1, start[np.maximum(parts, 0)] + triangles)
    part, axis, organ = np.moveaxis(rows[at], -1, 0)
    return parts, part, axis, organ, depth, normal


Look = Dict[str, Any]


USUAL_SIZE = (1024, 768)
"""Default pixels across and down."""
LOOKS = (
    *("view", "azimuth", "elevation", "background", "shadow", "supersample", "seed", "camera", "sun", "sunshine"),
    "skylight",
)
"""The settings of a picture."""


def look(size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> Look:
    """Returns the settings of a picture, checked."""
    keys("a picture", how, LOOKS)
    if "camera" in how:
        if size != USUAL_SIZE or "view" in how:
            line = "a camera has a size and a view of its own: leave these out"
            raise wrong(line, "camera", "given", "without size and view")
        size = how["camera"].size
    for angle in ("azimuth", "elevation"):
        if how.get("view") != "orbit" and angle in how:
            raise unused(angle, how[angle], "is of view='orbit', which is not asked for")  # type: ignore[literal-required]
    return _look(size, **how)


def _look(
    size: "Tuple[int, int] | int" = USUAL_SIZE,
    view: str = "three-quarter",
    azimuth: float = 31.5,
    elevation: float = 12.0,
    background: str = "sky",
    shadow: bool = True,
    supersample: int = 4,
    seed: int = 1,
    camera: "Optional[Camera]" = None,
    sun: "Optional[Tuple[float, float]]" = None,
    sunshine: float = 1.0,
    skylight: float = 1.0,
) -> Look:
    sides = (size, size) if hasattr(size, "__index__") else size
    if isinstance(sides, (str, bytes)) or not hasattr(sides, "__len__") or len(sides) != 2:
        raise TypeError(f"size must be a whole number of pixels or two, 1 to 8192, not {size!r}")
    return {
        "size": tuple(whole("size", side, 1, 8192) for side in sides),
        "view": word("view", view),
        "azimuth": number("azimuth", azimuth),
        "elevation": number("elevation", elevation, -85, 85, "deg"),
        "background": word("background", background),
        "shadow": flag("shadow", shadow),
        "supersample": whole("supersample", supersample, 1, 6),
        "seed": whole("seed", seed, 0, 2**64 - 1),
        "camera": None if camera is None else camera._eye(),
        "sun": None if sun is None else list(_towards_sun(sun)),
        "sunshine": number("sunshine", sunshine, 0, 4),
        "skylight": number("skylight", skylight, 0, 4),
    }


def _towards_sun(sun: "Tuple[float, float]") -> "Tuple[float, float, float]":
    """Returns the unit vector towards a sun of an azimuth (from north, -z, over east, +x) and an elevation, degrees."""
    if isinstance(sun, (str, bytes)) or not hasattr(sun, "__len__") or len(sun) != 2:
        raise TypeError(f"sun must be its azimuth and elevation in degrees, not {sun!r}")
    azimuth = math.radians(number("sun[0]", sun[0], -360, 360, "deg"))
    elevation = math.radians(number("sun[1]", sun[1], 1, 90, "deg"))
    level = math.cos(elevation)
    return level * math.sin(azimuth), math.sin(elevation), -level * math.cos(azimuth)


def _remade(recipe: Recipe) -> "Model":
    return Model(recipe.make(), recipe)


class Model:
    """Meshes and materials. A model never changes."""

    __slots__ = ("_digest", "_parts", "_raw", "_recipe")

    def __init__(self, raw: Any, recipe: "Optional[Recipe]" = None) -> None:
        self._raw = raw
        self._recipe = recipe
        self._digest: "Optional[str]" = None
        self._parts: "Optional[List[Part]]" = None

    def __reduce__(self) -> "Tuple[Any, ...]":
        """Pickles the request for its plant, which is made again on reading."""
        if self._recipe is None:
            raise TypeError("the model of a forest cannot be pickled: save it, or pickle its plants")
        return _remade, (self._recipe,)

    def __copy__(self) -> "Model":
        return self

    def __deepcopy__(self, memo: Any) -> "Model":
        return self

    def __eq__(self, other: object) -> bool:
        """Compares name, meshes and materials."""
        if not isinstance(other, Model):
            return NotImplemented
        return self is other or (self.name == other.name and self.digest == other.digest)

    def __hash__(self) -> int:
        return hash((self.name, self.digest))

    @property
    def name(self) -> str:
        """Name of the plant."""
        return self._raw.name

    @property
    def parts(self) -> "List[Part]":
        """One mesh for each kind of surface: branches, leaves, petals and so on."""
        if self._parts is None:
            materials = self._raw.materials()
            rows = enumerate(self._raw.parts())
            self._parts = [Part(self._raw, k, name, materials[m]) for k, (name, m, _, _) in rows]
        return self._parts

    @property
    def triangle_count(self) -> int:
        """Triangles of all parts."""
        return sum(part[3] for part in self._raw.parts())

    @property
    def digest(self) -> str:
        """Fingerprint of meshes and materials: the same on every machine."""
        if self._digest is None:
            self._digest = self._raw.digest()
        return self._digest

    def _joined(self, name: str, width: int, missing: float) -> "np.ndarray":
        import numpy as np

        columns = [getattr(p, name) for p in self.parts]
        if len(columns) == 1 and len(columns[0]) == len(self.parts[0].vertices):
            return columns[0]
        rows = [
            c if len(c) == len(p.vertices) else np.full((len(p.vertices), width), missing, np.float32)
            for c, p in zip(columns, self.parts)
        ]
        return np.concatenate(rows) if rows else np.empty((0, width), np.float32)

    @property
    def vertices(self) -> "np.ndarray":
        """(n, 3) float32, metres, of all parts: joined, which copies if there are several (``parts`` do not)."""
        return self._joined("vertices", 3, 0.0)

    @property
    def normals(self) -> "np.ndarray":
        """(n, 3) float32 of all parts."""
        return self._joined("normals", 3, 0.0)

    @property
    def uvs(self) -> "np.ndarray":
        """(n, 2) float32 of all parts; 0 for parts without any."""
        return self._joined("uvs", 2, 0.0)

    @property
    def colors(self) -> "np.ndarray":
        """(n, 3) float32 of all parts, linear RGB with the materials' colours, but without textures."""
        import numpy as np

        own = self._joined("colors", 3, 1.0)
        if not self.parts:
            return own
        base = [np.broadcast_to(np.float32(p.material["base_color"]), p.vertices.shape) for p in self.parts]
        return own * np.concatenate(base)

    @property
    def faces(self) -> "np.ndarray":
        """(m, 3) uint32 of all parts: rows of ``vertices``."""
        import numpy as np

        if len(self.parts) == 1:
            return self.parts[0].faces
        faces, first = [np.empty((0, 3), np.uint32)], 0
        for part in self.parts:
            faces.append(part.faces + np.uint32(first))
            first += len(part.vertices)
        return np.concatenate(faces)

    def to_trimesh(self) -> Any:
        """Returns a ``trimesh.Scene`` with one geometry for each part, with its texture.

        Needs ``pip install trimesh`` (and Pillow for textures).
        """
        try:
            import trimesh
        except ImportError as error:
            raise ImportError("to_trimesh() needs trimesh: pip install trimesh pillow") from error
        import numpy as np

        scene = trimesh.Scene()
        for part in self.parts:
            material = part.material
            color = np.concatenate([_srgb(np.array(material["base_color"], np.float32)), [1.0]])
            visual: Any = None
            if part.texture is not None and len(part.uvs):
                from PIL import Image

                uvs = np.array(part.uvs)
                uvs[:, 1] = 1.0 - uvs[:, 1]
                look = trimesh.visual.material.PBRMaterial(
                    name=material["name"],
                    baseColorFactor=np.uint8(255 * color),
                    baseColorTexture=Image.fromarray(np.array(part.texture)),
                    roughnessFactor=float(material["roughness"]),
                    metallicFactor=0.0,
                    doubleSided=bool(material["double_sided"]),
                    alphaMode="MASK" if material["cut_out"] else "OPAQUE",
                )
                visual = trimesh.visual.TextureVisuals(uv=uvs, material=look)
            mesh = trimesh.Trimesh(
                vertices=np.array(part.vertices, np.float64),
                faces=np.array(part.faces, np.int64),
                vertex_normals=np.array(part.normals, np.float64),
                visual=visual,
                process=False,
            )
            if visual is None:
                own = part.colors if len(part.colors) else np.ones((len(part.vertices), 3), np.float32)
                rgb = _srgb(own * np.float32(material["base_color"]))
                rgba = np.uint8(np.c_[255 * rgb, np.full(len(rgb), 255)])
                mesh.visual = trimesh.visual.ColorVisuals(mesh, vertex_colors=rgba)
            scene.add_geometry(mesh, geom_name=part.name, node_name=part.name)
        return scene

    def save(self, path: "str | os.PathLike[str]", unit: str = "m", up: str = "y") -> None:
        """Writes ``.glb``, ``.obj``, ``.ply``, ``.stl``, ``.usda`` or ``.usdz``, completely or not at all.

        ``unit`` (m, cm, mm) and ``up`` (y, z) are for formats that do not fix them; glTF is in metres, +y up.
        """
        folder, name = os.path.split(os.fspath(path))
        stem, extension = os.path.splitext(name)
        check_axes(extension[1:].lower(), unit, up)
        write_whole(folder, self._raw.files(extension[1:].lower(), stem, unit, up))

    def to_bytes(self, extension: str = "glb", unit: str = "m", up: str = "y") -> bytes:
        """Returns the file of a format, without companion files."""
        extension = extension.lower().lstrip(".")
        check_axes(extension, unit, up)
        return bytes(self._raw.files(extension, "model", unit, up)[0][1])

    def render(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> "np.ndarray":
        """Renders a picture: (height, width, 4) uint8, sRGB and alpha, rows from the top.

        ``view``: ``front``, ``three-quarter``, ``side``, ``top``, ``turntable`` or ``orbit`` (with ``azimuth`` and ``elevation``,
        degrees); ``background``: ``sky``, ``transparent``, ``white`` or ``#rrggbb``; ``shadow``; ``supersample``: 1 to 6;
        ``camera``: a ``burgeon.Camera`` instead of size and view; ``sun``: azimuth from north (-z) over east (+x) and elevation,
        degrees (default: next to the viewer); ``sunshine``, ``skylight``: brightness of sun and sky, 0 to 4, default 1. The
        pixels are those of ``burgeon render``.
        """
        return array(self._raw.render(look(size, **how)))

    def albedo(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> "np.ndarray":
        """Returns the colour of the surfaces in ``render(size, **how)`` without light: (height, width, 4) uint8, sRGB, and as
        alpha the share of the pixel that surfaces cover."""
        return array(self._raw.albedo(look(size, **how)))

    def to_png(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> bytes:
        """Renders the same as a PNG file."""
        pixels = self.render(size, **how)
        height, width, _ = pixels.shape
        return bytes(_burgeon.png(width, height, pixels.tobytes()))

    def to_html(self, height: int = 480) -> str:
        """Returns a self-contained 3-D view as HTML, on the Studio's stage: drag to turn, wheel or pinch to come nearer.

        Raises ``RuntimeError`` in a copy that was not installed from a wheel, which includes the stage.
        """
        from ._view import page

        return page(self, height)

    def _repr_png_(self) -> bytes:
        return self.to_png((640, 480))

    def _repr_html_(self) -> "Optional[str]":
        from ._view import can_show

        return self.to_html() if can_show() else None

    def __repr__(self) -> str:
        return f"<burgeon.Model {self.name!r}: {len(self.parts)} parts, {self.triangle_count:,} triangles>"


def _srgb(linear: "np.ndarray") -> "np.ndarray":
    import numpy as np

    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def joined(columns: "Sequence[Any]") -> "List[np.ndarray]":
    """Returns columns of the core as arrays."""
    return [array(c) for c in columns]
