/** Joins sheet, view and engine; owns the bars and the keys. No rule about plants is here. */
import { Card, dot } from './correct';
import { Engine } from './engine';
import { Files } from './files';
import type { Command, DocumentState, Request, StrokeMode, View } from './protocol';
import { Sheet, type Tool } from './sheet/sheet';
import { settingsPanel } from './settings';
import { setSetting, setting } from './store';
import { currentLanguage, number, setLanguage, t, tOf, type TextKey } from './text';
import { button, closePopover, dialog, el, icon, note, popover, relabel, type IconName } from './ui';
import { PlantView } from './view/view';

const TOOLS: readonly [Tool, string][] = [['parts', 'P'], ['branch-contour', 'B'], ['leaf-contour', 'L'], ['erase', 'E'], ['select', 'V']];
type Theme = 'auto' | 'light' | 'dark';

export class App {
  private readonly engine: Engine;
  private readonly sheet: Sheet;
  private readonly card: Card;
  private readonly files: Files;
  private view: PlantView | undefined;
  private state: DocumentState | undefined;
  private seen: View | undefined;
  private draft: { mode: StrokeMode; samples: Float64Array } | undefined;
  private drafted = false;
  private tool: Tool = 'parts';
  private theme: Theme = 'auto';
  private wire = false;
  private started = false;
  private busyTimer = 0;
  private readonly system = matchMedia('(prefers-color-scheme: dark)');
  private parts: Record<string, HTMLElement> = {};

  constructor(private readonly host: HTMLElement) {
    this.engine = new Engine({
      ready: () => this.ready(),
      state: (state, fresh) => { this.state = state; this.sheet.setState(state, fresh); this.showState(); },
      view: (view, parts, textures) => {
        this.seen = view;
        this.view?.update(view, parts, textures);
        this.sheet.setOrgans(new Map((view.item?.strokes ?? []).map((s) => [s.index, s.organ])));
        this.idle();
        this.showView();
        this.sendDraft();
      },
      busy: () => this.busy(),
      failed: (why) => {
        this.idle();
        note(why === 'cancelled' ? t('status.stopped') : t('note.refused', { why }), why === 'cancelled' ? 'good' : 'bad');
      },
      fault: (hold) => { this.idle(); this.view?.forget(); note(t(hold ? 'note.fault.hold' : 'note.fault'), 'bad'); },
      dead: () => { this.idle(); note(t('note.noworker'), 'bad'); },
    });
    this.sheet = new Sheet({
      stroke: (mode, samples) => { this.draft = undefined; this.drafted = false; this.ask({ kind: 'stroke', mode, samples }); },
      draft: (mode, samples) => { this.draft = { mode, samples }; this.showEmpty(); if (!this.engine.growing) this.sendDraft(); },
      undraft: () => {
        this.draft = undefined;
        if (this.drafted) this.ask({ kind: 'draft', mode: 'parts', samples: new Float64Array() });
        this.drafted = false;
        this.showEmpty();
      },
      erase: (ids) => this.run({ do: 'remove', ids }),
      moveBegin: () => this.ask({ kind: 'begin', name: 'move' }),
      moveTo: (ids, x, y) => this.ask({ kind: 'stage', command: { do: 'move', ids, x, y } }),
      moveEnd: (keep) => this.ask(keep ? { kind: 'commit' } : { kind: 'abandon' }),
      selected: (ids, anchor) => {
        if (ids.length > 0 && anchor && this.state) this.card.show(ids, anchor, this.state, this.seen, this.dark);
        else this.card.hide();
      },
      viewport: () => {
        this.view?.setSheetSeen(this.sheet.seen());
        const ids = this.sheet.selected;
        if (ids.length > 0) this.sheet.select(ids);
      },
    }, t('sheet.label'));
    this.card = new Card((command) => this.run(command));
    this.files = new Files(this.engine, {
      opened: () => { this.sheet.fit(); this.view?.frameNow(); },
      picture: () => this.view?.picture(),
      name: () => this.state?.name ?? t('app.untitled'),
      empty: () => !this.seen || this.seen.parts.length === 0,
      looking: (name) => this.looking(name),
    });
    const theme = setting('theme');
    this.theme = theme === 'light' || theme === 'dark' ? theme : 'auto';
  }

