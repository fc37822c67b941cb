/**
 * How the view shows the plants: stage, camera and guides, as the person set them. It belongs to the browser, not to the
 * document.
 */
import { backdrop, setBackdrop } from '../keeping/library';
import { setSetting, setting } from '../keeping/store';
import { t, tOf, type TextKey } from '../text';
import { el, note, popover } from '../page/ui';
import { LENS, MOST_CAMERAS, type Pose, posesFrom, SIDES, type Side } from '../view/camera';
import { type Guide, GUIDES } from '../view/guides';
import {
  BACKGROUNDS,
  GROUNDS,
  OF_PRESET,
  type Preset,
  PRESETS,
  presetOf,
  QUALITIES,
  settingFrom,
  SKIES,
  type StageSetting,
} from '../view/moods';
import type { PlantView } from '../view/view';
import type { WalkMode } from '../view/walk';
import { WalkPad } from '../view/walkpad';

/** The longest side of a picture behind the plants, pixels: as much as a large screen shows. */
const KEPT_PICTURE = 2560;

function parsed(name: string): unknown {
  try {
    return JSON.parse(setting(name) ?? 'null');
  } catch {
    return null;
  }
}

const clock = (hour: number): string => {
  const minutes = Math.round(hour * 60) % 1440;
  return `${String(Math.floor(minutes / 60)).padStart(2, '0')}:${String(minutes % 60).padStart(2, '0')}`;
};

export class Scenery {
  private stage: StageSetting = settingFrom(parsed('stage'));
  /** For whoever walks by a finger. */
  private pad: WalkPad | undefined;
  private poses: Pose[] = posesFrom(parsed('cameras'));

  constructor(
    private readonly view: PlantView | undefined,
    private readonly anchor: (name: 'stage' | 'camera') => HTMLElement,
    private readonly pick: (accept: string, act: (file: File) => void) => void,
  ) {
    if (!view) return;
    const lens = Number(setting('lens'));
    if (lens >= LENS.low && lens <= LENS.high) view.rig.setLens(lens);
    view.setStage(this.stage);
    for (const guide of (setting('guides') ?? '').split(' '))
      if (GUIDES.some((g) => g === guide)) view.setGuide(guide as Guide, true);
    if (this.stage.background === 'picture') void this.show();
  }

  /** A person walks or flies through the scene, or not any more. */
  walked(mode: WalkMode | undefined): void {
    document.body.dataset['walk'] = mode ?? '';
    this.pad?.element.remove();
    this.pad = undefined;
    const { view } = this;
    if (!mode || !view) return;
    const byFinger = matchMedia('(any-pointer: coarse)').matches;
    note(t(byFinger ? 'walk.finger.hint' : `walk.${mode}.hint`));
    if (!byFinger) return;
    this.pad = new WalkPad(mode, {
      go: (right, up, ahead) => view.rig.lead(right, up, ahead),
      end: () => view.rig.setWalking(undefined),
    });
    view.element.append(this.pad.element);
  }

  // Stage --------------------------------------------------------------------------------------------------------

  preset(preset: Preset): void {
    this.change(OF_PRESET[preset]);
  }

  private change(part: Partial<StageSetting>): void {
    this.stage = { ...this.stage, ...part };
    setSetting('stage', JSON.stringify(this.stage));
    this.view?.setStage(this.stage);
  }

