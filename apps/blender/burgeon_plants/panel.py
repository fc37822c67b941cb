"""The panel in the side bar, and entries of the menus of Add and Import."""

import json

import bpy

from . import fields, plants, settings

ADD = (
    ("burgeon.add_tree", "OUTLINER_OB_CURVES"),
    ("burgeon.add_flower", "LIGHT_SUN"),
    ("burgeon.add_leaf", "MESH_PLANE"),
    ("burgeon.from_strokes", "GREASEPENCIL"),
    ("burgeon.add_forest", "OUTLINER_COLLECTION"),
)


class BURGEON_PT_plants(bpy.types.Panel):
    """Plants: what there is to add, and the settings of the active one, by topic"""

    bl_idname, bl_label = "BURGEON_PT_plants", "Burgeon"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Burgeon"

    def draw(self, context):
        column = self.layout.column(align=True)
        for name, icon in ADD:
            column.operator(name, icon=icon)
        column.operator("burgeon.wind", icon="FORCE_WIND")
        plant = context.active_object
        if plants.is_plant(plant):
            draw_plant(self.layout, plant)


def draw_plant(layout, plant):
    """The settings of a plant."""
    own = plant.burgeon
    head = layout.column()
    head.use_property_split = True
    head.label(text=f"{plant.name}: {own.species or own.maker}{' of a project' if own.whole else ''}")
    if own.fault:
        for line in own.fault.splitlines():
            head.label(text=line, icon="ERROR")
    # Flowers and leaves have no fineness.
    if own.maker in ("tree", "flower") and not own.whole:
        head.prop(own, "species")
    for name in ("seed", *surface(own), "live"):
        head.prop(own, name)
    if own.maker == "flower":
        head.prop(own, "day")
        head.operator("burgeon.open_over_time", icon="SHAPEKEY_DATA")
        if own.opens:
            head.operator("burgeon.close")
    if not own.live:
        head.operator("burgeon.update", icon="FILE_REFRESH")
    group, spec = getattr(own, own.maker), settings.base(own)
    for topic, rows in topics(own):
        title, body = layout.panel(f"burgeon_{own.maker}_{topic}", default_closed=topic != fields.GENERAL)
        title.label(text=topic.replace("_", " ").capitalize())
        if body:
            body.use_property_split = True
            for row in rows:
                draw_row(body, group, row, spec, ())


def surface(own):
    """What a plant says of its meshes: of a project only their fineness is known, flowers and leaves have none."""
    names = settings.SURFACE.get(own.maker, ())
    return names[:1] if own.whole else names


def topics(own):
    """The rows that a plant has, by topic: what stands in no table comes first."""
    found, spec = {fields.GENERAL: []}, settings.base(own)
    # None while it waits for the settings of another species.
    for row in shown(fields.rows(own.maker), spec) if spec else ():
        found.setdefault(row.topic, []).append(row)
    return [(topic, rows) for topic, rows in found.items() if rows]


def shown(rows, spec):
    """The rows whose fields a table of a spec has."""
    return [row for row in rows if fields.table_of(spec, row) is not None]


def draw_row(layout, group, row, spec, where):
    """A row of a group, or a list with its rows; ``where``: the path of the group, of numbers for rows of lists."""
    if row.item:
        draw_list(layout, group, row, settings.was_in(row, fields.table_of(spec, row)), where)
    elif not row.switched:
        layout.prop(group, row.name)
    else:
        line = layout.row(heading=row.label)
        line.prop(group, row.switch, text="")
        value = line.row()
        value.active = getattr(group, row.switch)
        value.prop(group, row.name, text="")


def draw_list(layout, group, row, value, where):
    """A list with a button that adds; each of its rows with one that removes it."""
    head = layout.row()
    if row.switched:
        head.prop(group, row.switch, text="")
    values = settings.as_list(row, value)
    long = len(values) > settings.MOST_ITEMS
    head.label(text=f"{row.label}: {len(values)}, as they are" if long else row.label)
    if long or (row.switched and not getattr(group, row.switch)):
        return
    path = (*where, *row.path)
    head.operator("burgeon.add_item", text="", icon="ADD").path = json.dumps(path)
    for k, (item, one) in enumerate(zip(getattr(group, row.name), values, strict=False)):
        line = layout.box().row()
        body = line.column()
        for inner in shown(row.item, settings.wrapped(row, one)):
            draw_row(body, item, inner, settings.wrapped(row, one), (*path, k))
        remove = line.operator("burgeon.remove_item", text="", icon="REMOVE")
        remove.path, remove.index = json.dumps(path), k


def add_menu(self, _context):
    self.layout.separator()
    for name, icon in ADD:
        self.layout.operator(name, icon=icon)


def import_menu(self, _context):
    self.layout.operator("burgeon.import_project")


def register():
    bpy.utils.register_class(BURGEON_PT_plants)
    bpy.types.VIEW3D_MT_mesh_add.append(add_menu)
    bpy.types.TOPBAR_MT_file_import.append(import_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(import_menu)
    bpy.types.VIEW3D_MT_mesh_add.remove(add_menu)
    bpy.utils.unregister_class(BURGEON_PT_plants)
