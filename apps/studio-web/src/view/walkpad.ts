/** A stick on the screen for whoever walks by a finger, buttons that rise and sink, and one that ends it. */
import { t } from '../text';
import { button, el } from '../page/ui';
import type { WalkMode } from './walk';

export interface PadEvents {
  /** Right, up and ahead, each -1 to 1. */
  go(right: number, up: number, ahead: number): void;
  end(): void;
}

/** A finger this far from the middle, in shares of the stick, goes at full pace. */
const FULL = 0.4;

export class WalkPad {
  readonly element: HTMLElement;
  private up = 0;
  private at: readonly [number, number] = [0, 0];

  constructor(
    mode: WalkMode,
    private readonly events: PadEvents,
  ) {
    const knob = el('span', { class: 'knob', 'aria-hidden': 'true' });
    const stick = el('div', { class: 'stick', id: 'b-walk-stick', 'aria-label': t('walk.stick') }, knob);
    const lead = (e: PointerEvent): void => {
      const box = stick.getBoundingClientRect();
      const share = (x: number, from: number, size: number): number =>
        Math.max(-1, Math.min(1, (x - from - size / 2) / (FULL * size)));
      const [right, ahead] = [share(e.clientX, box.left, box.width), -share(e.clientY, box.top, box.height)];
      knob.style.translate = `${right * FULL * box.width}px ${-ahead * FULL * box.height}px`;
      this.tell([right, ahead], this.up);
    };
    const rest = (): void => {
      knob.style.translate = '';
      this.tell([0, 0], this.up);
    };
    stick.addEventListener('pointerdown', (e) => {
      stick.setPointerCapture?.(e.pointerId);
      lead(e);
    });
    stick.addEventListener('pointermove', (e) => {
      if (e.buttons !== 0) lead(e);
    });
    for (const over of ['pointerup', 'pointercancel'] as const) stick.addEventListener(over, rest);
    const flies = mode === 'fly' ? [this.riser('rise', 1), this.riser('sink', -1)] : [];
    const end = button('close', t('walk.end'), () => events.end());
    end.id = 'b-walk-end';
    this.element = el('div', { class: 'walkpad' }, stick, el('div', { class: 'risers' }, ...flies, end));
    // The pad lies over the view, which would turn.
    for (const kind of ['pointerdown', 'pointermove', 'pointerup'] as const)
      this.element.addEventListener(kind, (e) => e.stopPropagation());
  }

  /** A button that rises or sinks as long as it is held. */
  private riser(key: 'rise' | 'sink', by: 1 | -1): HTMLElement {
    const go = (): void => this.tell(this.at, by);
    const stop = (): void => this.tell(this.at, 0);
    return el(
      'button',
      {
        type: 'button',
        class: 'chip',
        id: `b-walk-${key}`,
        onpointerdown: go,
        onpointerup: stop,
        onpointercancel: stop,
        onpointerleave: stop,
      },
      t(`walk.${key}`),
    );
  }

  private tell(at: readonly [number, number], up: number): void {
    [this.at, this.up] = [at, up];
    this.events.go(at[0], up, at[1]);
  }
}