  private get dark(): boolean {
    return this.theme === 'dark' || (this.theme === 'auto' && this.system.matches);
  }

  begin(): void {
    try {
      this.view = new PlantView(t('view.label'));
      this.view.onFrontChange = (on) => this.parts['front']?.setAttribute('aria-pressed', String(on));
      this.view.onContext = (lost) => { if (lost) note(t('note.context'), 'bad'); };
    } catch {
      note(t('note.nowebgl'), 'bad');
    }
    this.build();
    this.files.listen(document.body);
    document.addEventListener('keydown', (e) => this.key(e));
    this.system.addEventListener('change', () => this.applyTheme());
    document.addEventListener('visibilitychange', () => { if (document.hidden) void this.files.keepNow(); });
    this.engine.start();
  }

  private ready(): void {
    if (this.started) return;
    this.started = true;
    void this.files.restore().finally(() => { document.body.dataset['ready'] = 'true'; });
  }

  // Asking -------------------------------------------------------------------------------------------------------

  private ask(request: Request): void {
    this.engine.ask(request).then(() => this.files.changed(request)).catch((e: Error) => {
      if (request.kind === 'stroke') this.sheet.dropPending();
      if (e.message !== 'restarted') note(t('note.refused', { why: e.message }), 'bad');
    });
  }

  private run(command: Command): void {
    this.ask({ kind: 'command', command });
  }

  /** The stroke under the pen, as it is now: at most one at a time is on its way. */
  private sendDraft(): void {
    const draft = this.draft;
    if (!draft) return;
    this.draft = undefined;
    this.drafted = true;
    this.engine.growing = true;
    this.engine.ask({ kind: 'draft', ...draft }).catch(() => { this.engine.growing = false; });
  }

  // The page -----------------------------------------------------------------------------------------------------

