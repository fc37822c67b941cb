/**
 * How near a text is to what is wanted; lower is nearer, undefined is not at all. Either it holds the words, or it holds
 * the letters in this order: each begins a word or lies in the word of the one before it. Letters from anywhere would
 * find what nobody meant.
 */
export function nearness(text: string, wanted: string): number | undefined {
  const [hay, needle] = [text.toLowerCase(), wanted.toLowerCase().trim()];
  const whole = hay.indexOf(needle);
  if (whole >= 0) return whole;
  const far = scattered(hay, needle.replaceAll(' ', ''), 0, false);
  return far === undefined ? undefined : 100 + far;
}

const isLetter = (c: string | undefined): boolean => c !== undefined && /[\p{L}\p{N}]/u.test(c);

/** How far apart the letters lie from `from` on; `inside`: a letter was found in the word that goes on there. */
function scattered(hay: string, needle: string, from: number, inside: boolean): number | undefined {
  if (needle === '') return 0;
  let same = inside;
  for (let at = from; at < hay.length; at += 1) {
    same &&= isLetter(hay[at]);
    if (hay[at] !== needle[0] || !(same || !isLetter(hay[at - 1]))) continue;
    const rest = scattered(hay, needle.slice(1), at + 1, true);
    if (rest !== undefined) return at - from + rest;
  }
  return undefined;
}
