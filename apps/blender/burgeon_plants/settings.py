"""Schemas -> properties of Blender. What a plant is asked for lies in properties of its object, one group for each maker.

A property may say another number than the plant's ``base``, the spec as JSON; which fields there are, the base alone says.
What changes that (another kind of a table, one row of a list more) is put into the base at once, and the properties anew.
"""

import copy
import json

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)

import burgeon as bg

from .fields import MAKERS, UNITS, VALUE, made, plain, rows, schema, table_of, usual, variants, words

MOST_ITEMS = 64
"""Longer lists have no rows, and stay as they are: nobody sets a thousand points in a panel."""
MOST_WHOLE = 2**31 - 1
"""Blender's whole numbers are of 32 bits; seeds, too."""
NONE = "NONE"

SURFACE = {
    "tree": ("detail", "sides", "textures", "texture_size", "foliage"),
    "sketch": ("detail", "sides", "textures", "variation", "petals"),
}
"""How the meshes of a maker are made; flowers and leaves have no such settings."""

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


SKIN = bg.schema("skin")
FOLIAGE = (
    ("outlines", "Outlines", "Leaves by their outlines"),
    ("cards", "Cards", "Leaves cut out of cards by their pictures: fewer triangles"),
    ("by-level", "By Level", "Outlines near by, cards far away"),
)


def _reshaped(group, _context):
    """A table is of another kind: it has other fields, which get the values that are usual for them."""
    if not filling:
        own = group.id_data.burgeon
        fill(own, asked(own))
        _touched(group, _context)


def _items(told):
    return [(word, word.replace("-", " ").capitalize(), about) for word, about in told.items()]


def _property(whole, row):
    schema = row.schema
    common = {"name": row.label, "description": _about(row), "update": _touched}
    limits = _limits(schema)
    if row.kind == "integer":
        return IntProperty(**common, **{k: int(min(max(v, -MOST_WHOLE), MOST_WHOLE)) for k, v in limits.items()})
    if row.kind == "number":
        subtype = UNITS.get(schema.get("x-unit"), "NONE")
        return FloatProperty(**common, **limits, subtype=subtype, precision=4, step=1 if limits["max"] <= 1 else 10)
    if row.kind == "boolean":
        return BoolProperty(**common)
    if row.kind == "text":
        return StringProperty(**common, subtype="FILE_PATH" if row.path[-1] == "file" else "NONE")
    if row.kind == "word":
        return EnumProperty(**common, items=[(NONE, "As it is", "")] * row.optional + _items(words(schema)))
    if row.kind == "variant":
        told = {word: table.get("description", "") for word, (_, table) in variants(whole, schema).items()}
        none = [(NONE, "None", "")] * row.optional
        return EnumProperty(**{**common, "update": _reshaped}, items=none + _items(told))
    if row.kind == "colour":
        return FloatVectorProperty(**common, size=3, subtype="COLOR_GAMMA", min=0.0, max=1.0)
    if row.kind == "linear":
        return FloatVectorProperty(**common, size=3, subtype="COLOR", min=0.0, max=1.0)
    return FloatVectorProperty(**common, **_limits(schema["items"]), size=schema["maxItems"], precision=4)


def _about(row):
    return row.schema.get("description", "").replace("`", "").strip().removesuffix(".")


def _limits(schema):
    return {"min": schema.get("minimum", -1e9), "max": schema.get("maximum", 1e9)}


CLASSES = []
"""The groups of properties, those first that others hold."""


def _group(name, whole, fields):
    """A group of properties with these rows."""
    own = {}
    for row in fields:
        if row.item:
            item = _group(f"{name}_{len(CLASSES)}", whole, row.item)
            own[row.name] = CollectionProperty(type=item, name=row.label, description=_about(row))
        else:
            own[row.name] = _property(whole, row)
        if row.switched:
            own[row.switch] = BoolProperty(name=f"Set {row.label}", description="Otherwise the program chooses", update=_touched)
    group = type(name, (bpy.types.PropertyGroup,), {"__annotations__": own})
    CLASSES.append(group)
    return group


