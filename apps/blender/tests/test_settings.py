"""Settings: every field of every schema has a row; kinds of tables, lists and their undo."""

import json

import bpy
import pytest
from test_plants import SMALL, active, same, small, there

import burgeon as bg
from burgeon_plants import fields, panel, plants, settings


def resolved(whole, field):
    """A field, and whether it may be null; not by the code that is tested."""
    null = "null" in field.get("type", []) if isinstance(field.get("type"), list) else False
    if "anyOf" in field:
        (one,) = [one for one in field["anyOf"] if one.get("type") != "null"]
        null = null or len(field["anyOf"]) > 1
        return resolved(whole, one)[0], null
    if "$ref" in field:
        return whole["$defs"][field["$ref"].split("/")[-1]], null
    return field, null


def without_row(whole, table, rows, path=(), kinds=()):
    """The paths of all fields of a table that no row shows; ``kinds``: of the tables around it, where they have some."""
    out = []
    for name, one in table["properties"].items():
        if "const" in one:
            continue
        here, (field, null) = (*path, name), resolved(whole, one)
        row = next((r for r in rows if r.path == here and any(dict(kinds) == {p: w for p, _, w in n} for n in r.of)), None)
        tables = [resolved(whole, kind)[0] for kind in field.get("oneOf", [])]
        if row is None and (null or "properties" not in field):
            out.append(here)
        if "properties" in field:
            out += without_row(whole, field, rows, here, kinds)
        for inner in tables:
            for word in [v["const"] for v in inner.get("properties", {}).values() if "const" in v]:
                out += without_row(whole, inner, rows, here, (*kinds, (here, word)))
        item = resolved(whole, field.get("items", {}))[0]
        if row is not None and row.kind == "list":
            item = item if "properties" in item else {"properties": {fields.VALUE: item}}
            out += [(*here, "[]", *rest) for rest in without_row(whole, item, row.item)]
    return out


@pytest.mark.parametrize("maker", fields.MAKERS)
def test_every_field_of_a_maker_has_a_row(maker):
    whole = bg.schema(maker)
    missing = without_row(whole, whole, fields.rows(maker))
    # Those without one are told, each with its reason.
    wanted = set(fields.WITHOUT) if maker == "tree" else set()
    assert {path[-1] for path in missing} == wanted, missing
    # And a property of Blender, whose name it takes.
    group = getattr(plants_group(maker), maker)
    for row in fields.rows(maker):
        assert row.name in group.bl_rna.properties, row.name
        assert not row.switched or row.switch in group.bl_rna.properties
        tooltip = group.bl_rna.properties[row.name].description
        assert not any(mark in tooltip for mark in ("::", "](", "[`", "```")), tooltip


def plants_group(maker):
    plant = bpy.data.objects.new("x", bpy.data.meshes.new("x"))
    plant.burgeon.maker = maker
    return plant.burgeon


def test_every_field_of_how_a_plant_is_meshed_has_a_row():
    shown = {name for names in settings.SURFACE.values() for name in names}
    # Of what changes from day to day; the program sets it.
    assert set(bg.schema("skin")["properties"]) - shown == {"steady_m"}
    assert shown <= set(settings.BURGEON_plant.__annotations__)


class Drawn:
    """A layout that looks whether there is what it is asked to show."""

    def __init__(self, seen):
        self.seen = seen

    def row(self, **_):
        return Drawn(self.seen)

    column = box = row

    def panel(self, _name, **_how):
        return Drawn(self.seen), Drawn(self.seen)

    def label(self, **how):
        assert how["text"]

    def prop(self, group, name, **_):
        assert name in group.bl_rna.properties, name
        self.seen.append(name)

    def operator(self, name, **_):
        assert hasattr(bpy.ops.burgeon, name.split(".")[1])
        self.seen.append(name)
        return type("Properties", (), {})()


