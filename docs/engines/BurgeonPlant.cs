// Makes a LOD group and a collider of a plant that `burgeon --for unity` wrote. Put it into a folder `Editor`.
using System.Linq;
using UnityEditor;
using UnityEngine;

public static class BurgeonPlant
{
    // Share of the height of the screen down to which each level is shown.
    static readonly float[] Heights = { 0.5f, 0.25f, 0.12f, 0.02f, 0.01f, 0.005f, 0.002f };

    [MenuItem("Tools/Burgeon/Levels and collider")]
    static void Dress()
    {
        foreach (var plant in Selection.gameObjects)
        {
            Undo.RegisterFullObjectHierarchyUndo(plant, "Levels and collider");
            var renderers = plant.GetComponentsInChildren<MeshRenderer>();
            var levels = renderers.Where(r => r.name.Contains("_LOD")).OrderBy(r => r.name).ToArray();
            if (levels.Length > 0)
            {
                var group = plant.GetComponent<LODGroup>() ?? plant.AddComponent<LODGroup>();
                group.SetLODs(levels.Select((r, k) => new LOD(Heights[k], new Renderer[] { r })).ToArray());
                group.RecalculateBounds();
            }
            foreach (var solid in renderers.Where(r => r.name.EndsWith("_collider")))
            {
                var collider = solid.gameObject.AddComponent<MeshCollider>();
                collider.sharedMesh = solid.GetComponent<MeshFilter>().sharedMesh;
                Object.DestroyImmediate(solid);
            }
        }
    }
}
