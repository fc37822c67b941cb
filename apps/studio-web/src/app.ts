/** Joins sheet, view and engine; owns the bars. No rule about plants is here. */
import { Clipboard } from './clipboard';
import { Commands, TOOLS } from './commands';
import { Card, dot } from './correct';
import { Engine } from './engine';
import { Files } from './files';
import { catalogueOf, gallery, MakerPanel, type Catalogue } from './makers';
import { SceneList } from './scene';
import { asPng, photoPanel, placed } from './photo';
import { measured } from './measure';
import type { Request } from './protocol';
import type {
  Action,
  Command,
  DocumentState,
  MakerWord,
  NewMaker,
  PlantState,
  PlantView as Seen,
  SceneView,
  SketchCommand,
  SketchState,
  StrokeMode,
} from './wire';
import { Sheet, type Tool } from './sheet/sheet';
import { settingsPanel } from './settings';
import { Shaping } from './shaping';
import { statsTable } from './stats';
import { setSetting, setting } from './store';
import { currentLanguage, number, setLanguage, t, tell, tOf, type TextKey } from './text';
import { endTour, firstRun } from './tour';
import { button, closePopover, dialog, el, icon, note, popover, relabel, type IconName } from './ui';
import { openVariations } from './variations';
import { PlantView } from './view/view';

type Theme = 'auto' | 'light' | 'dark';
type Look = 'solid' | 'wire' | 'skeleton';
/** Size of a picture in the grid of variations. */
const LOOK_SIZE = [200, 190] as const;
/** The sheet of a plant that is not drawn. */
const NO_DRAWING = { strokes: [], photo: null };
/** A flash of work shorter than this only disturbs. */
const MOMENT_MS = 200;

export class App {
  private readonly engine: Engine;
  readonly sheet: Sheet;
  private readonly card: Card;
  readonly files: Files;
  readonly clipboard: Clipboard;
  view: PlantView | undefined;
  /** Tools in the view; none without WebGL 2. */
  shaping: Shaping | undefined;
  private state: DocumentState | undefined;
  private scene: SceneView | undefined;
  private catalogue: Catalogue | undefined;
  private readonly commands = new Commands(this);
  private readonly panel: MakerPanel;
  private readonly list: SceneList;
  private shownPlant: number | null | undefined;
  private draft: { mode: StrokeMode; samples: Float64Array } | undefined;
  private drafted = false;
  private tool: Tool = 'parts';
  private theme: Theme = 'auto';
  look: Look = 'solid';
  private statsOn = false;
  private steady = 1;
  private started = false;
  private busyTimer = 0;
  private readonly system = matchMedia('(prefers-color-scheme: dark)');
  private parts: Record<string, HTMLElement> = {};
  /** The scene and the edits by hand, in the view's corner. */
  private readonly column = el('div', { class: 'column' });
  /** When the draft that is grown now was sent. */
  private draftAt = 0;
  private photoFrom: SketchState['photo'] = null;

