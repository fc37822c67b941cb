"""An object -> its plant, made anew when one of its properties changes."""

import json

import bpy
from bpy.app.handlers import persistent

import burgeon as bg

from . import meshes, opening, settings

WAIT_S = 0.3
"""So long after the last change a plant is made anew."""
FAULTS = (ValueError, TypeError, OSError, RuntimeError, MemoryError)
"""What the core refuses, as exceptions."""


def add(context, name, maker, species="", seed=1, detail=1.0, strokes="", fields=None, collection=None):
    """Makes a plant and adds it to a scene: an object with a mesh and its settings. What is refused adds nothing."""
    made = grown(maker, species, seed, detail, None, strokes, fields or {})
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


def grown(maker, species, seed, detail, day, strokes, fields):
    """What ``burgeon`` makes of settings."""
    how = {"seed": seed, "wind": True}
    if maker == "tree":
        return bg.grow(species or None, detail=detail, **how, **fields)
    if maker == "flower":
        return bg.bloom(species or None, day, **how, **fields)
    if maker == "leaf":
        return bg.leaf(**how, **fields)
    return bg.sketch(json.loads(strokes), detail=detail, **how, **fields)


def make(plant):
    """What ``burgeon`` makes of an object's settings."""
    own = plant.burgeon
    fields = settings.asked(own)
    day = own.day if own.maker == "flower" else None
    return grown(own.maker, own.species, own.seed, own.detail, day, own.strokes, fields)


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
