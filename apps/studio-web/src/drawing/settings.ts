/** The panel of a drawing: a form made of the schemas of drawing and surface, a lent leaf, and the pen. */
import { Form, type Fields } from '../making/form';
import { ownChips } from '../making/ownchips';
import { differing, type Schema, withField } from '../making/schema';
import { t, tOf } from '../text';
import { el } from '../page/ui';
import type { Json, PlantState, SketchCommand, SketchSpec, SketchState, SkinSpec } from '../wire';

export interface SettingsEvents {
  /** Asked of the drawing. */
  run(command: SketchCommand): void;
  begin(name: string): void;
  stage(command: SketchCommand): void;
  commit(): void;
  /** The drawing as it is. */
  now(): SketchState;
  /** Drawings that are changed with it. */
  others(): readonly PlantState[];
  /** The name of the plant. */
  name(): string;
  /** Strength of the stabiliser of the pen, 0 to 3. */
  steady: number;
  setSteady(strength: number): void;
}

/** What the panel shows first. */
const MAIN = ['/fill/density', '/phototropism', '/gravity', '/skin/variation', '/skin/petals'];

export class SettingsPanel {
  readonly element = el('div', { class: 'settings' });
  private readonly form: Form;
  private own: HTMLElement = el('div');
  private readonly alike = el('p', { class: 'muted alike' });
  private dragging = false;

  constructor(
    schema: Schema,
    lenders: PlantState[],
    private readonly events: SettingsEvents,
  ) {
    this.form = new Form(schema, {
      set: (path, value) => events.run(this.command(path, value)),
      stage: (path, value) => this.stage(this.command(path, value)),
      done: () => {
        if (this.dragging) events.commit();
        this.dragging = false;
      },
    });
    this.element.append(this.alike, this.form.element);
    if (lenders.length > 0)
      this.element.append(
        choice(
          t('tree.leaf'),
          [['', t('tree.leaf.own')], ...lenders.map((p): [string, string] => [String(p.id), p.name])],
          String(events.now().leaf ?? ''),
          (word) => events.run({ 'set-leaf': word === '' ? null : Number(word) }),
        ),
      );
    this.element.append(
      this.own,
      el('hr'),
      choice(
        t('set.steady'),
        ['0', '1', '2', '3'].map((word) => [word, tOf('set.steady', word)]),
        String(events.steady),
        (word) => events.setSteady(Number(word)),
      ),
    );
    this.show();
  }

  /** Shows the drawing as it is; what is dragged keeps its element. */
  show(): void {
    if (this.dragging) return;
    const { sketch, skin } = this.events.now();
    this.showOwn();
    const others = this.events.others();
    const values = { ...sketch, skin } as unknown as Fields;
    const theirs = others.map((p) => ({ ...p.sketch!.sketch, skin: p.sketch!.skin }) as unknown as Fields);
    this.form.show(values, MAIN, [], differing(values, theirs));
    this.alike.textContent = t('maker.alike', { count: others.length + 1 });
    this.alike.hidden = others.length === 0;
  }

  /** Settings that the person keeps: of the drawing and of its surface, not its strokes. */
  private showOwn(): void {
    const chips = ownChips({
      maker: 'sketch',
      now: () => {
        const { sketch, skin } = this.events.now();
        return { name: this.events.name(), spec: { sketch, skin } as unknown as Fields };
      },
      take: ({ sketch, skin }) => {
        // Each of the two is a step of undo.
        const now = this.events.now();
        const differ = (a: unknown, b: unknown): boolean => JSON.stringify(a) !== JSON.stringify(b);
        if (differ(sketch, now.sketch)) this.events.run({ 'set-sketch': sketch as unknown as SketchSpec });
        if (differ(skin, now.skin)) this.events.run({ 'set-skin': skin as unknown as SkinSpec });
      },
      renew: () => this.showOwn(),
    });
    this.own.replaceWith(chips);
    this.own = chips;
  }

  private command(path: string, value: Json): SketchCommand {
    const { sketch, skin } = this.events.now();
    const way = path.split('/').slice(1);
    return way[0] === 'skin'
      ? { 'set-skin': withField(skin, way.slice(1), value) }
      : { 'set-sketch': withField(sketch, way, value) };
  }

  private stage(command: SketchCommand): void {
    if (!this.dragging) this.events.begin('set-sketch' in (command as object) ? 'sketch' : 'skin');
    this.dragging = true;
    this.events.stage(command);
  }
}

function choice(
  label: string,
  words: [string, string][],
  value: string,
  act: (word: string) => void,
): HTMLElement {
  const select = el('select', { onchange: () => act(select.value) });
  for (const [word, text] of words) select.append(el('option', { value: word }, text));
  select.value = value;
  return el('label', { class: 'f-row' }, el('span', {}, label), select);
}
