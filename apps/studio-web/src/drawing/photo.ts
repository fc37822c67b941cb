/** A photograph under the drawing: brought to a size, placed, shown more or less, used for colours or not. */
import type { PhotoPlace, PhotoState, SketchCommand } from '../wire';
import type { Box } from '../sheet/geometry';
import { t, type TextKey } from '../text';
import { el } from '../page/ui';

/** Longest side in pixels: finer than a traced organ needs, small enough to be saved with every change. */
const MAX_SIDE = 1280;
const TYPES = /^image\/(png|jpeg|webp|avif|gif|bmp)$/;

export function isPhoto(file: File): boolean {
  return TYPES.test(file.type);
}

/** Any picture that the browser reads, as PNG of a bounded size. PNG is decoded alike everywhere. */
export async function asPng(file: Blob, side = MAX_SIDE): Promise<{ png: Uint8Array; aspect: number }> {
  // What the browser says of it is in a language of its own.
  const image = await createImageBitmap(file).catch(() => Promise.reject(new Error(t('fault.image'))));
  const scale = Math.min(1, side / Math.max(image.width, image.height));
  const canvas = document.createElement('canvas');
  canvas.width = Math.max(1, Math.round(image.width * scale));
  canvas.height = Math.max(1, Math.round(image.height * scale));
  canvas.getContext('2d')?.drawImage(image, 0, 0, canvas.width, canvas.height);
  image.close();
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, 'image/png'));
  if (!blob) throw new Error(t('fault.picture'));
  return { png: new Uint8Array(await blob.arrayBuffer()), aspect: canvas.height / canvas.width };
}

/** Where a picture lies that fills the part of the sheet that is seen, but for a margin. */
export function placed(seen: Box, aspect: number): { x: number; y: number; width: number } {
  const [w, h] = [(seen.right - seen.left) * 0.8, (seen.top - seen.bottom) * 0.86];
  const width = Math.min(w, h / aspect);
  return { x: (seen.left + seen.right - width) / 2, y: (seen.bottom + seen.top - width * aspect) / 2, width };
}

export interface PhotoEvents {
  /** Asked of the drawing. */
  run(command: SketchCommand): void;
  begin(name: string): void;
  stage(command: SketchCommand): void;
  commit(): void;
  choose(): void;
  placing(on: boolean): void;
}

const laid = (p: PhotoState, change: Partial<PhotoPlace>): SketchCommand => ({
  'place-photo': { ...p.place, ...change },
});

/** The panel: `now` gives the photograph as it lies at the moment. */
export function photoPanel(now: () => PhotoState | null, placing: boolean, events: PhotoEvents): HTMLElement {
  const panel = el('div', { class: 'settings' });
  const first = now();
  if (!first) {
    panel.append(
      el('p', { class: 'muted' }, t('photo.hint')),
      el('button', { type: 'button', class: 'primary', onclick: () => events.choose() }, t('photo.choose')),
    );
    return panel;
  }
  const slider = (
    text: TextKey,
    low: number,
    high: number,
    value: number,
    shown: (v: number) => string,
    set: (p: PhotoState, v: number) => SketchCommand,
  ): void => {
    const output = el('output', {}, shown(value));
    let dragging = false;
    const input = el('input', {
      type: 'range',
      min: String(low),
      max: String(high),
      step: '0.01',
      oninput: () => {
        const photo = now();
        if (!photo) return;
        output.textContent = shown(Number(input.value));
        if (!dragging) events.begin('photo');
        dragging = true;
        events.stage(set(photo, Number(input.value)));
      },
      onchange: () => {
        if (dragging) events.commit();
        dragging = false;
      },
    });
    input.value = String(value);
    panel.append(el('label', {}, el('span', {}, t(text)), input, output));
  };
  const percent = (v: number): string => `${Math.round(v * 100)} %`;
  slider('photo.opacity', 0.05, 1, first.place.opacity, percent, (p, opacity) => laid(p, { opacity }));
  // The size is a ratio to what it was when the panel opened; the middle stays.
  slider(
    'photo.size',
    -2,
    2,
    0,
    (v) => `${(2 ** v).toFixed(2)} ×`,
    (p, v) => {
      const width = first.place.width * 2 ** v;
      const was = p.place;
      return laid(p, {
        width,
        x: was.x + (was.width - width) / 2,
        y: was.y + (p.height - (width * p.height) / was.width) / 2,
      });
    },
  );
  const check = (text: TextKey, on: boolean, act: (on: boolean) => void): void => {
    const box = el('input', { type: 'checkbox', onchange: () => act(box.checked) });
    box.checked = on;
    panel.append(el('label', { class: 'check' }, box, el('span', {}, t(text))));
  };
  check('photo.paint', first.place.paint, (paint) => {
    const p = now();
    if (p) events.run(laid(p, { paint }));
  });
  check('photo.move', placing, (on) => events.placing(on));
  panel.append(
    el(
      'div',
      { class: 'row' },
      el('button', { type: 'button', class: 'chip', onclick: () => events.choose() }, t('photo.other')),
      el('span', { class: 'space' }),
      el(
        'button',
        { type: 'button', class: 'chip danger', onclick: () => events.run('remove-photo') },
        t('photo.off'),
      ),
    ),
  );
  return panel;
}
