// node organs.mjs WASM_MODULE NATIVE_DIGESTS FRAMES DETAIL FILE...: the WASM build must make every leaf, flower and tree
// that the native program made, bit for bit. NATIVE_DIGESTS is {"leaf1.csv": "...", "rose": "...", "tree oak": "...", ...}:
// a file that is named makes a leaf, a drawing (.svg) an opening plant, `stages` the motion through the three scans
// stage1.xyz to stage3.xyz.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { createRequire } from 'node:module';

const [module, nativeDigests, frames, detail, ...leaves] = process.argv.slice(2);
const burgeon = createRequire(import.meta.url)(module);
const native = JSON.parse(readFileSync(nativeDigests, 'utf8'));
const paths = new Map(leaves.map((path) => [basename(path), path]));

let different = 0;
for (const [name, digest] of Object.entries(native)) {
  const path = paths.get(name);
  const scan = (k) => readFileSync(paths.get(`stage${k}.xyz`));
  const wasm = name === 'stages'
    ? burgeon.motion_digest(scan(1), scan(2), scan(3), Number(frames))
    : name.endsWith('.svg')
    ? burgeon.opening_digest(name.slice(0, -4), readFileSync(path), Number(frames), 1n)
    : path
    ? JSON.parse(burgeon.leaf_report(name, readFileSync(path), 1n)).digest
    : name.startsWith('tree ')
      ? burgeon.tree_digest(name.slice(5), Number(detail), 1n)
      : burgeon.flower_digest(name, Number(frames), 1n);
  if (wasm !== digest) {
    different += 1;
    console.error(`${name}: native ${digest}, WASM ${wasm}`);
  }
}
const count = Object.keys(native).length;
console.log(`leaves, flowers and trees, native against WASM: ${count - different} passed, ${different} failed`);
process.exit(different || !count ? 1 : 0);
