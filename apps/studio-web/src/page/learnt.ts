/** Which commands a person has used: the others bear their names under their icons. */
import { setSetting, setting } from '../keeping/store';

const known = new Set((setting('used') ?? '').split(' ').filter((id) => id !== ''));

export function isLearnt(id: string): boolean {
  return known.has(id);
}

/** It was used: its name goes, and does not come back in this browser. */
export function learn(id: string): void {
  if (known.has(id)) return;
  known.add(id);
  setSetting('used', [...known].join(' '));
  for (const name of document.querySelectorAll(`[data-learn="${id}"]`)) name.remove();
}
