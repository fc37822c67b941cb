/** What a person can ask for by name or key: the command palette, the keys, the sheet that lists them. */
import type { App } from './app';
import { openPalette, type Action } from './palette';
import { SHAPE_TOOLS } from './shaping';
import type { Tool } from './sheet/sheet';
import { t, type TextKey } from './text';
import { tour } from './tour';
import { dialog, el } from './ui';

/** Tools of the sheet and their keys. */
export const TOOLS: readonly [Tool, string][] = [
  ['parts', 'P'],
  ['branch-contour', 'B'],
  ['leaf-contour', 'L'],
  ['erase', 'E'],
  ['select', 'V'],
];

export class Commands {
  constructor(private readonly app: App) {}

  openPalette(): void {
    openPalette(this.actions());
  }

  /** Everything the page can do: for the palette. */
  private actions(): Action[] {
    const { app } = this;
    const a = (id: string, key: TextKey, act: () => void, keys = ''): Action => ({
      id,
      label: t(key),
      act,
      ...(keys ? { keys } : {}),
    });
    return [
      ...TOOLS.map(([tool, keys]) => a(tool, `tool.${tool}` as TextKey, () => app.setTool(tool), keys)),
      a('undo', 'undo', () => app.ask({ kind: 'undo' }), 'Ctrl+Z'),
      a('redo', 'redo', () => app.ask({ kind: 'redo' }), 'Ctrl+Shift+Z'),
      a('new', 'menu.new', () => app.files.fresh()),
      a('close', 'act.close', () => {
        app.view?.forget();
        void app.files.close();
      }),
      a('open', 'menu.open', () => app.files.choose(), 'Ctrl+O'),
      a('samples', 'menu.samples', () => app.files.samples()),
      a('save', 'menu.save', () => void app.files.save(), 'Ctrl+S'),
      a('export', 'menu.export', () => app.files.chooseExport(), 'Ctrl+E'),
      a('share', 'menu.share', () => void app.files.share()),
      a('dice', 'dice', () => app.roll(), 'R'),
      a('lock', 'lock', () => app.toggleLock()),
      a('grid', 'variations.title', () => app.openVariations(), 'G'),
      a('settings', 'menu.settings', () => app.openSettings()),
      a('mirror', 'tool.mirror', () => app.toggleMirror(), 'M'),
      a('photo', 'tool.photo', () => app.openPhoto(), 'U'),
      a('fit', 'tool.fit', () => app.sheet.fit(), '0'),
      a('front', 'view.front', () => app.view?.setFront(!app.view.isFront), 'F'),
      a('frame', 'view.frame', () => app.view?.frameNow(), 'Shift+0'),
      a('wire', 'view.wire', () => app.setLook(app.look === 'wire' ? 'solid' : 'wire'), 'W'),
      a('skeleton', 'view.skeleton', () => app.setLook(app.look === 'skeleton' ? 'solid' : 'skeleton'), 'K'),
      a('shape', 'shape.title', () => app.shaping?.toggle(), 'S'),
      ...SHAPE_TOOLS.map(([word, keys]) =>
        a(
          `shape-${word}`,
          `shape.${word}` as TextKey,
          () => app.shaping?.take(word),
          app.shaping?.isOn ? keys : '',
        ),
      ),
      a('shape-up', 'shape.up.hint', () => app.shaping?.climb(1), 'Q'),
      a('shape-down', 'shape.down.hint', () => app.shaping?.climb(-1), 'Shift+Q'),
      a('stats', 'view.stats', () => app.toggleStats(), 'I'),
      a('picture', 'export.png', () => void app.files.picture()),
      a('all', 'act.all', () => app.selectAll(), 'Ctrl+A'),
      a('copy', 'act.copy', () => void app.clipboard.copy(), 'Ctrl+C'),
      a('paste', 'act.paste', () => void app.clipboard.pasteText(''), 'Ctrl+V'),
      a('duplicate', 'act.duplicate', () => app.clipboard.duplicate(), 'Ctrl+D'),
      a('clear', 'act.clear', () => app.draw('clear')),
      ...(['sketch', 'tree', 'leaf', 'flower'] as const).map((maker) =>
        a(`add-${maker}`, `scene.add.${maker}` as TextKey, () => void app.add(maker)),
      ),
      a('language', 'menu.language.hint', () => app.switchLanguage()),
      a('theme', 'menu.theme', () => app.switchTheme()),
      a('tour', 'tour.again', () => tour()),
      a('help', 'dialog.help', () => this.help(), '?'),
    ];
  }

