/** The scene of the view in a headset. */
import type * as THREE from 'three';
import type { Stage } from './stage';

export interface Immersed {
  renderer: THREE.WebGLRenderer;
  stage: Stage;
  /** The camera that a headset moves; it is where it was afterwards. */
  far: THREE.PerspectiveCamera;
  plants: THREE.Object3D;
  ended(): void;
}

/** What is beside the plants, and what is called before each picture. */
export interface Within {
  things: THREE.Object3D[];
  frame: (f: XRFrame, space: XRReferenceSpace) => void;
}

/** Gives the pictures of a scene to a session until it ends, from `rig`. `through`: the room is seen behind the plants. */
export async function immerse(
  { renderer, stage, far, plants, ended }: Immersed,
  session: XRSession,
  { floor, rig, through }: { floor: 'local-floor' | 'local'; rig: THREE.Group; through: boolean },
  { things, frame }: Within,
): Promise<void> {
  const [place, turn, lens] = [far.position.clone(), far.quaternion.clone(), far.fov];
  const { xr } = renderer;
  const left = (): void => {
    renderer.setAnimationLoop(null);
    xr.enabled = false;
    rig.remove(far);
    for (const thing of [rig, ...things]) thing.removeFromParent();
    far.position.copy(place);
    far.quaternion.copy(turn);
    far.fov = lens;
    stage.setBare(false);
    ended();
  };
  session.addEventListener('end', left);
  xr.enabled = true;
  xr.setReferenceSpaceType(floor);
  far.clearViewOffset();
  rig.add(far);
  stage.scene.add(rig, ...things);
  stage.setBare(through);
  await xr.setSession(session);
  renderer.setAnimationLoop((_, f) => {
    const space = xr.getReferenceSpace();
    if (f && space) frame(f, space);
    stage.prepare(true, far.aspect, plants);
    renderer.render(stage.scene, far);
  });
}
