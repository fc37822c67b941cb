"""Strokes of grease pencil and of annotations become plants that lie on them."""

import bpy
import numpy as np
import pytest
from mathutils import Matrix

import burgeon as bg
from burgeon_plants import plants, strokes

STEM = np.column_stack([0.1 * np.sin(3 * np.linspace(0, 1, 30)), np.linspace(0, 1, 30)])
ROUND = np.linspace(0, 2 * np.pi, 40)
BLADE = np.column_stack([0.25 * np.sin(ROUND) + 0.32, 0.6 - 0.12 * np.cos(ROUND) + 0.3 * np.sin(ROUND)])
DRAWING = (STEM, BLADE)

FRONT, RIGHT, TOP = ((1, 0, 0), (0, 0, 1)), ((0, 1, 0), (0, 0, 1)), ((1, 0, 0), (0, 1, 0))


def world(drawing, view, at=(0.0, 0.0, 0.0)):
    right, up = (np.array(axis, float) for axis in view)
    return [np.outer(line[:, 0], right) + np.outer(line[:, 1], up) + at for line in drawing]


def pencil(lines):
    """A grease pencil object with these strokes, active."""
    blocks = bpy.data.grease_pencils_v3 if hasattr(bpy.data, "grease_pencils_v3") else bpy.data.grease_pencils
    data = blocks.new("ink")
    frame = data.layers.new("ink").frames.new(1)
    if hasattr(frame, "drawing"):
        frame.drawing.add_strokes([len(line) for line in lines])
        made = frame.drawing.strokes
    else:
        made = [frame.strokes.new() for _ in lines]
    for stroke, line in zip(made, lines, strict=True):
        if not hasattr(frame, "drawing"):
            stroke.points.add(len(line))
        for point, place in zip(stroke.points, line, strict=True):
            setattr(point, "position" if hasattr(point, "position") else "co", place)
    ink = bpy.data.objects.new("ink", data)
    bpy.context.collection.objects.link(ink)
    bpy.context.view_layer.objects.active = ink
    return ink


