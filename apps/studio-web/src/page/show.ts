/** Shows in the bars and over both sides what the document and its plant are now. */
import type { Balls } from '../shaping/balls';
import type { Parts } from './bars';
import { LOOKS } from '../drawing/classes';
import { keyOf } from './commands';
import { dot } from '../drawing/correct';
import type { Standing } from '../keeping/keeper';
import type { MakerPanel } from '../making/makers';
import type { SceneList } from '../placing/scene';
import type { Readings } from '../drawing/readings';
import type { Session } from '../worker/session';
import type { Shaping } from '../shaping/shaping';
import type { Sheet } from '../sheet/sheet';
import { statsTable } from '../looking/stats';
import { hasText, number, t, tOf, warning } from '../text';
import type { Theme } from './theme';
import { el, icon, popover, relabel } from './ui';
import type { PlantView } from '../view/view';
import type { ViewModes } from '../looking/viewmode';
import type { Door } from '../vr/door';
import type { DocumentState, StrokeClass, WarningView } from '../wire';

/** A flash of work shorter than this only disturbs. */
const MOMENT_MS = 200;
/** Between what lies over the view and its edge, pixels. */
const EDGE = 10;
/** The day to which a drawn flower opens when it is told to. */
const OPEN_DAY = 6;

export interface Shown {
  readonly session: Session;
  readonly sheet: Sheet;
  readonly panel: MakerPanel;
  readonly list: SceneList;
  readonly shaping: Shaping | undefined;
  readonly balls: Balls | undefined;
  readonly modes: ViewModes;
  readonly door: Door;
  readonly theme: Theme;
  readonly readings: Readings;
}

export class Show {
  private statsOn = false;
  /** What is said of the file, and what is true of the saving. */
  private written = '';
  private stands: Standing = 'empty';
  private busyTimer = 0;

  constructor(
    private readonly shown: Shown,
    /** Others after the page was made anew. */
    public parts: Parts,
  ) {}

  toggleStats(): void {
    this.statsOn = !this.statsOn;
    this.switches();
    this.view();
  }

  // The document -------------------------------------------------------------------------------------------------

  document(): void {
    const { session, sheet } = this.shown;
    const { state, plant, drawn } = session;
    const { parts } = this;
    if (!state) return;
    this.title();
    this.steps(state);
    const seed = plant ? ` · ${t('dice.seed', { seed: plant.seed })}` : '';
    relabel(parts.buttons.get('dice')!, t('dice') + seed, keyOf('dice'));
    const { dataset } = document.body;
    dataset['strokes'] = String(drawn?.strokes.length ?? 0);
    dataset['plants'] = String(state.plants.length);
    dataset['current'] = plant?.maker ?? '';
    // What is wanted; `revision` is what is seen.
    dataset['wanted'] = String(state.revision);
    parts.sheetTools.hidden = sheet.element.hidden = parts.legend.hidden = !drawn;
    parts.maker.hidden = !plant || drawn !== null;
    parts.noPlant.hidden = plant !== undefined;
    parts.buttons.get('settings')!.disabled = !drawn;
    parts.buttons.get('materials')!.disabled = !plant;
    dataset['layers'] = (drawn?.layers ?? [])
      .map((l) => `${l.name}${l.hidden ? ' hidden' : ''}${l.locked ? ' locked' : ''}`)
      .join(', ');
    this.pieces(state);
    this.switches();
    this.model(undefined);
    this.emptySheet();
  }

  private title(): void {
    const { title } = this.shown.session;
    if (document.activeElement !== this.parts.name) this.parts.name.value = title;
    document.title = `${title} · ${t('app.title')}`;
  }

  /** What would be undone and done again: a step by its word, or an edit by hand by its own. */
  private steps(state: DocumentState): void {
    for (const which of ['undo', 'redo'] as const) {
      const step = state[which];
      const b = this.parts.buttons.get(which)!;
      b.disabled = step === null;
      const label =
        step === null
          ? t(which)
          : t(`${which}.step`, { step: tOf(hasText(`step.${step}`) ? 'step' : 'edit', step) });
      relabel(b, label, keyOf(which));
    }
  }

  /** What has a part of the page to itself. */
  private pieces(state: DocumentState): void {
    const { session, list, shaping, balls } = this.shown;
    // It says which plants are chosen, which the panel changes.
    list.show(state, session.scene);
    shaping?.show(session.plant, session.shapeable);
    balls?.show(session.plant);
    this.shaping();
    this.bloom();
  }

  /** The left side of the plants that are chosen. */
  maker(): void {
    const { session, panel, list } = this.shown;
    const { state } = session;
    if (state) panel.show(session.plant, state, session.seen, list.chosen);
  }

