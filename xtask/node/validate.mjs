// node validate.mjs FOLDER : Khronos glTF validator over every .glb and .gltf below the folder; no errors, no warnings but one.
import { readFileSync, readdirSync } from 'node:fs';
import { dirname, join } from 'node:path';
import validator from 'gltf-validator';

// Normal maps without tangents: the standard has viewers compute them (MikkTSpace), as ours were painted for. Written, they
// are 16 bytes a vertex.
const ignoredIssues = ['MESH_PRIMITIVE_GENERATED_TANGENT_SPACE'];

const files = readdirSync(process.argv[2], { recursive: true }).filter((f) => /\.(glb|gltf)$/.test(f)).sort();
let bad = 0;
for (const file of files) {
  const path = join(process.argv[2], file);
  const beside = (uri) => new Uint8Array(readFileSync(join(dirname(path), decodeURIComponent(uri))));
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
    ignoredIssues,
    externalResourceFunction: async (uri) => beside(uri),
  });
  if (issues.numErrors + issues.numWarnings === 0) continue;
  bad += 1;
  const first = issues.messages.slice(0, 3).map((m) => `${m.code} ${m.pointer} ${m.message}`).join('; ');
  console.error(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings: ${first}`);
}
console.log(`valid glTF files: ${files.length - bad} passed, ${bad} failed`);
process.exit(bad || !files.length ? 1 : 0);