  constructor(private readonly host: HTMLElement) {
    this.engine = new Engine({
      ready: () => this.ready(),
      state: (state, fresh, photo) => {
        this.state = state;
        const other = this.shownPlant !== undefined && state.current !== this.shownPlant;
        this.shownPlant = state.current;
        this.sheet.setState(this.drawn ?? NO_DRAWING, fresh);
        if (other) this.sheet.setOrgans(this.organs());
        this.view?.setPlaces(state.plants, state.current);
        if (other && this.drawn) this.sheet.fit();
        if (photo)
          void createImageBitmap(new Blob([photo])).then(
            (image) => this.sheet.setImage(image),
            () => undefined,
          );
        this.clipboard.select(this.drawn?.strokes ?? []);
        this.showState();
      },
      view: (view, fresh) => {
        this.scene = view;
        this.view?.update(view, fresh);
        if (this.draftAt > 0) measured('pen', this.draftAt);
        this.draftAt = 0;
        this.sheet.setOrgans(this.organs());
        this.panel.follow();
        if (fresh.some((f) => f.view.id === this.state?.current)) this.shaping?.renewed();
        for (const { id, error } of view.plants) this.tellOf(id, error && tell(error));
        this.idle();
        this.showView();
        this.refreshSkeleton();
        this.sendDraft();
      },
      busy: () => this.busy(),
      progress: (share) => {
        this.parts['busytext']!.textContent = t('status.working.percent', {
          percent: Math.floor(100 * share),
        });
      },
      failed: (why) => {
        this.idle();
        note(
          why.code === 'cancelled' ? t('status.stopped') : t('note.refused', { why: tell(why) }),
          why.code === 'cancelled' ? 'good' : 'bad',
        );
      },
      fault: (hold) => {
        this.idle();
        this.view?.forget();
        note(t(hold ? 'note.fault.hold' : 'note.fault'), 'bad');
      },
      dead: () => {
        this.idle();
        note(t('note.noworker'), 'bad');
      },
    });
    this.sheet = new Sheet(
      {
        stroke: (mode, samples, mirror) => {
          this.draft = undefined;
          this.drafted = false;
          if (mirror) this.ask({ kind: 'begin', name: 'draw' });
          this.ask({ kind: 'stroke', mode, samples });
          if (mirror) {
            this.ask({ kind: 'stroke', mode, samples: mirror });
            this.ask({ kind: 'commit' });
          }
        },
        draft: (mode, samples) => {
          this.draft = { mode, samples };
          this.showEmpty();
          if (!this.engine.growing) this.sendDraft();
        },
        undraft: () => {
          this.draft = undefined;
          if (this.drafted) this.ask({ kind: 'draft', mode: 'parts', samples: new Float64Array() });
          this.drafted = false;
          this.showEmpty();
        },
        erase: (ids) => this.draw({ 'remove-strokes': ids }),
        moveBegin: () => this.ask({ kind: 'begin', name: 'move' }),
        moveTo: (ids, x, y) => this.stageDrawn({ 'move-strokes': [ids, [x, y]] }),
        moveEnd: (keep) => this.ask(keep ? { kind: 'commit' } : { kind: 'abandon' }),
        selected: (ids, anchor) => {
          if (ids.length > 0 && anchor && this.drawn)
            this.card.show(ids, anchor, this.drawn, this.seen, this.dark);
          else this.card.hide();
        },
        photoBegin: () => {
          this.photoFrom = this.drawn?.photo ?? null;
          this.ask({ kind: 'begin', name: 'photo' });
        },
        photoMove: (dx, dy) => {
          const p = this.photoFrom;
          if (!p) return;
          const { x, y } = p.place;
          this.stageDrawn({ 'place-photo': { ...p.place, x: x + dx, y: y + dy } });
        },
        photoEnd: (keep) => this.ask(keep ? { kind: 'commit' } : { kind: 'abandon' }),
        viewport: () => {
          this.view?.setSheetSeen(this.sheet.seen());
          const ids = this.sheet.selected;
          if (ids.length > 0) this.sheet.select(ids);
        },
      },
      t('sheet.label'),
    );
    this.card = new Card((command) => this.draw(command));
    this.panel = new MakerPanel(() => this.catalogue, {
      run: (c) => this.run(c),
      act: (action) => this.act(action),
      begin: (name) => this.ask({ kind: 'begin', name }),
      stage: (command) => this.ask({ kind: 'stage', command }),
      commit: () => this.ask({ kind: 'commit' }),
      choose: (accept, act) => this.files.pickFile(accept, act),
      obstacle: (file) => void this.addObstacle(file),
      open: (file) => void this.files.openFile(file),
    });
    this.list = new SceneList({
      run: (c) => this.run(c),
      select: (plant) => this.ask({ kind: 'select', plant }),
      add: (maker) => void this.add(maker),
      gizmo: (mode) => void this.view?.setGizmo(mode),
    });
    this.files = new Files(this.engine, {
      opened: () => {
        this.sheet.fit();
        this.view?.frameNow();
      },
      picture: () => this.view?.picture(),
      name: () => this.state?.name ?? t('app.untitled'),
      empty: () =>
        !this.scene || [this.scene.guest, ...this.scene.plants].every((p) => !p || p.parts.length === 0),
      several: () => (this.state?.plants.length ?? 0) > 1,
      kind: () => this.plant?.maker ?? 'sketch',
      looking: (name) => this.looking(name),
      photo: (file) => this.layPhoto(file),
    });
    this.clipboard = new Clipboard(this.engine, this.sheet, {
      run: (c) => this.draw(c),
      openFile: (file) => this.files.openFile(file),
      changed: () => this.files.changed(),
      choose: (ids) => this.choose(ids),
    });
    const theme = setting('theme');
    this.theme = theme === 'light' || theme === 'dark' ? theme : 'auto';
    this.steady = Math.min(3, Math.max(0, Number(setting('steady') ?? 1) || 0));
    this.sheet.steady = this.steady;
  }

