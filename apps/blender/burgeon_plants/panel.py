"""The panel in the side bar, and entries of the menus of Add and Import."""

import bpy

from . import plants, settings

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
    group = getattr(own, own.maker)
    for topic, rows in topics(own):
        title, body = layout.panel(f"burgeon_{own.maker}_{topic}", default_closed=topic != settings.GENERAL)
        title.label(text=topic.replace("_", " ").capitalize())
        if body:
            body.use_property_split = True
            for row in rows:
                draw_row(body, group, row)


def surface(own):
    """What a plant says of its meshes: of a project only their fineness is known, flowers and leaves have none."""
    if own.maker not in ("tree", "sketch"):
        return ()
    if own.whole:
        return ("detail",)
    return ("detail", *(settings.SURFACE if own.maker == "tree" else settings.SURFACE[:2]))


def topics(own):
    """The rows that a plant has, by topic: what stands in no table comes first."""
    spec, found = settings.base(own), {settings.GENERAL: []}
    for row in settings.rows(own.maker):
        if settings.at(spec, row.path) is not settings.missing:
            found.setdefault(row.topic, []).append(row)
    return [(topic, rows) for topic, rows in found.items() if rows]


def draw_row(layout, group, row):
    if not row.optional or row.kind == "word":
        layout.prop(group, row.name)
        return
    line = layout.row(heading=row.label)
    line.prop(group, row.switch, text="")
    value = line.row()
    value.active = getattr(group, row.switch)
    value.prop(group, row.name, text="")


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
