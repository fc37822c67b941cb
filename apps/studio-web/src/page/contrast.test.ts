import { describe, expect, it } from 'vitest';
import { inkOf, ORGANS } from '../drawing/colours';
import css from '../style.css?raw';

/** Relative luminance and contrast as WCAG 2.2 defines them. */
function luminance(hex: string): number {
  const [r, g, b] = [1, 3, 5]
    .map((i) => parseInt(hex.slice(i, i + 2), 16) / 255)
    .map((c) => (c <= 0.040_45 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
}
function contrast(a: string, b: string): number {
  const [x, y] = [luminance(a), luminance(b)];
  return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05);
}

function theme(start: string): Record<string, string> {
  const block = css.slice(css.indexOf(start), css.indexOf('}', css.indexOf(start)));
  return Object.fromEntries([...block.matchAll(/--([\w-]+): (#[0-9a-f]{6});/g)].map((m) => [m[1]!, m[2]!]));
}

const THEMES = { light: theme(':root {'), dark: theme(':root[data-theme="dark"] {') };

describe('contrast (WCAG AA)', () => {
  for (const [name, c] of Object.entries(THEMES)) {
    it(`of text is 4.5 or more, ${name}`, () => {
      for (const text of ['ink', 'muted', 'accent', 'danger']) {
        for (const ground of ['bar', 'paper', 'raised', 'hover']) {
          expect(contrast(c[text]!, c[ground]!), `${text} on ${ground}`).toBeGreaterThanOrEqual(4.5);
        }
      }
      expect(contrast(c['accent-ink']!, c['accent']!)).toBeGreaterThanOrEqual(4.5);
    });

    it(`of focus and of strokes is 3 or more, ${name}`, () => {
      for (const ground of ['bar', 'paper', 'raised'])
        expect(contrast(c['focus']!, c[ground]!), ground).toBeGreaterThanOrEqual(3);
      for (const organ of [undefined, ...ORGANS]) {
        expect(
          contrast(inkOf(organ, name === 'dark'), c['paper']!),
          organ ?? 'unread',
        ).toBeGreaterThanOrEqual(3);
      }
    });
  }

  it('of notes is 4.5 or more', () => {
    expect(contrast('#f4f7f2', '#22302a')).toBeGreaterThanOrEqual(4.5);
    expect(contrast('#f4f7f2', '#7d1d14')).toBeGreaterThanOrEqual(4.5);
  });
});
