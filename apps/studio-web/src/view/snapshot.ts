/** A small picture of another plant, on the stage of the view. */
import * as THREE from 'three';
import type { Sent } from '../protocol';
import type { Looks } from './plant';
import type { Stage } from './stage';

/** Draws it alone, from where `eye` looks at `target`. The stage, the renderer's size and its shadows are another's then. */
export function snapshotOf(
  sent: Sent,
  { renderer, stage, looks }: { renderer: THREE.WebGLRenderer; stage: Stage; looks: Looks },
  [eye, aim]: readonly [THREE.PerspectiveCamera, THREE.Vector3],
  [width, height]: readonly [number, number],
): HTMLCanvasElement {
  const group = looks.build(sent);
  const [min, max] = [new THREE.Vector3(...sent.view.min), new THREE.Vector3(...sent.view.max)];
  const size = max.clone().sub(min);
  const scale = 1 / Math.max(size.x, size.y, size.z, 1e-9);
  group.scale.setScalar(scale);
  group.position.y = Math.max(0, -min.y * scale);
  const camera = new THREE.PerspectiveCamera(eye.fov, width / height, 0.01, 200);
  const target = min
    .clone()
    .add(max)
    .multiplyScalar(scale / 2);
  target.y += group.position.y;
  const distance =
    (size.length() * scale * 0.48) /
    Math.sin(THREE.MathUtils.degToRad(camera.fov / 2)) /
    Math.min(1, width / height);
  camera.position.copy(eye.position).sub(aim).setLength(distance).add(target);
  camera.lookAt(target);
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