  openStage(): void {
    if (!this.view) return;
    const panel = el('div', { class: 'settings scenery' });
    const fill = (): void => {
      const chosen = presetOf(this.stage);
      const chips = PRESETS.map((p) =>
        chip(t(`stage.${p}`), p === chosen, () => then({ ...OF_PRESET[p] }), { 'data-preset-stage': p }),
      );
      const { sky, hour, turn, ground, fog, blur, background, colour, quality } = this.stage;
      const then = (part: Partial<StageSetting>): void => {
        this.change(part);
        fill();
      };
      const mark = (): void => {
        const now = presetOf(this.stage);
        for (const c of panel.querySelectorAll('[data-preset-stage]'))
          c.setAttribute('aria-pressed', String(c.getAttribute('data-preset-stage') === now));
      };
      const slide = (
        key: 'hour' | 'turn' | 'fog' | 'blur',
        value: number,
        [low, high, step]: [number, number, number],
        write: (x: number) => string,
      ): HTMLElement =>
        slider(`stage.${key}`, value, low, high, step, write, (x) => {
          this.change({ [key]: x });
          mark();
        });
      const percent = (x: number): string => `${Math.round(100 * x)} %`;
      const choose = el('button', { type: 'button', class: 'link' }, t('stage.picture.choose'));
      choose.addEventListener('click', () => this.pick('image/*', (file) => void this.lay(file)));
      const paint = el('input', { type: 'color', 'data-stage': 'colour', 'aria-label': t('stage.colour') });
      paint.value = colour;
      paint.addEventListener('input', () => this.change({ colour: paint.value }));
      panel.replaceChildren(
        el('div', { class: 'chips' }, ...chips),
        select('stage.sky', 'sky', SKIES, sky, (w) => then({ sky: w })),
        slide('hour', hour, [0, 24, 0.25], clock),
        slide('turn', turn, [-180, 180, 5], (x) => `${x}°`),
        select('stage.ground', 'ground', GROUNDS, ground, (w) => then({ ground: w })),
        slide('fog', fog, [0, 1, 0.02], percent),
        slide('blur', blur, [0, 1, 0.05], percent),
        select('stage.background', 'background', BACKGROUNDS, background, (w) => then({ background: w })),
        ...(background === 'colour' ? [el('label', {}, el('span', {}, t('stage.colour')), paint)] : []),
        ...(background === 'picture' ? [choose] : []),
        select('stage.quality', 'quality', QUALITIES, quality, (w) => then({ quality: w })),
      );
    };
    fill();
    popover(this.anchor('stage'), panel, t('stage.title'));
  }

  /** A picture behind the plants; this browser keeps it, or says that it does not. */
  private async lay(file: File): Promise<void> {
    try {
      const image = await createImageBitmap(file);
      const share = Math.min(1, KEPT_PICTURE / Math.max(image.width, image.height));
      const canvas = el('canvas');
      canvas.width = Math.max(1, Math.round(image.width * share));
      canvas.height = Math.max(1, Math.round(image.height * share));
      canvas.getContext('2d')!.drawImage(image, 0, 0, canvas.width, canvas.height);
      this.view?.setPicture(canvas);
      this.change({ background: 'picture' });
      const url = canvas.toDataURL('image/jpeg', 0.85);
      await setBackdrop(url).catch(() => note(t('stage.picture.unkept'), 'bad'));
    } catch {
      note(t('note.unreadable', { name: file.name, why: t('stage.picture.bad') }), 'bad');
    }
  }

  private async show(): Promise<void> {
    const image = new Image();
    try {
      // Among the settings, older pages kept it.
      const url = (await backdrop()) ?? setting('backdrop');
      if (url === undefined) return;
      image.src = url;
      await image.decode();
      this.view?.setPicture(image);
    } catch {
      // What cannot be read is as if it had not been kept.
    }
  }

  // Camera -------------------------------------------------------------------------------------------------------

  side(side: Side): void {
    this.view?.seeSide(side);
  }

  walk(mode: WalkMode): void {
    this.view?.rig.setWalking(mode);
  }

  toggle(guide: Guide): void {
    const { view } = this;
    if (!view) return;
    view.setGuide(guide, !view.isGuided(guide));
    setSetting('guides', GUIDES.filter((g) => view.isGuided(g)).join(' '));
  }

  keepCamera(): void {
    const { view } = this;
    if (!view) return;
    if (this.poses.length >= MOST_CAMERAS) {
      note(t('camera.full', { count: MOST_CAMERAS }), 'bad');
      return;
    }
    this.setPoses([...this.poses, view.rig.pose]);
    note(t('camera.kept', { number: this.poses.length }));
  }

