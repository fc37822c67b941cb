// Hands on plants in the view: prune, turn, draw, brush; what survives and what says that it did not.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import {
  add,
  begin,
  bush,
  changed,
  count,
  data,
  drop,
  exported,
  sample,
  settled,
  stirred,
  until,
} from './journeys.mjs';
import { answered, becomes, eventually, pictures, reloaded, rested } from './waits.mjs';

/** A small tree, grown, with a tool in the hand. */
async function inHand(page, url, tool) {
  await bush(page, url);
  await page.keyboard.press('Shift+S');
  await page.locator('.strip').waitFor();
  await page.keyboard.press(String(tool));
  await rested(page);
  return settled(page);
}

/** A place of the view where the pointer means a branch that is not the trunk. */
async function branch(page, from = 4, trunk = false) {
  await page.keyboard.press('1');
  await rested(page);
  const box = await page.locator('.view').boundingBox();
  for (let k = from; k < 60; k += 1) {
    const [x, y] = [
      box.x + box.width * (0.5 + 0.25 * Math.sin(k * 2.4)),
      box.y + box.height * (0.25 + 0.006 * k),
    ];
    await page.mouse.move(x, y);
    await page.mouse.move(x + 1, y);
    await answered(page);
    const picked = await data(page, 'picked');
    if (picked !== '' && (trunk || picked !== '0')) return { x: x + 1, y, k };
  }
  throw new Error('no branch under the pointer');
}

/** Opens the list of what was done by hand. */
async function unfold(page) {
  await page.locator('.edits .fold').click();
  await page.locator('.edits .fold[aria-expanded=true]').waitFor();
}

const WIDE = { viewport: { width: 1360, height: 760 } };

const CENTRE = async (page) => {
  const box = await page.locator('.view').boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
};

async function prune({ page, url, shot }) {
  const plain = await inHand(page, url, 4);
  const at = await branch(page);
  await rested(page);
  await shot('shape-pick');
  await page.keyboard.press('4');
  await page.click('#b-shape-whole');
  await page.mouse.click(at.x, at.y);
  await until(page, 'edits', ['is', 1], 'one edit');
  await until(page, 'done', ['is', 1], 'it was done');
  const pruned = await changed(page, plain, 'pruned');
  await rested(page);
  await shot('shape-prune');
  await unfold(page);
  await page.locator('.edits li', { hasText: /prune−\d+ branches/ }).waitFor();
  await page.locator('#b-undo[title*="prune"]').waitFor();
  // Left out, done again, removed; each is a step.
  await page.click('[data-key=eye0]');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await page.click('[data-key=eye0]');
  await page.waitForFunction((d) => document.body.dataset.digest === d, pruned);
  await page.click('[data-key=gone0]');
  await until(page, 'edits', ['is', 0], 'removed');
  await settled(page);
  for (let i = 0; i < 4; i += 1) await page.keyboard.press('Control+z');
  await until(page, 'edits', ['is', 0], 'undone');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  // By the pointing tool and Delete, too.
  await page.keyboard.press('1');
  await page.mouse.click(at.x, at.y);
  await page.locator('#b-prune-chosen').waitFor();
  await page.keyboard.press('Delete');
  await page.waitForFunction((d) => document.body.dataset.digest === d, pruned);
  await page.keyboard.press('Escape');
  await page.locator('.strip').waitFor({ state: 'hidden' });
}

