/** The left side of plants that are not drawn: species, age, obstacles; marks and surface; species and day. */
import type { Engine } from '../worker/engine';
import { Form, type Fields, resetButton } from './form';
import type {
  Command,
  DocumentState,
  Json,
  LeafSpec,
  Obstacle,
  OrganMaterial,
  PlantState,
  PlantView,
  TreeCommand,
} from '../wire';
import { differing, drawingSchema, named, type Schema, withField } from './schema';
import { helpOf, t, wordOf } from '../text';
import { leafSample } from '../keeping/samples';
import { ownPresets } from './own';
import { ownChips } from './ownchips';
import { button, el, icon, refill } from '../page/ui';

export interface Catalogue {
  /** Of a drawing, with its surface. */
  drawing: Schema;
  tree: Schema;
  leaf: Schema;
  flower: Schema;
  material: Schema;
  materials: { key: string; material: OrganMaterial }[];
  trees: { key: string; species: string; about: string; spec: Fields }[];
  flowers: { key: string; spec: Fields }[];
}

export interface MakerEvents {
  run(command: Command): void;
  /** One command or several, as one step of undo; of several it has this name. */
  runAll(name: string, commands: readonly Command[]): void;
  /** Makes trees or flowers another species. */
  species(plants: readonly number[], key: string): void;
  begin(name: string): void;
  stage(command: Command, ...more: readonly Command[]): void;
  commit(): void;
  choose(accept: string, act: (file: File) => void): void;
  obstacle(file: File): void;
  open(file: File): void;
  /** Control balls of a leaf go back to where they were measured. */
  measured(): void;
  /** What is not of the document changed: the panel is shown again. */
  renew(): void;
}

/** The species whose pictures lie in `public/presets`. */
declare const PRESET_PICTURES: readonly string[];

/** Pictures of species; the name alone where there is none. */
function thumbnail(key: string, label: string): HTMLElement {
  const shown = PRESET_PICTURES.includes(key)
    ? el('img', { src: `./presets/${key}.png`, alt: '', loading: 'lazy' })
    : el('span', { class: 'thumb-none', 'aria-hidden': 'true' }, icon('tree'));
  const picture = el('span', { class: 'thumb' }, shown);
  return el('span', { class: 'thumb-cell' }, picture, el('span', {}, label));
}

/** A picture to choose each species by. */
export function gallery(
  catalogue: Catalogue,
  chosen: string | null,
  act: (key: string) => void,
): HTMLElement {
  const grid = el('div', { class: 'gallery' });
  for (const { key, species, about } of catalogue.trees) {
    grid.append(
      el(
        'button',
        {
          type: 'button',
          'data-preset': key,
          'aria-pressed': String(key === chosen),
          title: [species, helpOf(`preset.${key}`, about)].filter((x) => x).join(' · '),
          onclick: () => act(key),
        },
        thumbnail(key, wordOf(key)),
      ),
    );
  }
  return grid;
}

/** What matters first of each maker, beside what the head has. */
const MAIN: Partial<Record<PlantState['maker'], readonly string[]>> = {
  tree: ['/bare', '/leaves/length_m', '/look/leaf_color', '/look/bark_color', '/wood/trunk_radius_m'],
  flower: ['/whorls/0/count', '/whorls/0/tip_color', '/whorls/0/base_color', '/stalk_m', '/opening_days'],
  leaf: ['/surface', '/curl', '/wilt', '/texture'],
};
/** Of a leaf that is made of numbers. */
const LEAF_FORM = ['length_m', 'width', 'widest', 'veins', 'lobes'].map((field) => `/form/${field}`);
const TREE_ORDER = ['leaves', 'blade', 'look', 'method', 'wood', 'clearance_m'];

