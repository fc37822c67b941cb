// node guided.mjs BURGEON_WASM.js : a round of guided growth, by markers and buds, in Node on one thread. The least of
// five, each grown from the ground.
import { createRequire } from 'node:module';

globalThis.burgeonStop = () => false;
const { GuidedGrowth } = createRequire(import.meta.url)(process.argv[2]);
console.log('| markers a bud | buds | ms a round | us a bud |\n|---|---|---|---|');
for (const [markers, finer, buds] of [
  [60, 1, 800],
  [60, 4, 3200],
  [60, 4, 10_000],
  [12, 4, 10_000],
  [1300, 1, 800],
]) {
  let [best, living] = [Infinity, 0];
  for (let k = 0; k < 5; k += 1) {
    const growing = new GuidedGrowth(markers, finer, buds);
    living = growing.living;
    const start = performance.now();
    growing.step();
    best = Math.min(best, performance.now() - start);
    growing.free();
  }
  console.log(`| ${markers} | ${living} | ${best.toFixed(2)} | ${((best * 1e3) / living).toFixed(2)} |`);
}
