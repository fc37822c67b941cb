/**
 * Everything that a person can ask the page for, in one table. The palette, the keyboard, the buttons of the bars and
 * the sheet of keys are all read from it.
 */
import { CLASSES } from '../drawing/classes';
import type { Clipboard } from '../drawing/clipboard';
import type { Documents } from '../keeping/documents';
import type { Files } from '../keeping/files';
import type { Panels } from '../making/panels';
import type { GroundPen } from '../placing/scattering';
import type { Gizmo, SceneList } from '../placing/scene';
import type { Scenery } from '../looking/scenery';
import type { Session } from '../worker/session';
import type { Balls } from '../shaping/balls';
import type { Shaping } from '../shaping/shaping';
import { ALIGNMENTS, type Arrangement, arranged, DISTRIBUTIONS, fewest } from '../sheet/align';
import type { Sheet, Tool } from '../sheet/sheet';
import type { Half } from './halves';
import type { TextKey } from '../text';
import type { Theme } from './theme';
import type { Typing } from '../placing/typing';
import { CLIMB_KEYS, isBrush, rowOf, SHAPE_WORDS, SHEET_TOOLS } from '../shaping/tools';
import { SIDES } from '../view/camera';
import { GUIDES } from '../view/guides';
import { PRESETS } from '../view/moods';
import type { PlantView } from '../view/view';
import type { ViewModes } from '../looking/viewmode';
import type { Door, Mode } from '../vr/door';
import type { Command, StrokeClass } from '../wire';

/** The parts of the page that commands work on. */
export interface Page {
  readonly session: Session;
  readonly sheet: Sheet;
  /** The view and its tools: none without WebGL 2. */
  readonly view: PlantView | undefined;
  readonly shaping: Shaping | undefined;
  readonly balls: Balls | undefined;
  /** What draws on the ground. */
  readonly pen: GroundPen | undefined;
  readonly modes: ViewModes;
  readonly list: SceneList;
  /** What numbers are typed into. */
  readonly typing: Typing;
  readonly documents: Documents;
  readonly scenery: Scenery;
  readonly door: Door;
  readonly files: Files;
  readonly clipboard: Clipboard;
  readonly panels: Panels;
  readonly theme: Theme;
  /** Which gizmo the chosen plant has, if any. */
  readonly gizmo: Gizmo | undefined;
  /** Takes a gizmo, or lays it down if it is that one. */
  place(gizmo: Gizmo | undefined): void;
  /** Binds the gizmo to an axis, or no longer if it is that one. */
  bind(axis: 'x' | 'z'): void;
  readonly scatters: boolean;
  stopScattering(): void;
  setTool(tool: Tool): void;
  choose(strokes: number[]): void;
  immerse(mode: Mode): void;
  /** One side fills the page, or both are seen again. */
  fill(half: Half): void;
  toggleMirror(): void;
  openTurns(): void;
  toggleMeets(): void;
  /** Says what the chosen strokes are, or else those that come; null: that is found out. */
  mean(kind: StrokeClass | null): void;
  toggleStats(): void;
  switchLanguage(): void;
  /** Hides the names of buttons, or shows them again. */
  toggleNames(): void;
  openShelf(): void;
  openFilming(): void;
  openPreview(): void;
  openLight(): void;
  openWarnings(): void;
  openSize(): void;
  openPalette(): void;
  openHelp(): void;
  startTour(): void;
}

export interface PageCommand {
  readonly id: string;
  /** What the palette calls it; what has no label is reached by its key alone. */
  readonly label?: TextKey;
  /** Keys with a space between them; the first is the one that is shown. */
  readonly keys?: string;
  /** The keys count only while a tool of the view is held, and then before those of the page. */
  readonly shaping?: true;
  /** Whether the keys would do something now; if not, they are left to others and to the browser. */
  readonly when?: (page: Page) => boolean;
  readonly run: (page: Page) => void;
}