  private get dark(): boolean {
    return this.theme === 'dark' || (this.theme === 'auto' && this.system.matches);
  }

  /** The plant on the left side. */
  private get plant(): PlantState | undefined {
    return this.state?.plants.find((p) => p.id === this.state?.current);
  }

  /** What is drawn of it, if it is a sketch. */
  private get drawn(): SketchState | null {
    return this.plant?.sketch ?? null;
  }

  /** How it looks, or the model that is looked at. */
  private get seen(): Seen | undefined {
    return this.scene?.guest ?? this.scene?.plants.find((p) => p.id === this.state?.current);
  }

  private organs(): Map<number, string> {
    return new Map((this.seen?.item?.strokes ?? []).map((s) => [s.index, s.organ]));
  }

  private told = new Map<number, string | null>();

  /** A plant that cannot be made says why once. */
  private tellOf(id: number, error: string | null): void {
    if (error !== null && this.told.get(id) !== error)
      note(
        t('note.failed', { name: this.state?.plants.find((p) => p.id === id)?.name ?? '', why: error }),
        'bad',
      );
    this.told.set(id, error);
  }

  begin(): void {
    try {
      this.view = new PlantView(t('view.label'));
      this.view.onFrontChange = (on) => this.parts['front']?.setAttribute('aria-pressed', String(on));
      this.view.onPlaceBegin = () => this.ask({ kind: 'begin', name: 'place' });
      this.view.onPlace = (plant, position, yaw_deg, scale) =>
        this.ask({
          kind: 'stage',
          command: { plant: [plant, { place: { position, yaw_deg, scale } }] },
        });
      this.view.onPlaceEnd = () => this.ask({ kind: 'commit' });
      this.view.onPick = (plant) => this.ask({ kind: 'select', plant });
      this.shaping = new Shaping(this.view, {
        run: (c) => this.run(c),
        ask: (request) => this.engine.ask(request),
        select: (plant) => this.ask({ kind: 'select', plant }),
        refused: (why) => note(t('note.refused', { why }), 'bad'),
        changed: () => this.showShaping(),
      });
      this.view.onContext = (lost) => {
        if (lost) note(t('note.context'), 'bad');
      };
    } catch {
      note(t('note.nowebgl'), 'bad');
    }
    this.build();
    // The plant is shown beside the list, not behind it.
    new ResizeObserver(() =>
      this.view?.setInset(this.list.isFolded ? 0 : this.list.element.offsetWidth + 12),
    ).observe(this.list.element);
    this.files.listen(document.body);
    document.addEventListener('keydown', (e) => this.commands.key(e));
    document.addEventListener('paste', (e) => this.clipboard.paste(e));
    this.system.addEventListener('change', () => this.applyTheme());
    document.addEventListener('visibilitychange', () => {
      if (document.hidden) void this.files.keepNow();
    });
    this.engine.start();
  }

  private ready(): void {
    if (this.started) return;
    this.started = true;
    void this.files.restore().finally(() => {
      document.body.dataset['readyAt'] = String(performance.now());
      document.body.dataset['ready'] = 'true';
      // The state may come a moment later; a scene that was restored is there by now.
      if (!this.state || (this.state.plants.length === 1 && this.drawn?.strokes.length === 0)) firstRun();
      void this.loadCatalogue();
    });
  }

  private async loadCatalogue(): Promise<void> {
    if (this.catalogue) return;
    this.catalogue = await catalogueOf(this.engine).catch(() => undefined);
    this.showState();
  }

