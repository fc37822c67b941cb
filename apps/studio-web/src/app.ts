/** Joins the pieces of the page: what one of them says, another does. No rule about plants is here. */
import { buildPage, type Parts } from './page/bars';
import { toggleNames } from './page/names';
import { Clipboard } from './drawing/clipboard';
import { arrange, type CommandId, commandOf, oneBlade } from './page/commands';
import type { Page } from './page/commands';
import { Card } from './drawing/correct';
import { Documents } from './keeping/documents';
import type { ExportPreview } from './exporting/exportview';
import type { LightPanel } from './looking/lightview';
import { Files, safe } from './keeping/files';
import { openFilming } from './exporting/filming';
import { openHelp } from './page/help';
import type { Standing } from './keeping/keeper';
import { listenForKeys } from './page/keyboard';
import { MakerPanel } from './making/makers';
import { openPalette } from './page/palette';
import { type PanelAnchor, Panels } from './making/panels';
import { Readings } from './drawing/readings';
import { GroundPen } from './placing/scattering';
import { type Gizmo, SceneList } from './placing/scene';
import { Scenery } from './looking/scenery';
import { Session, type SessionEvents } from './worker/session';
import { Balls } from './shaping/balls';
import { Shaping } from './shaping/shaping';
import { openShelf } from './keeping/shelf';
import type { Frame } from './sheet/frame';
import { Sheet, type SheetEvents, type Tool } from './sheet/sheet';
import { TURNS } from './sheet/symmetry';
import { Show, whyNot } from './page/show';
import { cutWhenAsked } from './shaping/staged';
import { setSetting, setting } from './keeping/store';
import { currentLanguage, setLanguage, t, tell, tOf } from './text';
import { Theme } from './page/theme';
import type { Half } from './page/halves';
import { SHEET_TOOLS } from './shaping/tools';
import { endTour, firstRun, tour } from './page/tour';
import { closePopover, download, note, popover } from './page/ui';
import { sizePanel } from './placing/sizing';
import { Typing } from './placing/typing';
import { PlantView } from './view/view';
import { ViewModes } from './looking/viewmode';
import { Door, type Mode } from './vr/door';
import type { Written } from './exporting/exporting';
import type { Command, GestureRecord, Obstacle, PlantState, SetDown, SizeGoal, StrokeClass } from './wire';
import { Writing } from './keeping/writing';

/** The sheet of a plant that is not drawn. */
const NO_DRAWING = { strokes: [], layers: [], photo: null };

export class App implements Page {
  readonly session = new Session(this.sessionEvents());
  readonly sheet = new Sheet(this.sheetEvents(), t('sheet.label'));
  private readonly card = new Card({
    run: (command) => this.session.draw(command),
    oneBlade: () => oneBlade(this),
    wear: () => void this.panels.openMaterials(),
    copy: () => void this.clipboard.copy(),
    duplicate: () => this.clipboard.duplicate(),
    arrange: (how) => arrange(this, how),
    choose: (strokes) => this.choose(strokes),
  });
  readonly panel = this.makerPanel();
  readonly list = this.sceneList();
  /** Both are there, or neither is. */
  readonly view: PlantView | undefined;
  readonly shaping: Shaping | undefined;
  readonly balls: Balls | undefined;
  readonly pen: GroundPen | undefined;
  readonly modes: ViewModes;
  readonly door: Door;
  readonly documents = this.makeDocuments();
  private readonly writing = this.makeWriting();
  readonly scenery: Scenery;
  readonly files = this.makeFiles();
  readonly clipboard = new Clipboard(this.session.engine, this.sheet, {
    run: (c) => this.session.draw(c),
    openFile: (file) => this.files.openFile(file),
    choose: (ids) => this.choose(ids),
  });
  readonly typing = new Typing({
    gizmo: () => this.gizmo,
    axis: () => this.axis,
    chosen: () => this.list.chosen,
    carry: (plants, how) => this.session.run({ scene: { carry: [[...plants], how] } }),
  });
  readonly theme = new Theme((dark) => {
    this.sheet.setDark(dark);
    this.view?.setDark(dark);
    this.show.view();
  });
  readonly readings = new Readings(this.session, (strokes) => this.choose(strokes));
  readonly panels: Panels;
  private readonly show: Show;
  /** The export that is seen before it is written. */
  private preview: ExportPreview | undefined;
  /** The plants in the colours of the light that they absorb. */
  private light: LightPanel | undefined;
  private tool: Tool = 'parts';
  /** The tool before the dropper, which is laid down once it has a colour. */
  private drawer: Tool = 'parts';
  private readonly panelSizes = new ResizeObserver(() => this.seeBesidePanels());
  /** To which the gizmo is bound. */
  private axis: 'x' | 'z' | undefined;
  private started = false;
  private toldOfStorage = false;
  /** Why each plant could not be made, as it was said last. */
  private readonly said = new Map<number, string | null>();