const hasSelection = (p: Page): boolean => p.sheet.selected.length > 0;
const hasSheet = (p: Page): boolean => p.session.drawn !== null;
const hasLayer = (p: Page): boolean => p.panels.heldLayer !== undefined;
const isPicking = (p: Page): boolean => p.shaping?.word === 'pick';
const hasView = (p: Page): boolean => p.view !== undefined;
const isMoving = (p: Page): boolean => p.gizmo === 'translate';
const isBrushing = (p: Page): boolean => isBrush(p.shaping?.word);
/** How much the brackets change a brush. */
const BRUSH_STEP = 1.15;
/** How far an arrow moves strokes, pixels; with Shift five times as far. */
const NUDGE = 5;
/** How far a command turns strokes, degrees. */
const TURN_DEG = 15;

const ARROWS = [
  ['←', -1, 0],
  ['↑', 0, 1],
  ['→', 1, 0],
  ['↓', 0, -1],
] as const;

function nudge(page: Page, x: number, y: number): void {
  const step = NUDGE * page.sheet.unitsPerPixel;
  page.session.draw({ 'move-strokes': [page.sheet.selected, [x * step, y * step]] });
}

/** Turns what is selected about its middle; `across`: -1 for its mirror image. */
function turn(page: Page, angle_deg: number, across: 1 | -1): void {
  const box = page.sheet.selectedBox();
  if (!box) return;
  const about: [number, number] = [(box.left + box.right) / 2, (box.bottom + box.top) / 2];
  page.session.draw({ 'turn-strokes': [page.sheet.selected, { about, angle_deg, scale: [across, 1] }] });
}

/** Joins the chosen strokes into the outline of one leaf or petal, as one step. */
export function oneBlade(p: Page): void {
  const { plant, drawn } = p.session;
  const chosen = new Set(p.sheet.selected);
  // In the order of the drawing: the first keeps its number.
  const strokes = (drawn?.strokes ?? []).map((s) => s.id).filter((id) => chosen.has(id));
  if (!plant || strokes.length < 2) return;
  p.session.together('join', [
    { sketch: [plant.id, { 'join-strokes': strokes }] },
    { sketch: [plant.id, { 'set-class': [[strokes[0]!], 'blade'] }] },
  ]);
  p.choose([strokes[0]!]);
}

/** The keys of some arrangements. */
const ARRANGE_KEYS: Partial<Record<Arrangement, string>> = {
  left: 'Ctrl+←',
  right: 'Ctrl+→',
  top: 'Ctrl+↑',
  bottom: 'Ctrl+↓',
};

/** Puts the chosen strokes in order, as one step of undo. */
export function arrange(page: Page, how: Arrangement): void {
  const moves = arranged(page.sheet.chosen, how);
  if (moves.length === 0) return;
  const { plant } = page.session;
  if (!plant) return;
  page.session.together(
    'arrange',
    moves.map(([id, by]): Command => ({ sketch: [plant.id, { 'move-strokes': [[id], by] }] })),
  );
}

/** Lays down what is in the hand, or else lets go what is selected. */
function leave(page: Page): void {
  if (page.scatters) page.stopScattering();
  else if (page.gizmo) page.place(undefined);
  else if (page.balls?.isOn) page.balls.leave();
  else page.sheet.select([]);
}

function selectNext(page: Page, by: 1 | -1): void {
  page.setTool('select');
  page.sheet.selectNext(by);
}

