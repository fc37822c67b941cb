"""Schemas -> properties of Blender. What a plant is asked for lies in properties of its object, one group for each maker."""

import functools
import json
from typing import Any, NamedTuple

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

import burgeon as bg

MAKERS = ("tree", "flower", "leaf", "sketch")
GENERAL = "general"
"""The topic of the fields that stand in no table."""
MOST_ITEMS = 4
"""Of lists of tables (the whorls of a flower), so many have rows."""
MOST_WHOLE = 2**31 - 1
"""Blender's whole numbers are of 32 bits; seeds, too."""
NONE = "NONE"

SURFACE = ("sides", "textures", "texture_size", "foliage")
"""How the meshes of a tree are made, beside their fineness; those of a drawing have the first two."""

UNITS = {"m": "DISTANCE", "d": "NONE", "a": "NONE"}
"""Units of schemas, and what Blender has for them; degrees stay degrees."""


class Row(NamedTuple):
    """A field that the panel shows."""

    path: "tuple[str | int, ...]"
    kind: str
    """``number``, ``integer``, ``boolean``, ``word``, ``colour``, ``linear``, ``triple``."""
    optional: bool
    """It may be left out: a switch stands before it."""
    schema: "dict[str, Any]"

    @property
    def name(self):
        return "__".join(str(step) for step in self.path)

    @property
    def switch(self):
        return f"use__{self.name}"

    @property
    def topic(self):
        return self.path[0] if len(self.path) > 1 else GENERAL

    @property
    def label(self):
        steps = self.path[1:] if len(self.path) > 1 else self.path
        unit = self.schema.get("x-unit", "")
        words = [str(step + 1) if isinstance(step, int) else step.removesuffix(f"_{unit}") for step in steps]
        label = " ".join(words).replace("_", " ").capitalize()
        return f"{label} ({unit})" if unit and not unit.endswith("colour") and UNITS.get(unit) != "DISTANCE" else label


@functools.cache
def rows(maker):
    """All fields of a maker that a row can show."""
    whole, out = bg.schema(maker), {}
    for name, field in whole.get("properties", {}).items():
        _walk(whole, field, (name,), out)
    return list(out.values())


def _walk(whole, field, path, out):
    field, optional = _plain(whole, field)
    words = [one["const"] for one in field.get("oneOf", []) if "const" in one] or field.get("enum", [])
    kind, unit = field.get("type"), field.get("x-unit")
    found = None
    if words and all(isinstance(word, str) for word in words):
        found = "word"
    elif kind in ("number", "integer", "boolean"):
        found = kind
    elif unit == "colour":
        found = "colour"
    elif unit == "linear-colour":
        found = "linear"
    elif kind == "array" and field.get("minItems") == field.get("maxItems") == 3:
        found = "triple"
    elif kind == "array" and _plain(whole, field.get("items", {}))[0].get("properties"):
        for k in range(MOST_ITEMS):
            _walk(whole, field["items"], (*path, k), out)
    # Fields of all variants of a table: those that a plant does not have are not shown.
    for table in (field, *field.get("oneOf", [])):
        for name, inner in _plain(whole, table)[0].get("properties", {}).items():
            if len(path) < 4 and "const" not in inner:
                _walk(whole, inner, (*path, name), out)
    row = Row(path, found, optional, field)
    if found and len(row.switch) < 64:
        out.setdefault(path, row)


def _plain(whole, field):
    """A schema without references, and without the null of what may be left out; whether it may."""
    optional = False
    for _ in range(8):
        if "$ref" in field:
            target = whole["$defs"][field["$ref"].rsplit("/", 1)[1]]
            field = {**target, **{k: v for k, v in field.items() if k != "$ref"}}
        elif "anyOf" in field:
            inner = [one for one in field["anyOf"] if one.get("type") != "null"]
            if len(inner) != 1:
                break
            optional = optional or len(inner) < len(field["anyOf"])
            field = {**inner[0], **{k: v for k, v in field.items() if k != "anyOf"}}
        else:
            break
    if isinstance(field.get("type"), list):
        optional = optional or "null" in field["type"]
        field = {**field, "type": next((kind for kind in field["type"] if kind != "null"), "null")}
    return field, optional


