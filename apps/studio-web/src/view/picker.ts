/** What lies under a point of the screen: plants, obstacles, the ground. */
import * as THREE from 'three';
import type { PlantMeshes } from './plant';

/** Further away, in sizes of the stage, a ray that glances over the ground says nothing. */
const FAR = 60;

type Camera = THREE.PerspectiveCamera | THREE.OrthographicCamera;

export class Picker {
  private readonly caster = new THREE.Raycaster();

  /** `holder`: holds the plants, at the size of the stage and raised onto its ground. */
  constructor(
    private readonly element: HTMLElement,
    private readonly camera: () => Camera,
    private readonly holder: THREE.Object3D,
  ) {}

  /** The ray through a point of the screen. */
  ray(x: number, y: number): THREE.Ray {
    const box = this.element.getBoundingClientRect();
    const camera = this.camera();
    camera.updateMatrixWorld();
    this.caster.setFromCamera(
      new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2),
      camera,
    );
    return this.caster.ray;
  }

  /** The first of these plants, by their names. */
  plant(x: number, y: number, plants: ReadonlyMap<number, PlantMeshes>): number | undefined {
    this.ray(x, y);
    let best: { id: number; distance: number } | undefined;
    for (const [id, plant] of plants) {
      if (!plant.place.visible) continue;
      plant.place.updateWorldMatrix(true, true);
      const hit = this.caster.intersectObject(plant.group, true)[0];
      if (hit && (!best || hit.distance < best.distance)) best = { id, distance: hit.distance };
    }
    return best?.id;
  }

  /** The obstacle of a plant. */
  obstacle(x: number, y: number, { place, obstacles }: PlantMeshes): THREE.Intersection | undefined {
    this.ray(x, y);
    place.updateWorldMatrix(true, true);
    return this.caster.intersectObject(obstacles, true)[0];
  }

  /** Whether something of a plant lies before what the last ray met. */
  isBehind(hit: THREE.Intersection, { group }: PlantMeshes): boolean {
    const before = this.caster.intersectObject(group, true)[0];
    return before !== undefined && before.distance < hit.distance;
  }

  private groundUnder(x: number, y: number): THREE.Vector3 | undefined {
    const ground = new THREE.Plane(new THREE.Vector3(0, 1, 0), -this.holder.position.y);
    return this.ray(x, y).intersectPlane(ground, new THREE.Vector3()) ?? undefined;
  }

  /** The place of the ground: x and z, metres of the scene; none at or above the horizon. */
  ground(x: number, y: number): [number, number] | undefined {
    const at = this.groundUnder(x, y);
    if (!at || at.distanceTo(this.camera().position) > FAR) return undefined;
    const { position, scale } = this.holder;
    const round = (v: number): number => Math.round((v / scale.x) * 1000) / 1000;
    return [round(at.x - position.x), round(at.z - position.z)];
  }

  /** How far the place of the ground is from the camera, metres of the scene. */
  groundDistance(x: number, y: number): number | undefined {
    const at = this.groundUnder(x, y);
    return at && this.camera().position.distanceTo(at) / this.holder.scale.x;
  }
}

/** A pointer that moved no further than this, pixels, clicked. */
const CLICK = 5;

/** Tells of clicks of the first button that no drag is; `free`: a click may mean something. */
export function listenForClicks(
  canvas: HTMLCanvasElement,
  free: () => boolean,
  clicked: (x: number, y: number, more: boolean) => void,
): void {
  let from: [number, number] | undefined;
  canvas.addEventListener('pointerdown', (e) => {
    from = e.button === 0 && e.isPrimary && free() ? [e.clientX, e.clientY] : undefined;
  });
  canvas.addEventListener('pointerup', (e) => {
    const still = from && Math.hypot(e.clientX - from[0], e.clientY - from[1]) <= CLICK;
    from = undefined;
    if (still) clicked(e.clientX, e.clientY, e.shiftKey || e.ctrlKey || e.metaKey);
  });
}
