/** The strip of the tools that shape a plant: settings of the tool in the hand, and what is known of the chosen branch. */
import { number, t, type TextKey } from './text';
import { CLIMB_KEYS, type ShapeTool } from './tools';
import { GROWTH, type ToolSettings } from './toolsettings';
import { el, icon, type IconName } from './ui';
import type { Growth, ShapeAnswer, ShapeCommand } from './wire';

/** What the strip knows of the hands, and what it has them do. */
export interface Hands {
  readonly settings: ToolSettings;
  readonly chosen: ShapeAnswer['picked'];
  /** So many branches up is what is meant. */
  readonly bearers: number;
  readonly isMirrored: boolean;
  /** Of the brush, metres. */
  readonly radius: number;
  readonly editCount: number;
  turnMirror(): void;
  tellBrush(): void;
  showRing(): void;
  climb(by: 1 | -1): void;
  shapeChosen(command: ShapeCommand): void;
  /** Shows the strip anew. */
  renew(): void;
}

/** What a tool can be set to, and what it can do with the branch that is chosen. */
export function toolOptions(tool: ShapeTool | undefined, hands: Hands): HTMLElement[] {
  const { settings: s } = hands;
  const hint = (key: TextKey): HTMLElement => el('span', { class: 'muted' }, t(key));
  const chips = (
    key: TextKey,
    words: readonly [string, TextKey][],
    now: string,
    act: (word: string) => void,
  ): HTMLElement =>
    el(
      'span',
      { class: 'chips', role: 'group', 'aria-label': t(key) },
      ...words.map(([word, text]) =>
        el(
          'button',
          {
            type: 'button',
            class: 'chip',
            id: `b-shape-${word}`,
            'aria-pressed': String(word === now),
            onclick: () => {
              act(word);
              hands.renew();
            },
          },
          t(text),
        ),
      ),
    );
  const slider = (
    key: TextKey,
    low: number,
    high: number,
    step: number,
    value: number,
    shown: (x: number) => string,
    act: (x: number) => void,
  ): HTMLElement => {
    const output = el('output', {}, shown(value));
    const input = el('input', {
      type: 'range',
      min: String(low),
      max: String(high),
      step: String(step),
      'aria-label': t(key),
      oninput: () => {
        act(input.valueAsNumber);
        output.textContent = shown(input.valueAsNumber);
        hands.showRing();
      },
      onchange: () => input.blur(),
    });
    input.value = String(value);
    return el('label', {}, el('span', {}, t(key)), input, output);
  };
  const sides = (): HTMLElement =>
    chips('shape.mirror', [['mirror', 'shape.mirror']], hands.isMirrored ? 'mirror' : '', () => {
      hands.turnMirror();
    });
  const plain = (x: number): string => String(Math.round(x * 100) / 100);
  const radius = (of: { share: number }): HTMLElement =>
    slider(
      'shape.radius',
      Math.log(0.01),
      Math.log(0.4),
      0.01,
      Math.log(of.share),
      () => `${plain(hands.radius)} m`,
      (x) => {
        of.share = Math.exp(x);
        hands.tellBrush();
      },
    );
  switch (tool) {
    case 'pick':
      return [
        ...(hands.chosen ? chosenBox(hands.chosen, hands) : [hint('shape.pick.hint')]),
        climbBox(hands),
      ];
    case 'rotate':
      return [hint('shape.rotate.hint'), climbBox(hands)];
    case 'move':
      return [hint('shape.move.hint'), climbBox(hands)];
    case 'prune':
      return [
        chips(
          'shape.prune',
          [
            ['part', 'shape.prune.part'],
            ['whole', 'shape.prune.whole'],
          ],
          s.prune.whole ? 'whole' : 'part',
          (w) => {
            s.prune.whole = w === 'whole';
          },
        ),
        climbBox(hands),
      ];
    case 'copy':
      return [hint('shape.copy.hint'), climbBox(hands)];
    case 'regrow':
      return [hint('shape.regrow.hint'), climbBox(hands)];
    case 'sketch':
      return [
        slider('shape.twigs', 0, 4, 0.25, s.sketch.twigs, plain, (x) => {
          s.sketch.twigs = x;
        }),
        slider(
          'shape.tilt',
          -75,
          75,
          5,
          s.sketch.tilt_deg,
          (x) => `${plain(x)}°`,
          (x) => {
            s.sketch.tilt_deg = x;
          },
        ),
        sides(),
      ];
    case 'brush':
      return [
        radius(s.brush),
        slider('shape.density', 0.25, 4, 0.25, s.brush.density, plain, (x) => {
          s.brush.density = x;
          hands.tellBrush();
        }),
        sides(),
      ];
    case 'silhouette':
      return [
        slider('shape.density', 0.25, 4, 0.25, s.silhouette.density, plain, (x) => {
          s.silhouette.density = x;
        }),
        chips('shape.silhouette', [['trim', 'shape.trim']], s.silhouette.trim ? 'trim' : '', () => {
          s.silhouette.trim = !s.silhouette.trim;
        }),
        sides(),
      ];
    case 'grow': {
      const number = (of: keyof Growth, step: number): HTMLElement => {
        const [low, high] = GROWTH[of];
        return slider(`shape.grow.${of}`, low, high, step, s.grow[of], plain, (x) => {
          s.grow[of] = x;
        });
      };
      const grown = hint('shape.grow.hint');
      grown.id = 'grown';
      return [
        grown,
        number('vigour', 0.1),
        number('apical', 0.02),
        number('angle_deg', 5),
        number('lift', 0.02),
        number('apart', 0.1),
        sides(),
      ];
    }
    case 'leaves':
      return [
        chips(
          'shape.leaves',
          [
            ['fewer', 'shape.leaves.fewer'],
            ['more', 'shape.leaves.more'],
          ],
          s.leaves.more ? 'more' : 'fewer',
          (w) => {
            s.leaves.more = w === 'more';
          },
        ),
        radius(s.leaves),
      ];
    default:
      return [];
  }
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
