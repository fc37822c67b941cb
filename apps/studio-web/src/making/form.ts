/**
 * Forms made of JSON Schemas: a row for each field, with slider, number, choice, colour or switch. The schemas come from
 * the core; nothing here knows what a field does.
 */
import type { Json } from '../wire';
import type { Schema } from './schema';
import { hexOfLinear, linearOf } from '../drawing/colours';
import { fieldName, helpOf, t, unitOf, wordOf } from '../text';
import { el, refill } from '../page/ui';

export type Fields = { [key: string]: Json };

export interface FormEvents {
  /** The value of a field, named by its JSON pointer. */
  set(path: string, value: Json): void;
  /** As `set`, while a slider is dragged; `done` ends the drag. */
  stage(path: string, value: Json): void;
  done(): void;
}

/** A range that no slider can show is shown around the value. */
const WIDE = 300;
const STEPS = 200;

/** A schema without references and without the `null` of what may be left out. */
function plain(schema: Schema, root: Schema): Schema & { nullable?: boolean } {
  let s: Schema & { nullable?: boolean } = schema;
  for (let depth = 0; s.$ref !== undefined && depth < 8; depth += 1) {
    const { $ref, ...own } = s;
    const target = root.$defs?.[$ref.split('/').at(-1) ?? ''] ?? {};
    // A variant has its tag beside the reference: fields of both hold.
    s = { ...target, ...own, properties: { ...target.properties, ...own.properties } };
  }
  if (Array.isArray(s.type)) {
    const type = s.type.find((x) => x !== 'null');
    s = { ...s, type: type ?? 'null', nullable: s.type.includes('null') };
  }
  const inner = s.anyOf?.filter((x) => x.type !== 'null');
  if (s.anyOf && inner?.length === 1) {
    const { anyOf, ...own } = s;
    s = { ...plain(inner[0]!, root), ...own, nullable: inner.length < anyOf.length };
  }
  return s;
}

const isFields = (value: Json | undefined): value is Fields =>
  typeof value === 'object' && value !== null && !Array.isArray(value);
const words = (s: Schema): string[] =>
  s.enum?.map(String) ??
  (s.oneOf?.every((o) => o.const !== undefined) ? s.oneOf.map((o) => String(o.const)) : []);

/** The tag that tells variants apart, if the schema has variants. */
function tagOf(s: Schema): string | undefined {
  const first = s.oneOf?.[0]?.properties ?? {};
  return Object.keys(first).find((k) => first[k]?.const !== undefined);
}

/** The schema's own words, in the person's language. */
const tip = (s: Schema): string => helpOf(s['x-help'], s.description);

const round = (x: number): number => Number(x.toPrecision(4));

/** The value at a JSON pointer. */
function valueAt(fields: Json | undefined, path: string): Json | undefined {
  let at = fields;
  for (const key of path.split('/').slice(1))
    at = isFields(at) ? at[key] : Array.isArray(at) ? at[Number(key)] : undefined;
  return at;
}

/** Brings a value back to what it was at first. */
export function resetButton(name: string, act: () => void): HTMLElement {
  const label = t('form.reset', { name });
  const onclick = (e: Event): void => {
    e.preventDefault();
    act();
  };
  return el('button', { type: 'button', class: 'f-reset', title: label, 'aria-label': label, onclick }, '↺');
}

/** Says in the place of a value that not all have the same. */
export function showMixed(field: HTMLInputElement | HTMLSelectElement): void {
  field.closest('.f-row')?.classList.add('mixed');
  if (field instanceof HTMLSelectElement) {
    field.prepend(el('option', { value: 'mixed', disabled: '', hidden: '' }, t('mixed')));
    field.value = 'mixed';
  } else if (field.type === 'checkbox') field.indeterminate = true;
  else if (field.type === 'color') field.classList.add('unset');
  else if (field.type !== 'range') [field.value, field.placeholder] = ['', t('mixed')];
}

/** A form with fewer rows is seen as a whole. */
const FEW = 8;

export class Form {
  readonly element = el('div', { class: 'form' });
  private readonly rows = el('div', { class: 'form' });
  private readonly search = this.searchRow();
  private open = new Set<string>();
  private query = '';
  private values: Fields = {};
  /** Pointers of what is not the same in all that are changed. */
  private mixed: readonly string[] = [];
  /** What matters first, by pointers, and the order of the rest. */
  private order: { main: readonly string[]; rest: readonly string[] } = { main: [], rest: [] };

  /** `origin`: the values to which fields can be reset; of those that it has not, the schema's. */
  constructor(
    private readonly root: Schema,
    private readonly events: FormEvents,
    private readonly hidden: ReadonlySet<string> = new Set(),
    private readonly origin: () => Fields | undefined = () => undefined,
  ) {
    this.element.append(this.rows);
  }