/** Q takes what bears the twig under the pointer, for every tool that means a branch. */
async function bearer({ page, url, shot }) {
  const plain = await inHand(page, url, 1);
  const meant = () =>
    page.evaluate(() => [document.body.dataset.picked, Number(document.body.dataset.bears)]);
  const see = (what, of) =>
    page.waitForFunction(
      ([w, picked, bears]) => {
        const now = document.body.dataset;
        return w === 'same'
          ? now.picked === picked
          : now.picked !== '' && now.picked !== picked && Number(now.bears) > bears;
      },
      [what, ...of],
    );
  // A twig that is not borne by the trunk.
  let [at, twig, bough] = [{ k: 3 }];
  do {
    at = await branch(page, at.k + 1);
    twig = await meant();
    await page.keyboard.press('q');
    await see('more', twig);
    bough = await meant();
    if (bough[0] === '0') await page.keyboard.press('Shift+Q');
  } while (bough[0] === '0');
  await shot('shape-bearer');
  await page.keyboard.press('Shift+Q');
  await see('same', twig);
  // Not beyond what stands on the ground, and as often back again.
  let steps = 0;
  for (let [now] = twig; now !== '0'; [now] = await meant()) {
    await page.keyboard.press('q');
    await page.waitForFunction((was) => document.body.dataset.picked !== was, now);
    steps += 1;
  }
  await page.keyboard.press('q');
  await answered(page);
  await page.locator('#b-shape-up', { hasText: new RegExp(`\\+${steps}$`) }).waitFor();
  for (let k = 0; k < steps; k += 1) {
    await page.click('#b-shape-down');
    await answered(page);
  }
  await page.locator('#b-shape-down:disabled').waitFor();
  await page.mouse.move(at.x - 1, at.y);
  await page.mouse.move(at.x, at.y);
  await see('same', twig);
  // A branch that was clicked gives its place to what bears it.
  await page.mouse.click(at.x, at.y);
  await page.locator('#b-prune-chosen').waitFor();
  const said = await page.locator('.options').textContent();
  await page.keyboard.press('q');
  await page.waitForFunction(
    (was) =>
      document.querySelector('.options').textContent !== was && document.querySelector('#b-prune-chosen'),
    said,
  );
  await page.waitForFunction((bears) => document.body.dataset.bears === String(bears), bough[1]);
  await page.keyboard.press('Delete');
  await changed(page, plain, 'the bough is gone');
  await unfold(page);
  const removed = async () => Number(/−(\d+)/.exec(await page.locator('.edits li').textContent())?.[1]);
  await eventually(removed, (n) => n >= bough[1], `branches are gone, it bore ${bough[1]}`);
  await shot('shape-bearer-pruned');
}

/** Something is carried, elsewhere than before. */
async function carries(page, before = '') {
  await page.waitForFunction((was) => !['', was].includes(document.body.dataset.carried ?? ''), before);
  return data(page, 'carried');
}

async function rotate({ page, url, shot }) {
  const plain = await inHand(page, url, 2);
  const at = await branch(page);
  await page.keyboard.press('2');
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  for (let k = 1; k <= 8; k += 1) await page.mouse.move(at.x + 3 * k, at.y + 12 * k);
  const carried = await carries(page);
  assert.equal(await count(page, 'edits'), 0, 'nothing is kept before the hand lets go');
  await shot('shape-rotate-held');
  assert.equal(await data(page, 'digest'), plain, 'it is moved, and nothing is made again');
  await page.mouse.wheel(0, -100);
  await carries(page, carried);
  await page.mouse.up();
  await until(page, 'edits', ['is', 1], 'one drag is one edit');
  await until(page, 'done', ['is', 1], 'done');
  await settled(page);
  await rested(page);
  await shot('shape-rotate');
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  // Escape while it is held leaves nothing.
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + 40, at.y + 60, { steps: 4 });
  await carries(page);
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.body.dataset.carried === '');
  await page.mouse.up();
  assert.equal(await settled(page), plain);
  assert.equal(await count(page, 'edits'), 0);
  // The second button turns the view meanwhile.
  await rested(page);
  const before = await page.screenshot();
  await page.mouse.move(at.x, at.y);
  await page.mouse.down({ button: 'right' });
  await page.mouse.move(at.x + 150, at.y, { steps: 6 });
  await page.mouse.up({ button: 'right' });
  await rested(page);
  assert.notDeepEqual(await page.screenshot(), before);
  assert.equal(await settled(page), plain);
}