/** The season of leaves, -1 to 1, in a word. */
function seasonOf(x: number): string {
  if (Math.abs(x) >= 1) return t('tree.season.bare');
  if (x < 0) return t(x < -0.3 ? 'tree.season.unfolding' : 'tree.season.spring');
  if (x === 0) return t('tree.season.summer');
  return t(x < 0.45 ? 'tree.season.turning' : x <= 0.55 ? 'tree.season.autumn' : 'tree.season.falling');
}

/** Where the rows of the head stand in what a plant is asked for; the day of a flower is none of it. */
const HEAD_PATHS = { age: '/age', season: '/look/season', keep: '/leaves/leaf_keep', day: '' } as const;

/** What a plant is asked for. */
const specOf = ({ tree, leaf, flower }: PlantState): Fields =>
  (tree?.spec ?? leaf?.settings ?? flower?.spec ?? {}) as Fields;

/** A shape that did not come by then will not. */
const PATIENCE_MS = 4000;

export class MakerPanel {
  readonly element = el('div', { class: 'maker' });
  private form: Form | undefined;
  private shown = '';
  private dragging = false;
  private playing = 0;
  private plant: PlantState | undefined;
  /** The plants that are changed: that one, and others of its maker that are chosen with it. */
  private alike: readonly PlantState[] = [];
  private days: [number, number] | null = null;
  private head = el('div', { class: 'maker-head' });
  private species: { key: string; element: HTMLElement } | undefined;
  /** Rounds or years of each tree when it is full grown. */
  private readonly grown = new Map<number, number>();
  private tableOpen = false;

  constructor(
    private readonly catalogue: () => Catalogue | undefined,
    private readonly events: MakerEvents,
  ) {}

  /** Everything anew: another language. */
  reset(): void {
    this.shown = '';
    this.form = undefined;
    this.species = undefined;
  }

  stop(): void {
    cancelAnimationFrame(this.playing);
    if (this.playing !== 0) this.events.commit();
    this.playing = 0;
  }

  get isPlaying(): boolean {
    return this.playing !== 0;
  }

  /** `chosen`: the plants that are chosen, of any maker. */
  show(
    plant: PlantState | undefined,
    state: DocumentState,
    view: PlantView | undefined,
    chosen: readonly PlantState[],
  ): void {
    this.plant = plant;
    const isAlike = (p: PlantState): boolean => p.maker === plant?.maker && plant.maker !== 'sketch';
    this.alike = plant ? [plant, ...chosen.filter((p) => p.id !== plant.id && isAlike(p))] : [];
    if (view) this.days = view.days;
    const rounds = view?.item?.growth?.iterations;
    if (plant?.tree && plant.tree.spec['age'] === null && rounds) this.grown.set(plant.id, rounds);
    const catalogue = this.catalogue();
    if (!plant || plant.maker === 'sketch' || !catalogue) {
      this.shown = '';
      return;
    }
    const key = `${plant.id} ${plant.maker}`;
    if (key !== this.shown) {
      this.stop();
      this.shown = key;
      const { maker } = plant;
      const hidden = {
        tree: ['name', 'species', 'about', 'obstacles', 'roots'],
        leaf: [],
        flower: ['name'],
      }[maker];
      this.form = new Form(
        catalogue[maker],
        {
          set: (path, value) => this.events.runAll(maker, this.changes(path, value)),
          stage: (path, value) => this.stage(this.changes(path, value)),
          done: () => this.done(),
        },
        new Set(hidden),
        () => {
          const { tree, flower } = this.plant ?? {};
          const of = (all: { key: string; spec: Fields }[], preset: string | null): Fields | undefined =>
            all.find(({ key }) => key === preset)?.spec;
          return tree
            ? of(catalogue.trees, tree.preset)
            : flower
              ? of(catalogue.flowers, flower.preset)
              : undefined;
        },
      );
      this.element.replaceChildren(this.head, this.form.element);
      this.element.scrollTop = 0;
    }
    // What is dragged keeps its element.
    if (this.dragging || this.playing !== 0) return;
    // What is being typed stays.
    if (document.activeElement instanceof HTMLTextAreaElement && this.head.contains(document.activeElement))
      return;
    const [values, ...others] = this.alike.map(specOf);
    const mixed = differing(values, others);
    refill(this.head, 'data-path', () => {
      if (plant.tree) this.head.replaceChildren(...this.tree(plant, plant.tree, state, catalogue));
      if (plant.leaf) this.head.replaceChildren(...this.leaf(plant, plant.leaf));
      if (plant.flower) this.head.replaceChildren(...this.flower(plant, plant.flower, catalogue));
      if (others.length > 0) this.head.prepend(this.several(mixed));
    });
    const main = plant.leaf?.text === '' ? LEAF_FORM : (MAIN[plant.maker] ?? []);
    this.form?.show(values!, main, plant.maker === 'tree' ? TREE_ORDER : [], mixed);
  }