  constructor(private readonly host: HTMLElement) {
    try {
      this.view = this.makeView();
      this.shaping = this.makeShaping(this.view);
      this.balls = this.makeBalls(this.view);
      this.pen = new GroundPen(
        this.view,
        (ground) => {
          const { plant } = this.session;
          const how = this.list.scattering;
          if (plant) this.session.act({ scatter: { plant: plant.id, ground, ...how } });
        },
        () => this.list.scattered(),
      );
    } catch {
      note(t('note.nowebgl'), 'bad');
    }
    this.modes = new ViewModes(this.session.engine, this.view, () => this.show.switches());
    this.panels = new Panels(this);
    this.scenery = new Scenery(
      this.view,
      (name) => this.show.parts.buttons.get(name)!,
      (accept, act) => this.files.pickFile(accept, act),
    );
    this.door = this.makeDoor();
    this.show = new Show(this, this.build());
    this.sheet.meets = setting('meets') !== 'off';
    this.showAll();
  }

  /** Listens, and starts the worker. */
  begin(): void {
    this.files.listen(document.body);
    listenForKeys(this);
    document.addEventListener('paste', (e) => this.clipboard.paste(e));
    this.session.engine.start();
  }

  /** The worker is ready, for the first time or again after a fault. */
  private ready(): void {
    if (this.started) return;
    this.started = true;
    void this.files.restore().finally(() => {
      const { session } = this;
      this.writing.begun();
      document.body.dataset['readyAt'] = String(performance.now());
      document.body.dataset['ready'] = 'true';
      // The state may come a moment later; a scene that was restored is there by now.
      if (!session.state || this.isBlank) firstRun();
      void this.panels.loadCatalogue();
    });
  }

  // The pieces ---------------------------------------------------------------------------------------------------