async function draw({ page, url, shot }) {
  const plain = await inHand(page, url, 6);
  const at = await branch(page);
  await page.keyboard.press('6');
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  for (let k = 1; k <= 14; k += 1) await page.mouse.move(at.x + 9 * k, at.y - 7 * k + 0.4 * k * k);
  await answered(page);
  await shot('shape-sketch-held');
  await page.mouse.up();
  await until(page, 'edits', ['is', 1], 'a drawn branch');
  await until(page, 'done', ['is', 1], 'done');
  await changed(page, plain, 'it bears a new branch');
  await rested(page);
  await shot('shape-sketch');
  await unfold(page);
  await page.locator('.edits li', { hasText: /draw a branch\+\d+ branches/ }).waitFor();
}

async function brush({ page, url, shot }) {
  let digest = await inHand(page, url, 7);
  const centre = await CENTRE(page);
  await page.mouse.move(centre.x, centre.y);
  await page.keyboard.press(']');
  await answered(page);
  await page.mouse.down();
  for (let k = 1; k <= 10; k += 1) await page.mouse.move(centre.x - 11 * k, centre.y - 9 * k);
  await pictures(page);
  await shot('shape-brush-held');
  await page.mouse.up();
  await until(page, 'edits', ['is', 1], 'a brush stroke');
  await until(page, 'done', ['is', 1], 'branches grew along it');
  digest = await changed(page, digest, 'brushed');
  await rested(page);
  await shot('shape-brush');
  // Leaves: fewer within the stroke.
  await page.keyboard.press('9');
  await page.mouse.move(centre.x, centre.y - 60);
  await page.mouse.down();
  await page.mouse.move(centre.x + 60, centre.y - 60, { steps: 6 });
  await page.mouse.up();
  await until(page, 'done', ['is', 2], 'leaves went');
  digest = await changed(page, digest, 'fewer leaves');
  // A silhouette around the crown.
  await page.keyboard.press('8');
  const n = 24;
  for (let i = 0; i <= n; i += 1) {
    const a = (i / n) * 2 * Math.PI;
    await page.mouse.move(centre.x + 120 * Math.sin(a), centre.y - 40 - 110 * Math.cos(a));
    if (i === 0) await page.mouse.down();
  }
  await pictures(page);
  await shot('shape-silhouette-held');
  await page.mouse.up();
  await until(page, 'edits', ['is', 3], 'an outline');
  await changed(page, digest, 'filled');
  await rested(page);
  await shot('shape-silhouette');
  // What an outline cuts is asked for, and counted before.
  const filled = await settled(page);
  const small = async () => {
    for (let i = 0; i <= n; i += 1) {
      const a = (i / n) * 2 * Math.PI;
      await page.mouse.move(centre.x + 60 * Math.sin(a), centre.y - 40 - 60 * Math.cos(a));
      if (i === 0) await page.mouse.down();
    }
    await page.mouse.up();
    await page.locator('#b-outline-cut').waitFor();
  };
  await page.click('#b-shape-trim');
  await small();
  const told = await page.locator('dialog p').textContent();
  assert.match(told, /[1-9]\d* branches/, told);
  await shot('shape-cut');
  await page.keyboard.press('Escape');
  await page.waitForFunction((d) => document.body.dataset.digest === d, filled);
  assert.equal(await count(page, 'edits'), 3, 'nothing was done');
  await small();
  await page.click('#b-outline-cut');
  await until(page, 'edits', ['is', 4], 'it is cut');
  await changed(page, filled, 'it is cut');
}

async function seeds({ page, url, shot }) {
  const plain = await inHand(page, url, 4);
  const at = await branch(page, 9);
  await page.keyboard.press('4');
  await page.click('#b-shape-whole');
  await page.mouse.click(at.x, at.y);
  await until(page, 'done', ['is', 1], 'pruned');
  let digest = await changed(page, plain, 'pruned');
  for (let tries = 0; tries < 24 && (await count(page, 'undone')) === 0; tries += 1) {
    await page.keyboard.press('Shift+R');
    digest = await changed(page, digest, 'another seed');
  }
  assert.equal(await count(page, 'undone'), 1, 'a seed without such a branch');
  await unfold(page);
  await page.locator('.edits .is-bad', { hasText: 'not done: the branch is gone' }).waitFor();
  await rested(page);
  await shot('shape-gone');
  await page.click('#b-language');
  await page.locator('.edits .is-bad', { hasText: '枝条已不存在' }).waitFor();
  await page.click('#b-theme');
  await page.click('#b-theme');
  await rested(page);
  await shot('shape-dark-chinese');
}