  /** Says that changes go to several plants, and of the rows of the head where these differ. */
  private several(mixed: readonly string[]): HTMLElement {
    const days = new Set(this.alike.map((p) => p.flower?.day));
    const isMixed = (key: string, path: string): boolean =>
      key === 'day' ? days.size > 1 : mixed.includes(path);
    for (const [key, path] of Object.entries(HEAD_PATHS)) {
      const row = this.head.querySelector(`[data-path="${key}"]`)?.closest('.f-row');
      const shown = row?.querySelector('output');
      if (!shown || !isMixed(key, path)) continue;
      row!.classList.add('mixed');
      shown.textContent = t('mixed');
    }
    const count = this.alike.length;
    return el('p', { class: 'muted alike', 'data-alike': String(count) }, t('maker.alike', { count }));
  }

  /** One field of what the maker is asked for, of each plant that is changed. */
  private changes(path: string, value: Json): Command[] {
    return this.alike.map((plant) => this.command(plant, path, value));
  }

  /** The same asked of each plant that is changed. */
  private ofEach(command: Command): Command[] {
    const [[maker, [, asked]]] = Object.entries(command) as [[string, [number, Json]]];
    return this.alike.map(({ id }) => ({ [maker]: [id, asked] }) as unknown as Command);
  }

  private ask(command: Command): void {
    this.events.runAll(Object.keys(command)[0]!, this.ofEach(command));
  }

  private command(plant: PlantState, path: string, value: Json): Command {
    if (plant.leaf)
      return { leaf: [plant.id, { set: withField(plant.leaf.settings, path.split('/').slice(1), value) }] };
    return { [plant.flower ? 'flower' : 'tree']: [plant.id, { 'set-field': [path, value] }] } as Command;
  }

  private stage([command, ...more]: readonly Command[]): void {
    if (!command) return;
    if (!this.dragging) this.events.begin(Object.keys(command)[0]!);
    this.dragging = true;
    this.events.stage(command, ...more);
  }

  private done(): void {
    if (this.dragging) this.events.commit();
    this.dragging = false;
  }

  private slider(
    key: string,
    label: string,
    low: number,
    high: number,
    step: number,
    value: number,
    act: (x: number) => Command,
    /** What it is at first: a button brings that back. */
    origin: number = value,
  ): HTMLElement {
    const shown = el('output', {}, String(value));
    const input = el('input', {
      type: 'range',
      min: String(low),
      max: String(high),
      step: String(step),
      'data-path': key,
      'aria-label': label,
      oninput: () => {
        shown.textContent = input.value;
        this.stage(this.ofEach(act(Number(input.value))));
      },
      onchange: () => this.done(),
    });
    input.value = String(value);
    const reset = value === origin ? [] : [resetButton(label, () => this.ask(act(origin)))];
    return el('label', { class: 'f-row' }, el('span', {}, label, ...reset), input, shown);
  }

  private section(title: string, ...content: HTMLElement[]): HTMLElement {
    return el('section', { class: 'maker-part' }, el('h3', {}, title), ...content);
  }

