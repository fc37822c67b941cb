/**
 * The first run: four steps, beside what they speak of. Nothing is blocked meanwhile: a stroke that begins on the card is
 * drawn on the sheet below, and Escape ends the tour wherever the keyboard is.
 */
import { setSetting, setting } from '../keeping/store';
import { t, type TextKey } from '../text';
import { el } from './ui';

interface Step {
  at: string;
  title: TextKey;
  text: TextKey;
}

const STEPS: readonly Step[] = [
  { at: '.sheet', title: 'tour.draw', text: 'tour.draw.text' },
  { at: '.right', title: 'tour.see', text: 'tour.see.text' },
  { at: '#b-select', title: 'tour.correct', text: 'tour.correct.text' },
  { at: '#b-export', title: 'tour.export', text: 'tour.export.text' },
];

let card: HTMLElement | undefined;

function leave(e: KeyboardEvent): void {
  if (e.key === 'Escape') show(STEPS.length);
}

export function firstRun(): void {
  if (setting('tour') !== 'done') tour();
}

export function tour(): void {
  show(0);
}

export function endTour(): void {
  card?.remove();
  card = undefined;
  removeEventListener('keydown', leave);
  document.querySelector('.toured')?.classList.remove('toured');
}

function show(i: number): void {
  endTour();
  const step = STEPS[i];
  const anchor = step && document.querySelector<HTMLElement>(step.at);
  if (!step || !anchor) {
    setSetting('tour', 'done');
    return;
  }
  const last = i === STEPS.length - 1;
  const next = el(
    'button',
    { type: 'button', class: 'primary', onclick: () => show(i + 1) },
    t(last ? 'tour.done' : 'tour.next'),
  );
  const skip = el(
    'button',
    { type: 'button', class: 'link', onclick: () => show(STEPS.length) },
    t('tour.skip'),
  );
  card = el(
    'div',
    { class: 'tour', role: 'dialog', 'aria-label': t(step.title) },
    el('span', { class: 'muted' }, `${i + 1} / ${STEPS.length}`),
    el('strong', {}, t(step.title)),
    el('p', {}, t(step.text)),
    el('div', { class: 'row' }, ...(last ? [] : [skip]), el('span', { class: 'space' }), next),
  );
  addEventListener('keydown', leave);
  document.body.append(card);
  anchor.classList.add('toured');
  place(card, anchor.getBoundingClientRect());
}

function place(c: HTMLElement, box: DOMRect): void {
  const { offsetWidth: w, offsetHeight: h } = c;
  const small = box.width < 200;
  const x = small
    ? box.left > innerWidth / 2
      ? box.right - w
      : box.right + 14
    : box.left + (box.width - w) / 2;
  const y = small ? (box.top < 60 ? box.bottom + 12 : box.top - 10) : box.bottom - h - 16;
  c.style.left = `${Math.min(innerWidth - w - 10, Math.max(10, x))}px`;
  c.style.top = `${Math.min(innerHeight - h - 10, Math.max(10, y))}px`;
}
