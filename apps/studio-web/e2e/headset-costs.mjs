// What a headset costs, and how it looks into the room: drawn triangles, the first picture, memory of the loop.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import {
  SMALL,
  WIDE,
  carries,
  enter,
  find,
  frames,
  hand,
  key,
  press,
  state,
  stroke,
  way,
  wear,
} from './headset.mjs';
import { begin, changed, data, drop, settled, until } from './journeys.mjs';

/** The oak of the presets, of its own file. */
async function growOak(page) {
  await drop(
    page,
    'oak.toml',
    readFileSync(new URL('../../../crates/burgeon/presets/oak.toml', import.meta.url), 'utf8'),
  );
  await until(page, 'triangles', ['above', 150_000], 'an oak has grown');
}

/** A whole oak is drawn for both eyes within 300,000 triangles and 100 calls; out of the headset it is whole again. */
async function levels({ page, url, shot }) {
  await wear(page, 'metaQuest3');
  await begin(page, url);
  await growOak(page);
  const plain = await settled(page);
  // Two pictures, as a headset has them: what is counted is both.
  await page.evaluate(() => {
    window.device.stereoEnabled = true;
  });
  await page.locator('#b-headset').click();
  await page.waitForFunction(() => document.body.dataset.headset === 'on');
  await page.waitForFunction(() => {
    const { cost, frames: n } = JSON.parse(document.body.dataset.vr || '{}');
    return n > 3 && cost.triangles > 10_000 && cost.triangles <= 300_000;
  });
  await frames(page);
  const { cost, entry } = await state(page);
  console.log(
    `        ${cost.triangles} triangles and ${cost.calls} calls for both eyes; session after ${entry.session} ms, scene ` +
      `given after ${entry.ready} ms, first picture after ${entry.first} ms`,
  );
  assert.ok(cost.calls <= 100, `${cost.calls} calls`);
  assert.equal(await data(page, 'digest'), plain, 'the plant is the same one');
  await shot('headset-levels');
  // A branch of what is shown is carried, and nothing is made again.
  const at = await find(page, 'right');
  await press(page, 'right', 'squeeze', 1);
  await frames(page);
  await hand(page, 'right', [at[0] + 0.05, at[1] + 0.02, at[2]]);
  await carries(page);
  await press(page, 'right', 'squeeze', 0);
  await until(page, 'edits', ['is', 1], 'one edit');
  await changed(page, plain, 'it was turned');
}

/** What the card is given between the wish to go in and the first picture: nothing is translated, and little is sent. */
async function first({ page, url }) {
  await wear(page, 'metaQuest3');
  await page.addInitScript(() => {
    const counts = { programs: 0, textures: 0, pixels: 0, bytes: 0, draws: 0, triangles: 0 };
    window.counts = counts;
    window.pictures = [];
    const card = WebGL2RenderingContext.prototype;
    const count = (name, of) => {
      const plain = card[name];
      card[name] = function (...given) {
        of(...given);
        return plain.apply(this, given);
      };
    };
    const size = (data) => (typeof data === 'number' ? data : (data?.byteLength ?? 0));
    count('linkProgram', () => {
      counts.programs += 1;
    });
    count('texStorage2D', (_, _levels, _format, wide, high) => {
      counts.textures += 1;
      counts.pixels += wide * high;
    });
    count('bufferData', (_, data) => {
      counts.bytes += size(data);
    });
    count('bufferSubData', (_, _at, data, _from, length) => {
      counts.bytes += length ? length * data.BYTES_PER_ELEMENT : size(data);
    });
    for (const [name, corners] of [
      ['drawElements', (_, n) => n],
      ['drawElementsInstanced', (_, n, _type, _at, copies) => n * copies],
      ['drawArrays', (_, _first, n) => n],
    ])
      count(name, (...given) => {
        counts.draws += 1;
        if (given[0] === 4) counts.triangles += corners(...given) / 3;
      });
    const { requestAnimationFrame } = window.XRSession.prototype;
    window.XRSession.prototype.requestAnimationFrame = function (draw) {
      return requestAnimationFrame.call(this, (time, frame) => {
        const began = performance.now();
        draw(time, frame);
        if (window.pictures.length < 3) window.pictures.push({ ...counts, ms: performance.now() - began });
      });
    };
  });
  await begin(page, url);
  await growOak(page);
  await settled(page);
  await page.evaluate(() => {
    window.device.stereoEnabled = true;
  });
  // Until the page has nothing more to make ready.
  await page.waitForTimeout(4000);
  const before = await page.evaluate(() => ({ ...window.counts }));
  await page.locator('#b-headset').click();
  await page.waitForFunction(() => window.pictures.length > 1);
  await frames(page);
  const [drawn] = await page.evaluate(() => window.pictures);
  const { entry } = await state(page);
  const since = (what) => Math.round(drawn[what] - before[what]);
  console.log(
    `        ${since('programs')} programs, ${since('textures')} textures of ${since('pixels')} pixels, ` +
      `${since('bytes')} bytes of columns, ${since('draws')} calls and ${since('triangles')} triangles; asked for within ` +
      `${Math.round(drawn.ms)} ms; session after ${entry.session} ms, scene given after ${entry.ready} ms, first picture ` +
      `after ${entry.first} ms`,
  );
  assert.equal(since('programs'), 0, 'programs are translated before');
  // For both eyes and for shadows; the whole oak would be twice as many for the eyes alone.
  assert.ok(since('triangles') <= 400_000, 'coarser plants are there, and the page draws none meanwhile');
  assert.ok(since('bytes') < 1 << 24, 'no more than they take');
}

