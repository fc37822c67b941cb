// A headset and its controllers, emulated in the page (iwer): in, shape, out again; what was done stays.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { bush, changed, count, data, settled, until } from './journeys.mjs';
import { eventually, felt, reloaded, rested, saved } from './waits.mjs';

const IWER = readFileSync(new URL('../node_modules/iwer/build/iwer.min.js', import.meta.url), 'utf8');
export const WIDE = { viewport: { width: 700, height: 420 } };

/** Puts a headset onto the page before it loads. */
export async function wear(page, model) {
  await page.addInitScript(IWER);
  await page.addInitScript((name) => {
    // What iwer does not describe: the same buttons under the names of Pico's controllers, and no floor.
    const quest = globalThis.IWER.metaQuest3;
    const own = {
      pico4Ultra: {
        ...quest,
        name: 'Pico 4 Ultra',
        controllerConfig: {
          ...quest.controllerConfig,
          profileId: 'pico-4u',
          fallbackProfileIds: ['generic-trigger-squeeze-thumbstick'],
        },
      },
      // Of three degrees of freedom: no grip, by its names, and its place is guessed.
      pointing: {
        ...quest,
        name: 'a controller that points',
        controllerConfig: {
          ...quest.controllerConfig,
          profileId: 'oculus-go',
          fallbackProfileIds: ['generic-trigger-touchpad'],
        },
      },
      floorless: {
        ...quest,
        name: 'without a floor',
        supportedFeatures: quest.supportedFeatures.filter((f) => !f.endsWith('-floor')),
      },
    };
    window.burgeonWatches = true;
    window.device = new globalThis.IWER.XRDevice(own[name] ?? globalThis.IWER[name]);
    window.device.installRuntime({ forceInstall: true });
    window.device.position.set(0, 1.6, 0);
    // As long as a test says so, places are guessed from how things are turned.
    const { getPose } = window.XRFrame.prototype;
    window.XRFrame.prototype.getPose = function (...of) {
      const pose = getPose.apply(this, of);
      if (pose) Object.defineProperty(pose, 'emulatedPosition', { value: window.guessing === true });
      return pose;
    };
  }, model);
}

export const state = async (page) => JSON.parse((await data(page, 'vr')) || '{}');

/** Puts a controller somewhere; `aim`: towards a place, else straight ahead. */
export const hand = (page, side, [x, y, z], aim) =>
  page.evaluate(
    ([s, p, to]) => {
      const { position, quaternion } = window.device.controllers[s];
      position.set(...p);
      const [dx, dy, dz] = to ? to.map((v, i) => v - p[i]) : [0, 0, -1];
      const length = Math.hypot(dx, dy, dz);
      // The shortest turn from straight ahead (-z).
      const q = [dy, -dx, 0, length - dz];
      const n = Math.hypot(...q) || 1;
      quaternion.set(q[0] / n, q[1] / n, q[2] / n, q[3] / n);
    },
    [side, [x, y, z], aim],
  );

export const press = (page, side, button, value) =>
  page.evaluate(([s, b, v]) => window.device.controllers[s].updateButtonValue(b, v), [side, button, value]);

export const stick = (page, side, x, y) =>
  page.evaluate(
    ([s, u, v]) => {
      window.device.controllers[s].updateAxis('thumbstick', 'x-axis', u);
      window.device.controllers[s].updateAxis('thumbstick', 'y-axis', -v);
    },
    [side, x, y],
  );

/** Moves a controller there as a hand does: what is further away at once is a tracker that jumped. */
async function glide(page, side, from, to, aim) {
  const steps = Math.ceil(Math.hypot(...to.map((x, i) => x - from[i])) / 0.2);
  for (let k = 1; k <= steps; k += 1) {
    await hand(
      page,
      side,
      to.map((x, i) => from[i] + ((x - from[i]) * k) / steps),
      k === steps ? aim : undefined,
    );
    await frames(page, 1);
  }
}

/** A picture of the board at the wrist, with the head bowed to it. */
export async function shotOfBoard(page, shot, name, side = 'left') {
  await page.evaluate(() => window.device.quaternion.set(Math.sin(-0.3), 0, 0, Math.cos(-0.3)));
  await hand(page, side, [0, 1.25, -0.35]);
  await frames(page);
  await shot(name);
  await page.evaluate(() => window.device.quaternion.set(0, 0, 0, 1));
}

/** As long as some pictures take. */
export async function frames(page, count = 4) {
  const { frames: from = 0 } = await state(page);
  await page.waitForFunction(
    (n) => JSON.parse(document.body.dataset.vr || '{"frames":0}').frames >= n,
    from + Math.max(5, count),
  );
}

