/** The dialogs and panels that the page opens for a plant, and the plants and pictures that come of them. */
import type { Files } from '../keeping/files';
import type { LayersEvents } from '../drawing/layers';
import { type Catalogue, catalogueOf, gallery } from './makers';
import { type Held, hex, penOf } from '../drawing/pen';
import { asPng, photoPanel, placed } from '../drawing/photo';
import type { Session } from '../worker/session';
import { type SettingsEvents, SettingsPanel } from '../drawing/settings';
import type { Sheet, Tool } from '../sheet/sheet';
import { withChanges } from './schema';
import { setSetting, setting } from '../keeping/store';
import { t, tOf, type TextKey, wordOf } from '../text';
import { askName, closePopover, dialog, note, popover } from '../page/ui';
import { isNamedBySpecies } from '../keeping/names';
import { openVariations } from './variations';
import type { PlantView } from '../view/view';
import type {
  Command,
  Layer,
  MakerWord,
  NewMaker,
  PenStyle,
  PlantState,
  SketchCommand,
  StrokeClass,
} from '../wire';

/** Size of a picture in the grid of variations. */
const PICTURE_SIZE = [200, 190] as const;

type DrawingEvents = Pick<SettingsEvents, 'run' | 'begin' | 'stage' | 'commit'>;

/** Buttons below which a panel opens. */
export type PanelAnchor = 'photo' | 'settings' | 'materials' | 'pen' | 'layers' | 'turns';

export interface PanelsPage {
  readonly session: Session;
  readonly sheet: Sheet;
  readonly files: Files;
  readonly view: PlantView | undefined;
  anchor(name: PanelAnchor): HTMLElement;
  setTool(tool: Tool): void;
  choose(strokes: number[]): void;
  /** The plants that are chosen. */
  readonly chosen: readonly PlantState[];
  /** What the pen draws is another now. */
  meant(kind: StrokeClass | null): void;
  symmetry(): void;
  catalogueCame(): void;
}

export class Panels {
  /** What each maker can make; not there before the worker has said it. */
  catalogue: Catalogue | undefined;
  /** Strength of the stabiliser of the pen, 0 to 3. */
  private steady = Math.min(3, Math.max(0, Number(setting('steady') ?? 1) || 0));

  /** The pen that strokes are drawn with. */
  private readonly held: Held = { color: null, width: null, layer: null, class: null };
  /** What is shown again when the document changes. */
  private shown: { show(): void; element: HTMLElement } | undefined;

  constructor(private readonly page: PanelsPage) {
    page.sheet.steady = this.steady;
    page.session.pen = () => this.pen();
  }

  /** The layer that is held, with its row; nothing while strokes go to the sheet itself. */
  get heldLayer(): { layer: Layer; row: number } | undefined {
    const layers = this.page.session.drawn?.layers ?? [];
    const row = layers.findIndex((l) => l.name === this.held.layer);
    return row < 0 ? undefined : { layer: layers[row]!, row };
  }

  private pen(): PenStyle | undefined {
    // A layer that is gone is none.
    const layer = this.heldLayer?.layer.name ?? null;
    return penOf({ ...this.held, layer }, this.page.sheet.unitsPerPixel);
  }

  /** The document or what is chosen changed. */
  renew(): void {
    if (this.shown?.element.isConnected) this.shown.show();
  }

  private events(): LayersEvents {
    const { session, sheet } = this.page;
    const changed = (): void => {
      if (this.held.color !== null) sheet.setOwnColours(true);
      sheet.setPen(this.held);
    };
    const unit = (): number => sheet.unitsPerPixel;
    return {
      session,
      held: this.held,
      chosen: () => sheet.selected,
      unit,
      changed,
      mean: (kind) => this.mean(kind),
      choose: (strokes) => this.page.choose(strokes),
      takeColour: () => {
        closePopover();
        this.page.setTool('dropper');
      },
    };
  }

  /** Says what the pen draws from now on; null: that is found out. */
  mean(kind: StrokeClass | null): void {
    this.held.class = kind;
    this.page.meant(kind);
  }

  /** What the pen draws, if the person said so. */
  get meant(): StrokeClass | null {
    return this.held.class;
  }

  /** A colour for the chosen strokes, or else for those that come. */
  takeColour(color: string): void {
    const { session, sheet } = this.page;
    const bytes = color.match(/\d+/g)!.map(Number) as [number, number, number];
    if (sheet.selected.length > 0) {
      session.draw({ 'set-color': [sheet.selected, bytes] });
      return;
    }
    this.held.color = hex(bytes);
    this.events().changed();
  }