  /** Shows these values; what has the focus keeps it. `main`: rows that come before the others, which are folded. */
  show(
    values: Fields,
    main: readonly string[] = [],
    rest: readonly string[] = [],
    mixed: readonly string[] = [],
  ): void {
    [this.values, this.order, this.mixed] = [values, { main, rest }, mixed];
    refill(this.rows, 'data-path', () => {
      this.rows.replaceChildren(...this.shown());
      this.markMixed();
    });
    if (this.rows.querySelectorAll('.f-row').length > FEW && !this.search.isConnected)
      this.element.prepend(this.search);
  }

  /** Fields of which not all have the same say so, in the place of a value. */
  private markMixed(): void {
    for (const field of this.rows.querySelectorAll<HTMLInputElement | HTMLSelectElement>(
      'input[data-path], select[data-path]',
    )) {
      const path = field.dataset['path']!;
      if (this.mixed.some((m) => m === path || m.startsWith(`${path}/`) || path.startsWith(`${m}/`)))
        showMixed(field);
    }
  }

  private shown(): HTMLElement[] {
    const properties = this.root.properties ?? {};
    const { main, rest } = this.order;
    const names = [...rest, ...Object.keys(properties).filter((k) => !rest.includes(k))];
    const all = el(
      'div',
      { class: 'form' },
      ...names.flatMap((name) =>
        this.hidden.has(name) || !properties[name]
          ? []
          : this.field(name, properties[name], this.values[name], `/${name}`),
      ),
    );
    const rows = [...all.querySelectorAll<HTMLElement>('.f-row')];
    // A row that leaves its group says of what it is.
    const lifted = (row: HTMLElement): HTMLElement => {
      const group = row.closest('details')?.querySelector('summary')?.textContent;
      if (group) row.firstElementChild?.prepend(`${group} · `);
      return row;
    };
    if (this.query !== '') {
      const found = rows.filter((row) =>
        (row.firstElementChild?.textContent ?? '').toLowerCase().includes(this.query),
      );
      return found.length > 0 ? found.map(lifted) : [el('p', { class: 'muted' }, t('form.none'))];
    }
    const first = main.flatMap(
      (path) =>
        rows.find((row) =>
          [...row.querySelectorAll('[data-path]')].some((x) => x.matches(`[data-path="${path}"]`)),
        ) ?? [],
    );
    if (first.length === 0) return [...all.children] as HTMLElement[];
    const top = el('div', { class: 'form' }, ...first.map(lifted));
    return [top, this.fold('', t('form.all'), '', [...all.children] as HTMLElement[])];
  }

  private searchRow(): HTMLElement {
    const box = el('input', {
      type: 'search',
      class: 'field',
      placeholder: t('form.search'),
      'aria-label': t('form.search'),
      oninput: () => {
        this.query = box.value.trim().toLowerCase();
        this.rows.replaceChildren(...this.shown());
        this.markMixed();
      },
    });
    return el('div', { class: 'f-search' }, box);
  }

  /** Rows that are folded until a person opens them, which is remembered under a path. */
  private fold(path: string, title: string, help: string, content: HTMLElement[]): HTMLDetailsElement {
    const details = el(
      'details',
      {
        class: 'f-group',
        ontoggle: () => {
          if (details.open) this.open.add(path);
          else this.open.delete(path);
        },
      },
      el('summary', { title: help, 'data-path': path }, title),
      ...content,
    );
    details.open = this.open.has(path);
    return details;
  }

  private field(name: string, schema: Schema, value: Json | undefined, path: string): HTMLElement[] {
    const s = plain(schema, this.root);
    const now = value === undefined ? (s.default ?? null) : value;
    const choices = words(s);
    if (choices.length > 0) return [this.choice(name, s, choices, now, path)];
    const tag = tagOf(s);
    if (tag !== undefined) return isFields(now) ? [this.variants(name, s, tag, now, path)] : [];
    if (s.type === 'boolean') return [this.check(name, s, now === true, path)];
    if (s.type === 'number' || s.type === 'integer')
      return [this.number(name, s, typeof now === 'number' ? now : null, path)];
    if (s['x-unit'] === 'colour') return [this.colour(name, s, typeof now === 'string' ? now : null, path)];
    if (s['x-unit'] === 'linear-colour' && Array.isArray(now))
      return [this.linear(name, s, now as number[], path)];
    if (s.type === 'array' && Array.isArray(now) && now.length > 0 && now.every(isFields))
      return [this.list(name, s, now, path)];
    if (
      s.type === 'array' &&
      Array.isArray(now) &&
      now.length === 3 &&
      now.every((x) => typeof x === 'number')
    )
      return [this.triple(name, s, now as number[], path)];
    if (s.type === 'object' && isFields(now)) return [this.group(name, s, now, path)];
    return [];
  }

