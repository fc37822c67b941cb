/** Obstacles are dragged: along the ground, with Shift up and down. The tree grows when they are let go. */
import * as THREE from 'three';

export interface ObstacleEvents {
  /** The obstacle under a point of the screen, if nothing of a plant lies before it, and where it was met. */
  at(x: number, y: number): { mesh: THREE.Mesh; place: THREE.Object3D; point: THREE.Vector3 } | undefined;
  /** Whether one could be taken there. */
  over(x: number, y: number): boolean;
  ray(x: number, y: number): THREE.Ray;
  /** The view stands still while one is held. */
  hold(on: boolean): void;
  redraw(): void;
  /** So far, metres in the coordinates of its plant. */
  moved(row: number, by: [number, number, number]): void;
}

interface Held {
  readonly pointer: number;
  readonly mesh: THREE.Mesh;
  readonly place: THREE.Object3D;
  /** Where it was taken, of the world. */
  readonly from: THREE.Vector3;
  readonly home: THREE.Vector3;
  /** Where the pointer went on from when Shift was last pressed or released, and how far it was then. */
  start: THREE.Vector3;
  moved: THREE.Vector3;
  upright: boolean;
}

/** A hand that trembles moves nothing: so many pixels. */
const CLICK = 4;

/** Listens on the canvas before the camera does. */
export function dragObstacles(canvas: HTMLElement, events: ObstacleEvents): void {
  let held: Held | undefined;
  let first: [number, number] = [0, 0];
  let far = false;
  const plane = ({ start }: Held, upright: boolean, ray: THREE.Ray): THREE.Plane => {
    const normal = new THREE.Vector3(0, 1, 0);
    // Upright it faces the eye.
    if (upright) normal.set(-ray.direction.x, 0, -ray.direction.z).normalize();
    return new THREE.Plane().setFromNormalAndCoplanarPoint(normal, start);
  };
  const hitOf = (h: Held, e: PointerEvent): THREE.Vector3 | null => {
    const ray = events.ray(e.clientX, e.clientY);
    return ray.intersectPlane(plane(h, h.upright, ray), new THREE.Vector3());
  };
  const done = (keep: boolean): void => {
    if (!held) return;
    const { mesh, home, pointer } = held;
    const by = mesh.position.clone().sub(home);
    held = undefined;
    if (canvas.hasPointerCapture(pointer)) canvas.releasePointerCapture(pointer);
    canvas.style.cursor = '';
    const round = (x: number): number => Math.round(x * 1000) / 1000;
    const way: [number, number, number] = [round(by.x), round(by.y), round(by.z)];
    const goes = keep && far && way.some((x) => x !== 0);
    if (!goes) mesh.position.copy(home);
    events.hold(false);
    if (goes) events.moved(mesh.userData['row'] as number, way);
    events.redraw();
  };
  canvas.addEventListener(
    'pointerdown',
    (e) => {
      if (held || e.button !== 0 || !e.isPrimary) return;
      const hit = events.at(e.clientX, e.clientY);
      if (!hit) return;
      e.stopImmediatePropagation();
      e.preventDefault();
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(e.pointerId);
      canvas.style.cursor = 'grabbing';
      [first, far] = [[e.clientX, e.clientY], false];
      const { mesh, place, point } = hit;
      const home = mesh.position.clone();
      held = {
        pointer: e.pointerId,
        mesh,
        place,
        from: point,
        home,
        start: point.clone(),
        moved: new THREE.Vector3(),
        upright: e.shiftKey,
      };
      events.hold(true);
    },
    { capture: true },
  );
  canvas.addEventListener(
    'pointermove',
    (e) => {
      if (!held) {
        if (e.buttons === 0 && e.pointerType !== 'touch')
          canvas.style.cursor = events.over(e.clientX, e.clientY) ? 'grab' : '';
        return;
      }
      if (e.pointerId !== held.pointer) return;
      e.stopImmediatePropagation();
      far ||= Math.hypot(e.clientX - first[0], e.clientY - first[1]) > CLICK;
      if (e.shiftKey !== held.upright) {
        // On from where it is.
        held.start = held.from.clone().add(held.moved);
        held.upright = e.shiftKey;
      }
      const hit = hitOf(held, e);
      if (!far || !hit) return;
      const now = hit.sub(held.from);
      if (held.upright) [now.x, now.z] = [held.moved.x, held.moved.z];
      else now.y = held.moved.y;
      held.moved.copy(now);
      // The world's way in the coordinates of the plant: turned and sized.
      held.place.updateWorldMatrix(true, false);
      const origin = held.place.worldToLocal(new THREE.Vector3());
      held.mesh.position.copy(held.place.worldToLocal(now.clone()).sub(origin)).add(held.home);
      events.redraw();
    },
    { capture: true },
  );
  canvas.addEventListener('pointerup', (e) => {
    if (e.pointerId === held?.pointer) done(true);
  });
  canvas.addEventListener('pointercancel', () => done(false));
  document.addEventListener(
    'keydown',
    (e) => {
      if (!held || e.key !== 'Escape') return;
      e.preventDefault();
      e.stopImmediatePropagation();
      done(false);
    },
    { capture: true },
  );
}

/** The first of some obstacles in which a point lies (in the coordinates of their plant), and its row. Walls have no inside. */
export function obstacleAround(
  all: readonly THREE.Mesh[],
  at: readonly [number, number, number],
): { row: number; thing: THREE.Object3D } | undefined {
  const point = new THREE.Vector3();
  const thing = all.find((mesh) => {
    const { geometry } = mesh;
    if (geometry instanceof THREE.PlaneGeometry) return false;
    mesh.updateMatrix();
    point.set(...at).applyMatrix4(mesh.matrix.clone().invert());
    if (geometry instanceof THREE.SphereGeometry) return point.length() <= geometry.parameters.radius;
    geometry.computeBoundingBox();
    return geometry.boundingBox?.containsPoint(point) ?? false;
  });
  return thing && { row: Number(thing.userData['row']), thing };
}
