import { expect, test } from 'vitest';
import { en } from '../text/en';
import { zh } from '../text/zh';
import { iconOfEdit, isBrush, isChoice, isNumber, rowOf, SHAPE_WORDS, type ShapeTool } from './tools';
import { ToolSettings } from './toolsettings';

/** What the page says of a tool. */
function textsOf(word: ShapeTool): string[] {
  const { settings, edit = word, chooses } = rowOf(word);
  const own = Object.entries(settings).flatMap(([name, s]) => {
    if (isNumber(s)) return [`shape.set.${name}`];
    const words = isChoice(s) ? Object.keys(s.words) : [s.word];
    return words.map((w) => `shape.${word}.${w}`);
  });
  return [`shape.${word}`, `vr.tool.${word}`, ...(chooses ? [] : [`edit.${edit}`]), ...own];
}

test('a row of a tool is all but its texts: they are there in both languages', () => {
  const missing = SHAPE_WORDS.flatMap(textsOf).filter((key) => !(key in en && key in zh));
  expect(missing).toEqual([]);
});

test('no two tools are taken up by one key', () => {
  const keys = SHAPE_WORDS.map((word) => rowOf(word).keys);
  expect(new Set(keys).size).toBe(SHAPE_WORDS.length);
});

test('an edit wears the icon of its tool, one that no tool makes that of a branch', () => {
  expect(iconOfEdit('sketch-branch')).toBe('branch');
  expect(iconOfEdit('leaf-density')).toBe('leaf');
  expect(iconOfEdit('prune')).toBe('prune');
  expect(iconOfEdit('unheard-of')).toBe('branch');
});

test('the core is told metres of the plant, and a word where nothing is set', () => {
  const settings = new ToolSettings();
  expect(settings.wire('rotate', 8)).toBe('rotate');
  expect(settings.wire('brush', 10)).toEqual({ brush: { radius_m: 0.7000000000000001, density: 1 } });
  expect(settings.wire('leaves', 10)).toEqual({ leaves: { radius_m: 0.7000000000000001, keep: 0.25 } });
  expect(settings.wire('silhouette', 10)).toEqual({ silhouette: { density: 1, trim: false } });
});

test('each tool keeps what it is set to by itself, within its range', () => {
  const settings = new ToolSettings();
  settings.set('brush', 'radius_m', 3);
  expect(settings.of('brush')['radius_m']).toBe(0.4);
  expect(settings.of('leaves')['radius_m']).toBe(0.07);
  settings.turn('grow', 'vigour', 2);
  expect(settings.of('grow')['vigour']).toBeCloseTo(2 * 1.12 ** 2);
  settings.turn('leaves', 'keep', 1);
  settings.turn('prune', 'whole', 1);
  settings.turn('silhouette', 'trim', 1);
  expect([
    settings.of('leaves')['keep'],
    settings.of('prune')['whole'],
    settings.of('silhouette')['trim'],
  ]).toEqual([2, true, true]);
  settings.turn('grow', 'angle_deg', 100);
  expect(settings.of('grow')['angle_deg']).toBe(110);
  expect(SHAPE_WORDS.filter(isBrush)).toEqual(['brush', 'leaves']);
});
