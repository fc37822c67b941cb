/** Light or dark: as the person chose, else as the system is set. */
import { setSetting, setting } from '../keeping/store';

const ORDER = ['auto', 'light', 'dark'] as const;
type Choice = (typeof ORDER)[number];

export class Theme {
  private choice: Choice;
  private readonly system = matchMedia('(prefers-color-scheme: dark)');

  constructor(private readonly changed: (dark: boolean) => void) {
    const kept = setting('theme');
    this.choice = kept === 'light' || kept === 'dark' ? kept : 'auto';
    this.system.addEventListener('change', () => this.apply());
  }

  get isDark(): boolean {
    return this.choice === 'dark' || (this.choice === 'auto' && this.system.matches);
  }

  next(): void {
    this.choice = ORDER[(ORDER.indexOf(this.choice) + 1) % ORDER.length]!;
    setSetting('theme', this.choice);
    this.apply();
  }

  apply(): void {
    document.documentElement.dataset['theme'] = this.isDark ? 'dark' : 'light';
    this.changed(this.isDark);
  }
}
