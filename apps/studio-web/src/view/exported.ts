/** What an export would write, in the place of the plants: its meshes at one level of detail, moved by wind. */
import * as THREE from 'three';
import type { ExportedArrays, SentExport } from '../worker/protocol';
import type { Looks } from './plant';
import type { StandIn } from './plants';
import { blown, type Gust, gustOf } from './wind';

/** The strongest wind moves the top so far, in heights of the plant. */
const LEAN = 0.1;
/** Where it blows to, in the scene: x and z. */
const TOWARDS = new THREE.Vector3(0.97, 0, 0.26);
/** The moment that is shown where nothing is to move, seconds. */
const MOMENT_S = 0.7;
/** Copies are not in step: seconds between one plant and the next. */
const APART_S = 3.7;

interface Standing {
  /** Row of its meshes. */
  readonly model: number;
  readonly group: THREE.Group;
  readonly wind: Gust;
  readonly height: number;
}

export class Exported implements StandIn {
  readonly groups = new Map<number, THREE.Group>();
  /** All that there is, where it is one thing. */
  readonly whole: THREE.Group | undefined;
  private readonly standing: Standing[] = [];
  private readonly shapes: THREE.BufferGeometry[][];
  private strength = 0;

  /** `calm`: a person asked for less motion. */
  constructor(
    private readonly looks: Looks,
    private readonly sent: SentExport,
    private readonly calm: boolean,
  ) {
    for (const texture of sent.textures) looks.addTexture(texture);
    this.shapes = sent.models.map((parts) => parts.map(shapeOf));
    const stand = (model: number): THREE.Group => {
      const group = new THREE.Group();
      const { min, max } = sent.view.models[model]!;
      this.standing.push({ model, group, wind: gustOf(), height: max[1] - min[1] });
      return group;
    };
    for (const { plant, model } of sent.view.plants) this.groups.set(plant, stand(model));
    this.whole = sent.view.plants.length === 0 ? stand(0) : undefined;
    this.relook();
  }

  relook(): void {
    for (const { model: row, group, wind } of this.standing) {
      this.clear(group);
      const { parts, materials } = this.sent.view.models[row]!;
      parts.forEach(({ name, material }, i) => {
        const geometry = this.shapes[row]![i]!;
        const look = this.looks.material(materials[material]!, geometry.hasAttribute('color'));
        const moves = geometry.hasAttribute('_wind');
        const mesh = new THREE.Mesh(geometry, moves ? blown(look.clone(), wind) : look);
        mesh.name = name;
        mesh.castShadow = mesh.receiveShadow = true;
        if (moves) {
          const depth = new THREE.MeshDepthMaterial({ depthPacking: THREE.RGBADepthPacking });
          mesh.customDepthMaterial = blown(depth, wind);
          // It may sway out of the box of its vertices.
          mesh.frustumCulled = false;
        }
        group.add(mesh);
      });
    }
  }

  /** Triangles that are shown. */
  get triangles(): number {
    let sum = 0;
    for (const { group } of this.standing)
      for (const { geometry } of group.children as THREE.Mesh[]) sum += (geometry.index?.count ?? 0) / 3;
    return sum;
  }

  /** Share of the strongest wind, 0 to 1. */
  blow(strength: number): void {
    this.strength = strength;
  }

  get moves(): boolean {
    return this.strength > 0 && !this.calm && this.shapes.flat().some((s) => s.hasAttribute('_wind'));
  }

  tick(seconds: number): void {
    this.standing.forEach(({ group, wind, height }, i) => {
      wind.strength.value = this.strength;
      wind.time.value = (this.calm ? MOMENT_S : seconds) + i * APART_S;
      // Wind comes from one side, however a plant is turned.
      const yaw = group.parent?.rotation.y ?? 0;
      wind.gust.value
        .copy(TOWARDS)
        .applyAxisAngle(new THREE.Vector3(0, 1, 0), -yaw)
        .multiplyScalar(LEAN * height);
    });
  }

  dispose(): void {
    for (const { group } of this.standing) {
      this.clear(group);
      group.removeFromParent();
    }
    for (const shape of this.shapes.flat()) shape.dispose();
  }

  private clear(group: THREE.Group): void {
    for (const mesh of group.children as THREE.Mesh[]) {
      if (!mesh.customDepthMaterial) continue;
      mesh.customDepthMaterial.dispose();
      (mesh.material as THREE.Material).dispose();
    }
    group.clear();
  }
}

function shapeOf(columns: ExportedArrays): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  const sizes = { position: 3, normal: 3, uv: 2, color: 3, _wind: 4, _pivot: 3 } as const;
  const { positions, normals, uvs, colors, wind, pivots } = columns;
  const arrays = {
    position: positions,
    normal: normals,
    uv: uvs,
    color: colors,
    _wind: wind,
    _pivot: pivots,
  };
  for (const [name, array] of Object.entries(arrays))
    if (array.length > 0)
      geometry.setAttribute(name, new THREE.BufferAttribute(array, sizes[name as keyof typeof sizes]));
  geometry.setIndex(new THREE.BufferAttribute(columns.indices, 1));
  geometry.computeBoundingSphere();
  return geometry;
}