  private sessionEvents(): SessionEvents {
    return {
      ready: () => this.ready(),
      state: (fresh, photo, other) => {
        const { session, sheet } = this;
        const { drawn, state } = session;
        sheet.setState(drawn ?? NO_DRAWING, fresh);
        if (other) sheet.setOrgans(session.organs, this.readings.doubtful, this.readings.left);
        if (state) this.view?.setPlaces(state.plants, state.current);
        if (other && drawn) sheet.fit();
        if (photo)
          void createImageBitmap(new Blob([photo])).then(
            (image) => sheet.setImage(image),
            () => undefined,
          );
        this.panels.renew();
        this.clipboard.select(drawn?.strokes ?? []);
        if (state) this.writing.changed(state.revision);
        this.show.document();
        void this.documents.rename(session.title);
        this.preview?.follow();
      },
      view: (view, fresh) => {
        const { session } = this;
        this.view?.update(view, fresh);
        this.door.seen();
        session.draftShown();
        this.sheet.setOrgans(session.organs, this.readings.doubtful, this.readings.left);
        this.panel.follow();
        if (fresh.some((f) => f.view.id === session.state?.current)) {
          this.shaping?.renewed();
          this.balls?.renewed();
        }
        for (const { id, error } of view.plants) this.sayOnce(id, error && tell(error));
        this.show.idle();
        this.show.view();
        this.modes.refresh();
        this.preview?.follow();
        this.preview?.changed();
        this.light?.changed();
        if (fresh.length > 0) this.documents.seen();
        void this.documents.rename(session.title);
      },
      refused: (request, why) => {
        if (request.kind === 'stroke') this.sheet.dropPending();
        this.view?.putBack();
        // Fields show what there is again, not what was asked for.
        this.panels.renew();
        this.show.document();
        if (why !== 'restarted') note(t('note.refused', { why }), 'bad');
      },
      coarse: (fresh) => {
        this.view?.coarse(fresh);
        this.show.coarse();
      },
      busy: () => this.show.busy(),
      progress: (share) => this.show.progress(share),
      failed: (why) => {
        this.show.idle();
        if (why.code === 'cancelled') note(t('status.stopped'));
        else note(t('note.refused', { why: tell(why) }), 'bad');
      },
      fault: (hold) => {
        this.show.idle();
        this.view?.forget();
        note(t(hold ? 'note.fault.hold' : 'note.fault'), 'bad');
      },
      dead: () => {
        this.show.idle();
        note(t('note.noworker'), 'bad');
      },
      refusal: () => this.documents.refusal(),
      drawing: (requests) => this.documents.keeper.drawing(requests),
      undrawn: () => this.documents.keeper.undrawn(),
      asked: (request) => this.documents.keeper.record(request),
      vain: (request) => this.documents.keeper.forget(request),
      told: (request) => this.documents.keeper.again(request),
      did: (request, value) => this.door.recorder?.did(request, value),
    };
  }

  private get isBlank(): boolean {
    const { state, drawn } = this.session;
    return state?.plants.length === 1 && drawn?.strokes.length === 0;
  }

  /** A plant that cannot be made says why once. */
  private sayOnce(id: number, why: string | null): void {
    if (why !== null && this.said.get(id) !== why) {
      const name = this.session.state?.plants.find((p) => p.id === id)?.name ?? '';
      note(t('note.failed', { name, why }), 'bad');
    }
    this.said.set(id, why);
  }

  private sheetEvents(): SheetEvents {
    return {
      stroke: (mode, inked) => {
        endTour();
        this.session.stroke(mode, inked);
      },
      draft: (mode, inked) => {
        this.session.setDraft(mode, inked);
        this.show.emptySheet();
      },
      undraft: () => {
        this.session.dropDraft();
        this.show.emptySheet();
      },
      erase: (ids) => this.session.draw({ 'remove-strokes': ids }),
      begin: (name) => this.session.begin(name),
      change: (command) => this.session.stageDrawn(command),
      end: (keep) => this.session.end(keep),
      selected: (ids, frame) => {
        const { drawn, seen } = this.session;
        const { isDark } = this.theme;
        const { pressed } = this.sheet;
        const covered = (place: Frame): number => this.sheet.covered(place);
        if (ids.length > 0 && frame && drawn)
          this.card.show(ids, { frame, pressed, covered }, drawn, seen, isDark);
        else this.card.hide();
      },
      viewport: () => {
        this.view?.setSheetSeen(this.sheet.seen());
        this.sheet.reselect();
      },
      tapped: (fingers) => {
        const step = { 2: 'undo', 3: 'redo' }[fingers] as CommandId | undefined;
        if (step) commandOf(step).run(this);
      },
      picked: (color) => {
        if (color === undefined) {
          note(t('note.colourless'));
          return;
        }
        this.panels.takeColour(color);
        this.setTool(this.drawer);
      },
      centred: () => this.show.switches(),
    };
  }

  private makerPanel(): MakerPanel {
    const { session } = this;
    return new MakerPanel(() => this.panels.catalogue, {
      run: (c) => session.run(c),
      runAll: (name, commands) => session.runAll(name, commands),
      species: (plants, key) => this.panels.takeSpecies(plants, key),
      begin: (name) => session.begin(name),
      stage: (command, ...more) => session.stage(command, ...more),
      commit: () => session.commit(),
      choose: (accept, act) => this.files.pickFile(accept, act),
      obstacle: (file) => void this.panels.addObstacle(file),
      open: (file) => void this.files.openFile(file),
      renew: () => this.show.document(),
      measured: () => this.balls?.measured(),
    });
  }