export async function click(page, side, button) {
  await press(page, side, button, 1);
  await frames(page);
  await press(page, side, button, 0);
  await frames(page);
}

export async function enter(page, url, model = 'metaQuest3', command = undefined) {
  await wear(page, model);
  const digest = await bush(page, url);
  if (command) {
    await page.keyboard.press('Control+k');
    await page.locator('.palette input').fill('the room');
    await page.locator(`#p-${command}`).click();
  } else await page.locator('#b-headset').click();
  await page.waitForFunction(() => document.body.dataset.headset === 'on');
  await frames(page);
  return digest;
}

/** Points a controller at a branch that is not the trunk, from before the plant; `bearing`: one that bears others. */
export async function find(page, side, { bearing = false } = {}) {
  for (let k = 0; k < 80; k += 1) {
    const at = [0.35 * Math.sin(k * 2.4), 0.35 + 0.009 * k, -0.15];
    await felt(page, () => hand(page, side, at));
    await frames(page);
    const picked = await data(page, 'picked');
    const enough = !bearing || (await count(page, 'bears')) > 0;
    if (picked !== '' && picked !== '0' && enough) return at;
  }
  throw new Error('no branch before the controller');
}

/** Presses a key of the wrist, which the other hand holds before the eyes. */
export async function key(page, word, side = 'right', { last = false } = {}) {
  const other = side === 'right' ? 'left' : 'right';
  await hand(page, other, [0, 1.25, -0.35]);
  await frames(page);
  const place = await eventually(
    () => page.evaluate((w) => JSON.parse(document.body.dataset.wrist ?? '{}')[w], word),
    (there) => there !== undefined,
    `a key ${word}`,
  );
  await hand(page, side, [place[0], place[1] + 0.02, place[2] + 0.25], place);
  await frames(page);
  // Out of the headset there are no frames to wait for.
  if (last) {
    await press(page, side, 'trigger', 1);
    return;
  }
  await click(page, side, 'trigger');
  await hand(page, other, [-0.6, 0.9, 0.3]);
}

async function shape({ page, url, shot }) {
  const plain = await enter(page, url);
  const before = await state(page);
  assert.ok(before.tracked && before.size > 0, 'the controllers are there');
  await shot('headset-in');
  // A branch is held, and the thumb turns it by exactly a quarter.
  await key(page, 'rotate');
  assert.equal((await state(page)).tool, 'rotate');
  const at = await find(page, 'right');
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  assert.ok((await state(page)).working, 'a gesture is going on');
  for (let k = 0; k <= 6; k += 1) {
    await stick(page, 'right', Math.cos((k * Math.PI) / 12), Math.sin((k * Math.PI) / 12));
    await frames(page);
  }
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).said === '90.0°');
  await shot('headset-turned');
  await stick(page, 'right', 0, 0);
  await press(page, 'right', 'trigger', 0);
  await until(page, 'edits', ['is', 1], 'one edit');
  const turned = await changed(page, plain, 'a branch was turned');
  // A branch drawn in the air.
  await key(page, 'sketch');
  await hand(page, 'right', at);
  await frames(page);
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  for (let k = 1; k <= 12; k += 1) {
    await hand(page, 'right', [at[0] + 0.02 * k, at[1] + 0.015 * k, at[2] - 0.2 * Math.sin(k / 6)]);
    await frames(page);
  }
  await shot('headset-drawn');
  await press(page, 'right', 'trigger', 0);
  await until(page, 'edits', ['is', 2], 'a second edit');
  await until(page, 'done', ['is', 2], 'both were done');
  const drawn = await changed(page, turned, 'a branch was drawn');
  // B takes back, twice: the first plant. A does it again.
  for (const digest of [turned, plain]) {
    await click(page, 'right', 'b-button');
    await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  }
  for (const digest of [turned, drawn]) {
    await click(page, 'right', 'a-button');
    await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  }
  // Out by the wrist: the page shows the same plant, and keeps it.
  await key(page, 'leave', 'right', { last: true });
  await page.waitForFunction(() => document.body.dataset.headset === 'off');
  assert.equal(await settled(page), drawn);
  await rested(page);
  await shot('headset-out');
  await saved(page);
  await reloaded(page);
  await page.waitForFunction((d) => document.body.dataset.digest === d, drawn);
}

