/** Handles to move, turn and size a plant on the ground. Loaded when they are first asked for. */
import type { Camera, Object3D, Scene } from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';

export interface GizmoEvents {
  begin(): void;
  moved(): void;
  end(): void;
  redraw(): void;
}

export class Handles {
  private readonly controls: TransformControls;

  constructor(
    camera: Camera,
    canvas: HTMLElement,
    private readonly scene: Scene,
    events: GizmoEvents,
  ) {
    this.controls = new TransformControls(camera, canvas);
    this.controls.setSpace('local');
    this.controls.setSize(0.8);
    this.controls.addEventListener('dragging-changed', (e) => (e.value ? events.begin() : events.end()));
    this.controls.addEventListener('objectChange', () => events.moved());
    this.controls.addEventListener('change', () => events.redraw());
  }

  show(object: Object3D | undefined, mode: 'translate' | 'rotate' | 'scale' | undefined): void {
    const helper = this.controls.getHelper();
    if (!object || !mode) {
      this.controls.detach();
      this.scene.remove(helper);
      return;
    }
    this.controls.setMode(mode);
    // On the ground: moved along it, turned about the vertical, sized as a whole.
    this.controls.setSpace(mode === 'translate' ? 'world' : 'local');
    this.controls.showX = this.controls.showZ = mode !== 'rotate';
    this.controls.showY = mode !== 'translate';
    this.controls.attach(object);
    this.scene.add(helper);
  }

  setCamera(camera: Camera): void {
    this.controls.camera = camera;
  }
}
