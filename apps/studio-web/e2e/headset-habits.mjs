// What else hands do in an emulated headset: pull branches off, point without a place, take the headset off, feel ticks.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import {
  SMALL,
  WIDE,
  carries,
  click,
  editsOf,
  enter,
  find,
  frames,
  hand,
  key,
  press,
  shotOfBoard,
  state,
  stick,
  stroke,
  way,
} from './headset.mjs';
import { changed, data, settled, until } from './journeys.mjs';

/** Ends the record that is going on, and saves it; `side`: of the working hand. */
async function record(page, path, side = 'right') {
  const [file] = await Promise.all([page.waitForEvent('download'), key(page, 'record', side)]);
  await file.saveAs(path);
  return JSON.parse(readFileSync(path, 'utf8'));
}

const replayed = (burgeon, path) =>
  JSON.parse(execFileSync(burgeon, ['replay', path, '--json'], { encoding: 'utf8' }));

/** What the controllers are told to let hands feel, from now on. */
const feel = (page) =>
  page.evaluate(() => {
    window.ticks = [];
    for (const { handedness, gamepad } of window.device.activeSession.inputSources)
      for (const actuator of gamepad.hapticActuators)
        actuator.pulse = (strength, ms) => {
          window.ticks.push([handedness, strength, ms]);
          return Promise.resolve(true);
        };
  });
const ticks = (page) => page.evaluate(() => window.ticks.splice(0));

/** Turns a controller about the way it points, by so many radians. */
const roll = (page, side, angle) =>
  page.evaluate(
    ([s, a]) => window.device.controllers[s].quaternion.set(0, 0, Math.sin(a / 2), Math.cos(a / 2)),
    [side, angle],
  );

/** How far what is carried is turned, radians. */
function angle(carried) {
  const [x, y, z, w] = carried.split(' ').map(Number).slice(3);
  return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
}

/** A known roll: the part of the hand's turn about the way from the foot of what it holds to the tip. */
function rollOf(steps, carried) {
  const hands = steps.map((s) => s.did.hand).filter((h) => h?.tool === 'rotate');
  const began = hands.findIndex((h) => h.input.down);
  const ended = hands.findIndex((h) => h.input.up);
  const last = hands
    .slice(began, ended)
    .flatMap((h) => h.input.move ?? [])
    .at(-1);
  const [a, b] = [hands[began].input.down, last].map((p) => p.hand);
  const [px, py, pz] = carried.split(' ').map(Number);
  const way = [last.tip[0] - px, last.tip[1] - py, last.tip[2] - pz].map(
    (v, _, all) => v / Math.hypot(...all),
  );
  // b times the inverse of a.
  const cross = [0, 1, 2].map((i) => {
    const [j, k] = [(i + 1) % 3, (i + 2) % 3];
    return a[j] * b[k] - a[k] * b[j];
  });
  const turn = [0, 1, 2].map((i) => b[i] * a[3] - a[i] * b[3] + cross[i]);
  const real = a.reduce((sum, v, i) => sum + v * b[i], 0);
  const along = turn.reduce((sum, v, i) => sum + v * way[i], 0);
  return 2 * Math.atan2(Math.abs(along), Math.abs(real));
}

