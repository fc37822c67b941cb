import { en, type TextKey } from './en';
import type { Refusal } from '../wire';
import { zh } from './zh';
import { zhErrors, zhWords } from './zh-errors';
import { zhHelp } from './zh-help';

export type { TextKey };
export type Language = 'en' | 'zh';

const tables: Record<Language, Record<TextKey, string>> = { en, zh };
let language: Language = 'en';

export function setLanguage(to: Language): void {
  language = to;
  if (typeof document !== 'undefined') document.documentElement.lang = to === 'zh' ? 'zh-Hans' : 'en';
}

export function currentLanguage(): Language {
  return language;
}

/** The text of a key in the current language, with `{name}` replaced. */
export function t(key: TextKey, values: Record<string, string | number> = {}): string {
  return tables[language][key].replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

/** Why the core did not do something: its own English, or our text for its code. */
export function tell({ code, fields, causes, message }: Refusal): string {
  const text: string | undefined = language === 'zh' ? zhErrors[code as keyof typeof zhErrors] : undefined;
  const told = (name: string): string => {
    const cause = causes?.[name];
    return cause ? tell(cause) : (zhWords[fields[name] ?? ''] ?? fields[name] ?? '');
  };
  return text?.replace(/\{(\w+)\}/g, (_, name: string) => told(name)) ?? message;
}

/** The text of a key made of parts; the last part itself if there is no such key. */
export function tOf(group: string, word: string): string {
  const key = `${group}.${word}`;
  return key in en ? t(key as TextKey) : word;
}

/** Whole numbers in the language's own grouping. */
export function number(n: number): string {
  return new Intl.NumberFormat(language === 'zh' ? 'zh-CN' : 'en').format(n);
}

const human = (word: string): string => word.replace(/_(m|deg|years)$/, '').replaceAll(/[_-]/g, ' ');

/** What a field of a schema is called. */
export function fieldName(name: string): string {
  const key = `field.${name}`;
  return key in en ? t(key as TextKey) : human(name);
}

/** A species, a form, a kind: the word of the core, or ours for it. */
export function wordOf(word: string): string {
  const key = `word.${word}`;
  return key in en ? t(key as TextKey) : human(word);
}

/** A unit of a field. */
export function unitOf(unit: string): string {
  const key = `unit.${unit}`;
  return key in en ? t(key as TextKey) : '';
}

/** The first paragraph of a text that the core's schemas hold, as plain text. */
export function plainHelp(text: string): string {
  return text
    .split('\n\n')[0]!
    .replaceAll('\n', ' ')
    .replaceAll('`', '')
    .replace(/\[([^\]]*)\](\([^)]*\))?/g, '$1');
}

/** What the core says of a field, a choice or a species, in the current language; `key` is its name (`schema.ts`). */
export function helpOf(key: string | undefined, english = ''): string {
  return (language === 'zh' && key !== undefined ? zhHelp[key] : undefined) ?? plainHelp(english);
}
