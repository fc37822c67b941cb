/** A board at the wrist of the hand that does not work: tools, undo, how large one is. Pressed with the other hand. */
import * as THREE from 'three';
import { type IconName, pathOf } from '../page/icons';
import type { Controller } from './controller';

export interface Key {
  readonly id: string;
  readonly label: string;
  /** An icon before the label, as the page has it. */
  readonly icon?: IconName;
  /** Columns that it takes of `COLUMNS`. */
  readonly wide: number;
  readonly on?: boolean;
  /** A colour that is shown beside the label. */
  readonly swatch?: string;
  /** `hand`: that which presses it. */
  readonly act: (hand: Controller) => void;
}

const COLUMNS = 6;
/** Pixels of the picture, and its width, metres. */
const PIXELS = { width: 600, row: 84, head: 84, gap: 8 } as const;
const WIDTH_M = 0.22;
/** Letters, pixels: of 12 mm where there is room, read at half a metre; of two lines; and where there is no room at all. */
const LETTERS = { most: 32, lines: 28, least: 16 } as const;
/** An icon and the room before and after it, pixels; its grid and line, in units of that grid. */
const ICON = { px: 44, gap: 8, grid: 24, line: 2 } as const;
/** Where a line may be broken first. */
const BREAK = ' · ';
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
  /** The smallest letters of what was drawn last, pixels. */
  private smallest: number = LETTERS.most;

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

  /** Stands beside somebody who has one hand only: `head` is how that one's eyes are now. */
  rest(head: THREE.Matrix4): void {
    const [across, ahead] = [
      way.setFromMatrixColumn(head, 0).setY(0).normalize(),
      at.setFromMatrixColumn(head, 2),
    ];
    ahead.setY(0).normalize();
    place
      .setFromMatrixPosition(head)
      .addScaledVector(across, ASIDE.across)
      .addScaledVector(ahead, ASIDE.ahead);
    place.y += ASIDE.up;
    // Its face to the eyes.
    this.board.matrix.lookAt(size.setFromMatrixPosition(head), place, UP).setPosition(place);
    const tall = (WIDTH_M * this.canvas.height) / this.canvas.width;
    this.board.matrix.scale(size.set(WIDTH_M, tall, 1));
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

  /** How high the smallest letters on it are, millimetres of the person. */
  get lettersMm(): number {
    return (1000 * this.smallest * WIDTH_M) / PIXELS.width;
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
    this.smallest = LETTERS.most;
    this.writeHead(pen, width);
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
      const colour = key.on ? COLOURS.dark : COLOURS.text;
      const before = key.icon ? ICON.px + ICON.gap : 0;
      if (key.icon) drawIcon(pen, key.icon, [x + ICON.gap, y + (h - ICON.px) / 2], colour);
      const room = (key.swatch ? w - h : w - 12) - before;
      this.write(pen, key.label, x + before + room / 2 + 6, y + h / 2, room, colour);
      if (!key.swatch) continue;
      pen.fillStyle = key.swatch;
      pen.beginPath();
      pen.arc(x + w - h / 2, y + h / 2, h / 4, 0, 2 * Math.PI);
      pen.fill();
    }
    this.texture.needsUpdate = true;
  }

  /** The line above the keys, or two where it is long. */
  private writeHead(pen: CanvasRenderingContext2D, width: number): void {
    const [room, middle] = [width - 20, PIXELS.head / 2];
    pen.font = fontOf(LETTERS.lines);
    if (pen.measureText(this.head).width <= room) {
      this.write(pen, this.head, width / 2, middle, room, COLOURS.text);
      return;
    }
    const [first, second] = brokenLine(this.head);
    this.write(pen, first, width / 2, middle - 0.55 * LETTERS.lines, room, COLOURS.text, LETTERS.lines);
    this.write(pen, second, width / 2, middle + 0.6 * LETTERS.lines, room, COLOURS.text, LETTERS.lines);
  }

  private write(
    pen: CanvasRenderingContext2D,
    text: string,
    x: number,
    y: number,
    room: number,
    colour: string,
    most: number = LETTERS.most,
  ): void {
    pen.fillStyle = colour;
    let px = most;
    for (; px > LETTERS.least; px -= 2) {
      pen.font = fontOf(px);
      if (pen.measureText(text).width <= room) break;
    }
    pen.font = fontOf(px);
    this.smallest = Math.min(this.smallest, px);
    pen.fillText(text, x, y, room);
  }
}

/** Draws an icon with its upper left corner at a place. */
function drawIcon(
  pen: CanvasRenderingContext2D,
  name: IconName,
  [x, y]: [number, number],
  colour: string,
): void {
  pen.save();
  pen.translate(x, y);
  pen.scale(ICON.px / ICON.grid, ICON.px / ICON.grid);
  pen.strokeStyle = colour;
  pen.lineWidth = ICON.line;
  pen.lineCap = pen.lineJoin = 'round';
  pen.stroke(new Path2D(pathOf(name)));
  pen.restore();
}

const fontOf = (px: number): string => `600 ${px}px system-ui, sans-serif`;

/** A line in two of about the same length, broken where a part of it ends, at a space, or (in Chinese) anywhere. */
export function brokenLine(text: string): [string, string] {
  const middle = text.length / 2;
  for (const gap of [BREAK, ' ', '']) {
    let [best, off] = [-1, text.length / 4];
    for (let at = 1; at < text.length - 1; at += 1) {
      const away = Math.abs(at + gap.length / 2 - middle);
      if (text.startsWith(gap, at) && away <= off) [best, off] = [at, away];
    }
    if (best > 0) return [text.slice(0, best), text.slice(best + gap.length)];
  }
  return [text, ''];
}

interface Met {
  distance: number;
  key: Key | undefined;
}

/** Where the board stands without a hand to hold it, metres from the eyes. */
const ASIDE = { across: -0.3, ahead: -0.45, up: -0.25 } as const;
const UP = new THREE.Vector3(0, 1, 0);
const place = new THREE.Vector3();
const met: Met = { distance: 0, key: undefined };
const size = new THREE.Vector3();
const inverse = new THREE.Matrix4();
const at = new THREE.Vector3();
const way = new THREE.Vector3();
