/** What the headset asks of the page. */
import type { Written } from '../exporting/exporting';
import type { GestureRecord, Obstacle, SetDown } from '../wire';
import type { Found } from './recorder';

export type Mode = 'immersive-vr' | 'immersive-ar';

export interface HeadsetEvents {
  undo(): void;
  redo(): void;
  /** Makes the plant another species, the next or the one before; what it is now, if it has any. */
  species(by: 1 | -1): Promise<string | undefined>;
  /** Another plant like the chosen one, beside it. */
  copy(): void;
  run(command: 'dice' | 'guide-grid' | 'guide-staff' | 'save'): void;
  /** Writes the scene as a model. */
  model(format: Written): void;
  /** The document as a project file. */
  project(): Promise<Uint8Array>;
  /** The plant that is worked on, the numbers of all, and the digest of what is seen of it. */
  seen(): Found & { digest: string | undefined };
  /** Hands a record to the browser. */
  write(record: GestureRecord): void;
  /** Sets an obstacle of the chosen plant down elsewhere. */
  setDown(row: number, how: SetDown): void;
  /** Shows at most so many triangles of all plants, the largest coarser; 0: all. */
  most(triangles: number): void;
  /** Makes what that would show, before it is wished for. */
  ready(triangles: number): void;
  /** Works on the next plant, the one before, or (0) this one; which it is then. */
  select(by: -1 | 0 | 1): { name: string; number: number; count: number } | undefined;
  /** Another plant of the same kind beside the others; it is worked on. */
  add(): void;
  /** How many obstacles the chosen plant has; undefined where it can have none. */
  obstacles(): number | undefined;
  obstruct(shape: Obstacle): void;
  /** Takes the last obstacle away. */
  clear(): void;
  /** It was entered, or left. */
  changed(on: boolean): void;
}
