import { readFileSync } from 'node:fs';
import { beforeAll, describe, expect, it, vi } from 'vitest';
import { drawingSchema, named, type Schema } from '../making/schema';
import { initSync, studio_schema } from '../wasm/burgeon_wasm';
import { ENGINES, FORMATS } from '../wire';
import { en } from './en';
import { fieldName, helpOf, plainHelp, setLanguage, unitOf, wordOf } from '.';
import { zhHelp } from './zh-help';

interface Species {
  key: string;
  about: string;
}

/** Everything of the core's schemas that a panel can show. */
const said = {
  fields: new Set<string>(),
  /** Fields with what they are of. */
  owned: new Set<string>(),
  words: new Set<string>(),
  units: new Set<string>(),
  /** By their names. */
  texts: new Map<string, string>(),
};

function gather(s: Schema | Schema[] | unknown): void {
  if (Array.isArray(s)) {
    s.forEach(gather);
    return;
  }
  if (typeof s !== 'object' || s === null) return;
  const schema = s as Schema;
  if (typeof schema.description === 'string') {
    // A text without a name, or two of one name, would be in English in the Chinese page.
    expect(schema['x-help'], schema.description).toBeTruthy();
    expect(said.texts.get(schema['x-help']!) ?? plainHelp(schema.description)).toBe(
      plainHelp(schema.description),
    );
    said.texts.set(schema['x-help']!, plainHelp(schema.description));
  }
  for (const word of [...(schema.enum ?? []), schema.const])
    if (typeof word === 'string') said.words.add(word);
  if (schema['x-unit'] !== undefined && !schema['x-unit'].endsWith('colour'))
    said.units.add(schema['x-unit']);
  for (const [name, field] of Object.entries(schema.properties ?? {})) {
    said.fields.add(name);
    if (field['x-help'] !== undefined) said.owned.add(field['x-help'].split('.').slice(-2).join('.'));
    gather(field);
  }
  for (const [key, part] of Object.entries(schema))
    if (key !== 'properties') gather(key === '$defs' ? Object.values(part as object) : part);
}

beforeAll(() => {
  initSync({ module: readFileSync(new URL('../wasm/burgeon_wasm_bg.wasm', import.meta.url)) });
  const { sketch, skin, tree, leaf, flower, material, trees, flowers, materials } = JSON.parse(
    studio_schema(),
  ) as {
    sketch: Schema;
    skin: Schema;
    tree: Schema;
    leaf: Schema;
    flower: Schema;
    material: Schema;
    materials: { key: string }[];
    trees: Species[];
    flowers: { key: string }[];
  };
  gather([
    drawingSchema(named(sketch, 'sketch'), named(skin, 'skin')),
    named(tree, 'tree'),
    named(leaf, 'leaf'),
    named(flower, 'flower'),
    named(material, 'material'),
  ]);
  for (const { key, about } of trees) {
    said.words.add(key);
    said.texts.set(`preset.${key}`, plainHelp(about));
  }
  for (const { key } of [...flowers, ...materials]) said.words.add(key);
  for (const [word, { about }] of Object.entries(ENGINES)) said.texts.set(`engine.${word}`, plainHelp(about));
  for (const [word, { about }] of Object.entries(FORMATS)) said.texts.set(`format.${word}`, plainHelp(about));
  expect(said.fields.size).toBeGreaterThan(100);
  expect(said.texts.size).toBeGreaterThan(200);
});

describe('what the core says', () => {
  it('has a name in both languages for each field, choice and unit', () => {
    const keys = [
      ...[...said.fields].map((f) => `field.${f}`),
      ...[...said.words].map((w) => `word.${w}`),
      ...[...said.units].map((u) => `unit.${u}`),
    ];
    expect(keys.filter((k) => !(k in en))).toEqual([]);
  });

  it('has no names for what is not there any more', () => {
    const left = Object.keys(en).filter((key) => {
      const [group, ...rest] = key.split('.');
      const name = rest.join('.');
      if (group === 'field') return !said.fields.has(name) && !said.owned.has(name);
      if (group === 'unit') return !said.units.has(name);
      // Fields of obstacles are called by words.
      return group === 'word' && !said.words.has(name) && !said.fields.has(name);
    });
    expect(left).toEqual([]);
  });

  it('is Chinese in the Chinese page, each text and no other', () => {
    expect([...said.texts.keys()].filter((key) => !(key in zhHelp))).toEqual([]);
    expect(Object.keys(zhHelp).filter((key) => !said.texts.has(key))).toEqual([]);
    expect(Object.entries(zhHelp).filter(([, text]) => !/[\u4e00-\u9fff]/.test(text))).toEqual([]);
  });

  it('keeps its numbers in Chinese', () => {
    const numbers = (text: string): string[] =>
      text.replace(/\d+ million/g, '').match(/-?\d[\d,.]*\d|-?\d/g) ?? [];
    for (const [key, text] of said.texts)
      for (const n of numbers(text)) expect(zhHelp[key], key).toContain(n);
  });

  it('is asked for in the current language', async () => {
    vi.stubGlobal('document', { documentElement: {} });
    await setLanguage('zh');
    expect([
      fieldName('lambda'),
      wordOf('guided'),
      unitOf('m'),
      helpOf('tree.look', 'Colours and\nbark.\n\nMore.'),
    ]).toEqual(['顶端优势', '引导生长', '米', '颜色与树皮。']);
    await setLanguage('en');
    expect([
      helpOf('tree.look', 'What [`Lsystem::parse`] and [`x`](Self::x) read.'),
      unitOf('colour'),
    ]).toEqual(['What Lsystem::parse and x read.', '']);
  });
});
