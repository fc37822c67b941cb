/** What the parts of a controller do, written beside them until each was used. */
import * as THREE from 'three';
import type { Controller, Part } from './controller';

/** Of a label, metres; beside the part, in the space of the grip. */
const SIZE = [0.09, 0.0225] as const;
const PLACES: Partial<Record<Part, readonly [number, number, number]>> = {
  trigger: [0, 0.005, -0.075],
  grip: [0, -0.035, -0.005],
  upper: [0, 0.055, -0.01],
  stick: [0, 0.03, -0.045],
};
const PIXELS = [512, 128] as const;
/** A label that was used fades away in so many frames. */
const FADE = 45;

interface Label {
  readonly part: Part;
  readonly sprite: THREE.Sprite;
  /** Frames until it is gone; undefined before it was used. */
  left: number | undefined;
}

/** The labels of one hand. */
export class Labels {
  readonly group = new THREE.Group();
  private labels: Label[] = [];

  /** `texts`: of the parts that have labels; those in `used` have none any more. `aside`: metres beside the other hand. */
  constructor(
    texts: Partial<Record<Part, string>>,
    used: ReadonlySet<string>,
    private readonly name: 'work' | 'other',
    private readonly onUsed: (name: string) => void,
    aside = 0,
  ) {
    for (const [part, text] of Object.entries(texts) as [Part, string][]) {
      const at = PLACES[part];
      if (!at || used.has(`${name}.${part}`)) continue;
      const sprite = new THREE.Sprite(written(text));
      // The board stands over the other hand: its labels are beside it, one under the other.
      if (name === 'other') sprite.position.set(aside, 0.03 - 0.03 * this.labels.length, 0);
      else sprite.position.set(...at);
      sprite.scale.set(...SIZE, 1);
      sprite.renderOrder = 11;
      this.group.add(sprite);
      this.labels.push({ part, sprite, left: undefined });
    }
    this.group.matrixAutoUpdate = false;
  }

  /** Every frame: goes with the hand. Fingers have no parts to label. */
  follow(hand: Controller | undefined): void {
    this.group.visible = false;
    if (!hand?.tracked || hand.isHand) return;
    this.group.visible = this.labels.length > 0;
    this.group.matrix.copy(hand.grip);
    this.group.matrixWorldNeedsUpdate = true;
    for (const label of this.labels) {
      const { thumb } = hand;
      const used = label.part === 'stick' ? Math.hypot(thumb[0], thumb[1]) > 0.6 : hand.holds(label.part);
      if (used && label.left === undefined) {
        label.left = FADE;
        this.onUsed(`${this.name}.${label.part}`);
      }
      if (label.left === undefined) continue;
      label.left -= 1;
      label.sprite.material.opacity = Math.max(0, label.left / FADE);
      label.sprite.visible = label.left > 0;
    }
  }

  /** How many are still to be read. */
  get shown(): number {
    return this.labels.filter((l) => l.left === undefined).length;
  }

  dispose(): void {
    for (const { sprite } of this.labels) {
      sprite.material.map?.dispose();
      sprite.material.dispose();
    }
    this.group.removeFromParent();
  }
}

/** What grows in the hand, in numbers beside it. */
export class Readout {
  private readonly canvas = document.createElement('canvas');
  readonly sprite = new THREE.Sprite(spriteOf(this.canvas));
  private said: string | undefined;

  constructor() {
    this.sprite.scale.set(2 * SIZE[0], 2 * SIZE[1], 1);
    this.sprite.renderOrder = 11;
    this.sprite.visible = false;
  }

  /** Undefined: nothing is to be read. */
  say(text: string | undefined): void {
    if (text === this.said) return;
    this.said = text;
    if (text === undefined) return;
    write(this.canvas, text);
    this.sprite.material.map!.needsUpdate = true;
  }

  get text(): string {
    return this.said ?? '';
  }

  /** Every frame: above the hand that works, or its fingers. */
  follow(hand: Controller | undefined): void {
    this.sprite.visible = this.said !== undefined && (hand?.tracked ?? false);
    if (hand) this.sprite.position.copy(hand.tip).setY(hand.tip.y + 0.06);
  }
}

function written(text: string): THREE.SpriteMaterial {
  const canvas = document.createElement('canvas');
  write(canvas, text);
  return spriteOf(canvas);
}

function write(canvas: HTMLCanvasElement, text: string): void {
  [canvas.width, canvas.height] = PIXELS;
  const pen = canvas.getContext('2d');
  if (pen) {
    pen.fillStyle = '#10261d';
    pen.beginPath();
    pen.roundRect(4, 4, PIXELS[0] - 8, PIXELS[1] - 8, 40);
    pen.fill();
    pen.fillStyle = '#f4fbf3';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    for (let px = 60; px >= 24; px -= 4) {
      pen.font = `600 ${px}px system-ui, sans-serif`;
      if (pen.measureText(text).width <= PIXELS[0] - 60) break;
    }
    pen.fillText(text, PIXELS[0] / 2, PIXELS[1] / 2, PIXELS[0] - 60);
  }
}

function spriteOf(canvas: HTMLCanvasElement): THREE.SpriteMaterial {
  const map = new THREE.CanvasTexture(canvas);
  map.colorSpace = THREE.SRGBColorSpace;
  return new THREE.SpriteMaterial({ map, transparent: true, depthTest: false, toneMapped: false });
}
