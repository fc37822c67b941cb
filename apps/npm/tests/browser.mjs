// node tests/browser.mjs CHROMIUM OUT, with the tarball in BURGEON_TARBALL: the example pages in a browser. That of plain
// three.js as it is, without a bundler; that of react-three-fiber built by Vite from the installed package. Pictures to OUT.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import {
  cpSync,
  existsSync,
  mkdirSync,
  readdirSync,
  readFileSync,
  rmSync,
  symlinkSync,
  writeFileSync,
} from 'node:fs';
import { createServer } from 'node:http';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { FLAGS } from '../../studio-web/e2e/flags.mjs';

const [browserPath, out] = process.argv.slice(2);
const own = fileURLToPath(new URL('..', import.meta.url));
rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });

/** The example of React, in a folder in which the package is installed. */
function react() {
  const folder = join(out, 'react');
  cpSync(join(own, 'examples/react'), folder, { recursive: true });
  writeFileSync(join(folder, 'package.json'), '{"type":"module","private":true}');
  const npm = process.platform === 'win32' ? 'npm.cmd' : 'npm';
  const options = ['--offline', '--no-audit', '--no-fund', '--silent', '--legacy-peer-deps'];
  execFileSync(npm, ['install', ...options, process.env.BURGEON_TARBALL], { cwd: folder });
  for (const name of ['three', 'react', 'react-dom', '@react-three/fiber']) {
    const to = join(folder, 'node_modules', name);
    mkdirSync(dirname(to), { recursive: true });
    symlinkSync(join(own, 'node_modules', name), to, 'junction');
  }
  const vite = join(own, 'node_modules/vite/bin/vite.js');
  execFileSync(process.execPath, [vite, 'build', '--logLevel', 'warn', '--base', './'], {
    cwd: folder,
    stdio: 'inherit',
  });
  return join(folder, 'dist');
}

const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.wasm': 'application/wasm',
  '.json': 'application/json',
};

/** Serves a folder; what was asked for is noted. */
async function serve(folder) {
  const asked = [];
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname)).replace(
      /\/$/,
      '/index.html',
    );
    const file = join(folder, path);
    asked.push(path);
    if (!file.startsWith(folder) || !existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    response
      .writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream' })
      .end(readFileSync(file));
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { url: `http://127.0.0.1:${server.address().port}`, asked, close: () => server.close() };
}

const browser = await chromium.launch({ executablePath: browserPath, args: FLAGS });
const faults = [];

async function open(url) {
  const page = await browser.newPage({ viewport: { width: 560, height: 400 } });
  page.on('pageerror', (e) => faults.push(`${url}: ${e.stack ?? e}`));
  page.on('console', (m) => {
    const text = m.text();
    // SwiftShader tells how slow it is; react-three-fiber uses a clock that three.js will give up.
    if (
      m.type() === 'error' ||
      (m.type() === 'warning' && /three|shader|burgeon/i.test(text) && !/GPU stall|THREE\.Clock/.test(text))
    )
      faults.push(`${url}: ${text}`);
  });
  await page.goto(url);
  await page.waitForFunction(() => document.body.dataset.ready === 'yes', undefined, { timeout: 180_000 });
  return page;
}

/** How many colours a picture of the page has, by coarse steps, and its share of greens. */
async function look(page, name) {
  const png = await page.screenshot({ path: join(out, `${name}.png`), timeout: 120_000 });
  return page.evaluate(async (base64) => {
    const bitmap = await createImageBitmap(await (await fetch(`data:image/png;base64,${base64}`)).blob());
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    const colours = new Set();
    let dark = 0;
    for (let k = 0; k < data.length; k += 4) {
      colours.add(`${data[k] >> 4},${data[k + 1] >> 4},${data[k + 2] >> 4}`);
      dark += data[k + 1] < 110 ? 1 : 0;
    }
    return { colours: colours.size, dark: dark / (data.length / 4) };
  }, png.toString('base64'));
}