const TABLE = [
  ...SHEET_TOOLS.map(([tool, keys]) => ({
    id: tool,
    label: `tool.${tool}` as const,
    keys,
    run: (p: Page) => p.setTool(tool),
  })),
  { id: 'undo', label: 'undo', keys: 'Ctrl+Z', run: (p) => p.session.ask({ kind: 'undo' }) },
  { id: 'redo', label: 'redo', keys: 'Ctrl+Shift+Z Ctrl+Y', run: (p) => p.session.ask({ kind: 'redo' }) },
  { id: 'new', label: 'menu.new', run: (p) => void p.documents.fresh() },
  { id: 'documents', label: 'menu.documents', keys: 'Shift+O', run: (p) => p.openShelf() },
  { id: 'open', label: 'menu.open', keys: 'Ctrl+O', run: (p) => p.files.choose() },
  { id: 'samples', label: 'menu.samples', run: (p) => p.files.samples() },
  { id: 'save', label: 'menu.save', keys: 'Ctrl+S', run: (p) => void p.files.save() },
  { id: 'export', label: 'menu.export', keys: 'Ctrl+E', run: (p) => p.files.chooseExport() },
  { id: 'export-view', label: 'exported.title', when: hasView, run: (p) => p.openPreview() },
  { id: 'light', label: 'light.title', keys: 'Shift+T', when: hasView, run: (p) => p.openLight() },
  { id: 'share', label: 'menu.share', run: (p) => void p.files.share() },
  { id: 'dice', label: 'dice', keys: 'Shift+R', run: (p) => p.panels.roll() },
  { id: 'lock', label: 'lock', run: (p) => p.panels.toggleLock() },
  { id: 'grid', label: 'variations.title', keys: 'Shift+G', run: (p) => p.panels.openVariations() },
  { id: 'settings', label: 'menu.settings', run: (p) => p.panels.openSettings() },
  { id: 'materials', label: 'material.title', keys: 'Shift+M', run: (p) => void p.panels.openMaterials() },
  { id: 'pen', label: 'tool.pen', run: (p) => void p.panels.openPen() },
  { id: 'layers', label: 'tool.layers', keys: 'Shift+L', run: (p) => void p.panels.openLayers() },
  { id: 'layer-add', label: 'layer.add', when: hasSheet, run: (p) => p.panels.addLayer() },
  { id: 'layer-put', label: 'layer.put.chosen', when: hasSelection, run: (p) => p.panels.putOnLayer() },
  { id: 'layer-hide', label: 'layer.hide.held', when: hasLayer, run: (p) => p.panels.setHeldLayer('hidden') },
  { id: 'layer-lock', label: 'layer.lock.held', when: hasLayer, run: (p) => p.panels.setHeldLayer('locked') },
  { id: 'turns', label: 'tool.turns', keys: 'Y', when: hasSheet, run: (p) => p.openTurns() },
  { id: 'meet', label: 'act.meet', keys: 'J', when: hasSheet, run: (p) => p.toggleMeets() },
  { id: 'mirror', label: 'tool.mirror', keys: 'M', run: (p) => p.toggleMirror() },
  { id: 'photo', label: 'tool.photo', keys: 'U', run: (p) => p.panels.openPhoto() },
  { id: 'fit', label: 'tool.fit', keys: '0', run: (p) => p.sheet.fit() },
  { id: 'front', label: 'view.front', keys: 'D', run: (p) => p.view?.setFront(!p.view.isFront) },
  { id: 'focus', label: 'view.focus', keys: 'F', run: (p) => p.view?.focus() },
  { id: 'fill-sheet', label: 'fill.sheet', keys: 'Shift+P', run: (p) => p.fill('sheet') },
  { id: 'fill-view', label: 'fill.view', keys: 'Shift+F', when: hasView, run: (p) => p.fill('view') },
  { id: 'frame', label: 'view.frame', keys: 'Shift+0', run: (p) => p.view?.frameNow() },
  { id: 'wire', label: 'view.wire', keys: 'W', run: (p) => p.modes.toggle('wire') },
  { id: 'skeleton', label: 'view.skeleton', keys: 'K', run: (p) => p.modes.toggle('skeleton') },
  {
    id: 'shape',
    label: 'shape.title',
    keys: 'Shift+S',
    when: (p) => p.shaping !== undefined,
    // A leaf has no branches: its marks are what a hand takes.
    run: (p) => (p.session.plant?.leaf ? p.balls : p.shaping)?.toggle(),
  },
  { id: 'place-move', label: 'place.translate', keys: 'G', when: hasView, run: (p) => p.place('translate') },
  { id: 'place-turn', label: 'place.rotate', keys: 'R', when: hasView, run: (p) => p.place('rotate') },
  { id: 'place-size', label: 'place.scale', keys: 'S', when: hasView, run: (p) => p.place('scale') },
  { id: 'size', label: 'size.set', when: hasView, run: (p) => p.openSize() },
  { id: 'place-x', keys: 'X', when: isMoving, run: (p) => p.bind('x') },
  { id: 'place-z', keys: 'Z', when: isMoving, run: (p) => p.bind('z') },
  ...SHAPE_WORDS.map((word) => ({
    id: `shape-${word}` as const,
    label: `shape.${word}` as const,
    keys: rowOf(word).keys,
    shaping: true as const,
    run: (p: Page) => p.shaping?.take(word),
  })),
  {
    id: 'shape-up',
    label: 'shape.up.hint',
    keys: CLIMB_KEYS.up,
    shaping: true,
    run: (p) => p.shaping?.climb(1),
  },
  {
    id: 'shape-down',
    label: 'shape.down.hint',
    keys: CLIMB_KEYS.down,
    shaping: true,
    run: (p) => p.shaping?.climb(-1),
  },
  { id: 'shape-next', keys: '.', shaping: true, when: isPicking, run: (p) => p.shaping?.walk('next') },
  {
    id: 'shape-previous',
    keys: ',',
    shaping: true,
    when: isPicking,
    run: (p) => p.shaping?.walk('previous'),
  },
  {
    id: 'shape-smaller',
    keys: '[',
    shaping: true,
    when: isBrushing,
    run: (p) => p.shaping?.resize(1 / BRUSH_STEP),
  },
  {
    id: 'shape-larger',
    keys: ']',
    shaping: true,
    when: isBrushing,
    run: (p) => p.shaping?.resize(BRUSH_STEP),
  },
  { id: 'shape-remove', keys: 'Del', shaping: true, when: isPicking, run: (p) => p.shaping?.remove() },
  {
    id: 'shape-leave',
    keys: 'Esc',
    shaping: true,
    run: (p) => {
      if (!p.shaping?.cancel()) p.shaping?.take(undefined);
    },
  },
  {
    id: 'warnings',
    label: 'warnings.open',
    when: (p) => (p.session.seen?.warnings.length ?? 0) > 0,
    run: (p) => p.openWarnings(),
  },
  { id: 'stats', label: 'view.stats', keys: 'I', run: (p) => p.toggleStats() },
  { id: 'stage', label: 'stage.title', keys: 'T', run: (p) => p.scenery.openStage() },
  ...PRESETS.map((preset) => ({
    id: `stage-${preset}` as const,
    label: `stage.of.${preset}` as const,
    run: (p: Page) => p.scenery.preset(preset),
  })),
  { id: 'camera', label: 'camera.title', keys: 'C', run: (p) => p.scenery.openCamera() },
  ...SIDES.map((side) => ({
    id: `side-${side}` as const,
    label: `side.of.${side}` as const,
    run: (p: Page) => p.scenery.side(side),
  })),
  {
    id: 'headset',
    label: 'vr.enter',
    when: (p) => p.door.modes.includes('immersive-vr'),
    run: (p) => p.immerse('immersive-vr'),
  },
  {
    id: 'pass-through',
    label: 'vr.enter.through',
    when: (p) => p.door.modes.includes('immersive-ar'),
    run: (p) => p.immerse('immersive-ar'),
  },
  { id: 'camera-keep', label: 'camera.keep', run: (p) => p.scenery.keepCamera() },
  { id: 'walk', label: 'walk.walk', keys: 'N', run: (p) => p.scenery.walk('walk') },
  { id: 'fly', label: 'walk.fly', keys: 'Shift+N', run: (p) => p.scenery.walk('fly') },
  ...GUIDES.map((guide) => ({
    id: `guide-${guide}` as const,
    label: `guide.${guide}` as const,
    ...(guide === 'figure' ? { keys: 'H' } : {}),
    run: (p: Page) => p.scenery.toggle(guide),
  })),
  { id: 'film', label: 'film.title', keys: 'O', run: (p) => p.openFilming() },
  { id: 'picture', label: 'export.png', run: (p) => void p.files.picture() },
  {
    id: 'all',
    label: 'act.all',
    keys: 'Ctrl+A',
    run: (p) => p.choose(p.session.drawn?.strokes.map((s) => s.id) ?? []),
  },
  {
    id: 'copy',
    label: 'act.copy',
    keys: 'Ctrl+C',
    when: (p) => hasSelection(p) && !getSelection()?.toString(),
    run: (p) => void p.clipboard.copy(),
  },
  { id: 'cut', keys: 'Ctrl+X', when: hasSelection, run: (p) => void p.clipboard.cut() },
  {
    id: 'paste',
    label: 'act.paste',
    keys: 'Ctrl+V',
    // The browser's own paste follows the key and brings what other programs copied.
    when: () => false,
    run: (p) => void p.clipboard.pasteHeld(),
  },
  {
    id: 'duplicate',
    label: 'act.duplicate',
    keys: 'Ctrl+D',
    // Strokes if some are chosen, else plants.
    run: (p) => (hasSelection(p) ? p.clipboard : p.list).duplicate(),
  },
  {
    id: 'smooth',
    label: 'act.smooth',
    when: hasSelection,
    run: (p) => p.session.draw({ 'smooth-strokes': p.sheet.selected }),
  },
  {
    id: 'join',
    label: 'act.join',
    when: (p) => p.sheet.selected.length > 1,
    run: (p) => p.session.draw({ 'join-strokes': p.sheet.selected }),
  },
  {
    id: 'one-blade',
    label: 'act.oneblade',
    keys: 'Shift+J',
    when: (p) => p.sheet.selected.length > 1,
    run: (p) => oneBlade(p),
  },
  ...(
    [
      ['flip', 0, -1],
      ['turn-left', TURN_DEG, 1],
      ['turn-right', -TURN_DEG, 1],
    ] as const
  ).map(([id, angle, across]) => ({
    id,
    label: `act.${id}` as const,
    when: hasSelection,
    run: (p: Page) => turn(p, angle, across),
  })),
  ...[...ALIGNMENTS, ...DISTRIBUTIONS].map((how) => ({
    id: `arrange-${how}` as const,
    label: `arrange.${how}` as const,
    ...(ARRANGE_KEYS[how] === undefined ? {} : { keys: ARRANGE_KEYS[how] }),
    when: (p: Page) => p.sheet.selected.length >= fewest(how),
    run: (p: Page) => arrange(p, how),
  })),
  ...CLASSES.map((kind, row) => ({
    id: `mean-${kind}` as const,
    label: `mean.${kind}` as const,
    ...(row < 9 ? { keys: String(row + 1) } : {}),
    when: hasSheet,
    run: (p: Page) => p.mean(kind),
  })),
  { id: 'mean-auto', label: 'mean.auto', keys: '`', when: hasSheet, run: (p) => p.mean(null) },
  {
    id: 'group',
    label: 'scene.group.make',
    keys: 'Ctrl+G',
    when: (p) => p.list.chosen.length > 1,
    run: (p) => p.list.group(),
  },
  {
    id: 'ungroup',
    label: 'scene.ungroup',
    keys: 'Ctrl+Shift+G',
    when: (p) => p.list.chosen.some((plant) => plant.group !== ''),
    run: (p) => p.list.ungroup(),
  },
  { id: 'clear', label: 'act.clear', run: (p) => p.session.draw('clear') },
  {
    id: 'split',
    label: 'act.split',
    when: (p) => p.session.drawn !== null,
    run: (p) => {
      const { plant } = p.session;
      if (plant) p.session.act({ split: { plant: plant.id } });
    },
  },
  {
    id: 'remove',
    keys: 'Del',
    when: hasSelection,
    run: (p) => p.session.draw({ 'remove-strokes': p.sheet.selected }),
  },
  { id: 'select-none', keys: 'Esc', run: leave },
  { id: 'select-previous', keys: '[', run: (p) => selectNext(p, -1) },
  { id: 'select-next', keys: ']', run: (p) => selectNext(p, 1) },
  ...ARROWS.flatMap(([arrow, x, y]) =>
    ([1, 5] as const).map((times) => ({
      id: `nudge-${arrow}-${times}` as const,
      keys: times === 1 ? arrow : `Shift+${arrow}`,
      when: (p: Page) => hasSelection(p) && document.activeElement === p.sheet.element,
      run: (p: Page) => nudge(p, x * times, y * times),
    })),
  ),
  ...(['sketch', 'tree', 'leaf', 'flower'] as const).map((maker) => ({
    id: `add-${maker}` as const,
    label: `scene.add.${maker}` as const,
    run: (p: Page) => void p.panels.add(maker),
  })),
  { id: 'language', label: 'menu.language.hint', run: (p) => p.switchLanguage() },
  { id: 'theme', label: 'menu.theme', run: (p) => p.theme.next() },
  { id: 'names', label: 'act.names', run: (p) => p.toggleNames() },
  { id: 'tour', label: 'tour.again', run: (p) => p.startTour() },
  { id: 'palette', keys: 'Ctrl+K', run: (p) => p.openPalette() },
  { id: 'help', label: 'dialog.help', keys: '?', run: (p) => p.openHelp() },
] as const satisfies readonly PageCommand[];

