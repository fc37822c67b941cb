/** A branch in the hand: what is seen of it is moved by a matrix, and nothing is meshed before the hand lets go. */
import * as THREE from 'three';
import type { CarriedPose } from '../wire';

/** Part, first triangle, and the one after the last, of each range; ranges of a part ascend. */
export type HeldRows = Uint32Array;

/** The corners of the triangles in some ranges, and those of all others. */
export function parted(
  index: Uint32Array | Uint16Array,
  ranges: readonly (readonly [number, number])[],
): { held: Uint32Array; rest: Uint32Array } {
  const count = 3 * ranges.reduce((sum, [from, to]) => sum + to - from, 0);
  const [held, rest] = [new Uint32Array(count), new Uint32Array(index.length - count)];
  let [h, r, last] = [0, 0, 0];
  for (const [from, to] of ranges) {
    const [still, moved] = [index.subarray(last, 3 * from), index.subarray(3 * from, 3 * to)];
    rest.set(still, r);
    held.set(moved, h);
    [r, h, last] = [r + still.length, h + moved.length, 3 * to];
  }
  rest.set(index.subarray(last), r);
  return { held, rest };
}

/** `p -> to + turn (p - from)` as a matrix. */
export function matrixOf({ from, to, turn }: CarriedPose, out: THREE.Matrix4): THREE.Matrix4 {
  spin.fromArray(turn);
  place.fromArray(from).applyQuaternion(spin).negate().add(shift.fromArray(to));
  return out.compose(place, spin, ONE);
}

/** What is carried of one plant: its meshes in two, of the same columns. */
export class Carrying {
  private readonly parts: {
    mesh: THREE.Mesh;
    whole: THREE.BufferGeometry;
    rest: THREE.BufferGeometry;
    held: THREE.Mesh;
  }[] = [];

  /** `meshes`: by part. Copies of the plant share its shapes, so these stay as they are. */
  constructor(
    /** The name of the meshes. */
    readonly number: number,
    group: THREE.Group,
    meshes: readonly (THREE.Mesh | undefined)[],
    rows: HeldRows,
  ) {
    meshes.forEach((mesh, part) => {
      const index = mesh?.geometry.getIndex();
      const ranges: [number, number][] = [];
      for (let i = 0; i < rows.length; i += 3)
        if (rows[i] === part) ranges.push([rows[i + 1]!, rows[i + 2]!]);
      if (!mesh || !index || ranges.length === 0) return;
      const { held, rest } = parted(index.array as Uint32Array, ranges);
      const whole = mesh.geometry;
      const moved = new THREE.Mesh(sharing(whole, held), mesh.material);
      moved.castShadow = moved.receiveShadow = true;
      moved.matrixAutoUpdate = false;
      moved.frustumCulled = false;
      const still = sharing(whole, rest);
      mesh.geometry = still;
      group.add(moved);
      this.parts.push({ mesh, whole, rest: still, held: moved });
    });
  }

  pose(pose: CarriedPose): void {
    for (const { held } of this.parts) {
      matrixOf(pose, held.matrix);
      held.matrixWorldNeedsUpdate = true;
    }
  }

  /** Everything is as it was before, but for meshes that have other shapes by now. */
  end(): void {
    for (const { mesh, whole, rest, held } of this.parts) {
      held.removeFromParent();
      if (mesh.geometry === rest) mesh.geometry = whole;
      for (const geometry of [held.geometry, rest]) {
        // The columns are those of the whole and stay on the graphics card.
        for (const name of Object.keys(geometry.attributes)) geometry.deleteAttribute(name);
        geometry.dispose();
      }
    }
    this.parts.length = 0;
  }
}

/** The same columns with other corners. */
function sharing(whole: THREE.BufferGeometry, index: Uint32Array): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  for (const [name, column] of Object.entries(whole.attributes)) geometry.setAttribute(name, column);
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  geometry.boundingSphere = whole.boundingSphere;
  return geometry;
}

const ONE = new THREE.Vector3(1, 1, 1);
const spin = new THREE.Quaternion();
const place = new THREE.Vector3();
const shift = new THREE.Vector3();