/** A shoot grows while the trigger is held, with more vigour by the stick. */
async function grow({ page, url, shot }) {
  const plain = await enter(page, url);
  await key(page, 'grow');
  assert.equal((await state(page)).tool, 'grow');
  const at = await find(page, 'right');
  await press(page, 'right', 'trigger', 1);
  const first = await changed(page, plain, 'it grows');
  await stick(page, 'right', 0, 1);
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).said.includes('Vigour'));
  await changed(page, first, 'it grows on');
  await stick(page, 'right', 0, 0);
  // The wrist has the numbers, too: the trigger is taken, so the lower button presses them.
  await hand(page, 'left', [0, 1.25, -0.35]);
  await frames(page, 12);
  await page.waitForFunction(() => JSON.parse(document.body.dataset.wrist ?? '{}')['apical+']);
  const apical = await page.evaluate(() => JSON.parse(document.body.dataset.wrist)['apical+']);
  await glide(page, 'right', at, [apical[0], apical[1] + 0.02, apical[2] + 0.25], apical);
  await frames(page);
  await click(page, 'right', 'a-button');
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).said.includes('Apical control 0.58'));
  await shotOfBoard(page, shot, 'headset-growing');
  await press(page, 'right', 'trigger', 0);
  await until(page, 'edits', ['is', 1], 'one edit');
  await until(page, 'done', ['is', 1], 'it was done');
  await click(page, 'right', 'b-button');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
}

/** Where one stands: grips, sticks, true size; the left hand; a session that ends in the middle. */
async function stand({ page, url }) {
  const plain = await enter(page, url);
  const near = await state(page);
  await key(page, 'scale');
  const large = await state(page);
  assert.ok(Math.abs(large.size / near.size - 1) > 0.1, `another size: ${near.size}, ${large.size}`);
  await key(page, 'scale');
  assert.ok(Math.abs((await state(page)).size - near.size) < 1e-9);
  // Both grips: hands that part make the scene twice as large; the person half.
  for (const [side, x] of [
    ['left', -0.2],
    ['right', 0.2],
  ]) {
    await hand(page, side, [x, 1.1, -0.4]);
    await frames(page);
    await press(page, side, 'squeeze', 1);
  }
  await frames(page);
  for (let k = 1; k <= 10; k += 1) {
    await hand(page, 'left', [-0.2 - 0.02 * k, 1.1, -0.4]);
    await hand(page, 'right', [0.2 + 0.02 * k, 1.1, -0.4]);
    await frames(page, 1);
  }
  const half = await state(page);
  assert.ok(Math.abs(half.size / near.size - 0.5) < 0.02, `half the size: ${near.size}, ${half.size}`);
  for (const side of ['left', 'right']) await press(page, side, 'squeeze', 0);
  await frames(page);
  // The other stick turns by 30 degrees, and goes where it points.
  await stick(page, 'left', 1, 0);
  await frames(page);
  await stick(page, 'left', 0, 0);
  await frames(page);
  assert.ok(Math.abs(Math.abs((await state(page)).turn) - 30) < 0.1, `turned: ${(await state(page)).turn}`);
  const from = (await state(page)).at;
  await hand(page, 'left', [-0.2, 1.2, -0.3], [-0.2, 1.0, -1.3]);
  await stick(page, 'left', 0, 1);
  await frames(page);
  await stick(page, 'left', 0, 0);
  await frames(page);
  const to = (await state(page)).at;
  assert.ok(Math.hypot(to[0] - from[0], to[2] - from[2]) > 0.2, 'elsewhere');
  assert.equal(await data(page, 'digest'), plain, 'walking changes no plant');
  // The left hand works, and the session ends while it holds a branch: what was done so far is kept.
  await key(page, 'scale');
  await key(page, 'scale');
  await key(page, 'left');
  await key(page, 'rotate', 'left');
  await find(page, 'left');
  await press(page, 'left', 'trigger', 1);
  await frames(page);
  for (const x of [0.2, 0.6, 1]) {
    await stick(page, 'left', x, 1);
    await frames(page);
  }
  await page.evaluate(() => window.device.activeSession.end());
  await page.waitForFunction(() => document.body.dataset.headset === 'off');
  await until(page, 'edits', ['is', 1], 'the edit is kept');
  await changed(page, plain, 'the branch stays turned');
}

/** What is carried, once it is elsewhere than before. */
export async function carries(page, before = '') {
  await page.waitForFunction((was) => !['', was].includes(document.body.dataset.carried ?? ''), before);
  return data(page, 'carried');
}