  private sceneList(): SceneList {
    return new SceneList({
      run: (c) => this.session.run(c),
      select: (plant) => this.session.select(plant),
      chose: (plants) => {
        this.view?.setChosen(plants);
        this.show.maker();
      },
      add: (maker) => void this.panels.add(maker),
      split: (plant) => this.session.act({ split: { plant } }),
      gizmo: (mode) => {
        if (mode) this.shaping?.take(undefined);
        void this.view?.setGizmo(mode);
      },
      snap: (on) => this.view?.setSnap(on),
      width: (plant) => this.view?.widthOf(plant) ?? 0,
      scatter: (wish) => {
        this.shaping?.take(undefined);
        if (wish) this.view?.setFront(false);
        this.pen?.take(wish);
        if (wish) note(t(`scatter.${wish.pattern}.hint`));
      },
      together: (name, commands) => this.session.together(name, commands),
    });
  }

  private makeDocuments(): Documents {
    const { session } = this;
    return new Documents({
      ask: (request) => session.engine.ask(request),
      save: () => session.engine.ask<Uint8Array>({ kind: 'save' }),
      name: () => session.title,
      picture: () => (session.isBare ? undefined : this.view?.picture()),
      opened: () => {
        // Another document's plants and pictures have the same numbers.
        this.view?.forget();
        this.said.clear();
        this.sheet.select([]);
        this.setTool('parts');
        this.opened();
      },
      standing: (now) => this.standing(now),
    });
  }

  /** What is true of the saving; that nothing is kept is said once, beside the line that stays. */
  private standing(now: Standing): void {
    this.show?.standing(now);
    const failed = typeof now === 'object';
    if (failed && !this.toldOfStorage)
      note(t(now.failed.name === 'QuotaExceededError' ? 'note.full' : 'note.storage'), 'bad');
    this.toldOfStorage = failed;
  }

  private opened(): void {
    this.sheet.fit();
    this.view?.begin();
  }

  private makeWriting(): Writing {
    return new Writing(this.session.engine, {
      document: () => this.documents.current,
      revision: () => this.session.state?.revision ?? -1,
      standing: (text) => this.show?.file(text),
      left: (name) => note(t('file.left.note', { name }), 'bad'),
    });
  }

  private makeFiles(): Files {
    const { session } = this;
    return new Files(session.engine, this.documents, {
      opened: () => this.opened(),
      picture: () => this.view?.picture(),
      name: () => session.title,
      empty: () => session.isBare,
      several: () => (session.state?.plants.length ?? 0) > 1,
      kind: () => session.plant?.maker ?? 'sketch',
      viewed: (name) => this.show.model(name),
      photo: (file) => this.panels.layPhoto(file),
      look: () => this.openPreview(),
      exportChosen: () => this.preview?.renew(),
      blank: () => this.isBlank,
      offered: (name, version) => this.writing.opened(name, version),
    });
  }

  /** Throws where the browser has no WebGL 2. */
  private makeView(): PlantView {
    const { session } = this;
    return new PlantView(t('view.label'), {
      pick: (plant, more) => (more ? this.list.chooseToo(plant) : this.list.choose([plant])),
      drawn: () => {
        this.shaping?.drawn();
        this.balls?.drawn();
        this.show?.extent(this.view?.extent());
      },
      front: (on) => this.show.press('front', on),
      walked: (mode) => this.scenery.walked(mode),
      context: (lost) => {
        if (lost) note(t('note.context'), 'bad');
      },
      placeBegin: () => session.begin('place'),
      place: (plant, position, yaw_deg, scale) =>
        session.stage({ plant: [plant, { place: { position, yaw_deg, scale } }] }),
      carry: (plants, how) => session.stage({ scene: { carry: [plants, how] } }),
      zoomed: (by, right, down) => this.sheet.zoomAbout(by, right, down),
      placeEnd: () => session.commit(),
      obstacle: (plant, row, by) => session.run({ tree: [plant, { 'move-obstacle': [row, by] }] }),
    });
  }

