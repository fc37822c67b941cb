/** Light on the plants: they are shown in the colours of what they absorb, with a legend, under a sky and a sun of one's choice. */
import type { SentLight } from '../worker/protocol';
import type { Session } from '../worker/session';
import { number, t, type TextKey, warning } from '../text';
import { button, el } from '../page/ui';
import { Lit } from '../view/lit';
import type { PlantView } from '../view/view';
import type { LightAsk, LightView } from '../wire';

/** A change of the document or of a setting is followed when the hand rests so long, milliseconds. */
const REST_MS = 250;
/** Lines of light in each direction: a quick look, and what the command takes. */
const RAYS = { quick: 32_768, fine: 262_144 } as const;

type Source = 'sky' | 'sun' | 'place';
type Sky = NonNullable<LightAsk['sky']>;

export interface LightPage {
  readonly session: Session;
  readonly view: PlantView;
  /** Over which part of the page the settings lie. */
  readonly host: HTMLElement;
  closed(): void;
}

/** What was chosen last, as long as the page is there. */
const last = {
  source: 'sky' as Source,
  sky: 'overcast' as Sky,
  diffuse: 100,
  direct: 200,
  azimuth: 180,
  elevation: 45,
  latitude: 48.1,
  longitude: 11.6,
  date: '2026-06-21',
  /** The hour by the clock; a day has none. */
  hour: 12,
  whole: false,
  rays: 'quick' as keyof typeof RAYS,
  percent: false,
};

/** The settings as the core reads them. */
export function askOf(how: typeof last): LightAsk {
  const plain = { sky: null, diffuse: null, direct: null, sun: null, place: null, rays: RAYS[how.rays] };
  switch (how.source) {
    case 'sky':
      return { ...plain, sky: how.sky === 'clear' ? 'overcast' : how.sky, diffuse: how.diffuse };
    case 'sun': {
      const sun: [number, number] = [how.azimuth, how.elevation];
      return { ...plain, sky: how.sky, diffuse: how.diffuse, direct: how.direct, sun };
    }
    case 'place': {
      const [year = 0, month = 0, day = 0] = how.date.split('-').map(Number);
      const { latitude, longitude } = how;
      const place = { latitude, longitude, date: [year, month, day] as [number, number, number] };
      return { ...plain, place: { ...place, hour: how.whole ? null : how.hour } };
    }
  }
}

/** A figure with three digits or so. */
const digits = (x: number): string => new Intl.NumberFormat('en', { maximumSignificantDigits: 3 }).format(x);

export class LightPanel {
  private readonly element = el('section', {
    class: 'exportview lightview',
    id: 'b-lightview',
    role: 'region',
    'aria-label': t('light.title'),
  });
  private readonly rows = el('div', { class: 'settings' });
  private readonly figures = el('div', { class: 'figures', 'aria-live': 'polite' });
  private readonly working = el('p', { class: 'working', role: 'status' });
  private readonly legend = el('div', { class: 'lightlegend', id: 'b-light-legend', role: 'img' });
  private seen: LightView | undefined;
  private wanted = 0;
  private asking = false;
  private stopped = false;
  private timer = 0;
  private closed = false;

  constructor(private readonly page: LightPage) {
    const close = button('close', t('dialog.close'), () => this.close());
    close.id = 'b-lightview-close';
    const stop = el(
      'button',
      { type: 'button', class: 'link', id: 'b-light-stop', onclick: () => this.stop() },
      t('status.cancel'),
    );
    this.working.append(el('span', {}, t('light.working'), ' '), stop);
    this.element.append(
      el('header', {}, el('h2', {}, t('light.title')), close),
      el('p', { class: 'muted' }, t('light.hint')),
      this.rows,
      this.working,
      this.figures,
    );
    this.element.addEventListener('keydown', (e) => {
      if (e.key !== 'Escape') return;
      e.stopPropagation();
      this.close();
    });
    this.legend.hidden = true;
    page.host.append(this.element);
    page.view.element.parentElement!.append(this.legend);
    this.fill();
    this.ask();
    this.rows.querySelector('select')?.focus();
  }