/** On a Pico, left-handed: a branch goes with the hand by as much as the hand turns, and the plant after it. */
async function pico({ page, url, shot }) {
  const plain = await enter(page, url, 'pico4Ultra');
  await key(page, 'left');
  await key(page, 'rotate', 'left');
  const at = await find(page, 'left');
  await press(page, 'left', 'squeeze', 1);
  await frames(page);
  await hand(page, 'left', [at[0] + 0.05, at[1] + 0.02, at[2]]);
  const first = await carries(page);
  await hand(page, 'left', [at[0] + 0.15, at[1] + 0.1, at[2] + 0.08]);
  await carries(page, first);
  assert.equal(await data(page, 'digest'), plain, 'nothing is made again while it is held');
  await shot('headset-carried');
  await press(page, 'left', 'squeeze', 0);
  await until(page, 'edits', ['is', 1], 'one edit');
  await changed(page, plain, 'it was turned');
  await click(page, 'left', 'y-button');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
}

/** A plane that is placed in space, and an outline on it. */
async function plane({ page, url, shot }) {
  const plain = await enter(page, url);
  await key(page, 'silhouette');
  // The grip sets the plane before the plant, turned a little.
  await hand(page, 'right', [0.05, 1.0, -0.3], [0.35, 0.95, -1.3]);
  await frames(page);
  await press(page, 'right', 'squeeze', 1);
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).plane);
  await press(page, 'right', 'squeeze', 0);
  await frames(page);
  await shot('headset-plane');
  const ring = (k) => [0.05 + 0.2 * Math.cos(k / 4), 1.0 + 0.2 * Math.sin(k / 4), -0.45];
  await hand(page, 'right', ring(0));
  await frames(page);
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  for (let k = 1; k <= 25; k += 1) {
    await hand(page, 'right', ring(k));
    await frames(page, 1);
  }
  await shot('headset-outline');
  await press(page, 'right', 'trigger', 0);
  await until(page, 'edits', ['is', 1], 'one edit');
  await changed(page, plain, 'it was filled');
  await key(page, 'more');
  await key(page, 'plane');
  await page.waitForFunction(() => !JSON.parse(document.body.dataset.vr).plane);
}

/** Hands without controllers: a pinch is the trigger; one that is lost for good has let go. */
async function hands({ page, url, shot }) {
  await wear(page, 'metaQuest3');
  const plain = await bush(page, url);
  await page.evaluate(() => {
    window.device.primaryInputMode = 'hand';
  });
  await page.locator('#b-headset').click();
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr || '{}').hand);
  const place = (side, [x, y, z]) =>
    page.evaluate(([s, p]) => window.device.hands[s].position.set(...p), [side, [x, y, z]]);
  const pinch = (value) => page.evaluate((v) => window.device.hands.right.updatePinchValue(v), value);
  await place('left', [-0.6, 0.9, 0.3]);
  // Fingers that nearly pinch: what they point at is what they take.
  await pinch(0.7);
  let at;
  for (let k = 0; k < 80; k += 1) {
    at = [0.35 * Math.sin(k * 2.4), 0.35 + 0.009 * k, -0.15];
    await felt(page, () => place('right', at));
    await frames(page);
    const picked = await data(page, 'picked');
    if (picked !== '' && picked !== '0') break;
  }
  await pinch(1);
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).working);
  await place('right', [at[0] + 0.12, at[1] + 0.12, at[2]]);
  await carries(page);
  await shot('headset-hand');
  // It is not seen any more, and comes back open.
  await page.evaluate(() => {
    window.device.hands.right.connected = false;
  });
  await page.waitForFunction(() => !JSON.parse(document.body.dataset.vr).working);
  await until(page, 'edits', ['is', 1], 'what was done is kept');
  await changed(page, plain, 'it stays turned');
}

/** The wrist: another species, a copy, another seed, and back again; first steps are told until they are done. */
const wrist =
  (language) =>
  async ({ page, url, shot }) => {
    const plain = await enter(page, url);
    await page.evaluate(() => {
      window.device.stereoEnabled = true;
    });
    assert.equal((await state(page)).step, 'turn');
    const labels = (await state(page)).labels;
    assert.ok(labels > 0, 'parts have labels');
    await shotOfBoard(page, shot, `headset-tools${language}`);
    await key(page, 'more');
    await shotOfBoard(page, shot, `headset-more${language}`);
    await key(page, 'dice');
    const other = await changed(page, plain, 'another seed');
    await key(page, 'next');
    await changed(page, other, 'another species');
    await key(page, 'scene');
    await key(page, 'copy');
    await until(page, 'plants', ['is', 2], 'a copy beside it');
    for (let k = 0; k < 3; k += 1) await click(page, 'right', 'b-button');
    await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
    assert.ok((await state(page)).labels < labels, 'what was used needs no label');
    assert.equal((await state(page)).step, 'turn', 'nothing was turned yet');
  };