  private makeShaping(view: PlantView): Shaping {
    const { session } = this;
    return new Shaping(view, {
      run: (c) => session.run(c),
      ask: (request) => session.engine.ask(request),
      cut: (plant, outline) => {
        const refused = (e: Error): void => note(t('note.refused', { why: e.message }), 'bad');
        cutWhenAsked(session, plant, outline).catch(refused);
      },
      select: (plant) => session.select(plant),
      refused: (why) => note(t('note.refused', { why }), 'bad'),
      say: (what) => note(what),
      changed: () => this.show.shaping(),
    });
  }

  private makeBalls(view: PlantView): Balls {
    const { session } = this;
    return new Balls(view, {
      ask: (request) => session.engine.ask(request),
      begin: (name) => session.begin(name),
      stage: (command) => session.stage(command),
      commit: () => session.commit(),
      abandon: () => session.end(false),
      changed: (on) => {
        this.show.shaping();
        if (on) note(t('leaf.balls.hint'));
      },
    });
  }

  private makeDoor(): Door {
    const { session } = this;
    const events = {
      undo: () => session.ask({ kind: 'undo' }),
      redo: () => session.ask({ kind: 'redo' }),
      species: (by: 1 | -1) => this.panels.nextSpecies(by),
      copy: () => {
        const { plant } = session;
        if (!plant) return;
        const aside = this.view?.widthOf(plant.id) || 1;
        session.run({ scene: { duplicate: [plant.id, [Math.round(aside * 100) / 100, 0, 0]] } });
      },
      run: (id: CommandId) => commandOf(id).run(this),
      model: (format: Written) => void this.files.model(format),
      most: (triangles: number) =>
        void session.engine.ask({ kind: 'most', triangles }).catch(() => undefined),
      ready: (triangles: number) =>
        void session.engine.ask({ kind: 'ready', triangles }).catch(() => undefined),
      project: () => session.engine.ask<Uint8Array>({ kind: 'save' }),
      seen: () => ({
        plant: session.plant?.id,
        numbers: session.state?.numbers,
        digest: session.seen?.item?.digest,
      }),
      write: (record: GestureRecord) => {
        const name = `${safe(session.title)}.gestures.json`;
        download(name, JSON.stringify(record), 'application/json');
        note(t('note.exported', { name }));
      },
      setDown: (row: number, how: SetDown) => {
        const { plant } = session;
        if (plant?.tree) session.run({ tree: [plant.id, { 'set-down-obstacle': [row, how] }] });
      },
      select: (by: -1 | 0 | 1) => {
        const { state, plant } = session;
        const plants = state?.plants ?? [];
        const row = plants.findIndex((p) => p.id === plant?.id);
        const to = plants[(row + by + plants.length) % plants.length];
        if (row < 0 || !to) return undefined;
        if (by !== 0) session.select(to.id);
        return { name: to.name, number: plants.indexOf(to) + 1, count: plants.length };
      },
      add: () => {
        const key = session.plant?.tree?.preset ?? 'oak';
        session.act({ add: { name: tOf('word', key), maker: { tree: key } } });
      },
      obstacles: () => session.plant?.tree?.obstacles.length,
      obstruct: (shape: Obstacle) => {
        const { plant } = session;
        const name = t(shape.shape === 'box' ? 'tree.obstacle.box' : 'tree.obstacle.ball');
        if (plant?.tree) session.run({ tree: [plant.id, { 'add-obstacle': { name, shape } }] });
      },
      clear: () => {
        const { plant } = session;
        const last = (plant?.tree?.obstacles.length ?? 0) - 1;
        if (plant && last >= 0) session.run({ tree: [plant.id, { 'remove-obstacle': last }] });
      },
      changed: (on: boolean) => {
        document.body.dataset['headset'] = on ? 'on' : 'off';
        this.show.shaping();
      },
    };
    return new Door(this.view, this.shaping, events, () => this.show.headset());
  }