  private build(): void {
    const p = this.parts;
    const hold = <T extends HTMLElement>(name: string, e: T): T => { p[name] = e; e.id = `b-${name}`; return e; };
    const main = (name: IconName, key: TextKey, act: () => void, shortcut = ''): HTMLElement =>
      hold(name, el('button', { type: 'button', class: 'wide', title: shortcut ? `${t(key)}  (${shortcut})` : t(key), onclick: act }, icon(name), el('span', {}, t(key))));
    const title = hold('name', el('input', {
      class: 'name', spellcheck: 'false', maxlength: '200', 'aria-label': t('menu.name'), title: t('menu.name'),
      onchange: () => { const name = (title as HTMLInputElement).value.trim(); if (name) this.run({ do: 'rename', name }); },
      onkeydown: (e) => { if ((e as KeyboardEvent).key === 'Enter') title.blur(); },
    }));
    const bar = el('header', { class: 'bar' },
      el('span', { class: 'logo' }, el('img', { src: './icon.svg', alt: '', width: '26', height: '26' }), el('b', {}, 'Burgeon')),
      title,
      el('span', { class: 'group' },
        hold('undo', button('undo', t('undo'), () => this.ask({ kind: 'undo' }), 'Ctrl+Z')),
        hold('redo', button('redo', t('redo'), () => this.ask({ kind: 'redo' }), 'Ctrl+Shift+Z'))),
      el('span', { class: 'group' },
        hold('dice', button('dice', t('dice'), () => this.roll(), 'R')),
        hold('settings', button('settings', t('menu.settings'), () => this.openSettings()))),
      el('span', { class: 'space' }),
      el('span', { class: 'group' },
        main('fresh', 'menu.new', () => this.files.fresh()),
        main('samples', 'menu.samples', () => this.files.samples()),
        main('open', 'menu.open', () => this.files.choose(), 'Ctrl+O'),
        main('save', 'menu.save', () => void this.files.save(), 'Ctrl+S'),
        main('export', 'menu.export', () => this.openExport(), 'Ctrl+E')),
      el('span', { class: 'group' },
        hold('language', el('button', { type: 'button', class: 'plain', title: t('menu.language.hint'), onclick: () => this.switchLanguage() }, t('menu.language'))),
        hold('theme', button('theme', t('menu.theme'), () => this.switchTheme())),
        hold('help', button('help', t('menu.help'), () => this.help(), '?'))));
    const tools = el('div', { class: 'tools', role: 'toolbar', 'aria-orientation': 'vertical' });
    for (const [tool, key] of TOOLS) {
      tools.append(hold(tool, button(tool, t(`tool.${tool}` as TextKey), () => this.setTool(tool), key)));
    }
    tools.append(el('hr'), hold('fit', button('fit', t('tool.fit'), () => this.sheet.fit(), '0')));
    const empty = hold('empty', el('div', { class: 'empty' },
      el('h1', {}, t('sheet.empty')), el('p', {}, t('sheet.empty.hint')),
      el('button', { type: 'button', class: 'link', onclick: () => this.files.samples() }, t('sheet.empty.sample'))));
    const left = el('section', { class: 'left' }, this.sheet.element, tools, empty, hold('legend', el('div', { class: 'legend', role: 'list', 'aria-label': t('legend.title') })), this.card.element);
    const seeButtons = el('div', { class: 'tools right-tools', role: 'toolbar' },
      hold('front', button('front', t('view.front'), () => this.view?.setFront(!this.view.isFront), 'F')),
      hold('frame', button('fit', t('view.frame'), () => this.view?.frameNow(), 'Shift+0')),
      hold('wire', button('wire', t('view.wire'), () => this.toggleWire(), 'W')));
    const right = el('section', { class: 'right' },
      ...(this.view ? [this.view.element, seeButtons] : [el('p', { class: 'nogl' }, t('note.nowebgl'))]),
      hold('grows', el('p', { class: 'grows' }, t('view.empty'))), hold('looking', el('p', { class: 'looking' })));
    const split = el('div', { class: 'split', role: 'separator', 'aria-orientation': 'vertical', tabindex: '0' });
    const body = el('main', {}, left, split, right);
    this.splitter(split, body);
    const foot = el('footer', { class: 'foot' }, hold('counts', el('span', { class: 'counts' })), el('span', { class: 'space' }),
      hold('busy', el('span', { class: 'busy' }, el('i'), hold('busytext', el('span', {}, t('status.loading'))),
        el('button', { type: 'button', class: 'link', onclick: () => this.engine.interrupt() }, t('status.cancel')))),
      hold('kept', el('span', { class: 'muted' })));
    this.host.replaceChildren(bar, body, foot);
    p['looking']!.hidden = true;
    if (this.started) p['busy']!.hidden = true;
    this.files.onKept = () => { p['kept']!.textContent = t('status.saved'); };
    this.setTool(this.tool);
    this.applyTheme();
    this.showState();
    this.showView();
  }

  private splitter(split: HTMLElement, body: HTMLElement): void {
    const to = (share: number): void => body.style.setProperty('--left', `${Math.min(80, Math.max(20, share))}%`);
    split.addEventListener('pointerdown', (e) => split.setPointerCapture(e.pointerId));
    split.addEventListener('pointermove', (e) => {
      if (!split.hasPointerCapture(e.pointerId)) return;
      const box = body.getBoundingClientRect();
      const upright = box.height > box.width;
      to(upright ? ((e.clientY - box.top) / box.height) * 100 : ((e.clientX - box.left) / box.width) * 100);
    });
    split.addEventListener('keydown', (e) => {
      const by = { ArrowLeft: -3, ArrowUp: -3, ArrowRight: 3, ArrowDown: 3 }[e.key];
      if (by) to((parseFloat(body.style.getPropertyValue('--left')) || 50) + by);
    });
  }

  private setTool(tool: Tool): void {
    this.tool = tool;
    this.sheet.setTool(tool);
    for (const [name] of TOOLS) this.parts[name]?.setAttribute('aria-pressed', String(name === tool));
  }