/** A headset that does not know the floor, and a controller that vanishes in the middle of a gesture. */
async function astray({ page, url }) {
  const plain = await enter(page, url, 'floorless');
  assert.equal((await state(page)).tool, 'rotate');
  const at = await find(page, 'right');
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  await hand(page, 'right', [at[0] + 0.1, at[1] + 0.1, at[2]]);
  await carries(page);
  assert.ok((await state(page)).working, 'a gesture is going on');
  // The controller vanishes.
  await page.evaluate(() => {
    window.device.controllers.right.connected = false;
  });
  await page.waitForFunction(() => !JSON.parse(document.body.dataset.vr).working);
  await until(page, 'edits', ['is', 1], 'what was done is kept');
  await changed(page, plain, 'the branch stays turned');
}

/** Runs a hand over some places, with the trigger held; `last`: what is done before it lets go. */
export async function stroke(page, places, last = async () => {}, side = 'right', button = 'trigger') {
  await hand(page, side, places[0]);
  await frames(page);
  await press(page, side, button, 1);
  await frames(page);
  for (const place of places.slice(1)) {
    await hand(page, side, place);
    await frames(page, 1);
  }
  await last();
  await press(page, side, button, 0);
  await frames(page);
}

/** From a place, so many steps of the same length. */
export const way = ([x, y, z], [dx, dy, dz], count) =>
  Array.from({ length: count + 1 }, (_, k) => [x + dx * k, y + dy * k, z + dz * k]);

/** A copy of a branch, both sides of a mirror, fewer leaves, a cut; and all of it back: the first plant. */
async function both({ page, url, shot }) {
  const plain = await enter(page, url);
  await key(page, 'copy');
  assert.equal((await state(page)).tool, 'copy');
  let at = await find(page, 'right');
  const digests = [plain];
  const done = async (count, what) => {
    await until(page, 'edits', ['is', count], what);
    await until(page, 'done', ['is', count], `${what}: done`);
    digests.push(await changed(page, digests.at(-1), what));
  };
  await stroke(page, way(at, [0.01, -0.03, -0.03], 10), async () => {
    await changed(page, plain, 'the copy is seen before it is let go');
    await shot('headset-copy');
  });
  await done(1, 'a copy');
  // The mirror stands between the hands: what is drawn on the right is made on the left.
  await key(page, 'mirror');
  await page.waitForFunction(() => (document.body.dataset.mirror ?? '') !== '');
  const normal = (await data(page, 'mirror')).split(' ').map(Number);
  assert.ok(Math.abs(Math.abs(normal[0]) - 1) < 0.2 && normal[1] === 0, `across the view: ${normal}`);
  await key(page, 'sketch');
  at = await find(page, 'right');
  await stroke(page, way(at, [0.03, 0.015, 0], 12), () => shot('headset-mirror-drawing'));
  await done(2, 'a branch and its image');
  await shot('headset-mirror');
  // Grown on both sides, with its age and density to be read beside the hand.
  await key(page, 'grow');
  at = await find(page, 'right');
  await press(page, 'right', 'trigger', 1);
  await page.waitForFunction(() =>
    /Age \d+ · \d+ branches · \d/.test(JSON.parse(document.body.dataset.vr).read),
  );
  await shot('headset-readout');
  await press(page, 'right', 'trigger', 0);
  await done(3, 'growth on both sides');
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).read === '');
  await key(page, 'mirror');
  await page.waitForFunction(() => document.body.dataset.mirror === '');
  // Leaves go, and then a branch.
  await key(page, 'leaves');
  for (let k = 0; k < 3; k += 1) await key(page, 'larger');
  await stroke(page, way([-0.2, 1, -0.6], [0.04, 0.02, -0.01], 12));
  await done(4, 'fewer leaves');
  await key(page, 'prune');
  await find(page, 'right');
  await click(page, 'right', 'trigger');
  await done(5, 'a cut');
  for (const digest of digests.slice(0, -1).reverse()) {
    await click(page, 'right', 'b-button');
    await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  }
  assert.equal(await data(page, 'digest'), plain, 'the first plant again');
}