/** A branch rolls with the hand, comes off when it is pulled, is moved and grown anew; what bears it is meant, too. */
async function grab({ page, url, shot, burgeon, out }) {
  const plain = await enter(page, url);
  const { digests, done } = editsOf(page, plain);
  await key(page, 'scene');
  await key(page, 'record');
  await key(page, 'scene');
  await feel(page);
  await key(page, 'rotate');
  await ticks(page);
  // In its place, rolled by a third of a round.
  let at = await find(page, 'right');
  await press(page, 'right', 'squeeze', 1);
  await frames(page);
  for (let k = 1; k <= 8; k += 1) {
    await roll(page, 'right', (k * Math.PI) / 12);
    await frames(page, 1);
  }
  await carries(page);
  await frames(page, 6);
  const rolled = { carried: await data(page, 'carried'), said: (await state(page)).said };
  await press(page, 'right', 'squeeze', 0);
  await done('a roll');
  const felt = (await ticks(page)).filter(([side]) => side === 'right');
  assert.deepEqual(
    felt,
    [
      ['right', 0.7, 30],
      ['right', 0.9, 40],
    ],
    'taken and let go',
  );
  // Pulled far away: it comes off with a tick, and is dropped on the wood nearest to its foot.
  at = await find(page, 'right');
  await stroke(
    page,
    way(at, [at[0] < 0 ? -0.04 : 0.04, 0.025, 0.03], 12),
    async () => {
      await carries(page);
      await frames(page, 6);
      await shot('headset-pulled');
    },
    'right',
    'squeeze',
  );
  await done('a branch on other wood');
  const kinds = (await ticks(page)).map(([, strength]) => strength);
  assert.ok(kinds[0] === 0.7 && kinds.at(-1) === 0.9 && kinds.slice(1, -1).includes(0.4), `${kinds}`);
  // Moved, and grown anew.
  await key(page, 'move');
  at = await find(page, 'right');
  await stroke(page, way(at, [0.01, -0.02, 0.005], 10), () => carries(page));
  await done('a move');
  await key(page, 'regrow');
  await find(page, 'right');
  await click(page, 'right', 'trigger');
  await done('another branch');
  // What bears the twig is meant once the wrist says so, and the twig again.
  await key(page, 'pick');
  at = await find(page, 'right');
  const twig = await data(page, 'picked');
  await key(page, 'bearer');
  await hand(page, 'right', at);
  await page.waitForFunction((was) => !['', was].includes(document.body.dataset.picked ?? ''), twig);
  await key(page, 'twig');
  await hand(page, 'right', at);
  await page.waitForFunction((was) => document.body.dataset.picked === was, twig);
  // A brush that is made larger while it is down.
  await key(page, 'brush');
  at = await find(page, 'right');
  await stroke(page, way(at, [0.01, 0.015, 0], 8), async () => {
    await stick(page, 'right', 0, 1);
    await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).said.includes('Radius'));
    await frames(page, 12);
    await stick(page, 'right', 0, 0);
    for (const place of way([at[0] + 0.09, at[1] + 0.13, at[2]], [0.01, 0.015, 0], 6)) {
      await hand(page, 'right', place);
      await frames(page, 1);
    }
  });
  await done('a brush');
  await stick(page, 'left', 1, 0);
  await frames(page);
  await stick(page, 'left', 0, 0);
  assert.ok(
    (await ticks(page)).some(([side]) => side === 'left'),
    'a turn by 30 degrees is felt',
  );
  await key(page, 'scene');
  const path = `${out}/grab.gestures.json`;
  const { steps } = await record(page, path);
  const made = steps.flatMap((s) => s.did.hand?.input.brush ?? []);
  assert.ok(made.length > 0 && made.at(-1).radius_m > made[0].radius_m, 'the brush grew on the way');
  const asked = rollOf(steps, rolled.carried);
  assert.ok(asked > 0.05 && Math.abs(asked - angle(rolled.carried)) < 1e-3, `${asked}, ${rolled.carried}`);
  assert.equal(rolled.said, `${((asked * 180) / Math.PI).toFixed(1)}°`);
  const again = replayed(burgeon, path);
  assert.deepEqual([again.digest, again.same, again.edits], [digests.at(-1), true, digests.length - 1]);
  for (const digest of digests.slice(0, -1).reverse()) {
    await click(page, 'right', 'b-button');
    await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  }
}

