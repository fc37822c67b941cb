/** Numbers that are typed while plants are moved, turned or sized: how far, by how much, how many times. */
import type { Gizmo } from './scene';
import { t } from '../text';
import { carryOf, middleOf } from './typed';
import { el, note } from '../page/ui';
import type { Carry, PlantState } from '../wire';

export interface TypingEvents {
  /** What is in the hand, and the axis to which it is bound. */
  gizmo(): Gizmo | undefined;
  axis(): 'x' | 'z' | undefined;
  chosen(): readonly PlantState[];
  carry(plants: readonly number[], how: Carry): void;
}

export class Typing {
  /** What was typed so far, over the view. */
  readonly element = el('output', { id: 'b-typed', class: 'chip typed', hidden: '' });
  private text = '';

  constructor(private readonly events: TypingEvents) {}

  /** Takes a key, and says whether it was for this. */
  take({ key, ctrlKey, metaKey }: Pick<KeyboardEvent, 'key' | 'ctrlKey' | 'metaKey'>): boolean {
    const gizmo = this.events.gizmo();
    const isOurs =
      gizmo !== undefined &&
      !ctrlKey &&
      !metaKey &&
      (/^[\d.,-]$/.test(key) || (this.text !== '' && ['Backspace', 'Enter', 'Escape'].includes(key)));
    if (!isOurs) {
      // X and Z bind to an axis in between.
      if (gizmo === undefined) this.show('');
      return false;
    }
    if (key === 'Enter') this.apply(gizmo);
    else this.show(key === 'Escape' ? '' : key === 'Backspace' ? this.text.slice(0, -1) : this.text + key);
    return true;
  }

  private apply(gizmo: Gizmo): void {
    const plants = this.events.chosen();
    const how = carryOf(gizmo, this.events.axis(), this.text, middleOf(plants));
    if (!how) note(t('typed.wrong', { text: this.text }), 'bad');
    else if (plants.length > 0)
      this.events.carry(
        plants.map((p) => p.id),
        how,
      );
    this.show('');
  }

  private show(text: string): void {
    this.text = text;
    this.element.hidden = text === '';
    const gizmo = this.events.gizmo();
    const axis = this.events.axis();
    if (gizmo) this.element.textContent = t(`typed.${gizmo}`, { text, axis: axis ?? 'x, z' });
  }
}