  private setPoses(poses: Pose[]): void {
    this.poses = poses;
    setSetting('cameras', JSON.stringify(poses));
  }

  /** Removes a camera that was kept; `show`: shows those that there are. */
  private drop(row: number, show: () => void): void {
    const pose = this.poses[row];
    if (!pose) return;
    this.setPoses(this.poses.filter((_, i) => i !== row));
    show();
    const act = (): void => {
      this.setPoses([...this.poses.slice(0, row), pose, ...this.poses.slice(row)]);
      show();
    };
    note(t('camera.dropped', { number: row + 1 }), 'good', { label: t('undo'), act });
  }

  openCamera(): void {
    const { view } = this;
    if (!view) return;
    const panel = el('div', { class: 'settings scenery' });
    const fill = (): void => {
      const sides = SIDES.map((s) => chip(t(`side.${s}`), false, () => this.side(s), { 'data-side': s }));
      const kept = this.poses.flatMap((pose, i) => [
        chip(String(i + 1), false, () => view.rig.take(pose), {
          'data-camera': String(i + 1),
          title: t('camera.take', { number: i + 1 }),
        }),
        chip('×', false, () => this.drop(i, fill), {
          class: 'chip drop',
          'data-camera-drop': String(i + 1),
          title: t('camera.drop', { number: i + 1 }),
        }),
      ]);
      const keep = chip(
        t('camera.keep'),
        false,
        () => {
          this.keepCamera();
          fill();
        },
        { 'data-camera': 'keep' },
      );
      const walks = (['walk', 'fly'] as const).map((mode) =>
        chip(t(`walk.${mode}`), view.rig.walking === mode, () => this.walk(mode), { 'data-walk': mode }),
      );
      const guides = GUIDES.map((guide) =>
        chip(
          t(`guide.${guide}`),
          view.isGuided(guide),
          () => {
            this.toggle(guide);
            fill();
          },
          { 'data-guide': guide },
        ),
      );
      panel.replaceChildren(
        el('div', { class: 'chips' }, ...sides),
        slider(
          'camera.lens',
          Math.round(view.rig.lens),
          LENS.low,
          LENS.high,
          1,
          (x) => `${x}°`,
          (x) => {
            view.rig.setLens(x);
            setSetting('lens', String(x));
          },
        ),
        el('div', { class: 'chips' }, ...walks),
        el('div', { class: 'chips' }, ...guides),
        el('hr'),
        el('div', { class: 'chips' }, keep, ...kept),
      );
    };
    fill();
    popover(this.anchor('camera'), panel, t('camera.title'));
  }
}

function chip(
  text: string,
  on: boolean,
  act: () => void,
  more: Record<string, string> = {},
): HTMLButtonElement {
  return el(
    'button',
    { type: 'button', class: 'chip', 'aria-pressed': String(on), ...more, onclick: act },
    text,
  );
}

function slider(
  text: TextKey,
  value: number,
  low: number,
  high: number,
  step: number,
  write: (x: number) => string,
  act: (x: number) => void,
): HTMLElement {
  const shown = el('output', {}, write(value));
  const input = el('input', {
    type: 'range',
    min: String(low),
    max: String(high),
    step: String(step),
    'data-stage': text,
    oninput: () => {
      shown.textContent = write(Number(input.value));
      act(Number(input.value));
    },
  });
  input.value = String(value);
  return el('label', {}, el('span', {}, t(text)), input, shown);
}

function select<T extends string>(
  text: TextKey,
  group: string,
  words: readonly T[],
  value: T,
  act: (word: T) => void,
): HTMLElement {
  const field = el('select', { 'data-stage': group, onchange: () => act(field.value as T) });
  for (const word of words) field.append(el('option', { value: word }, tOf(`stage.${group}`, word)));
  field.value = value;
  return el('label', {}, el('span', {}, t(text)), field);
}