  private toggleWire(): void {
    this.wire = !this.wire;
    this.view?.setWire(this.wire);
    this.parts['wire']?.setAttribute('aria-pressed', String(this.wire));
  }

  private roll(): void {
    const [n] = crypto.getRandomValues(new Uint32Array(1));
    this.run({ do: 'seed', seed: String(1 + (n! % 999_999)) });
  }

  private openSettings(): void {
    if (!this.state) return;
    const state = (): DocumentState => this.state!;
    popover(this.parts['settings']!, settingsPanel(state, {
      run: (c) => this.run(c), begin: (name) => this.ask({ kind: 'begin', name }),
      stage: (command) => this.ask({ kind: 'stage', command }), commit: () => this.ask({ kind: 'commit' }),
    }), t('menu.settings'));
  }

  private openExport(): void {
    const list = el('div', { class: 'menu', role: 'menu' });
    for (const format of ['glb', 'obj', 'ply', 'stl', 'png', 'json'] as const) {
      list.append(el('button', { type: 'button', role: 'menuitem', 'data-format': format, onclick: () => { closePopover(); void this.files.exportAs(format); } }, t(`export.${format}`)));
    }
    popover(this.parts['export']!, list, t('menu.export'));
  }

  private switchLanguage(): void {
    const to = currentLanguage() === 'en' ? 'zh' : 'en';
    setLanguage(to);
    setSetting('language', to);
    this.sheet.setLabel(t('sheet.label'));
    this.view?.setLabel(t('view.label'));
    this.sheet.select([]);
    this.build();
  }

  private switchTheme(): void {
    const order: Theme[] = ['auto', 'light', 'dark'];
    this.theme = order[(order.indexOf(this.theme) + 1) % 3]!;
    setSetting('theme', this.theme);
    this.applyTheme();
  }

  private applyTheme(): void {
    document.documentElement.dataset['theme'] = this.dark ? 'dark' : 'light';
    this.sheet.setDark(this.dark);
    this.view?.setDark(this.dark);
    this.showView();
  }

  private help(): void {
    const rows: [string, TextKey][] = [
      ['P B L E V', 'key.tools'], ['Ctrl+Z · Ctrl+Shift+Z', 'key.undo'], ['Ctrl+O · Ctrl+S · Ctrl+E', 'key.files'],
      ['R', 'key.dice'], ['F', 'key.front'], ['[ ]', 'key.next'], ['← ↑ → ↓', 'key.nudge'], ['Del', 'key.delete'], ['?', 'key.help'],
    ];
    const keys = el('dl', { class: 'keys' });
    for (const [key, text] of rows) keys.append(el('dt', {}, el('kbd', {}, key)), el('dd', {}, t(text)));
    const texts = (['help.draw', 'help.pan', 'help.correct', 'help.drop'] as const).map((k) => el('li', {}, t(k)));
    dialog(t('dialog.help'), el('ul', {}, ...texts), keys);
  }

  private key(e: KeyboardEvent): void {
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
    switch (e.key.toLowerCase()) {
      case 'z': return () => this.ask({ kind: e.shiftKey ? 'redo' : 'undo' });
      case 'y': return () => this.ask({ kind: 'redo' });
      case 's': return () => void this.files.save();
      case 'o': return () => this.files.choose();
      case 'e': return () => this.openExport();
      case 'a': return () => { this.setTool('select'); this.sheet.select(this.state?.strokes.map((s) => s.id) ?? []); };
      default: return undefined;
    }
  }

