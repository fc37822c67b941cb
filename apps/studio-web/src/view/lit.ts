/** The plants in the colours of the light that they absorb, in the place of the plants. */
import * as THREE from 'three';
import type { ExportedArrays } from '../worker/protocol';
import type { Looks } from './plant';
import type { StandIn } from './plants';

export class Lit implements StandIn {
  readonly groups = new Map<number, THREE.Group>();
  readonly whole = new THREE.Group();
  readonly moves = false;

  constructor(
    private readonly looks: Looks,
    parts: readonly ExportedArrays[],
  ) {
    for (const { positions, colors, indices } of parts) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
      geometry.setAttribute('color', new THREE.BufferAttribute(colors, 3));
      geometry.setIndex(new THREE.BufferAttribute(indices, 1));
      const mesh = new THREE.Mesh(geometry);
      mesh.castShadow = true;
      this.whole.add(mesh);
    }
    this.relook();
  }

  private get meshes(): THREE.Mesh[] {
    return this.whole.children as THREE.Mesh[];
  }

  /** Triangles that are shown. */
  get triangles(): number {
    return this.meshes.reduce((sum, { geometry }) => sum + (geometry.index?.count ?? 0) / 3, 0);
  }

  relook(): void {
    // One colour is one amount of light: no lamp of the stage falls on it.
    const material = this.looks.plain();
    for (const mesh of this.meshes) mesh.material = material;
  }

  tick(): void {}

  dispose(): void {
    for (const { geometry } of this.meshes) geometry.dispose();
    this.whole.removeFromParent();
    this.whole.clear();
  }
}
