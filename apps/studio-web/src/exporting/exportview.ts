/** The export as it will be, before it is written: its level of detail and wind in the view, its figures beside it. */
import { aboutOf, holds, isZipped, levelRows, MODELS, nameOf, type Target, type Written } from './exporting';
import { optionsOf } from './programs';
import type { SentExport } from '../worker/protocol';
import type { Session } from '../worker/session';
import { megabytes, number, t, type TextKey, tOf } from '../text';
import { button, el, refill } from '../page/ui';
import { Exported } from '../view/exported';
import type { PlantView } from '../view/view';
import type { ExportRequest, ExportView } from '../wire';

const MOST_LEVELS = 4;
/** A change of the document is followed when the hand rests so long, milliseconds. */
const REST_MS = 120;

export interface ExportPage {
  readonly session: Session;
  readonly view: PlantView;
  /** Over which part of the page it lies. */
  readonly host: HTMLElement;
  /** Opens the dialogue of the export with these options. */
  write(format: Target): void;
  closed(): void;
}

/** What was chosen last, as long as the page is there. */
const last = { level: 0, wind: 0 };

export class ExportPreview {
  private readonly element = el('section', {
    class: 'exportview',
    id: 'b-exportview',
    role: 'region',
    'aria-label': t('exported.title'),
  });
  private readonly table = el('div', { class: 'figures', 'aria-live': 'polite' });
  private readonly rows = el('div', { class: 'settings' });
  private readonly lent = el('div', { class: 'lent' });
  private readonly calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
  private shown: Exported | undefined;
  private wanted = 0;
  private asking = false;
  private timer = 0;
  private closed = false;
  /** There is a scene to choose. */
  private several = false;

  constructor(private readonly page: ExportPage) {
    const close = button('close', t('dialog.close'), () => this.close());
    close.id = 'b-exportview-close';
    const write = el(
      'button',
      {
        type: 'button',
        class: 'primary',
        id: 'b-exportview-go',
        onclick: () => page.write(optionsOf().format),
      },
      t('exported.write'),
    );
    this.element.append(
      el('header', {}, el('h2', {}, t('exported.title')), close),
      el('p', { class: 'muted' }, t('exported.hint')),
      this.rows,
      this.lent,
      this.table,
      el('div', { class: 'row' }, el('span', { class: 'space' }), write),
    );
    this.element.addEventListener('keydown', (e) => {
      if (e.key !== 'Escape') return;
      e.stopPropagation();
      this.close();
    });
    page.host.append(this.element);
    this.fill();
    this.follow();
    this.ask();
    this.rows.querySelector('select')?.focus();
  }

  /** What will be written. */
  private get request(): ExportRequest & { readonly format: Written } {
    const { format, options } = optionsOf();
    const whole = options.whole || !this.isSeveral;
    return { format: format as Written, ...options, whole, wind: last.wind > 0 };
  }

  private get isSeveral(): boolean {
    return (this.page.session.state?.plants.length ?? 0) > 1;
  }