  // Trees --------------------------------------------------------------------------------------------------------

  private tree(
    plant: PlantState,
    tree: NonNullable<PlantState['tree']>,
    state: DocumentState,
    catalogue: Catalogue,
  ): HTMLElement[] {
    const { spec } = tree;
    const age = typeof spec['age'] === 'number' ? spec['age'] : null;
    const years = typeof spec['years'] === 'number' ? spec['years'] : this.grown.get(plant.id);
    const most = Math.max(2, age ?? 0, years ?? 40);
    const keep = Number((spec['leaves'] as Fields | undefined)?.['leaf_keep'] ?? 1);
    const lenders = state.plants.filter((p) => p.lends && p.id !== plant.id);
    const leafOf = el(
      'select',
      {
        'data-path': 'leaf-of',
        onchange: () =>
          this.ask({ tree: [plant.id, { 'set-leaf': leafOf.value === '' ? null : Number(leafOf.value) }] }),
      },
      el('option', { value: '' }, t('tree.leaf.own')),
      ...lenders.map((p) => el('option', { value: String(p.id) }, p.name)),
    );
    leafOf.value = tree.leaf === null ? '' : String(tree.leaf);
    const first = catalogue.trees.find(({ key }) => key === tree.preset)?.spec ?? {};
    const ages = this.slider(
      'age',
      t('tree.age'),
      1,
      most,
      1,
      age ?? most,
      (x) => ({ tree: [plant.id, { 'set-field': ['/age', x >= most ? null : x] }] }),
      typeof first['age'] === 'number' ? first['age'] : most,
    );
    if (age === null) ages.querySelector('output')!.textContent = t('tree.age.full');
    const look = spec['look'] as Fields | undefined;
    const season = Number(look?.['season'] ?? 0);
    const seasons = this.slider(
      'season',
      t('tree.season'),
      -1,
      1,
      0.01,
      season,
      (x) => {
        seasons.querySelector('output')!.textContent = seasonOf(x);
        return { tree: [plant.id, { 'set-field': ['/look/season', x] }] };
      },
      Number((first['look'] as Fields | undefined)?.['season'] ?? 0),
    );
    const sheds = (look?.['autumn_color'] ?? null) !== null && spec['bare'] !== true;
    seasons.querySelector('output')!.textContent = sheds ? seasonOf(season) : t('tree.season.none');
    seasons.querySelector('input')!.disabled = !sheds;
    seasons.title = t(sheds ? 'tree.season.hint' : 'tree.season.none.hint');
    const presets = new Set(this.alike.map((p) => p.tree?.preset ?? null));
    const preset = presets.size > 1 ? null : tree.preset;
    const shown = `${this.alike.map((p) => p.id)} ${preset} ${ownPresets('tree').map((p) => p.name)}`;
    // Kept while it shows the same: it has a place to which it was scrolled.
    if (this.species?.key !== shown) {
      this.species = {
        key: shown,
        element: this.section(
          t('tree.species'),
          gallery(catalogue, preset, (key) => this.takeSpecies(key)),
          this.own(plant, (own) => ({ tree: [plant.id, { 'set-spec': [null, own] }] })),
        ),
      };
    }
    return [
      this.species.element,
      this.section(
        t('tree.main'),
        ages,
        seasons,
        this.slider(
          'keep',
          t('tree.keep'),
          0,
          1,
          0.01,
          keep,
          (x) => ({ tree: [plant.id, { 'set-field': ['/leaves/leaf_keep', x] }] }),
          Number((first['leaves'] as Fields | undefined)?.['leaf_keep'] ?? 1),
        ),
        el('label', { class: 'f-row', title: t('tree.leaf.hint') }, el('span', {}, t('tree.leaf')), leafOf),
      ),
      this.obstacles(tree),
    ];
  }