async function kept({ page, url, troubles }) {
  await inHand(page, url, 4);
  const at = await branch(page);
  await page.keyboard.press('4');
  await page.click('#b-shape-whole');
  await page.mouse.click(at.x, at.y);
  await until(page, 'done', ['is', 1], 'pruned');
  const digest = await settled(page);
  const [project] = await Promise.all([page.waitForEvent('download'), page.click('#b-save')]);
  const path = await project.path();
  await page.waitForFunction(() => /Saved/.test(document.querySelector('#b-kept').textContent));
  await reloaded(page);
  await until(page, 'edits', ['is', 1], 'the edit is recovered');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  await page.click('#b-fresh');
  await until(page, 'edits', ['is', 0], 'a new scene');
  const chooser = page.waitForEvent('filechooser');
  await page.click('#b-open');
  await (await chooser).setFiles(path);
  await until(page, 'edits', ['is', 1], 'the file has it');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  // When the worker falls, its edits are done again.
  const [worker] = page.workers();
  await worker
    .evaluate(() => {
      setTimeout(() => {
        throw new Error('made to fall by the test');
      });
    })
    .catch(() => {});
  await page.locator('.note.bad', { hasText: 'started again' }).waitFor();
  await until(page, 'done', ['is', 1], 'and still there');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  assert.deepEqual(
    troubles.splice(0).filter((what) => !what.includes('made to fall by the test')),
    [],
  );
}

async function drawn({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  const plain = await settled(page);
  await page.keyboard.press('Shift+S');
  await page.locator('.strip').waitFor();
  const at = await branch(page, 0, true);
  await page.keyboard.press('2');
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + 70, at.y + 20, { steps: 6 });
  await page.mouse.up();
  await until(page, 'done', ['is', 1], 'a drawn stem is turned');
  await changed(page, plain, 'turned');
  await rested(page);
  await shot('shape-drawing');
  assert.equal((await exported(page, 'glb')).bytes.subarray(0, 4).toString(), 'glTF');
  // The sheet keeps its own tools and keys.
  await becomes(() => count(page, 'strokes'), 15, 'the number of strokes');
  await page.keyboard.press('Escape');
  // A click on a plant of the scene chooses it.
  await add(page, 'flower');
  await settled(page);
  await rested(page);
  const box = await page.locator('.view').boundingBox();
  search: for (let k = 0; k < 12; k += 1) {
    for (let j = 0; j < 8; j += 1) {
      await page.mouse.click(box.x + box.width * (0.45 + 0.045 * k), box.y + box.height * (0.25 + 0.08 * j));
      await answered(page);
      if ((await data(page, 'current')) === 'sketch') break search;
    }
  }
  assert.equal(await data(page, 'current'), 'sketch', 'clicked in the view');
}

/** Fingers: one shapes, a second one lets go and turns the view. */
async function fingers({ page, url, context, shot }) {
  const plain = await inHand(page, url, 2);
  const at = await branch(page);
  await page.keyboard.press('2');
  const cdp = await context.newCDPSession(page);
  const send = (type, points) =>
    cdp.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  await send('touchStart', [[at.x, at.y]]);
  for (let k = 1; k < 8; k += 1) await send('touchMove', [[at.x + 4 * k, at.y + 10 * k]]);
  await carries(page);
  await send('touchStart', [
    [at.x + 28, at.y + 70],
    [at.x + 90, at.y + 60],
  ]);
  await page.waitForFunction(() => document.body.dataset.carried === '');
  await send('touchEnd', []);
  assert.equal(await settled(page), plain);
  assert.equal(await count(page, 'edits'), 0, 'a second finger lets go');
  await send('touchStart', [[at.x, at.y]]);
  for (let k = 1; k < 8; k += 1) await send('touchMove', [[at.x + 4 * k, at.y + 10 * k]]);
  await send('touchEnd', []);
  await until(page, 'done', ['is', 1], 'one finger, one edit');
  await settled(page);
  await rested(page);
  await shot('shape-tablet');
}