  private fill(): void {
    const { format, options } = optionsOf();
    const far = options.impostor && holds(format, 'levels');
    // The level that is shown is one of those that are written.
    if (last.level < MOST_LEVELS || !far) last.level = Math.min(last.level, options.levels - 1);
    const several = this.isSeveral;
    this.several = several;
    const formats = MODELS.map((f) => [f, `${nameOf(f)} · ${aboutOf(f)}`] as const);
    const percent = (x: number): string => (x === 0 ? t('exported.still') : `${Math.round(100 * x)} %`);
    const carries = holds(format, 'wind');
    const notes: string[] = [];
    if (!carries) notes.push(t('exported.windless'));
    else if (this.calm) notes.push(t('exported.calm'));
    const fine = levelRows(options, () => this.renew(), 'b-exported-');
    fine.show(format);
    this.rows.replaceChildren(
      select('exported.format', 'format', formats, format as Written, (f) => {
        optionsOf().format = f;
        optionsOf();
        this.renew();
      }),
      ...(several
        ? [
            select(
              'export.what',
              'what',
              [
                ['scene', t('export.what.scene')],
                ['plant', t('export.what.plant')],
              ] as const,
              options.whole ? 'scene' : 'plant',
              (w) => {
                options.whole = w === 'scene';
                this.ask();
              },
            ),
          ]
        : []),
      slider(
        'exported.level',
        'level',
        last.level,
        far ? MOST_LEVELS : MOST_LEVELS - 1,
        1,
        (x) => (x < MOST_LEVELS ? `LOD ${x}` : t('exported.far')),
        true,
        (x) => {
          last.level = x;
          if (x < MOST_LEVELS) options.levels = Math.max(options.levels, x + 1);
          fine.show(format);
          this.ask();
        },
      ),
      ...fine.rows,
      slider('exported.wind', 'wind', last.wind, 1, 0.05, percent, carries, (x) => {
        const before = last.wind;
        last.wind = x;
        options.wind = x > 0;
        this.shown?.blow(x);
        this.page.view.stir();
        // With wind, more is written.
        if (before > 0 !== x > 0) this.ask();
      }),
      ...notes.map((text) => el('p', { class: 'muted' }, text)),
    );
  }

  /** Something else is chosen, here or in the dialogue. */
  renew(): void {
    this.fill();
    this.ask();
  }

  /** The document changed: age and season of a tree are lent by its panel, and what is seen is out of date. */
  follow(): void {
    if (this.several !== this.isSeveral) this.fill();
    if (this.page.session.plant?.maker !== 'tree') {
      this.lent.replaceChildren();
      return;
    }
    const own = ['age', 'season'].map((path) =>
      document.querySelector<HTMLElement>(`#b-maker [data-path="${path}"]`),
    );
    if (own.includes(null)) return;
    refill(this.lent, 'data-path', () =>
      this.lent.replaceChildren(...own.map((slider) => slider!.closest('label')!)),
    );
  }

  /** The plants were made again. */
  changed(): void {
    clearTimeout(this.timer);
    // What is shown is old from now on.
    this.element.dataset['wanted'] = String(this.wanted + 1);
    this.timer = window.setTimeout(() => this.ask(), REST_MS);
  }

  /** One look at a time; what came up meanwhile is looked at next. */
  private ask(): void {
    this.wanted += 1;
    this.element.dataset['wanted'] = String(this.wanted);
    if (!this.asking) void this.look();
  }

  private async look(): Promise<void> {
    this.asking = true;
    const { session, view } = this.page;
    let done = 0;
    while (!this.closed && done !== this.wanted) {
      done = this.wanted;
      const { request } = this;
      try {
        const sent = await session.engine.ask<SentExport>({ kind: 'look', request, level: last.level });
        if (this.closed) break;
        if (done !== this.wanted) continue;
        view.setStandIn((looks) => {
          this.shown = new Exported(looks, sent, this.calm);
          this.shown.blow(request.wind ? last.wind : 0);
          return this.shown;
        });
        this.tell(sent.view, request.format);
        await this.weigh(request, done);
      } catch (e) {
        if (this.closed || done !== this.wanted) continue;
        this.shown = undefined;
        view.setStandIn(undefined);
        this.table.replaceChildren(el('p', { class: 'muted' }, (e as Error).message));
      }
      this.element.dataset['shown'] = String(done);
    }
    this.asking = false;
  }

  /** How much all of it comes to, where it is more than what is shown. */
  private async weigh(request: ExportRequest, asked: number): Promise<void> {
    if (request.levels === 1 && !request.impostor && !request.sway) return;
    const bytes = await this.page.session.engine.ask<number>({ kind: 'weigh', request });
    if (this.closed || asked !== this.wanted) return;
    const written = line('exported.written', 'written', bytes);
    written.title = t('exported.file.help');
    this.table.append(written);
  }

