import { en, type TextKey } from './en';
import type { Refusal, WarningView } from '../wire';

export type { TextKey };
export type Language = 'en' | 'zh';

/** The texts of the other language, once they were wanted. */
let chinese: typeof import('./chinese') | undefined;
let language: Language = 'en';

/** Goes over to a language; the first time its texts are fetched. English is always there. */
export async function setLanguage(to: Language): Promise<void> {
  if (to === 'zh') chinese ??= await import('./chinese');
  language = to;
  if (typeof document !== 'undefined') document.documentElement.lang = to === 'zh' ? 'zh-Hans' : 'en';
}

const other = (): typeof chinese => (language === 'zh' ? chinese : undefined);

export function currentLanguage(): Language {
  return language;
}

/** The text of a key in the current language, with `{name}` replaced. */
export function t(key: TextKey, values: Record<string, string | number> = {}): string {
  return (other()?.zh ?? en)[key].replace(/\{(\w+)\}/g, (whole, name: string) =>
    String(values[name] ?? whole),
  );
}

/** Why the core did not do something: its own English, or our text for its code. */
export function tell({ code, fields, causes, message }: Refusal): string {
  const texts = other();
  const text: string | undefined = texts?.zhErrors[code as keyof typeof texts.zhErrors];
  const told = (name: string): string => {
    const cause = causes?.[name];
    return cause ? tell(cause) : (texts?.zhWords[fields[name] ?? ''] ?? fields[name] ?? '');
  };
  // A field that does not apply is empty.
  return text?.replace(/\{(\w+)\}/g, (_, name: string) => told(name)).trim() ?? message;
}

/** What was not as one might expect of a plant: our text for its code with the numbers of the core's, or the core's own. */
export function warning({ code, fields, message }: WarningView): string {
  const texts = other();
  const told = (name: string): string => {
    const value = fields[name] ?? '';
    // What an edit by hand is called, and why it was not done.
    const group = { word: 'edit', why: 'why' }[name];
    return texts?.zhWords[value] ?? (group ? tOf(group, value) : value);
  };
  const own = texts?.zhWarnings[code]?.replace(/\{(\w+)\}/g, (_, name: string) => told(name));
  if (own === undefined) return message;
  const more = fields['more'];
  return more === undefined ? own : own + t('warning.more', { count: more });
}

/** Whether a key made of parts has a text. */
export const hasText = (key: string): key is TextKey => key in en;

/** The text of a key made of parts; the last part itself if there is no such key. */
export function tOf(group: string, word: string): string {
  const key = `${group}.${word}`;
  return hasText(key) ? t(key) : word;
}

/** Whole numbers in the language's own grouping. */
export function number(n: number): string {
  return new Intl.NumberFormat(language === 'zh' ? 'zh-CN' : 'en').format(n);
}

/** Words in a row. */
export function listOf(words: readonly string[]): string {
  return words.join(language === 'zh' ? '、' : ', ');
}

/** Bytes as megabytes, of three digits or so. */
export function megabytes(bytes: number): string {
  const mb = bytes / 1e6;
  return mb.toFixed(mb >= 100 ? 0 : mb >= 10 ? 1 : mb >= 0.1 ? 2 : 3);
}

const human = (word: string): string => word.replace(/_(m|deg|years)$/, '').replaceAll(/[_-]/g, ' ');

/** What a field of a schema is called: by its name, or with what it is of where that name means several things. */
export function fieldName(name: string, help = ''): string {
  const own = `field.${help.split('.').slice(-2).join('.')}`;
  const key = own in en ? own : `field.${name}`;
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
  return (key !== undefined ? other()?.zhHelp[key] : undefined) ?? plainHelp(english);
}
