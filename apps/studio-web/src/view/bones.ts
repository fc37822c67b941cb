/** A plant as the lines of its axes. */
import * as THREE from 'three';

/** Colours of axes by order: 0, 1, 2, 3 and more; each shows on light and dark sky. */
const ORDERS = [0x8a4b14, 0xc0600f, 0x1f8a55, 0x2079c0, 0x8a4fb5].map((c) => new THREE.Color(c));
/** Leaves and petals among the axes. */
const BLADES = [0x3f9a3a, 0xd0407a].map((c) => new THREE.Color(c));

/** Lines through pairs of points with the order of each (100 leaf, 101 petal). */
export function bonesOf(pairs: Float32Array, look: THREE.LineBasicMaterial): THREE.LineSegments {
  const n = pairs.length / 4;
  const [positions, colors] = [new Float32Array(3 * n), new Float32Array(3 * n)];
  for (let i = 0; i < n; i += 1) {
    positions.set(pairs.subarray(4 * i, 4 * i + 3), 3 * i);
    const kind = pairs[4 * i + 3]!;
    const { r, g, b } = kind >= 100 ? BLADES[kind - 100]! : ORDERS[Math.min(kind, ORDERS.length - 1)]!;
    colors.set([r, g, b], 3 * i);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(colors, 3));
  return new THREE.LineSegments(geometry, look);
}
