import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { Looks, PlantMeshes } from './plant';
import { Crowd } from './crowd';
import type { MaterialView, PlantView } from '../wire';

const look: MaterialView = {
  name: 'leaf',
  kind: 'leaf',
  color: [0.1, 0.4, 0.1],
  roughness: 0.8,
  translucency: 0,
  masked: false,
  two_sided: true,
  texture: null,
  normal: null,
  orm: null,
};
const seen = (id: number): PlantView => ({
  id,
  fresh: true,
  mesh: 7,
  error: null,
  item: null,
  warnings: [],
  stages: [],
  front: null,
  days: null,
  min: [0, 0, 0],
  max: [1, 1, 1],
  parts: [
    { name: 'wood', material: 0 },
    { name: 'leaves', material: 0 },
  ],
  materials: [look],
  obstacles: [],
});

/** Copies of one plant in a row, one metre apart. */
function copies(count: number): { holder: THREE.Group; plants: PlantMeshes[] } {
  const looks = new Looks(true);
  const holder = new THREE.Group();
  const shapes = [new THREE.BoxGeometry(), new THREE.PlaneGeometry()];
  const plants = Array.from({ length: count }, (_, row) => {
    const plant = new PlantMeshes(looks);
    plant.update(seen(row), shapes);
    plant.place.position.set(row, 0, 0);
    holder.add(plant.place);
    return plant;
  });
  return { holder, plants };
}

const crowds = (holder: THREE.Group): THREE.InstancedMesh[] =>
  holder.children.filter((child): child is THREE.InstancedMesh => child instanceof THREE.InstancedMesh);

describe('copies that stand still', () => {
  it('are drawn together, each in its place', () => {
    const { holder, plants } = copies(10);
    const crowd = new Crowd(holder);
    crowd.show(plants);
    const meshes = crowds(holder);
    expect(meshes.map((m) => m.count)).toEqual([10, 10]);
    expect(plants.some((p) => p.group.visible)).toBe(false);
    const matrix = new THREE.Matrix4();
    meshes[1]!.getMatrixAt(3, matrix);
    expect(new THREE.Vector3().setFromMatrixPosition(matrix).x).toBe(3);
    expect(meshes[0]!.boundingSphere!.radius).toBeGreaterThan(4.5);
  });

  it('are drawn one by one where they are few, or when a hand takes most of them', () => {
    const { holder, plants } = copies(6);
    const crowd = new Crowd(holder);
    crowd.show(plants);
    expect(crowd.size).toBe(2);
    for (const plant of plants) plant.group.visible = true;
    crowd.show(plants.slice(3));
    expect([crowd.size, crowds(holder).length]).toEqual([0, 0]);
    expect(plants.every((p) => p.group.visible)).toBe(true);
  });

  it('take more of them than there were, and other materials', () => {
    const { holder, plants } = copies(12);
    const crowd = new Crowd(holder);
    crowd.show(plants.slice(0, 5));
    for (const plant of plants) plant.group.visible = true;
    crowd.show(plants);
    expect(crowds(holder).map((m) => m.count)).toEqual([12, 12]);
    for (const plant of plants) plant.relook();
    crowd.relook(plants);
    expect(crowds(holder)[0]!.material).toBe(plants[0]!.materialOf(0));
  });
});