/** One controller that only points: the board stands beside the person, and branches are drawn on a plane that leans. */
async function pointing({ page, url, shot, burgeon, out }) {
  await page.addInitScript(() => {
    window.guessing = true;
  });
  const plain = await enter(page, url, 'pointing');
  await page.evaluate(() => {
    window.device.controllers.left.connected = false;
  });
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).pointer);
  await frames(page, 12);
  const at = [0.1, 1.2, 0];
  const tap = async (word) => {
    const place = await page.evaluate((w) => JSON.parse(document.body.dataset.wrist ?? '{}')[w], word);
    assert.ok(place, `a key ${word}`);
    await hand(page, 'right', at, place);
    await frames(page);
    await click(page, 'right', 'trigger');
  };
  await shot('headset-pointing');
  await tap('scene');
  await tap('record');
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).records);
  await tap('scene');
  await tap('sketch');
  assert.equal((await state(page)).tool, 'sketch');
  // The first branch that the ray means, from where the hand is.
  let aim;
  for (let k = 0; k < 80; k += 1) {
    aim = [0.35 * Math.sin(k * 2.4), 0.35 + 0.009 * k, -0.75];
    await hand(page, 'right', at, aim);
    await frames(page);
    const picked = await data(page, 'picked');
    if (picked !== '' && picked !== '0') break;
  }
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  for (let k = 1; k <= 16; k += 1) {
    // Half way the thumb has the plane lean away from the eyes.
    if (k === 8) await stick(page, 'right', 0, 0.7);
    await hand(page, 'right', at, [aim[0] + 0.012 * k, aim[1] + 0.02 * k, aim[2]]);
    await frames(page, 1);
  }
  assert.equal((await state(page)).trace.points, 0, 'nothing is drawn where the hand is');
  await shot('headset-pointing-drawn');
  await stick(page, 'right', 0, 0);
  await press(page, 'right', 'trigger', 0);
  await until(page, 'edits', ['is', 1], 'a branch on the plane');
  await until(page, 'done', ['is', 1], 'it was done');
  const drawn = await changed(page, plain, 'a branch was drawn');
  await tap('scene');
  const path = `${out}/pointing.gestures.json`;
  const place = await page.evaluate(() => JSON.parse(document.body.dataset.wrist).record);
  await hand(page, 'right', at, place);
  await frames(page);
  const [file] = await Promise.all([page.waitForEvent('download'), click(page, 'right', 'trigger')]);
  await file.saveAs(path);
  const { steps } = JSON.parse(readFileSync(path, 'utf8'));
  const inputs = steps.flatMap((s) => (s.did.hand?.tool.sketch ? [s.did.hand.input] : []));
  const poses = inputs.flatMap((i) => [i.down, i.up, ...(i.move ?? [])]).filter((p) => p);
  assert.ok(poses.length > 8 && poses.every((p) => !p.tip), 'no place is told that nobody knows');
  assert.ok(
    inputs.some((i) => i.thumb),
    'the thumb is told',
  );
  assert.deepEqual([replayed(burgeon, path).digest, replayed(burgeon, path).same], [drawn, true]);
}

/** A controller with a place that is only guessed for a while waits; a headset that is taken off lets go; a dead one, too. */
async function taken({ page, context, url, shot }) {
  const plain = await enter(page, url);
  await key(page, 'sketch');
  const at = await find(page, 'right');
  const line = way(at, [0.02, 0.015, 0], 12);
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  for (const place of line.slice(0, 5)) {
    await hand(page, 'right', place);
    await frames(page, 1);
  }
  await page.evaluate(() => {
    window.guessing = true;
  });
  await page.waitForFunction(() => !JSON.parse(document.body.dataset.vr).tracked);
  assert.ok((await state(page)).working, 'the stroke waits');
  await page.evaluate(() => {
    window.guessing = false;
  });
  for (const place of line.slice(5, 9)) {
    await hand(page, 'right', place);
    await frames(page, 1);
  }
  // Taken off.
  await page.evaluate(() => window.device.updateVisibilityState('hidden'));
  await until(page, 'edits', ['is', 1], 'what was drawn is kept');
  await until(page, 'done', ['is', 1], 'it was done');
  const drawn = await changed(page, plain, 'a branch was drawn');
  await page.evaluate(() => window.device.updateVisibilityState('visible'));
  await press(page, 'right', 'trigger', 0);
  await frames(page);
  assert.equal(await data(page, 'headset'), 'on', 'put on again, it goes on');
  assert.ok(!(await state(page)).working);
  // The battery dies in the middle of a stroke: what was finished is there on the desktop.
  await page.waitForFunction(() => document.body.dataset.kept === 'saved');
  await find(page, 'right');
  await press(page, 'right', 'trigger', 1);
  await frames(page);
  const cdp = await context.newCDPSession(page);
  await Promise.race([cdp.send('Page.crash').catch(() => {}), page.waitForTimeout(500).catch(() => {})]);
  const after = await context.newPage();
  after.setDefaultTimeout(60_000);
  await after.goto(url);
  await after.waitForFunction((d) => document.body.dataset.digest === d, drawn);
  await shot('headset-dead', after);
  await after.keyboard.press('Control+z');
  await after.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await after.close();
}

/** A record of a scene of several plants: it names them, and a plant that comes in later. */
async function several({ page, url, burgeon, out }) {
  await enter(page, url);
  await key(page, 'scene');
  await key(page, 'plant.add');
  await until(page, 'plants', ['is', 2], 'a second plant');
  await settled(page);
  await key(page, 'plant.before');
  await key(page, 'record');
  await page.waitForFunction(() => JSON.parse(document.body.dataset.vr).records);
  const before = await data(page, 'digest');
  await key(page, 'more');
  await key(page, 'dice');
  const other = await changed(page, before, 'another seed');
  const at = await find(page, 'right');
  await stroke(page, way(at, [0.01, 0.008, 0.004], 10), () => carries(page), 'right', 'squeeze');
  await until(page, 'edits', ['is', 1], 'a turn');
  const turned = await changed(page, other, 'it was turned');
  await key(page, 'scene');
  await key(page, 'copy');
  await until(page, 'plants', ['is', 3], 'a copy');
  await settled(page);
  await key(page, 'more');
  await key(page, 'dice');
  const last = await changed(page, turned, 'the copy has a seed of its own');
  await key(page, 'scene');
  const path = `${out}/several.gestures.json`;
  const { numbers } = await record(page, path);
  assert.equal(numbers.plants.length, 2, 'the numbers of those that were there');
  const again = replayed(burgeon, path);
  assert.deepEqual([again.digest, again.same, again.edits], [last, true, 1]);
}

