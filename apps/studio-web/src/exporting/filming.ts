/** The dialogue for pictures and films, and their making: frame by frame, with progress, until it is done or stopped. */
import type { Session } from '../worker/session';
import { stageSeen } from '../shaping/staged';
import { t, type TextKey } from '../text';
import { dialog, download, el, note } from '../page/ui';
import { LONGEST } from '../view/shot';
import type { PlantView } from '../view/view';
import type { FilmFormat } from './film';
import type { Command } from '../wire';

const SHOTS = ['picture', 'turn', 'growth'] as const;
type Shot = (typeof SHOTS)[number];
const FORMATS: readonly (readonly [FilmFormat, string])[] = [
  ['webm', 'WebM'],
  ['mp4', 'MP4'],
  ['sheet', ''],
];
/** A film's longest side and length: encoders and memory end there. */
const FILM_LONGEST = 3840;
const LONGEST_S = 60;
/** A sheet of more frames than this is a film. */
const SHEET_FRAMES = 64;

interface Wanted {
  shot: Shot;
  format: FilmFormat;
  width: number;
  height: number;
  transparent: boolean;
  seconds: number;
  fps: number;
}

let last: Wanted = {
  shot: 'picture',
  format: 'webm',
  width: 1920,
  height: 1080,
  transparent: false,
  seconds: 6,
  fps: 25,
};

export interface FilmingPage {
  readonly session: Session;
  readonly view: PlantView;
  name(): string;
}

/** What a plant goes through: a command for each share of it, 0 to 1, and what it is called as a step. */
interface Course {
  readonly step: string;
  at(share: number): Command;
}

/** How the chosen plant grows or opens, if it does. */
export function courseOf({ plant, seen }: Pick<Session, 'plant' | 'seen'>): Course | undefined {
  if (!plant) return undefined;
  const { id } = plant;
  const [opening, wilting] = seen?.days ?? [6, 4];
  const day = (share: number): number => Math.round(share * (opening + wilting) * 100) / 100;
  if (plant.flower) return { step: 'day', at: (s) => ({ flower: [id, { 'set-day': day(s) }] }) };
  if (plant.tree) {
    const age = plant.tree.spec['age'];
    const most = typeof age === 'number' ? age : (seen?.item?.growth?.iterations ?? 40);
    return {
      step: 'tree',
      at: (s) => {
        const years = Math.max(1, Math.round(s * most));
        return {
          tree: [id, { 'set-field': ['/age', years >= most && typeof age !== 'number' ? null : years] }],
        };
      },
    };
  }
  if (plant.sketch && (seen?.item?.counts.flowers ?? 0) > 0)
    return { step: 'day', at: (s) => ({ sketch: [id, { 'set-day': day(s) }] }) };
  return undefined;
}

export function openFilming(page: FilmingPage): void {
  const wanted: Wanted = { ...last };
  const course = courseOf(page.session);
  if (wanted.shot === 'growth' && !course) wanted.shot = 'turn';
  const number = (
    text: TextKey,
    key: 'width' | 'height' | 'seconds' | 'fps',
    low: number,
    high: number,
  ): HTMLLabelElement => {
    const input = el('input', {
      type: 'number',
      class: 'f-number',
      min: String(low),
      max: String(high),
      required: '',
      'data-film': key,
      oninput: () => {
        if (Number.isFinite(input.valueAsNumber)) wanted[key] = input.valueAsNumber;
      },
    });
    input.value = String(wanted[key]);
    return el('label', { class: 'option' }, el('span', {}, t(text)), input);
  };
  const select = <T extends string>(
    text: TextKey,
    key: string,
    words: readonly (readonly [T, string])[],
    value: T,
    act: (w: T) => void,
  ): HTMLLabelElement => {
    const field = el('select', { 'data-film': key, onchange: () => act(field.value as T) });
    for (const [word, label] of words) field.append(el('option', { value: word }, label));
    field.value = value;
    return el('label', { class: 'option' }, el('span', {}, t(text)), field);
  };
  const shots = SHOTS.filter((s) => s !== 'growth' || course).map((s) => [s, t(`film.${s}`)] as const);
  const clear = el('input', {
    type: 'checkbox',
    'data-film': 'transparent',
    onchange: () => {
      wanted.transparent = clear.checked;
    },
  });
  clear.checked = wanted.transparent;
  clear.style.justifySelf = 'start';
  const formats = FORMATS.map(([f, label]) => [f, label || t('film.sheet')] as const);
  const rows = {
    shot: select('film.shot', 'shot', shots, wanted.shot, (w) => {
      wanted.shot = w;
      show();
    }),
    format: select('film.format', 'format', formats, wanted.format, (w) => {
      wanted.format = w;
      show();
    }),
    width: number('film.width', 'width', 16, LONGEST),
    height: number('film.height', 'height', 16, LONGEST),
    seconds: number('film.seconds', 'seconds', 1, LONGEST_S),
    fps: number('film.fps', 'fps', 1, 60),
    clear: el('label', { class: 'option' }, el('span', {}, t('film.transparent')), clear),
  };
  const show = (): void => {
    const film = wanted.shot !== 'picture';
    const sheet = film && wanted.format === 'sheet';
    rows.format.hidden = rows.seconds.hidden = rows.fps.hidden = !film;
    rows.clear.hidden = film && !sheet;
    for (const row of [rows.width, rows.height])
      row.querySelector('input')!.max = String(film ? FILM_LONGEST : LONGEST);
  };
  const go = el('button', { type: 'submit', class: 'primary', id: 'b-film-go' }, t('film.go'));
  const form = el(
    'form',
    {
      class: 'export',
      onsubmit: (e) => {
        e.preventDefault();
        last = { ...wanted };
        d.close();
        void make(page, wanted, course);
      },
    },
    ...Object.values(rows),
    el('p', { class: 'muted' }, t('film.note')),
    el('div', { class: 'row' }, el('span', { class: 'space' }), go),
  );
  const d = dialog(t('film.title'), form);
  show();
  rows.shot.querySelector('select')!.focus();
}

