"""An object -> its plant, made anew when one of its properties changes."""

import base64
import hashlib
import json

import bpy
import numpy as np
from bpy.app.handlers import persistent

import burgeon as bg

from . import meshes, opening, settings

WAIT_S = 0.3
"""So long after the last change a plant is made anew."""
FAULTS = (ValueError, TypeError, OSError, RuntimeError, MemoryError)
"""What the core refuses, as exceptions."""


def add(context, name, maker, species="", seed=1, detail=1.0, strokes="", fields=None, collection=None):
    """Makes a plant and adds it to a scene: an object with a mesh and its settings. What is refused adds nothing."""
    made = grown(maker, species, seed, {"detail": detail}, None, strokes, fields or {})
    plant = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    own = plant.burgeon
    settings.filling = True
    own.maker, own.species, own.seed, own.detail, own.strokes = maker, species, seed, detail, strokes
    if maker == "flower":
        own.day = made.days[0]
    settings.filling = False
    settings.fill(own, made.spec)
    meshes.fill(plant.data, made.model)
    own.made = settings.key(own)
    (collection or context.collection).objects.link(plant)
    return plant


def keep_project(name, data):
    """A project of the Studio as a text of this file, for the plants that are imported from it."""
    text = bpy.data.texts.new(name)
    text.write(base64.b64encode(data).decode())
    return text


def adopt(made, project, row, collection):
    """Adds a plant of a project: an object with a mesh, its place, and the settings that it has there."""
    plant = bpy.data.objects.new(made.name, bpy.data.meshes.new(made.name))
    own = plant.burgeon
    settings.filling = True
    own.maker, own.project, own.row, own.whole = made.maker, project, row, str(made.seed)
    own.seed = min(made.seed, settings.MOST_WHOLE)
    own.detail, own.day = made.detail or 1.0, made.day or 0.0
    settings.filling = False
    settings.fill(own, made.spec)
    meshes.fill(plant.data, made.model)
    own.made = settings.key(own)
    collection.objects.link(plant)
    return plant


KEPT = 64
"""So many plants of projects are kept as they were saved: a change of settings makes only what it touches."""
kept = {}


def saved(own):
    """The plant of a project, as it was saved."""
    if own.project is None:
        raise ValueError("the text with the project that it was imported from is no longer in this file")
    text = own.project.as_string()
    key = hashlib.sha256(text.encode()).digest(), own.row
    if key not in kept:
        while len(kept) >= KEPT:
            kept.pop(next(iter(kept)))
        (kept[key],) = bg.open(base64.b64decode(text), only=own.row, wind=True)
    return kept[key]


def again(own, fields):
    """What a plant of a project is with the settings that it has now: edits by hand and materials stay."""
    was = saved(own)
    how = {}
    if own.seed != min(was.seed, settings.MOST_WHOLE):
        how["seed"] = own.seed
    if was.detail is not None and np.float32(was.detail) != np.float32(own.detail):
        how["detail"] = own.detail
    if own.maker == "flower" and np.float32(was.day) != np.float32(own.day):
        how["day"] = own.day
    return was.again(**how, **fields)


def grown(maker, species, seed, skin, day, strokes, fields):
    """What ``burgeon`` makes of settings; ``skin``: of the meshes of trees and drawings."""
    how = {"seed": seed, "wind": True}
    if maker == "tree":
        return bg.grow(species or None, **skin, **how, **fields)
    if maker == "flower":
        return bg.bloom(species or None, day, **how, **fields)
    if maker == "leaf":
        return bg.leaf(**how, **fields)
    return bg.sketch(json.loads(strokes), **skin, **how, **fields)


def make(plant):
    """What ``burgeon`` makes of an object's settings."""
    own = plant.burgeon
    fields = settings.asked(own)
    if own.whole:
        return again(own, fields)
    # Another species opens on days of its own.
    day = own.day if own.maker == "flower" and own.base else None
    skin = {name: getattr(own, name) for name in settings.SURFACE.get(own.maker, ())}
    skin = {name: value for name, value in skin.items() if value != settings.NONE}
    return grown(own.maker, own.species, own.seed, skin, day, own.strokes, fields)


def is_plant(plant):
    """Whether an object is the plant of settings."""
    return plant is not None and plant.type == "MESH" and plant.burgeon.maker in settings.MAKERS


def is_stale(plant):
    """Whether a plant is not what its settings say."""
    return plant.burgeon.made != settings.key(plant.burgeon)


def update(plant):
    """Makes a plant anew if it is not what its settings say; whether it was not."""
    own = plant.burgeon
    if not is_stale(plant):
        own.fault = ""
        return False
    made = make(plant)
    own.fault = ""
    if not own.base:
        settings.fill(own, made.spec)
        if own.maker == "flower":
            settings.filling = True
            own.day = made.days[0]
            settings.filling = False
    if plant.data.users > 1:
        # Another object shows the same mesh: it stays as it is.
        plant.data = bpy.data.meshes.new(plant.data.name)
    if own.opens:
        opening.put(plant, made, *json.loads(own.opens))
    else:
        plant.shape_key_clear()
        meshes.fill(plant.data, made.model)
    own.made = settings.key(own)
    return True


waiting = set()
"""Names of objects that are to be made anew."""


def touched(plant):
    """A setting changed: the plant waits until nothing has changed for a moment."""
    if is_plant(plant) and plant.burgeon.live:
        waiting.add(plant.name)
        wait()


def wait():
    """Starts the wait, or starts it again."""
    if bpy.app.timers.is_registered(catch_up):
        bpy.app.timers.unregister(catch_up)
    bpy.app.timers.register(catch_up, first_interval=WAIT_S)


def catch_up():
    """Makes what waits. What is refused stays as it is and says why."""
    for name in sorted(waiting):
        plant = bpy.data.objects.get(name)
        if not is_plant(plant):
            waiting.discard(name)
            continue
        if plant.mode != "OBJECT":
            # The mesh is in the hands of a person.
            continue
        waiting.discard(name)
        try:
            update(plant)
        except FAULTS as error:
            plant.burgeon.fault = str(error)
    return WAIT_S if waiting else None


@persistent
def looked(*_):
    """After undo, redo and opening a file, what lies there may be from before the last time it was made."""
    waiting.update(plant.name for plant in bpy.data.objects if is_plant(plant) and plant.burgeon.live and is_stale(plant))
    if waiting:
        wait()


HANDLERS = ("undo_post", "redo_post", "load_post")


def register():
    settings.changed.append(touched)
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).append(looked)


def unregister():
    settings.changed.remove(touched)
    for name in HANDLERS:
        getattr(bpy.app.handlers, name).remove(looked)
    if bpy.app.timers.is_registered(catch_up):
        bpy.app.timers.unregister(catch_up)
    waiting.clear()
    kept.clear()