def at(spec, path):
    """The value at a path of a spec; ``missing`` where it has none."""
    for step in path:
        if isinstance(step, int):
            if not isinstance(spec, list) or step >= len(spec):
                return missing
            spec = spec[step]
        elif not isinstance(spec, dict) or step not in spec:
            return missing
        else:
            spec = spec[step]
    return spec


missing = object()
"""In the place of a value that a spec does not have."""

changed = []
"""Called with the object whose settings changed."""
filling = False
"""Settings are put by a program: nobody changed them."""


def _touched(group, _context):
    if not filling:
        for call in changed:
            call(group.id_data)


def _other_species(plant, context):
    """Another species has settings of its own, which the plant gets when it is made anew."""
    if not filling:
        plant.base = ""
        _touched(plant, context)


def _species(plant, _context, _typed):
    trees, flowers = bg.presets()
    return {"tree": trees, "flower": flowers}.get(plant.maker, [])


SKIN = bg.schema("skin")["properties"]
FOLIAGE = (
    ("outlines", "Outlines", "Leaves by their outlines"),
    ("cards", "Cards", "Leaves cut out of cards by their pictures: fewer triangles"),
    ("by-level", "By Level", "Outlines near by, cards far away"),
)


def _property(row):
    about, schema = row.schema.get("description", ""), row.schema
    common = {"name": row.label, "description": about.replace("`", "").strip().removesuffix("."), "update": _touched}
    limits = {"min": schema.get("minimum", -1e9), "max": schema.get("maximum", 1e9)}
    if row.kind == "integer":
        whole = {k: int(min(max(v, -MOST_WHOLE), MOST_WHOLE)) for k, v in limits.items()}
        return IntProperty(**common, **whole)
    if row.kind == "number":
        subtype = UNITS.get(schema.get("x-unit"), "NONE")
        return FloatProperty(**common, **limits, subtype=subtype, precision=4, step=1 if limits["max"] <= 1 else 10)
    if row.kind == "boolean":
        return BoolProperty(**common)
    if row.kind == "word":
        told = {one.get("const"): one.get("description", "") for one in schema.get("oneOf", [])}
        words = [word for word in told if word] or schema["enum"]
        items = [(word, word.replace("-", " ").capitalize(), told.get(word, "")) for word in words]
        return EnumProperty(**common, items=[(NONE, "As it is", ""), *items] if row.optional else items)
    if row.kind == "colour":
        return FloatVectorProperty(**common, size=3, subtype="COLOR_GAMMA", min=0.0, max=1.0)
    if row.kind == "linear":
        return FloatVectorProperty(**common, size=3, subtype="COLOR", min=0.0, max=1.0)
    return FloatVectorProperty(**common, size=3, precision=4)


def _group(maker):
    """The group of properties of a maker, from its schema."""
    own = {}
    for row in rows(maker):
        own[row.name] = _property(row)
        if row.optional and row.kind != "word":
            own[row.switch] = BoolProperty(name=f"Set {row.label}", description="Otherwise the program chooses", update=_touched)
    return type(f"BURGEON_{maker}", (bpy.types.PropertyGroup,), {"__annotations__": own})


GROUPS = {maker: _group(maker) for maker in MAKERS}


