// node digests.mjs WASM_MODULE NATIVE_REPORT DRAWING... : the WASM build must make every plant that the native
// program made, bit for bit.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { createRequire } from 'node:module';

const [module, nativeReport, ...drawings] = process.argv.slice(2);
const burgeon = createRequire(import.meta.url)(module);
const native = JSON.parse(readFileSync(nativeReport, 'utf8'));
const wasm = drawings.flatMap((path) =>
  JSON.parse(burgeon.sketch_report(basename(path), readFileSync(path), BigInt(native.seed))));

let different = Math.abs(native.items.length - wasm.length);
if (different) console.error(`native made ${native.items.length} plants, WASM ${wasm.length}`);
native.items.forEach((item, i) => {
  if (item.digest !== wasm[i]?.digest) {
    different += 1;
    console.error(`${item.name}: native ${item.digest}, WASM ${wasm[i]?.digest}`);
  }
});
console.log(`native against WASM: ${native.items.length - different} passed, ${different} failed`);
process.exit(different || !native.items.length ? 1 : 0);
