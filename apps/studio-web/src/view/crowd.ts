/** Copies that stand still are drawn together: one call for each of their parts, however many they are. */
import * as THREE from 'three';
import type { PlantMeshes, Shapes } from './plant';

/** So many copies are worth drawing together. */
const FEWEST = 4;

export class Crowd {
  private readonly meshes = new Map<Shapes, THREE.InstancedMesh[]>();

  /** `holder`: holds the plants. */
  constructor(private readonly holder: THREE.Object3D) {}

  /** Meshes that stand for many. */
  get size(): number {
    return [...this.meshes.values()].reduce((sum, all) => sum + all.length, 0);
  }

  /** Draws copies among these plants together, and hides them one by one. All of them are seen, and none is held. */
  show(plants: readonly PlantMeshes[]): void {
    const copies = new Map<Shapes, PlantMeshes[]>();
    for (const plant of plants) {
      const known = copies.get(plant.shapes);
      if (known) known.push(plant);
      else copies.set(plant.shapes, [plant]);
    }
    for (const [shapes, all] of copies) {
      if (shapes.length === 0 || all.length < FEWEST) copies.delete(shapes);
    }
    for (const [shapes, meshes] of this.meshes) {
      if (copies.has(shapes)) continue;
      meshes.forEach(drop);
      this.meshes.delete(shapes);
    }
    for (const [shapes, all] of copies) this.gather(shapes, all);
  }

  private gather(shapes: Shapes, all: readonly PlantMeshes[]): void {
    const [first] = all;
    const known = this.meshes.get(shapes) ?? [];
    for (const mesh of known.splice(shapes.length)) drop(mesh);
    for (const plant of all) {
      plant.place.updateMatrix();
      plant.group.visible = false;
    }
    shapes.forEach((geometry, i) => {
      const material = first!.materialOf(i);
      let mesh = known[i];
      if (!mesh || mesh.instanceMatrix.count < all.length) {
        if (mesh) drop(mesh);
        mesh = new THREE.InstancedMesh(geometry, material, all.length);
        mesh.castShadow = mesh.receiveShadow = true;
        this.holder.add(mesh);
        known[i] = mesh;
      }
      mesh.geometry = geometry;
      mesh.material = material;
      mesh.count = all.length;
      all.forEach((plant, row) => mesh.setMatrixAt(row, plant.place.matrix));
      mesh.instanceMatrix.needsUpdate = true;
      mesh.computeBoundingSphere();
    });
    this.meshes.set(shapes, known);
  }

  /** Takes the materials of the plants anew. */
  relook(plants: readonly PlantMeshes[]): void {
    for (const [shapes, meshes] of this.meshes) {
      const plant = plants.find((p) => p.shapes === shapes);
      if (!plant) continue;
      for (const [i, mesh] of meshes.entries()) mesh.material = plant.materialOf(i);
    }
  }
}

function drop(mesh: THREE.InstancedMesh): void {
  mesh.removeFromParent();
  mesh.dispose();
}