  /** `path`: of a value that can be reset. */
  private row(name: string, s: Schema, path: string | undefined, ...content: HTMLElement[]): HTMLElement {
    const unit = unitOf(s['x-unit'] ?? '');
    const label = fieldName(name, s['x-help']) + (unit ? ` (${unit})` : '');
    const reset = path === undefined ? [] : this.resetOf(name, s, path);
    return el('label', { class: 'f-row', title: tip(s) }, el('span', {}, label, ...reset), ...content);
  }

  /** A button where the value is another than it was at first. */
  private resetOf(name: string, s: Schema, path: string): HTMLElement[] {
    const first = valueAt(this.origin(), path) ?? s.default;
    const now = valueAt(this.values, path);
    if (first === undefined || now === undefined || JSON.stringify(first) === JSON.stringify(now)) return [];
    return [resetButton(fieldName(name, s['x-help']), () => this.events.set(path, first))];
  }

  private number(
    name: string,
    s: Schema & { nullable?: boolean },
    value: number | null,
    path: string,
  ): HTMLElement {
    const [least, most] = [s.minimum ?? 0, s.maximum ?? Infinity];
    const at = value ?? (typeof s.default === 'number' ? s.default : Math.min(Math.max(1, least), most));
    const whole = s.type === 'integer';
    const wide = most - least > WIDE || (least > 0 && most > WIDE * least);
    // Far apart: a slider of ratios around the value.
    const ratio = wide && at > 0;
    const [low, high] = ratio
      ? [Math.max(least, at / 8), Math.min(most, at * 8)]
      : [least, wide ? Math.min(most, Math.max(10, 4 * at)) : most];
    const from = (share: number): number => {
      const x = ratio ? low * (high / low) ** share : low + share * (high - low);
      return whole ? Math.round(x) : round(x);
    };
    const to = (x: number): number =>
      high <= low ? 0 : ratio ? Math.log(x / low) / Math.log(high / low) : (x - low) / (high - low);
    const box = el('input', {
      type: 'number',
      class: 'f-number',
      min: String(least),
      ...(most < Infinity ? { max: String(most) } : {}),
      step: whole ? '1' : 'any',
      'data-path': path,
      'aria-label': fieldName(name, s['x-help']),
      onchange: () => {
        if (box.value === '' && s.nullable) this.events.set(path, null);
        else if (Number.isFinite(box.valueAsNumber))
          this.events.set(path, whole ? Math.round(box.valueAsNumber) : box.valueAsNumber);
      },
    });
    box.value = value === null ? '' : String(round(value));
    if (s.nullable) box.placeholder = t('form.auto');
    const slider = el('input', {
      type: 'range',
      min: '0',
      max: String(whole && !ratio ? Math.max(1, Math.min(STEPS, high - low)) : STEPS),
      step: '1',
      'data-path': `${path}#`,
      'aria-label': fieldName(name, s['x-help']),
      oninput: () => {
        const x = from(Number(slider.value) / Number(slider.max));
        box.value = String(x);
        this.events.stage(path, x);
      },
      onchange: () => this.events.done(),
    });
    slider.value = String(Math.round(to(Math.min(high, Math.max(low, at))) * Number(slider.max)));
    return this.row(name, s, path, slider, box);
  }

  private check(name: string, s: Schema, on: boolean, path: string): HTMLElement {
    const box = el('input', {
      type: 'checkbox',
      'data-path': path,
      onchange: () => this.events.set(path, box.checked),
    });
    box.checked = on;
    return this.row(name, s, path, box);
  }

  private colour(
    name: string,
    s: Schema & { nullable?: boolean },
    value: string | null,
    path: string,
  ): HTMLElement {
    const box = el('input', {
      type: 'color',
      'data-path': path,
      onchange: () => this.events.set(path, box.value),
    });
    box.value = value ?? '#808080';
    if (!s.nullable) return this.row(name, s, path, box);
    const use = el('input', {
      type: 'checkbox',
      'aria-label': fieldName(name, s['x-help']),
      onchange: () => this.events.set(path, use.checked ? box.value : null),
    });
    use.checked = value !== null;
    box.disabled = value === null;
    return this.row(name, s, path, el('span', { class: 'f-pair' }, use, box));
  }

  /** Shares of red, green and blue light, as the colour that they look like. */
  private linear(name: string, s: Schema, now: number[], path: string): HTMLElement {
    const box = el('input', {
      type: 'color',
      'data-path': path,
      onchange: () => this.events.set(path, linearOf(box.value)),
    });
    box.value = hexOfLinear(now);
    return this.row(name, s, path, box);
  }