  private plainKey(e: KeyboardEvent): (() => void) | undefined {
    const tool = TOOLS.find(([, key]) => key.toLowerCase() === e.key.toLowerCase());
    if (tool) return () => this.setTool(tool[0]);
    const ids = this.sheet.selected;
    const step = 5 * this.sheet.unitsPerPixel * (e.shiftKey ? 5 : 1);
    const nudge = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[e.key];
    if (nudge && ids.length > 0 && document.activeElement === this.sheet.element) {
      return () => this.run({ do: 'move', ids, x: nudge[0]! * step, y: nudge[1]! * step });
    }
    switch (e.key) {
      case 'r': case 'R': return () => this.roll();
      case 'f': case 'F': return () => this.view?.setFront(!this.view.isFront);
      case 'w': case 'W': return () => this.toggleWire();
      case '0': return () => this.sheet.fit();
      case ')': return () => this.view?.frameNow();
      case '?': return () => this.help();
      case '[': return () => { this.setTool('select'); this.sheet.selectNext(-1); };
      case ']': return () => { this.setTool('select'); this.sheet.selectNext(1); };
      case 'Escape': return () => this.sheet.select([]);
      case 'Delete': case 'Backspace': return ids.length > 0 ? () => this.run({ do: 'remove', ids }) : undefined;
      default: return undefined;
    }
  }

  // What is shown ------------------------------------------------------------------------------------------------

  private showState(): void {
    const { state, parts: p } = this;
    if (!state) return;
    const name = p['name'] as HTMLInputElement;
    if (document.activeElement !== name) name.value = state.name;
    for (const [which, key, shortcut] of [['undo', 'undo', 'Ctrl+Z'], ['redo', 'redo', 'Ctrl+Shift+Z']] as const) {
      const step = state[which];
      const b = p[which] as HTMLButtonElement;
      b.disabled = step === null;
      relabel(b, step === null ? t(key) : t(`${key}.step`, { step: tOf('step', step) }), shortcut);
    }
    relabel(p['dice']!, `${t('dice')} · ${t('dice.seed', { seed: state.seed })}`, 'R');
    document.body.dataset['strokes'] = String(state.strokes.length);
    document.title = `${state.name} · ${t('app.title')}`;
    this.looking(undefined);
    this.showEmpty();
  }

  private showEmpty(): void {
    this.parts['empty']!.hidden = !this.sheet.isEmpty;
  }

  private looking(name: string | undefined): void {
    const line = this.parts['looking']!;
    line.hidden = name === undefined;
    line.textContent = name === undefined ? '' : t('view.model', { name });
  }

  private showView(): void {
    const { seen, parts: p } = this;
    const counts: string[] = [];
    const c = seen?.item?.counts;
    const add = (key: TextKey, count: number): void => { if (count > 0) counts.push(t(key, { count: number(count) })); };
    add('status.strokes', this.state?.strokes.length ?? 0);
    if (c) {
      for (const kind of ['flowers', 'petals', 'leaves', 'branches', 'triangles'] as const) add(`status.${kind}`, c[kind]);
      counts.push(t('status.time', { ms: number(Math.round(seen.item!.timings_ms.total)) }));
    }
    p['counts']!.textContent = counts.join('  ·  ');
    p['counts']!.title = (seen?.item?.warnings ?? []).join('\n');
    p['grows']!.hidden = (seen?.parts.length ?? 0) > 0;
    const organs = [...new Set((seen?.item?.strokes ?? []).map((s) => s.organ))];
    p['legend']!.replaceChildren(...organs.map((o) => el('span', { role: 'listitem' }, dot(o, this.dark), tOf('organ', o))));
    document.body.dataset['triangles'] = String(c?.triangles ?? 0);
    document.body.dataset['flowers'] = String(c?.flowers ?? 0);
    document.body.dataset['parts'] = String(seen?.parts.length ?? 0);
    document.body.dataset['digest'] = seen?.item?.digest ?? '';
    document.body.dataset['revision'] = String(seen?.revision ?? 0);
    const ids = this.sheet.selected;
    if (ids.length > 0) this.sheet.select(ids);
  }

  private busy(): void {
    if (this.busyTimer) return;
    // A flash of work shorter than this only disturbs.
    this.busyTimer = window.setTimeout(() => {
      this.parts['busytext']!.textContent = t('status.working');
      this.parts['busy']!.hidden = false;
    }, 250);
  }

  private idle(): void {
    clearTimeout(this.busyTimer);
    this.busyTimer = 0;
    this.parts['busy']!.hidden = true;
  }
}
