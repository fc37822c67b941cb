// node bench/peers/npm.mjs CHROMIUM: the time from `import` to the first tree, of the packed npm package (`cargo xtask npm`)
// and of @dgreenheck/ez-tree, in Node and in a browser, one after another in one run. Each number is the least and the
// median of some fresh starts: a process of Node, a page with an empty cache. The peer is installed outside the repository.
import { execFileSync, execSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { cpus, loadavg, tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { FLAGS } from '../../apps/studio-web/e2e/flags.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
const { chromium } = createRequire(join(root, 'apps/npm/package.json'))('playwright-core');
const target = process.env.CARGO_TARGET_DIR ?? join(root, 'target');
const tarball = readdirSync(join(target, 'npm')).find((f) => f.endsWith('.tgz'));
const away = mkdtempSync(join(tmpdir(), 'burgeon-bench-'));
const RUNS = 5;
writeFileSync(join(away, 'package.json'), '{"type":"module","private":true}');
execSync(`npm install --no-audit --no-fund --silent "${join(target, 'npm', tarball)}" three @dgreenheck/ez-tree`, { cwd: away });

// As in ez-tree.mjs: a page's few words that it asks for in Node answer nothing.
const STUBS = `const none = () => ({ addEventListener() {}, removeEventListener() {}, style: {}, getContext: () => null });
globalThis.document ??= { createElementNS: none, createElement: none };
globalThis.self ??= globalThis; globalThis.window ??= globalThis;`;
/** What each does until there is an object for a scene; triangles of it. */
const CODE = {
  'burgeon, oak': `const { grow } = await import('burgeon');
    const plant = await grow('oak', { seed: 2 }); const tree = plant.object3D();
    const triangles = plant.report.counts.triangles;`,
  'burgeon/growth, oak': `const { grow } = await import('burgeon/growth');
    const plant = await grow('oak', { seed: 2 }); const tree = plant.object3D();
    const triangles = plant.report.counts.triangles;`,
  'burgeon/growth, oak at detail 0.1, textures of 256': `const { grow } = await import('burgeon/growth');
    const plant = await grow('oak', { seed: 2, detail: 0.1, texture_size: 256 }); const tree = plant.object3D();
    const triangles = plant.report.counts.triangles;`,
  'burgeon/growth, oak, first': `const { grow } = await import('burgeon/growth');
    const plant = await new Promise((first) => void grow('oak', { seed: 2, first })); const tree = plant.object3D();
    const triangles = plant.report.counts.triangles;`,
  'ez-tree, Oak Medium': `const { Tree } = await import('@dgreenheck/ez-tree');
    const tree = new Tree(); tree.loadPreset('Oak Medium'); tree.generate();
    let triangles = 0; tree.traverse((o) => { triangles += (o.geometry?.index?.count ?? 0) / 3; });`,
  'ez-tree, Oak Large': `const { Tree } = await import('@dgreenheck/ez-tree');
    const tree = new Tree(); tree.loadPreset('Oak Large'); tree.generate();
    let triangles = 0; tree.traverse((o) => { triangles += (o.geometry?.index?.count ?? 0) / 3; });`,
};

const rows = Object.keys(CODE).map((name) => ({ name, node: [], page: [] }));
for (let k = 0; k < RUNS; k++) {
  for (const row of rows) {
    const script = `${STUBS} const started = performance.now(); ${CODE[row.name]}
      console.log(JSON.stringify({ ms: performance.now() - started, triangles })); process.exit(0);`;
    const said = execFileSync(process.execPath, ['--input-type=module', '-e', script], { cwd: away, encoding: 'utf8' });
    const { ms, triangles } = JSON.parse(said.trim().split('\n').pop());
    row.node.push(ms);
    row.triangles = triangles;
  }
}

const TYPES = { '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm', '.html': 'text/html' };
/** Compressed once, as a server of packages does. */
const zipped = new Map();
const server = createServer((request, response) => {
  const path = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname));
  if (path === '/') {
    const burgeon = '/node_modules/burgeon/dist/';
    const ez = JSON.parse(readFileSync(join(away, 'node_modules/@dgreenheck/ez-tree/package.json'), 'utf8'));
    const entry = ez.module ?? ez.exports?.['.']?.import ?? ez.main;
    const imports = {
      three: '/node_modules/three/build/three.module.js',
      burgeon: `${burgeon}index.js`,
      'burgeon/growth': `${burgeon}growth/index.js`,
      '@dgreenheck/ez-tree': `/node_modules/@dgreenheck/ez-tree/${entry.replace(/^\.\//, '')}`,
    };
    const page = `<!doctype html><link rel="icon" href="data:,"><script type="importmap">${JSON.stringify({ imports })}</script>`;
    response.writeHead(200, { 'content-type': 'text/html' }).end(page);
    return;
  }
  const file = join(away, path);
  if (!file.startsWith(away) || !existsSync(file)) {
    response.writeHead(404).end();
    return;
  }
  if (!zipped.has(file)) zipped.set(file, gzipSync(readFileSync(file), { level: 9 }));
  const type = TYPES[extname(file)] ?? 'application/octet-stream';
  response.writeHead(200, { 'content-type': type, 'content-encoding': 'gzip' }).end(zipped.get(file));
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));
const url = `http://127.0.0.1:${server.address().port}/`;
const browser = await chromium.launch({ executablePath: process.argv[2], args: FLAGS });
try {
  for (let k = 0; k < RUNS; k++) {
    for (const row of rows) {
      const context = await browser.newContext();
      const page = await context.newPage();
      await page.goto(url);
      const code = `(async () => { const started = performance.now(); ${CODE[row.name]} return { ms: performance.now() - started, triangles }; })()`;
      const { ms } = await page.evaluate(code);
      row.page.push(ms);
      await context.close();
    }
  }
} finally {
  await browser.close();
  server.close();
  rmSync(away, { recursive: true, force: true });
}

const told = (times) => {
  const sorted = times.toSorted((a, b) => a - b);
  return `${sorted[0].toFixed(0)} / ${sorted[RUNS >> 1].toFixed(0)}`;
};
const load = loadavg()[0].toFixed(1);
console.log(`${cpus().length} processors (${cpus()[0]?.model.trim()}), load ${load}; least / median of ${RUNS} fresh starts, ms`);
console.log('\n| from import to the first tree | Node | Chromium | triangles |\n|---|---|---|---|');
for (const { name, node, page, triangles } of rows) {
  console.log(`| ${name} | ${told(node)} | ${told(page)} | ${triangles.toLocaleString('en')} |`);
}