  /** Presets of the person's own. What is kept is the plant as it is then: the section stays while its settings change. */
  private own(plant: PlantState, take: (own: Fields) => Command): HTMLElement {
    return ownChips({
      maker: plant.maker,
      now: () => {
        const { name, tree, flower, leaf } = this.plant ?? plant;
        const spec = tree?.spec ?? flower?.spec ?? leaf?.settings ?? {};
        return { name, spec: spec as unknown as Fields };
      },
      take: (own) => this.ask(take(own)),
      renew: () => {
        this.species = undefined;
        this.events.renew();
      },
    });
  }

  private takeSpecies(key: string): void {
    const plants = this.alike.map((p) => p.id);
    this.events.species(plants, key);
  }

  private treeRun(command: TreeCommand): void {
    if (this.plant) this.events.run({ tree: [this.plant.id, command] });
  }

  private obstacles(tree: NonNullable<PlantState['tree']>): HTMLElement {
    const list = el('ul', { class: 'obstacles' });
    tree.obstacles.forEach(({ name, shape }, row) => {
      const numbers = Object.entries(shape).filter(
        ([, v]) => typeof v === 'number' || (Array.isArray(v) && v.length === 3),
      );
      const fields =
        shape.shape === 'mesh'
          ? []
          : numbers.map(([key, value]) => {
              const values = (Array.isArray(value) ? value : [value]) as number[];
              const boxes = values.map((x, i) => {
                const box = el('input', {
                  type: 'number',
                  step: '0.1',
                  class: 'f-number',
                  'data-path': `o${row}${key}${i}`,
                  'aria-label': `${wordOf(key)} ${Array.isArray(value) ? 'xyz'[i] : ''}`,
                  onchange: () => {
                    if (!Number.isFinite(box.valueAsNumber)) return;
                    const next = values.map((y, k) => (k === i ? box.valueAsNumber : y));
                    const changed = { ...shape, [key]: Array.isArray(value) ? next : next[0]! } as Obstacle;
                    this.treeRun({ 'set-obstacle': [row, { name, shape: changed }] });
                  },
                });
                box.value = String(Number(x.toPrecision(4)));
                return box;
              });
              return el(
                'label',
                { class: 'f-row' },
                el('span', {}, wordOf(key)),
                el('span', { class: 'f-triple' }, ...boxes),
              );
            });
      const called = el('input', {
        class: 'f-name',
        'data-path': `o${row}name`,
        'aria-label': t('tree.obstacle.name'),
        'data-obstacle-name': String(row),
        maxlength: '200',
        onchange: () => {
          const wanted = called.value.trim();
          if (wanted !== '' && wanted !== name) this.treeRun({ 'rename-obstacle': [row, wanted] });
          else called.value = name;
        },
      });
      called.value = name;
      list.append(
        el(
          'li',
          {},
          el(
            'div',
            { class: 'f-pair' },
            called,
            button('close', t('tree.obstacle.off', { name }), () => this.treeRun({ 'remove-obstacle': row })),
          ),
          ...fields,
        ),
      );
    });
    const taken = new Set(tree.obstacles.map((o) => o.name));
    const another = (name: string): string => {
      for (let n = 1; ; n += 1) {
        const next = n === 1 ? name : `${name} ${n}`;
        if (!taken.has(next)) return next;
      }
    };
    const add = (name: string, shape: Obstacle, key: 'box' | 'ball'): HTMLElement =>
      el(
        'button',
        {
          type: 'button',
          class: 'chip',
          'data-obstacle': key,
          onclick: () => this.treeRun({ 'add-obstacle': { name: another(name), shape } }),
        },
        name,
      );
    return this.section(
      t('tree.obstacles'),
      list,
      el(
        'div',
        { class: 'chips' },
        add(t('tree.obstacle.box'), { shape: 'box', min: [0.5, 0, -1], max: [1.5, 3, 1] }, 'box'),
        add(t('tree.obstacle.ball'), { shape: 'sphere', centre: [0, 4, 0], radius_m: 1.2 }, 'ball'),
        el(
          'button',
          {
            type: 'button',
            class: 'chip',
            'data-obstacle': 'file',
            onclick: () => this.events.choose('.glb,.gltf,.obj,.ply,.stl', (f) => this.events.obstacle(f)),
          },
          t('tree.obstacle.file'),
        ),
      ),
    );
  }

