/** The strip of the tools that shape a plant: settings of the tool in the hand, and what is known of the chosen branch. */
import { hasText, number, t, type TextKey, tOf } from '../text';
import {
  CLIMB_KEYS,
  isChoice,
  isNumber,
  type NumberSetting,
  rowOf,
  type Setting,
  type ShapeTool,
} from './tools';
import type { ToolSettings } from './toolsettings';
import { el, icon } from '../page/ui';
import type { IconName } from '../page/icons';
import type { ShapeAnswer, ShapeCommand } from '../wire';

/** What the strip knows of the hands, and what it has them do. */
export interface Hands {
  readonly settings: ToolSettings;
  readonly chosen: ShapeAnswer['picked'];
  /** So many branches up is what is meant. */
  readonly bearers: number;
  readonly isMirrored: boolean;
  /** Of the plant, metres. */
  readonly size: number;
  readonly editCount: number;
  turnMirror(): void;
  /** A setting of the tool in the hand is another now. */
  changed(): void;
  climb(by: 1 | -1): void;
  shapeChosen(command: ShapeCommand): void;
  /** Shows the strip anew. */
  renew(): void;
}

/** What a tool can be set to, and what it can do with the branch that is chosen. */
export function toolOptions(tool: ShapeTool, hands: Hands): HTMLElement[] {
  const row = rowOf(tool);
  const { chosen, isMirrored } = hands;
  const hint = `shape.${tool}.hint`;
  const told = el('span', { class: 'muted' }, hasText(hint) ? t(hint) : '');
  // What grows in the hand is told in the place of the hint.
  if (row.rounds) told.id = 'grown';
  return [
    ...(row.chooses && chosen ? chosenBox(chosen, hands) : hasText(hint) ? [told] : []),
    ...Object.entries(row.settings).map(([name, setting]) => option(tool, name, setting, hands)),
    ...(row.mirrors
      ? [chips(t('shape.mirror'), [['mirror', 'shape.mirror', isMirrored]], () => hands.turnMirror())]
      : []),
    ...(row.climbs ? [climbBox(hands)] : []),
  ];
}

function option(tool: ShapeTool, name: string, setting: Setting, hands: Hands): HTMLElement {
  const { settings } = hands;
  const now = settings.of(tool)[name];
  const act = (value: number | boolean): void => {
    settings.set(tool, name, value);
    hands.changed();
    hands.renew();
  };
  const label = (word: string): TextKey => `shape.${tool}.${word}` as TextKey;
  if (isNumber(setting)) return slider(tool, name, setting, hands);
  if (isChoice(setting)) {
    const words = Object.entries(setting.words);
    return chips(
      t(`shape.${tool}`),
      words.map(([word, value]) => [word, label(word), value === now]),
      (word) => act(setting.words[word]!),
    );
  }
  return chips(t(`shape.${tool}`), [[setting.word, label(setting.word), now === true]], () => act(!now));
}

/** Buttons side by side: the word, the text and whether it is pressed of each. */
function chips(
  group: string,
  words: readonly (readonly [string, TextKey, boolean])[],
  act: (word: string) => void,
): HTMLElement {
  return el(
    'span',
    { class: 'chips', role: 'group', 'aria-label': group },
    ...words.map(([word, text, isOn]) =>
      el(
        'button',
        {
          type: 'button',
          class: 'chip',
          id: `b-shape-${word}`,
          'aria-pressed': String(isOn),
          onclick: () => act(word),
        },
        t(text),
      ),
    ),
  );
}

/** What is in shares of the plant is set by its logarithm: a twig and a crown are both within reach. */
function slider(tool: ShapeTool, name: string, setting: NumberSetting, hands: Hands): HTMLElement {
  const { settings, size } = hands;
  const { low, high, step, ofPlant } = setting;
  const [to, back] = ofPlant ? [Math.log, Math.exp] : [(x: number) => x, (x: number) => x];
  const label = tOf('shape.set', name);
  const output = el('output', {}, settings.shown(tool, size, name));
  const input = el('input', {
    type: 'range',
    min: String(to(low)),
    max: String(to(high)),
    step: String(step),
    'aria-label': label,
    oninput: () => {
      settings.set(tool, name, back(input.valueAsNumber));
      output.textContent = settings.shown(tool, size, name);
      hands.changed();
    },
    onchange: () => input.blur(),
  });
  input.value = String(to(Number(settings.of(tool)[name])));
  return el('label', {}, el('span', {}, label), input, output);
}

/** What is known of the branch that was pointed at, and what can be done with it. */
function chosenBox(p: NonNullable<ShapeAnswer['picked']>, hands: Hands): HTMLElement[] {
  const act = (text: TextKey, id: string, name: IconName, command: ShapeCommand): HTMLElement =>
    el(
      'button',
      { type: 'button', class: 'chip', id, onclick: () => hands.shapeChosen(command) },
      icon(name),
      t(text),
    );
  const axis = p.key;
  return [
    el('span', {}, t('shape.branch', branchWords(p))),
    ...(axis
      ? [
          act('shape.prune', 'b-prune-chosen', 'prune', { add: { op: 'prune', axis, at: 0 } }),
          act('shape.regrow', 'b-regrow-chosen', 'regrow', {
            add: { op: 'regrow', axis, seed: hands.editCount + 1 },
          }),
        ]
      : []),
  ];
}

/** From the twig to what bears it, and back. */
function climbBox(hands: Hands): HTMLElement {
  const step = (id: string, key: TextKey, keys: string, by: 1 | -1, text: string): HTMLButtonElement =>
    el(
      'button',
      {
        type: 'button',
        class: 'chip',
        id,
        title: `${t(`${key}.hint` as TextKey)}  (${keys})`,
        onclick: () => hands.climb(by),
      },
      text,
    );
  const [up, down] = [
    step(
      'b-shape-up',
      'shape.up',
      CLIMB_KEYS.up,
      1,
      `${t('shape.up')}${hands.bearers > 0 ? ` +${hands.bearers}` : ''}`,
    ),
    step('b-shape-down', 'shape.down', CLIMB_KEYS.down, -1, t('shape.down')),
  ];
  up.setAttribute('aria-pressed', String(hands.bearers > 0));
  down.disabled = hands.bearers === 0;
  return el('span', { class: 'chips', role: 'group', 'aria-label': t('shape.up.hint') }, up, down);
}

/** What is said of a branch. */
function branchWords(p: NonNullable<ShapeAnswer['picked']>): Record<string, string | number> {
  return {
    order: p.order,
    length: String(Math.round(p.length_m * 100) / 100),
    count: number(p.bears),
  };
}
