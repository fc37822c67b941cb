/** Times for `cargo xtask bench-web`: measures of the browser's own timeline, the last of each name kept. */
export function measured(what: 'pen' | 'undo' | 'open' | 'shape', start: number): void {
  const name = `burgeon.${what}`;
  performance.clearMeasures(name);
  performance.measure(name, { start, end: performance.now() });
}
