"""Annotation and grease pencil -> strokes on a sheet, and where the sheet stands."""

import numpy as np


def of_context(context):
    """The strokes of the active grease pencil object, else of the annotation of the scene: points (n, 3) of the world."""
    active = context.active_object
    if active is not None and active.type in ("GREASEPENCIL", "GPENCIL"):
        found = _of_layers(active.data.layers, np.array(active.matrix_world))
        if found:
            return found
    # Blender 5 calls it an annotation.
    notes = getattr(context.scene, "annotation", None) or getattr(context.scene, "grease_pencil", None)
    return _of_layers(notes.layers, np.eye(4)) if notes else []


def _of_layers(layers, matrix):
    out = []
    for layer in layers:
        # The ruler tool keeps its lines among the annotations.
        if any(getattr(layer, name, False) for name in ("hide", "annotation_hide", "is_ruler")):
            continue
        frame = layer.current_frame() if hasattr(layer, "current_frame") else layer.active_frame
        drawing = getattr(frame, "drawing", frame)
        for stroke in drawing.strokes if drawing else []:
            place = [tuple(p.position if hasattr(p, "position") else p.co) for p in stroke.points]
            points = np.array(place, float).reshape(-1, 3)
            if len(points) > 1:
                out.append(points @ matrix[:3, :3].T + matrix[:3, 3])
    return out


def flat(strokes):
    """Strokes of the world -> the same on a sheet, (n, 2) in metres, y upwards; and the sheet.

    The sheet is a matrix (4, 4) from x, away from who looks, y to the world. It is the plane in which the strokes vary most;
    of strokes that are all on one line, the front view's.
    """
    points = np.concatenate(strokes)
    middle = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - middle, full_matrices=False)
    if len(sizes) < 2 or sizes[0] == 0.0:
        raise ValueError("the strokes are all at one place: draw them larger")
    away = axes[2] if len(axes) > 2 and sizes[1] > 0.02 * sizes[0] else _beside(axes[0])
    # It is looked at from the front, from the right, from above.
    if max((away * (-1.0, 1.0, -1.0)).tolist(), key=abs) < 0.0:
        away = -away
    up = np.array([0.0, 0.0, 1.0]) - away * away[2]
    if np.linalg.norm(up) < 0.3:
        # On the floor, its top is where +y is.
        up = np.array([0.0, 1.0, 0.0]) - away * away[1]
    up /= np.linalg.norm(up)
    right = np.cross(away, up)
    sheet = np.eye(4)
    sheet[:3, 0], sheet[:3, 1], sheet[:3, 2], sheet[:3, 3] = right, away, up, middle
    return [np.column_stack([(s - middle) @ right, (s - middle) @ up]) for s in strokes], sheet


def _beside(line):
    """The direction of sight across a line: forwards if that is possible."""
    away = np.array([0.0, 1.0, 0.0]) - line * line[1]
    if np.linalg.norm(away) < 0.3:
        away = np.array([-1.0, 0.0, 0.0]) + line * line[0]
    return away / np.linalg.norm(away)