  /** How often strokes are drawn round a centre, and where that is. */
  async openTurns(): Promise<void> {
    const { turnsPanel } = await import('../drawing/layers');
    const { sheet } = this.page;
    const panel = turnsPanel(sheet, () => this.page.symmetry());
    popover(this.page.anchor('turns'), panel, t('tool.turns'));
  }

  async openPen(): Promise<void> {
    if (!this.page.session.drawn) return;
    const { penPanel } = await import('../drawing/layers');
    popover(this.page.anchor('pen'), penPanel(this.events()), t('tool.pen'));
  }

  async openLayers(): Promise<void> {
    if (!this.page.session.drawn) return;
    const { LayersPanel } = await import('../drawing/layers');
    const panel = new LayersPanel(this.events());
    this.shown = panel;
    popover(this.page.anchor('layers'), panel.element, t('tool.layers'));
  }

  addLayer(): void {
    const { session } = this.page;
    askName(t('layer.add'), t('layer.name'), '', (name) => {
      session.draw({ 'add-layer': name });
      this.held.layer = name;
    });
  }

  putOnLayer(): void {
    const { session, sheet } = this.page;
    session.draw({ 'put-on': [sheet.selected, this.heldLayer?.layer.name ?? null] });
  }

  /** Hides or locks the layer that is held, or shows and unlocks it. */
  setHeldLayer(what: 'hidden' | 'locked'): void {
    const held = this.heldLayer;
    if (held)
      this.page.session.draw({ 'set-layer': [held.row, { ...held.layer, [what]: !held.layer[what] }] });
  }

  async openMaterials(): Promise<void> {
    const { session, sheet, files } = this.page;
    await this.loadCatalogue();
    const { catalogue } = this;
    if (!session.plant || !catalogue) return;
    const { MaterialsPanel } = await import('./materials');
    const panel = new MaterialsPanel({
      session,
      catalogue,
      chosen: () => sheet.selected,
      choose: (accept, act) => files.pickFile(accept, act),
    });
    this.shown = panel;
    popover(this.page.anchor('materials'), panel.element, t('material.title'));
  }

  async loadCatalogue(): Promise<void> {
    if (this.catalogue) return;
    this.catalogue = await catalogueOf(this.page.session.engine).catch(() => undefined);
    this.page.catalogueCame();
  }

  /** Makes the plant the next species, or the one before; what it is then. Drawings and leaves are of none. */
  async nextSpecies(by: 1 | -1): Promise<string | undefined> {
    const { session } = this.page;
    await this.loadCatalogue();
    const { plant } = session;
    const now = plant?.tree ?? plant?.flower;
    if (!plant || !now || !this.catalogue) return undefined;
    const keys = (plant.tree ? this.catalogue.trees : this.catalogue.flowers).map(({ key }) => key);
    // A plant of its own kind comes before the first.
    const at = keys.indexOf(now.preset ?? '');
    const key = keys[(Math.max(at, by > 0 ? -1 : 0) + by + keys.length) % keys.length];
    if (key === undefined) return undefined;
    this.takeSpecies([plant.id], key);
    return wordOf(key);
  }

  /** Makes plants another species; the name of each goes with it, unless a person gave it one. */
  takeSpecies(plants: readonly number[], key: string): void {
    const { session } = this.page;
    session.begin('species');
    for (const plant of session.state?.plants.filter((p) => plants.includes(p.id)) ?? []) {
      session.act({ preset: { plant: plant.id, key } });
      if (isNamedBySpecies(plant)) session.run({ plant: [plant.id, { rename: tOf('word', key) }] });
    }
    session.commit();
  }

  /** A plant of a maker: trees ask for their species first. */
  async add(maker: MakerWord): Promise<void> {
    const { session } = this.page;
    await this.loadCatalogue();
    if (maker !== 'tree' || !this.catalogue) {
      const made: NewMaker =
        maker === 'flower' ? { flower: 'lily' } : maker === 'tree' ? { tree: 'oak' } : maker;
      const name =
        typeof made === 'object' ? tOf('word', Object.values(made)[0]!) : t(`maker.${maker}` as TextKey);
      session.act({ add: { name, maker: made } });
      return;
    }
    const d = dialog(
      t('tree.choose'),
      gallery(this.catalogue, null, (key) => {
        d.close();
        session.act({ add: { name: tOf('word', key), maker: { tree: key } } });
      }),
    );
    d.classList.add('wide-dialog');
  }

