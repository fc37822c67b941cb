import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { Carrying, matrixOf, parted } from './carry';

const columns = (triangles: number): THREE.BufferGeometry => {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(9 * triangles), 3));
  geometry.setIndex(
    new THREE.BufferAttribute(
      Uint32Array.from({ length: 3 * triangles }, (_, i) => i),
      1,
    ),
  );
  return geometry;
};
const index = (mesh: THREE.Mesh): number[] => Array.from(mesh.geometry.getIndex()!.array);

describe('what is carried', () => {
  it('is some triangles, and all others stay', () => {
    const all = Uint32Array.from({ length: 15 }, (_, i) => i);
    const { held, rest } = parted(all, [
      [1, 2],
      [3, 5],
    ]);
    expect([...held]).toEqual([3, 4, 5, 9, 10, 11, 12, 13, 14]);
    expect([...rest]).toEqual([0, 1, 2, 6, 7, 8]);
    expect(parted(all, []).rest).toEqual(all);
    expect(parted(all, [[0, 5]]).held).toEqual(all);
  });

  it('goes where the pose says', () => {
    const half = Math.SQRT1_2;
    const m = matrixOf(
      { mesh: 1, from: [1, 2, 0], to: [4, 0, 1], turn: [0, 0, half, half] },
      new THREE.Matrix4(),
    );
    const at = (x: number, y: number, z: number): number[] =>
      new THREE.Vector3(x, y, z).applyMatrix4(m).toArray();
    at(1, 2, 0).forEach((x, i) => expect(x).toBeCloseTo([4, 0, 1][i]!, 12));
    // A quarter about z.
    at(2, 2, 3).forEach((x, i) => expect(x).toBeCloseTo([4, 1, 4][i]!, 12));
  });

  it('is put back as it was, and copies never see it', () => {
    const group = new THREE.Group();
    const [whole, other] = [columns(4), columns(2)];
    const [wood, leaves] = [new THREE.Mesh(whole), new THREE.Mesh(other)];
    group.add(wood, leaves);
    const disposed: unknown[] = [];
    whole.addEventListener('dispose', () => disposed.push('whole'));
    const carrying = new Carrying(7, group, [wood, leaves], Uint32Array.of(0, 1, 3));
    expect(group.children.length).toBe(3);
    expect(leaves.geometry).toBe(other);
    const held = group.children[2] as THREE.Mesh;
    expect([index(held), index(wood)]).toEqual([
      [3, 4, 5, 6, 7, 8],
      [0, 1, 2, 9, 10, 11],
    ]);
    expect(held.geometry.getAttribute('position')).toBe(whole.getAttribute('position'));
    expect(whole.getIndex()!.count).toBe(12);
    carrying.pose({ mesh: 7, from: [0, 0, 0], to: [0, 3, 0], turn: [0, 0, 0, 1] });
    expect(held.matrix.elements[13]).toBe(3);
    carrying.end();
    expect([wood.geometry, group.children.length, disposed.length]).toEqual([whole, 2, 0]);
    // A mesh that has other shapes by now keeps them.
    const again = new Carrying(7, group, [wood, leaves], Uint32Array.of(0, 0, 1));
    wood.geometry = other;
    again.end();
    expect(wood.geometry).toBe(other);
  });
});
