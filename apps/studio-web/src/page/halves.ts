/** The sheet and the view with a bar between them, and either of them as wide as the page. */
import { t } from '../text';
import { el } from './ui';

export type Half = 'sheet' | 'view';

/** Percent of the page that the sheet may have beside the view; beyond, one of them fills it. */
const BESIDE = { least: 20, most: 80 } as const;
/** A bar that is dragged nearer to the edge than this, percent, leaves the page to the other side. */
const EDGE = 8;
/** An arrow key moves the bar so far, percent. */
const STEP = 3;

/** The share of the sheet, percent, where a bar is left at `wanted`: 0 and 100 where one side fills the page. */
function settledAt(wanted: number): number {
  if (wanted < EDGE) return 0;
  if (wanted > 100 - EDGE) return 100;
  return Math.min(BESIDE.most, Math.max(BESIDE.least, wanted));
}

export class Halves {
  readonly element: HTMLElement;
  private readonly bar = el('div', {
    class: 'split',
    role: 'separator',
    'aria-orientation': 'vertical',
    'aria-label': t('split.label'),
    'aria-valuemin': '0',
    'aria-valuemax': '100',
    'aria-valuenow': '50',
    tabindex: '0',
  });
  private share = 50;
  /** What both had when one of them was made to fill the page. */
  private before = 50;

  /** `over`: what lies over both. */
  constructor(left: HTMLElement, right: HTMLElement, over: HTMLElement) {
    const { bar } = this;
    this.element = el('main', {}, left, bar, right, over);
    bar.addEventListener('pointerdown', (e) => bar.setPointerCapture(e.pointerId));
    bar.addEventListener('pointermove', (e) => this.drag(e));
    bar.addEventListener('keydown', (e) => {
      const by = { ArrowLeft: -STEP, ArrowUp: -STEP, ArrowRight: STEP, ArrowDown: STEP }[e.key];
      const to = { Home: 0, End: 100 }[e.key];
      if (by === undefined && to === undefined) return;
      e.preventDefault();
      // From the edge the bar comes back to where both are seen.
      this.set(to ?? Math.min(BESIDE.most, Math.max(BESIDE.least, this.share + by!)));
    });
  }

  /** One of them fills the page, or both are seen again if it did. */
  fill(half: Half): void {
    const whole = half === 'sheet' ? 100 : 0;
    this.set(this.share === whole ? this.before : whole);
  }

  private drag(e: PointerEvent): void {
    if (!this.bar.hasPointerCapture(e.pointerId)) return;
    const box = this.element.getBoundingClientRect();
    const upright = box.height > box.width;
    this.set(
      settledAt(
        upright ? ((e.clientY - box.top) / box.height) * 100 : ((e.clientX - box.left) / box.width) * 100,
      ),
    );
  }

  private set(share: number): void {
    if (this.share > 0 && this.share < 100) this.before = this.share;
    this.share = share;
    const { element, bar } = this;
    element.style.setProperty('--left', `${share}%`);
    element.dataset['filled'] = share === 0 ? 'view' : share === 100 ? 'sheet' : '';
    bar.setAttribute('aria-valuenow', String(Math.round(share)));
  }
}