/** What is held grows on while nothing moves, and faster with the wheel; letting go keeps it. */
async function grow({ page, url, shot }) {
  const plain = await inHand(page, url, 1);
  const at = await branch(page);
  await page.keyboard.press('0');
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  const seen = [plain];
  for (let k = 0; k < 5; k += 1) {
    seen.push(await stirred(page, seen.at(-1), 'it grows'));
    if (k === 2) await page.mouse.wheel(0, -100);
  }
  assert.equal(new Set(seen).size, seen.length, 'another plant each time');
  await shot('shape-growing');
  await page.mouse.up();
  await until(page, 'edits', ['is', 1], 'one edit');
  await until(page, 'done', ['is', 1], 'it was done');
  const grown = await changed(page, plain, 'grown');
  await rested(page);
  await shot('shape-grown');
  await page.locator('#b-undo[title*="growth"]').waitFor();
  // Nothing grows on after that, and one undo takes all of it back.
  assert.equal(await settled(page), grown);
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  // On the ground beside it, and Escape.
  const box = await page.locator('.view').boundingBox();
  await page.mouse.move(box.x + box.width * 0.78, box.y + box.height * 0.66);
  await page.mouse.down();
  await stirred(page, plain, 'a stem grows');
  await page.keyboard.press('Escape');
  await page.mouse.up();
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await until(page, 'edits', ['is', 0], 'nothing was kept');
}

/** From the empty sky a branch begins at the wood beside it; too far away it is said why nothing happens. */
async function sky({ page, url, shot }) {
  const plain = await inHand(page, url, 6);
  const at = await branch(page);
  await page.keyboard.press('6');
  const box = await page.locator('.view').boundingBox();
  const edge = box.x + box.width - 90;
  let told = 0;
  // From far beside the bush towards it: the first line that makes a branch began in the sky.
  for (let x = edge; x > at.x; x -= 25) {
    await page.mouse.move(x, at.y);
    await page.mouse.move(x + 1, at.y);
    await answered(page);
    const over = await data(page, 'picked');
    await page.evaluate(() => {
      for (const note of document.querySelectorAll('.note')) note.remove();
    });
    await page.mouse.down();
    for (let k = 1; k <= 10; k += 1) await page.mouse.move(x + 5 * k, at.y - 8 * k);
    await page.mouse.up();
    await page.waitForFunction(
      () => document.body.dataset.edits === '1' || document.querySelector('.note') !== null,
    );
    await answered(page);
    if ((await count(page, 'edits')) === 1) {
      assert.equal(over, '', 'it began in the sky');
      break;
    }
    assert.match(await page.locator('.note').first().textContent(), /none is near/);
    told += 1;
  }
  assert.ok(told > 0, 'far away it says why not');
  await until(page, 'edits', ['is', 1], 'a drawn branch');
  await until(page, 'done', ['is', 1], 'done');
  await changed(page, plain, 'it bears a new branch');
  await rested(page);
  await shot('shape-sky');
}

/** Where the control balls of a leaf are on the page, the tip first. */
async function balls(page) {
  await rested(page);
  await page.waitForFunction(() => (document.body.dataset.balls ?? '') !== '');
  const box = await page.locator('.view').boundingBox();
  const places = (await data(page, 'balls')).split(' ').map(Number);
  return Array.from({ length: places.length / 3 }, (_, i) => [
    box.x + places[3 * i],
    box.y + places[3 * i + 1],
  ]);
}

