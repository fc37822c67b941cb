/** The short names of buttons under their icons: there until the person hides them. */
import { setSetting, setting } from '../keeping/store';
import { el } from './ui';

let shown = setting('names') !== 'hidden';

/** Gives a button a short name, which it bears under its icon while names are shown. */
export function nameButton(b: HTMLButtonElement, name: string): HTMLButtonElement {
  b.dataset['short'] = name;
  caption(b);
  return b;
}

function caption(b: HTMLElement): void {
  b.querySelector('.caption')?.remove();
  if (shown) b.append(el('span', { class: 'caption', 'aria-hidden': 'true' }, b.dataset['short'] ?? ''));
}

/** Hides the names that are shown, or shows them again; the browser keeps that. */
export function toggleNames(): void {
  shown = !shown;
  setSetting('names', shown ? 'shown' : 'hidden');
  for (const b of document.querySelectorAll<HTMLElement>('[data-short]')) caption(b);
}

export const areNamesShown = (): boolean => shown;
