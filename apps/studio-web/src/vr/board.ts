/** What the board at the wrist has on each of its pages: which keys, and what each does. */
import type { Shaping } from '../shaping/shaping';
import { t, type TextKey, tOf } from '../text';
import { isBrush, isNumber, rowOf, SHAPE_WORDS } from '../shaping/tools';
import type { Written } from '../exporting/exporting';
import type { IconName } from '../page/icons';
import type { HeadsetEvents } from './events';
import type { ObstacleKind } from './placing';
import type { Key } from './wrist';

/** What the keys ask of the headset. */
export interface Board {
  page: 'tools' | 'more' | 'scene' | 'export';
  /** What is on now. */
  state(): {
    placed: ObstacleKind | undefined;
    isRecorded: boolean;
    trueScale: boolean;
    leftHanded: boolean;
    /** Of what is drawn: its colour as CSS, and across, millimetres. */
    trace: { colour: string; mm: number };
  };
  say(text: string): void;
  /** Something was taken back. */
  undone(): void;
  /** Works on another plant, or says which this is. */
  tellPlant(by: -1 | 0 | 1): void;
  place(kind: ObstacleKind): void;
  /** Begins to write down what hands do, or ends it. */
  writeDown(): void;
  mirror: Key['act'];
  brush(by: number): void;
  /** The trace in the next colour, or in the next thickness. */
  traceColour(): void;
  traceThickness(): void;
  resize(): void;
  swapHands(): void;
  /** So many steps higher. */
  sit(by: 1 | -1): void;
  leave(): void;
  startLesson(): void;
}

/** What a model is written as from within, in rows of keys. */
const FORMATS = [
  ['glb', 'usda'],
  ['obj', 'ply'],
  ['stl', 'mtg'],
] as const satisfies readonly (readonly Written[])[];

type Rows = readonly (readonly Key[])[];

/** Icons of keys that do what a button of the page does. */
const ICONS: Readonly<Record<string, IconName>> = {
  undo: 'undo',
  redo: 'redo',
  mirror: 'mirror',
  scale: 'scale',
  leave: 'close',
  more: 'more',
  scene: 'scene',
  dice: 'dice',
  grid: 'grid',
  copy: 'copy',
  save: 'save',
  export: 'export',
  clear: 'bin',
  'plant.add': 'plus',
};

const key = (id: string, wide: number, act: Key['act'], on = false): Key => ({
  id,
  label: t(`vr.${id}` as TextKey),
  ...(ICONS[id] && { icon: ICONS[id] }),
  wide,
  on,
  act,
});

/** The keys that the board has now, in rows. */
export function rowsOf(board: Board, shaping: Shaping, events: HeadsetEvents): Rows {
  // The trigger is taken while something grows: these alone are pressed, by another button.
  if (shaping.isGrowing) return numberRows(board, shaping);
  const rows = {
    tools: () => toolRows(board, shaping, events),
    more: () => moreRows(board, shaping, events),
    scene: () => sceneRows(board, events),
    export: () => exportRows(events),
  }[board.page]();
  const open = (page: 'more' | 'scene', act: () => void): Key =>
    key(
      page,
      3,
      () => {
        board.page = board.page === page ? 'tools' : page;
        act();
      },
      board.page === page,
    );
  return [...rows, [open('more', () => {}), open('scene', () => board.tellPlant(0))]];
}

/** Numbers of the tool in the hand: a key for less and one for more. */
function numberRows(board: Board, shaping: Shaping): Rows {
  const settings = Object.entries(shaping.word ? rowOf(shaping.word).settings : {});
  const numbers = settings.filter(([, setting]) => isNumber(setting) && setting.notch !== undefined);
  return numbers.map(([of]) =>
    ([-1, 1] as const).map(
      (by): Key => ({
        id: `${of}${by < 0 ? '-' : '+'}`,
        label: `${tOf('shape.set', of)} ${by < 0 ? '−' : '+'}`,
        wide: 3,
        act: () => board.say(shaping.turn(of, by)),
      }),
    ),
  );
}