  private tell({ parts, draws, textures, texture_bytes, file_bytes }: ExportView, format: Written): void {
    const cell = (figure: string, value: number, text: string): HTMLElement =>
      el('td', { 'data-figure': figure, 'data-value': String(value) }, text);
    const count = (figure: string, value: number): HTMLElement => cell(figure, value, number(value));
    const single = !holds(format, 'parts');
    const sum = (key: 'triangles' | 'vertices' | 'bytes'): number => parts.reduce((s, p) => s + p[key], 0);
    const rows = parts.map((p) =>
      el(
        'tr',
        { 'data-part': p.kind },
        el('th', { scope: 'row' }, tOf('part', p.kind)),
        count('triangles', p.triangles),
        count('vertices', p.vertices),
        single ? cell('draws', 0, '–') : count('draws', p.draws),
        cell('bytes', p.bytes, megabytes(p.bytes)),
      ),
    );
    const whole = el(
      'tr',
      { class: 'whole', 'data-part': 'all' },
      el('th', { scope: 'row' }, t('exported.all')),
      count('triangles', sum('triangles')),
      count('vertices', sum('vertices')),
      count('draws', draws),
      cell('bytes', sum('bytes'), megabytes(sum('bytes'))),
    );
    const head = (['part', 'triangles', 'vertices', 'draws', 'geometry'] as const).map((key) =>
      el('th', { scope: 'col', title: t(`exported.${key}.help`) }, t(`exported.${key}`)),
    );
    const file = line(isZipped(format) ? 'exported.zip' : 'exported.file', 'file', file_bytes);
    file.title = t('exported.file.help');
    this.table.replaceChildren(
      el('table', {}, el('thead', {}, el('tr', {}, ...head)), el('tbody', {}, ...rows, whole)),
      ...(textures > 0
        ? [line('exported.textures', 'textures', texture_bytes, ` (${number(textures)})`)]
        : []),
      file,
      el('p', { class: 'muted' }, t(holds(format, 'instances') ? 'exported.note.glb' : 'exported.note')),
    );
    this.element.dataset['seen'] = String(this.shown?.triangles ?? 0);
  }

  close(): void {
    if (this.closed) return;
    this.closed = true;
    clearTimeout(this.timer);
    this.element.remove();
    this.page.view.setStandIn(undefined);
    void this.page.session.engine.ask({ kind: 'unlook' }).catch(() => undefined);
    // Age and season go back to their panel.
    this.page.closed();
  }
}

function line(key: TextKey, figure: string, bytes: number, more = ''): HTMLElement {
  return el(
    'p',
    {},
    el('span', {}, t(key), ' '),
    el('b', { 'data-figure': figure, 'data-value': String(bytes) }, `${megabytes(bytes)} MB`),
    more,
  );
}

function select<T extends string>(
  text: TextKey,
  key: string,
  words: readonly (readonly [T, string])[],
  value: T,
  act: (word: T) => void,
): HTMLElement {
  const field = el('select', { 'data-exported': key, onchange: () => act(field.value as T) });
  for (const [word, label] of words) field.append(el('option', { value: word }, label));
  field.value = value;
  return el('label', {}, el('span', {}, t(text)), field);
}

function slider(
  text: TextKey,
  key: string,
  value: number,
  high: number,
  step: number,
  write: (x: number) => string,
  on: boolean,
  act: (x: number) => void,
): HTMLElement {
  const shown = el('output', {}, on ? write(value) : '–');
  const input = el('input', {
    type: 'range',
    min: '0',
    max: String(high),
    step: String(step),
    'data-exported': key,
    oninput: () => {
      shown.textContent = write(Number(input.value));
      act(Number(input.value));
    },
  });
  input.value = String(value);
  input.disabled = !on;
  return el('label', {}, el('span', {}, t(text)), input, shown);
}
