/** The panel of materials: of leaves, petals and sepals, and of what was drawn by the chosen strokes. */
import { Form, type Fields } from './form';
import { asPng } from '../drawing/photo';
import type { Catalogue } from './makers';
import type { Session } from '../worker/session';
import { t, tOf, wordOf } from '../text';
import { el, note } from '../page/ui';
import type { Json, OrganMaterial, Wearer } from '../wire';

const WEARERS: readonly Wearer[] = ['leaf', 'petal', 'sepal'];
const ORDER = ['pattern', 'color', 'second', 'amount', 'roughness'];
/** Pixels of a petal that shows a material. */
const SWATCH = [44, 60] as const;
/** Longest side of a picture that organs wear, pixels. */
const PICTURE_SIDE = 1024;

export interface MaterialsEvents {
  session: Session;
  catalogue: Catalogue;
  /** The strokes that are chosen on the sheet. */
  chosen(): number[];
  choose(accept: string, act: (file: File) => void): void;
}

type Target = Wearer | 'strokes';

/** The same for the same material, whatever the order of its fields. */
const keyOf = (material: OrganMaterial | null): string =>
  material ? JSON.stringify(material, Object.keys(material).sort()) : '';

/** What a person opened the panel for last. */
let last: Target = 'petal';

export class MaterialsPanel {
  readonly element = el('div', { class: 'settings materials' });
  private readonly target: HTMLSelectElement;
  private readonly library = el('div', {
    class: 'swatches',
    role: 'group',
    'aria-label': t('material.library'),
  });
  private readonly form: Form;
  private readonly own = el('div', { class: 'form' });
  private dragging = false;

  constructor(private readonly events: MaterialsEvents) {
    const { catalogue, session } = events;
    const strokes = events.chosen().length > 0;
    const wearers = WEARERS.filter((w) => w !== 'sepal' || session.plant?.maker === 'flower');
    this.target = el(
      'select',
      {
        id: 'b-material-of',
        onchange: () => {
          last = this.target.value as Target;
          this.show();
        },
      },
      ...(strokes ? [el('option', { value: 'strokes' }, t('material.of.strokes'))] : []),
      ...wearers.map((w) => el('option', { value: w }, tOf('material.of', w))),
    );
    this.target.value = strokes ? 'strokes' : wearers.includes(last as Wearer) ? last : 'petal';
    this.form = new Form(
      catalogue.material,
      {
        set: (path, value) => this.change(path, value, (m) => this.wear(m)),
        stage: (path, value) => this.change(path, value, (m) => this.stage(m)),
        done: () => {
          if (this.dragging) session.commit();
          this.dragging = false;
        },
      },
      new Set(['picture']),
    );
    const upload = el(
      'button',
      { type: 'button', class: 'chip', id: 'b-material-picture', onclick: () => this.upload() },
      t('material.picture'),
    );
    const none = el(
      'button',
      { type: 'button', class: 'chip', id: 'b-material-none', onclick: () => this.wear(null) },
      t('material.none'),
    );
    this.own.append(this.form.element);
    this.element.append(
      el('label', {}, el('span', {}, t('material.of')), this.target),
      this.library,
      el('div', { class: 'chips' }, upload, none),
      this.own,
    );
    for (const { key, material } of catalogue.materials) this.library.append(this.swatch(key, material));
    this.show();
  }

  /** Shows what is worn now. */
  show(): void {
    if (this.dragging) return;
    const now = this.worn();
    this.own.hidden = now === null;
    if (now) this.form.show(now as unknown as Fields, [], ORDER);
    for (const b of this.library.children)
      b.setAttribute('aria-pressed', String(b.getAttribute('data-worn') === keyOf(now)));
  }

  private worn(): OrganMaterial | null {
    const { session } = this.events;
    const of = this.target.value as Target;
    if (of !== 'strokes') return session.plant?.wear[of] ?? null;
    const chosen = new Set(this.events.chosen());
    return session.drawn?.strokes.find((s) => chosen.has(s.id))?.material ?? null;
  }

  private swatch(key: string, material: OrganMaterial): HTMLElement {
    const canvas = el('canvas', {
      width: String(SWATCH[0]),
      height: String(SWATCH[1]),
      'aria-hidden': 'true',
    });
    const [width, height] = SWATCH;
    const asked = this.events.session.engine.ask<Uint8Array<ArrayBuffer>>({
      kind: 'swatch',
      material,
      width,
      height,
    });
    asked.then(
      (pixels) => {
        const data = new ImageData(new Uint8ClampedArray(pixels), width, height);
        canvas.getContext('2d')?.putImageData(data, 0, 0);
      },
      () => undefined,
    );
    const b = el(
      'button',
      {
        type: 'button',
        class: 'swatch',
        'data-material': key,
        'data-worn': keyOf(material),
        onclick: () => this.wear(material),
      },
      canvas,
      el('span', {}, wordOf(key)),
    );
    return b;
  }

  private change(path: string, value: Json, act: (material: OrganMaterial) => void): void {
    const now = this.worn();
    if (now) act({ ...now, [path.slice(1)]: value, ...(value === 'picture' ? {} : this.unpictured(path)) });
  }

  /** Another pattern needs no picture. */
  private unpictured(path: string): Partial<OrganMaterial> {
    return path === '/pattern' ? { picture: null } : {};
  }

  private wear(material: OrganMaterial | null): void {
    const { session, chosen } = this.events;
    const { plant } = session;
    const of = this.target.value as Target;
    if (!plant) return;
    if (of === 'strokes') session.draw({ 'set-material': [chosen(), material] });
    else session.run({ plant: [plant.id, { wear: [of, material] }] });
  }

  private stage(material: OrganMaterial): void {
    const { session, chosen } = this.events;
    const { plant } = session;
    const of = this.target.value as Target;
    if (!plant) return;
    if (!this.dragging) session.begin('material');
    this.dragging = true;
    if (of === 'strokes') session.stageDrawn({ 'set-material': [chosen(), material] });
    else session.stage({ plant: [plant.id, { wear: [of, material] }] });
  }

  private upload(): void {
    const { session, chosen, choose, catalogue } = this.events;
    const of = this.target.value as Target;
    const material = this.worn() ?? catalogue.materials[0]!.material;
    const strokes = of === 'strokes' ? chosen() : [];
    choose('image/*', (file) => {
      const worn = asPng(file, PICTURE_SIDE).then(({ png }) =>
        session.engine.ask({ kind: 'wear', wearer: of === 'strokes' ? 'petal' : of, strokes, material, png }),
      );
      worn.catch((e: Error) => note(t('note.unreadable', { name: file.name, why: e.message }), 'bad'));
    });
  }
}