function toolRows(board: Board, shaping: Shaping, events: HeadsetEvents): Rows {
  const now = board.state();
  const tools = SHAPE_WORDS.map(
    (word): Key => ({
      id: word,
      label: t(`vr.tool.${word}` as TextKey),
      icon: rowOf(word).icon,
      wide: 2,
      on: shaping.word === word,
      act: () => {
        shaping.take(word);
        board.say(t(`shape.${word}`));
      },
    }),
  );
  const undo = (): void => {
    events.undo();
    board.undone();
  };
  return [
    tools.slice(0, 3),
    tools.slice(3, 6),
    tools.slice(6, 9),
    tools.slice(9).map((one) => ({ ...one, wide: 3 })),
    [
      key('undo', 2, undo),
      key('redo', 2, events.redo),
      key('mirror', 2, (hand) => board.mirror(hand), shaping.isMirrored),
    ],
    ...settingRows(board, shaping),
    [
      key('scale', 3, () => board.resize(), now.trueScale),
      key('left', 3, () => board.swapHands(), now.leftHanded),
    ],
    [
      key('lower', 2, () => board.sit(-1)),
      key('higher', 2, () => board.sit(1)),
      key('leave', 2, () => board.leave()),
    ],
  ];
}

/** What the tool in the hand can be set to, and for one that means a branch, what bears it. */
function settingRows(board: Board, shaping: Shaping): Rows {
  const { word } = shaping;
  if (!word) return [];
  const row = rowOf(word);
  const brushed = [key('smaller', 3, () => board.brush(1 / 1.25)), key('larger', 3, () => board.brush(1.25))];
  const borne = [key('bearer', 3, () => shaping.climb(1)), key('twig', 3, () => shaping.climb(-1))];
  const choices = Object.entries(row.settings).filter(([, setting]) => !isNumber(setting));
  const turned = choices.map(([name]): readonly Key[] => [
    {
      id: name,
      label: shaping.settingsText(name),
      wide: 6,
      act: () => board.say(shaping.turn(name, 1)),
    },
  ]);
  return [
    ...(isBrush(word) ? [brushed] : []),
    ...(row.climbs ? [borne] : []),
    ...turned,
    ...numberRows(board, shaping),
  ];
}

function moreRows(board: Board, shaping: Shaping, events: HeadsetEvents): Rows {
  const species = (by: 1 | -1) => () => {
    void events.species(by).then((name) => board.say(name ?? t('vr.species.none')));
  };
  const { trace } = board.state();
  const colour = { ...key('trace.colour', 3, () => board.traceColour()), swatch: trace.colour };
  const thickness = {
    ...key('trace.thick', 3, () => board.traceThickness()),
    label: t('vr.trace.thick', trace),
  };
  return [
    [key('before', 3, species(-1)), key('next', 3, species(1))],
    [colour, thickness],
    [key('dice', 6, () => events.run('dice'))],
    [key('grid', 3, () => events.run('guide-grid')), key('staff', 3, () => events.run('guide-staff'))],
    [
      key('plane', 3, () => void shaping.placePlane(undefined), shaping.plane !== undefined),
      key('lesson', 3, () => board.startLesson()),
    ],
  ];
}

function sceneRows(board: Board, events: HeadsetEvents): Rows {
  const now = board.state();
  const clear = (): void => {
    if (events.obstacles()) events.clear();
    else board.say(t('vr.place.none'));
  };
  const formats = (): void => {
    board.page = 'export';
  };
  return [
    [key('plant.before', 3, () => board.tellPlant(-1)), key('plant.next', 3, () => board.tellPlant(1))],
    [key('plant.add', 3, events.add), key('copy', 3, events.copy)],
    [
      key('ball', 3, () => board.place('ball'), now.placed === 'ball'),
      key('box', 3, () => board.place('box'), now.placed === 'box'),
    ],
    [key('clear', 6, clear)],
    [key('save', 3, () => events.run('save')), key('export', 3, formats)],
    [key('record', 6, () => board.writeDown(), now.isRecorded)],
  ];
}

function exportRows(events: HeadsetEvents): Rows {
  return FORMATS.map((row) =>
    row.map(
      (format): Key => ({
        id: `export.${format}`,
        label: format.toUpperCase(),
        wide: 3,
        act: () => events.model(format),
      }),
    ),
  );
}