export type CommandId = (typeof TABLE)[number]['id'];
export const COMMANDS: readonly (PageCommand & { id: CommandId })[] = TABLE;

const BY_ID = new Map(COMMANDS.map((c) => [c.id, c]));

export function commandOf(id: CommandId): PageCommand {
  return BY_ID.get(id)!;
}

/** The key of a command that is shown to people; empty if it has none. */
export function keyOf(id: CommandId): string {
  return commandOf(id).keys?.split(' ')[0] ?? '';
}

/** The rows of the sheet of keys: whose keys, what stands between them, and what they do. */
const KEY_ROWS: readonly [CommandId[], string, TextKey][] = [
  [SHEET_TOOLS.map(([tool]) => tool), ' ', 'key.tools'],
  [['undo', 'redo'], ' · ', 'key.undo'],
  [['documents'], '', 'documents.title'],
  [['open', 'save', 'export'], ' · ', 'key.files'],
  [['copy', 'cut', 'paste', 'duplicate'], ' · ', 'key.copy'],
  [['all'], '', 'act.all'],
  [['remove'], '', 'key.delete'],
  [ARROWS.map(([arrow]) => `nudge-${arrow}-1` as const), ' ', 'key.nudge'],
  [['mirror'], '', 'tool.mirror'],
  [['turns'], '', 'tool.turns'],
  [['meet'], '', 'act.meet'],
  [['mean-axis', 'mean-pot'], ' – ', 'key.mean'],
  [['mean-auto'], '', 'mean.auto'],
  [['arrange-left', 'arrange-top', 'arrange-right', 'arrange-bottom'], ' ', 'key.arrange'],
  [['photo'], '', 'tool.photo'],
  [['layers'], '', 'tool.layers'],
  [['materials'], '', 'material.title'],
  [['dice'], '', 'key.dice'],
  [['grid'], '', 'variations.title'],
  [['front'], '', 'key.front'],
  [['focus', 'frame'], ' · ', 'key.focus'],
  [['fill-sheet', 'fill-view'], ' · ', 'key.fill'],
  [['stage', 'camera', 'film'], ' · ', 'key.stage'],
  [['walk', 'fly'], ' · ', 'key.walk'],
  [['guide-figure'], '', 'guide.figure'],
  [['place-move', 'place-turn', 'place-size'], ' · ', 'key.place'],
  [['place-x', 'place-z'], ' · ', 'key.place.axis'],
  [['group', 'ungroup'], ' · ', 'key.group'],
  [['wire', 'skeleton'], ' · ', 'key.modes'],
  [['stats'], '', 'view.stats'],
  [['light'], '', 'light.title'],
  [['shape'], '', 'key.shape'],
  [['shape-pick', 'shape-leaves'], ' – ', 'key.shape.tools'],
  [['shape-up', 'shape-down'], ' · ', 'key.shape.up'],
  [['shape-previous', 'shape-next'], ' · ', 'key.shape.walk'],
  [['shape-smaller', 'shape-larger'], ' ', 'key.shape.size'],
  [['palette'], '', 'palette.title'],
  [['help'], '', 'key.help'],
];

/** The sheet of keys, ready to be written: keys and what they do. */
export function keySheet(): { keys: string; text: TextKey }[] {
  return KEY_ROWS.map(([ids, between, text]) => ({ keys: ids.map(keyOf).join(between), text }));
}
