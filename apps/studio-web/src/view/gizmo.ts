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
  private mode: 'translate' | 'rotate' | 'scale' = 'translate';
  private axis: 'x' | 'z' | undefined;

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
    this.mode = mode;
    this.only(this.axis);
    this.controls.attach(object);
    this.scene.add(helper);
  }

  /** Only one axis of the ground can be moved along, or both. */
  only(axis: 'x' | 'z' | undefined): void {
    this.axis = axis;
    const { controls, mode } = this;
    const bound = mode === 'translate' ? axis : undefined;
    controls.showX = mode !== 'rotate' && bound !== 'z';
    controls.showZ = mode !== 'rotate' && bound !== 'x';
    controls.showY = mode !== 'translate';
  }

  get isShown(): boolean {
    return this.controls.object !== undefined;
  }

  setVisible(on: boolean): void {
    this.controls.getHelper().visible = on && this.isShown;
  }

  /** A handle is under the pointer. */
  get isUnderPointer(): boolean {
    return this.controls.object !== undefined && this.controls.axis !== null;
  }

  setCamera(camera: Camera): void {
    this.controls.camera = camera;
  }
}