/** Plants, things in the way, a model of it all: without leaving. */
async function scene({ page, url, shot }) {
  const plain = await enter(page, url);
  await key(page, 'scene');
  assert.ok((await state(page)).said.includes('1 of 1'), (await state(page)).said);
  await shotOfBoard(page, shot, 'headset-scene');
  // A ball in the way: the tree grows around it.
  await key(page, 'ball');
  await stroke(page, way([0.1, 1.15, -0.75], [0.015, 0, 0], 8), () => shot('headset-ball'));
  const around = await changed(page, plain, 'it grows around a ball');
  await key(page, 'clear');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await click(page, 'right', 'b-button');
  await page.waitForFunction((d) => document.body.dataset.digest === d, around);
  // The grip in it takes it along; it is one step.
  await stroke(
    page,
    way([0.1, 1.15, -0.75], [-0.01, 0.005, 0], 8),
    () => shot('headset-ball-held'),
    'right',
    'squeeze',
  );
  await changed(page, around, 'it grows around the ball where that stands now');
  await click(page, 'right', 'b-button');
  await page.waitForFunction((d) => document.body.dataset.digest === d, around);
  await key(page, 'clear');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  // A box is turned by the hand that holds it, and the stick makes it larger.
  await key(page, 'box');
  const corner = [0.05, 1.1, -0.8];
  await stroke(page, way(corner, [0.02, 0.02, 0.01], 8));
  const boxed = await changed(page, plain, 'it grows around a box');
  const inside = corner.map((x, i) => x + 4 * [0.02, 0.02, 0.01][i]);
  await hand(page, 'right', [inside[0], inside[1], inside[2] + 0.03]);
  await frames(page);
  await press(page, 'right', 'squeeze', 1);
  await frames(page);
  for (let k = 1; k <= 8; k += 1) {
    await page.evaluate((angle) => {
      const { quaternion } = window.device.controllers.right;
      quaternion.set(0, 0, Math.sin(angle / 2), Math.cos(angle / 2));
    }, k / 10);
    await frames(page, 1);
  }
  await stick(page, 'right', 0, 1);
  await page.waitForFunction(() => /1[1-9]\d %/.test(JSON.parse(document.body.dataset.vr).said));
  await stick(page, 'right', 0, 0);
  await shot('headset-box-turned');
  await press(page, 'right', 'squeeze', 0);
  await changed(page, boxed, 'it grows around the turned box');
  await click(page, 'right', 'b-button');
  await page.waitForFunction((d) => document.body.dataset.digest === d, boxed);
  // Another plant, which is worked on; and back to the first.
  await key(page, 'plant.add');
  await until(page, 'plants', ['is', 2], 'a second plant');
  await settled(page);
  await key(page, 'plant.before');
  assert.ok((await state(page)).said.includes('1 of 2'), (await state(page)).said);
  await key(page, 'plant.next');
  assert.ok((await state(page)).said.includes('2 of 2'), (await state(page)).said);
  await shot('headset-plants');
  await key(page, 'export');
  await shotOfBoard(page, shot, 'headset-export');
  for (const format of ['usda', 'obj', 'ply', 'stl', 'mtg']) {
    const [written] = await Promise.all([page.waitForEvent('download'), key(page, `export.${format}`)]);
    assert.ok(written.suggestedFilename().includes(format), written.suggestedFilename());
    assert.ok(readFileSync(await written.path()).length > 1000, `${format} has something in it`);
  }
  const [file] = await Promise.all([page.waitForEvent('download'), key(page, 'export.glb')]);
  assert.ok(file.suggestedFilename().endsWith('.glb'), file.suggestedFilename());
  const bytes = readFileSync(await file.path());
  assert.equal(bytes.toString('latin1', 0, 4), 'glTF');
  assert.equal(bytes.readUInt32LE(8), bytes.length, 'the whole of it');
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).said.startsWith('Exported'));
}

/** In the middle of a stroke the tracker is lost and comes back; then the session ends. */
async function lost({ page, url }) {
  const plain = await enter(page, url);
  await key(page, 'sketch');
  const at = await find(page, 'right');
  const line = way(at, [0.02, 0.015, 0], 12);
  await stroke(page, line.slice(0, 6), async () => {
    await hand(page, 'right', [Number.NaN, 0, 0]);
    await page.waitForFunction(() => !JSON.parse(document.body.dataset.vr).tracked);
    assert.ok((await state(page)).working, 'the stroke waits');
    for (const place of line.slice(6)) {
      await hand(page, 'right', place);
      await frames(page, 1);
    }
    assert.ok((await state(page)).working, 'it goes on');
  });
  await until(page, 'edits', ['is', 1], 'one stroke, one edit');
  await until(page, 'done', ['is', 1], 'it was done');
  const drawn = await changed(page, plain, 'a branch was drawn');
  await hand(page, 'right', at);
  await frames(page);
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  for (const place of way(at, [-0.02, 0.02, 0.01], 8)) {
    await hand(page, 'right', place);
    await frames(page, 1);
  }
  await page.evaluate(() => window.device.activeSession.end());
  await page.waitForFunction(() => document.body.dataset.headset === 'off');
  await until(page, 'edits', ['is', 2], 'what was drawn so far is kept');
  await until(page, 'done', ['is', 2], 'it was done');
  await changed(page, drawn, 'the second branch stands');
}

