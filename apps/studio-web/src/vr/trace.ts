/** What a hand draws, as it is seen while it does: a tube in the air, in a colour and as thick as the person likes. */
import * as THREE from 'three';
import { setSetting, setting } from '../keeping/store';

/** Points of a tube at most, and corners around each. */
const MOST = 2048;
const SIDES = 5;
/** Nearer to the last point than this share of the radius, a hand draws nothing new. */
const APART = 0.6;
/** Without pressure it is this share as thick as with all of it. */
const LIGHT = 0.4;
export const COLOURS = [0x9be07a, 0xffffff, 0xffd34d, 0x6fc7ff, 0xff8fb0] as const;
/** Across, millimetres of the person. */
export const THICKNESS_MM = [3, 6, 12] as const;

/** Of a list, what was kept under a name; the first where nothing was, or nonsense. */
function kept(name: string, list: readonly number[]): number {
  const row = Number(setting(name));
  return Number.isInteger(row) && row >= 0 && row < list.length ? row : 0;
}

export class Trace {
  private readonly geometry = new THREE.BufferGeometry();
  private readonly corners = new THREE.BufferAttribute(new Float32Array(3 * SIDES * MOST), 3);
  readonly mesh = new THREE.Mesh(this.geometry, new THREE.MeshBasicMaterial({ toneMapped: false }));
  private colour = kept('vr.trace.colour', COLOURS);
  private thickness = kept('vr.trace.thick', THICKNESS_MM);
  private count = 0;
  private readonly last = new THREE.Vector3();
  private firstRadius = 0;
  /** Across the tube where it ends. */
  private readonly across = new THREE.Vector3();
  /** Of the corners, what the card does not have yet. */
  private readonly fresh = { start: 0, count: 0 };

  constructor() {
    this.corners.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute('position', this.corners);
    this.geometry.setIndex(new THREE.BufferAttribute(tubeCorners(), 1));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 9;
    this.mesh.visible = false;
    this.mesh.material.color.setHex(this.hex);
    this.begin();
  }

  get hex(): number {
    return COLOURS[this.colour]!;
  }

  get mm(): number {
    return THICKNESS_MM[this.thickness]!;
  }

  nextColour(): void {
    this.colour = (this.colour + 1) % COLOURS.length;
    setSetting('vr.trace.colour', String(this.colour));
    this.mesh.material.color.setHex(this.hex);
  }

  nextThickness(): void {
    this.thickness = (this.thickness + 1) % THICKNESS_MM.length;
    setSetting('vr.trace.thick', String(this.thickness));
  }

  /** Nothing is drawn yet. */
  begin(): void {
    this.count = 0;
    this.geometry.setDrawRange(0, 0);
  }

  /** Points of it. */
  get points(): number {
    return this.count;
  }

  /** The hand is here (in the scene) and presses so much, 0 to 1; `metre`: one of the person, in units of the scene. */
  add(at: THREE.Vector3, pressure: number, metre: number): void {
    const radius = ((this.mm * metre) / 2000) * (LIGHT + (1 - LIGHT) * THREE.MathUtils.clamp(pressure, 0, 1));
    if (this.count >= MOST || !Number.isFinite(at.x + at.y + at.z)) return;
    if (this.count === 0) {
      this.firstRadius = radius;
      this.across.set(0, 0, 0);
    } else {
      along.subVectors(at, this.last);
      if (along.length() < APART * radius) return;
      along.normalize();
      this.turn();
      // Which way it goes from its first point is known now.
      if (this.count === 1) this.ring(0, this.last, this.firstRadius);
      this.ring(this.count, at, radius);
    }
    this.last.copy(at);
    this.count += 1;
    this.geometry.setDrawRange(0, 6 * SIDES * Math.max(0, this.count - 1));
  }

  /** Turns what lies across with the way it goes, without a twist. */
  private turn(): void {
    const { across } = this;
    across.addScaledVector(along, -across.dot(along));
    if (across.lengthSq() < 1e-6) {
      across.set(0, 1, 0);
      if (Math.abs(along.y) > 0.9) across.set(1, 0, 0);
      across.addScaledVector(along, -across.dot(along));
    }
    across.normalize();
    beside.crossVectors(along, across);
  }

  private ring(row: number, at: THREE.Vector3, radius: number): void {
    for (let side = 0; side < SIDES; side += 1) {
      corner
        .copy(at)
        .addScaledVector(this.across, radius * COSINES[side]!)
        .addScaledVector(beside, radius * SINES[side]!);
      this.corners.setXYZ(row * SIDES + side, corner.x, corner.y, corner.z);
    }
    const { fresh, corners } = this;
    const ranges = corners.updateRanges;
    const [from, to] = [3 * SIDES * row, 3 * SIDES * (row + 1)];
    if (ranges.length === 0) {
      [fresh.start, fresh.count] = [from, to - from];
      ranges.push(fresh);
    } else {
      const start = Math.min(fresh.start, from);
      fresh.count = Math.max(fresh.start + fresh.count, to) - start;
      fresh.start = start;
    }
    corners.needsUpdate = true;
  }
}

/** Of a tube of the most points: two triangles for each side between two rings. */
function tubeCorners(): Uint16Array {
  const all = new Uint16Array(6 * SIDES * (MOST - 1));
  let k = 0;
  for (let row = 0; row + 1 < MOST; row += 1)
    for (let side = 0; side < SIDES; side += 1) {
      const [a, b] = [row * SIDES + side, row * SIDES + ((side + 1) % SIDES)];
      for (const corner of [a, b, a + SIDES, b, b + SIDES, a + SIDES]) {
        all[k] = corner;
        k += 1;
      }
    }
  return all;
}

const COSINES = Array.from({ length: SIDES }, (_, k) => Math.cos((2 * Math.PI * k) / SIDES));
const SINES = Array.from({ length: SIDES }, (_, k) => Math.sin((2 * Math.PI * k) / SIDES));
const along = new THREE.Vector3();
const beside = new THREE.Vector3();
const corner = new THREE.Vector3();
