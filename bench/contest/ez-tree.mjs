// Trees of @dgreenheck/ez-tree as JSON that `render.py` reads. Runs in the folder where the package is installed:
//   node ez-tree.mjs OUT "Oak Medium" "Pine Medium"
// Its pictures stay in the package; the file names those that its materials would load.
import { readFileSync, writeFileSync } from 'node:fs';
const none = () => ({ addEventListener() {}, removeEventListener() {}, style: {}, getContext: () => null });
globalThis.document ??= { createElementNS: none, createElement: none };
globalThis.self ??= globalThis;
globalThis.window ??= globalThis;
const { Tree } = await import('@dgreenheck/ez-tree');
const { version } = JSON.parse(readFileSync('node_modules/@dgreenheck/ez-tree/package.json', 'utf8'));
const [out, ...presets] = process.argv.slice(2);
for (const preset of presets) {
  const tree = new Tree();
  tree.loadPreset(preset);
  const start = process.cpuUsage();
  tree.generate();
  const { user, system } = process.cpuUsage(start);
  const mesh = (of) => ({
    position: [...of.geometry.attributes.position.array],
    uv: [...of.geometry.attributes.uv.array],
    index: [...of.geometry.index.array],
    tint: of.material.color.toArray(),
    alphaTest: of.material.alphaTest,
  });
  const { bark, leaves } = tree.options;
  const repeat = [bark.textureScale.x, 1 / bark.textureScale.y];
  const name = `${out}/${preset.toLowerCase().replaceAll(' ', '-')}.json`;
  const made = { version, bark: bark.type, leaf: leaves.type, repeat };
  const [branches, foliage] = [mesh(tree.branchesMesh), mesh(tree.leavesMesh)];
  writeFileSync(name, JSON.stringify({ ...made, branches, leaves: foliage }));
  const triangles = (branches.index.length + foliage.index.length) / 3;
  console.log(`${name}: ${((user + system) / 1e6).toFixed(2)} s of processor, ${triangles} triangles`);
}
process.exit(0);
