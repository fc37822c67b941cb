"""Plants: tables, measures, clouds, files, and plants derived from them."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Dict, Iterable, List, Optional, Tuple

from . import _burgeon
from ._drawing import Drawing, draw
from ._files import write_whole
from ._given import STRUCTURES, asked_of, flag, number, whole, word, wrong
from ._given import axes as check_axes
from ._light import Light, lit
from ._recipe import Recipe, recipe
from .model import USUAL_SIZE, Cloud, Masks, Model, array, look, seen, shown

if TYPE_CHECKING:
    import numpy as np
    from typing_extensions import Unpack

    from ._light import Lighting
    from .model import Path, View

__all__ = ["Axes", "Nodes", "Organs", "Plant"]


class _Table:
    """Columns of one length. They use the memory of the core, which they keep alive; they are read-only."""

    __slots__ = ("_known", "_raw")
    _prefix = ""
    _columns: "Tuple[str, ...]" = ()

    def __init__(self, raw: Any) -> None:
        self._raw = raw
        self._known: "Dict[str, np.ndarray]" = {}

    def _column(self, name: str) -> "np.ndarray":
        if name not in self._known:
            self._known[name] = array(self._raw.column(f"{self._prefix}_{name}"))
        return self._known[name]

    def to_dict(self) -> "Dict[str, np.ndarray]":
        """Returns all columns by name, for ``pandas.DataFrame`` and the like."""
        out: "Dict[str, np.ndarray]" = {}
        for name in self._columns:
            column = self._column(name)
            if column.ndim == 1:
                out[name] = column
            else:
                out.update({f"{name}_{axis}": column[:, k] for k, axis in enumerate("xyz")})
        return out

    def __len__(self) -> int:
        return len(self._column(self._columns[0]))

    def __repr__(self) -> str:
        return f"<burgeon.{type(self).__name__}: {len(self):,} rows of {', '.join(self._columns)}>"


class Nodes(_Table):
    """Points of axes: one row a node, those of an axis in a row, base first. Shown without a copy."""

    __slots__ = ()
    _prefix = "node"
    _columns = ("position", "radius", "axis")

    @property
    def position(self) -> "np.ndarray":
        """(n, 3) float64: metres, +y up, ground at y = 0."""
        return self._column("position")

    @property
    def radius(self) -> "np.ndarray":
        """(n,) float64: metres."""
        return self._column("radius")

    @property
    def axis(self) -> "np.ndarray":
        """(n,) uint32: row of ``plant.axes``."""
        return self._column("axis")


class Axes(_Table):
    """Trunks, branches, stems, stalks, roots: one row each, after their bearers."""

    __slots__ = ()
    _prefix = "axis"
    _columns = ("part", "order", "parent", "bearer", "first", "end", "length", "angle", "stroke")

    @property
    def part(self) -> "np.ndarray":
        """(n,) uint8: row of ``burgeon.PARTS``."""
        return self._column("part")

    @property
    def order(self) -> "np.ndarray":
        """(n,) uint32: 0 for axes that stand on the ground, one more with each branching."""
        return self._column("order")

    @property
    def parent(self) -> "np.ndarray":
        """(n,) int32: row of the axis that bears it; -1 for those on the ground."""
        return self._column("parent")

    @property
    def bearer(self) -> "np.ndarray":
        """(n,) int32: row of the node that bears it; -1 for those on the ground."""
        return self._column("bearer")

    @property
    def first(self) -> "np.ndarray":
        """(n,) uint32: row of its first node."""
        return self._column("first")

    @property
    def end(self) -> "np.ndarray":
        """(n,) uint32: the row after its last node."""
        return self._column("end")

    @property
    def length(self) -> "np.ndarray":
        """(n,) float64: from node to node, metres."""
        return self._column("length")

    @property
    def angle(self) -> "np.ndarray":
        """(n,) float64: between its first internode and the one that bears it, degrees; NaN for those on the ground."""
        return self._column("angle")

    @property
    def stroke(self) -> "np.ndarray":
        """(n,) int32: the stroke from which it was read; -1 if the program grew it."""
        return self._column("stroke")


class Organs(_Table):
    """Leaves, petals, fruits and so on: one row each."""

    __slots__ = ()
    _prefix = "organ"
    _columns = ("part", "position", "along", "normal", "scale", "area", "bearer", "flower", "shape", "stroke")

    @property
    def part(self) -> "np.ndarray":
        """(n,) uint8: row of ``burgeon.PARTS``."""
        return self._column("part")

    @property
    def position(self) -> "np.ndarray":
        """(n, 3) float64: its root, metres."""
        return self._column("position")

    @property
    def along(self) -> "np.ndarray":
        """(n, 3) float64: unit vector from root to tip."""
        return self._column("along")

    @property
    def normal(self) -> "np.ndarray":
        """(n, 3) float64: unit vector of its upper side."""
        return self._column("normal")

    @property
    def scale(self) -> "np.ndarray":
        """(n,) float64: size relative to its shape."""
        return self._column("scale")

    @property
    def area(self) -> "np.ndarray":
        """(n,) float64: one side of it as it is bent, square metres; half of the surface of round organs."""
        return self._column("area")

    @property
    def bearer(self) -> "np.ndarray":
        """(n,) int32: row of ``plant.nodes``; -1 for none."""
        return self._column("bearer")

    @property
    def flower(self) -> "np.ndarray":
        """(n,) int32: number of its flower; -1 for none."""
        return self._column("flower")

    @property
    def shape(self) -> "np.ndarray":
        """(n,) uint32: number of its shape."""
        return self._column("shape")

    @property
    def stroke(self) -> "np.ndarray":
        """(n,) int32: the stroke from which it was read; -1 if the program placed it."""
        return self._column("stroke")


class Plant:
    """A plant of any maker. A plant never changes: ``shape`` and ``at`` return others. Threads may share it."""

    __slots__ = ("_known", "_raw", "_recipe")

    def __init__(self, recipe: Recipe, raw: Any = None) -> None:
        self._recipe = recipe
        self._raw = recipe.make() if raw is None else raw
        self._known: "Dict[str, Any]" = {}

    def _then(self, function: str, *arguments: Any) -> "Plant":
        """Returns the plant that a method of this one makes."""
        then = recipe(function, *arguments, before=self._recipe)
        return Plant(then, then.of(self._raw))

    def __reduce__(self) -> "Tuple[Any, ...]":
        """Pickles the request for the plant, which is made again on reading."""
        return Plant, (self._recipe,)

    def __copy__(self) -> "Plant":
        return self

    def __deepcopy__(self, memo: Any) -> "Plant":
        return self

    def __eq__(self, other: object) -> bool:
        """Compares name, seed, place, structure and meshes."""
        if not isinstance(other, Plant):
            return NotImplemented
        return self is other or (self._marks() == other._marks() and self.model == other.model)

    def __hash__(self) -> int:
        return hash(self._marks())

    def _marks(self) -> "Tuple[Any, ...]":
        return self.name, self.seed, self.maker, self.digest, self.day, self.place

    def _keep(self, name: str, make: Any) -> Any:
        if name not in self._known:
            self._known[name] = make()
        return self._known[name]

    @property
    def name(self) -> str:
        """Its name, for files and reports."""
        return self._raw.name

    @property
    def seed(self) -> int:
        """The seed of all random numbers."""
        return self._raw.seed

    @property
    def maker(self) -> str:
        """``sketch``, ``tree``, ``leaf`` or ``flower``."""
        return self._raw.maker

    @property
    def digest(self) -> str:
        """Its fingerprint: that of the command line's report, on every machine."""
        return self._raw.digest

    @property
    def report(self) -> "Dict[str, Any]":
        """Its entry of the command line's report: counts, times, warnings, and the reading of a drawing."""
        return self._keep("report", lambda: json.loads(self._raw.report()))

    @property
    def warnings(self) -> "List[str]":
        """Warnings of its making."""
        return list(self.report.get("warnings", []))

    @property
    def checks(self) -> "List[Dict[str, Any]]":
        """Checks of it: ``name``, ``value``, ``bound``, ``side``, ``ok``, ``severity``, ``message``, ``advice``."""
        return list(self.report.get("checks", []))

    @property
    def spec(self) -> "Dict[str, Any]":
        """All options of its maker, including defaults."""
        return json.loads(self._raw.spec())

    @property
    def place(self) -> "Tuple[Tuple[float, float, float], float, float]":
        """Its place in the project from which it was opened, or in its scan: position in metres, rotation about +y in degrees,
        scale."""
        position, yaw, scale = self._raw.place
        return (position[0], position[1], position[2]), yaw, scale

    @property
    def found(self) -> "Optional[Dict[str, Any]]":
        """Counts of the points of a scanned tree: ``points``, ``ground``, ``noise``, ``wood``, ``leaves``, ..."""
        found = self._raw.found
        return None if found is None else json.loads(found)

    @property
    def front(self) -> "Optional[Tuple[float, Tuple[float, float]]]":
        """For a drawing: metres for each of its units, and the point (x, y, y upwards) of it at which the plant stands.

        The front view of the model is the drawing: ``plant_xy = (drawing_xy - point) * metres``.
        """
        front = self._raw.front
        return None if front is None else (front[0], (front[1][0], front[1][1]))

    def leaf_area_by_layer(self, layer: float = 1.0) -> "np.ndarray":
        """Returns the area of one side of the leaves in each layer, lowest first, square metres.

        ``layer``: thickness of a layer, metres, 0.001 to 1000; the first begins at y = 0, and leaves that are lower count to it.
        A leaf counts to the layer of its root.
        """
        import numpy as np

        layer = number("layer", layer, 0.001, 1000, "m")
        organs = self.organs
        leaves = organs.part == PARTS.index("leaf")
        rows = np.maximum(np.floor(organs.position[leaves, 1] / layer), 0).astype(np.int64)
        return np.bincount(rows, weights=organs.area[leaves])

    def measures(self) -> "Dict[str, Any]":
        """Returns all measures, in SI units (docs/measures.md): ``height_m``, ``dbh_m``, ``leaf_area_m2`` and so on.

        None stands for a measure that this plant lacks, such as a diameter at breast height below 1.3 m.
        """
        return json.loads(self._raw.measures())

    @property
    def nodes(self) -> Nodes:
        """Positions and radii of all axes."""
        return self._keep("nodes", lambda: Nodes(self._raw))

    @property
    def axes(self) -> Axes:
        """Trunk, branches, stems, roots."""
        return self._keep("axes", lambda: Axes(self._raw))

    @property
    def organs(self) -> Organs:
        """Leaves, petals, fruits."""
        return self._keep("organs", lambda: Organs(self._raw))

    @property
    def parents(self) -> "np.ndarray":
        """(nodes,) int32: the node before each node, or the one that bears its axis; -1 at the ground."""

        def make() -> "np.ndarray":
            import numpy as np

            parents = np.arange(-1, len(self.nodes) - 1, dtype=np.int32)
            parents[self.axes.first] = self.axes.bearer
            parents.setflags(write=False)
            return parents

        return self._keep("parents", make)

    @property
    def model(self) -> Model:
        """Its meshes and materials."""
        return self._keep("model", lambda: Model(self._raw.model(), recipe("model", before=self._recipe)))

    def level(self, level: int) -> Model:
        """Returns coarser meshes for views from far away, 1 to 6: about half of the triangles with each level."""
        level = whole("level", level, 0, 6)
        if level == 0:
            return self.model
        return Model(self._raw.level(level), recipe("level", level, before=self._recipe))

    def labels(self) -> "List[np.ndarray]":
        """Returns the labels of the triangles of each part of ``model``: (triangles, 3) int32 of part, axis, organ.

        Rows of ``burgeon.PARTS``, ``axes`` and ``organs``; -1 for none.
        """
        return [array(c) for c in self._raw.labels()]

    def cloud(
        self,
        points: int = 20_000,
        stations: "Optional[int]" = None,
        elevation: "Optional[float]" = None,
        noise: float = 0.0,
        seed: "Optional[int]" = None,
        *,
        beam: float = 0.0,
        pulse: "Optional[float]" = None,
        path: "Optional[Path]" = None,
    ) -> Cloud:
        """Scans the plant: the first surface that a beam meets gives a point, surfaces behind it are hidden.

        ``points``: 1 to 5 million; ``stations``: places of the scanner, evenly around the plant, 1 to 64 (4); ``elevation``:
        their angle above the horizon of its centre, degrees, -80 to 80 (5); ``noise``: standard deviation of the distance,
        metres, 0 to 1 (0); ``seed``: that of the choice of points and of noise (the plant's).

        ``beam``: divergence of a beam from edge to edge, milliradians, 0 to 50 (0, a line). A beam that an edge splits gives a
        point between the surfaces, with the label of the one that fills more of it, and ``share`` below 1, if they are nearer
        than ``pulse`` to one another, metres, 0 to 5 (0.25); else each gives an echo of its own. ``path``: 2 to 256 points
        (x, y, z) along which the scanner moves at a constant speed, instead of stations: its mirror turns in planes across it.
        """
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
        return Cloud(**columns, instance=self._instance(columns["axis"], columns["organ"]))

    def _instance(self, axis: "np.ndarray", organ: "np.ndarray") -> "np.ndarray":
        """Returns numbers of instances (``burgeon.labels``) for rows of axes and organs."""
        import numpy as np

        return np.where(organ >= 0, organ + (1 + len(self.axes)), axis + 1).astype(np.int32)

    def light(self, **how: "Unpack[Lighting]") -> Light:
        """Computes the photosynthetically active light that each of its axes and organs absorbs (``burgeon light``).

        ``sky``: ``overcast``, ``uniform`` or ``clear``; ``diffuse``, ``direct``: PAR of sky and sun on level ground, W/m2, 0 to
        2000; ``sun``: azimuth from north (-z) over east (+x) and elevation, degrees; or ``place`` (latitude, longitude, metres)
        with ``date``, ``hour`` (12), ``zone``, ``turbidity`` (1 to 10) or ``daily``, the sum of the day; ``sky_table``: rows of
        azimuth, elevation and W/m2; ``repeat``: width and depth of a cell that repeats itself without end, metres; ``leaf``:
        reflectance and transmittance; ``wood``, ``soil``: reflectance; ``bounces``: 0 to 50; ``rays``: lines of light in each
        direction, 1000 to 4194304. Defaults are those of the command (docs/light.md).
        """
        return lit(self._raw, **how)

    def drawing(self) -> Drawing:
        """Returns a line drawing of it, as a person would draw it from the front: stems, outlines of leaves and petals, or the
        crown.

        ``plant.drawing().save("x.svg")`` writes it; ``sketch`` reads it.
        """
        return draw(self._raw)

    def masks(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> Masks:
        """Returns the labels of each pixel of ``render(size, **how)`` at its centre: part, axis, organ and depth."""
        import numpy as np

        labels = self.labels()
        start = np.cumsum([0] + [len(rows) for rows in labels])
        _, part, axis, organ, depth, normal = shown(self._raw.model(), labels, start, look(size, **how))
        return Masks(part, axis, organ, depth, normal, self._instance(axis, organ))

    def branches(self, order: int = 1) -> "List[Dict[str, Any]]":
        """Returns the branches up to an order: ``path`` (their name in edits), ``at``, ``base_m``, ``length_m``, ``radius_m``,
        ..."""
        return json.loads(self._raw.branches(whole("order", order, 0, 1000)))

    def shape(self, edits: "str | os.PathLike[str] | Dict[str, Any] | Iterable[Dict[str, Any]]") -> "Plant":
        """Returns the plant after edits by hand: an edits file (``burgeon shape --template``), its content, or its list.

        >>> short = oak.shape([{"op": "prune", "axis": {"path": [0, 0]}, "at": 0.5}])  # doctest: +SKIP
        """
        if isinstance(edits, (str, os.PathLike)):
            with open(edits, encoding="utf-8") as file:
                edits = json.load(file)
        if isinstance(edits, dict):
            edits = edits.get("edits", [edits])
        if not isinstance(edits, (list, tuple)):
            raise TypeError(f"edits must be a file, its content or a list of edits, not {edits!r}")
        return self._then("shape", list(edits))

    def at(self, day: float) -> "Plant":
        """Returns the plant on another day, 0 (bud) to 100: for flowers, and for drawings whose flowers then open."""
        return self._then("at", number("day", day, 0, 100, "d"))

    def again(
        self,
        *,
        seed: "Optional[int]" = None,
        day: "Optional[float]" = None,
        detail: "Optional[float]" = None,
        sides: "Optional[int]" = None,
        textures: "Optional[bool]" = None,
        wind: "Optional[bool]" = None,
        **fields: Any,
    ) -> "Plant":
        """Returns the plant with other settings; missing ones stay, and so do edits by hand, materials, obstacles and place.

        ``fields``: those of its maker, as in ``schema(plant.maker)``: ``tree.again(age=12, leaves={"leaf_keep": 0.5})``. It also
        works for the plants of a project (``open``). ``detail``, ``sides``, ``textures``: for trees and drawings; ``day``: for
        flowers.
        """
        skin = {"detail": detail, "sides": sides, "textures": textures, "wind": wind}
        asked = asked_of(1 if seed is None else seed, 1.0, fields, skin)
        day = None if day is None else number("day", day, 0, 100, "d")
        return self._then("again", asked, seed is not None, day)

    @property
    def days(self) -> "Optional[Tuple[float, float]]":
        """Days from bud to full bloom, and from there to wilted; None for plants without days."""
        days = self._raw.days
        return None if days is None else tuple(days)

    @property
    def day(self) -> "Optional[float]":
        """The day of a flower, or of a drawing whose flowers open; None for others."""
        return self._raw.day

    @property
    def detail(self) -> "Optional[float]":
        """Fineness of the meshes of a tree or drawing, 0.1 to 8; None for others."""
        surface = self._raw.surface
        return None if surface is None else surface[0]

    def mtg(self, up: str = "z", unit: str = "m") -> Any:
        """Returns its structure as ``openalea.mtg.MTG`` if that is installed, else as the text of an ``.mtg`` file.

        As text with openalea.mtg installed: ``plant.to_bytes("mtg")``.
        """
        text = bytes(self._raw.structure("mtg", unit, up)).decode()
        try:
            from openalea.mtg.io import read_mtg
        except ImportError:
            return text
        return read_mtg(text)

    def to_bytes(self, extension: str, unit: str = "m", up: "Optional[str]" = None) -> bytes:
        """Returns the file of a format: models, ``mtg``, ``opf``, ``qsm`` (a table of cylinders), ``swc`` (a skeleton),
        ``burgeon`` (a project).
        """
        extension = extension.lower().lstrip(".")
        if extension in STRUCTURES:
            return bytes(self._raw.structure(extension, unit, up or "z"))
        check_axes(extension, unit, up)
        if extension == "burgeon":
            return bytes(self._raw.project())
        return self.model.to_bytes(extension, unit, up or "y")

    def save(
        self,
        path: "str | os.PathLike[str]",
        unit: "Optional[str]" = None,
        up: "Optional[str]" = None,
        *,
        engine: "Optional[str]" = None,
        lods: "Optional[int]" = None,
        one_file: bool = False,
        instances: bool = False,
        impostor: "Optional[int]" = None,
        pack: "Optional[str]" = None,
        sway: bool = False,
        triangles: "Optional[int]" = None,
        megabytes: "Optional[float]" = None,
    ) -> "Tuple[str, ...]":
        """Writes a model (``.glb``, ``.obj``, ``.ply``, ``.stl``, ``.usda``, ``.usdz``), its structure (``.mtg``, ``.opf``,
        ``.swc``), its cylinders (``.qsm.csv``), or a project of the Studio (``.burgeon``): completely or not at all.

        Of models: ``lods`` coarser copies, 0 to 6, beside it (``x-lod1.glb``, ...); ``impostor``: one more, views from all sides
        in an atlas of so many pixels, 128 to 4096. Of ``.glb``: ``one_file`` takes the copies in; ``instances``: each form of
        leaf once; ``pack``: ``quantized`` or ``meshopt``; ``sway``: joints with an animation (docs/exports.md).

        ``triangles``: most triangles of the model, 100 or more, which then is the first level of detail within it; ``megabytes``:
        most megabytes of its file and those beside it, 0.001 to 4000: textures become smaller first, then the model becomes the
        first level of detail that fits. A budget that nothing fits is a SpecError with the least that there is.

        ``engine``: ``three``, ``blender``, ``unity``, ``unreal``, ``godot``, ``isaac`` or ``print`` sets what is left open as the
        importer of that program takes it (docs/engines). What was set is returned, as options of ``burgeon``,
        and at the end how the model was reduced for a budget.
        """
        folder, name = os.path.split(os.fspath(path))
        stem, dotted = os.path.splitext(name)
        extension = dotted[1:].lower()
        if name.lower().endswith(".qsm.csv"):
            extension = "qsm"
        form = {
            "engine": None if engine is None else word("engine", engine),
            "lods": 0 if lods is None else whole("lods", lods, 0, 6),
            "one_file": flag("one_file", one_file),
            "instances": flag("instances", instances),
            "impostor": None if impostor is None else whole("impostor", impostor, 128, 4096),
            "pack": None if pack is None else word("pack", pack),
            "sway": flag("sway", sway),
            "triangles": None if triangles is None else whole("triangles", triangles, 100, 4_000_000_000),
            "megabytes": None if megabytes is None else number("megabytes", megabytes, 0.001, 4000),
        }
        if extension in (*STRUCTURES, "burgeon"):
            asked = [word for word, value in form.items() if value not in (0, False, None)]
            if asked:
                raise wrong(f"{asked[0]} is of models, not of .{extension} files", asked[0], "given", "left out")
            write_whole(folder, [(name, self.to_bytes(extension, unit or "m", up))])
            return ()
        check_axes(extension, unit or "m", up)
        axes = {"unit": word("unit", unit or "m"), "up": word("up", up or "y"), "names": False}
        given = [unit is not None, up is not None, lods is not None]
        files, settings = self._raw.files(extension, stem, {**axes, "given": given, **form})
        write_whole(folder, [(name, files[0][1]), *files[1:]])
        return tuple(settings)

    def render(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> "np.ndarray":
        """Renders a picture: see ``Model.render``."""
        return self.model.render(size, **how)

    def albedo(self, size: "Tuple[int, int] | int" = USUAL_SIZE, **how: "Unpack[View]") -> "np.ndarray":
        """Returns the colour of its surfaces without light: see ``Model.albedo``."""
        return self.model.albedo(size, **how)

    def _repr_png_(self) -> bytes:
        return self.model._repr_png_()

    def _repr_html_(self) -> "Optional[str]":
        from ._view import can_show

        return self.to_html() if can_show() else None

    def to_html(self, height: int = 480) -> str:
        """Returns a self-contained 3-D view as HTML: see ``Model.to_html``; a large plant has coarser meshes there."""
        from ._view import MOST_TRIANGLES

        level = 0
        while level < 6 and self.model.triangle_count > MOST_TRIANGLES << level:
            level += 1
        return self.level(level).to_html(height)

    def __repr__(self) -> str:
        return (
            f"<burgeon.Plant {self.name!r} ({self.maker}, seed {self.seed}): {len(self.axes):,} axes, "
            f"{len(self.organs):,} organs, {self.model.triangle_count:,} triangles>"
        )


PARTS: "Tuple[str, ...]" = tuple(_burgeon.PARTS)
"""Words for points, triangles, axes and organs, by their number ``part``."""