/** A leaf is taken by its marks: one is pulled, another made thicker; all go back to where they were measured. */
async function marks({ page, url, shot }) {
  await begin(page, url);
  await drop(page, 'tobacco.csv', readFileSync('../../fixtures/leaves/leaf1.csv', 'utf8'));
  await until(page, 'triangles', ['above', 500], 'a leaf from marks');
  const through = await settled(page);
  await page.selectOption('[data-path="/surface"]', 'approximate');
  await changed(page, through, 'another surface');
  const plain = await settled(page);
  assert.equal((await data(page, 'balls')) ?? '', '');
  await page.keyboard.press('Shift+S');
  const before = await balls(page);
  assert.equal(before.length, 71, 'ten rows of seven marks and the tip');
  const [x, y] = before[0];
  await page.mouse.move(x + 3, y - 2);
  await page.mouse.down();
  for (let k = 1; k <= 10; k += 1) await page.mouse.move(x + 3, y - 2 - 6 * k);
  await page.mouse.up();
  await changed(page, plain, 'the tip was pulled');
  const pulled = await settled(page);
  // The camera follows the plant: what counts is where the tip is beside the base of the leaf.
  const away = (all) => Math.hypot(all[0][0] - all[67][0], all[0][1] - all[67][1]);
  const after = await eventually(
    () => balls(page),
    (now) => Math.abs(away(now) - away(before)) > 8,
    'the tip went with the pointer',
  );
  await shot('leaf-marks');
  await becomes(() => page.locator('#b-measured').count(), 1, 'the button of what was measured');
  // The wheel over a mark makes its veins thicker, and does not zoom.
  const mark = after[11];
  await page.mouse.move(...mark);
  for (let k = 0; k < 6; k += 1) await page.mouse.wheel(0, -100);
  await changed(page, pulled, 'a thicker vein');
  const thick = await settled(page);
  // On a busy machine the turns of the wheel come apart, and are as many steps back.
  let back = 0;
  for (let digest = thick; digest !== pulled && back < 6; back += 1) {
    await page.keyboard.press('Control+z');
    await changed(page, digest, 'a step back');
    digest = await settled(page);
  }
  for (let k = 0; k < back; k += 1) {
    const digest = await data(page, 'digest');
    await page.keyboard.press('Control+y');
    await changed(page, digest, 'a step forward');
    await settled(page);
  }
  assert.equal(await data(page, 'digest'), thick, 'forward again');
  // Held and given up with Escape, nothing is done.
  const now = await balls(page);
  await page.mouse.move(...now[4]);
  await page.mouse.down();
  await page.mouse.move(now[4][0] + 40, now[4][1] + 20);
  await page.keyboard.press('Escape');
  await page.mouse.up();
  assert.equal(await settled(page), thick);
  // Elsewhere the view is turned as always.
  const centre = await CENTRE(page);
  await page.mouse.move(centre.x, centre.y + 200);
  await page.mouse.down();
  await page.mouse.move(centre.x + 120, centre.y + 200, { steps: 5 });
  await page.mouse.up();
  assert.notDeepEqual(await balls(page), now, 'another view');
  assert.equal(await settled(page), thick);
  await page.click('#b-measured');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => document.body.dataset.balls === '');
}

export const shaping = [
  ['shape: prune a branch and undo', prune, WIDE],
  ['shape: what bears a twig', bearer, WIDE],
  ['shape: turn a branch', rotate, WIDE],
  ['shape: draw a branch', draw, WIDE],
  ['shape: a branch from the sky', sky, WIDE],
  ['shape: brush, leaves, outline', brush, WIDE],
  ['shape: it grows while it is held', grow, WIDE],
  ['shape: another seed says what is gone', seeds, WIDE],
  ['shape: saved, reloaded, recovered', kept, WIDE],
  ['shape: a drawing, and a click on a plant', drawn, WIDE],
  ['shape: marks of a leaf', marks, WIDE],
  ['shape: fingers', fingers, { viewport: { width: 820, height: 1000 }, hasTouch: true }],
];