/** A tracker that is elsewhere for two pictures is not followed; one that stays elsewhere has let go where it was. */
async function jumps({ page, url }) {
  const plain = await enter(page, url);
  await key(page, 'rotate');
  const at = await find(page, 'right');
  await press(page, 'right', 'squeeze', 1);
  await frames(page);
  await felt(page, () => hand(page, 'right', [at[0] + 0.05, at[1] + 0.02, at[2]]));
  const held = await carries(page);
  const jump = () =>
    page.evaluate(async () => {
      const { position } = window.device.controllers.right;
      const picture = () => new Promise((done) => window.device.activeSession.requestAnimationFrame(done));
      const { x, y, z } = position;
      position.set(x + 1, y + 1, z);
      await picture();
      await picture();
      position.set(x, y, z);
    });
  await felt(page, jump);
  await frames(page);
  assert.ok((await state(page)).working, 'a jump that is over ends nothing');
  assert.equal(await data(page, 'carried'), held, 'and moves nothing');
  // Both trackers are elsewhere, and stay there.
  await hand(page, 'right', [at[0] + 1.1, at[1] + 0.6, at[2]]);
  await hand(page, 'left', [-1.8, 0.2, 0.9]);
  await page.waitForFunction(() => !JSON.parse(document.body.dataset.vr).working);
  await press(page, 'right', 'squeeze', 0);
  await until(page, 'edits', ['is', 1], 'what was done before is kept');
  await until(page, 'done', ['is', 1], 'it was done');
  await changed(page, plain, 'the branch stays turned');
  await click(page, 'right', 'b-button');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
}

/** A known turn: the angle between where the hand was and is, seen from the foot of what it holds. */
function angleOf(record, carried) {
  const hands = record.steps.map((s) => s.did.hand).filter((h) => h?.tool === 'rotate');
  const began = hands.findLastIndex((h) => h.input.down);
  const moves = hands.slice(began).flatMap((h) => h.input.move ?? []);
  const [px, py, pz, x, y, z, w] = carried.split(' ').map(Number);
  const from = ({ tip }) => [tip[0] - px, tip[1] - py, tip[2] - pz];
  const [a, b] = [from(hands[began].input.down), from(moves.at(-1))];
  const dot = a.reduce((sum, v, i) => sum + v * b[i], 0);
  return [
    Math.acos(dot / Math.hypot(...a) / Math.hypot(...b)),
    2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w)),
  ];
}