  switches(): void {
    const { session, sheet, modes } = this.shown;
    const { buttons, stats } = this.parts;
    const { plant } = session;
    const locked = plant?.locked ?? false;
    this.headset();
    this.press('wire', modes.mode === 'wire');
    this.press('skeleton', modes.mode === 'skeleton');
    this.press('stats', this.statsOn);
    this.press('mirror', sheet.symmetry?.kind === 'mirror');
    this.press('turns', sheet.symmetry?.kind === 'turns');
    const { symmetry } = sheet;
    document.body.dataset['turns'] =
      symmetry?.kind === 'turns' ? `${symmetry.count} ${symmetry.about.map(Math.round)}` : '';
    this.press('lock', locked);
    buttons
      .get('lock')!
      .querySelector('svg')!
      .replaceWith(icon(locked ? 'lock' : 'unlock'));
    stats.hidden = !this.statsOn;
    for (const name of ['dice', 'grid']) buttons.get(name)!.disabled = locked || !plant;
  }

  press(button: string, on: boolean): void {
    this.parts.buttons.get(button)?.setAttribute('aria-pressed', String(on));
  }

  /** The tools of the view: whether one is held, whether one could be. */
  shaping(): void {
    const { shaping, balls, session } = this.shown;
    if (!shaping || !balls) return;
    this.press('shape', shaping.isOn || balls.isOn);
    this.parts.buttons.get('shape')!.disabled = !shaping.isPossible && !shaping.isOn && !session.plant?.leaf;
    document.body.dataset['shape'] = shaping.word ?? '';
    this.shown.door.renewed();
  }

  /** The way into a headset is shown where there is one. */
  headset(): void {
    const { modes } = this.shown.door;
    this.parts.buttons.get('headset')!.hidden = !modes.includes('immersive-vr');
    document.body.dataset['headsets'] = modes.join(' ');
  }

  /** What the pen was told to draw. */
  meant(kind: StrokeClass | null): void {
    const { meant } = this.parts;
    meant.hidden = kind === null;
    document.body.dataset['meant'] = kind ?? '';
    if (kind === null) return;
    meant.replaceChildren(
      dot(LOOKS[kind], this.shown.theme.isDark),
      t('meant', { what: tOf('class', kind) }),
      icon('close'),
    );
    meant.title = t('meant.hint');
  }

  emptySheet(): void {
    this.parts.empty.hidden = !this.shown.sheet.isEmpty || !this.shown.session.drawn;
  }

  /** How large the plant is, in metres, beside its foot where there is room. */
  extent(seen: ReturnType<PlantView['extent']>): void {
    const { extent } = this.parts;
    extent.hidden = seen === undefined;
    if (!seen) return;
    const metres = (m: number): string => m.toPrecision(m < 1 ? 2 : 3);
    extent.textContent = t('view.extent', { high: metres(seen.high), wide: metres(seen.wide) });
    const { clientWidth = 0, clientHeight = 0 } = extent.parentElement ?? {};
    const [right, low] = [clientWidth - extent.offsetWidth - EDGE, clientHeight - extent.offsetHeight - EDGE];
    extent.style.left = `${Math.max(EDGE, Math.min(seen.x + EDGE, right))}px`;
    extent.style.top = `${Math.max(EDGE, Math.min(seen.y - extent.offsetHeight, low))}px`;
  }

  /** The name of the model that is viewed instead of the plant, if one is. */
  model(name: string | undefined): void {
    const { model, modelName } = this.parts;
    model.hidden = name === undefined;
    modelName.textContent = name === undefined ? '' : t('view.model', { name });
  }

  // The plant ----------------------------------------------------------------------------------------------------

  view(): void {
    const { session, sheet, theme } = this.shown;
    const { seen, state } = session;
    const { parts } = this;
    this.counts();
    if (this.statsOn) parts.stats.replaceChildren(statsTable(session.plant, seen));
    parts.grows.hidden = !session.isBare;
    this.title();
    if (state) this.pieces(state);
    const organs = [...new Set(session.organs.values())];
    parts.legend.replaceChildren(
      ...organs.map((o) => el('span', { role: 'listitem' }, dot(o, theme.isDark), tOf('organ', o))),
    );
    const { dataset } = document.body;
    const counts = seen?.item?.counts;
    dataset['triangles'] = String(counts?.triangles ?? 0);
    dataset['flowers'] = String(counts?.flowers ?? 0);
    dataset['parts'] = String(seen?.parts.length ?? 0);
    dataset['materials'] = (seen?.materials ?? []).map((m) => m.name).join(' ');
    dataset['meshes'] = String(new Set(session.scene?.plants.map((p) => p.mesh)).size);
    dataset['digest'] = seen?.item?.digest ?? '';
    dataset['revision'] = String(session.scene?.revision ?? 0);
    sheet.reselect();
  }

