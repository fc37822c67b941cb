// node e2e/evaluate.mjs : how long a look at each sketch of Table 1 takes while a stroke is drawn over it, a tree takes
// to grow and to follow a hand that turns a branch, in Node on one thread, without a browser beside it. The least is
// nearest to what an idle machine does.
import { readFileSync } from 'node:fs';
import { initSync, StudioSession } from '../src/wasm/burgeon_wasm.js';

globalThis.burgeonStop = () => false;
initSync({ module: readFileSync(new URL('../src/wasm/burgeon_wasm_bg.wasm', import.meta.url)) });
console.log(
  '| sketch | look, least | look, median | whole plant after the pen is lifted, least |\n|---|---|---|---|',
);
for (const name of 'abcdefgh') {
  const session = new StudioSession();
  session.open(`${name}.svg`, readFileSync(`../../fixtures/sketches/table1/${name}.svg`), 0, true);
  const [view] = JSON.parse(session.evaluate()).plants;
  const { strokes } = view.item;
  const [low, high] = [
    [Infinity, Infinity],
    [-Infinity, -Infinity],
  ];
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
    parts.forEach((_, p) => {
      for (const column of ['positions', 'normals', 'uvs', 'colors', 'indices']) session[column](id, p);
    });
    return performance.now() - start;
  };
  const samples = [];
  const looks = [];
  for (let i = 0; i < 40; i += 1) {
    samples.push(at(0.5 + 0.006 * i, 0), at(0.5 + 0.008 * i, 1), 16 * i, 0.5);
    if (i < 5) continue;
    session.draft('parts', Float64Array.from(samples), '');
    looks.push(timed());
  }
  const wholes = [];
  for (let i = 0; i < 5; i += 1) {
    session.add_stroke('parts', Float64Array.from(samples), '', '[]');
    wholes.push(timed());
    session.undo();
    session.evaluate();
  }
  looks.sort((a, b) => a - b);
  console.log(
    `| ${name} | ${looks[0].toFixed(1)} ms | ${looks[looks.length >> 1].toFixed(1)} ms | ${Math.min(...wholes).toFixed(1)} ms |`,
  );
  session.free();
}

console.log(
  '\n| tree | triangles | grown, least of 3 | a branch turned: a move to meshes, least | median | let go to the whole plant, least of 3 |\n|---|---|---|---|---|---|',
);
for (const preset of ['umbrella-pine', 'hazel', 'oak']) {
  const [grown, moves, wholes] = [[], [], []];
  let [triangles, box, plant] = [0, undefined, 0];
  for (let round = 0; round < 3; round += 1) {
    const session = new StudioSession();
    const timed = () => {
      const start = performance.now();
      const { id, parts, item, min, max } = JSON.parse(session.evaluate()).plants.at(-1);
      box = { min, max };
      plant = id;
      parts.forEach((_, p) => {
        for (const column of ['positions', 'normals', 'uvs', 'colors', 'indices']) session[column](id, p);
      });
      triangles = item?.counts.triangles ?? triangles;
      return performance.now() - start;
    };
    session.act(JSON.stringify({ add: { name: preset, maker: { tree: preset } } }));
    grown.push(timed());
    const whole = triangles;
    // The first branch of the trunk that a line of sight meets in the middle of the crown.
    const at = (x, y) => ({
      origin: [x, y, 99],
      direction: [0, 0, -1],
      forward: [0, 0, -1],
      up: [0, 1, 0],
      pressure: 1,
    });
    const hand = (tool, input) =>
      JSON.parse(
        session.shape(
          JSON.stringify(tool),
          '{"metres":0.05,"per_metre":0,"bearers":0}',
          JSON.stringify(input),
        ),
      );
    let place;
    for (let k = 0; k < 400 && !place; k += 1) {
      const within = (i, share) => box.min[i] + share * (box.max[i] - box.min[i]);
      const [x, y] = [within(0, 0.52 + 0.01 * (k % 20)), within(1, 0.4 + 0.02 * Math.floor(k / 20))];
      const { picked } = hand('pick', { move: [at(x, y)] });
      if (picked && picked.order > 0 && picked.length_m > 0.3) place = [x, y];
    }
    if (!place) throw new Error(`${preset}: no branch`);
    hand('rotate', { down: at(...place) });
    for (let k = 1; k <= 12; k += 1) {
      const start = performance.now();
      hand('rotate', { move: [at(place[0] + 0.03 * k, place[1] - 0.05 * k)] });
      const asked = performance.now() - start;
      moves.push(asked + timed());
    }
    const { commit } = hand('rotate', { up: at(place[0] + 0.4, place[1] - 0.6) });
    session.run(JSON.stringify({ shape: [plant, { add: commit }] }));
    wholes.push(timed());
    triangles = whole;
    session.free();
  }
  moves.sort((a, b) => a - b);
  const least = (times) => `${Math.min(...times).toFixed(1)} ms`;
  console.log(
    `| ${preset} | ${triangles} | ${least(grown)} | ${least(moves)} | ${moves[moves.length >> 1].toFixed(1)} ms | ${least(wholes)} |`,
  );
}

console.log('\n| flower | triangles | another day on the slider, least | median |\n|---|---|---|---|');
for (const preset of ['rose', 'peony', 'cherry-blossom', 'dandelion', 'orchid', 'lily']) {
  const session = new StudioSession();
  session.act(JSON.stringify({ add: { name: preset, maker: { flower: preset } } }));
  let [triangles, plant] = [0, 0];
  const shown = () => {
    const { id, parts, item } = JSON.parse(session.evaluate()).plants.at(-1);
    [plant, triangles] = [id, item.counts.triangles];
    parts.forEach((_, p) => {
      for (const column of ['positions', 'normals', 'uvs', 'colors', 'indices']) session[column](id, p);
    });
  };
  shown();
  const days = [];
  for (let k = 0; k < 24; k += 1) {
    const start = performance.now();
    // From bud to wilted, at no day that a preset starts with.
    session.run(JSON.stringify({ flower: [plant, { 'set-day': 0.013 + (9 * k) / 24 }] }));
    shown();
    days.push(performance.now() - start);
  }
  days.sort((a, b) => a - b);
  console.log(`| ${preset} | ${triangles} | ${days[0].toFixed(1)} ms | ${days[12].toFixed(1)} ms |`);
  session.free();
}
