/** A board at the wrist of the hand that does not work: tools, undo, how large one is. Pressed with the other hand. */
import * as THREE from 'three';
import type { Controller } from './controller';

export interface Key {
  readonly id: string;
  readonly label: string;
  /** Columns that it takes of `COLUMNS`. */
  readonly wide: number;
  readonly on?: boolean;
  /** `hand`: that which presses it. */
  readonly act: (hand: Controller) => void;
}

const COLUMNS = 6;
/** Pixels of the picture, and its width, metres: letters are 12 mm high, read at half a metre. */
const PIXELS = { width: 600, row: 84, head: 72, gap: 8 } as const;
const WIDTH_M = 0.22;
/** Above the back of the hand, leaning towards the eyes. */
const OVER_HAND = new THREE.Matrix4().makeRotationX(-0.9).setPosition(0, 0.09, -0.02);
const COLOURS = {
  board: '#10261d',
  key: '#23503f',
  on: '#d8f3c4',
  under: '#3f8f6d',
  text: '#f4fbf3',
  dark: '#10261d',
} as const;

interface Placed extends Key {
  readonly x: number;
  readonly y: number;
  readonly w: number;
}

/** Keys in rows of `COLUMNS`. */
export function layOut(rows: readonly (readonly Key[])[]): Placed[] {
  return rows.flatMap((row, r) => {
    let column = 0;
    return row.map((key) => {
      const placed = { ...key, x: column / COLUMNS, y: r, w: key.wide / COLUMNS };
      column += key.wide;
      return placed;
    });
  });
}

export class Wrist {
  readonly board: THREE.Mesh<THREE.PlaneGeometry, THREE.MeshBasicMaterial>;
  private readonly canvas = document.createElement('canvas');
  private readonly texture = new THREE.CanvasTexture(this.canvas);
  private keys: Placed[] = [];
  private head = '';
  private under: string | undefined;
  private seen = '';

  constructor() {
    this.texture.colorSpace = THREE.SRGBColorSpace;
    this.texture.anisotropy = 4;
    // Drawn with what is transparent, after the ground.
    const look = new THREE.MeshBasicMaterial({ map: this.texture, toneMapped: false, transparent: true });
    this.board = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), look);
    this.board.matrixAutoUpdate = false;
    // Not behind a leaf that hangs there.
    look.depthTest = false;
    this.board.renderOrder = 10;
  }

  set(rows: readonly (readonly Key[])[]): void {
    this.keys = layOut(rows);
    const now = JSON.stringify(this.keys);
    if (now === this.seen) return;
    this.seen = now;
    const height = PIXELS.head + rows.length * PIXELS.row;
    if (this.canvas.height !== height || this.canvas.width !== PIXELS.width) {
      [this.canvas.width, this.canvas.height] = [PIXELS.width, height];
      // Another size is another texture.
      this.texture.dispose();
    }
    this.draw();
  }

  /** A line above the keys. */
  say(text: string): void {
    if (text === this.head) return;
    this.head = text;
    this.draw();
  }

  /** Goes with a hand. */
  follow(hand: THREE.Matrix4): void {
    const tall = (WIDTH_M * this.canvas.height) / this.canvas.width;
    this.board.matrix.multiplyMatrices(hand, OVER_HAND).scale(size.set(WIDTH_M, tall, 1));
    this.board.matrixWorldNeedsUpdate = true;
  }

  /** Where a ray of the person's space meets the board: the distance, and the key that it means. Good until the next call. */
  meet(from: THREE.Vector3, direction: THREE.Vector3): Readonly<Met> | undefined {
    if (!this.board.visible) return undefined;
    inverse.copy(this.board.matrix).invert();
    at.copy(from).applyMatrix4(inverse);
    way.copy(from).add(direction).applyMatrix4(inverse).sub(at);
    const t = -at.z / way.z;
    if (!(t >= 0 && Number.isFinite(t))) return undefined;
    at.addScaledVector(way, t);
    const u = at.x + 0.5;
    const v = 0.5 - at.y;
    if (u < 0 || u > 1 || v < 0 || v > 1) return undefined;
    const row = (v * this.canvas.height - PIXELS.head) / PIXELS.row;
    met.distance = t;
    met.key = undefined;
    for (const k of this.keys) if (u >= k.x && u < k.x + k.w && row >= k.y && row < k.y + 1) met.key = k;
    return met;
  }

  /** What the line above the keys says. */
  get text(): string {
    return this.head;
  }

  /** Where the middle of each key is, in the person's space. */
  places(): Record<string, number[]> {
    const { height } = this.canvas;
    return Object.fromEntries(
      this.keys.map((k) => {
        const v = (PIXELS.head + (k.y + 0.5) * PIXELS.row) / height;
        at.set(k.x + k.w / 2 - 0.5, 0.5 - v, 0).applyMatrix4(this.board.matrix);
        return [k.id, at.toArray()];
      }),
    );
  }

  /** The key that is pointed at. */
  point(key: Key | undefined): void {
    if (key?.id === this.under) return;
    this.under = key?.id;
    this.draw();
  }

  dispose(): void {
    this.texture.dispose();
    this.board.geometry.dispose();
    this.board.material.dispose();
  }

  private draw(): void {
    const pen = this.canvas.getContext('2d');
    if (!pen) return;
    const { width, height } = this.canvas;
    pen.fillStyle = COLOURS.board;
    pen.fillRect(0, 0, width, height);
    pen.textBaseline = 'middle';
    pen.textAlign = 'center';
    this.write(pen, this.head, width / 2, PIXELS.head / 2, width - 20, COLOURS.text);
    const { gap, row, head } = PIXELS;
    for (const key of this.keys) {
      const [x, y, w, h] = [
        key.x * width + gap / 2,
        head + key.y * row + gap / 2,
        key.w * width - gap,
        row - gap,
      ];
      pen.fillStyle = key.on ? COLOURS.on : key.id === this.under ? COLOURS.under : COLOURS.key;
      pen.beginPath();
      pen.roundRect(x, y, w, h, 14);
      pen.fill();
      if (key.on && key.id === this.under) {
        pen.lineWidth = 5;
        pen.strokeStyle = COLOURS.under;
        pen.stroke();
      }
      this.write(pen, key.label, x + w / 2, y + h / 2, w - 12, key.on ? COLOURS.dark : COLOURS.text);
    }
    this.texture.needsUpdate = true;
  }

  private write(
    pen: CanvasRenderingContext2D,
    text: string,
    x: number,
    y: number,
    room: number,
    colour: string,
  ): void {
    pen.fillStyle = colour;
    for (let px = 32; px >= 16; px -= 2) {
      pen.font = `600 ${px}px system-ui, sans-serif`;
      if (px === 16 || pen.measureText(text).width <= room) break;
    }
    pen.fillText(text, x, y, room);
  }
}

interface Met {
  distance: number;
  key: Key | undefined;
}

const met: Met = { distance: 0, key: undefined };
const size = new THREE.Vector3();
const inverse = new THREE.Matrix4();
const at = new THREE.Vector3();
const way = new THREE.Vector3();
