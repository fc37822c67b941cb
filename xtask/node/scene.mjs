// node scene.mjs WASM_MODULE PROJECT REPORT: the WASM build must make every plant of a project that the native program
// made, bit for bit. REPORT is that of `burgeon sketch PROJECT`.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const [module, project, report] = process.argv.slice(2);
globalThis.burgeonStop = () => false;
const burgeon = createRequire(import.meta.url)(module);
const native = JSON.parse(readFileSync(report, 'utf8')).items;
const wasm = new Map(JSON.parse(burgeon.scene_report(readFileSync(project))).map((item) => [item.name, item.digest]));
const different = native.filter((item) => !item.digest || item.digest !== wasm.get(item.name));
for (const item of different) console.error(`${item.name}: native ${item.digest}, WASM ${wasm.get(item.name)}`);
console.log(`${native.length - different.length} of ${native.length} plants of a scene are the same`);
process.exit(native.length > 0 && different.length === 0 ? 0 : 1);
