// node e2e/held.mjs : a branch in the hand, from the pose of a controller to how what is seen of it is moved, in Node on one
// thread. The page moves what is held by this one matrix: no buffer is written. The least is nearest to an idle machine.
import { readFileSync } from 'node:fs';
import { initSync, StudioSession } from '../src/wasm/burgeon_wasm.js';

/** Nodes that the tree has at least. */
const NODES = 20_000;
const POSES = 400;
const SPEC =
  'name = "held"\n[method]\nkind = "colonization"\npoints = 50000\n[method.steps]\nattraction_m = 2\nkill_m = 0.3\nstep_m = 0.1\n' +
  '[method.envelope]\nshape = "sphere"\ncentre = [0, 6, 0]\nradius_m = 5\n';

globalThis.burgeonStop = () => false;
initSync({ module: readFileSync(new URL('../src/wasm/burgeon_wasm_bg.wasm', import.meta.url)) });
const session = new StudioSession();
session.open('held.toml', new TextEncoder().encode(SPEC), 0, false);
const { min, max } = JSON.parse(session.evaluate()).plants.at(-1);
const REACH = '{"metres":0.05,"per_metre":0.01,"bearers":0}';
const hand = (tool, input) => JSON.parse(session.shape(JSON.stringify(tool), REACH, JSON.stringify(input)));
const within = (i, share) => min[i] + share * (max[i] - min[i]);
const pose = (tip, turn) => ({
  origin: tip,
  direction: [0, 0, -1],
  forward: [0, 0, -1],
  up: [0, 1, 0],
  pressure: 1,
  tip,
  hand: [0, Math.sin(turn / 2), 0, Math.cos(turn / 2)],
});
/** Nodes of a branch and of all that it bears: pieces, and one more for each branch, which is left out. */
const nodes = (axis) => session.branch(axis).length / 8;

// The stem, which bears everything, near the ground; and of what is borne, the branch with the most nodes that rays meet.
let [stem, limb] = [undefined, undefined];
for (let k = 0; k < 900; k += 1) {
  const tip = [within(0, 0.3 + 0.4 * ((k * 0.618) % 1)), within(1, 0.02 + k / 1000), max[2] + 0.5];
  const { picked } = hand('pick', { move: [pose(tip, 0)] });
  if (!picked) continue;
  const found = { at: [...picked.point], axis: picked.axis, nodes: nodes(picked.axis) };
  if (picked.stands) stem ??= found;
  else if (found.nodes > (limb?.nodes ?? 0)) limb = found;
}
if (!stem || !limb || stem.nodes < NODES)
  throw new Error(`a stem of ${stem?.nodes} nodes, a limb of ${limb?.nodes}`);

/** Times of many poses, ascending; `way`: where the hand is, of 0 to 1. */
function held({ at }, way, moved) {
  const start = performance.now();
  hand('rotate', { down: pose([at[0], at[1], at[2] + 0.01], 0) });
  hand('rotate', { move: [pose([at[0] + 0.01, at[1], at[2]], 0.01)] });
  session.held_rows();
  const taken = performance.now() - start;
  const times = [];
  for (let k = 1; k <= POSES; k += 1) {
    const began = performance.now();
    const { carried, host } = hand('rotate', { move: [pose(way(at, k / POSES), k / POSES)] });
    times.push(performance.now() - began);
    if (!carried || (moved && k === POSES && host === null)) throw new Error('it is not in the hand');
  }
  hand('rotate', 'cancel');
  return [taken, times.sort((a, b) => a - b)];
}
const turn = ([x, y, z], t) => [x + 0.3 * t, y + 0.1 * t, z + 0.2 * t];
const pull = ([x, y, z], t) => [x + 2 * (max[0] - min[0]) * (0.2 + 0.8 * t), y + t, z];
console.log(
  '| in the hand | nodes | taken, ms | a pose, least | median | 95th percentile |\n|---|---|---|---|---|---|',
);
for (const [name, what, way, moved] of [
  ['the whole tree, turned', stem, turn, false],
  ['a limb, turned', limb, turn, false],
  ['the same limb, pulled off and carried along the wood', limb, pull, true],
]) {
  const [taken, times] = held(what, way, moved);
  const at = (share) => times[Math.floor(share * (times.length - 1))].toFixed(3);
  console.log(`| ${name} | ${what.nodes} | ${taken.toFixed(1)} | ${at(0)} | ${at(0.5)} | ${at(0.95)} |`);
}
session.free();
