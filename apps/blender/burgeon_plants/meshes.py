"""A model of ``burgeon`` -> a mesh of Blender: z up, a slot for each material, attributes for wind."""

import numpy as np

from . import materials

TINT, WIND, PIVOT, UV = "tint", "wind", "pivot", "UVMap"


def turned(points):
    """From +y up to +z up; what faced the viewer (+z) faces -y, the front view of Blender."""
    out = np.empty_like(points)
    out[:, 0], out[:, 1], out[:, 2] = points[:, 0], -points[:, 2], points[:, 1]
    return out


def parts_of(model):
    """The parts of a model that have triangles."""
    return [part for part in model.parts if len(part.faces)]


def points_of(model):
    """All vertices of a model as those of its mesh, (n, 3) float32."""
    parts = parts_of(model)
    points = np.concatenate([part.vertices for part in parts]) if parts else np.zeros((0, 3), np.float32)
    return turned(points.astype(np.float32))


def _joined(parts, name, width):
    """A column of all parts; ones where a part has none."""
    columns = [getattr(part, name) for part in parts]
    rows = [c if len(c) else np.ones((len(p.vertices), width), np.float32) for c, p in zip(columns, parts, strict=True)]
    return np.concatenate(rows).astype(np.float32)


def fill(mesh, model):
    """Puts a model into a mesh in the place of what it holds."""
    parts = parts_of(model)
    offsets = np.cumsum([0] + [len(part.vertices) for part in parts])
    count = int(offsets[-1])
    before = list(mesh.materials)
    mesh.clear_geometry()
    mesh.materials.clear()
    if count:
        made = [materials.of_part(part) for part in parts]
        slots = list(dict.fromkeys(made))
        for slot in slots:
            mesh.materials.append(slot)
        faces = np.concatenate([part.faces.astype(np.int32) + first for part, first in zip(parts, offsets)])
        of_faces = np.concatenate([np.full(len(p.faces), slots.index(m), np.int32) for p, m in zip(parts, made)])
        _put(mesh, parts, faces, of_faces, points_of(model))
    materials.forget(before)
    mesh.update()


def _put(mesh, parts, faces, slots, points):
    corners, count = faces.reshape(-1), len(points)
    mesh.vertices.add(count)
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(faces))
    mesh.vertices.foreach_set("co", points.reshape(-1))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.foreach_set("loop_start", np.arange(0, len(corners), 3, dtype=np.int32))
    mesh.polygons.foreach_set("material_index", slots)
    uvs = np.concatenate([part.uvs if len(part.uvs) else np.zeros((len(part.vertices), 2), np.float32) for part in parts])
    # v of Blender is upwards.
    flipped = np.column_stack([uvs[:, 0], 1.0 - uvs[:, 1]]).astype(np.float32)
    mesh.uv_layers.new(name=UV).uv.foreach_set("vector", flipped[corners].reshape(-1))
    tint = np.column_stack([_joined(parts, "colors", 3), np.ones(count, np.float32)])
    mesh.color_attributes.new(TINT, "FLOAT_COLOR", "POINT").data.foreach_set("color", tint.reshape(-1))
    if all(len(part.wind) for part in parts):
        mesh.attributes.new(WIND, "FLOAT_COLOR", "POINT").data.foreach_set("color", _joined(parts, "wind", 4).reshape(-1))
        pivots = turned(_joined(parts, "pivots", 3))
        mesh.attributes.new(PIVOT, "FLOAT_VECTOR", "POINT").data.foreach_set("vector", pivots.reshape(-1))
    mesh.update(calc_edges=True)
    mesh.shade_smooth()
    mesh.normals_split_custom_set_from_vertices(turned(_joined(parts, "normals", 3)))
