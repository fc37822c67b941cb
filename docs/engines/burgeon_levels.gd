# Gives the levels of a plant that `burgeon --for godot --lods 3` wrote their visibility ranges. An import script of Godot 4.
@tool
extends EditorScenePostImport

# Heights of the plant away from it at which the next level takes over.
const FARTHER := [2.0, 5.0, 12.0, 30.0, 60.0, 120.0]

func _post_import(scene: Node) -> Object:
	var levels: Array[MeshInstance3D] = []
	for child in scene.find_children("*_LOD*", "MeshInstance3D"):
		levels.append(child)
	levels.sort_custom(func(a, b): return String(a.name) < String(b.name))
	for k in levels.size():
		var height := levels[0].get_aabb().size.y
		levels[k].visibility_range_begin = 0.0 if k == 0 else FARTHER[k - 1] * height
		levels[k].visibility_range_end = 0.0 if k + 1 == levels.size() else FARTHER[k] * height
		levels[k].visibility_range_fade_mode = GeometryInstance3D.VISIBILITY_RANGE_FADE_SELF
	return scene