  /** A plant of a maker: trees ask for their species first. */
  async add(maker: MakerWord): Promise<void> {
    await this.loadCatalogue();
    if (maker !== 'tree' || !this.catalogue) {
      const name = t(`maker.${maker}` as TextKey);
      const made: NewMaker =
        maker === 'flower' ? { flower: 'lily' } : maker === 'tree' ? { tree: 'oak' } : maker;
      this.act({ add: { name, maker: made } });
      return;
    }
    const d = dialog(
      t('tree.choose'),
      gallery(this.catalogue, null, (key) => {
        d.close();
        this.act({ add: { name: tOf('word', key), maker: { tree: key } } });
      }),
    );
    d.classList.add('wide-dialog');
  }

  private async addObstacle(file: File): Promise<void> {
    try {
      await this.engine.ask({
        kind: 'obstacle',
        name: file.name,
        bytes: new Uint8Array(await file.arrayBuffer()),
      });
      this.files.changed();
    } catch (e) {
      note(t('note.unreadable', { name: file.name, why: (e as Error).message }), 'bad');
    }
  }

  // Asking -------------------------------------------------------------------------------------------------------

  ask(request: Request): void {
    if (request.kind === 'stroke') endTour();
    const start = performance.now();
    this.engine
      .ask(request)
      .then(() => {
        if (request.kind === 'undo') measured('undo', start);
        this.files.changed(request);
      })
      .catch((e: Error) => {
        if (request.kind === 'stroke') this.sheet.dropPending();
        if (e.message !== 'restarted') note(t('note.refused', { why: e.message }), 'bad');
      });
  }

  run(command: Command): void {
    this.ask({ kind: 'command', command });
  }

  act(action: Action): void {
    this.ask({ kind: 'action', action });
  }

  /** Asks the drawing on the sheet. */
  draw(command: SketchCommand): void {
    if (this.plant) this.run({ sketch: [this.plant.id, command] });
  }

  private stageDrawn(command: SketchCommand): void {
    if (this.plant) this.ask({ kind: 'stage', command: { sketch: [this.plant.id, command] } });
  }

  /** The stroke under the pen, as it is now: at most one at a time is on its way. */
  private sendDraft(): void {
    const draft = this.draft;
    if (!draft) return;
    this.draft = undefined;
    this.drafted = true;
    this.engine.growing = true;
    this.draftAt = performance.now();
    this.engine.ask({ kind: 'draft', ...draft }).catch(() => {
      this.engine.growing = false;
    });
  }

  // The page -----------------------------------------------------------------------------------------------------

