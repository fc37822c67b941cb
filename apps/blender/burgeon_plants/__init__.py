"""Burgeon in Blender: plants from a panel, from strokes, from projects. All rules about plants are the package ``burgeon``'s.

| module | owns |
|---|---|
| ``fields`` | schemas -> rows: which fields there are, and when |
| ``settings`` | rows -> properties of Blender: names, ranges, units and help are those of the schema |
| ``plants`` | an object -> its plant, made anew when a property changes |
| ``meshes``, ``materials`` | a model -> a mesh with materials and attributes |
| ``opening`` | a flower's days -> shape keys with keyframes |
| ``wind`` | the node group that moves a mesh |
| ``strokes`` | annotation or grease pencil -> strokes on a sheet |
| ``operators``, ``panel`` | what a person sees |
"""

from . import operators, panel, plants, settings


def register():
    settings.register()
    operators.register()
    panel.register()
    plants.register()


def unregister():
    plants.unregister()
    panel.unregister()
    operators.unregister()
    settings.unregister()