  // Leaves -------------------------------------------------------------------------------------------------------

  private leaf(plant: PlantState, leaf: NonNullable<PlantState['leaf']>): HTMLElement[] {
    const { id } = plant;
    const empty = leaf.text === '';
    const table = el('textarea', {
      class: 'field marks',
      rows: '7',
      spellcheck: 'false',
      'data-path': 'marks',
      'aria-label': t('leaf.table'),
      placeholder: 'row,mark,x,y,z,thickness,midrib',
    });
    table.value = leaf.text;
    const take = el(
      'button',
      {
        type: 'button',
        class: 'chip',
        onclick: () =>
          this.events.run({
            leaf: [id, { 'set-data': { name: leaf.file || 'marks.csv', text: table.value } }],
          }),
      },
      t('leaf.table.take'),
    );
    const edit = el(
      'details',
      {
        class: 'f-group',
        ontoggle: () => {
          this.tableOpen = edit.open;
        },
      },
      el('summary', {}, t('leaf.table')),
      table,
      el('div', { class: 'chips' }, take),
    );
    edit.open = this.tableOpen;
    return [
      this.section(
        t('leaf.data'),
        el('p', { class: 'muted' }, empty ? t('leaf.none') : leaf.file),
        el(
          'div',
          { class: 'chips' },
          el(
            'button',
            {
              type: 'button',
              class: empty ? 'primary' : 'chip',
              id: 'b-marks',
              onclick: () => this.events.choose('.csv,.json', (f) => this.events.open(f)),
            },
            t(empty ? 'leaf.choose' : 'leaf.other'),
          ),
          ...(empty ? [this.sampleButton(id)] : []),
        ),
        edit,
      ),
      ...this.moved(leaf.settings.balls.length),
      this.section(
        t('leaf.own'),
        this.own(plant, (own) => ({
          leaf: [id, { set: own as unknown as LeafSpec }],
        })),
      ),
    ];
  }

  /** What a hand did to the marks. */
  private moved(count: number): HTMLElement[] {
    if (count === 0) return [];
    const back = el(
      'button',
      { type: 'button', class: 'chip', id: 'b-measured', onclick: () => this.events.measured() },
      t('leaf.measured'),
    );
    const told = el('p', { class: 'muted' }, t('leaf.moved', { count }));
    return [this.section(t('shape.title'), told, el('div', { class: 'chips' }, back))];
  }

  /** A leaf to begin with: its table can be changed then. */
  private sampleButton(id: number): HTMLElement {
    const take = async (): Promise<void> => {
      const text = await leafSample();
      this.events.run({ leaf: [id, { 'set-data': { name: 'sample.csv', text } }] });
    };
    return el(
      'button',
      { type: 'button', class: 'chip', id: 'b-leaf-sample', onclick: () => void take() },
      t('leaf.sample'),
    );
  }

  // Flowers ------------------------------------------------------------------------------------------------------