  /** Rows of the same kind: each folded, with a copy added at the end or one taken away. */
  private list(name: string, s: Schema, now: Fields[], path: string): HTMLElement {
    const item = plain(typeof s.items === 'object' ? s.items : {}, this.root);
    const rows = now.map((fields, k) => {
      const title = t('form.row', { name: fieldName(name), row: k + 1 });
      const drop = el(
        'button',
        {
          type: 'button',
          class: 'chip',
          onclick: () =>
            this.events.set(
              path,
              now.filter((_, other) => other !== k),
            ),
        },
        t('form.row.drop'),
      );
      const one = this.group(name, item, fields, `${path}/${k}`, now.length > 1 ? [drop] : []);
      one.querySelector('summary')!.textContent = title;
      return one;
    });
    const add = el(
      'button',
      {
        type: 'button',
        class: 'chip',
        'data-path': `${path}+`,
        onclick: () => this.events.set(path, [...now, now.at(-1)!]),
      },
      t('form.row.add'),
    );
    return this.fold(path, fieldName(name), tip(s), [...rows, add]);
  }

  private choice(
    name: string,
    s: Schema & { nullable?: boolean },
    choices: string[],
    now: Json,
    path: string,
  ): HTMLElement {
    const select = el('select', {
      'data-path': path,
      onchange: () => this.events.set(path, select.value === '' ? null : select.value),
    });
    if (s.nullable) select.append(el('option', { value: '' }, t('form.auto')));
    const meant = (word: string): string => tip(s.oneOf?.find((o) => o.const === word) ?? {});
    for (const word of choices)
      select.append(el('option', { value: word, title: meant(word) }, wordOf(word)));
    select.value = now === null ? '' : String(now);
    return this.row(name, s, path, select);
  }

  private triple(name: string, s: Schema, now: number[], path: string): HTMLElement {
    const boxes = now.map((x, i) => {
      const box = el('input', {
        type: 'number',
        step: 'any',
        class: 'f-number',
        'data-path': `${path}/${i}`,
        'aria-label': `${fieldName(name)} ${'xyz'[i]}`,
        onchange: () => {
          if (Number.isFinite(box.valueAsNumber))
            this.events.set(
              path,
              now.map((y, k) => (k === i ? box.valueAsNumber : y)),
            );
        },
      });
      box.value = String(round(x));
      return box;
    });
    return this.row(name, s, path, el('span', { class: 'f-triple' }, ...boxes));
  }

  private group(
    name: string,
    s: Schema,
    now: Fields,
    path: string,
    extra: HTMLElement[] = [],
    skip = '',
  ): HTMLElement {
    const properties = s.properties ?? {};
    const rows = Object.keys(properties).flatMap((key) =>
      key === skip ? [] : this.field(key, properties[key]!, now[key], `${path}/${key}`),
    );
    return this.fold(path, fieldName(name), tip(s), [...extra, ...rows]);
  }

  /** One of several forms, told apart by a tag. Forms whose fields have no sensible start are not offered. */
  private variants(name: string, s: Schema, tag: string, now: Fields, path: string): HTMLElement {
    const all = (s.oneOf ?? []).map((o) => plain(o, this.root));
    const wordFor = (o: Schema): string => String(o.properties?.[tag]?.const ?? '');
    const current = all.find((o) => wordFor(o) === now[tag]);
    if (!current) return el('span', { hidden: '' });
    const start = (o: Schema): Fields | undefined => {
      const fields: Fields = { [tag]: wordFor(o) };
      for (const key of o.required ?? []) {
        if (key === tag) continue;
        const f = plain(o.properties?.[key] ?? {}, this.root);
        const same = now[key];
        if (same !== undefined) fields[key] = same;
        else if (f.default !== undefined) fields[key] = f.default;
        else if (f.type === 'number' || f.type === 'integer')
          fields[key] = Math.min(Math.max(1, f.minimum ?? 0), f.maximum ?? 1);
        else return undefined;
      }
      return fields;
    };
    const select = el('select', {
      'data-path': `${path}/${tag}`,
      onchange: () => {
        const to = all.find((o) => wordFor(o) === select.value);
        const fields = to && start(to);
        if (fields) this.events.set(path, fields);
      },
    });
    for (const o of all)
      if (o === current || start(o))
        select.append(el('option', { value: wordFor(o), title: tip(o) }, wordOf(wordFor(o))));
    select.value = wordFor(current);
    const text = (s: Schema): Schema =>
      s.description === undefined ? {} : { description: s.description, 'x-help': s['x-help'] ?? '' };
    const kind = this.row(tag, text(current), undefined, select);
    return this.group(name, { ...current, ...text(s) }, now, path, [kind], tag);
  }
}
