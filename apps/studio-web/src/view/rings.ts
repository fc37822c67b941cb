/** Rings on the ground around plants that are chosen together. */
import * as THREE from 'three';
import type { PlantMeshes } from './plant';

const COLOUR = 0x2f9e5a;
const POINTS = 64;
/** Of plants that are not there yet, metres. */
const LEAST = 0.05;

export class Rings {
  private readonly shape = new THREE.BufferGeometry().setFromPoints(
    Array.from({ length: POINTS }, (_, k) => {
      const turn = (2 * Math.PI * k) / POINTS;
      return new THREE.Vector3(Math.cos(turn), 0, Math.sin(turn));
    }),
  );
  /** Among what is transparent, which is drawn after the ground. */
  private readonly ink = new THREE.LineBasicMaterial({
    color: COLOUR,
    toneMapped: false,
    depthTest: false,
    transparent: true,
  });
  private rings: THREE.LineLoop[] = [];

  /** Lays a ring around each of these plants, and no others; it goes where its plant goes. */
  show(plants: readonly PlantMeshes[]): void {
    for (const ring of this.rings) ring.removeFromParent();
    this.rings = plants.map(({ place, view }) => {
      const ring = new THREE.LineLoop(this.shape, this.ink);
      const [x0, , z0] = view?.min ?? [0, 0, 0];
      const [x1, , z1] = view?.max ?? [0, 0, 0];
      ring.position.set((x0 + x1) / 2, 0, (z0 + z1) / 2);
      ring.scale.setScalar(Math.max(LEAST, Math.max(x1 - x0, z1 - z0) / 2));
      place.add(ring);
      return ring;
    });
  }

  setVisible(on: boolean): void {
    this.ink.visible = on;
  }
}