@pytest.mark.parametrize("operator, how", [("add_tree", SMALL), ("add_flower", {"species": "lily"}), ("add_leaf", {})])
def test_the_panel_shows_what_there_is(operator, how):
    getattr(bpy.ops.burgeon, operator)(**how)
    seen = []
    panel.draw_plant(Drawn(seen), active())
    own = active().burgeon
    rows = panel.shown(fields.rows(own.maker), settings.base(own))
    assert {row.name for row in rows if not row.item} <= set(seen)
    lists = [row for row in rows if row.item]
    assert seen.count("burgeon.add_item") >= len(lists)
    if operator == "add_flower":
        assert seen.count("burgeon.remove_item") >= len(own.flower.whorls) >= 2 and "insertion__height_m" in seen


def test_a_table_of_another_kind_has_the_fields_of_that_kind():
    bpy.ops.burgeon.add_tree(**SMALL)
    own = active().burgeon
    own.tree.method, own.tree.use__years, own.tree.use__age = "competition", False, False
    own.tree.method__points = 60
    for word in ("colonization", "competition"):
        own.tree.method = word
        asked = settings.asked(own)["method"]
        assert asked["kind"] == word and asked["points"] == 60 and settings.base(own)["method"] == asked
        plants.catch_up()
        assert own.fault == "" and not plants.is_stale(active()), word
    names = {row.name for row in panel.shown(fields.rows("tree"), settings.base(own))}
    assert {"method__attraction_m", "method__envelope"} <= names and "method__rules" not in names
    # What is not yet whole is refused by name, and the plant stays.
    before = len(active().data.vertices)
    own.tree.method = "lsystem"
    plants.catch_up()
    assert "there is no axiom" in own.fault and len(active().data.vertices) == before
    path = json.dumps(["method", "rules"])
    own.tree.method__rules[0].value = "axiom: F"
    assert settings.asked(own)["method"]["rules"] == "axiom: F"
    bpy.ops.burgeon.add_item(path=path)
    own.tree.method__rules[1].value = "F -> F"
    assert settings.asked(own)["method"]["rules"] == "axiom: F\nF -> F"


def test_crowns_of_every_shape_are_set():
    bpy.ops.burgeon.add_tree(**SMALL)
    own = active().burgeon
    own.tree.method, own.tree.use__years, own.tree.use__age = "competition", False, False
    own.tree.method__points = 60
    own.tree.method__envelope = "sphere"
    for word in ("ellipsoid", "cone", "cylinder", "sphere"):
        own.tree.method__envelope = word
        plants.catch_up()
        assert own.fault == "" and settings.asked(own)["method"]["envelope"]["shape"] == word
    own.tree.method__envelope = "revolution"
    plants.catch_up()
    assert "profile" in own.fault
    for radius, height in ((0.5, 1.0), (2.0, 3.0), (0.0, 5.0)):
        bpy.ops.burgeon.add_item(path=json.dumps(["method", "envelope", "profile"]))
        own.tree.method__envelope__profile[-1].value = (radius, height)
    plants.catch_up()
    assert own.fault == ""
    assert settings.asked(own)["method"]["envelope"]["profile"] == [[0.5, 1.0], [2.0, 3.0], [0.0, 5.0]]
    # A crown that may be left out is switched on and off by its kind.
    own.tree.method__first_envelope = "sphere"
    plants.catch_up()
    assert own.fault == "" and settings.asked(own)["method"]["first_envelope"]["shape"] == "sphere"
    own.tree.method__first_envelope = settings.NONE
    assert settings.asked(own)["method"]["first_envelope"] is None


def test_lists_take_rows_and_give_them_back():
    bpy.ops.burgeon.add_tree(**SMALL)
    tree = active()
    assert bpy.ops.burgeon.add_item(path='["obstacles"]') == {"FINISHED"}
    assert tree.burgeon.tree.obstacles[0].value == "box"
    tree.burgeon.tree.obstacles[0].value = "sphere"
    tree.burgeon.tree.obstacles[0].value__centre = (0.5, 0.5, 0.0)
    tree.burgeon.tree.obstacles[0].value__radius_m = 0.25
    bpy.ops.burgeon.add_item(path='["roots"]')
    tree.burgeon.tree.roots[-1].value = (1.5, 0.0, 0.0)
    roots = small().spec["roots"]
    plants.catch_up()
    ball = {"shape": "sphere", "centre": [0.5, 0.5, 0.0], "radius_m": 0.25}
    assert tree.burgeon.fault == "" and same(tree, small(obstacles=[ball], roots=[*roots, [1.5, 0, 0]]))
    bpy.ops.burgeon.remove_item(path='["obstacles"]', index=0)
    bpy.ops.burgeon.remove_item(path='["roots"]', index=len(roots))
    plants.catch_up()
    assert same(tree, small()) and settings.asked(tree.burgeon) == small().spec
    with pytest.raises(RuntimeError, match=rf"^Error: there is no row 31 in a list of {len(roots)}"):
        bpy.ops.burgeon.remove_item(path='["roots"]', index=30)
    with pytest.raises(RuntimeError, match=r"^Error: there is no list"):
        bpy.ops.burgeon.add_item(path='["leaves"]')
    for _ in range(settings.MOST_ITEMS - len(roots)):
        bpy.ops.burgeon.add_item(path='["roots"]')
    with pytest.raises(RuntimeError, match=r"^Error: the panel shows lists of up to 64 rows"):
        bpy.ops.burgeon.add_item(path='["roots"]')


