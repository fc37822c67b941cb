/** Whether every letter of `wanted` occurs in `text` in this order; lower is nearer, undefined is not at all. */
export function nearness(text: string, wanted: string): number | undefined {
  const [hay, needle] = [text.toLowerCase(), wanted.toLowerCase().trim()];
  const whole = hay.indexOf(needle);
  if (whole >= 0) return whole;
  let [at, gaps] = [0, 0];
  for (const letter of needle.replaceAll(' ', '')) {
    const next = hay.indexOf(letter, at);
    if (next < 0) return undefined;
    gaps += next - at;
    at = next + 1;
  }
  return 100 + gaps;
}