  private flower(
    plant: PlantState,
    flower: NonNullable<PlantState['flower']>,
    catalogue: Catalogue,
  ): HTMLElement[] {
    const { id } = plant;
    const chips = el('div', { class: 'chips', role: 'group', 'aria-label': t('flower.species') });
    for (const { key: word } of catalogue.flowers) {
      chips.append(
        el(
          'button',
          {
            type: 'button',
            class: 'chip',
            'data-flower': word,
            'aria-pressed': String(this.alike.every((p) => p.flower?.preset === word)),
            onclick: () => this.takeSpecies(word),
          },
          wordOf(word),
        ),
      );
    }
    const law = el(
      'div',
      { class: 'chips' },
      el(
        'span',
        { class: 'muted' },
        flower.law === null ? t('flower.law.own') : t('flower.law.is', { name: flower.law }),
      ),
      el(
        'button',
        {
          type: 'button',
          class: 'chip',
          onclick: () => this.events.choose('.json', (f) => this.events.open(f)),
        },
        t('flower.law.choose'),
      ),
    );
    if (flower.law !== null)
      law.append(
        el(
          'button',
          {
            type: 'button',
            class: 'chip',
            onclick: () => this.events.run({ flower: [id, { 'set-law': null }] }),
          },
          t('flower.law.off'),
        ),
      );
    return [
      this.section(
        t('flower.species'),
        chips,
        this.own(plant, (own) => ({ flower: [id, { 'set-spec': [null, own] }] })),
      ),
      this.section(t('flower.day'), this.dayRow(flower.day)),
      this.section(t('flower.law'), law),
    ];
  }

  /** The day with a button that plays it; also for drawn flowers. */
  dayRow(day: number): HTMLElement {
    const days = this.days ?? [6, 4];
    const end = Math.round((days[0] + days[1]) * 100) / 100;
    const slider = this.slider('day', t('flower.day'), 0, end, 0.05, Math.min(day, end), (x) =>
      this.dayCommand(x),
    );
    const play = el(
      'button',
      { type: 'button', class: 'chip play', 'data-path': 'play', onclick: () => this.play(slider, end) },
      icon('play'),
      t('flower.play'),
    );
    return el('div', { class: 'day' }, slider, play);
  }

  private dayCommand(day: number): Command {
    const { id, flower } = this.plant!;
    return flower ? { flower: [id, { 'set-day': day }] } : { sketch: [id, { 'set-day': day }] };
  }

  private lastDay = -1;
  private answered = true;
  private askedAt = 0;

  /** From the bud to wilting in eight seconds; as one step of undo. */
  private play(row: HTMLElement, end: number): void {
    if (this.playing !== 0) {
      this.stop();
      return;
    }
    const input = row.querySelector('input')!;
    const output = row.querySelector('output')!;
    const label = row.parentElement!.querySelector('.play')!.lastChild!;
    const from = Number(input.value) >= end - 0.05 ? 0 : Number(input.value);
    const start = performance.now();
    label.textContent = t('flower.stop');
    this.events.begin('day');
    this.lastDay = -1;
    this.answered = true;
    const frame = (now: number): void => {
      const day = Math.min(end, Math.round((from + (Math.max(0, now - start) / 8000) * end) * 100) / 100);
      // One shape at a time: asking for more only puts them off.
      if ((this.answered || now - this.askedAt > PATIENCE_MS) && day !== this.lastDay) {
        this.lastDay = day;
        this.askedAt = now;
        this.answered = false;
        input.value = String(day);
        output.textContent = String(day);
        const [command, ...more] = this.ofEach(this.dayCommand(day));
        if (command) this.events.stage(command, ...more);
      }
      if (day >= end && (this.answered || now - this.askedAt > PATIENCE_MS)) {
        this.stop();
        label.textContent = t('flower.play');
        return;
      }
      this.playing = requestAnimationFrame(frame);
    };
    this.playing = requestAnimationFrame(frame);
  }

  /** A new shape is there: the next may be asked for. */
  follow(): void {
    this.answered = true;
  }
}

export async function catalogueOf(engine: Engine): Promise<Catalogue> {
  const all = JSON.parse(await engine.ask<string>({ kind: 'schema' })) as Catalogue & {
    sketch: Schema;
    skin: Schema;
  };
  for (const maker of ['sketch', 'skin', 'tree', 'leaf', 'flower', 'material'] as const)
    named(all[maker], maker);
  return { ...all, drawing: drawingSchema(all.sketch, all.skin) };
}
