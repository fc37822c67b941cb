/** Between points of the screen and the coordinates of a plant. */
import * as THREE from 'three';
import type { ShapePointer, ShapeReach } from '../wire';

type Camera = THREE.PerspectiveCamera | THREE.OrthographicCamera;

/** A ray of the world in the coordinates of a plant. */
export function pointerOf(
  { origin, direction }: THREE.Ray,
  camera: Camera,
  place: THREE.Object3D,
  pressure: number,
): ShapePointer {
  place.updateWorldMatrix(true, false);
  fromWorld.copy(place.matrixWorld).invert();
  return {
    origin: scratch.copy(origin).applyMatrix4(fromWorld).toArray(),
    direction: scratch.copy(direction).transformDirection(fromWorld).toArray(),
    forward: camera.getWorldDirection(scratch).transformDirection(fromWorld).toArray(),
    up: scratch.set(0, 1, 0).applyQuaternion(camera.quaternion).transformDirection(fromWorld).toArray(),
    pressure,
  };
}

// A headset asks in every picture: nothing is made for it but the answer.
const fromWorld = new THREE.Matrix4();
const scratch = new THREE.Vector3();

/** A share of the height of the screen, in metres of a plant. */
export function reachOf(
  camera: Camera,
  place: THREE.Object3D | undefined,
  share: number,
): Omit<ShapeReach, 'bearers'> {
  const size = (place?.getWorldScale(scratch).x ?? 1) || 1;
  if (camera instanceof THREE.OrthographicCamera)
    return { metres: (share * (camera.top - camera.bottom)) / size, per_metre: 0 };
  return { metres: 0, per_metre: 2 * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)) * share };
}

/** Points of a plant (x, y, z, radius) on a screen of `w` by `h` pixels: x, y and width; width 0 behind the eye. */
export function onScreen(
  camera: Camera,
  place: THREE.Object3D | undefined,
  w: number,
  h: number,
  points: Float32Array,
): Float32Array {
  const out = new Float32Array((points.length / 4) * 3);
  if (!place) return out;
  camera.updateMatrixWorld();
  place.updateWorldMatrix(true, false);
  const size = place.getWorldScale(new THREE.Vector3()).x;
  const eye = camera.matrixWorldInverse;
  const v = new THREE.Vector3();
  for (let i = 0, o = 0; i < points.length; i += 4, o += 3) {
    v.set(points[i]!, points[i + 1]!, points[i + 2]!)
      .applyMatrix4(place.matrixWorld)
      .applyMatrix4(eye);
    const depth = -v.z;
    v.applyMatrix4(camera.projectionMatrix);
    const wide =
      camera instanceof THREE.OrthographicCamera
        ? (points[i + 3]! * size * h) / (camera.top - camera.bottom)
        : (points[i + 3]! * size * h) /
          (2 * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)) * Math.max(1e-6, depth));
    out.set([((v.x + 1) / 2) * w, ((1 - v.y) / 2) * h, depth > 0 ? 2 * wide : 0], o);
  }
  return out;
}