  /** Large trees are seen, much coarser, before they are whole. */
  coarse(): void {
    this.parts.grows.hidden = true;
    document.body.dataset['coarse'] = String(Number(document.body.dataset['coarse'] ?? 0) + 1);
  }

  /** The figures at the foot of the page. */
  private counts(): void {
    const { session } = this.shown;
    const item = session.seen?.item;
    const texts: string[] = [];
    const strokes = session.drawn?.strokes.length;
    if (strokes) texts.push(t('status.strokes', { count: number(strokes) }));
    if (item) {
      for (const kind of ['flowers', 'petals', 'leaves', 'branches', 'triangles'] as const) {
        const count = item.counts[kind];
        if (count) texts.push(t(`status.${kind}`, { count: number(count) }));
      }
      texts.push(t('status.time', { ms: number(Math.max(0, Math.round(item.timings_ms.total))) }));
    }
    this.parts.counts.textContent = texts.join('  ·  ');
    this.warnings(session.seen?.warnings ?? []);
  }

  /** How many warnings the plant has; a click shows what they say. */
  private warnings(all: readonly WarningView[]): void {
    const { warned } = this.parts;
    warned.hidden = all.length === 0;
    warned.textContent = t('status.warnings', { count: number(all.length) });
    relabel(warned, t('warnings.title', { count: number(all.length) }));
  }

  openWarnings(): void {
    const { seen } = this.shown.session;
    const rows = (seen?.warnings ?? []).map((w) => el('li', { 'data-warning': w.code }, warning(w)));
    if (rows.length === 0) return;
    const title = t('warnings.title', { count: number(rows.length) });
    const list = el('div', { class: 'warnings', tabindex: '-1' }, el('b', {}, title), el('ul', {}, ...rows));
    popover(this.parts.warned, list, title);
  }

  /** What a drawing is read as; of a drawn flower that opens, its day, and a button to play it. */
  private bloom(): void {
    const { session, panel } = this.shown;
    const { drawn } = session;
    const box = this.parts.bloom;
    const flowers = (session.seen?.item?.counts.flowers ?? 0) > 0;
    const { readings } = this.shown;
    readings.show();
    const opening = drawn !== null && (flowers || drawn.day !== null);
    box.hidden = !opening && readings.element.hidden;
    const held = box.contains(document.activeElement) && document.activeElement instanceof HTMLInputElement;
    if (box.hidden || !drawn || panel.isPlaying || held) return;
    const opens = drawn.day !== null;
    const toggle = el(
      'button',
      {
        type: 'button',
        class: 'chip',
        id: 'b-opens',
        'aria-pressed': String(opens),
        title: t('bloom.hint'),
        onclick: () => session.draw({ 'set-day': opens ? null : OPEN_DAY }),
      },
      t('bloom.opens'),
    );
    // The readings stay where they are: what is taken out and put back loses the keyboard.
    if (readings.element.parentElement !== box) box.prepend(readings.element);
    while (box.lastElementChild !== readings.element) box.lastElementChild!.remove();
    box.append(...(opening ? [toggle] : []), ...(opens ? [panel.dayRow(drawn.day!)] : []));
  }

  // The work -----------------------------------------------------------------------------------------------------

  busy(): void {
    if (this.busyTimer) return;
    this.busyTimer = window.setTimeout(() => {
      this.parts.busyText.textContent = t('status.working');
      this.parts.busy.hidden = false;
    }, MOMENT_MS);
  }

  progress(share: number): void {
    this.parts.busyText.textContent = t('status.working.percent', { percent: Math.floor(100 * share) });
  }

  idle(): void {
    clearTimeout(this.busyTimer);
    this.busyTimer = 0;
    this.parts.busy.hidden = true;
  }

  /** What is true of the file that is written. */
  file(text: string): void {
    this.written = text;
    this.standing(this.stands);
  }

  /** What is true of the saving. */
  standing(now: Standing): void {
    const { kept, readonly } = this.parts;
    const failed = typeof now === 'object';
    const said = failed
      ? t('status.failed', { why: whyNot(now.failed) })
      : {
          empty: '',
          opening: t('status.loading'),
          saving: t('status.saving'),
          saved: t('status.saved'),
          readonly: t('status.readonly'),
        }[now];
    kept.textContent = [said, this.written].filter((text) => text !== '').join(' · ');
    this.stands = now;
    kept.classList.toggle('bad', failed);
    readonly.hidden = now !== 'readonly';
    document.body.dataset['kept'] = failed ? 'failed' : now;
  }
}

/** Why the browser keeps nothing. */
export function whyNot(e: Error): string {
  return t(e.name === 'QuotaExceededError' ? 'failed.full' : 'failed.shut');
}