def _of_skin(name):
    """Range and default of a number of the schema of surfaces."""
    field = SKIN["properties"][name]
    return {"default": field["default"], "min": field["minimum"], "max": field["maximum"], "update": _touched}


PETALS = [(NONE, "By Chance", ""), *_items(words(plain(SKIN, SKIN["properties"]["petals"])[0]))]
GROUPS = {maker: _group(f"BURGEON_{maker}", schema(maker), rows(maker)) for maker in MAKERS}


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
    sides: IntProperty(name="Sides", description="Of an ordinary branch", **_of_skin("sides"))
    textures: BoolProperty(name="Textures", description="Otherwise plain colours", default=True, update=_touched)
    texture_size: IntProperty(name="Texture Size", description="Pixels of a side", default=512, min=64, max=4096, update=_touched)
    variation: FloatProperty(name="Variation", description="How far colours differ within it", **_of_skin("variation"))
    petals: EnumProperty(name="Petals", description="Colour of drawn petals", items=PETALS, update=_touched)
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
    before, filling = filling, True
    try:
        plant.base = json.dumps(spec)
        _fill(rows(plant.maker), getattr(plant, plant.maker), spec)
    finally:
        filling = before


def _fill(fields, group, spec):
    for row in fields:
        table = table_of(spec, row)
        if table is None:
            continue
        value = was_in(row, table)
        if row.switched:
            setattr(group, row.switch, value is not None)
        if row.item:
            _fill_list(row, getattr(group, row.name), as_list(row, value))
        elif row.kind == "word":
            setattr(group, row.name, NONE if value is None else value)
        elif row.kind == "variant":
            setattr(group, row.name, _word(row, value))
        elif value is not None:
            setattr(group, row.name, _to_blender(row, value))
        elif row.schema.get("minimum", 0) > 0:
            setattr(group, row.name, max(row.schema["minimum"], 1 if row.kind == "integer" else 0))


def _fill_list(row, items, values):
    """Rows go and come at the end: one whose own property changed just now must not be freed."""
    values = values if len(values) <= MOST_ITEMS else []
    while len(items) > len(values):
        items.remove(len(items) - 1)
    while len(items) < len(values):
        items.add()
    for item, value in zip(items, values, strict=True):
        _fill(row.item, item, wrapped(row, value))


def was_in(row, table):
    """What the table of a spec has for a row; what it leaves out is as usual."""
    return table.get(row.path[-1], copy.deepcopy(row.schema.get("default", None if row.optional or not row.item else [])))


def as_list(row, value):
    return value.split("\n") if row.kind == "lines" and value is not None else value or []


def is_wrapped(row):
    """Whether the rows of a list are no tables: each is then the field ``VALUE`` of one."""
    return all(one.path[0] == VALUE for one in row.item)


def wrapped(row, value):
    return {VALUE: value} if is_wrapped(row) else value


def _word(row, value):
    """Of which kind a table is."""
    return NONE if value is None else value[_tag(row)]


def _tag(row):
    """The field that says of which kind a table is."""
    tags = (name for one in row.schema["oneOf"] for name, inner in one["properties"].items() if "const" in inner)
    return next(tags)


def _to_blender(row, value):
    if row.kind == "colour":
        return [int(value[k : k + 2], 16) / 255.0 for k in (1, 3, 5)]
    return min(value, MOST_WHOLE) if row.kind == "integer" else value


def value_of(whole, group, row, was):
    """What a row asks for; ``was``, bit for bit, where it says the same in Blender's single precision."""
    now = getattr(group, row.name)
    if row.kind == "word":
        return None if now == NONE else now
    if row.switched and not getattr(group, row.switch):
        return None
    if row.item:
        return _list_of(whole, row, now, was)
    if row.kind == "text":
        return bpy.path.abspath(now) if row.path[-1] == "file" else now
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


