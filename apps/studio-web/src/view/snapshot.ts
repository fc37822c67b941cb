/** A small picture of another plant, on the stage of the view. */
import * as THREE from 'three';
import type { Sent } from '../worker/protocol';
import type { Looks } from './plant';
import type { Stage } from './stage';

type Triple = readonly [number, number, number];

/** Brings a plant of these bounds to the size of the stage and onto its ground: where its middle is then, and how far it reaches. */
export function stand(
  group: THREE.Group,
  bounds: { readonly min: Triple; readonly max: Triple },
): { metre: number; middle: THREE.Vector3; radius: number } {
  const [min, max] = [new THREE.Vector3(...bounds.min), new THREE.Vector3(...bounds.max)];
  const size = max.clone().sub(min);
  const metre = 1 / Math.max(size.x, size.y, size.z, 1e-9);
  group.scale.setScalar(metre);
  group.position.y = Math.max(0, -min.y * metre);
  const middle = min
    .add(max)
    .multiplyScalar(metre / 2)
    .add(group.position);
  return { metre, middle, radius: (size.length() * metre) / 2 };
}

/** So far from its middle a camera sees all of it. */
export const awayOf = (radius: number, { fov, aspect }: THREE.PerspectiveCamera): number =>
  (0.96 * radius) / Math.sin(THREE.MathUtils.degToRad(fov / 2)) / Math.min(1, aspect);

/** Draws it alone, from where `eye` looks at `target`. The stage, the renderer's size and its shadows are another's then. */
export function snapshotOf(
  sent: Sent,
  { renderer, stage, looks }: { renderer: THREE.WebGLRenderer; stage: Stage; looks: Looks },
  [eye, aim]: readonly [THREE.PerspectiveCamera, THREE.Vector3],
  [width, height]: readonly [number, number],
): HTMLCanvasElement {
  const group = looks.build(sent);
  const { middle, radius } = stand(group, sent.view);
  const camera = new THREE.PerspectiveCamera(eye.fov, width / height, 0.01, 200);
  const away = awayOf(radius, camera);
  camera.position.copy(eye.position).sub(aim).setLength(away).add(middle);
  camera.lookAt(middle);
  stage.setFlat(false);
  stage.prepare(true, width / height, group);
  stage.scene.add(group);
  renderer.setPixelRatio(1);
  renderer.setSize(width, height, false);
  renderer.shadowMap.needsUpdate = true;
  renderer.render(stage.scene, camera);
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [width, height];
  canvas.getContext('2d')?.drawImage(renderer.domElement, 0, 0);
  stage.scene.remove(group);
  for (const mesh of group.children) (mesh as THREE.Mesh).geometry.dispose();
  return canvas;
}
