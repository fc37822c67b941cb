"""A flower's days as shape keys, each at its full at one frame."""

import json

import numpy as np

from . import meshes, settings


def put(plant, made, shapes, first, last):
    """Gives a plant all days of a flower, from bud to wilted, as one mesh with keyframes from frame to frame.

    Raises ValueError, and changes nothing, for a flower that has other triangles on other days.
    """
    low, high = made.days
    days = np.linspace(0.0, low + high, shapes)
    models = [made.at(float(day)).model for day in days]
    triangles = [[part.faces for part in meshes.parts_of(model)] for model in models]
    for day, faces in zip(days, triangles, strict=True):
        alike = len(faces) == len(triangles[0]) and all(np.array_equal(a, b) for a, b in zip(faces, triangles[0], strict=True))
        if not alike:
            raise ValueError(f"on day {day:.1f} this flower has other triangles than as a bud: it cannot have shape keys")
    plant.shape_key_clear()
    # The colours of full bloom: shape keys have places only.
    bloom = int(np.argmin(np.abs(days - low)))
    meshes.fill(plant.data, models[bloom])
    plant.shape_key_add(name="Bloom", from_mix=False)
    keys = []
    for day, model in zip(days, models, strict=True):
        key = plant.shape_key_add(name=f"Day {day:.2f}", from_mix=False)
        key.data.foreach_set("co", meshes.points_of(model).reshape(-1))
        keys.append(key)
    frames = np.linspace(first, last, shapes)
    for k, key in enumerate(keys):
        for other in range(max(k - 1, 0), min(k + 2, shapes)):
            key.value = 1.0 if other == k else 0.0
            key.keyframe_insert("value", frame=float(frames[other]))
    for curve in curves(plant.data.shape_keys):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    plant.burgeon.opens = json.dumps([shapes, first, last])
    plant.burgeon.made = settings.key(plant.burgeon)


def curves(owner):
    """The curves of the keyframes of a data block."""
    action = owner.animation_data.action
    if hasattr(action, "fcurves"):
        return list(action.fcurves)
    return [curve for layer in action.layers for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves]