  private build(): void {
    const p = this.parts;
    const hold = <T extends HTMLElement>(name: string, e: T): T => {
      p[name] = e;
      e.id = `b-${name}`;
      return e;
    };
    const main = (name: IconName, key: TextKey, act: () => void, shortcut = ''): HTMLElement =>
      hold(
        name,
        el(
          'button',
          {
            type: 'button',
            class: 'wide',
            title: shortcut ? `${t(key)}  (${shortcut})` : t(key),
            onclick: act,
          },
          icon(name),
          el('span', {}, t(key)),
        ),
      );
    const title = hold(
      'name',
      el('input', {
        class: 'name',
        spellcheck: 'false',
        maxlength: '200',
        'aria-label': t('menu.name'),
        title: t('menu.name'),
        onchange: () => {
          const name = (title as HTMLInputElement).value.trim();
          if (name) this.run({ scene: { rename: name } });
        },
        onkeydown: (e) => {
          if ((e as KeyboardEvent).key === 'Enter') title.blur();
        },
      }),
    );
    const bar = el(
      'header',
      { class: 'bar' },
      el(
        'span',
        { class: 'logo' },
        el('img', { src: './icon.svg', alt: '', width: '26', height: '26' }),
        el('b', {}, 'Burgeon'),
      ),
      title,
      el(
        'span',
        { class: 'group' },
        hold(
          'undo',
          button('undo', t('undo'), () => this.ask({ kind: 'undo' }), 'Ctrl+Z'),
        ),
        hold(
          'redo',
          button('redo', t('redo'), () => this.ask({ kind: 'redo' }), 'Ctrl+Shift+Z'),
        ),
      ),
      el(
        'span',
        { class: 'group' },
        hold(
          'dice',
          button('dice', t('dice'), () => this.roll(), 'R'),
        ),
        hold(
          'lock',
          button('unlock', t('lock'), () => this.toggleLock()),
        ),
        hold(
          'grid',
          button('grid', t('variations.title'), () => this.openVariations(), 'G'),
        ),
        hold(
          'settings',
          button('settings', t('menu.settings'), () => this.openSettings()),
        ),
      ),
      el('span', { class: 'space' }),
      el(
        'span',
        { class: 'group' },
        main('fresh', 'menu.new', () => this.files.fresh()),
        main('samples', 'menu.samples', () => this.files.samples()),
        main('open', 'menu.open', () => this.files.choose(), 'Ctrl+O'),
        main('save', 'menu.save', () => void this.files.save(), 'Ctrl+S'),
        main('share', 'menu.share', () => void this.files.share()),
        main('export', 'menu.export', () => this.files.chooseExport(), 'Ctrl+E'),
      ),
      el(
        'span',
        { class: 'group' },
        hold(
          'language',
          el(
            'button',
            {
              type: 'button',
              class: 'plain',
              title: t('menu.language.hint'),
              onclick: () => this.switchLanguage(),
            },
            t('menu.language'),
          ),
        ),
        hold(
          'theme',
          button('theme', t('menu.theme'), () => this.switchTheme()),
        ),
        hold(
          'commands',
          button('commands', t('palette.title'), () => this.commands.openPalette(), 'Ctrl+K'),
        ),
        hold(
          'help',
          button('help', t('menu.help'), () => this.commands.help(), '?'),
        ),
      ),
    );
    const tools = el('div', { class: 'tools', role: 'toolbar', 'aria-orientation': 'vertical' });
    for (const [tool, key] of TOOLS) {
      tools.append(
        hold(
          tool,
          button(tool, t(`tool.${tool}` as TextKey), () => this.setTool(tool), key),
        ),
      );
    }
    tools.append(
      el('hr'),
      hold(
        'mirror',
        button('mirror', t('tool.mirror'), () => this.toggleMirror(), 'M'),
      ),
      hold(
        'photo',
        button('photo', t('tool.photo'), () => this.openPhoto(), 'U'),
      ),
      hold(
        'fit',
        button('fit', t('tool.fit'), () => this.sheet.fit(), '0'),
      ),
    );
    const empty = hold(
      'empty',
      el(
        'div',
        { class: 'empty' },
        el('h1', {}, t('sheet.empty')),
        el('p', {}, t('sheet.empty.hint')),
        el(
          'button',
          { type: 'button', class: 'link', onclick: () => this.files.samples() },
          t('sheet.empty.sample'),
        ),
      ),
    );
    const left = el(
      'section',
      { class: 'left' },
      this.sheet.element,
      tools,
      empty,
      hold('legend', el('div', { class: 'legend', role: 'list', 'aria-label': t('legend.title') })),
      this.card.element,
      hold('bloom', el('div', { class: 'bloom' })),
      hold('maker', this.panel.element),
      hold(
        'noplant',
        el('div', { class: 'nothing' }, el('h1', {}, t('scene.empty')), el('p', {}, t('scene.empty.hint'))),
      ),
    );
    p['tools'] = tools;
    const seeButtons = el(
      'div',
      { class: 'tools right-tools', role: 'toolbar' },
      hold(
        'shape',
        button('shape', t('shape.title'), () => this.shaping?.toggle(), 'S'),
      ),
      el('hr'),
      hold(
        'front',
        button('front', t('view.front'), () => this.view?.setFront(!this.view.isFront), 'F'),
      ),
      hold(
        'frame',
        button('fit', t('view.frame'), () => this.view?.frameNow(), 'Shift+0'),
      ),
      hold(
        'wire',
        button('wire', t('view.wire'), () => this.setLook(this.look === 'wire' ? 'solid' : 'wire'), 'W'),
      ),
      hold(
        'skeleton',
        button(
          'skeleton',
          t('view.skeleton'),
          () => this.setLook(this.look === 'skeleton' ? 'solid' : 'skeleton'),
          'K',
        ),
      ),
      hold(
        'stats',
        button('stats', t('view.stats'), () => this.toggleStats(), 'I'),
      ),
      hold(
        'picture',
        button('picture', t('export.png'), () => void this.files.picture()),
      ),
    );
    const right = el(
      'section',
      { class: 'right' },
      ...(this.view && this.shaping
        ? [this.view.element, this.shaping.overlay.element, seeButtons, this.shaping.element]
        : [el('p', { class: 'nogl' }, t('note.nowebgl'))]),
      hold('statsbox', el('div', { class: 'statsbox' })),
      this.column,
      hold('grows', el('p', { class: 'grows' }, t('view.empty'))),
      hold('looking', el('p', { class: 'looking' })),
    );
    const split = el('div', {
      class: 'split',
      role: 'separator',
      'aria-orientation': 'vertical',
      tabindex: '0',
    });
    const body = el('main', {}, left, split, right);
    this.splitter(split, body);
    this.column.replaceChildren(this.list.element, ...(this.shaping ? [this.shaping.list] : []));
    const foot = el(
      'footer',
      { class: 'foot' },
      hold('counts', el('span', { class: 'counts' })),
      el('span', { class: 'space' }),
      hold(
        'busy',
        el(
          'span',
          { class: 'busy' },
          el('i'),
          hold('busytext', el('span', {}, t('status.loading'))),
          el(
            'button',
            { type: 'button', class: 'link', onclick: () => this.engine.interrupt() },
            t('status.cancel'),
          ),
        ),
      ),
      hold('kept', el('span', { class: 'muted' })),
    );
    this.host.replaceChildren(bar, body, foot);
    p['looking']!.hidden = true;
    if (this.started) p['busy']!.hidden = true;
    this.files.onKept = () => {
      p['kept']!.textContent = t('status.saved');
    };
    this.setTool(this.tool);
    this.showSwitches();
    this.applyTheme();
    this.showState();
    this.showView();
  }

