"""What a person asks for: each is one step of undo."""

import json
import math
import os

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Operator
from mathutils import Matrix

import burgeon as bg

from . import meshes, opening, plants, settings, strokes, wind


def _species(words):
    return EnumProperty(name="Species", items=[(word, word.replace("-", " ").capitalize(), "") for word in words])


TREES, FLOWERS = bg.presets()


def _seed():
    return IntProperty(name="Seed", description="What all chance follows from", default=1, min=0)


def _detail(default=1.0):
    return FloatProperty(name="Detail", description="Fineness of the meshes", default=default, min=0.1, max=8.0)


class Refusing(Operator):
    """Tells what the core refuses, and changes nothing."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT"

    def execute(self, context):
        try:
            return self.do(context) or {"FINISHED"}
        except plants.FAULTS as error:
            self.report({"ERROR"}, str(error) or type(error).__name__)
            return {"CANCELLED"}


class OfPlant(Refusing):
    """Of the active object, which is a plant."""

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and plants.is_plant(context.active_object)


class BURGEON_OT_add_tree(Refusing):
    """Add a tree that grows by competition for space and light"""

    bl_idname, bl_label = "burgeon.add_tree", "Tree"

    species: _species(TREES)
    seed: _seed()
    age: IntProperty(name="Age", description="Years or rounds of growth; 0 for that of the species", default=0, min=0, max=5000)
    detail: _detail()

    def do(self, context):
        fields = {"age": self.age} if self.age else {}
        plant = plants.add(context, self.species, "tree", self.species, self.seed, self.detail, fields=fields)
        _place(context, plant)


class BURGEON_OT_add_flower(Refusing):
    """Add a flower that opens; its day is one of its settings"""

    bl_idname, bl_label = "burgeon.add_flower", "Flower"

    species: _species(FLOWERS)
    seed: _seed()

    def do(self, context):
        _place(context, plants.add(context, self.species, "flower", self.species, self.seed))


class BURGEON_OT_add_leaf(Refusing):
    """Add a leaf of numbers"""

    bl_idname, bl_label = "burgeon.add_leaf", "Leaf"

    seed: _seed()

    def do(self, context):
        _place(context, plants.add(context, "leaf", "leaf", seed=self.seed))


class BURGEON_OT_from_strokes(Refusing):
    """Make a plant of the strokes of the active grease pencil object, or of the annotation. Its front view is the drawing"""

    bl_idname, bl_label = "burgeon.from_strokes", "From Strokes"

    seed: _seed()
    detail: _detail()

    def do(self, context):
        drawn = strokes.of_context(context)
        if not drawn:
            raise ValueError("there are no strokes: draw with the annotation tool, or on a grease pencil object and select it")
        lines, sheet = strokes.flat(drawn)
        # Once to see how its height is measured, then so that a metre drawn is a metre.
        text = json.dumps([line.tolist() for line in lines])
        first = plants.grown("sketch", "", self.seed, {"detail": 0.1, "textures": False}, None, text, {})
        fields = {"height_m": first.measures()["height_m"] / first.front[0]}
        plant = plants.add(context, "drawing", "sketch", "", self.seed, self.detail, text, fields)
        x, y = first.front[1]
        plant.matrix_world = Matrix(sheet.tolist()) @ Matrix.Translation((x, 0.0, y))
        _choose(context, plant)


class BURGEON_OT_update(OfPlant):
    """Make the plant anew of its settings"""

    bl_idname, bl_label = "burgeon.update", "Update"

    def do(self, context):
        plants.update(context.active_object)


class OfList(OfPlant):
    """Of a list among the settings of the active plant."""

    bl_options = {"REGISTER", "UNDO", "INTERNAL"}


class BURGEON_OT_add_item(OfList):
    """Add a row to this list: like the last one"""

    bl_idname, bl_label = "burgeon.add_item", "Add a Row"

    path: StringProperty(description="Where the list stands, as JSON")

    def do(self, context):
        settings.add_item(context.active_object.burgeon, json.loads(self.path))


class BURGEON_OT_remove_item(OfList):
    """Remove this row of the list"""

    bl_idname, bl_label = "burgeon.remove_item", "Remove the Row"

    path: StringProperty(description="Where the list stands, as JSON")
    index: IntProperty(min=0)

    def do(self, context):
        settings.remove_item(context.active_object.burgeon, json.loads(self.path), self.index)


class BURGEON_OT_open_over_time(OfPlant):
    """Give a flower its days as shape keys with keyframes, from bud to wilted"""

    bl_idname, bl_label = "burgeon.open_over_time", "Open Over Time"

    shapes: IntProperty(name="Shapes", description="Days that are made; it moves evenly between them", default=9, min=2, max=64)
    first: IntProperty(name="First Frame", default=1)
    last: IntProperty(name="Last Frame", default=120)

    @classmethod
    def poll(cls, context):
        return OfPlant.poll.__func__(cls, context) and context.active_object.burgeon.maker == "flower"

    def do(self, context):
        if self.last <= self.first:
            raise ValueError(f"the last frame must come after the first, not {self.last} after {self.first}")
        plant = context.active_object
        opening.put(plant, plants.make(plant), self.shapes, self.first, self.last)


class BURGEON_OT_close(OfPlant):
    """Take the keyframes of a flower away: it is as on its day"""

    bl_idname, bl_label = "burgeon.close", "Remove Keyframes"

    @classmethod
    def poll(cls, context):
        return OfPlant.poll.__func__(cls, context) and bool(context.active_object.burgeon.opens)

    def do(self, context):
        context.active_object.burgeon.opens = ""
        plants.update(context.active_object)


class BURGEON_OT_wind(Refusing):
    """Have wind blow on the plants that are selected, and on those that selected instances show"""

    bl_idname, bl_label = "burgeon.wind", "Wind"

    gust: FloatProperty(
        name="Gust",
        description="Of each plant's height, so much at its top",
        default=0.05,
        min=0.0,
        max=0.5,
        subtype="FACTOR",
    )
    direction: FloatProperty(name="Direction", description="0 is along +x", default=0.0, subtype="ANGLE")

    def do(self, context):
        blown = {}
        for one in context.selected_objects:
            for object_ in one.instance_collection.all_objects if one.instance_collection else (one,):
                if wind.can(object_):
                    blown[object_.name] = object_
        if not blown:
            raise ValueError("no plant is selected: wind moves the meshes that Burgeon made")
        for object_ in blown.values():
            high = object_.dimensions.z if object_.dimensions.z else max(corner[2] for corner in object_.bound_box)
            reach = self.gust * high
            wind.add(object_, (reach * math.cos(self.direction), reach * math.sin(self.direction), 0.0))


class BURGEON_OT_import(Refusing):
    """Import the plants of a project of the Studio, with their settings"""

    bl_idname, bl_label = "burgeon.import_project", "Burgeon (.burgeon)"

    filepath: StringProperty(subtype="FILE_PATH")
    filter_glob: StringProperty(default="*.burgeon", options={"HIDDEN"})

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def do(self, context):
        with open(self.filepath, "rb") as file:
            data = file.read()
        found = bg.open(data, wind=True)
        if not found:
            raise ValueError(f"{self.filepath}: no plants, or all are hidden")
        name = os.path.basename(self.filepath)
        collection = bpy.data.collections.new(os.path.splitext(name)[0])
        context.scene.collection.children.link(collection)
        project = plants.keep_project(name, data)
        for row, made in enumerate(found):
            plant = plants.adopt(made, project, row, collection)
            (x, y, z), yaw, scale = made.place
            plant.location, plant.rotation_euler, plant.scale = (x, -z, y), (0.0, 0.0, math.radians(yaw)), (scale,) * 3


class BURGEON_OT_add_forest(Refusing):
    """Add a forest: instances of collections that hold its trees"""

    bl_idname, bl_label = "burgeon.add_forest", "Forest"

    species: _species(TREES)
    width: FloatProperty(name="Width", default=30.0, min=0.1, max=1000.0, subtype="DISTANCE")
    depth: FloatProperty(name="Depth", default=30.0, min=0.1, max=1000.0, subtype="DISTANCE")
    spacing: FloatProperty(name="Spacing", default=5.0, min=0.05, max=100.0, subtype="DISTANCE")
    kinds: IntProperty(name="Kinds", description="Different trees; the others are copies", default=4, min=1, max=100)
    vary: FloatProperty(name="Vary", description="Trees are so much smaller or larger", default=0.15, min=0.0, max=0.9)
    age: IntProperty(name="Age", description="Years or rounds of growth; 0 for that of the species", default=0, min=0, max=5000)
    seed: _seed()
    detail: _detail(0.5)
    textures: BoolProperty(name="Textures", default=True)

    def do(self, context):
        how = {"detail": self.detail, "textures": self.textures, "wind": True, **({"age": self.age} if self.age else {})}
        area = (self.width, self.depth)
        made = bg.grove(self.species, area, spacing=self.spacing, kinds=self.kinds, vary=self.vary, seed=self.seed, **how)
        trees = []
        for k, plant in enumerate(made.plants):
            mesh = bpy.data.meshes.new(f"{self.species} {k + 1}")
            meshes.fill(mesh, plant.model)
            # In no scene: only its instances are seen.
            held = bpy.data.collections.new(mesh.name)
            held.objects.link(bpy.data.objects.new(mesh.name, mesh))
            trees.append(held)
        collection = bpy.data.collections.new(f"{self.species} forest")
        context.scene.collection.children.link(collection)
        at = np.array(context.scene.cursor.location)
        columns = (made.places[name].tolist() for name in ("position", "yaw_deg", "scale", "plant"))
        for (x, y, z), yaw, scale, row in zip(*columns, strict=True):
            copy = bpy.data.objects.new(trees[row].name, None)
            copy.instance_type, copy.instance_collection = "COLLECTION", trees[row]
            copy.empty_display_size = 0.2
            copy.location, copy.rotation_euler, copy.scale = at + (x, -z, y), (0.0, 0.0, math.radians(yaw)), (scale,) * 3
            collection.objects.link(copy)


def _place(context, plant):
    plant.location = context.scene.cursor.location
    _choose(context, plant)


def _choose(context, plant):
    """The plant is the active object, and it alone is selected."""
    for other in context.selected_objects:
        other.select_set(False)
    plant.select_set(True)
    context.view_layer.objects.active = plant


CLASSES = (
    BURGEON_OT_add_tree,
    BURGEON_OT_add_flower,
    BURGEON_OT_add_leaf,
    BURGEON_OT_from_strokes,
    BURGEON_OT_update,
    BURGEON_OT_add_item,
    BURGEON_OT_remove_item,
    BURGEON_OT_open_over_time,
    BURGEON_OT_close,
    BURGEON_OT_wind,
    BURGEON_OT_import,
    BURGEON_OT_add_forest,
)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister():
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