def annotate(drawing):
    """Draws with Blender's own tool, and hands back the strokes where that put them: across the view of the start file."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    bpy.context.scene.tool_settings.annotation_stroke_placement_view3d = "CURSOR"
    with bpy.context.temp_override(window=window, area=area, region=region):
        for line in drawing:
            pixels = line * 300 + (region.width / 2, 100)
            common = {"name": "", "location": (0, 0, 0), "mouse_event": (0, 0), "pressure": 1.0, "size": 1.0}
            common.update(x_tilt=0.0, y_tilt=0.0)
            if "pen_flip" in bpy.types.OperatorStrokeElement.bl_rna.properties:
                # Of Blender 4.2.
                common["pen_flip"] = False
            samples = [{**common, "mouse": tuple(p), "time": k / 60, "is_start": k == 0} for k, p in enumerate(pixels.tolist())]
            assert bpy.ops.gpencil.annotate(mode="DRAW", stroke=samples, wait_for_input=False) == {"FINISHED"}
    scene = bpy.context.scene
    block = getattr(scene, "annotation", None) or scene.grease_pencil
    return [np.array([tuple(p.co) for p in stroke.points]) for stroke in block.layers[0].active_frame.strokes]


def box(points):
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


def lies_on(plant, lines, axes, tolerance=0.03):
    """Whether a plant, seen along the sheet, covers the box of its strokes."""
    shown = np.array([plant.matrix_world @ v.co for v in plant.data.vertices])
    wanted = np.concatenate(lines)
    return np.allclose(box(shown[:, axes]), box(wanted[:, axes]), atol=tolerance)


@pytest.mark.parametrize(("view", "axes"), [(FRONT, (0, 2)), (RIGHT, (1, 2)), (TOP, (0, 1))])
@pytest.mark.parametrize("at", [(0.0, 0.0, 0.0), (3.0, -4.0, 1.5)])
def test_strokes_of_a_grease_pencil_become_a_plant_that_lies_on_them(view, axes, at):
    lines = world(DRAWING, view, at)
    ink = pencil(lines)
    assert bpy.ops.burgeon.from_strokes(seed=1) == {"FINISHED"}
    plant = bpy.context.view_layer.objects.active
    assert plant is not ink and plants.is_plant(plant) and plant.burgeon.maker == "sketch"
    bpy.context.view_layer.update()
    assert len(plant.data.polygons) > 100 and lies_on(plant, lines, axes)
    # The same plant as of the package, of the same strokes.
    assert bg.sketch([line for line in DRAWING]).axes.part.tolist() == bg.sketch(strokes.flat(lines)[0]).axes.part.tolist()


def test_an_object_that_is_moved_and_scaled_has_its_strokes_where_they_are_seen():
    ink = pencil(world(DRAWING, FRONT))
    ink.location, ink.scale = (1.0, 2.0, 0.5), (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    bpy.ops.burgeon.from_strokes()
    plant = bpy.context.view_layer.objects.active
    bpy.context.view_layer.update()
    lines = [2.0 * line + (1.0, 2.0, 0.5) for line in world(DRAWING, FRONT)]
    assert lies_on(plant, lines, (0, 2), 0.06)


def test_an_annotation_becomes_a_plant():
    lines = annotate(DRAWING)
    assert len(lines) == 2
    assert bpy.ops.burgeon.from_strokes() == {"FINISHED"}
    plant = bpy.context.view_layer.objects.active
    bpy.context.view_layer.update()
    sheet = np.array(strokes.flat(lines)[1])
    # Upright as it was drawn, and on the strokes as they are seen across the sheet.
    assert sheet[2, 2] > 0.3 and np.allclose(np.array(plant.matrix_world)[:3, :3], sheet[:3, :3], atol=1e-6)
    seen = [(line - sheet[:3, 3]) @ sheet[:3, :3] for line in lines]
    plant.matrix_world = Matrix(np.linalg.inv(sheet).tolist()) @ plant.matrix_world
    bpy.context.view_layer.update()
    assert lies_on(plant, seen, (0, 2), 0.03 * np.ptp(np.concatenate(seen)[:, 2]))
    # It follows its settings as others do.
    plant.burgeon.sketch.height_m = 2.0 * plant.burgeon.sketch.height_m
    before = plant.dimensions.z
    plants.catch_up()
    bpy.context.view_layer.update()
    assert plant.burgeon.fault == "" and plant.dimensions.z == pytest.approx(2.0 * before, rel=0.1)
    # What is hidden is not drawn.
    scene = bpy.context.scene
    block = getattr(scene, "annotation", None) or scene.grease_pencil
    block.layers[0].annotation_hide = True
    with pytest.raises(RuntimeError, match="^Error: there are no strokes"):
        bpy.ops.burgeon.from_strokes()


def test_a_plant_of_strokes_is_one_step_of_undo():
    pencil(world(DRAWING, FRONT))
    bpy.ops.ed.undo_push(message="start")
    assert bpy.ops.burgeon.from_strokes("EXEC_DEFAULT", True) == {"FINISHED"}
    made = {o.name: len(o.data.vertices) for o in bpy.data.objects if plants.is_plant(o)}
    assert len(made) == 1
    bpy.ops.ed.undo()
    assert [o.name for o in bpy.data.objects] == ["ink"]
    bpy.ops.ed.redo()
    assert {o.name: len(o.data.vertices) for o in bpy.data.objects if plants.is_plant(o)} == made


def test_strokes_that_cannot_be_a_plant_are_reported():
    pencil([np.zeros((5, 3))])
    with pytest.raises(RuntimeError, match="^Error: the strokes are all at one place"):
        bpy.ops.burgeon.from_strokes()
    assert not any(plants.is_plant(o) for o in bpy.data.objects)


def test_a_sheet_faces_who_looks_whichever_way_it_stands():
    for turn in (0.0, 0.6, -0.6, 1.2):
        right = (np.cos(turn), np.sin(turn), 0.0)
        lines = world(DRAWING, (right, (0, 0, 1)), (3, 4, 1))
        flat, sheet = strokes.flat(lines)
        for line, wanted in zip(flat, DRAWING, strict=True):
            shift = line - wanted
            assert np.allclose(shift, shift[0], atol=1e-9), turn
        assert np.allclose(sheet[:3, 0], right) and np.linalg.det(sheet) == pytest.approx(1.0)
    # One straight line says nothing of its plane: it is the front view's.
    flat, sheet = strokes.flat([np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]])])
    assert np.allclose(sheet[:3, 1], (0, 1, 0)) and flat[0][-1][1] == pytest.approx(1.0)