  help(): void {
    const rows: [string, TextKey][] = [
      ['P B L E V', 'key.tools'],
      ['Ctrl+Z · Ctrl+Shift+Z', 'key.undo'],
      ['Ctrl+O · Ctrl+S · Ctrl+E', 'key.files'],
      ['Ctrl+C · Ctrl+X · Ctrl+V · Ctrl+D', 'key.copy'],
      ['Ctrl+A', 'act.all'],
      ['Del', 'key.delete'],
      ['← ↑ → ↓', 'key.nudge'],
      ['M', 'tool.mirror'],
      ['U', 'tool.photo'],
      ['R', 'key.dice'],
      ['G', 'variations.title'],
      ['F', 'key.front'],
      ['W · K', 'key.looks'],
      ['I', 'view.stats'],
      ['S', 'key.shape'],
      ['1 – 9', 'key.shape.tools'],
      ['Q · Shift+Q', 'key.shape.up'],
      ['[ ]', 'key.shape.size'],
      ['Ctrl+K', 'palette.title'],
      ['?', 'key.help'],
    ];
    const keys = el('dl', { class: 'keys' });
    for (const [key, text] of rows) keys.append(el('dt', {}, el('kbd', {}, key)), el('dd', {}, t(text)));
    const texts = (['help.draw', 'help.pan', 'help.correct', 'help.shape', 'help.drop'] as const).map((k) =>
      el('li', {}, t(k)),
    );
    const again = el(
      'button',
      {
        type: 'button',
        class: 'link',
        onclick: () => {
          d.close();
          tour();
        },
      },
      t('tour.again'),
    );
    const d = dialog(t('dialog.help'), el('ul', {}, ...texts), keys, again);
  }

  key(e: KeyboardEvent): void {
    const target = e.target as HTMLElement;
    if (target.matches('input, select, textarea') || document.querySelector('dialog[open]')) return;
    const command = e.ctrlKey || e.metaKey;
    const act = command ? this.commandKey(e) : this.plainKey(e);
    if (act) {
      e.preventDefault();
      act();
    }
  }

  private commandKey(e: KeyboardEvent): (() => void) | undefined {
    const { app } = this;
    switch (e.key.toLowerCase()) {
      case 'z':
        return () => app.ask({ kind: e.shiftKey ? 'redo' : 'undo' });
      case 'y':
        return () => app.ask({ kind: 'redo' });
      case 's':
        return () => void app.files.save();
      case 'o':
        return () => app.files.choose();
      case 'e':
        return () => app.files.chooseExport();
      case 'k':
        return () => this.openPalette();
      case 'a':
        return () => app.selectAll();
      case 'c':
        return app.sheet.selected.length > 0 && !getSelection()?.toString()
          ? () => void app.clipboard.copy()
          : undefined;
      case 'x':
        return app.sheet.selected.length > 0 ? () => void app.clipboard.cut() : undefined;
      case 'd':
        return () => app.clipboard.duplicate();
      default:
        return undefined;
    }
  }

  /** Keys of the tools in the view. */
  private shapeKey(e: KeyboardEvent): (() => void) | undefined {
    const { shaping } = this.app;
    if (!shaping) return undefined;
    if (e.key === 's' || e.key === 'S') return () => shaping.toggle();
    if (!shaping.isOn) return undefined;
    const tool = SHAPE_TOOLS.find(([, key]) => key === e.key);
    if (tool) return () => shaping.take(tool[0]);
    switch (e.key) {
      case 'Escape':
        return () => {
          if (!shaping.cancel()) shaping.take(undefined);
        };
      case 'Delete':
      case 'Backspace':
        return shaping.word === 'pick' ? () => shaping.remove() : undefined;
      case '[':
        return shaping.word === 'brush' || shaping.word === 'leaves'
          ? () => shaping.resize(1 / 1.15)
          : undefined;
      case ']':
        return shaping.word === 'brush' || shaping.word === 'leaves' ? () => shaping.resize(1.15) : undefined;
      case 'q':
      case 'Q':
        return () => shaping.climb(e.shiftKey ? -1 : 1);
      default:
        return undefined;
    }
  }

  private plainKey(e: KeyboardEvent): (() => void) | undefined {
    const { app } = this;
    const shape = this.shapeKey(e);
    if (shape) return shape;
    const tool = TOOLS.find(([, key]) => key.toLowerCase() === e.key.toLowerCase());
    if (tool) return () => app.setTool(tool[0]);
    const ids = app.sheet.selected;
    const step = 5 * app.sheet.unitsPerPixel * (e.shiftKey ? 5 : 1);
    const nudge = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
    if (nudge && ids.length > 0 && document.activeElement === app.sheet.element) {
      return () => app.draw({ 'move-strokes': [ids, [nudge[0]! * step, nudge[1]! * step]] });
    }
    switch (e.key) {
      case 'r':
      case 'R':
        return () => app.roll();
      case 'f':
      case 'F':
        return () => app.view?.setFront(!app.view.isFront);
      case 'w':
      case 'W':
        return () => app.setLook(app.look === 'wire' ? 'solid' : 'wire');
      case 'k':
      case 'K':
        return () => app.setLook(app.look === 'skeleton' ? 'solid' : 'skeleton');
      case 'i':
      case 'I':
        return () => app.toggleStats();
      case 'g':
      case 'G':
        return () => app.openVariations();
      case 'm':
      case 'M':
        return () => app.toggleMirror();
      case 'u':
      case 'U':
        return () => app.openPhoto();
      case '0':
        return () => app.sheet.fit();
      case ')':
        return () => app.view?.frameNow();
      case '?':
        return () => this.help();
      case '[':
        return () => {
          app.setTool('select');
          app.sheet.selectNext(-1);
        };
      case ']':
        return () => {
          app.setTool('select');
          app.sheet.selectNext(1);
        };
      case 'Escape':
        return () => app.sheet.select([]);
      case 'Delete':
      case 'Backspace':
        return ids.length > 0 ? () => app.draw({ 'remove-strokes': ids }) : undefined;
      default:
        return undefined;
    }
  }
}
