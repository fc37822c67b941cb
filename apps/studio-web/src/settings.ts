/** The plant's settings: a row for each, made from one table. A drag of a slider is one step of undo. */
import type { PlantState, SketchCommand, SketchSpec, SketchState, SkinSpec } from './wire';
import { t, tOf, type TextKey } from './text';
import { el } from './ui';

export interface SettingsEvents {
  /** Asked of the drawing. */
  run(command: SketchCommand): void;
  begin(name: string): void;
  stage(command: SketchCommand): void;
  commit(): void;
  /** Strength of the stabiliser of the pen, 0 to 3. */
  steady: number;
  setSteady(strength: number): void;
}

interface Slider {
  text: TextKey;
  low: number;
  high: number;
  step: number;
  get(s: SketchState): number;
  set(s: SketchState, value: number): SketchCommand;
}

const sketch = (s: SketchState, change: Partial<SketchSpec>): SketchCommand => ({
  'set-sketch': { ...s.sketch, ...change },
});
const skin = (s: SketchState, change: Partial<SkinSpec>): SketchCommand => ({
  'set-skin': { ...s.skin, ...change },
});
const fill = (s: SketchState, change: Partial<SketchSpec['fill']>): SketchCommand =>
  sketch(s, { fill: { ...s.sketch.fill, ...change } });

const SLIDERS: readonly Slider[] = [
  {
    text: 'set.density',
    low: 0.1,
    high: 4,
    step: 0.1,
    get: (s) => s.sketch.fill.density,
    set: (s, density) => fill(s, { density }),
  },
  {
    text: 'set.tropism',
    low: -1,
    high: 1,
    step: 0.05,
    get: (s) => s.sketch.fill.tropism,
    set: (s, tropism) => fill(s, { tropism }),
  },
  {
    text: 'set.phototropism',
    low: -1,
    high: 1,
    step: 0.05,
    get: (s) => s.sketch.phototropism,
    set: (s, phototropism) => sketch(s, { phototropism }),
  },
  {
    text: 'set.gravity',
    low: 0,
    high: 1,
    step: 0.05,
    get: (s) => s.sketch.gravity,
    set: (s, gravity) => sketch(s, { gravity }),
  },
  {
    text: 'set.detail',
    low: 0.2,
    high: 3,
    step: 0.1,
    get: (s) => s.skin.detail,
    set: (s, detail) => skin(s, { detail }),
  },
  {
    text: 'set.variation',
    low: 0,
    high: 1,
    step: 0.05,
    get: (s) => s.skin.variation,
    set: (s, variation) => skin(s, { variation }),
  },
];

const PETALS = ['pink', 'white', 'yellow', 'violet', 'red', 'orange', 'blue', 'magenta'] as const;

/** The panel for a document; `now` gives the latest state when something is changed. */
export function settingsPanel(
  now: () => SketchState,
  lenders: PlantState[],
  events: SettingsEvents,
): HTMLElement {
  const panel = el('div', { class: 'settings' });
  for (const slider of SLIDERS) {
    const value = slider.get(now());
    const shown = el('output', {}, String(Math.round(value * 100) / 100));
    let dragging = false;
    const input = el('input', {
      type: 'range',
      min: String(slider.low),
      max: String(slider.high),
      step: String(slider.step),
      oninput: () => {
        const value = Number(input.value);
        shown.textContent = String(value);
        const command = slider.set(now(), value);
        if (!dragging) events.begin('set-sketch' in (command as object) ? 'sketch' : 'skin');
        dragging = true;
        events.stage(command);
      },
      onchange: () => {
        if (dragging) events.commit();
        dragging = false;
      },
    });
    input.value = String(value);
    panel.append(el('label', {}, el('span', {}, t(slider.text)), input, shown));
  }
  panel.append(
    choice(
      'set.petals',
      ['auto', ...PETALS],
      now().skin.petals ?? 'auto',
      (word) => events.run(skin(now(), { petals: word === 'auto' ? null : (word as SkinSpec['petals']) })),
      'petal',
    ),
    choice(
      'set.leaf_depth',
      ['drawn', 'signed', 'paper'],
      now().sketch.leaf_depth,
      (word) => events.run(sketch(now(), { leaf_depth: word as SketchSpec['leaf_depth'] })),
      'set.leaf_depth',
    ),
    choice(
      'set.branch_depth',
      ['riesz', 'paper'],
      now().sketch.branch_depth,
      (word) => events.run(sketch(now(), { branch_depth: word as SketchSpec['branch_depth'] })),
      'set.branch_depth',
    ),
  );
  if (lenders.length > 0) {
    const select = el(
      'select',
      {
        onchange: () => events.run({ 'set-leaf': select.value === '' ? null : Number(select.value) }),
      },
      el('option', { value: '' }, t('tree.leaf.own')),
      ...lenders.map((p) => el('option', { value: String(p.id) }, p.name)),
    );
    select.value = String(now().leaf ?? '');
    panel.append(el('label', {}, el('span', {}, t('tree.leaf')), select));
  }
  panel.append(
    el('hr'),
    choice(
      'set.steady',
      ['0', '1', '2', '3'],
      String(events.steady),
      (word) => events.setSteady(Number(word)),
      'set.steady',
    ),
  );
  return panel;
}

function choice(
  text: TextKey,
  words: readonly string[],
  value: string,
  act: (word: string) => void,
  group: string,
): HTMLElement {
  const select = el('select', { onchange: () => act(select.value) });
  for (const word of words) {
    const label = word === 'auto' ? t('set.petals.auto') : tOf(group, word);
    select.append(el('option', { value: word }, label));
  }
  select.value = value;
  return el('label', {}, el('span', {}, t(text)), select);
}
