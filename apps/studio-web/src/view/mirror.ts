/** A plane of symmetry as it is seen: a pane with a grid, upright in the plant. */
import * as THREE from 'three';
import type { Mirror } from '../wire';

const COLOUR = 0x7fd0ff;
const LINES = 8;

export class MirrorPlane {
  /** As wide and high as 1, standing on its lower edge, across z. */
  readonly mesh = new THREE.Group();

  constructor() {
    const pane = new THREE.Mesh(
      new THREE.PlaneGeometry(1, 1).translate(0, 0.5, 0),
      new THREE.MeshBasicMaterial({
        color: COLOUR,
        transparent: true,
        opacity: 0.1,
        side: THREE.DoubleSide,
        depthWrite: false,
        toneMapped: false,
      }),
    );
    const places: number[] = [];
    for (let i = 0; i <= LINES; i += 1) {
      const at = i / LINES;
      places.push(at - 0.5, 0, 0, at - 0.5, 1, 0, -0.5, at, 0, 0.5, at, 0);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(places, 3));
    const grid = new THREE.LineSegments(
      geometry,
      new THREE.LineBasicMaterial({ color: COLOUR, transparent: true, opacity: 0.35, toneMapped: false }),
    );
    this.mesh.add(pane, grid);
    this.mesh.matrixAutoUpdate = false;
  }

  /** Where a mirror is, a little wider than a plant of `size` metres. */
  place({ point, normal }: Mirror, size: number): THREE.Object3D {
    const across = new THREE.Vector3(...normal);
    const up = new THREE.Vector3(0, 1, 0);
    this.mesh.matrix
      .makeBasis(new THREE.Vector3().crossVectors(up, across), up, across)
      .scale(new THREE.Vector3().setScalar(1.1 * size))
      .setPosition(...point);
    this.mesh.matrixWorldNeedsUpdate = true;
    return this.mesh;
  }
}