def _list_of(whole, row, items, was):
    """What the rows of a list ask for."""
    values = as_list(row, was)
    if len(values) != len(items):
        return was
    out = []
    for item, value in zip(items, values, strict=True):
        table = copy.deepcopy(wrapped(row, value))
        _ask(whole, row.item, item, table)
        out.append(table[VALUE] if is_wrapped(row) else table)
    return "\n".join(out) if row.kind == "lines" else out


def base(plant):
    """What a plant is asked for before its properties change it; nothing while it waits for the settings of its species."""
    return json.loads(plant.base or "{}")


def asked(plant):
    """The spec of a plant: its base, and what its properties say instead."""
    spec = base(plant)
    if spec:
        _ask(schema(plant.maker), rows(plant.maker), getattr(plant, plant.maker), spec)
    return spec


def _ask(whole, fields, group, spec):
    """Puts what the properties of a group say into a spec."""
    other = []
    for row in fields:
        table = table_of(spec, row)
        if table is None:
            continue
        was, name = was_in(row, table), row.path[-1]
        if was is None and not row.optional:
            continue
        if row.kind == "variant":
            if getattr(group, row.name) != _word(row, was):
                other.append(row)
            continue
        now = value_of(whole, group, row, was)
        if name in table or now != was:
            table[name] = now
    # Last, as the properties of their fields are still those of the kind that they were.
    for row in other:
        table, word = table_of(spec, row), getattr(group, row.name)
        if table is not None:
            like = was_in(row, table)
            table[row.path[-1]] = None if word == NONE else made(whole, variants(whole, row.schema)[word][1], like)


def add_item(plant, path):
    """One row more at the end of a list: like the last, or, of an empty list, as usual."""
    spec, row, table = _listed(plant, path)
    values = as_list(row, was_in(row, table))
    if len(values) >= MOST_ITEMS:
        raise ValueError(f"the panel shows lists of up to {MOST_ITEMS} rows")
    if row.kind == "lines":
        values.append("")
    elif values:
        values.append(copy.deepcopy(values[-1]))
    else:
        values.append(usual(schema(plant.maker), row.schema["items"], row.path[-1]))
    _put_list(plant, spec, row, table, values)


def remove_item(plant, path, index):
    """One row of a list less."""
    spec, row, table = _listed(plant, path)
    values = as_list(row, was_in(row, table))
    if not 0 <= index < len(values):
        raise ValueError(f"there is no row {index + 1} in a list of {len(values)}")
    del values[index]
    _put_list(plant, spec, row, table, values)


def _listed(plant, path):
    """A spec as it is asked for now, the row of a list in it, and the table of the spec in which the list stands.

    ``path``: steps of rows; a number between them is a row of a list, in which the next ones go on.
    """
    spec = asked(plant)
    fields, table, rest = rows(plant.maker), spec, list(path)
    while True:
        end = next((k for k, step in enumerate(rest) if isinstance(step, int)), len(rest))
        steps = tuple(rest[:end])
        row = next((r for r in fields if r.item and r.path == steps and table_of(table, r) is not None), None)
        if row is None:
            raise ValueError(f"there is no list {path} among the settings")
        here = table_of(table, row)
        if end == len(rest):
            return spec, row, here
        values = as_list(row, was_in(row, here))
        if not 0 <= rest[end] < len(values):
            raise ValueError(f"there is no row {rest[end] + 1} in a list of {len(values)}")
        fields, table, rest = row.item, wrapped(row, values[rest[end]]), rest[end + 1 :]


def _put_list(plant, spec, row, table, values):
    table[row.path[-1]] = "\n".join(values) if row.kind == "lines" else values
    fill(plant, spec)
    _touched(plant, None)


def key(plant):
    """All that a plant is made from."""
    surface = dict.fromkeys(name for names in SURFACE.values() for name in names)
    names = ("maker", "species", "seed", *surface, "day", "strokes", "opens", "row", "whole")
    return json.dumps([[getattr(plant, name) for name in names], asked(plant)], sort_keys=True)


CLASSES.append(BURGEON_plant)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Object.burgeon = PointerProperty(type=BURGEON_plant)


def unregister():
    del bpy.types.Object.burgeon
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