  async addObstacle(file: File): Promise<void> {
    const { session } = this.page;
    try {
      const bytes = new Uint8Array(await file.arrayBuffer());
      await session.engine.ask({ kind: 'obstacle', name: file.name, bytes });
    } catch (e) {
      note(t('note.unreadable', { name: file.name, why: (e as Error).message }), 'bad');
    }
  }

  async layPhoto(file: File): Promise<void> {
    const { session, sheet } = this.page;
    const { png, aspect } = await asPng(file);
    await session.known;
    const { x, y, width } = placed(sheet.seen(), aspect);
    if (!session.drawn) throw new Error(t('note.nosketch'));
    await session.engine.ask({ kind: 'photo', png, x, y, width });
    note(t('note.photo'));
  }

  openPhoto(): void {
    const { session, sheet, files } = this.page;
    const panel = photoPanel(() => session.drawn?.photo ?? null, sheet.placing, {
      ...this.drawing(),
      run: (c) => {
        session.draw(c);
        if (c === 'remove-photo') closePopover();
      },
      choose: () => {
        closePopover();
        files.choose('image/*');
      },
      placing: (on) => {
        sheet.placing = on;
      },
    });
    popover(this.page.anchor('photo'), panel, t('tool.photo'));
  }

  async openSettings(): Promise<void> {
    const { session, sheet } = this.page;
    await this.loadCatalogue();
    const first = session.drawn;
    if (!first || !this.catalogue) return;
    const lenders = (session.state?.plants ?? []).filter((p) => p.lends && p.id !== session.plant?.id);
    const panel = new SettingsPanel(this.catalogue.drawing, lenders, {
      run: (c) => session.runAll('sketch', this.ofEach(c)),
      begin: (name) => session.begin(name),
      stage: (c) => {
        const [first, ...more] = this.ofEach(c);
        if (first) session.stage(first, ...more);
      },
      commit: () => session.commit(),
      others: () => this.otherDrawings,
      now: () => session.drawn ?? first,
      name: () => session.plant?.name ?? '',
      steady: this.steady,
      setSteady: (strength) => {
        this.steady = strength;
        sheet.steady = strength;
        setSetting('steady', String(strength));
      },
    });
    this.shown = panel;
    popover(this.page.anchor('settings'), panel.element, t('menu.settings'));
  }

  /** Drawings that are chosen beside that on the sheet. */
  private get otherDrawings(): PlantState[] {
    const { plant } = this.page.session;
    return this.page.chosen.filter((p) => p.sketch && p.id !== plant?.id);
  }

  /** What a panel asks of the drawing on the sheet, asked of all that are chosen: settings change by what changed of them. */
  private ofEach(command: SketchCommand): Command[] {
    const { plant, drawn } = this.page.session;
    if (!plant || !drawn) return [];
    const others = this.otherDrawings.map((p): Command => {
      const { sketch, skin } = p.sketch!;
      if (typeof command === 'object' && 'set-sketch' in command)
        return { sketch: [p.id, { 'set-sketch': withChanges(drawn.sketch, command['set-sketch'], sketch) }] };
      if (typeof command === 'object' && 'set-skin' in command)
        return { sketch: [p.id, { 'set-skin': withChanges(drawn.skin, command['set-skin'], skin) }] };
      return { sketch: [p.id, command] };
    });
    return [{ sketch: [plant.id, command] }, ...others];
  }

  /** How a panel changes the drawing. */
  private drawing(): DrawingEvents {
    const { session } = this.page;
    return {
      run: (c) => session.draw(c),
      begin: (name) => session.begin(name),
      stage: (c) => session.stageDrawn(c),
      commit: () => session.commit(),
    };
  }

  openVariations(): void {
    const { session } = this.page;
    const { plant } = session;
    if (!plant || plant.locked || session.drawn?.strokes.length === 0) return;
    openVariations(session.engine, plant.seed, {
      snapshot: (sent) => this.page.view?.snapshot(sent, ...PICTURE_SIZE),
      take: (seed) => session.run({ plant: [plant.id, { 'set-seed': seed }] }),
    });
  }

  roll(): void {
    const { session } = this.page;
    const { plant } = session;
    if (!plant) return;
    if (plant.locked) {
      note(t('note.locked'));
      return;
    }
    const [n] = crypto.getRandomValues(new Uint32Array(1));
    session.run({ plant: [plant.id, { 'set-seed': String(1 + (n! % 999_999)) }] });
  }

  toggleLock(): void {
    const { session } = this.page;
    const { plant } = session;
    if (plant) session.run({ plant: [plant.id, { lock: !plant.locked }] });
  }
}