  /** Goes into the headset, or comes out of it. */
  immerse(mode: Mode): void {
    this.door.pass(mode).catch((e: Error) => note(t('note.headset', { why: e.message }), 'bad'));
  }

  // The page -----------------------------------------------------------------------------------------------------

  /** The page in the language of now. */
  private build(): Parts {
    const pieces = { card: this.card.element, panel: this.panel.element, list: this.list.element };
    const parts = buildPage(this.host, this, pieces);
    this.panelSizes.disconnect();
    for (const panel of [this.list.element, parts.viewTools]) this.panelSizes.observe(panel);
    return parts;
  }

  /** Plants are shown beside the panels of the view and not behind them. */
  private seeBesidePanels(): void {
    const { view, list } = this;
    if (!view) return;
    const { viewTools } = this.show.parts;
    const [outer, tools] = [view.element, viewTools].map((e) => e.getBoundingClientRect()) as [
      DOMRect,
      DOMRect,
    ];
    const seen = viewTools.offsetWidth > 0;
    const upright = tools.height > tools.width;
    view.setCovered({
      left: list.isFolded ? 0 : list.element.getBoundingClientRect().right - outer.left,
      right: seen && upright ? outer.right - tools.left : 0,
      bottom: seen && !upright ? outer.bottom - tools.top : 0,
    });
  }

  private showAll(): void {
    this.show.standing(this.documents.keeper.standing);
    this.setTool(this.tool);
    this.show.meant(this.panels.meant);
    this.show.switches();
    this.show.document();
    // The view is shown with it.
    this.theme.apply();
  }

  meant(kind: StrokeClass | null): void {
    this.show.meant(kind);
  }

  symmetry(): void {
    this.show.switches();
  }

  get chosen(): readonly PlantState[] {
    return this.list.chosen;
  }

  anchor(name: PanelAnchor): HTMLElement {
    return this.show.parts.buttons.get(name)!;
  }

  catalogueCame(): void {
    this.show.document();
  }

  get gizmo(): Gizmo | undefined {
    return this.list.gizmo;
  }

  place(gizmo: Gizmo | undefined): void {
    this.list.take(gizmo === this.list.gizmo ? undefined : gizmo);
  }

  bind(axis: 'x' | 'z'): void {
    this.axis = this.axis === axis ? undefined : axis;
    this.view?.setAxis(this.axis);
  }

  get scatters(): boolean {
    return this.pen?.isOn ?? false;
  }

  stopScattering(): void {
    this.pen?.take(undefined);
  }

  setTool(tool: Tool): void {
    if (tool === 'dropper' && this.tool !== 'dropper') this.drawer = this.tool;
    this.tool = tool;
    this.sheet.setTool(tool);
    for (const [name] of SHEET_TOOLS) this.show.press(name, name === tool);
  }

  choose(strokes: number[]): void {
    if (this.tool !== 'lasso') this.setTool('select');
    this.sheet.select(strokes);
  }

  fill(half: Half): void {
    this.show.parts.halves.fill(half);
  }

  toggleMirror(): void {
    const { session, sheet } = this;
    // The main axis's root, where there is a plant; else the middle of the sheet.
    const { left, right } = sheet.seen();
    const root = session.drawn && session.drawn.strokes.length > 0 ? session.seen?.front?.x : undefined;
    const isOn = sheet.symmetry?.kind === 'mirror';
    sheet.symmetry = isOn ? undefined : { kind: 'mirror', x: root ?? (left + right) / 2 };
    this.show.switches();
  }

  /** Symmetry round a centre, which the next press puts; where there is one, how it is. */
  openTurns(): void {
    const { sheet } = this;
    if (sheet.symmetry?.kind !== 'turns') {
      const { left, right, bottom, top } = sheet.seen();
      const about = [(left + right) / 2, (bottom + top) / 2] as const;
      sheet.symmetry = { kind: 'turns', about, count: TURNS.first };
      sheet.centring = true;
      this.show.switches();
    }
    void this.panels.openTurns();
  }

