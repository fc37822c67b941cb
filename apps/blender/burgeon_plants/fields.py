"""Schemas -> rows of a panel: which fields there are, of what kind, when; and what a new table holds. Nothing of Blender."""

import copy
import functools
import json
import keyword
from typing import Any, NamedTuple

import burgeon as bg

MAKERS = ("tree", "flower", "leaf", "sketch")
GENERAL = "general"
"""The topic of the fields that stand in no table."""
UNITS = {"m": "DISTANCE", "d": "NONE", "a": "NONE"}
"""Units of schemas, and what Blender has for them; degrees stay degrees."""

LINES = (("method", "rules"),)
"""Texts of several lines: a field of Blender has one, so they are lists of lines."""
WITHOUT = {
    "vertices": "the mesh of an obstacle or a crown: thousands of numbers, which stay as they are",
    "triangles": "the same",
}
"""Fields that have no row, and why."""
VALUE = "value"
"""The field of a row of a list that is no table."""


class Row(NamedTuple):
    """A field that the panel shows."""

    path: "tuple[str, ...]"
    kind: str
    """``number``, ``integer``, ``boolean``, ``word``, ``colour``, ``linear``, ``vector``, ``text``; ``variant``: which of
    several tables it is; ``list``, ``lines``."""
    optional: bool
    """It may be left out: a switch stands before it."""
    schema: "dict[str, Any]"
    name: str
    """That of its property."""
    of: "tuple[tuple[tuple[tuple[str, ...], str, str], ...], ...]"
    """When there is such a field: each is a path, a field and a word, which the spec has there; one of several lists of them."""
    item: "tuple[Row, ...]" = ()
    """Of a list, what each of its rows has."""
    inner: bool = False
    """It is of a row of a list."""

    @property
    def switch(self):
        return f"use__{self.name}"

    @property
    def topic(self):
        return self.path[0] if len(self.path) > 1 or self.kind in ("list", "lines", "variant") else GENERAL

    @property
    def switched(self):
        return self.optional and self.kind not in ("word", "variant")

    @property
    def label(self):
        steps = self.path[1:] if len(self.path) > 1 and (not self.inner or self.path[0] == VALUE) else self.path
        unit = self.schema.get("x-unit", "")
        label = " ".join(step.removesuffix(f"_{unit}") for step in steps).replace("_", " ").capitalize()
        return f"{label} ({unit})" if unit and not unit.endswith("colour") and UNITS.get(unit) != "DISTANCE" else label


@functools.cache
def schema(maker):
    """The schema of what a maker is asked for."""
    return bg.schema(maker)


@functools.cache
def rows(maker):
    """All fields of a maker that a row can show."""
    return _rows(schema(maker), schema(maker), False)


def _rows(whole, table, inner):
    found = {}

    def walk(field, path, of):
        field, optional = plain(whole, field)
        kind = _kind(whole, field, path)
        if kind:
            put(path, kind, optional, field, of)
        kinds = variants(whole, field)
        for word, (tag, table) in kinds.items():
            for name, one in table["properties"].items():
                if name != tag:
                    walk(one, (*path, name), (*of, (path, tag, word)))
        for name, one in {} if kinds else field.get("properties", {}).items():
            walk(one, (*path, name), of)

    def put(path, kind, optional, field, of):
        like = _bare(field)
        there = [row for row in found.values() if row.path == path]
        for row in there:
            if (row.kind, row.optional, _bare(row.schema)) == (kind, optional, like):
                found[row.name] = row._replace(of=(*row.of, of))
                return
        # A field of another table by the same name.
        name = "__".join((*path, f"of_{of[-1][2]}") if there else path).replace("-", "_")
        if keyword.iskeyword(name):
            name += "_"
        item = ()
        if kind == "list":
            one, _ = plain(whole, field["items"])
            item = _rows(whole, one if "properties" in one else {"properties": {VALUE: one}}, True)
        elif kind == "lines":
            item = _rows(whole, {"properties": {VALUE: {"type": "string"}}}, True)
        found[name] = Row(path, kind, optional, field, name, (of,), item, inner)

    for name, one in table["properties"].items():
        walk(one, (name,), ())
    return tuple(found.values())


