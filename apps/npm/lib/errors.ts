/** What is wrong with what was asked for. */
import type { Refusal } from './wire.js';

/** Names the field, its value and its range where they are what is wrong. */
export class BurgeonError extends Error {
  /** A word in kebab-case that never changes its meaning, such as `field-range`. */
  readonly code: string;
  /** Names and values of the sentence. */
  readonly fields: Readonly<Record<string, string>>;
  /** The field that is wrong, such as `leaves.leaf_keep`. */
  readonly field: string | undefined;
  /** Its value. */
  readonly value: string | undefined;
  /** What it may be: a range, the words that are known, or a kind of value. */
  readonly range: string | undefined;
  /** Those of the fields that are errors themselves, such as the slip that a line of a file has, with codes of their own. */
  readonly causes: Readonly<Record<string, BurgeonError>>;

  constructor(refusal: Refusal) {
    super(refusal.message);
    this.name = 'BurgeonError';
    this.code = refusal.code;
    this.fields = refusal.fields;
    const { field, path, name, value, found, range, choices, wanted } = refusal.fields;
    const beside = refusal.code === 'spec-unknown' || refusal.code === 'spec-missing' ? name : '';
    this.field = field ?? ([path, beside].filter(Boolean).join('.') || undefined);
    this.value = refusal.code === 'spec-choice' ? name : value || found;
    this.range = range ?? choices ?? wanted;
    const causes = Object.entries(refusal.causes ?? {});
    this.causes = Object.fromEntries(causes.map(([field, cause]) => [field, new BurgeonError(cause)]));
  }
}

/** As a worker sends it. */
export function sent({ code, fields, causes, message }: BurgeonError): Refusal {
  const inner = Object.entries(causes).map(([field, cause]) => [field, sent(cause)] as const);
  return { code, fields: { ...fields }, causes: Object.fromEntries(inner), message };
}

/** An error of the core; anything else is a fault of ours and stays what it is. */
export function refusedBy(thrown: unknown): unknown {
  if (typeof thrown !== 'string') return thrown;
  try {
    return new BurgeonError(JSON.parse(thrown) as Refusal);
  } catch {
    return new Error(thrown);
  }
}

/** Lists and objects may hold anything, and have no text then. */
function told(value: unknown): string {
  if (typeof value === 'string') return JSON.stringify(value.slice(0, 80));
  if (Array.isArray(value)) return `a list of ${value.length}`;
  return typeof value === 'object' && value !== null ? 'an object' : String(value);
}

/** What is wrong with an argument, before it goes to the core. */
export function wrong(field: string, value: unknown, range: string): BurgeonError {
  const shown = told(value);
  return new BurgeonError({
    code: 'field-range',
    fields: { field, value: shown, range },
    message: `${field} must be ${range}, not ${shown}`,
  });
}

/** An option that there is not, before anything goes to the core: a misspelt one would do nothing. */
export function unknown(name: string, choices: readonly string[]): BurgeonError {
  return new BurgeonError({
    code: 'spec-unknown',
    fields: { path: '', name, choices: choices.join(', ') },
    message: `there is no option ${name}; there are ${choices.join(', ')}`,
  });
}