/** Everything that a hand can do, one after another, written down and done again by the command; then all of it taken back. */
const whole =
  (model, side) =>
  async ({ page, url, burgeon, out }) => {
    const plain = await enter(page, url, model);
    const undo = side === 'right' ? 'b-button' : 'y-button';
    if (side === 'left') await key(page, 'left');
    const at = (word) => key(page, word, side);
    const { digests, done } = editsOf(page, plain);
    await at('scene');
    await at('record');
    await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).records);
    await at('scene');
    // Grown, with more vigour on the way.
    await at('grow');
    await find(page, side);
    await press(page, side, 'trigger', 1);
    const first = await changed(page, plain, 'it grows');
    await stick(page, side, 0, 1);
    await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).said.includes('Vigour'));
    await changed(page, first, 'it grows on');
    await stick(page, side, 0, 0);
    await press(page, side, 'trigger', 0);
    await done('a shoot');
    // Grabbed, and turned by what the hand does.
    await at('rotate');
    const held = await find(page, side);
    let carried = '';
    await stroke(
      page,
      way(held, [0.012, 0.008, 0.006], 10),
      async () => {
        await carries(page);
        // Where the hand is now, and not where it was some pictures ago.
        await felt(page, () => {});
        carried = await data(page, 'carried');
      },
      side,
      'squeeze',
    );
    await done('a turn');
    await at('sketch');
    await stroke(page, way(await find(page, side), [0.02, 0.015, 0], 10), undefined, side);
    await done('a branch in the air');
    await at('brush');
    await stroke(page, way(await find(page, side), [0.015, 0.02, 0], 10), undefined, side);
    await done('a brush');
    // A plane before the plant, and an outline on it.
    await at('silhouette');
    await hand(page, side, [0.05, 1.0, -0.3], [0.35, 0.95, -1.3]);
    await frames(page);
    await press(page, side, 'squeeze', 1);
    await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).plane);
    await press(page, side, 'squeeze', 0);
    const ring = (k) => [0.05 + 0.2 * Math.cos(k / 3), 1.0 + 0.2 * Math.sin(k / 3), -0.45];
    await stroke(
      page,
      Array.from({ length: 19 }, (_, k) => ring(k)),
      undefined,
      side,
    );
    await done('an outline');
    await at('leaves');
    for (let k = 0; k < 3; k += 1) await at('larger');
    await stroke(page, way([-0.2, 1, -0.6], [0.04, 0.02, -0.01], 12), undefined, side);
    await done('fewer leaves');
    await at('prune');
    await find(page, side, { bearing: true });
    await click(page, side, 'trigger');
    await done('a cut');
    for (const digest of digests.slice(0, -1).reverse()) {
      await click(page, side, undo);
      await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
    }
    assert.equal(await data(page, 'digest'), plain, 'the first plant again');
    const redo = side === 'right' ? 'a-button' : 'x-button';
    for (const digest of digests.slice(1)) {
      await click(page, side, redo);
      await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
    }
    // The record is done again by the command, without page or headset: the same plant.
    await at('scene');
    const [file] = await Promise.all([page.waitForEvent('download'), at('record')]);
    const path = `${out}/${model}-${side}.gestures.json`;
    await file.saveAs(path);
    const record = JSON.parse(readFileSync(path, 'utf8'));
    const [asked, turned] = angleOf(record, carried);
    assert.ok(asked > 0.1 && Math.abs(asked - turned) < 0.01, `turned by ${turned}, the hand by ${asked}`);
    const again = JSON.parse(execFileSync(burgeon, ['replay', path, '--json'], { encoding: 'utf8' }));
    assert.deepEqual([again.digest, again.same, again.edits], [digests.at(-1), true, 7]);
    await at('scene');
    await key(page, 'leave', side, { last: true });
    await page.waitForFunction(() => document.body.dataset.headset === 'off');
    assert.equal(await settled(page), digests.at(-1));
    await saved(page);
    await reloaded(page);
    await page.waitForFunction((d) => document.body.dataset.digest === d, digests.at(-1));
  };

/** The digests after each edit of a plant, the plain one first, and a step that waits for one more. */
export function editsOf(page, plain) {
  const digests = [plain];
  const done = async (what) => {
    const count = digests.length;
    await until(page, 'edits', ['is', count], what);
    await until(page, 'done', ['is', count], `${what}: done`);
    digests.push(await changed(page, digests.at(-1), what));
  };
  return { digests, done };
}

export const SMALL = { viewport: { width: 420, height: 300 } };

/** What every run of the journeys does: in, by a known angle, out again; and what goes wrong with a controller. */
export const headsetCore = [
  ['headset: turn, draw, undo, leave', shape, SMALL],
  ['headset: astray', astray, SMALL],
  ['headset: trackers that jump', jumps, SMALL],
];

export const headset = [
  ['headset: all tools (Quest 3, right)', whole('metaQuest3', 'right'), SMALL],
  ['headset: all tools (Quest 3, left)', whole('metaQuest3', 'left'), SMALL],
  ['headset: all tools (Pico 4 Ultra, right)', whole('pico4Ultra', 'right'), SMALL],
  ['headset: all tools (Pico 4 Ultra, left)', whole('pico4Ultra', 'left'), SMALL],
  ['headset: a shoot grows', grow, WIDE],
  ['headset: size, place, left hand, an early end', stand, WIDE],
  ['headset: a Pico, left-handed, a branch in the hand', pico, WIDE],
  ['headset: an outline on a plane in space', plane, WIDE],
  ['headset: hands without controllers', hands, WIDE],
  ['headset: the wrist', wrist(''), WIDE],
  ['headset: the wrist in Chinese', wrist('-zh'), { ...WIDE, locale: 'zh-CN' }],
  ['headset: copy, both sides, leaves, a cut, all back', both, WIDE],
  ['headset: plants, things in the way, a model', scene, WIDE],
  ['headset: lost in a stroke', lost, WIDE],
];