def _kind(whole, field, path):
    """What kind of row a field has; None for tables, and for what has none."""
    unit, kind = field.get("x-unit"), field.get("type")
    if path and path[-1] in WITHOUT:
        return None
    if words(field):
        return "word"
    if variants(whole, field):
        return "variant"
    if kind in ("number", "integer", "boolean"):
        return kind
    if unit == "colour":
        return "colour"
    if kind == "string":
        return "lines" if path in LINES else "text"
    if kind != "array":
        return None
    if unit == "linear-colour":
        return "linear"
    few = field.get("minItems") == field.get("maxItems") and field.get("maxItems", 0) in (2, 3)
    return "vector" if few and plain(whole, field["items"])[0].get("type") == "number" else "list"


def words(field):
    """The words that a field may be, and what each means."""
    found = {one["const"]: one.get("description", "") for one in field.get("oneOf", []) if isinstance(one.get("const"), str)}
    return found or {word: "" for word in field.get("enum", [])}


def variants(whole, field):
    """The tables that a field may be: word -> the name of the field that says it, and the table's schema."""
    found = {}
    for one in field.get("oneOf", []):
        table, _ = plain(whole, one)
        for name, inner in table.get("properties", {}).items():
            if isinstance(inner.get("const"), str):
                found[inner["const"]] = (name, table)
    return found


def _bare(field):
    """A schema without what people read, as text: two such fields take the same values."""

    def bare(value):
        if isinstance(value, dict):
            return {k: bare(v) for k, v in value.items() if k not in ("description", "default", "title")}
        return [bare(v) for v in value] if isinstance(value, list) else value

    return json.dumps(bare(field), sort_keys=True)


def plain(whole, field):
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


def usual(whole, field, name, like=None):
    """What a field is at first: its default; that of another field by its name and of its kind; else what comes next to 1,
    of places the origin.

    ``like``: a table whose fields stay where the new one has the same.
    """
    field, optional = plain(whole, field)
    if "default" in field:
        return copy.deepcopy(field["default"])
    if optional:
        return None
    for _, table in list(variants(whole, field).values())[:1]:
        return made(whole, table, like)
    if "properties" in field:
        return made(whole, field, like)
    known = _usual(whole).get((name, field.get("type")), missing)
    if known is not missing:
        return copy.deepcopy(known)
    if words(field):
        return next(iter(words(field)))
    kind = field.get("type")
    if kind == "array" and field.get("x-unit") == "m" and plain(whole, field["items"])[0].get("minimum", -1) < 0:
        return [0.0] * field.get("minItems", 0)
    if kind in ("number", "integer"):
        value = min(max(1, field.get("minimum", 1)), field.get("maximum", 1))
        return int(value) if kind == "integer" else float(value)
    if kind == "array":
        return [usual(whole, field["items"], name) for _ in range(field.get("minItems", 0))]
    return {"boolean": False, "string": ""}[kind]


def made(whole, table, like=None):
    """A new table of a schema."""
    out = {}
    for name, one in table["properties"].items():
        value = one["const"] if "const" in one else usual(whole, one, name)
        was = (like or {}).get(name, missing)
        # Alike as values go; what does not fit its range is refused by name.
        if "const" not in one and was is not missing and _same_kind(was, value):
            value = was
        out[name] = value
    return out


def _same_kind(a, b):
    numbers = (int, float)
    if isinstance(a, list) and isinstance(b, list):
        return not a or not b or _same_kind(a[0], b[0])
    return type(a) is type(b) or (type(a) in numbers and type(b) in numbers)


TYPES = {bool: "boolean", int: "integer", float: "number", str: "string", list: "array"}


def _usual(whole):
    """Defaults by the names and types of their fields, also those within the default of a table."""
    found = {}

    def note(name, value):
        for table in value if isinstance(value, list) else [value]:
            for inner, one in table.items() if isinstance(table, dict) else ():
                note(inner, one)
        if type(value) in TYPES and value not in ("", []):
            found.setdefault((name, TYPES[type(value)]), value)

    def walk(node):
        if isinstance(node, dict):
            for name, one in node.get("properties", {}).items():
                if isinstance(one, dict) and "default" in one:
                    note(name, one["default"])
        for inner in node.values() if isinstance(node, dict) else node if isinstance(node, list) else ():
            walk(inner)

    walk(whole)
    return found


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


def table_of(spec, row):
    """The table of a spec in which a row's field stands; None if this spec has no such field."""
    table = at(spec, row.path[:-1])
    if not isinstance(table, dict):
        return None
    for needed in row.of:
        tables = [(at(spec, path), tag, word) for path, tag, word in needed]
        if all(isinstance(one, dict) and one.get(tag) == word for one, tag, word in tables):
            return table
    return None
