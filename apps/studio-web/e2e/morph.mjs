// node e2e/morph.mjs CHROMIUM BURGEON OUT : the animation of an opening flower (`burgeon bloom run`) plays in three.js.
// Loaded by GLTFLoader, played by AnimationMixer; vertices must move as the file says, on and on through the keys.
// A picture of five moments goes to OUT.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { chromium } from 'playwright-core';
import { FLAGS } from './flags.mjs';

const [browserPath, burgeon, out] = process.argv.slice(2);
rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
const FRAMES = 9;
const SECONDS = 4;
for (const flower of ['tulip', 'lily']) {
  execFileSync(burgeon, [
    'bloom',
    'run',
    flower,
    '-o',
    join(out, `${flower}.glb`),
    '--frames',
    String(FRAMES),
    '--seconds',
    String(SECONDS),
    '--quiet',
  ]);
}

/** Farthest that a vertex is from where the file's last key says, and the positions of a few at some moments. */
const PAGE = `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><style>body{margin:0;background:#dde6ee}</style>
<script type="importmap">{"imports":{"three":"/three/build/three.module.js","three/addons/":"/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
renderer.setSize(240, 320);
window.play = async (file, moments) => {
  const gltf = await new GLTFLoader().loadAsync(file);
  const scene = new THREE.Scene();
  scene.add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x778866, 2.2));
  const sun = new THREE.DirectionalLight(0xffffff, 2);
  sun.position.set(1, 2, 2);
  scene.add(sun);
  const mixer = new THREE.AnimationMixer(gltf.scene);
  const action = mixer.clipAction(gltf.animations[0]);
  action.setLoop(THREE.LoopOnce).clampWhenFinished = true;
  action.play();
  const meshes = [];
  gltf.scene.traverse((o) => { if (o.isMesh) meshes.push(o); });
  const box = new THREE.Box3();
  const rows = (mesh, take) => {
    const v = new THREE.Vector3();
    const count = mesh.geometry.attributes.position.count;
    return Array.from({ length: count }, (_, i) => { mesh.getVertexPosition(i, v); return take(v, i); });
  };
  const told = [];
  for (const t of moments) {
    mixer.setTime(t);
    // What the file says at this moment: base and target of the nearest key; at one key the base itself is seen.
    const { times, values } = gltf.animations[0].tracks[0];
    const wanted = Math.round((t / gltf.animations[0].duration) * (times.length - 1));
    let far = 0;
    const places = [];
    for (const mesh of meshes) {
      const { position } = mesh.geometry.attributes;
      const targets = mesh.geometry.morphAttributes.position ?? [];
      const target = targets[values.slice(wanted * targets.length, (wanted + 1) * targets.length).indexOf(1)];
      rows(mesh, (v, i) => {
        box.expandByPoint(v);
        const at = (k) => position.getComponent(i, k) + (target ? target.getComponent(i, k) : 0);
        far = Math.max(far, Math.hypot(v.x - at(0), v.y - at(1), v.z - at(2)));
        if (i % 97 === 0) places.push([v.x, v.y, v.z]);
      });
    }
    told.push({ t, far, places });
  }
  const middle = box.getCenter(new THREE.Vector3());
  const size = box.getSize(new THREE.Vector3());
  const camera = new THREE.PerspectiveCamera(30, 240 / 320, 0.001, 10);
  camera.position.copy(middle).add(new THREE.Vector3(0.35, 0.3, 1).multiplyScalar(1.9 * Math.max(size.y, size.x)));
  camera.lookAt(middle);
  // At its end the action stopped.
  action.reset().play();
  const drawn = new Set();
  for (const t of moments) {
    mixer.setTime(t);
    renderer.render(scene, camera);
    const picture = new Image();
    picture.src = renderer.domElement.toDataURL();
    await picture.decode();
    drawn.add(picture.src);
    document.body.append(picture);
  }
  return { told, pictures: drawn.size, meshes: meshes.length, vertices: meshes.reduce((n, m) => n + m.geometry.attributes.position.count, 0),
    tracks: gltf.animations[0].tracks.length, seconds: gltf.animations[0].duration, size: size.toArray() };
};
document.body.dataset.ready = 'true';
</script><body>`;

const TYPES = { '.js': 'text/javascript', '.glb': 'model/gltf-binary' };
const server = createServer((request, response) => {
  const path = normalize(new URL(request.url, 'http://x').pathname);
  const file = path.startsWith('/three/') ? join('node_modules', path) : join(out, path);
  if (path === '/') return response.writeHead(200, { 'content-type': 'text/html' }).end(PAGE);
  if (!existsSync(file)) return response.writeHead(404).end();
  return response
    .writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'text/plain' })
    .end(readFileSync(file));
});
await new Promise((resolve) => {
  server.listen(0, '127.0.0.1', resolve);
});
const url = `http://127.0.0.1:${server.address().port}/`;
let failed = 0;
let browser;
try {
  browser = await chromium.launch({ executablePath: browserPath, args: FLAGS });
  for (const flower of ['tulip', 'lily']) {
    const page = await browser.newPage({ viewport: { width: 1200, height: 330 } });
    const troubles = [];
    page.on('pageerror', (e) => troubles.push(e.message));
    page.on('console', (m) => {
      if (m.type() === 'error') troubles.push(m.text());
    });
    await page.goto(url);
    await page.waitForFunction(() => document.body.dataset.ready === 'true', null, { timeout: 60_000 });
    const step = SECONDS / (FRAMES - 1);
    const moments = [0, 2, 4, 6, FRAMES - 1].map((k) => k * step);
    const got = await page.evaluate(([file, at]) => window.play(file, at), [`/${flower}.glb`, moments]);
    await page.screenshot({ path: join(out, `${flower}.png`) });
    assert.deepEqual(troubles, [], 'the page has no errors');
    assert.ok(Math.abs(got.seconds - SECONDS) < 1e-4, `the animation takes ${got.seconds} s`);
    assert.equal(got.tracks, got.meshes, 'each mesh has a track of weights');
    assert.equal(got.pictures, moments.length, 'each moment is another picture');
    const height = Math.max(...got.size);
    for (const { t, far } of got.told) {
      assert.ok(far < 1e-5 * height, `at ${t} s a vertex is ${far} m from where the file says`);
    }
    const moves = got.told
      .slice(1)
      .map(({ places }, k) =>
        Math.max(...places.map((p, i) => Math.hypot(...p.map((x, a) => x - got.told[k].places[i][a])))),
      );
    for (const [k, move] of moves.entries()) {
      assert.ok(move > 0.01 * height, `from ${moments[k]} to ${moments[k + 1]} s nothing moves (${move} m)`);
    }
    console.log(
      `ok      ${flower}: ${got.vertices} vertices of ${got.meshes} meshes, moves of ${moves.map((m) => `${(m * 1e3).toFixed(1)} mm`).join(', ')} in three.js`,
    );
    await page.close();
  }
} catch (e) {
  failed = 1;
  console.log(`FAILED  a morph animation in three.js: ${e.message}`);
} finally {
  await browser?.close();
  server.close();
}
process.exit(failed);
