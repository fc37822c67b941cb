// node e2e/evaluate.mjs : how long a look at each sketch of Table 1 takes while a stroke is drawn over it, in Node on
// one thread, without a browser beside it. The least is nearest to what an idle machine does.
import { readFileSync } from 'node:fs';
import { initSync, StudioSession } from '../src/wasm/burgeon_wasm.js';

globalThis.burgeonStop = () => false;
initSync({ module: readFileSync(new URL('../src/wasm/burgeon_wasm_bg.wasm', import.meta.url)) });
console.log('| sketch | look, least | look, median | whole plant after the pen is lifted, least |\n|---|---|---|---|');
for (const name of 'abcdefgh') {
  const session = new StudioSession();
  session.open(`${name}.svg`, readFileSync(`../../fixtures/sketches/table1/${name}.svg`), 0, true);
  const [view] = JSON.parse(session.evaluate()).plants;
  const { strokes } = view.item;
  let [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (const { index } of strokes) {
    const points = session.stroke_points(index);
    for (let i = 0; i < points.length; i += 1) {
      if (i % 3 === 2) continue;
      low[i % 3] = Math.min(low[i % 3], points[i]);
      high[i % 3] = Math.max(high[i % 3], points[i]);
    }
  }
  const at = (share, k) => low[k] + share * (high[k] - low[k]);
  const timed = () => {
    const start = performance.now();
    const [{ id, parts }] = JSON.parse(session.evaluate()).plants;
    parts.forEach((_, p) => { for (const column of ['positions', 'normals', 'uvs', 'colors', 'indices']) session[column](id, p); });
    return performance.now() - start;
  };
  const samples = [];
  const looks = [];
  for (let i = 0; i < 40; i += 1) {
    samples.push(at(0.5 + 0.006 * i, 0), at(0.5 + 0.008 * i, 1), 16 * i, 0.5);
    if (i < 5) continue;
    session.draft('parts', Float64Array.from(samples));
    looks.push(timed());
  }
  const wholes = [];
  for (let i = 0; i < 5; i += 1) {
    session.add_stroke('parts', Float64Array.from(samples));
    wholes.push(timed());
    session.undo();
    session.evaluate();
  }
  looks.sort((a, b) => a - b);
  console.log(`| ${name} | ${looks[0].toFixed(1)} ms | ${looks[looks.length >> 1].toFixed(1)} ms | ${Math.min(...wholes).toFixed(1)} ms |`);
  session.free();
}
