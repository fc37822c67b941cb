"""Plants from the panel: meshes, settings, undo, flowers, wind, forests, projects."""

import bpy
import numpy as np
import pytest

import burgeon as bg
from burgeon_plants import meshes, opening, panel, plants, settings, wind
from conftest import ROOT

SMALL = {"species": "hazel", "seed": 3, "age": 4, "detail": 0.2}


def active():
    return bpy.context.view_layer.objects.active


def small(**fields):
    return bg.grow("hazel", **{"seed": 3, "age": 4, "detail": 0.2, "wind": True, **fields})


def points(mesh):
    out = np.zeros(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", out)
    return out.reshape(-1, 3)


def evaluated(plant):
    """The vertices of an object after its shape keys and modifiers."""
    graph = bpy.context.evaluated_depsgraph_get()
    return points(plant.evaluated_get(graph).data)


def same(plant, made):
    """Whether a mesh is that of a model, vertex by vertex."""
    return np.array_equal(points(plant.data), meshes.points_of(made.model))


def test_a_tree_is_that_of_the_package():
    assert bpy.ops.burgeon.add_tree(**SMALL) == {"FINISHED"}
    tree, made = active(), small()
    assert same(tree, made) and len(tree.data.polygons) == made.model.triangle_count
    # Metres, upright, on the ground.
    assert points(tree.data)[:, 2].max() == pytest.approx(made.model.vertices[:, 1].max())
    assert abs(points(tree.data)[:, 2].min()) < 0.05
    assert not tree.data.validate()
    assert tree.location[:] == (0, 0, 0)


def test_texture_coordinates_normals_and_tints_are_those_of_the_model():
    bpy.ops.burgeon.add_tree(**SMALL)
    mesh = active().data
    uvs = np.zeros(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].uv.foreach_get("vector", uvs)
    normals = np.array([corner.vector for corner in mesh.corner_normals])
    corners = np.zeros(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    tints = np.zeros(4 * len(mesh.vertices), np.float32)
    mesh.color_attributes["tint"].data.foreach_get("color", tints)
    vertex, loop = 0, 0
    for part in meshes.parts_of(small().model):
        here = slice(loop, loop + part.faces.size)
        rows = corners[here] - vertex
        assert np.array_equal(rows, part.faces.reshape(-1))
        assert np.allclose(uvs.reshape(-1, 2)[here], np.column_stack([part.uvs[rows, 0], 1 - part.uvs[rows, 1]]), atol=1e-6)
        wanted = meshes.turned(part.normals)[rows]
        along = (normals[here] * wanted).sum(axis=1)
        assert np.quantile(along, 0.001) > 0.99, part.name
        if len(part.colors):
            assert np.allclose(tints.reshape(-1, 4)[vertex : vertex + len(part.vertices), :3], part.colors, atol=1e-6)
        vertex, loop = vertex + len(part.vertices), loop + part.faces.size
    assert vertex == len(mesh.vertices)


def test_materials_have_the_pictures_of_the_model():
    bpy.ops.burgeon.add_tree(**SMALL)
    mesh, parts = active().data, meshes.parts_of(small().model)
    assert [slot.name for slot in mesh.materials] == [part.material["name"] for part in parts]
    for slot, part in zip(mesh.materials, parts, strict=True):
        shown = {node.label: node.image for node in slot.node_tree.nodes if node.type == "TEX_IMAGE"}
        wanted = {"texture": part.texture, **{k: v for k, v in part.maps.items() if k != "height"}}
        assert set(shown) == {name for name, pixels in wanted.items() if pixels is not None}
        for name, image in shown.items():
            assert tuple(image.size) == (wanted[name].shape[1], wanted[name].shape[0]) and image.packed_file
            got = np.zeros(wanted[name].size, np.float32)
            image.pixels.foreach_get(got)
            assert np.array_equal(np.rint(got.reshape(wanted[name].shape)[::-1] * 255), wanted[name]), name
        kinds = {node.type for node in slot.node_tree.nodes}
        assert ("BSDF_TRANSLUCENT" in kinds) == (part.material["translucency"] > 0)
        assert ("BSDF_TRANSPARENT" in kinds) == part.material["cut_out"]
    leaf = next(m for m in mesh.materials if m.name == "leaf")
    assert "BSDF_TRANSLUCENT" in {node.type for node in leaf.node_tree.nodes}
    assert not leaf.use_backface_culling


def test_plants_that_look_alike_share_their_materials_and_old_ones_go():
    bpy.ops.burgeon.add_tree(**SMALL)
    first = active()
    bpy.ops.burgeon.add_tree(**{**SMALL, "age": 3})
    second = active()
    shared = set(first.data.materials) & set(second.data.materials)
    assert len(shared) >= 2
    before = len(bpy.data.materials)
    second.burgeon.tree.look__leaf_color = (0.8, 0.1, 0.1)
    plants.catch_up()
    second.burgeon.tree.look__leaf_color = (0.1, 0.1, 0.8)
    plants.catch_up()
    assert set(first.data.materials) >= shared - {m for m in shared if m.name.startswith("leaf")}
    assert len(bpy.data.materials) <= before + 1
    assert all(m.users for m in bpy.data.materials)


def test_settings_are_those_of_the_schema():
    bpy.ops.burgeon.add_tree(**SMALL)
    own = active().burgeon
    age = own.tree.bl_rna.properties["age"]
    field = bg.schema("tree")["properties"]["age"]
    assert own.tree.age == 4 and own.tree.use__age
    assert age.hard_min == field["minimum"] and age.description.startswith(field["description"][:20])
    topics = dict(panel.topics(own))
    assert {"general", "leaves", "look", "wood", "variation", "method", "blossom", "blade"} <= set(topics)
    # Every number, truth, word and colour of the spec has a row.
    shown, spec = {row.path for rows in topics.values() for row in rows}, settings.base(own)
    for table in ("leaves", "look", "wood", "variation", "blossom"):
        for name, value in spec[table].items():
            if isinstance(value, (int, float, bool, str)):
                assert (table, name) in shown, name
    assert own.tree.look__bark == spec["look"]["bark"]
    assert own.tree.leaves__length_m == pytest.approx(spec["leaves"]["length_m"])


@pytest.mark.parametrize("maker", settings.MAKERS)
def test_properties_that_nobody_changed_ask_for_what_was_there(maker):
    made = {"tree": ["add_tree"], "flower": ["add_flower"], "leaf": ["add_leaf"], "sketch": ["add_leaf"]}[maker]
    words = {"tree": bg.presets()[0], "flower": bg.presets()[1]}.get(maker, [None])
    for word in words:
        plant = bpy.data.objects.new("x", bpy.data.meshes.new("x"))
        plant.burgeon.maker = maker
        spec = {"tree": bg.grow, "flower": bg.bloom}[maker](word, **FEW.get(maker, {})).spec if word else DRAWN[maker]()
        settings.fill(plant.burgeon, spec)
        assert settings.asked(plant.burgeon) == spec, (word, made)
    assert not plants.waiting


FEW = {"tree": {"age": 1, "textures": False, "detail": 0.1}}
DRAWN = {
    "leaf": lambda: bg.leaf().spec,
    "sketch": lambda: bg.sketch([[(0.1 * k % 0.3, float(k)) for k in range(20)]]).spec,
}


def test_a_change_of_settings_is_made_once_after_a_moment():
    bpy.ops.burgeon.add_tree(**SMALL)
    tree = active()
    before = len(tree.data.polygons)
    asked, make = [], plants.make
    plants.make = lambda plant: asked.append(plant.name) or make(plant)
    try:
        for age in (5, 6, 7, 6):
            tree.burgeon.tree.age = age
        tree.burgeon.tree.leaves__leaf_keep = 0.5
        assert plants.waiting == {tree.name} and bpy.app.timers.is_registered(plants.catch_up)
        assert len(tree.data.polygons) == before and not asked
        plants.catch_up()
        assert asked == [tree.name] and not plants.waiting
        plants.catch_up()
        assert asked == [tree.name]
    finally:
        plants.make = make
    assert same(tree, small(age=6, leaves={"leaf_keep": 0.5}))
    tree.burgeon.seed = 8
    plants.catch_up()
    assert same(tree, small(age=6, seed=8, leaves={"leaf_keep": 0.5}))
    # Not live: only when it is asked for.
    tree.burgeon.live = False
    tree.burgeon.seed = 9
    plants.catch_up()
    assert same(tree, small(age=6, seed=8, leaves={"leaf_keep": 0.5}))
    assert bpy.ops.burgeon.update() == {"FINISHED"}
    assert same(tree, small(age=6, seed=9, leaves={"leaf_keep": 0.5}))


def test_a_mesh_that_a_person_edits_waits():
    bpy.ops.burgeon.add_tree(**SMALL)
    tree = active()
    bpy.ops.object.mode_set(mode="EDIT")
    tree.burgeon.tree.age = 5
    assert plants.catch_up() == plants.WAIT_S and plants.waiting
    bpy.ops.object.mode_set(mode="OBJECT")
    assert plants.catch_up() is None
    assert same(tree, small(age=5))


def test_objects_that_show_one_mesh_do_not_change_each_other():
    bpy.ops.burgeon.add_tree(**SMALL)
    tree = active()
    twin = tree.copy()
    bpy.context.collection.objects.link(twin)
    twin.burgeon.seed = 5
    plants.catch_up()
    assert same(tree, small()) and same(twin, small(seed=5))


def test_what_is_refused_is_reported_and_changes_nothing():
    bpy.ops.burgeon.add_tree(species="hazel", seed=3, detail=0.2)
    tree, grown = active(), bg.grow("hazel", seed=3, detail=0.2, wind=True)
    counts = [len(block) for block in (bpy.data.objects, bpy.data.meshes, bpy.data.materials)]
    # More leaves than may be: the core says how many.
    spacing = tree.burgeon.tree.leaves__spacing_m
    tree.burgeon.tree.leaves__spacing_m = 0.0001
    with pytest.raises(RuntimeError, match="^Error: .*leaves.spacing_m"):
        bpy.ops.burgeon.update()
    assert same(tree, grown)
    plants.catch_up()
    assert "leaves" in tree.burgeon.fault and same(tree, grown)
    tree.burgeon.tree.leaves__spacing_m = spacing
    plants.catch_up()
    assert tree.burgeon.fault == ""
    with pytest.raises(RuntimeError, match="^Error: .*spacing"):
        bpy.ops.burgeon.add_forest(species="hazel", width=1000, depth=1000, spacing=0.05)
    with pytest.raises(RuntimeError, match="^Error: there are no strokes"):
        bpy.ops.burgeon.from_strokes()
    for name in ("none.burgeon", "version-5.txt"):
        with pytest.raises(RuntimeError, match="^Error: "):
            bpy.ops.burgeon.import_project(filepath=str(ROOT / "fixtures/projects" / name))
    with pytest.raises(RuntimeError, match="^Error: "):
        bpy.ops.burgeon.import_project(filepath=str(ROOT / "README.md"))
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="^Error: no plant is selected"):
        bpy.ops.burgeon.wind()
    assert counts == [len(block) for block in (bpy.data.objects, bpy.data.meshes, bpy.data.materials)]


@pytest.mark.parametrize("species", bg.presets()[1])
def test_a_flower_opens_by_shape_keys_with_keyframes(species):
    bpy.ops.burgeon.add_flower(species=species, seed=2)
    flower = active()
    made = bg.bloom(species, seed=2, wind=True)
    low, high = made.days
    assert bpy.ops.burgeon.open_over_time(shapes=3, first=1, last=41) == {"FINISHED"}
    keys = flower.data.shape_keys
    assert len(keys.key_blocks) == 4
    for frame, day in ((1, 0.0), (21, (low + high) / 2), (41, low + high)):
        bpy.context.scene.frame_set(frame)
        wanted = meshes.points_of(made.at(day).model)
        assert np.allclose(evaluated(flower), wanted, atol=1e-5), frame
    bpy.context.scene.frame_set(11)
    between = (meshes.points_of(made.at(0.0).model) + meshes.points_of(made.at((low + high) / 2).model)) / 2
    assert np.allclose(evaluated(flower), between, atol=1e-5)


def test_a_flower_that_opens_follows_its_settings():
    bpy.ops.burgeon.add_flower(species="tulip", seed=2)
    flower = active()
    with pytest.raises(RuntimeError, match="the last frame must come after the first"):
        bpy.ops.burgeon.open_over_time(first=10, last=10)
    bpy.ops.burgeon.open_over_time(shapes=3, first=1, last=41)
    flower.burgeon.flower.stalk_m = 0.5
    plants.catch_up()
    assert len(flower.data.shape_keys.key_blocks) == 4 and flower.burgeon.fault == ""
    assert len(opening.curves(flower.data.shape_keys)) == 3
    bpy.context.scene.frame_set(41)
    last = bg.bloom("tulip", seed=2, wind=True, stalk_m=0.5)
    last = last.at(sum(last.days))
    assert np.allclose(evaluated(flower), meshes.points_of(last.model), atol=1e-5)
    assert bpy.ops.burgeon.close() == {"FINISHED"}
    assert flower.data.shape_keys is None
    flower.burgeon.day = 0.0
    plants.catch_up()
    assert same(flower, bg.bloom("tulip", 0.0, seed=2, wind=True, stalk_m=0.5))


def blown(points, wind, pivot, gust, time):
    """The shader of docs/exports.md, in its own axes."""
    tau, gust = 6.2832, np.array(gust)
    moved = points + gust * (wind[:, :1] * (0.6 + 0.4 * np.sin(1.1 * time)))
    moved = moved + gust * wind[:, 1:2] * np.sin(2.3 * time + tau * wind[:, 3:])
    own = wind[:, 3] + pivot @ np.array([7.1, 5.3, 3.7])
    turn = np.cross([0.60, 0.64, 0.48], points - pivot)
    return moved + turn * (0.25 * wind[:, 2] * np.sin(9.0 * time + tau * own))[:, None]


def test_wind_moves_a_tree_as_the_shader_of_the_docs_does():
    bpy.ops.burgeon.add_tree(**SMALL)
    tree, model = active(), small().model
    assert bpy.ops.burgeon.wind(gust=0.1) == {"FINISHED"}
    gust = 0.1 * tree.dimensions.z
    columns = [np.concatenate([getattr(p, name) for p in meshes.parts_of(model)]) for name in ("vertices", "wind", "pivots")]
    rate = bpy.context.scene.render.fps
    for frame in (0, 7, 40):
        bpy.context.scene.frame_set(frame)
        wanted = meshes.turned(blown(*(c.astype(float) for c in columns), (gust, 0, 0), frame / rate))
        got = evaluated(tree)
        # Sines of large numbers in single precision.
        assert np.abs(got - wanted).max() < 2e-3 and np.abs(got - points(tree.data)).max() > 0.02
    # Once more: the same modifier, now still.
    assert bpy.ops.burgeon.wind(gust=0.0) == {"FINISHED"} and len(tree.modifiers) == 1
    tree.modifiers[wind.MODIFIER][wind._identifier(wind.group(), "Strength")] = 0.0
    tree.update_tag()
    assert np.allclose(evaluated(tree), points(tree.data), atol=1e-6)


def test_a_forest_is_instances_of_a_few_meshes_and_moves():
    args = {"width": 40.0, "depth": 30.0, "spacing": 3.5, "kinds": 3, "detail": 0.1, "textures": False}
    assert bpy.ops.burgeon.add_forest(species="hazel", seed=4, age=3, **args) == {"FINISHED"}
    collection = bpy.data.collections["hazel forest"]
    wanted = bg.grove("hazel", (40.0, 30.0), spacing=3.5, kinds=3, seed=4, age=3, detail=0.1, textures=False)
    assert len(collection.objects) == len(wanted) >= 50 and len(bpy.data.meshes) == len(wanted.plants) <= 3
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    seen = [tuple(one.matrix_world.translation) for one in graph.object_instances if one.is_instance]
    x, y, z = wanted.places["position"].T
    assert np.allclose(np.array(seen), np.column_stack([x, -z, y]), atol=1e-4)
    for one in collection.objects:
        one.select_set(True)
    assert bpy.ops.burgeon.wind(gust=0.1) == {"FINISHED"}
    held = collection.objects[0].instance_collection.objects[0]
    assert held.modifiers[wind.MODIFIER].node_group == wind.group()


def test_projects_are_imported_where_their_plants_stand():
    for path in sorted((ROOT / "fixtures/projects").glob("*.burgeon"))[-2:]:
        assert bpy.ops.burgeon.import_project(filepath=str(path)) == {"FINISHED"}
        there = bg.open(path, wind=True)
        collection = bpy.data.collections[path.stem]
        assert len(collection.objects) == len(there)
        for plant, one in zip(there, sorted(collection.objects, key=lambda o: list(collection.objects).index(o)), strict=True):
            (x, y, z), yaw, scale = plant.place
            assert same(one, plant) and one.location[:] == pytest.approx((x, -z, y))
            assert one.rotation_euler.z == pytest.approx(np.radians(yaw)) and one.scale.x == pytest.approx(scale)


@pytest.mark.parametrize("version", [3, 5])
def test_plants_of_projects_have_their_settings(version):
    path = ROOT / f"fixtures/projects/version-{version}.burgeon"
    bpy.ops.burgeon.import_project(filepath=str(path))
    there = bg.open(path, wind=True)
    for plant in there:
        one = bpy.data.objects[plant.name]
        assert plants.is_plant(one) and not plants.is_stale(one) and one.burgeon.maker == plant.maker
        assert settings.asked(one.burgeon) == plant.spec
        assert {topic for topic, _ in panel.topics(one.burgeon)}
        one.burgeon.seed = 77
    assert plants.catch_up() is None
    for plant in there:
        one = bpy.data.objects[plant.name]
        assert one.burgeon.fault == "" and same(one, plant.again(seed=77))
        one.burgeon.seed = min(plant.seed, settings.MOST_WHOLE)
    plants.catch_up()
    assert all(same(bpy.data.objects[plant.name], plant) for plant in there)
    lily = next((p for p in there if p.maker == "flower"), None)
    if lily:
        one = bpy.data.objects[lily.name]
        one.burgeon.day, one.burgeon.flower.stalk_m = 1.5, 0.5
        plants.catch_up()
        assert same(one, lily.again(day=1.5, stalk_m=0.5))
        bpy.context.view_layer.objects.active = one
        assert bpy.ops.burgeon.open_over_time(shapes=3, first=1, last=41) == {"FINISHED"}
        bpy.context.scene.frame_set(1)
        assert np.allclose(evaluated(one), meshes.points_of(lily.again(day=0.0, stalk_m=0.5).model), atol=1e-5)


def test_plants_of_projects_keep_what_was_done_by_hand(tmp_path):
    tree = bg.grow("hazel", seed=2**40 + 5, age=4, detail=0.3)
    cut = tree.shape([{"op": "prune", "axis": {"path": tree.branches(1)[1]["path"]}, "at": 0.3}])
    cut.save(tmp_path / "cut.burgeon")
    bpy.ops.burgeon.import_project(filepath=str(tmp_path / "cut.burgeon"))
    (one,) = bpy.data.collections["cut"].objects
    assert same(one, cut.again(wind=True)) and one.burgeon.tree.age == 4
    one.burgeon.tree.leaves__leaf_keep = 0.5
    one.burgeon.detail = 0.2
    plants.catch_up()
    wanted = cut.again(wind=True, detail=0.2, **settings.asked(one.burgeon))
    assert one.burgeon.fault == "" and same(one, wanted) and wanted.report["edits"][0]["done"] and wanted.seed == 2**40 + 5
    # It is in the file: the project may go from the disk.
    (tmp_path / "cut.burgeon").unlink()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "x.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "x.blend"))
    plants.kept.clear()
    one = next(o for o in bpy.data.objects if plants.is_plant(o))
    one.burgeon.seed = 3
    plants.catch_up()
    assert same(one, wanted.again(seed=3))
    bpy.data.texts.remove(one.burgeon.project)
    plants.kept.clear()
    one.burgeon.seed = 4
    plants.catch_up()
    assert "no longer in this file" in one.burgeon.fault and same(one, wanted.again(seed=3))


def test_fifty_plants_in_one_scene():
    for seed in range(50):
        assert bpy.ops.burgeon.add_tree(species="grass", seed=seed, detail=0.1) == {"FINISHED"}
        active().location.x = seed
    there = [o for o in bpy.data.objects if plants.is_plant(o)]
    assert len(there) == 50 and len({len(o.data.vertices) for o in there}) > 10
    for one in there:
        one.burgeon.detail = 0.2
    plants.catch_up()
    assert not any(plants.is_stale(one) for one in there)
    # What all share is there once.
    assert len(bpy.data.materials) < 20


def test_each_operator_is_one_step_of_undo():
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.burgeon.add_tree("EXEC_DEFAULT", True, **SMALL)
    bpy.ops.burgeon.add_leaf("EXEC_DEFAULT", True)
    assert sum(plants.is_plant(o) for o in bpy.data.objects) == 2
    bpy.ops.ed.undo()
    assert [o.name for o in bpy.data.objects if plants.is_plant(o)] == ["hazel"]
    assert same(bpy.data.objects["hazel"], small())
    bpy.ops.ed.undo()
    assert not bpy.data.objects
    bpy.ops.ed.redo()
    assert same(bpy.data.objects["hazel"], small())


def there():
    """All that a file holds of plants, in words that can be compared."""
    plain = [o for o in bpy.data.objects if o.type == "MESH"]
    return (
        sorted((o.name, len(o.data.vertices), o.burgeon.maker, o.burgeon.opens, len(o.modifiers)) for o in plain),
        sorted((o.name, bool(o.data.shape_keys)) for o in plain),
        sorted(c.name for c in bpy.data.collections),
        len(bpy.data.objects),
    )


def _drawn():
    bpy.ops.burgeon.add_tree("EXEC_DEFAULT", True, **SMALL)


def _opened():
    bpy.ops.burgeon.add_flower("EXEC_DEFAULT", True, species="tulip")


def _opening():
    _opened()
    bpy.ops.burgeon.open_over_time("EXEC_DEFAULT", True, shapes=2, first=1, last=9)


PROJECT = str(ROOT / "fixtures/projects/version-5.burgeon")


@pytest.mark.parametrize(
    "before, name, how",
    [
        (None, "add_flower", {"species": "tulip"}),
        (None, "add_leaf", {}),
        (None, "add_forest", {"species": "grass", "width": 6, "depth": 6, "spacing": 2, "kinds": 1, "detail": 0.1}),
        (None, "import_project", {"filepath": PROJECT}),
        (_drawn, "wind", {"gust": 0.1}),
        (_opened, "open_over_time", {"shapes": 2, "first": 1, "last": 9}),
        (_opening, "close", {}),
    ],
)
def test_what_an_operator_does_is_undone_and_done_again(before, name, how):
    bpy.ops.ed.undo_push(message="start")
    if before:
        before()
    first = there()
    assert getattr(bpy.ops.burgeon, name)("EXEC_DEFAULT", True, **how) == {"FINISHED"}
    then = there()
    assert then != first
    bpy.ops.ed.undo()
    assert there() == first
    bpy.ops.ed.redo()
    assert there() == then


def test_another_species_brings_settings_of_its_own():
    bpy.ops.burgeon.add_tree(**SMALL)
    tree = active()
    tree.burgeon.species = "grass"
    plants.catch_up()
    wanted = bg.grow("grass", seed=3, detail=0.2, wind=True)
    assert tree.burgeon.fault == "" and same(tree, wanted)
    assert settings.asked(tree.burgeon) == wanted.spec and not plants.is_stale(tree)
    tree.burgeon.tree.leaves__leaf_keep = 0.5
    plants.catch_up()
    assert same(tree, bg.grow("grass", seed=3, detail=0.2, wind=True, leaves={"leaf_keep": 0.5}))
    # What there is not leaves the plant as it is, and is told with what is meant.
    tree.burgeon.species = "hazle"
    plants.catch_up()
    assert "is `hazel` meant?" in tree.burgeon.fault and panel.topics(tree.burgeon) == []
    tree.burgeon.species = "hazel"
    plants.catch_up()
    assert tree.burgeon.fault == "" and same(tree, bg.grow("hazel", seed=3, detail=0.2, wind=True))
    bpy.ops.burgeon.add_flower(species="tulip", seed=2)
    flower = active()
    flower.burgeon.species = "lily"
    plants.catch_up()
    made = bg.bloom("lily", seed=2, wind=True)
    assert same(flower, made) and flower.burgeon.day == pytest.approx(made.days[0])


def test_the_surface_of_trees_and_drawings_can_be_set():
    bpy.ops.burgeon.add_tree(**SMALL)
    tree = active()
    assert panel.surface(tree.burgeon) == ("detail", "sides", "textures", "texture_size", "foliage")
    tree.burgeon.sides, tree.burgeon.foliage, tree.burgeon.texture_size = 4, "cards", 64
    plants.catch_up()
    assert same(tree, small(sides=4, foliage="cards", texture_size=64))
    sizes = {tuple(n.image.size) for m in tree.data.materials for n in m.node_tree.nodes if n.type == "TEX_IMAGE"}
    assert (64, 64) in sizes and (512, 512) not in sizes
    tree.burgeon.textures = False
    plants.catch_up()
    assert same(tree, small(sides=4, foliage="cards", textures=False))
    assert not any(n.type == "TEX_IMAGE" for m in tree.data.materials for n in m.node_tree.nodes)
    bpy.ops.burgeon.add_leaf()
    assert panel.surface(active().burgeon) == ()


def test_undo_of_a_setting_brings_the_mesh_back_and_redo_the_new_one():
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.burgeon.add_tree("EXEC_DEFAULT", True, **SMALL)
    active().burgeon.tree.age = 6
    # As Blender does when a person changes a property: the step holds the mesh from before.
    bpy.ops.ed.undo_push(message="age")
    plants.catch_up()
    assert same(active(), small(age=6))
    bpy.ops.ed.undo()
    plants.catch_up()
    tree = bpy.data.objects["hazel"]
    assert tree.burgeon.tree.age == 4 and same(tree, small())
    bpy.ops.ed.redo()
    plants.catch_up()
    tree = bpy.data.objects["hazel"]
    assert tree.burgeon.tree.age == 6 and same(tree, small(age=6))


def test_it_is_saved_and_opened_again(tmp_path):
    bpy.ops.burgeon.add_tree(**SMALL)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "x.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "x.blend"))
    tree = next(o for o in bpy.data.objects if plants.is_plant(o))
    assert same(tree, small()) and tree.burgeon.tree.age == 4 and not plants.is_stale(tree)
    tree.burgeon.tree.age = 5
    plants.catch_up()
    assert same(tree, small(age=5))