/** The room behind the plants: no sky and no ground, and the tools do what they do elsewhere. */
async function room({ page, url, shot }) {
  const plain = await enter(page, url, 'metaQuest3', 'pass-through');
  assert.equal(await page.evaluate(() => window.device.activeSession?.environmentBlendMode), 'alpha-blend');
  await shot('headset-room');
  // The emulator lays its pictures over the page: where nothing is drawn, a colour behind them is seen.
  await page.evaluate(() => {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(
      'html, body { background: #f0f } body * { visibility: hidden } canvas[role=img] { visibility: visible }',
    );
    document.adoptedStyleSheets = [sheet];
  });
  await frames(page);
  const seen = await page.screenshot();
  await page.evaluate(() => {
    document.adoptedStyleSheets = [];
  });
  const shares = await page.evaluate(async (png) => {
    const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
    const picture = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const pen = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data: pixels } = pen.getImageData(0, 0, picture.width, picture.height);
    let clear = 0;
    for (let i = 0; i < pixels.length; i += 4)
      clear += pixels[i] === 255 && pixels[i + 1] === 0 && pixels[i + 2] === 255 ? 1 : 0;
    return { clear: (4 * clear) / pixels.length };
  }, seen.toString('base64'));
  console.log(`        ${Math.round(100 * shares.clear)} % of the picture is the room`);
  assert.ok(shares.clear > 0.4 && shares.clear < 0.99, `${shares.clear} of the picture is clear`);
  const at = await find(page, 'right');
  await stroke(page, way(at, [0.012, 0.008, 0.006], 8), undefined, 'right', 'squeeze');
  await until(page, 'edits', ['is', 1], 'one edit');
  const turned = await changed(page, plain, 'a branch was turned');
  await key(page, 'leave', 'right', { last: true });
  await page.waitForFunction(() => document.body.dataset.headset === 'off');
  assert.equal(await data(page, 'digest'), turned);
  await page.waitForTimeout(700);
  await shot('headset-room-left');
}

const LOOP_MS = 25_000;

/** What pictures leave behind on the heap, collected or not, by the file whose code asked for it. */
async function heap(page, context, words) {
  const cdp = await context.newCDPSession(page);
  await cdp.send('HeapProfiler.enable');
  await cdp.send('HeapProfiler.collectGarbage');
  await cdp.send('HeapProfiler.startSampling', {
    samplingInterval: 512,
    includeObjectsCollectedByMajorGC: true,
    includeObjectsCollectedByMinorGC: true,
  });
  const { frames: from } = await state(page);
  // Nobody looks meanwhile: what is told to the test takes memory, too.
  await page.evaluate(() => {
    window.burgeonWatches = false;
  });
  await page.waitForTimeout(LOOP_MS);
  await page.evaluate(() => {
    window.burgeonWatches = true;
  });
  await page.waitForFunction((n) => JSON.parse(document.body.dataset.vr).frames > n, from);
  const { frames: to } = await state(page);
  assert.ok(to - from >= 30, `${to - from} pictures`);
  const { profile } = await cdp.send('HeapProfiler.stopSampling');
  await cdp.detach();
  const files = new Map();
  const makers = new Map();
  const walk = ({ callFrame, selfSize, children }, under) => {
    const { url, functionName, lineNumber, columnNumber } = callFrame;
    // What the engine makes for a function counts for the file that called it; the emulator is a script without a name.
    const own = url.includes('/assets/')
      ? url.replace(/.*\/assets\/(.*?)-[^-]*\.js/, '$1')
      : url || lineNumber >= 0
        ? ''
        : under;
    const file = own === '' ? 'emulator and test' : own;
    files.set(file, (files.get(file) ?? 0) + selfSize);
    const maker = `${file} ${functionName || '?'}:${lineNumber}:${columnNumber}`;
    makers.set(maker, (makers.get(maker) ?? 0) + selfSize);
    for (const child of children) walk(child, file);
  };
  walk(profile.head, '');
  const sorted = (map, least) =>
    [...map]
      .map(([name, bytes]) => [name, Math.round(bytes / (to - from))])
      .filter(([, bytes]) => bytes >= least)
      .sort((a, b) => b[1] - a[1]);
  console.log(
    `        ${words}, bytes a picture: ${sorted(files, 1)
      .map(([n, b]) => `${n} ${b}`)
      .join(', ')}`,
  );
  if (process.env.MAKERS)
    console.log(
      sorted(makers, 20)
        .slice(0, 40)
        .map(([n, b]) => `          ${b} ${n}`)
        .join('\n'),
    );
  return new Map(sorted(files, 0));
}

/** What the loop of pictures takes from the heap: with hands at rest, and with a branch in the hand. */
async function loop({ page, context, url }) {
  await enter(page, url);
  await find(page, 'right');
  await heap(page, context, 'hands at rest');
  const at = await find(page, 'right');
  await press(page, 'right', 'squeeze', 1);
  await frames(page);
  // Moved by the page itself, so that the test asks for nothing meanwhile.
  await page.evaluate(([x, y, z]) => {
    let k = 0;
    window.moving = setInterval(() => {
      k += 1;
      window.device.controllers.right.position.set(x + 0.05 * Math.sin(k / 9), y + 0.05 * Math.cos(k / 7), z);
    }, 11);
  }, at);
  await heap(page, context, 'a branch in the hand');
  await page.evaluate(() => clearInterval(window.moving));
  await press(page, 'right', 'squeeze', 0);
  await until(page, 'edits', ['is', 1], 'one edit');
}

export const headsetCosts = [
  ['headset: levels of detail', levels, WIDE],
  ['headset: the first picture', first, WIDE],
  ['headset: the room behind the plants', room, WIDE],
  ['headset: memory of the loop', loop, SMALL],
];