/** The rest of the wrist: a seat, guides, a file, the trace, the first steps one after another; letters of 8 mm at least. */
const board =
  (language) =>
  async ({ page, url, shot }) => {
    await enter(page, url);
    await page.evaluate(() => {
      window.device.stereoEnabled = true;
    });
    const legible = async () => {
      const { letters, page: of } = await state(page);
      assert.ok(letters >= 8, `letters of ${letters} mm on the page ${of}`);
    };
    const low = (await state(page)).at[1];
    const { size } = await state(page);
    await key(page, 'higher');
    assert.ok(Math.abs((await state(page)).at[1] - low - 0.1 * size) < 1e-6, 'a step of the seat');
    await key(page, 'lower');
    assert.ok(Math.abs((await state(page)).at[1] - low) < 1e-6, 'and back');
    // Every page, and the line above with all that it may say.
    for (const word of ['rotate', 'brush', 'grow', 'silhouette']) {
      await key(page, word);
      await shotOfBoard(page, shot, `board-${word}${language}`);
      await legible();
    }
    await key(page, 'more');
    await shotOfBoard(page, shot, `board-more${language}`);
    await legible();
    const { trace } = await state(page);
    await key(page, 'trace.colour');
    await key(page, 'trace.thick');
    const now = (await state(page)).trace;
    assert.ok(now.colour !== trace.colour && now.mm > trace.mm, `${JSON.stringify(now)}`);
    await key(page, 'grid');
    await key(page, 'staff');
    await hand(page, 'left', [-0.6, 0.9, 0.3]);
    await frames(page);
    await shot(`board-guides${language}`);
    for (const word of ['scene', 'export']) {
      await key(page, word);
      await shotOfBoard(page, shot, `board-${word}${language}`);
      await legible();
      if (word === 'scene') {
        const [file] = await Promise.all([page.waitForEvent('download'), key(page, 'save')]);
        assert.ok(file.suggestedFilename().endsWith('.burgeon'), file.suggestedFilename());
        assert.equal(readFileSync(await file.path()).toString('latin1', 0, 2), 'PK');
      }
    }
    await key(page, 'more');
    await key(page, 'lesson');
    assert.equal((await state(page)).tool, 'rotate', 'the tool that the first step needs');
    // The first steps: each is told until it was done.
    const step = async (is) => {
      await page.waitForFunction((s) => JSON.parse(document.body.dataset.vr).step === s, is);
      await shotOfBoard(page, shot, `board-step-${is || 'done'}${language}`);
      await legible();
    };
    await step('turn');
    if (language !== '') assert.match((await state(page)).said, /[\u4e00-\u9fff]/, 'in Chinese');
    const at = await find(page, 'right');
    await stroke(page, way(at, [0.01, 0.008, 0.004], 8), () => carries(page), 'right', 'squeeze');
    await until(page, 'done', ['is', 1], 'a turn');
    await step('draw');
    await key(page, 'more');
    await key(page, 'sketch');
    const from = await find(page, 'right');
    await stroke(page, way(from, [0.02, 0.015, 0], 12), async () => {
      assert.ok((await state(page)).trace.points > 6, 'the trace is seen');
      await shot(`board-trace${language}`);
    });
    await until(page, 'done', ['is', 2], 'a branch');
    await step('undo');
    await click(page, 'right', 'b-button');
    await step('');
  };

export const headsetHabits = [
  ['headset: a branch in the hand, rolled, pulled off, moved', grab, WIDE],
  ['headset: one controller that only points', pointing, WIDE],
  ['headset: guessed, taken off, a dead battery', taken, SMALL],
  ['headset: a record of one plant of several', several, SMALL],
  ['headset: all of the wrist', board(''), WIDE],
  ['headset: all of the wrist, Chinese', board('-zh'), { ...WIDE, locale: 'zh-CN' }],
];