/** Shows how far it is; closing it stops the work. */
function progress(): { signal: AbortSignal; set(share: number): void; close(): void } {
  const stop = new AbortController();
  const bar = el('progress', { max: '1', 'aria-label': t('film.making') });
  bar.value = 0;
  const percent = el('span', { class: 'muted' }, '0 %');
  const cancel = el(
    'button',
    { type: 'button', class: 'primary', id: 'b-film-stop', onclick: () => d.close() },
    t('status.cancel'),
  );
  const d = dialog(
    t('film.making'),
    el(
      'div',
      { class: 'export' },
      bar,
      el('div', { class: 'row' }, percent, el('span', { class: 'space' }), cancel),
    ),
  );
  d.classList.add('filming');
  let done = false;
  d.addEventListener('close', () => {
    if (!done) stop.abort();
  });
  return {
    signal: stop.signal,
    set: (share) => {
      bar.value = share;
      percent.textContent = `${Math.round(100 * share)} %`;
    },
    close: () => {
      done = true;
      d.close();
    },
  };
}

async function make(page: FilmingPage, wanted: Wanted, course: Course | undefined): Promise<void> {
  const bar = progress();
  try {
    const [name, blob] =
      wanted.shot === 'picture' ? await picture(page, wanted, bar) : await film(page, wanted, course, bar);
    bar.signal.throwIfAborted();
    download(name, blob, blob.type);
    note(t('note.exported', { name }));
  } catch (e) {
    if (bar.signal.aborted) note(t('film.stopped'));
    else {
      const { message } = e as Error;
      note(t('note.refused', { why: message === 'no encoder' ? t('film.noencoder') : message }), 'bad');
    }
  } finally {
    bar.close();
  }
}

/** How far the work is, and whether it is to go on. */
interface Bar {
  signal: AbortSignal;
  set(share: number): void;
}

async function picture({ view, name }: FilmingPage, wanted: Wanted, bar: Bar): Promise<[string, Blob]> {
  const { pngOf } = await import('./film');
  const { width, height, transparent } = wanted;
  const pixels = await view.shot({ width, height, transparent }, 0, (share) => {
    bar.signal.throwIfAborted();
    bar.set(share);
  });
  return [`${name()}.png`, await pngOf(pixels, width, height)];
}

async function film(
  page: FilmingPage,
  wanted: Wanted,
  course: Course | undefined,
  bar: Bar,
): Promise<[string, Blob]> {
  const { recorder, sheetShape } = await import('./film');
  const { format, shot } = wanted;
  const sheet = format === 'sheet';
  const even = (n: number): number => Math.max(16, n - (n % 2));
  const [width, height] = sheet ? [wanted.width, wanted.height] : [even(wanted.width), even(wanted.height)];
  const frames = Math.max(
    2,
    Math.min(Math.round(wanted.seconds * wanted.fps), sheet ? SHEET_FRAMES : Infinity),
  );
  const [columns, rows] = sheetShape(frames);
  if (sheet && Math.max(columns * width, rows * height) > 2 * LONGEST) throw new Error(t('film.large'));
  const spec = { format, width, height, fps: wanted.fps, frames };
  const tape = await recorder(spec);
  const growing = shot === 'growth' ? course : undefined;
  const size = { width, height, transparent: sheet && wanted.transparent };
  const { view } = page;
  const front = view.isFront;
  // What is seen from the front alone does not turn.
  if (shot === 'turn') view.leaveFront();
  try {
    const run = async (): Promise<void> => {
      let before = '';
      let pixels: Uint8ClampedArray<ArrayBuffer> | undefined;
      for (let i = 0; i < frames; i += 1) {
        bar.signal.throwIfAborted();
        if (growing) {
          const command = growing.at(i / (frames - 1));
          const now = JSON.stringify(command);
          if (now !== before || !pixels) {
            await stageSeen(page.session, command, bar.signal);
            pixels = await view.shot(size);
          }
          before = now;
        } else pixels = await view.shot(size, (i / frames) * 2 * Math.PI);
        await tape.add(pixels, i);
        bar.set((i + 1) / (frames + 1));
        // The page answers between frames: it may be told to stop.
        await new Promise((resolve) => {
          setTimeout(resolve);
        });
      }
    };
    if (growing) await throughGrowth(page, growing, bar.signal, run);
    else await run();
    const blob = await tape.finish();
    const ending = sheet ? `-${columns}x${rows}.png` : `.${format}`;
    return [`${page.name()}-${shot}${ending}`, blob];
  } catch (e) {
    tape.cancel();
    throw e;
  } finally {
    view.setFront(front);
  }
}

/**
 * A view that was composed by hand stays as it is; else the plant as it is at its end gives the size. Afterwards it is as it was,
 * and no step of undo is left.
 */
async function throughGrowth(
  page: FilmingPage,
  course: Course,
  signal: AbortSignal,
  run: () => Promise<void>,
): Promise<void> {
  const { session, view } = page;
  await session.engine.ask({ kind: 'begin', name: course.step });
  try {
    if (view.isComposed) view.hold(true);
    await stageSeen(page.session, course.at(1), signal);
    view.hold(true);
    await run();
  } finally {
    await session.engine.ask({ kind: 'abandon' });
    view.hold(false);
  }
}
