/** How large the stage shows the plants, and where the camera stands so that all of them are seen. */
import * as THREE from 'three';
import type { Box } from '../sheet/geometry';
import { frameSheet, type Rig } from './camera';
import type { Guides } from './guides';
import type { Plants } from './plants';
import type { Stage } from './stage';

/** Height of the strip of tools with its options, pixels. */
const STRIP = 116;
/** So much of a plant may be in the ground before it is raised onto it, where the ground hides what is in it. */
const SUNK = 0.06;

/** Plants are shown beside panels as long as so much of the width is left to them. */
const LEAST_WIDTH = 0.3;

/** How far panels reach into the view from its sides, pixels. */
export interface Covered {
  readonly left: number;
  readonly right: number;
  readonly bottom: number;
}

/** What is framed, and with what. */
export interface Framed {
  readonly element: HTMLElement;
  readonly stage: Stage;
  readonly plants: Plants;
  /** Holds what is shown of the plants, at the size of the stage. */
  readonly holder: THREE.Group;
  readonly guides: Guides;
  readonly rig: Rig;
  /** The camera of the front view. */
  readonly flat: THREE.OrthographicCamera;
  /** Something is dragged: nothing may change its size under the hand. */
  isDragged(): boolean;
}

export class Framing {
  /** Units of the stage for each metre of the plants. */
  scale = 1;
  /** The front view is shown. */
  front = false;
  /** The camera is led to whatever is shown. */
  follow = true;
  /** A tool is in the hand: the first button is the tool's, the second turns the view. */
  hands = false;
  /** The plant to which the stage was fitted. */
  private fitted: number | null = null;
  /** The plant keeps its size, whatever it becomes. */
  private held = false;
  private sheetSeen: Box | undefined;
  /** What panels cover, and what they will once no hand works any more. */
  private covered: Covered = { left: 0, right: 0, bottom: 0 };
  private wanted = this.covered;

  constructor(private readonly of: Framed) {}

  /** Brings all that is seen to the size of the stage. */
  fit(): void {
    this.shadeAll();
    const { plants, holder, stage, guides, rig } = this.of;
    // Under a hand that works on it a plant keeps its size.
    if (this.of.isDragged() || this.held || (this.hands && this.fitted === plants.current)) return;
    const box = plants.bounds();
    const { min, max } = box;
    const size = max.clone().sub(min);
    const largest = Math.max(size.x, size.y, size.z);
    if (!(largest > 0)) return;
    this.fitted = plants.current;
    this.scale = 1 / largest;
    holder.scale.setScalar(this.scale);
    // One plant stands where it was drawn; several stand around the middle of the stage.
    const alone = this.front || plants.guest !== undefined;
    const [x, z] = alone
      ? [0, 0]
      : plants.named.size > 1
        ? [(min.x + max.x) / 2, (min.z + max.z) / 2]
        : plants.only;
    // Roots below the ground are shown: the ground sinks no plant. But the tip of a leaf may be in the grass.
    const sunk = stage.covers && -min.y < SUNK * size.y;
    const up = sunk ? 0 : Math.max(0, -min.y * this.scale);
    holder.position.set(-x * this.scale, up, -z * this.scale);
    // Beside the plants and not among them: it throws no shadow.
    guides.group.scale.copy(holder.scale);
    guides.group.position.copy(holder.position);
    stage.setMetre(this.scale);
    guides.setBox(box);
    this.shadeAll();
    if (this.follow) this.look(box, !rig.isLed);
  }

  /** Whatever was moved off the stage keeps its shadow. */
  private shadeAll(): void {
    const { min, max } = this.of.plants.bounds();
    if (min.x > max.x) return;
    const { x, z } = this.of.holder.position;
    const far = (low: number, high: number, at: number): number =>
      Math.max(Math.abs(low * this.scale + at), Math.abs(high * this.scale + at));
    this.of.stage.shadeUpTo(Math.hypot(far(min.x, max.x, x), far(min.z, max.z, z)));
  }

  /** Leads the camera to a box of metres. */
  look(box: THREE.Box3, now: boolean): void {
    if (box.isEmpty()) return;
    const { element, guides, holder, rig } = this.of;
    const seen = guides.any && !this.front ? guides.extend(box) : box;
    const { clientWidth: w, clientHeight: h } = element;
    const { left, right, bottom } = this.covered;
    const across = Math.max(1, Math.min(w - left - right, h - bottom)) / Math.max(1, h);
    const { position } = holder;
    const world = new THREE.Box3();
    for (const corner of [seen.min, seen.max])
      world.expandByPoint(corner.clone().multiplyScalar(this.scale).add(position));
    rig.frame(world, across, now);
  }

  /** Leads the camera to all plants, if it follows them. */
  lookAtAll(): void {
    if (this.follow) this.look(this.of.plants.bounds(), false);
  }

  /** Fits the stage anew, and follows it again. */
  reset(): void {
    this.follow = true;
    this.fitted = null;
    this.fit();
    this.lookAtAll();
  }

  /** The plants keep their size from now on, or fit the stage again. */
  hold(on: boolean): void {
    this.held = on;
    if (!on) this.fit();
  }

  /** With a tool in the hand the view keeps its size; the tools' strip lies over its foot. */
  setHands(on: boolean): void {
    this.hands = on;
    this.cover();
    this.lay();
    if (!on && this.follow) this.fit();
    else this.lookAtAll();
  }

  /** What panels cover from now on: plants are shown beside them. Whether that changes anything now. */
  setCovered(covered: Covered): boolean {
    const before = this.wanted;
    this.wanted = covered;
    const same =
      covered.left === before.left && covered.right === before.right && covered.bottom === before.bottom;
    // Under a hand the view stands still.
    if (this.hands || same) return false;
    this.cover();
    this.lay();
    this.lookAtAll();
    return true;
  }

  private cover(): void {
    const { left, right, bottom } = this.wanted;
    const room = (1 - LEAST_WIDTH) * this.of.element.clientWidth;
    this.covered = {
      left: left + right > room ? 0 : left,
      right,
      bottom: this.hands ? Math.max(STRIP, bottom) : bottom,
    };
  }

  /** How far the middle of what panels leave free lies from the middle of the view: rightwards and upwards, pixels. */
  get shift(): [number, number] {
    const { left, right, bottom } = this.covered;
    return [(left - right) / 2, bottom / 2];
  }

  /** The part of the plane that the sheet shows, which the front view shows, too. */
  setSheetSeen(box: Box): void {
    this.sheetSeen = box;
    if (this.front) this.lay();
  }

  /** Brings both cameras to the shape of the view. */
  lay(): void {
    const { element, plants, holder, flat } = this.of;
    const { far } = this.of.rig;
    const { clientWidth: w, clientHeight: h } = element;
    far.aspect = w / Math.max(1, h);
    const [x, y] = this.shift;
    if (x !== 0 || y !== 0) far.setViewOffset(w, h, -x, y, w, h);
    else far.clearViewOffset();
    far.updateProjectionMatrix();
    const front = plants.chosen?.view?.front;
    if (front && this.sheetSeen)
      frameSheet(flat, front, this.sheetSeen, this.scale, holder.position.y, far.aspect);
  }
}