class BURGEON_plant(bpy.types.PropertyGroup):
    """What an object is the plant of; of an object that is none, ``maker`` is empty."""

    maker: StringProperty()
    species: StringProperty(
        name="Species",
        description="What it grows from; another one has settings of its own",
        search=_species,
        search_options={"SORT"},
        update=_other_species,
    )
    seed: IntProperty(name="Seed", description="What all chance follows from", default=1, min=0, update=_touched)
    detail: FloatProperty(name="Detail", description="Fineness of the meshes", default=1.0, min=0.1, max=8.0, update=_touched)
    sides: IntProperty(
        name="Sides",
        description="Of an ordinary branch",
        default=SKIN["sides"]["default"],
        min=SKIN["sides"]["minimum"],
        max=SKIN["sides"]["maximum"],
        update=_touched,
    )
    textures: BoolProperty(name="Textures", description="Otherwise plain colours", default=True, update=_touched)
    texture_size: IntProperty(name="Texture Size", description="Pixels of a side", default=512, min=64, max=4096, update=_touched)
    foliage: EnumProperty(name="Foliage", description="How leaves are meshed", items=FOLIAGE, update=_touched)
    day: FloatProperty(name="Day", description="0 is the bud", min=0.0, soft_max=30.0, max=1000.0, update=_touched)
    live: BoolProperty(name="Live", description="Make it anew a moment after each change", default=True, update=_touched)
    base: StringProperty(description="What it is asked for, as JSON, before the properties change it")
    strokes: StringProperty(description="Of a drawing: its strokes, as JSON")
    project: PointerProperty(type=bpy.types.Text, description="The project that it was imported from")
    row: IntProperty(description="Which of the plants of its project it is")
    whole: StringProperty(description="Of an imported plant: its seed, which may be larger than Blender's numbers")
    opens: StringProperty(description="Of a flower: shapes, first and last frame of its keyframes, as JSON")
    made: StringProperty(description="What the mesh was made from")
    fault: StringProperty(description="Why it could not be made")


for _maker, _of in GROUPS.items():
    BURGEON_plant.__annotations__[_maker] = PointerProperty(type=_of)


def fill(plant, spec):
    """Puts a spec into the properties of a plant."""
    global filling
    filling = True
    try:
        plant.base = json.dumps(spec)
        group = getattr(plant, plant.maker)
        for row in rows(plant.maker):
            value = at(spec, row.path)
            if value is missing:
                continue
            if row.optional and row.kind != "word":
                setattr(group, row.switch, value is not None)
            if row.kind == "word":
                setattr(group, row.name, NONE if value is None else value)
            elif value is not None:
                setattr(group, row.name, _to_blender(row, value))
            elif row.schema.get("minimum", 0) > 0:
                setattr(group, row.name, max(row.schema["minimum"], 1 if row.kind == "integer" else 0))
    finally:
        filling = False


def _to_blender(row, value):
    if row.kind == "colour":
        return [int(value[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    return min(value, MOST_WHOLE) if row.kind == "integer" else value


def value_of(plant, row, was):
    """What a row asks for; ``was``, bit for bit, where it says the same in Blender's single precision."""
    group = getattr(plant, plant.maker)
    now = getattr(group, row.name)
    if row.kind == "word":
        return None if now == NONE else now
    if row.optional and not getattr(group, row.switch):
        return None
    if row.kind == "boolean":
        return bool(now)
    if row.kind == "integer":
        return was if isinstance(was, int) and min(was, MOST_WHOLE) == now else int(now)
    if row.kind == "number":
        return was if was is not None and np.float32(was) == np.float32(now) else float(f"{now:.7g}")
    if row.kind == "colour":
        word = "#" + "".join(f"{round(255 * share):02x}" for share in now)
        return was if was is not None and was.lower() == word else word
    same = was is not None and all(np.float32(a) == np.float32(b) for a, b in zip(was, now, strict=True))
    return was if same else [float(f"{x:.7g}") for x in now]


def base(plant):
    """What a plant is asked for before its properties change it; nothing while it waits for the settings of its species."""
    return json.loads(plant.base or "{}")


def asked(plant):
    """The spec of a plant: its base, and what its properties say instead."""
    spec = base(plant)
    for row in rows(plant.maker):
        *tables, last = row.path
        if at(spec, row.path) is not missing:
            table = at(spec, tables)
            table[last] = value_of(plant, row, table[last])
    return spec


def key(plant):
    """All that a plant is made from."""
    names = ("maker", "species", "seed", "detail", *SURFACE, "day", "strokes", "opens", "row", "whole")
    return json.dumps([[getattr(plant, name) for name in names], asked(plant)], sort_keys=True)


CLASSES = (*GROUPS.values(), BURGEON_plant)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Object.burgeon = PointerProperty(type=BURGEON_plant)


def unregister():
    del bpy.types.Object.burgeon
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