def test_a_list_within_a_list_is_set():
    bpy.ops.burgeon.add_tree(**SMALL)
    own = active().burgeon
    own.tree.method = "guided"
    bpy.ops.burgeon.add_item(path='["method", "changes"]')
    change = own.tree.method__changes[0]
    assert not change.use__tropisms
    change.use__tropisms, change.round = True, 2
    bpy.ops.burgeon.add_item(path='["method", "changes", 0, "tropisms"]')
    own.tree.method__changes[0].tropisms[0].direction = (0.0, -1.0, 0.0)
    (asked,) = settings.asked(own)["method"]["changes"]
    assert asked["round"] == 2 and asked["tropisms"][0]["direction"] == [0.0, -1.0, 0.0]
    own.tree.use__years = False
    plants.catch_up()
    assert own.fault == ""


def test_long_lists_stay_as_they_are():
    plant = bpy.data.objects.new("x", bpy.data.meshes.new("x"))
    plant.burgeon.maker = "tree"
    points = [[0.01 * k, 1.0, 0.0] for k in range(settings.MOST_ITEMS + 1)]
    spec = bg.grow({"method": {"kind": "points", "points": points}}, age=1, textures=False, detail=0.1).spec
    settings.fill(plant.burgeon, spec)
    assert settings.asked(plant.burgeon) == spec and not plant.burgeon.tree.method__points__of_points


def _listed():
    bpy.ops.burgeon.add_tree("EXEC_DEFAULT", True, **SMALL)
    bpy.ops.burgeon.add_item("EXEC_DEFAULT", True, path='["roots"]')


def _waiting():
    bpy.ops.burgeon.add_tree("EXEC_DEFAULT", True, **SMALL)
    active().burgeon.live = False
    active().burgeon.tree.age = 6
    bpy.ops.ed.undo_push(message="age")


def asked_there():
    return there(), [json.dumps(settings.asked(o.burgeon)) for o in bpy.data.objects if plants.is_plant(o)]


@pytest.mark.parametrize(
    "before, name, how",
    [
        (_listed, "add_item", {"path": '["roots"]'}),
        (_listed, "remove_item", {"path": '["roots"]', "index": 0}),
        (_waiting, "update", {}),
    ],
)
def test_what_an_operator_of_settings_does_is_undone_and_done_again(before, name, how):
    bpy.ops.ed.undo_push(message="start")
    before()
    first = asked_there()
    assert getattr(bpy.ops.burgeon, name)("EXEC_DEFAULT", True, **how) == {"FINISHED"}
    then = asked_there()
    assert then != first
    bpy.ops.ed.undo()
    assert asked_there() == first
    bpy.ops.ed.redo()
    assert asked_there() == then


def test_undo_of_another_kind_of_table_brings_its_fields_back():
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.burgeon.add_tree("EXEC_DEFAULT", True, **SMALL)
    before = settings.asked(active().burgeon)
    active().burgeon.tree.method = "guided"
    bpy.ops.ed.undo_push(message="method")
    bpy.ops.ed.undo()
    assert settings.asked(bpy.data.objects["hazel"].burgeon) == before
    bpy.ops.ed.redo()
    assert settings.asked(bpy.data.objects["hazel"].burgeon)["method"]["kind"] == "guided"