  private fill(): void {
    const { source } = last;
    const skies: readonly (readonly [Sky, TextKey])[] = [
      ['overcast', 'light.sky.overcast'],
      ['uniform', 'light.sky.uniform'],
      // A clear sky is bright around its sun.
      ...(source === 'sun' ? ([['clear', 'light.sky.clear']] as const) : []),
    ];
    const when = <T>(is: boolean, ...rows: T[]): T[] => (is ? rows : []);
    const atPlace = source === 'place';
    this.rows.replaceChildren(
      select(
        'source',
        ['sky', 'sun', 'place'],
        (s) => t(`light.source.${s}`),
        source,
        (s) => {
          last.source = s;
          if (s === 'sun') last.sky = 'clear';
          this.fill();
          this.renew();
        },
      ),
      ...when(
        !atPlace,
        select(
          'sky',
          skies.map(([sky]) => sky),
          (sky) => t(`light.sky.${sky}`),
          skies.some(([sky]) => sky === last.sky) ? last.sky : 'overcast',
          (sky) => {
            last.sky = sky;
            this.renew();
          },
        ),
        this.field('diffuse', [0, 1000], 'W/m²'),
      ),
      ...when(
        source === 'sun',
        this.field('direct', [0, 1000], 'W/m²'),
        this.field('azimuth', [0, 360], '°'),
        this.field('elevation', [0, 90], '°'),
      ),
      ...when(
        atPlace,
        this.field('latitude', [-90, 90], '°'),
        this.field('longitude', [-180, 180], '°'),
        this.date(),
        this.day(),
        ...when(!last.whole, this.field('hour', [0, 24], 'h')),
      ),
      select(
        'rays',
        ['quick', 'fine'],
        (r) => t(`light.rays.${r}`),
        last.rays,
        (r) => {
          last.rays = r;
          this.renew();
        },
      ),
      select(
        'unit',
        ['absolute', 'percent'],
        (u) => t(`light.unit.${u}`),
        last.percent ? 'percent' : 'absolute',
        (u) => {
          last.percent = u === 'percent';
          if (this.seen) this.tell(this.seen);
        },
      ),
    );
  }

  /** A number of the settings. */
  private field(
    key: 'diffuse' | 'direct' | 'azimuth' | 'elevation' | 'latitude' | 'longitude' | 'hour',
    [low, high]: readonly [number, number],
    unit: string,
  ): HTMLElement {
    const input = el('input', {
      type: 'number',
      min: String(low),
      max: String(high),
      step: 'any',
      'data-light': key,
      onchange: () => {
        const value = Number(input.value);
        if (input.value === '' || !Number.isFinite(value)) input.value = String(last[key]);
        else {
          last[key] = value;
          this.renew();
        }
      },
    });
    input.value = String(last[key]);
    return el('label', {}, el('span', {}, t(`light.${key}`)), input, el('output', {}, unit));
  }

  private date(): HTMLElement {
    const input = el('input', {
      type: 'date',
      min: '1950-01-01',
      max: '2050-12-31',
      'data-light': 'date',
      onchange: () => {
        if (input.value === '') input.value = last.date;
        else {
          last.date = input.value;
          this.renew();
        }
      },
    });
    input.value = last.date;
    return el('label', {}, el('span', {}, t('light.date')), input);
  }

  private day(): HTMLElement {
    const words = ['hour', 'day'] as const;
    return select(
      'span',
      words,
      (w) => t(`light.span.${w}`),
      last.whole ? 'day' : 'hour',
      (w) => {
        last.whole = w === 'day';
        this.fill();
        this.renew();
      },
    );
  }

  /** The plants or a setting changed. */
  changed(): void {
    this.renew();
  }

  private renew(): void {
    clearTimeout(this.timer);
    this.element.dataset['wanted'] = String(this.wanted + 1);
    this.timer = window.setTimeout(() => this.ask(), REST_MS);
  }

  /** One computation at a time: another begins once the one under way has given way. */
  private ask(): void {
    this.wanted += 1;
    this.stopped = false;
    this.element.dataset['wanted'] = String(this.wanted);
    if (this.asking) this.page.session.engine.giveWay();
    else void this.compute();
  }

  private stop(): void {
    this.stopped = true;
    this.page.session.engine.giveWay();
  }

