// Plants shown: the stage, the camera, pictures and films.
import assert from 'node:assert/strict';
import { readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { inflateRawSync } from 'node:zlib';
import { add, begin, changed, count, exported, sample, settled, until } from './journeys.mjs';
import {
  answered,
  becomes,
  eventually,
  finished,
  loaded,
  pictures,
  reloaded,
  rested,
  restingEye,
  saved,
  stored,
  take,
} from './waits.mjs';

/** The pixels of a part of a picture file, four bytes each, and the size of the whole; shares of its width and height. */
export async function pixels(page, bytes, [x0, y0, x1, y1] = [0, 0, 1, 1]) {
  const { rgba, ...sizes } = await page.evaluate(
    async ([base64, a, b, c, d]) => {
      const raw = Uint8Array.from(atob(base64), (ch) => ch.charCodeAt(0));
      const image = await createImageBitmap(new Blob([raw]));
      const canvas = new OffscreenCanvas(image.width, image.height);
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      const [width, height] = [image.width, image.height];
      const box = [a * width, b * height, Math.max(1, (c - a) * width), Math.max(1, (d - b) * height)];
      const part = context.getImageData(...box.map(Math.floor));
      let text = '';
      for (let i = 0; i < part.data.length; i += 4096)
        text += String.fromCharCode(...part.data.subarray(i, i + 4096));
      return { rgba: btoa(text), across: part.width, width, height };
    },
    [bytes.toString('base64'), x0, y0, x1, y1],
  );
  return { p: Buffer.from(rgba, 'base64'), ...sizes };
}

/** Mean red, green, blue (0 to 255) and smallest alpha of a part of a picture file, and its size. */
export async function mean(page, bytes, part) {
  const { p, width, height } = await pixels(page, bytes, part);
  const sum = [0, 0, 0];
  let alpha = 255;
  for (let i = 0; i < p.length; i += 4) {
    for (let k = 0; k < 3; k += 1) sum[k] += p[i + k];
    alpha = Math.min(alpha, p[i + 3]);
  }
  return { rgb: sum.map((s) => (4 * s) / p.length), alpha, width, height };
}

/** What is to be seen, when nothing more is coming. */
async function seen(page, part) {
  await rested(page);
  return mean(page, await page.locator('.view canvas').screenshot(), part);
}
const luma = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
const apart = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

/** How much neighbouring pixels of a part of the view differ, 0 to 255. */
async function edges(page, part) {
  await rested(page);
  const { p, across } = await pixels(page, await page.locator('.view canvas').screenshot(), part);
  let sum = 0;
  for (let i = 0; i + 4 * across < p.length; i += 4)
    sum += Math.abs(p[i] - p[i + 4]) + Math.abs(p[i] - p[i + 4 * across]);
  return (2 * sum) / p.length;
}

/** Far ground fades into fog, and what is out of focus has no edges. */
async function air({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  await page.keyboard.press('t');
  await page.click('[data-preset-stage=noon]');
  await page.locator('[data-preset-stage=noon][aria-pressed=true]').waitFor();
  // The panel lies over the view: it is closed while the view is looked at.
  const set = async (key, value) => {
    if ((await page.locator('.scenery').count()) === 0) await page.keyboard.press('t');
    await page.locator(`[data-stage="stage.${key}"]`).evaluate((e, v) => {
      e.value = v;
      e.dispatchEvent(new Event('input', { bubbles: true }));
      e.dispatchEvent(new Event('change', { bubbles: true }));
    }, String(value));
    await page.keyboard.press('Escape');
  };
  await set('fog', 0);
  // Where the ground is far away, beside the plant.
  const far = [0.02, 0.66, 0.3, 0.78];
  const clear = [(await seen(page, far)).rgb, await edges(page, far)];
  await set('fog', 1);
  const fogged = [(await seen(page, far)).rgb, await edges(page, far)];
  await shot('stage-fog');
  assert.ok(apart(clear[0], fogged[0]) > 6, `${clear[0]} and ${fogged[0]}`);
  assert.ok(fogged[1] < 0.7 * clear[1], `fog hides the ground: ${fogged[1]} of ${clear[1]}`);
  await set('fog', 0);
  await set('blur', 1);
  // What blurs is loaded when it is first asked for.
  await eventually(
    () => edges(page, far),
    (blurred) => blurred < 0.7 * clear[1],
    `it is out of focus: of ${clear[1]}`,
  );
  await shot('stage-blur');
}

export async function palette(page, id) {
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').waitFor();
  await page.click(`#p-${id}`);
}

async function stage({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  const preset = (name) => page.click(`[data-preset-stage=${name}]`);
  await page.keyboard.press('t');
  await page.locator('[data-preset-stage=studio][aria-pressed=true]').waitFor();
  // The panel lies over the view: it is closed while the view is looked at.
  const look = async (part) => {
    await page.keyboard.press('Escape');
    const { rgb } = await seen(page, part);
    await page.keyboard.press('t');
    await page.locator('.scenery').waitFor();
    return rgb;
  };
  const [all, sky, foot] = [
    [0.1, 0.15, 0.85, 0.98],
    [0.4, 0.01, 0.8, 0.05],
    [0.1, 0.92, 0.85, 0.98],
  ];
  const looks = {};
  for (const name of ['studio', 'noon', 'golden', 'overcast', 'night']) {
    await preset(name);
    await page.locator(`[data-preset-stage=${name}][aria-pressed=true]`).waitFor();
    await page.keyboard.press('Escape');
    await rested(page);
    const picture = await page.locator('.view canvas').screenshot();
    looks[name] = {};
    for (const [part, box] of Object.entries({ all, sky, foot }))
      looks[name][part] = (await mean(page, picture, box)).rgb;
    await shot(`stage-${name}`);
    await page.keyboard.press('t');
  }
  const names = Object.keys(looks);
  for (const a of names)
    for (const b of names)
      if (a < b) assert.ok(apart(looks[a].all, looks[b].all) > 6, `${a} and ${b} look alike`);
  const { studio, noon, golden, overcast, night } = looks;
  assert.ok(luma(night.all) < 0.5 * luma(noon.all), 'night is darker than noon');
  assert.ok(luma(night.all) > 8, 'night can be read');
  assert.ok(noon.sky[2] > noon.sky[0] + 10, 'the sky at noon is blue');
  assert.ok(golden.foot[0] / golden.foot[2] > noon.foot[0] / noon.foot[2], 'golden light is warm');
  assert.ok(luma(golden.foot) > 0.85 * luma(noon.foot), 'grass stands upright: a low sun lights it too');
  assert.ok(Math.max(...overcast.sky) - Math.min(...overcast.sky) < 22, 'clouds are grey');
  for (const { foot: f } of [noon, golden, overcast]) assert.ok(f[1] > f[2] + 8, `grass is green: ${f}`);
  assert.ok(studio.foot[1] - studio.foot[2] < 40, 'the studio has no grass');
  // By hand: soil, a colour, a picture.
  await preset('noon');
  await page.selectOption('[data-stage=ground]', 'soil');
  const soil = await look(foot);
  assert.ok(soil[0] > soil[1] && soil[1] > soil[2], `soil is brown: ${soil}`);
  await shot('stage-soil');
  await page.selectOption('[data-stage=background]', 'colour');
  await page.locator('[data-stage=colour]').fill('#3366cc');
  await page.selectOption('[data-stage=ground]', 'none');
  const painted = await look(sky);
  assert.ok(apart(painted, [0x33, 0x66, 0xcc]) < 4, `the colour behind is the one chosen: ${painted}`);
  await page.selectOption('[data-stage=background]', 'picture');
  const chooser = page.waitForEvent('filechooser');
  await page.click('.scenery .link');
  const red = Buffer.from(
    'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8DwHwAFBQIAX8jx0gAAAABJRU5ErkJggg==',
    'base64',
  );
  await (await chooser).setFiles({ name: 'red.png', mimeType: 'image/png', buffer: red });
  // It is read first.
  const behind = await eventually(
    () => look(sky),
    ([r, g]) => r > 180 && g < 60,
    'a picture stands behind',
  );
  // Another quality: more is drawn, and it is told.
  assert.equal(await page.locator('.view').getAttribute('data-quality'), 'fast', 'no graphics card here');
  await page.selectOption('[data-stage=quality]', 'fine');
  await page.locator('.view[data-quality=fine]').waitFor();
  await loaded(page, 'post');
  const like = (rgb) => apart(rgb, behind) < 6;
  await eventually(() => look(sky), like, `the picture keeps its colours: ${behind}`);
  await page.selectOption('[data-stage=quality]', 'auto');
  await backdropKept(page);
  await reloaded(page);
  await eventually(async () => (await seen(page, sky)).rgb, like, `the stage is remembered: ${behind}`);
}

/** Where a point of the world is on the screen, pixels from the middle, for the camera as the page tells it. */
export function frameOf({ position, target, lens, shift: [rightwards, upwards] }, height) {
  const sub = (a, b) => a.map((x, i) => x - b[i]);
  const dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
  const unit = (a) => a.map((x) => x / Math.hypot(...a));
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const ahead = unit(sub(target, position));
  const right = unit(cross(ahead, [0, 1, 0]));
  const up = cross(right, ahead);
  const k = height / 2 / Math.tan((lens * Math.PI) / 360);
  return {
    to: (p) => {
      const v = sub(p, position);
      const depth = dot(v, ahead);
      return [(k * dot(v, right)) / depth + rightwards, (-k * dot(v, up)) / depth - upwards];
    },
    at: (x, y) => {
      const depth = Math.hypot(...sub(target, position));
      const [across, down] = [(x - rightwards) / k, (y + upwards) / k];
      return position.map((p, i) => p + depth * (ahead[i] + across * right[i] - down * up[i]));
    },
  };
}

async function camera({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  const before = await restingEye(page);
  const box = await page.locator('.view').boundingBox();
  const [dx, dy] = [70, -110];
  await page.mouse.move(box.x + box.width / 2 + dx, box.y + box.height / 2 + dy);
  const point = frameOf(before, box.height).at(dx, dy);
  for (let k = 0; k < 4; k += 1) {
    await page.mouse.wheel(0, -240);
    await pictures(page);
  }
  const near = await restingEye(page);
  const size = ({ position, target }) => Math.hypot(...position.map((p, i) => p - target[i]));
  assert.ok(size(near) < 0.8 * size(before), 'the wheel came nearer');
  const [x, y] = frameOf(near, box.height).to(point);
  assert.ok(Math.hypot(x - dx, y - dy) < 2.5, `the point stays under the pointer: ${x}, ${y}`);
  // Nobody is lost: however far it is dragged, the plants are near.
  for (let k = 0; k < 12; k += 1) {
    await page.mouse.down({ button: 'right' });
    await page.mouse.move(box.x + 30, box.y + 300, { steps: 3 });
    await page.mouse.up({ button: 'right' });
    await page.mouse.move(box.x + box.width - 90, box.y + 300);
  }
  const far = await restingEye(page);
  assert.ok(Math.hypot(far.target[0], far.target[1] - 0.48, far.target[2]) < 3.01, `${far.target}`);
  await page.keyboard.press('f');
  const focused = await restingEye(page);
  assert.ok(Math.abs(focused.target[0]) < 0.3 && Math.abs(focused.target[2]) < 0.3, 'F comes back');
  for (const [side, axis, sign] of [
    ['left', 0, -1],
    ['right', 0, 1],
    ['back', 2, -1],
    ['top', 1, 1],
    ['bottom', 1, -1],
    ['front', 2, 1],
  ]) {
    await palette(page, `side-${side}`);
    const { position, target } = await restingEye(page);
    const arm = position.map((p, i) => p - target[i]);
    assert.ok(sign * arm[axis] > 0.95 * Math.hypot(...arm), `${side}: ${arm}`);
  }
  // The lens: another angle, the same size.
  await page.keyboard.press('c');
  const wide = await restingEye(page);
  const lens = page.locator('[data-stage="camera.lens"]');
  await lens.evaluate((e) => {
    e.value = '60';
    e.dispatchEvent(new Event('input', { bubbles: true }));
  });
  const narrow = await restingEye(page);
  const seenHeight = (e) => size(e) * Math.tan((e.lens * Math.PI) / 360);
  assert.equal(narrow.lens, 60);
  assert.ok(Math.abs(seenHeight(narrow) / seenHeight(wide) - 1) < 0.02, 'what is looked at keeps its size');
  // A camera that is kept, also over a new start of the page.
  await page.click('[data-camera=keep]');
  const kept = await restingEye(page);
  await page.click('[data-side=left]');
  await rested(page);
  await page.click('[data-camera="1"]');
  assert.deepEqual(await restingEye(page), kept);
  await page.click('[data-guide=figure]');
  await page.click('[data-guide=staff]');
  await page.click('[data-guide=grid]');
  await page.keyboard.press('Escape');
  await palette(page, 'frame');
  await rested(page);
  await shot('guides');
  await reloaded(page);
  await rested(page);
  await page.keyboard.press('c');
  await page.locator('[data-guide=figure][aria-pressed=true]').waitFor();
  await page.click('[data-camera="1"]');
  assert.deepEqual((await restingEye(page)).position, kept.position, 'kept in the browser');
  await page.keyboard.press('Escape');
  // On foot.
  await page.keyboard.press('n');
  await page.waitForFunction(() => document.body.dataset.walk === 'walk');
  const from = await restingEye(page);
  // The key is held until there is something to be seen of it.
  const held = async (key, went, what) => {
    await page.keyboard.down(key);
    await eventually(
      async () => JSON.parse(await page.locator('.view').getAttribute('data-eye')),
      went,
      what,
    );
    await page.keyboard.up(key);
    return restingEye(page);
  };
  const away = ({ position }) => size({ position: from.position, target: position });
  const to = await held('w', (eye) => away(eye) > 0.1, 'W walks');
  assert.equal(to.position[1], from.position[1], 'on the ground');
  assert.equal(await page.locator('#b-wire').getAttribute('aria-pressed'), 'false', 'W is the walker’s');
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.body.dataset.walk === '');
  // In flight, E rises.
  await page.keyboard.press('Shift+N');
  await page.waitForFunction(() => document.body.dataset.walk === 'fly');
  await held('e', ({ position }) => position[1] > to.position[1] + 0.05, `it is above ${to.position[1]}`);
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.body.dataset.walk === '');
  await palette(page, 'frame');
  await rested(page);
}

/** Fills the dialogue for pictures and films, and starts. */
async function film(page, wanted) {
  await page.keyboard.press('o');
  await page.locator('[data-film=shot]').waitFor();
  for (const [key, value] of Object.entries(wanted)) {
    const field = page.locator(`[data-film=${key}]`);
    if (typeof value === 'boolean') await field.setChecked(value);
    else if (typeof value === 'number') await field.fill(String(value));
    else await field.selectOption(value);
  }
  await page.click('#b-film-go');
}

export async function filmed(page, wanted) {
  const [download] = await Promise.all([page.waitForEvent('download'), film(page, wanted)]);
  await page.locator('dialog').waitFor({ state: 'detached' });
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

async function picture({ page, url, out }) {
  await begin(page, url);
  await sample(page);
  await rested(page);
  const { name, bytes } = await filmed(page, {
    shot: 'picture',
    width: 3000,
    height: 2000,
    transparent: true,
  });
  assert.match(name, /\.png$/);
  const corner = await mean(page, bytes, [0, 0, 0.02, 0.02]);
  assert.deepEqual([corner.width, corner.height], [3000, 2000]);
  assert.equal(corner.alpha, 0, 'the corner is clear');
  const stem = await mean(page, bytes, [0.3, 0.05, 0.7, 0.95]);
  assert.ok(
    stem.rgb.some((c) => c > 4),
    'the plant is there',
  );
  const solid = await filmed(page, { shot: 'picture', width: 700, height: 1900, transparent: false });
  const opaque = await mean(page, solid.bytes);
  assert.deepEqual([opaque.width, opaque.height, opaque.alpha], [700, 1900, 255]);
  // What the screen shows and what a picture of its shape holds have the same colours.
  const { width, height } = await page.locator('.view').boundingBox();
  const size = { width: Math.round(width), height: Math.round(height) };
  for (const preset of ['studio', 'noon']) {
    await palette(page, `stage-${preset}`);
    await rested(page);
    const same = await filmed(page, { shot: 'picture', ...size, transparent: false });
    writeFileSync(join(out, `picture-${preset}.png`), same.bytes);
    for (const part of [
      [0.3, 0, 0.6, 0.04],
      [0.1, 0.52, 0.3, 0.6],
      [0.3, 0.9, 0.6, 0.98],
      [0.35, 0.3, 0.65, 0.7],
    ]) {
      const [kept, shown] = [(await mean(page, same.bytes, part)).rgb, (await seen(page, part)).rgb];
      assert.ok(apart(kept, shown) < 14, `${preset} ${part}: ${kept} as ${shown}`);
    }
  }
  writeFileSync(join(out, 'picture-clear.png'), bytes);
}

/** How long a film is and whether its frames differ, as a player sees it. */
async function played(context, bytes, type) {
  const player = await context.newPage();
  try {
    return await player.evaluate(
      async ([base64, mime]) => {
        const raw = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
        const video = document.createElement('video');
        video.muted = true;
        video.src = URL.createObjectURL(new Blob([raw], { type: mime }));
        const on = (name) =>
          new Promise((resolve, reject) => {
            video.addEventListener(name, resolve, { once: true });
            video.addEventListener('error', () => reject(new Error(video.error?.message)), { once: true });
          });
        await on('loadeddata');
        const canvas = new OffscreenCanvas(video.videoWidth, video.videoHeight);
        const context = canvas.getContext('2d', { willReadFrequently: true });
        const drawn = () => {
          context.drawImage(video, 0, 0);
          return context.getImageData(0, 0, canvas.width, canvas.height).data;
        };
        const unlike = (a, b) => {
          let count = 0;
          for (let i = 0; i < a.length; i += 4) if (Math.abs(a[i] - b[i]) > 24) count += 1;
          return count;
        };
        // A slow player says that it has gone there before its picture is another: looked at until it is.
        const look = async (time, before) => {
          video.currentTime = time;
          await on('seeked');
          const began = performance.now();
          while (unlike(drawn(), before) <= 100 && performance.now() - began < 20_000)
            await new Promise((next) => {
              setTimeout(next, 50);
            });
          return drawn();
        };
        const first = await look(0.01, new Uint8ClampedArray(4 * canvas.width * canvas.height));
        const later = await look(video.duration / 4, first);
        const differ = unlike(first, later);
        return { duration: video.duration, width: video.videoWidth, height: video.videoHeight, differ };
      },
      [bytes.toString('base64'), type],
    );
  } finally {
    await player.close();
  }
}

async function films({ page, url, context }) {
  await begin(page, url);
  await add(page, 'flower');
  await until(page, 'triangles', ['above', 200], 'a lily');
  const digest = await settled(page);
  await rested(page);
  const undo = await page.locator('#b-undo').getAttribute('title');
  for (const [format, type] of [
    ['webm', 'video/webm'],
    ['mp4', 'video/mp4'],
  ]) {
    const wanted = { shot: 'turn', format, width: 320, height: 240, seconds: 2, fps: 6 };
    const { name, bytes } = await filmed(page, wanted);
    assert.ok(name.endsWith(`.${format}`), name);
    const film = await played(context, bytes, type);
    assert.deepEqual([film.width, film.height], [320, 240]);
    assert.ok(Math.abs(film.duration - 2) < 0.2, `${format} lasts ${film.duration} s`);
    assert.ok(film.differ > 100, `${format}: the camera goes round (${film.differ})`);
  }
  const sheet = await filmed(page, {
    shot: 'growth',
    format: 'sheet',
    width: 160,
    height: 200,
    seconds: 1,
    fps: 6,
    transparent: true,
  });
  assert.match(sheet.name, /-3x2\.png$/);
  const [bud, open] = [
    await mean(page, sheet.bytes, [0, 0, 1 / 3, 0.5]),
    await mean(page, sheet.bytes, [0, 0.5, 1 / 3, 1]),
  ];
  assert.deepEqual([bud.width, bud.height, bud.alpha], [480, 400, 0]);
  assert.ok(apart(bud.rgb, open.rgb) > 2, 'the flower opens');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  const step = () => page.locator('#b-undo').getAttribute('title');
  await becomes(step, undo, 'what is left to undo');
  // Stopped: nothing is written, and the plant is as it was.
  const files = [];
  page.on('download', (d) => files.push(d.suggestedFilename()));
  await film(page, { shot: 'growth', format: 'webm', width: 320, height: 240, seconds: 30, fps: 25 });
  await page.waitForFunction(() => (document.querySelector('.filming progress')?.value ?? 0) > 0);
  await page.click('#b-film-stop');
  await page.locator('.note', { hasText: 'Nothing was written' }).waitFor();
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  await settled(page);
  await becomes(step, undo, 'what is left to undo');
  assert.equal(await count(page, 'plants'), 1);
  // Whatever had been written would come before this.
  const next = page.waitForEvent('download');
  await page.click('#b-save');
  await next;
  assert.equal(files.length, 1, files.join());
}

/** What a binary glTF file holds: triangles, vertices and meshes that are drawn; bytes of its meshes. */
function heldBy(glb) {
  const length = glb.readUInt32LE(12);
  const file = JSON.parse(glb.subarray(20, 20 + length).toString());
  const held = { triangles: 0, vertices: 0, draws: 0, bytes: 0 };
  for (const { mesh } of file.nodes.filter((n) => n.mesh !== undefined)) {
    const [{ attributes, indices }] = file.meshes[mesh].primitives;
    held.triangles += file.accessors[indices].count / 3;
    held.vertices += file.accessors[attributes.POSITION].count;
    held.draws += 1;
  }
  for (const { target, byteLength } of file.bufferViews) if (target) held.bytes += byteLength;
  return held;
}

/** A file of a zip, by its name. */
export function unzipped(zip, name) {
  const end = zip.lastIndexOf('PK\x05\x06', undefined, 'latin1');
  for (let at = zip.readUInt32LE(end + 16); zip.readUInt32LE(at) === 0x02014b50; ) {
    const [nameLength, extra, comment] = [28, 30, 32].map((k) => zip.readUInt16LE(at + k));
    if (zip.subarray(at + 46, at + 46 + nameLength).toString() === name) {
      const local = zip.readUInt32LE(at + 42);
      const from = local + 30 + zip.readUInt16LE(local + 26) + zip.readUInt16LE(local + 28);
      const bytes = zip.subarray(from, from + zip.readUInt32LE(at + 20));
      return zip.readUInt16LE(at + 10) === 0 ? bytes : inflateRawSync(bytes);
    }
    at += 46 + nameLength + extra + comment;
  }
  throw new Error(`no ${name} in the zip`);
}

/** Waits until what is asked for is seen, and says the figures. */
export async function lookedAt(page) {
  await answered(page);
  await page.waitForFunction(() => {
    const panel = document.querySelector('#b-exportview')?.dataset;
    const { dataset } = document.body;
    const seen = panel?.shown !== undefined && panel.wanted === panel.shown;
    return seen && dataset.wanted === dataset.revision;
  });
  return page.evaluate(() => {
    const of = (row) =>
      Object.fromEntries(
        [...row.querySelectorAll('[data-figure]')].map((c) => [c.dataset.figure, Number(c.dataset.value)]),
      );
    const rows = [...document.querySelectorAll('#b-exportview tr[data-part]')];
    const { seen } = document.querySelector('#b-exportview').dataset;
    const file = document.querySelector('#b-exportview [data-figure=file]').dataset.value;
    const written = document.querySelector('#b-exportview [data-figure=written]')?.dataset.value;
    return {
      parts: Object.fromEntries(rows.map((r) => [r.dataset.part, of(r)])),
      seen: Number(seen),
      file: Number(file),
      written: written && Number(written),
    };
  });
}

async function slide(page, key, value) {
  await page.locator(`[data-exported=${key}]`).evaluate((e, v) => {
    e.value = v;
    e.dispatchEvent(new Event('input', { bubbles: true }));
  }, String(value));
}

/** The same where nothing is to move: not before the view has come to rest. */
async function stirs(page, part) {
  await finished(page);
  return sways(page, part);
}

/** How far the pictures of two moments are apart, of a part of the view. */
async function sways(page, part) {
  // Notes lie over it, and go by themselves.
  await page.evaluate(() => {
    for (const note of document.querySelectorAll('.note')) note.remove();
  });
  const a = await page.locator('.view canvas').screenshot();
  await page.waitForTimeout(1300);
  const b = await page.locator('.view canvas').screenshot();
  const [{ p }, { p: q }] = [await pixels(page, a, part), await pixels(page, b, part)];
  let differ = 0;
  for (let i = 0; i < p.length; i += 4)
    if (Math.abs(p[i] - q[i]) + Math.abs(p[i + 1] - q[i + 1]) > 40) differ += 1;
  return differ;
}

async function preview({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  await settled(page);
  await palette(page, 'export-view');
  await page.locator('#b-exportview').waitFor();
  // As it is shown: the figures are those of the file.
  const whole = await lookedAt(page);
  const glb = await exported(page, 'glb', 1, undefined, false);
  const { bytes: geometry, ...counts } = heldBy(glb.bytes);
  const { triangles, vertices, draws, bytes } = whole.parts.all;
  assert.deepEqual({ triangles, vertices, draws, bytes }, { ...counts, bytes: geometry });
  assert.equal(whole.file, glb.bytes.length, 'the size of the file was counted');
  assert.equal(whole.seen, triangles, 'the view shows what is counted');
  assert.ok(whole.parts.petal.triangles > 0 && whole.parts.leaf.triangles > 0, JSON.stringify(whole.parts));
  // Still, then in the wind.
  await rested(page);
  const [crown, foot] = [
    [0.1, 0.1, 0.85, 0.7],
    [0.1, 0.88, 0.85, 1],
  ];
  assert.equal(await stirs(page, crown), 0, 'nothing moves without wind');
  await slide(page, 'wind', 1);
  const windy = await lookedAt(page);
  assert.ok(windy.file > whole.file, 'wind takes room in the file');
  await eventually(
    () => sways(page, crown),
    (differ) => differ > 300,
    'the flower sways',
  );
  assert.ok((await sways(page, foot)) < 60, 'its foot stands');
  await shot('export-wind');
  const blown = await exported(page, 'glb', 1, undefined, true);
  assert.equal(windy.parts.all.bytes, heldBy(blown.bytes).bytes, 'what wind takes is counted');
  // Coarser: fewer triangles are shown and told, and the file of that level holds as many.
  await slide(page, 'level', 2);
  const coarse = await lookedAt(page);
  assert.ok(coarse.seen < 0.6 * windy.seen, `${coarse.seen} of ${windy.seen} triangles`);
  assert.equal(coarse.seen, coarse.parts.all.triangles);
  const levels = await exported(page, 'glb', 3, undefined, true);
  const level = unzipped(levels.bytes, 'plant_LOD2.glb');
  assert.equal(coarse.parts.all.triangles, heldBy(level).triangles);
  assert.equal(coarse.file, level.length);
  await becomes(() => page.inputValue('#b-exported-levels'), '3', 'what is looked at and written');
  assert.equal(coarse.written, levels.bytes.length, 'all levels together');
  // All in one file, with views from all sides.
  await page.check('#b-exported-impostor');
  await page.selectOption('#b-exported-files', 'one');
  const joined = await lookedAt(page);
  // Those views are seen, too, on four triangles.
  await slide(page, 'level', 4);
  const afar = await lookedAt(page);
  assert.deepEqual([afar.parts.all.triangles, afar.seen], [4, 4]);
  assert.ok(afar.file > 100_000 && afar.file < joined.written, 'they are a part of what is written');
  await shot('export-afar');
  await page.click('#b-exportview-go');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#b-export-go')]);
  const { size } = statSync(await download.path());
  assert.match(download.suggestedFilename(), /\.glb$/, 'one file');
  assert.equal(joined.written, size, 'levels and views in one file');
  // Fewer levels are written than was looked at: the coarsest of them is shown.
  await page.uncheck('#b-exported-impostor');
  await page.selectOption('#b-exported-levels', '1');
  await lookedAt(page);
  await becomes(() => page.inputValue('[data-exported=level]'), '0', 'the level');
  // Formats without wind say so; a zip is counted as one.
  await page.selectOption('[data-exported=format]', 'obj');
  await slide(page, 'level', 0);
  const obj = await lookedAt(page);
  await page.locator('[data-exported=wind]:disabled').waitFor();
  const zip = await exported(page, 'obj', 1);
  assert.equal(obj.file, zip.bytes.length);
  assert.equal(obj.parts.all.triangles, triangles);
  await page.selectOption('[data-exported=format]', 'glb');
  await page.click('#b-exportview-close');
  await page.locator('#b-exportview').waitFor({ state: 'detached' });
  assert.equal(await stirs(page, crown), 0, 'the plant itself stands still');
}

async function scene({ page, url, shot }) {
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  await settled(page);
  const one = await count(page, 'triangles');
  await palette(page, 'export-view');
  const alone = await lookedAt(page);
  assert.equal(alone.parts.all.triangles, one);
  // The age is that of the tree's own panel, one step of undo.
  const age = page.locator('#b-exportview [data-path=age]');
  await age.evaluate((e) => {
    e.value = '3';
    e.dispatchEvent(new Event('input', { bubbles: true }));
    e.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await page.waitForFunction((n) => Number(document.body.dataset.triangles) < n, one);
  await settled(page);
  const young = await lookedAt(page);
  assert.equal(young.parts.all.triangles, await count(page, 'triangles'));
  await page.click('#b-undo');
  await page.waitForFunction((n) => Number(document.body.dataset.triangles) === n, one);
  await lookedAt(page);
  await becomes(() => age.count(), 1, 'sliders of the age, which is still lent,');
  // Less motion: the tree leans and does not sway.
  await slide(page, 'wind', 0);
  await lookedAt(page);
  await rested(page);
  const still = await page.locator('.view canvas').screenshot();
  await slide(page, 'wind', 1);
  await lookedAt(page);
  assert.equal(await stirs(page, [0.1, 0.1, 0.85, 0.9]), 0, 'less motion was asked for');
  const leans = await page.locator('.view canvas').screenshot();
  assert.ok(!leans.equals(still), 'it leans');
  await shot('export-calm');
  await page.click('#b-exportview-close');
  await page.locator('#b-maker [data-path=age]').waitFor({ state: 'attached' });
  // Copies are drawn twice and written once.
  await page.click('.scene .fold');
  await page.click('[id^=b-more-]');
  await page.click('.menu >> text=Duplicate');
  await until(page, 'plants', ['is', 2], 'a copy');
  await settled(page);
  await palette(page, 'export-view');
  await page.selectOption('[data-exported=what]', 'scene');
  await slide(page, 'wind', 0);
  const two = await lookedAt(page);
  assert.deepEqual([two.seen, two.parts.all.triangles], [2 * one, 2 * one]);
  assert.equal(two.parts.all.draws, 2 * alone.parts.all.draws);
  assert.equal(two.parts.all.bytes, alone.parts.all.bytes, 'its geometry is there once');
  assert.ok(two.file < alone.file + 4000, `${two.file} bytes of two, ${alone.file} of one`);
  const file = await exported(page, 'glb', 1, 'scene', false);
  assert.equal(two.file, file.bytes.length);
  await shot('export-copies');
}

/** A point of the view over which the pointer becomes this cursor; none if there is none. */
async function under(page, cursor) {
  const box = await page.locator('.view canvas').boundingBox();
  for (let k = 0; k < 260; k += 1) {
    const [x, y] = [
      box.x + box.width * (0.12 + (0.7 * (k % 20)) / 20),
      box.y + box.height * (0.2 + (0.7 * Math.floor(k / 20)) / 13),
    ];
    await page.mouse.move(x, y);
    const now = await page.locator('.view canvas').evaluate((e) => e.style.cursor);
    if (now === cursor) return [x, y];
  }
  return undefined;
}

/** Obstacles are dragged, and the tree grows when they are let go. */
async function obstacles({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  await settled(page);
  await page.click('[data-obstacle=ball]');
  await page.locator('[data-path=o0centre0]').waitFor();
  await settled(page);
  // It has a name of its own, and so has the next.
  const name = page.locator('[data-obstacle-name="0"]');
  await name.fill('Old well');
  await name.press('Enter');
  await settled(page);
  await page.click('[data-obstacle=ball]');
  await page.locator('[data-obstacle-name="1"]').waitFor();
  await settled(page);
  const names = await page.locator('[data-obstacle-name]').evaluateAll((all) => all.map((n) => n.value));
  assert.equal(names[0], 'Old well');
  assert.notEqual(names[1], names[0]);
  await page.keyboard.press('Escape');
  await page.click('#b-undo');
  await page.locator('[data-obstacle-name="1"]').waitFor({ state: 'detached' });
  await settled(page);
  // At the edge of the crown, so that most of it has no leaf before it.
  for (const [path, value] of [
    ['o0centre0', '1.9'],
    ['o0centre1', '1.2'],
  ]) {
    await page.locator(`[data-path=${path}]`).fill(value);
    await page.locator(`[data-path=${path}]`).press('Enter');
    await page.waitForFunction(
      ([p, v]) => document.querySelector(`[data-path=${p}]`)?.value === v,
      [path, value],
    );
    await settled(page);
  }
  await rested(page);
  const before = await settled(page);
  const centre = () =>
    page.evaluate(() =>
      [0, 1, 2].map((i) => Number(document.querySelector(`[data-path=o0centre${i}]`).value)),
    );
  const grip = await under(page, 'grab');
  assert.ok(grip, 'the ball can be taken');
  const [x, y] = grip;
  const drag = async (dx, dy) => {
    const eye = await restingEye(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + dx, y + dy, { steps: 5 });
    return eye;
  };
  // Escape takes it back.
  await drag(60, 0);
  await rested(page);
  await shot('obstacle-dragged');
  await page.keyboard.press('Escape');
  await page.mouse.up();
  assert.equal(await settled(page), before);
  assert.deepEqual(await centre(), [1.9, 1.2, 0], 'nothing was done');
  // Along the ground: the tree grows anew when it is let go, and not before.
  const eye = await drag(110, 0);
  const now = await restingEye(page);
  assert.equal(await settled(page), before, 'while it is dragged the tree stays');
  assert.ok(apart(now.position, eye.position) < 0.002, 'and the camera');
  await page.mouse.up();
  await page.waitForFunction((d) => document.body.dataset.digest !== d, before);
  const after = await settled(page);
  const [cx, cy] = await centre();
  assert.ok(cx > 2.3, `it went to the right: ${cx}`);
  assert.equal(cy, 1.2, 'along the ground');
  assert.notEqual(after, before, 'it is out of the way');
  await page.locator('#b-undo[title*="move an obstacle"]').waitFor();
  await shot('obstacle-let-go');
  await page.click('#b-undo');
  await page.waitForFunction((d) => document.body.dataset.digest === d, before);
  await becomes(centre, [1.9, 1.2, 0], 'after one step back its middle');
  // With Shift, up.
  await rested(page);
  const again = await under(page, 'grab');
  await page.mouse.move(...again);
  await page.keyboard.down('Shift');
  await page.mouse.down();
  await page.mouse.move(again[0] + 4, again[1] - 60, { steps: 5 });
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await page.waitForFunction(() => Number(document.querySelector('[data-path=o0centre1]').value) > 1.3);
  await settled(page);
  const up = await centre();
  assert.deepEqual([up[0], up[2]], [1.9, 0], 'straight up');
}

/** A plant whose place is locked stays there. */
async function fixed({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'flower');
  await settled(page);
  await page.click('.scene .fold');
  const place = () =>
    page.evaluate(() => ['nx', 'nz'].map((k) => document.querySelector(`[data-key=${k}]`).value));
  await page.keyboard.press('g');
  await page.click('#b-fix');
  await page.locator('#b-fix[aria-pressed=true]').waitFor();
  await shot('place-locked');
  for (const key of ['nx', 'nz', 'nyaw', 'nscale'])
    await page.locator(`[data-key=${key}]:disabled`).waitFor();
  await page.locator('[data-gizmo=translate]:disabled').waitFor();
  await page.locator('#b-undo[title*="lock the place"]').waitFor();
  const [was, undo] = [await place(), await page.locator('#b-undo').getAttribute('title')];
  await rested(page);
  const box = await page.locator('.view canvas').boundingBox();
  const pull = async () => {
    for (let k = 0; k < 60; k += 1) {
      const [px, py] = [
        box.x + box.width * 0.5 + 30 + 3 * (k % 20),
        box.y + box.height * (0.6 + 0.06 * Math.floor(k / 20)),
      ];
      await page.mouse.move(px, py);
      await page.mouse.down();
      await page.mouse.move(px + 60, py, { steps: 2 });
      await page.mouse.up();
      await page.mouse.move(px + 60, py);
    }
  };
  await pull();
  await settled(page);
  assert.deepEqual(await place(), was, 'the gizmo is gone');
  assert.equal(await page.locator('#b-undo').getAttribute('title'), undo);
  // It is kept, and can be unlocked.
  await saved(page);
  await reloaded(page);
  await settled(page);
  await page.click('.scene .fold');
  await page.locator('#b-fix[aria-pressed=true]').waitFor();
  await page.click('#b-fix');
  await page.locator('#b-fix[aria-pressed=false]').waitFor();
  await page.locator('[data-key=nx]:enabled').waitFor();
}

/** What is to note of a plant is read by one click, in both languages. */
async function warnings({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  const digest = await settled(page);
  assert.equal(await page.locator('#b-warnings').isVisible(), false, 'there is nothing to note');
  // A wall without a back: what is inside of it can only be guessed.
  const wall = 'v 1 0 -1\nv 1 3 -1\nv 1 3 1\nv 1 0 1\nf 1 2 3 4\n';
  const chooser = page.waitForEvent('filechooser');
  await page.click('[data-obstacle=file]');
  await (await chooser).setFiles({ name: 'wall.obj', mimeType: 'model/obj', buffer: Buffer.from(wall) });
  await changed(page, digest, 'a wall in its way');
  await page.locator('#b-warnings').click();
  const first = page.locator('.warnings li').first();
  const english = await first.textContent();
  assert.match(english, /\w+ \w+ \w+/);
  const box = await page.locator('.popover').boundingBox();
  const foot = await page.locator('#b-warnings').boundingBox();
  assert.ok(box.y + box.height <= foot.y, 'it stands above what was clicked');
  await shot('warnings');
  await page.keyboard.press('Escape');
  await palette(page, 'language');
  await page.waitForFunction(() => document.documentElement.lang === 'zh-Hans');
  await settled(page);
  await page.locator('#b-warnings').click();
  const chinese = await first.textContent();
  assert.match(chinese, /[\u4e00-\u9fff]{4}/);
  // What the obstacle is called stays as it is.
  assert.doesNotMatch(chinese.replace('wall', ''), /[a-z]{4}/);
  assert.deepEqual(chinese.match(/\d+/g), english.match(/\d+/g), 'with its numbers');
  await shot('warnings-zh');
}

/** A picture file (BMP) of reddish noise, which no compression makes small. */
function noise(width, height) {
  const pixels = Buffer.alloc(3 * width * height);
  let state = 1;
  for (let i = 0; i < pixels.length; i += 1) {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    // Blue, green, red: red is the brighter half.
    pixels[i] = (state >>> 25) + (i % 3 === 2 ? 128 : 0);
  }
  const head = Buffer.alloc(54);
  head.write('BM');
  head.writeUInt32LE(54 + pixels.length, 2);
  for (const [at, value] of [
    [10, 54],
    [14, 40],
    [18, width],
    [22, height],
  ])
    head.writeUInt32LE(value, at);
  head.writeUInt16LE(1, 26);
  head.writeUInt16LE(24, 28);
  return Buffer.concat([head, pixels]);
}

const backdropKept = (page) =>
  eventually(
    () => stored(page, 'pictures', 'getAllKeys'),
    (keys) => keys.includes('.backdrop'),
    'pictures that are kept',
  );

async function chooseBackdrop(page, buffer) {
  const chooser = page.waitForEvent('filechooser');
  await page.click('.scenery .link');
  await (await chooser).setFiles({ name: 'noise.bmp', mimeType: 'image/bmp', buffer });
}

/** What is removed from the stage comes back by a click; a picture too large for settings is kept, or it is told. */
async function keptStage({ page, url, shot }) {
  await page.addInitScript(() => {
    const { put } = IDBObjectStore.prototype;
    IDBObjectStore.prototype.put = function write(...rest) {
      // A storage that has no room for more than a document.
      if (sessionStorage.getItem('full') && rest[1] === '.backdrop')
        throw new DOMException('full', 'QuotaExceededError');
      return put.apply(this, rest);
    };
  });
  await begin(page, url);
  await sample(page);
  await page.keyboard.press('c');
  for (const side of ['front', 'left', 'back']) {
    await page.click(`[data-side=${side}]`);
    await rested(page);
    await page.click('[data-camera=keep]');
  }
  await page.click('[data-camera="2"]');
  const left = await restingEye(page);
  await page.click('[data-camera="3"]');
  const back = await restingEye(page);
  await page.click('[data-camera-drop="2"]');
  await page.waitForFunction(() => !document.querySelector('[data-camera="3"]'));
  await take(page, '', 'Undo');
  await page.locator('[data-camera="3"]').waitFor();
  await page.click('[data-camera="2"]');
  assert.deepEqual(await restingEye(page), left, 'the camera is in its place again');
  assert.notDeepEqual(left, back);
  await page.keyboard.press('Escape');
  await page.keyboard.press('t');
  await page.selectOption('[data-stage=background]', 'picture');
  await chooseBackdrop(page, noise(2600, 2000));
  const sky = [0.4, 0.01, 0.8, 0.05];
  const reddish = async (why) => {
    await page.keyboard.press('Escape');
    await eventually(
      async () => (await seen(page, sky)).rgb,
      ([r, , b]) => r > 160 && b < 110,
      why,
    );
  };
  await reddish('the picture stands behind');
  // It is kept after it is shown, or a note says that it is not.
  await backdropKept(page);
  assert.equal(await page.locator('.note.bad').count(), 0);
  await saved(page);
  await reloaded(page);
  await reddish('and after a reload');
  await shot('kept-backdrop');
  await page.evaluate(() => sessionStorage.setItem('full', 'yes'));
  await page.keyboard.press('t');
  await chooseBackdrop(page, noise(40, 40));
  await page.locator('.note.bad', { hasText: 'no room for the picture' }).waitFor();
}

export const staging = [
  ['warnings are read by one click', warnings],
  ['an obstacle is dragged and the tree grows when it is let go', obstacles],
  ['a plant whose place is locked stays', fixed],
  ['an export is seen before it is written: levels, wind, figures', preview],
  ['an export of a tree is seen at its age, and stands still for whom it should', scene],
  ['the stage: presets, ground, background, quality', stage],
  ['the stage: fog and what is out of focus', air],
  ['the stage keeps its cameras and its picture', keptStage],
  ['the camera: to the pointer, sides, lens, kept, on foot', camera],
  ['a picture of any size, with transparency', picture],
  ['films: round the plant, opening, stopped', films],
];