  /** Whether ends of strokes meet what is drawn. */
  toggleMeets(): void {
    const { sheet } = this;
    sheet.meets = !sheet.meets;
    setSetting('meets', sheet.meets ? 'on' : 'off');
    note(t(sheet.meets ? 'note.meets' : 'note.meets.not'));
  }

  mean(kind: StrokeClass | null): void {
    const { selected } = this.sheet;
    if (selected.length > 0) this.session.draw({ 'set-class': [selected, kind] });
    else this.panels.mean(this.panels.meant === kind ? null : kind);
  }

  toggleStats(): void {
    this.show.toggleStats();
  }

  switchLanguage(): void {
    const to = currentLanguage() === 'en' ? 'zh' : 'en';
    const refused = (e: Error): void => note(t('note.refused', { why: e.message }), 'bad');
    setLanguage(to).then(() => {
      setSetting('language', to);
      this.sheet.setLabel(t('sheet.label'));
      this.view?.setLabel(t('view.label'));
      this.shaping?.take(this.shaping.word);
      this.sheet.select([]);
      this.preview?.close();
      this.light?.close();
      this.panel.reset();
      this.show.parts = this.build();
      this.show.parts.busy.hidden = this.started;
      this.showAll();
    }, refused);
  }

  openShelf(): void {
    void openShelf({
      here: this.documents,
      rename: (name) => this.session.run({ scene: { rename: name } }),
      failed: (why) => note(t('note.refused', { why: whyNot(why) }), 'bad'),
    });
  }

  openFilming(): void {
    const { session, view } = this;
    if (view && !session.isBare) openFilming({ session, view, name: () => safe(session.title) });
    else note(t(view ? 'note.nothing' : 'note.nowebgl'), 'bad');
  }

  openPreview(): void {
    const { session, view } = this;
    this.light?.close();
    if (this.preview) this.preview.close();
    else if (!view || session.isBare) note(t(view ? 'note.nothing' : 'note.nowebgl'), 'bad');
    else
      void import('./exporting/exportview').then(({ ExportPreview }) => {
        const host = this.show.parts.sheetTools.parentElement!;
        this.preview ??= new ExportPreview({
          session,
          view,
          host,
          write: () => this.files.chooseExport(),
          closed: () => {
            this.preview = undefined;
            this.show.press('export-view', false);
            this.show.document();
          },
        });
        this.show.press('export-view', true);
      });
  }

  openLight(): void {
    const { session, view } = this;
    this.preview?.close();
    if (this.light) this.light.close();
    else if (!view || session.isBare) note(t(view ? 'note.nothing' : 'note.nowebgl'), 'bad');
    else
      void import('./looking/lightview').then(({ LightPanel }) => {
        const host = this.show.parts.sheetTools.parentElement!;
        this.light ??= new LightPanel({
          session,
          view,
          host,
          closed: () => {
            this.light = undefined;
            this.show.press('light', false);
          },
        });
        this.show.press('light', true);
      });
  }

  toggleNames(): void {
    toggleNames();
  }

  openWarnings(): void {
    this.show.openWarnings();
  }

  /** How high and wide the chosen plants are, and shall be. */
  openSize(): void {
    const [extent, plants] = [this.view?.extent(), this.list.chosen];
    if (!extent || plants.length === 0) return;
    const panel = sizePanel({
      now: { height: extent.high, width: extent.wide },
      grows: plants.every((p) => p.maker === 'tree'),
      count: plants.length,
      size: (goal) => this.resize(plants, goal),
      done: () => closePopover(),
    });
    popover(this.show.parts.extent, panel, t('size.set'));
  }

  /** Gives plants a size, as one step of undo; else says why they cannot have it. */
  private async resize(plants: readonly PlantState[], goal: SizeGoal): Promise<string | undefined> {
    try {
      const request = { kind: 'size', plants: plants.map((p) => p.id), goal } as const;
      this.session.together('size', await this.session.engine.ask<Command[]>(request));
      return undefined;
    } catch (e) {
      return t('note.refused', { why: (e as Error).message });
    }
  }

  openPalette(): void {
    openPalette(this);
  }

  openHelp(): void {
    openHelp();
  }

  startTour(): void {
    tour();
  }
}