  private async compute(): Promise<void> {
    this.asking = true;
    const { session, view } = this.page;
    let done = 0;
    while (!this.closed && done !== this.wanted) {
      done = this.wanted;
      this.working.hidden = false;
      try {
        const sent = await session.engine.ask<SentLight>({ kind: 'light', asked: askOf(last) });
        if (this.closed || done !== this.wanted) continue;
        let triangles = 0;
        view.setStandIn((looks) => {
          const lit = new Lit(looks, sent.parts);
          triangles = lit.triangles;
          return lit;
        });
        this.element.dataset['seen'] = String(triangles);
        this.tell(sent.view);
      } catch (e) {
        if (this.closed || done !== this.wanted) continue;
        const why = this.stopped ? t('light.stopped') : (e as Error).message;
        this.show(undefined);
        this.figures.replaceChildren(el('p', { class: 'muted', id: 'b-light-why' }, why));
      }
      this.element.dataset['shown'] = String(done);
    }
    this.working.hidden = true;
    this.asking = false;
  }

  /** Shows the plants as they are where there is no light on them. */
  private show(seen: LightView | undefined): void {
    this.seen = seen;
    this.legend.hidden = seen === undefined;
    if (!seen) this.page.view.setStandIn(undefined);
  }

  private tell(seen: LightView): void {
    this.show(seen);
    const unit = `${seen.unit}/m²`;
    const share = (x: number): string => `${digits(100 * x)} %`;
    const light = (x: number): string => (last.percent ? share(x / seen.incoming) : `${digits(x)} ${unit}`);
    const rows: [TextKey, string, number | null][] = [
      ['light.incoming', `${digits(seen.incoming)} ${unit}`, seen.incoming],
      ['light.of.sun', light(seen.direct), seen.direct],
      ['light.of.sky', light(seen.diffuse), seen.diffuse],
      ['light.absorbed', `${digits(seen.absorbed)} ${seen.unit}`, seen.absorbed],
      ['light.leaves', `${digits(seen.leaf_absorbed)} ${seen.unit}`, seen.leaf_absorbed],
      ['light.share', seen.leaf_share === null ? '–' : share(seen.leaf_share), seen.leaf_share],
      ['light.area', `${digits(seen.leaf_area)} m²`, seen.leaf_area],
      ['light.sunlit', seen.sunlit === null ? '–' : share(seen.sunlit), seen.sunlit],
    ];
    const [azimuth, elevation] = seen.sun ?? [];
    const sun = seen.sun ? t('light.sun', { azimuth: digits(azimuth!), elevation: digits(elevation!) }) : '';
    const hours = seen.hours === null ? '' : t('light.hours', { hours: digits(seen.hours) });
    this.figures.replaceChildren(
      el(
        'table',
        {},
        el(
          'tbody',
          {},
          ...rows.map(([key, shown, value]) =>
            el(
              'tr',
              {},
              el('th', { scope: 'row' }, t(key)),
              el('td', { 'data-figure': key.split('.').at(-1)!, 'data-value': String(value) }, shown),
            ),
          ),
        ),
      ),
      ...[sun, hours, ...seen.warnings.map(warning)]
        .filter((line) => line !== '')
        .map((line) => el('p', { class: 'muted' }, line)),
      el('p', { class: 'muted' }, t('light.rays.told', { rays: number(RAYS[last.rays]) })),
    );
    this.drawLegend(seen, light);
  }

  private drawLegend(seen: LightView, light: (x: number) => string): void {
    const colours = seen.scale.map((c) => `rgb(${c.map((x) => Math.round(255 * x)).join(' ')})`);
    const bar = el('i', { class: 'ramp' });
    bar.style.background = `linear-gradient(to right, ${colours.join(', ')})`;
    const ends = [0, seen.brightest / 2, seen.brightest].map(light);
    this.legend.replaceChildren(
      el('b', {}, t('light.legend')),
      bar,
      el('div', { class: 'ends' }, ...ends.map((end) => el('span', {}, end))),
    );
    this.legend.dataset['brightest'] = String(seen.brightest);
    this.legend.setAttribute('aria-label', `${t('light.legend')}: ${ends[0]} – ${ends[2]}`);
  }

  close(): void {
    if (this.closed) return;
    this.closed = true;
    clearTimeout(this.timer);
    if (this.asking) this.page.session.engine.giveWay();
    this.element.remove();
    this.legend.remove();
    this.page.view.setStandIn(undefined);
    this.page.closed();
  }
}

function select<T extends string>(
  key: string,
  words: readonly T[],
  label: (word: T) => string,
  value: T,
  act: (word: T) => void,
): HTMLElement {
  const field = el('select', { 'data-light': key, onchange: () => act(field.value as T) });
  for (const word of words) field.append(el('option', { value: word }, label(word)));
  field.value = value;
  return el('label', {}, el('span', {}, t(`light.${key}` as TextKey)), field);
}