try {
  const plain = await serve(own);
  const page = await open(`${plain.url}/examples/three/?detail=0.15`);
  assert.match(await page.locator('output').textContent(), /triangles/);
  assert.ok(page.workers().length === 1, 'the core computes in a worker');
  assert.ok(plain.asked.includes('/dist/core/burgeon_npm_bg.wasm'));
  const seen = await look(page, 'three');
  assert.ok(seen.colours > 60 && seen.dark > 0.05, JSON.stringify(seen));
  // Drawn by the processor, it would take all of it.
  await page.evaluate(() => {
    globalThis.requestAnimationFrame = () => 0;
  });
  // What is refused is told, and the page goes on.
  const told = await page.evaluate(async () => {
    const { grow, BurgeonError } = await import('burgeon');
    const error = await grow('oak', { detail: 99 }).catch((e) => e);
    const stop = new AbortController();
    const stopped = grow('oak', { signal: stop.signal, seed: 9 }).catch((e) => e.name);
    const waiting = grow('grass', { detail: 0.2 });
    setTimeout(() => stop.abort(), 50);
    const names = [error instanceof BurgeonError, error.field, await stopped, (await waiting).name];
    return names;
  });
  assert.deepEqual(told.slice(0, 3), [true, 'detail', 'AbortError']);
  assert.ok(told[3].length > 0);
  // Wind moves leaves: with the clock at two moments the canvas differs, and with none it does not.
  const moved = await page.evaluate(async () => {
    const THREE = await import('three');
    const { grow } = await import('burgeon');
    const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
    renderer.setSize(300, 300);
    const tree = await grow('hazel', { seed: 3, detail: 0.2, textures: false });
    const pixels = (object, moment) => {
      const { wind } = object.userData;
      wind.running = false;
      wind.time.value = moment;
      const scene = new THREE.Scene();
      scene.add(object, new THREE.HemisphereLight(0xffffff, 0x888888, 3));
      const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 100);
      const high = tree.bounds.max[1];
      camera.position.set(0, high / 2, 1.6 * high);
      renderer.render(scene, camera);
      const gl = renderer.getContext();
      const data = new Uint8Array(4 * 300 * 300);
      gl.readPixels(0, 0, 300, 300, gl.RGBA, gl.UNSIGNED_BYTE, data);
      return data;
    };
    const differ = (a, b) => a.reduce((n, x, k) => n + (Math.abs(x - b[k]) > 24 ? 1 : 0), 0) / a.length;
    const blown = tree.object3D({ wind: 0.6 });
    const still = pixels(tree.object3D({ wind: false }), 0);
    const [early, late] = [pixels(blown, 0.4), pixels(blown, 1.6)];
    const whole = pixels(tree.object3D({ wind: 0.6, instances: false }), 1.6);
    const copies = tree.stand([{ x: 0, z: 0 }], { wind: 0.6 });
    const copied = pixels(copies, 1.6);
    return [differ(early, late), differ(still, late), differ(whole, late), differ(whole, copied)];
  });
  // In the dark a plant is dark, and a leaf before the light has its own tint.
  const shone = await page.evaluate(async () => {
    const THREE = await import('three');
    const { grow } = await import('burgeon');
    const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
    renderer.setSize(300, 300);
    const tree = await grow('hazel', { seed: 3, detail: 0.2, textures: false });
    const high = tree.bounds.max[1];
    const mean = (side) => {
      const scene = new THREE.Scene();
      scene.add(tree.object3D({ wind: false, shadows: false }));
      if (side !== 0) {
        const sun = new THREE.DirectionalLight(0xffffff, 3);
        sun.position.set(0, 0.3, side);
        scene.add(sun);
      }
      const camera = new THREE.PerspectiveCamera(45, 1, 0.1, 100);
      camera.position.set(0, high / 2, 1.6 * high);
      renderer.render(scene, camera);
      const gl = renderer.getContext();
      const data = new Uint8Array(4 * 300 * 300);
      gl.readPixels(0, 0, 300, 300, gl.RGBA, gl.UNSIGNED_BYTE, data);
      const sum = [0, 0, 0];
      for (let k = 0; k < data.length; k += 4) for (const c of [0, 1, 2]) sum[c] += data[k + c];
      return sum.map((x) => x / (300 * 300));
    };
    return { dark: mean(0), before: mean(1), behind: mean(-1) };
  });
  assert.deepEqual(shone.dark, [0, 0, 0], 'nothing glows in the dark');
  const saturation = ([r, g, b]) => 1 - Math.min(r, g, b) / Math.max(r, g, b, 1e-9);
  assert.ok(Math.max(...shone.behind) > 0.05 * Math.max(...shone.before), JSON.stringify(shone));
  assert.ok(saturation(shone.behind) > 0.8 * saturation(shone.before), JSON.stringify(shone));
  console.log(
    `saturation before the light ${saturation(shone.before).toFixed(2)}, against it ${saturation(shone.behind).toFixed(2)}`,
  );
  const shares = moved.map((x) => x.toFixed(4)).join(', ');
  assert.ok(moved[0] > 0.01 && moved[1] > 0.01, `wind moves it: ${shares}`);
  // Leaves as instances sway as their foot does, those of a mesh each vertex for itself: all but the same.
  assert.ok(moved[2] < 0.25 * moved[1] && moved[3] < 0.002, `the same in all ways to draw it: ${shares}`);
  console.log(
    `plain three.js: drawn, ${seen.colours} colours; pixels that wind moves, instances, copies: ${shares}`,
  );
  await page.close();
  plain.close();

  const folder = react();
  const built = await serve(folder);
  assert.ok(
    readdirSync(join(folder, 'assets')).some((f) => f.startsWith('worker')),
    'Vite found the worker',
  );
  const second = await open(`${built.url}/?detail=0.15`);
  await second.waitForTimeout(2000);
  assert.equal(second.workers().length, 1);
  const fiber = await look(second, 'react');
  assert.ok(fiber.colours > 60 && fiber.dark > 0.05, JSON.stringify(fiber));
  console.log(`react-three-fiber: drawn, ${fiber.colours} colours`);
  built.close();
  assert.deepEqual(faults, []);
} finally {
  await browser.close();
}