  private splitter(split: HTMLElement, body: HTMLElement): void {
    const to = (share: number): void =>
      body.style.setProperty('--left', `${Math.min(80, Math.max(20, share))}%`);
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

  setTool(tool: Tool): void {
    this.tool = tool;
    this.sheet.setTool(tool);
    for (const [name] of TOOLS) this.parts[name]?.setAttribute('aria-pressed', String(name === tool));
  }

  setLook(look: Look): void {
    this.look = look;
    this.view?.setWire(look === 'wire');
    if (look === 'skeleton') this.refreshSkeleton();
    else this.view?.setSkeleton(undefined);
    this.showSwitches();
  }

  private refreshSkeleton(): void {
    if (this.look !== 'skeleton') return;
    this.engine.ask<Float32Array>({ kind: 'skeleton' }).then(
      (pairs) => {
        if (this.look === 'skeleton') this.view?.setSkeleton(pairs);
      },
      () => undefined,
    );
  }

  toggleStats(): void {
    this.statsOn = !this.statsOn;
    this.showSwitches();
    this.showView();
  }

  toggleMirror(): void {
    // The main axis's root, where there is a plant; else the middle of the sheet.
    const seen = this.sheet.seen();
    const root = this.drawn && this.drawn.strokes.length > 0 ? this.seen?.front?.x : undefined;
    this.sheet.setAxis(this.sheet.symmetric ? undefined : (root ?? (seen.left + seen.right) / 2));
    this.showSwitches();
  }

  toggleLock(): void {
    const { plant } = this;
    if (plant) this.run({ plant: [plant.id, { lock: !plant.locked }] });
  }

  private showSwitches(): void {
    const press = (name: string, on: boolean): void =>
      this.parts[name]?.setAttribute('aria-pressed', String(on));
    press('wire', this.look === 'wire');
    press('skeleton', this.look === 'skeleton');
    press('stats', this.statsOn);
    press('mirror', this.sheet.symmetric);
    const locked = this.plant?.locked ?? false;
    press('lock', locked);
    this.parts['lock']?.replaceChildren(icon(locked ? 'lock' : 'unlock'));
    this.parts['statsbox']!.hidden = !this.statsOn;
    for (const name of ['dice', 'grid'])
      (this.parts[name] as HTMLButtonElement).disabled = locked || !this.plant;
  }

  private showShaping(): void {
    const { shaping } = this;
    const b = this.parts['shape'] as HTMLButtonElement | undefined;
    if (!b || !shaping) return;
    b.setAttribute('aria-pressed', String(shaping.isOn));
    b.disabled = !shaping.isPossible && !shaping.isOn;
    document.body.dataset['shape'] = shaping.word ?? '';
  }

  openVariations(): void {
    const { plant } = this;
    if (!plant || plant.locked || this.drawn?.strokes.length === 0) return;
    openVariations(this.engine, plant.seed, {
      snapshot: (sent) => this.view?.snapshot(sent, ...LOOK_SIZE),
      take: (seed) => this.run({ plant: [plant.id, { 'set-seed': seed }] }),
    });
  }

  openPhoto(): void {
    popover(
      this.parts['photo']!,
      photoPanel(() => this.drawn?.photo ?? null, this.sheet.placing, {
        run: (c) => {
          this.draw(c);
          if (c === 'remove-photo') closePopover();
        },
        begin: (name) => this.ask({ kind: 'begin', name }),
        stage: (c) => this.stageDrawn(c),
        commit: () => this.ask({ kind: 'commit' }),
        choose: () => {
          closePopover();
          this.files.choose('image/*');
        },
        placing: (on) => {
          this.sheet.placing = on;
        },
      }),
      t('tool.photo'),
    );
  }

  private async layPhoto(file: File): Promise<void> {
    const { png, aspect } = await asPng(file);
    const { x, y, width } = placed(this.sheet.seen(), aspect);
    if (!this.drawn) throw new Error(t('note.nosketch'));
    await this.engine.ask({ kind: 'photo', png, x, y, width });
    this.files.changed();
    note(t('note.photo'));
  }

  private setSteady(strength: number): void {
    this.steady = strength;
    this.sheet.steady = strength;
    setSetting('steady', String(strength));
  }

  roll(): void {
    if (!this.plant) return;
    if (this.plant.locked) {
      note(t('note.locked'));
      return;
    }
    const [n] = crypto.getRandomValues(new Uint32Array(1));
    this.run({ plant: [this.plant.id, { 'set-seed': String(1 + (n! % 999_999)) }] });
  }

  openSettings(): void {
    if (!this.drawn) return;
    const state = (): SketchState => this.drawn ?? first;
    const first = this.drawn;
    const lenders = (this.state?.plants ?? []).filter((p) => p.lends && p.id !== this.plant?.id);
    popover(
      this.parts['settings']!,
      settingsPanel(state, lenders, {
        run: (c) => this.draw(c),
        begin: (name) => this.ask({ kind: 'begin', name }),
        stage: (c) => this.stageDrawn(c),
        commit: () => this.ask({ kind: 'commit' }),
        steady: this.steady,
        setSteady: (strength) => this.setSteady(strength),
      }),
      t('menu.settings'),
    );
  }

  selectAll(): void {
    this.choose(this.drawn?.strokes.map((s) => s.id) ?? []);
  }

  private choose(ids: number[]): void {
    this.setTool('select');
    this.sheet.select(ids);
  }

  switchLanguage(): void {
    const to = currentLanguage() === 'en' ? 'zh' : 'en';
    setLanguage(to);
    setSetting('language', to);
    this.sheet.setLabel(t('sheet.label'));
    this.view?.setLabel(t('view.label'));
    this.shaping?.take(this.shaping.word);
    this.sheet.select([]);
    this.panel.reset();
    this.build();
  }

  switchTheme(): void {
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

  // What is shown ------------------------------------------------------------------------------------------------

  private showState(): void {
    const { state, parts: p } = this;
    if (!state) return;
    const name = p['name'] as HTMLInputElement;
    if (document.activeElement !== name) name.value = state.name;
    for (const [which, key, shortcut] of [
      ['undo', 'undo', 'Ctrl+Z'],
      ['redo', 'redo', 'Ctrl+Shift+Z'],
    ] as const) {
      const step = state[which];
      const b = p[which] as HTMLButtonElement;
      b.disabled = step === null;
      relabel(b, step === null ? t(key) : t(`${key}.step`, { step: tOf('step', step) }), shortcut);
    }
    const { plant, drawn } = this;
    relabel(p['dice']!, plant ? `${t('dice')} · ${t('dice.seed', { seed: plant.seed })}` : t('dice'), 'R');
    document.body.dataset['strokes'] = String(drawn?.strokes.length ?? 0);
    document.body.dataset['plants'] = String(state.plants.length);
    document.body.dataset['current'] = plant?.maker ?? '';
    p['tools']!.hidden = this.sheet.element.hidden = p['legend']!.hidden = !drawn;
    p['maker']!.hidden = !plant || drawn !== null;
    p['noplant']!.hidden = plant !== undefined;
    (p['settings'] as HTMLButtonElement).disabled = !drawn;
    this.panel.show(plant, state, this.seen);
    this.list.show(state, this.scene);
    this.shaping?.show(plant, this.scene?.guest ? undefined : this.seen);
    this.showShaping();
    this.showBloom();
    this.showSwitches();
    document.title = `${state.name} · ${t('app.title')}`;
    this.looking(undefined);
    this.showEmpty();
  }

  private showEmpty(): void {
    this.parts['empty']!.hidden = !this.sheet.isEmpty || !this.drawn;
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
    const add = (key: TextKey, count: number | null): void => {
      if (count) counts.push(t(key, { count: number(count) }));
    };
    add('status.strokes', this.drawn?.strokes.length ?? 0);
    if (c) {
      for (const kind of ['flowers', 'petals', 'leaves', 'branches', 'triangles'] as const)
        add(`status.${kind}`, c[kind]);
      counts.push(t('status.time', { ms: number(Math.round(seen.item!.timings_ms.total)) }));
    }
    p['counts']!.textContent = counts.join('  ·  ');
    if (this.statsOn) p['statsbox']!.replaceChildren(statsTable(this.plant, seen));
    p['counts']!.title = (seen?.item?.warnings ?? []).join('\n');
    p['grows']!.hidden = [this.scene?.guest, ...(this.scene?.plants ?? [])].some(
      (v) => (v?.parts.length ?? 0) > 0,
    );
    if (this.state) {
      this.panel.show(this.plant, this.state, seen);
      this.list.show(this.state, this.scene);
      this.shaping?.show(this.plant, this.scene?.guest ? undefined : seen);
      this.showShaping();
      this.showBloom();
    }
    const organs = [...new Set((seen?.item?.strokes ?? []).map((s) => s.organ))];
    p['legend']!.replaceChildren(
      ...organs.map((o) => el('span', { role: 'listitem' }, dot(o, this.dark), tOf('organ', o))),
    );
    document.body.dataset['triangles'] = String(c?.triangles ?? 0);
    document.body.dataset['flowers'] = String(c?.flowers ?? 0);
    document.body.dataset['parts'] = String(seen?.parts.length ?? 0);
    document.body.dataset['digest'] = seen?.item?.digest ?? '';
    document.body.dataset['revision'] = String(this.scene?.revision ?? 0);
    const ids = this.sheet.selected;
    if (ids.length > 0) this.sheet.select(ids);
  }

  /** A drawn flower that opens: its day, and a button to play it. */
  private showBloom(): void {
    const box = this.parts['bloom']!;
    const { drawn } = this;
    const flowers = (this.seen?.item?.counts.flowers ?? 0) > 0;
    box.hidden = !drawn || (!flowers && drawn.day === null);
    if (
      box.hidden ||
      !drawn ||
      this.panel.isPlaying ||
      (box.contains(document.activeElement) && document.activeElement instanceof HTMLInputElement)
    )
      return;
    const opens = drawn.day !== null;
    const toggle = el(
      'button',
      {
        type: 'button',
        class: 'chip',
        id: 'b-opens',
        'aria-pressed': String(opens),
        title: t('bloom.hint'),
        onclick: () => this.draw({ 'set-day': opens ? null : 6 }),
      },
      t('bloom.opens'),
    );
    box.replaceChildren(toggle, ...(opens ? [this.panel.dayRow(drawn.day!)] : []));
  }

  private busy(): void {
    if (this.busyTimer) return;
    this.busyTimer = window.setTimeout(() => {
      this.parts['busytext']!.textContent = t('status.working');
      this.parts['busy']!.hidden = false;
    }, MOMENT_MS);
  }

  private idle(): void {
    clearTimeout(this.busyTimer);
    this.busyTimer = 0;
    this.parts['busy']!.hidden = true;
  }
}
