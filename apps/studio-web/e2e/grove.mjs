// Many plants in one scene: copies, gizmos by keys, what is drawn on the ground, and what anybody can use.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import {
  add,
  BUSH,
  begin,
  bush,
  changed,
  count,
  data,
  exported,
  sample,
  settled,
  slide,
  until,
} from './journeys.mjs';
import { frameOf, mean } from './staging.mjs';
import { answered, becomes, eventually, loaded, pictures, rested } from './waits.mjs';

const WIDE = { viewport: { width: 1360, height: 760 } };
const AXE = readFileSync(new URL('../node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');

/** A small tree, grown and seen. */
async function planted(page, url) {
  await bush(page, url);
  await rested(page);
}

const field = (page, key) => page.locator(`[data-key=${key}]`).inputValue().then(Number);
const middle = async (page) => {
  const box = await page.locator('.view').boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2, box };
};

/** What undo would take back, as its button says it. */
const undone = (page) => page.locator('#b-undo').getAttribute('title');

/** Drags the gizmo by its first handle that is found below the middle of the view, which is drawn anew when it is hovered. */
async function pull(page, by) {
  const { x, y, box } = await middle(page);
  await page.mouse.move(x, box.y + 4);
  await rested(page);
  for (let k = 0; k < 400; k += 1) {
    const at = [x - 60 + 15 * (k % 25), y + box.height * (0.02 + 0.03 * Math.floor(k / 25))];
    await page.mouse.move(...at);
    if ((await page.locator('.view').getAttribute('data-rests')) === '1') continue;
    await page.mouse.down();
    await page.mouse.move(at[0] + by, at[1], { steps: 4 });
    await page.mouse.up();
    await settled(page);
    return;
  }
  throw new Error('no handle under the pointer');
}

/** A tree that takes long tells how far it is. */
async function progress({ page, url }) {
  await begin(page, url);
  await page.evaluate(() => {
    const told = [];
    const read = () => {
      const percent = /(\d+)\s*%/.exec(document.querySelector('.busy')?.textContent ?? '')?.[1];
      if (percent !== undefined && told.at(-1) !== Number(percent)) told.push(Number(percent));
    };
    new MutationObserver(read).observe(document.body, {
      subtree: true,
      childList: true,
      characterData: true,
    });
    globalThis.told = told;
  });
  await add(page, 'tree', 'birch');
  await until(page, 'triangles', ['above', 1000], 'it has grown');
  await settled(page);
  const told = await page.evaluate(() => globalThis.told);
  assert.ok(told.length > 3, `told: ${told}`);
  assert.ok(Math.max(...told) > 60 && Math.min(...told) < 60, `from early to late: ${told}`);
}

/** A copy shares its meshes and is written once. */
async function copies({ page, url, shot }) {
  await planted(page, url);
  await page.click('.scene .fold');
  const alone = (await exported(page, 'glb')).bytes.length;
  for (let k = 2; k <= 4; k += 1) {
    await page.locator('[data-plant=tree]').last().click();
    await settled(page);
    await page.click('[id^=b-more-] >> nth=-1');
    const before = await count(page, 'revision');
    await page.click('.menu >> text=Duplicate');
    await until(page, 'revision', ['above', before], 'it is seen');
    await until(page, 'plants', ['is', k], 'a copy');
  }
  await settled(page);
  await rested(page);
  assert.equal(await count(page, 'meshes'), 1, 'all of them share one plant');
  await shot('grove-copies');
  const four = (await exported(page, 'glb')).bytes.length;
  assert.ok(four < alone + 5000, `${four} bytes of four, ${alone} of one`);
  // Another seed is another plant, and the others stay as they are.
  const digest = await settled(page);
  await page.keyboard.press('Shift+R');
  await changed(page, digest, 'another seed');
  assert.equal(await count(page, 'meshes'), 2);
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  await until(page, 'meshes', ['is', 1], 'shared again');
  // By the keys that duplicate strokes where some are chosen.
  await page.keyboard.press('Control+d');
  await until(page, 'plants', ['is', 5], 'one more');
  await page.keyboard.press('Control+z');
  await until(page, 'plants', ['is', 4], 'and gone');
}

/** Move, turn and size by keys, with steps and along an axis. */
async function gizmos({ page, url, shot }) {
  await planted(page, url);
  await page.click('.scene .fold');
  const pressed = (mode, on) => page.locator(`[data-gizmo=${mode}][aria-pressed=${on}]`).waitFor();
  for (const [key, mode] of [
    ['g', 'translate'],
    ['r', 'rotate'],
    ['s', 'scale'],
  ]) {
    await page.keyboard.press(key);
    await pressed(mode, true);
  }
  await answered(page);
  assert.equal(await count(page, 'plants'), 1, 'no dice were rolled');
  await page.keyboard.press('Escape');
  await pressed('scale', false);
  await page.click('[data-key=snap]');
  await page.keyboard.press('g');
  await page.keyboard.press('x');
  await loaded(page, 'gizmo');
  await pull(page, 120);
  await eventually(
    () => field(page, 'nx'),
    (at) => at !== 0,
    'the handle moves the plant',
  );
  assert.equal(await field(page, 'nz'), 0, 'it is bound to x');
  await rested(page);
  await shot('grove-gizmo');
  for (const key of ['nx', 'nz']) {
    const at = await field(page, key);
    assert.ok(Math.abs(at / 0.25 - Math.round(at / 0.25)) < 1e-6, `${key} is ${at}`);
  }
  await eventually(
    () => undone(page),
    (title) => /place/.test(title),
    'the drag is a step',
  );
}

/** A plant that is dragged goes as far as the pointer does on the ground, and its shadow with it. */
async function dragged({ page, url, shot }) {
  await planted(page, url);
  await page.click('.scene .fold');
  await page.keyboard.press('g');
  await page.keyboard.press('x');
  await loaded(page, 'gizmo');
  const { x, y, box } = await middle(page);
  const pose = JSON.parse(await page.locator('.view').getAttribute('data-eye'));
  const frame = frameOf(pose, box.height);
  /** How much darker the ground is where a plant there throws its shadow than beside it. */
  const shade = async (at) => {
    await rested(page);
    const bytes = await page.locator('.view canvas').screenshot();
    const [px, py] = frame.to(at);
    const luma = async (dx) => {
      const [u, v] = [0.5 + (px + dx) / box.width, 0.5 + py / box.height];
      const { rgb } = await mean(page, bytes, [u - 0.2, v - 0.07, u - 0.05, v - 0.03]);
      return (rgb[0] + rgb[1] + rgb[2]) / 3;
    };
    return (await luma(box.width * 0.25)) - (await luma(0));
  };
  const first = await shade([0, 0, 0]);
  assert.ok(first > 8, `it throws a shadow: ${first}`);
  const [foot, right] = [frame.to([0, 0, 0]), frame.to([1, 0, 0])];
  const axis = [right[0] - foot[0], right[1] - foot[1]].map((d, _, of) => d / Math.hypot(...of));
  const hot = (d) => [x + foot[0] + d * axis[0], y + foot[1] + d * axis[1]];
  const way = 82;
  await page.mouse.move(...hot(52));
  await pictures(page);
  await page.mouse.down();
  await page.mouse.move(...hot(52 + way), { steps: 6 });
  await page.mouse.up();
  await settled(page);
  const to = await field(page, 'nx');
  assert.ok(to > 0, 'the handle moves the plant');
  const [u, v] = frame.to([to * pose.metre, 0, 0]);
  const went = Math.hypot(u - foot[0], v - foot[1]);
  assert.ok(Math.abs(went - way) < 0.1 * way, `${went} pixels, the pointer ${way}`);
  const there = await shade([to * pose.metre, 0, 0]);
  assert.ok(there > 0.6 * first, `its shadow went along: ${there}, ${first} before`);
  await shot('grove-dragged');
}

/** What is being typed stays while the panel is filled anew; what was taken is shown as it was taken. */
async function typing({ page, url }) {
  await planted(page, url);
  await page.click('.scene .fold');
  const old = await page.locator('[data-key=nx]').elementHandle();
  const grown = async (share) => {
    const digest = await settled(page);
    await slide(page, 'age', share);
    await changed(page, digest, 'another age');
  };
  await page.locator('[data-key=nx]').selectText();
  await page.keyboard.type('1.2');
  // Something else changes the plant meanwhile.
  await grown(0.6);
  await becomes(() => old.evaluate((e) => e.isConnected), false, 'the panel of before');
  assert.doesNotMatch(await undone(page), /place/, 'nothing was taken yet');
  await page.keyboard.type('5');
  await becomes(() => page.locator('[data-key=nx]').inputValue(), '1.25', 'what is typed');
  await page.keyboard.press('Enter');
  await page.locator('#b-undo[title*="place"]').waitFor();
  await becomes(() => field(page, 'nx'), 1.25, 'what was taken');
  // Taken by Enter, or by leaving it, also where nothing is typed any more.
  for (const [text, leave] of [
    ['0.5', 'Enter'],
    ['0.75', 'Tab'],
  ]) {
    await page.locator('[data-key=nx]').selectText();
    await page.keyboard.type(text);
    await grown(text === '0.5' ? 0.8 : 0.5);
    assert.doesNotMatch(await undone(page), /place/);
    await page.keyboard.press(leave);
    await page.locator('#b-undo[title*="place"]').waitFor();
    await becomes(() => field(page, 'nx'), Number(text), 'what was taken');
  }
  // A size beyond what there may be is shown as it was taken, not as it was typed.
  await page.locator('[data-key=nscale]').selectText();
  await page.keyboard.type('0');
  await page.keyboard.press('Enter');
  await eventually(
    () => field(page, 'nscale'),
    (size) => size > 0,
    'no plant has no size',
  );
}

/** Plants that are chosen together are a group, and go as one. */
async function groups({ page, url, shot }) {
  await planted(page, url);
  await page.click('.scene .fold');
  const rows = page.locator('.plant[data-plant=tree]');
  const menu = async (row, item) => {
    await page.click(`[id^=b-more-] >> nth=${row}`);
    await page.click(`.menu >> text=${item}`);
  };
  for (const k of [2, 3]) {
    await menu(0, 'Duplicate');
    await until(page, 'plants', ['is', k], 'a copy');
    await settled(page);
    await rows.first().click();
    await settled(page);
  }
  const choose = async (row) => {
    await rows.nth(row).click();
    await page.waitForFunction(
      (k) => document.querySelectorAll('.plant[data-plant=tree]')[k].getAttribute('aria-pressed') === 'true',
      row,
    );
    await settled(page);
  };
  // The copies stand in one place: the second one goes on.
  await choose(2);
  await page.fill('[data-key=nz]', '-1');
  await page.locator('[data-key=nz]').blur();
  await settled(page);
  await becomes(() => field(page, 'nz'), -1, 'where it stands');
  const place = async (row) => {
    await choose(row);
    return [await field(page, 'nx'), await field(page, 'nz')];
  };
  const before = [await place(1), await place(2)];
  await rows.nth(1).click();
  await settled(page);
  await rows.nth(2).click({ modifiers: ['Control'] });
  await page.getByText('2 plants chosen').waitFor();
  await becomes(() => page.locator('.plant[aria-pressed=true]').count(), 2, 'what is chosen');
  await page.keyboard.press('Control+g');
  const group = page.locator('.plant.group');
  await page.locator('.plant.group[aria-pressed=true]', { hasText: 'Group 1 × 2' }).waitFor();
  // The gizmo takes both.
  await page.keyboard.press('g');
  await loaded(page, 'gizmo');
  await pull(page, 60);
  await eventually(
    () => undone(page),
    (title) => /place/.test(title),
    'the handle moves them',
  );
  await page.keyboard.press('Escape');
  await rested(page);
  await shot('grove-group');
  const after = [await place(1), await place(2)];
  const by = after.map((at, row) => at.map((v, k) => v - before[row][k]));
  assert.ok(Math.hypot(...by[0]) > 0.01, `${by[0]}`);
  assert.ok(Math.hypot(by[0][0] - by[1][0], by[0][1] - by[1][1]) < 0.002, `${by} are alike`);
  await page.keyboard.press('Control+z');
  await page.waitForFunction(
    (z) => Number(document.querySelector('[data-key=nz]').value) === z,
    before[1][1],
  );
  assert.deepEqual([await place(1), await place(2)], before, 'one step of undo takes both back');
  // Hidden, copied, parted, deleted as one.
  await page.click('[data-key="geGroup 1"]');
  // The group and its plants.
  await page.waitForFunction(() => document.querySelectorAll('li.is-hidden').length === 3);
  await page.keyboard.press('Control+z');
  await page.locator('li.is-hidden').first().waitFor({ state: 'detached' });
  await page.click('[data-key="gmGroup 1"]');
  await page.click('.menu >> text=Duplicate');
  await until(page, 'plants', ['is', 5], 'a copy of both');
  await page.getByText('Group 2 × 2').waitFor();
  await page.getByText('Group 2 × 2').click();
  await page.keyboard.press('Control+Shift+G');
  await page.getByText('Group 2 × 2').waitFor({ state: 'detached' });
  await settled(page);
  await group.click();
  await settled(page);
  await group.press('Delete');
  await until(page, 'plants', ['is', 3], 'its plants went with it');
  await page.keyboard.press('Control+z');
  await until(page, 'plants', ['is', 5], 'and came back');
  await settled(page);
  // A locked plant keeps all of them.
  await group.click();
  await settled(page);
  await page.click('#b-fix');
  await page.locator('[data-gizmo=translate]:disabled').waitFor();
}

/** Copies along a line on the ground; they are a group. */
async function scatter({ page, url, shot }) {
  await planted(page, url);
  await page.click('.scene .fold');
  const spacing = await field(page, 'nspacing');
  assert.ok(spacing > 0.1, `the crown is ${spacing} m wide`);
  // Half a crown apart, so that several have room on what this window shows.
  await page.fill('[data-key=nspacing]', String(spacing / 2));
  await page.locator('[data-key=nspacing]').blur();
  await rested(page);
  const { x, box } = await middle(page);
  const floor = box.y + box.height * 0.86;
  await page.click('[data-scatter=line]');
  await page.mouse.move(x - 150, floor);
  await page.mouse.down();
  await page.mouse.move(x + 260, floor, { steps: 12 });
  await pictures(page);
  await shot('grove-line-held');
  await page.mouse.up();
  await until(page, 'plants', ['above', 2], 'copies stand along the line');
  await settled(page);
  const many = await count(page, 'plants');
  await until(page, 'meshes', ['above', 1], 'seeds of their own');
  assert.ok((await count(page, 'meshes')) <= 4, 'three kinds and the first');
  await page.locator('.plant.group', { hasText: `bush × ${many}` }).waitFor();
  await rested(page);
  await shot('grove-line');
  await page.click('[data-key="gebush"]');
  await page.locator('li.is-hidden').first().waitFor();
  await page.keyboard.press('Control+z');
  await page.locator('li.is-hidden').first().waitFor({ state: 'detached' });
  await page.keyboard.press('Control+z');
  await until(page, 'plants', ['is', 1], 'one step of undo takes all copies back');
  await settled(page);
  await rested(page);
  await page.click('[data-scatter=area]');
  const ring = Array.from({ length: 25 }, (_, k) => [
    x + 210 * Math.cos(k / 4),
    floor - 40 + 55 * Math.sin(k / 4),
  ]);
  await page.mouse.move(...ring[0]);
  await page.mouse.down();
  for (const at of ring) await page.mouse.move(...at);
  await page.mouse.up();
  await until(page, 'plants', ['above', 2], 'copies fill the area');
  await settled(page);
  await rested(page);
  await shot('grove-area');
  await page.keyboard.press('Control+z');
  await until(page, 'plants', ['is', 1], 'they are gone');
  await settled(page);
  await rested(page);
  // The brush sets copies about its way, one step for the whole way.
  await page.click('[data-scatter=brush]');
  await page.mouse.move(x - 200, floor);
  await page.mouse.down();
  await page.mouse.move(x + 200, floor - 30, { steps: 14 });
  await page.mouse.up();
  await until(page, 'plants', ['above', 2], 'copies stand where the brush was');
  await settled(page);
  await rested(page);
  await shot('grove-brush');
  await page.keyboard.press('Control+z');
  await until(page, 'plants', ['is', 1], 'one step takes them back');
}

/** Files that come together, and a model that is only looked at. */
async function files({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  const glb = await exported(page, 'glb');
  const toml = BUSH.replace('"bush"', '"other"');
  await page.evaluate(
    ([a, b]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([a], 'bush.toml'));
      transfer.items.add(new File([b], 'other.toml'));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
    },
    [BUSH, toml],
  );
  await until(page, 'plants', ['is', 3], 'both files came in');
  const chooser = page.waitForEvent('filechooser');
  await page.click('#b-open');
  await (await chooser).setFiles({ name: 'looked.glb', mimeType: 'model/gltf-binary', buffer: glb.bytes });
  await page.locator('#b-looking-close').waitFor();
  await page.locator('#b-looking', { hasText: 'sample' }).waitFor();
  await rested(page);
  await shot('grove-looking');
  await page.click('#b-looking-close');
  await page.locator('#b-looking').waitFor({ state: 'hidden' });
  await answered(page);
  assert.equal(await count(page, 'plants'), 3, 'the scene is as it was');
}

/** What a tool was set to is its own; branches by keys; a line from the sky. */
async function tools({ page, url, shot }) {
  await planted(page, url);
  await page.keyboard.press('Shift+S');
  await page.locator('.strip').waitFor();
  await page.keyboard.press('2');
  await page.keyboard.press('q');
  await page.locator('#b-shape-up', { hasText: /\+1$/ }).waitFor();
  await page.keyboard.press('3');
  // Bearer +1 stays with its tool.
  await page.locator('#b-shape-up', { hasText: /^[^+]*$/ }).waitFor();
  // By keys alone: the trunk, what it bears, the next one, and back.
  await page.keyboard.press('1');
  await rested(page);
  const { x, y, box } = await middle(page);
  await page.mouse.move(box.x + 4, box.y + 4);
  await answered(page);
  const picked = async (key, test) => {
    const before = await page.locator('.options').textContent();
    await page.keyboard.press(key);
    if (test !== 'same')
      await page.waitForFunction((b) => document.querySelector('.options').textContent !== b, before);
    await answered(page);
    return data(page, 'picked');
  };
  const trunk = await picked('.');
  const bough = await picked('Shift+Q');
  assert.notEqual(bough, trunk);
  await page.keyboard.press('.');
  await page.waitForFunction((b) => document.body.dataset.picked !== b, bough);
  await shot('grove-keys');
  await page.keyboard.press('Delete');
  await until(page, 'done', ['is', 1], 'pruned without a pointer');
  const plain = await settled(page);
  assert.equal(await page.locator('.edits ol').count(), 0, 'the list of edits is folded');
  // A branch from nowhere says so.
  await page.keyboard.press('6');
  await page.mouse.move(box.x + box.width * 0.84, y - box.height * 0.35);
  await page.mouse.down();
  await page.mouse.move(x + box.width * 0.3, y - box.height * 0.42, { steps: 6 });
  await page.mouse.up();
  await page.locator('.note', { hasText: 'begins on wood' }).waitFor();
  assert.equal(await settled(page), plain);
}

/** The panel: what matters first, the rest folded, search, and one value as it was. */
async function panel({ page, url, shot }) {
  await begin(page, url);
  await page.click('#b-add');
  await page.click('[data-add=tree]');
  // The catalogue comes first.
  await page.locator('dialog [data-preset]').first().waitFor();
  const species = await page
    .locator('dialog [data-preset]')
    .evaluateAll((all) => all.map((e) => e.dataset.preset));
  assert.ok(species.includes('oak') && !species.some((key) => key.startsWith('oak-')), species.join());
  assert.equal(
    await page.locator('dialog .thumb:has(img) svg').count(),
    0,
    'no placeholder behind a picture',
  );
  await page.click('dialog [data-preset=hazel]');
  await until(page, 'triangles', ['above', 1000], 'a hazel');
  const plain = await settled(page);
  const shown = () => page.locator('.form .f-row:visible').count();
  await becomes(shown, 5, 'the number of settings at first');
  await rested(page);
  await shot('grove-panel');
  const length = page.locator('input[data-path="/leaves/length_m"]');
  const was = await length.inputValue();
  await length.fill(String(2 * Number(was)));
  await length.press('Enter');
  const longer = await changed(page, plain, 'longer leaves');
  await page.locator('.f-row', { has: length }).locator('.f-reset').click();
  await changed(page, longer, 'as it was');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await becomes(() => length.inputValue(), was, 'the length of leaves');
  await page.locator('.f-search input').fill('light');
  await page.waitForFunction(() => {
    const found = [...document.querySelectorAll('.form .f-row')].filter((row) => row.checkVisibility());
    return found.length > 0 && found.every((row) => /light/i.test(row.textContent));
  });
  await shot('grove-search');
  await page.locator('.f-search input').fill('');
  await page.waitForFunction(() => document.querySelectorAll('.form details').length > 2);
  await becomes(shown, 5, 'the number of settings');
  await add(page, 'leaf');
  await page.waitForFunction(() => document.body.dataset.current === 'leaf');
  const made = await settled(page);
  await rested(page);
  await shot('grove-leaf-numbers');
  const lobes = page.locator('input[data-path="/form/lobes"]');
  await lobes.fill('0.5');
  await lobes.press('Enter');
  const lobed = await changed(page, made, 'lobes');
  await shot('grove-leaf-lobes');
  await page.click('#b-leaf-sample');
  await changed(page, lobed, 'a leaf from the sample');
  await until(page, 'triangles', ['above', 500], 'a leaf from the sample');
  await rested(page);
  await shot('grove-leaf-sample');
}

/** The panel of a drawing is made of its schemas: a value changed, given back, and one among the folded rows. */
async function settings({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  const plain = await settled(page);
  await page.click('#b-settings');
  await page.locator('.popover [data-path="/skin/petals"]').first().selectOption('blue');
  // The rows are shown anew with what was taken.
  await settled(page);
  await page.locator('.popover .f-search input').fill('height');
  const height = page.locator('.popover input[type=number][data-path="/height_m"]');
  await height.fill('2');
  await height.press('Enter');
  const taller = await changed(page, plain, 'two metres');
  await shot('drawing-settings');
  await page.locator('.popover .f-row:has([data-path="/height_m"]) .f-reset').click();
  await changed(page, taller, 'as tall as before');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
}

const OVER = 'dialog[open], .popover';

/** Until what was asked for lies over the page, with what it shows. */
async function opened(page) {
  await page.locator(OVER).first().waitFor();
  if ((await page.locator('.shelf-dialog').count()) > 0) await page.locator('.shelf-open').first().waitFor();
}

/** Until nothing on the page moves or changes its colour. */
async function calm(page) {
  await answered(page);
  await page.waitForFunction(() =>
    document
      .getAnimations()
      .every((a) => a.playState !== 'running' || a.effect?.getComputedTiming().endTime === Infinity),
  );
}

/** Nothing critical or serious, in what is seen first, with panels and dialogs. */
async function anybody({ page, url }) {
  await begin(page, url);
  // The policy of the page allows no text to become code: the driver brings it in.
  const cdp = await page.context().newCDPSession(page);
  const look = async (where) => {
    await calm(page);
    await cdp.send('Runtime.evaluate', { expression: AXE });
    const { result, exceptionDetails } = await cdp.send('Runtime.evaluate', {
      expression:
        "axe.run(document, { resultTypes: ['violations'] }).then((r) => JSON.stringify(r.violations.map((v) => " +
        '({ id: v.id, impact: v.impact, nodes: v.nodes.map((n) => n.html.slice(0, 160)).slice(0, 4) }))))',
      awaitPromise: true,
      returnByValue: true,
    });
    assert.ok(!exceptionDetails, JSON.stringify(exceptionDetails));
    const bad = JSON.parse(result.value).filter((v) => v.impact === 'critical' || v.impact === 'serious');
    assert.deepEqual(bad, [], `${where}: ${JSON.stringify(bad, null, 1)}`);
  };
  await look('an empty page');
  await sample(page);
  await look('a drawing');
  await page.keyboard.press('Shift+L');
  await page.locator('.layers [aria-pressed="true"]').first().waitFor();
  await look('layers');
  await page.keyboard.press('Escape');
  await add(page, 'tree', 'hazel');
  await until(page, 'triangles', ['above', 1000], 'a hazel');
  await look('a tree and its panel');
  await page.keyboard.press('Shift+S');
  await page.locator('.strip').waitFor();
  await look('tools');
  await page.keyboard.press('Escape');
  for (const id of ['export', 'help', 'documents', 'stage', 'camera', 'film', 'materials']) {
    await page.click(`#b-${id}`);
    await opened(page);
    await look(id);
    await page.keyboard.press('Escape');
    await page.locator(OVER).first().waitFor({ state: 'detached' });
  }
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').waitFor();
  await look('the palette');
  await page.keyboard.press('Escape');
}

/** On a phone whatever can be pressed is 44 pixels wide and high, and what the colours mean covers no button. */
async function fingers({ page, url, shot }) {
  await begin(page, url);
  assert.ok(await page.evaluate(() => matchMedia('(pointer: coarse)').matches));
  const look = async (where) => {
    await calm(page);
    const small = await page.evaluate(() => {
      const wanted = 'button, a, select, summary, input, [role=button], [role=option], [role=tab]';
      const seen = (e) => e.getBoundingClientRect().width > 0 && getComputedStyle(e).visibility !== 'hidden';
      // What stands in a label is pressed by it.
      const inLabel = (e) => (['checkbox', 'color'].includes(e.type) ? (e.closest('label') ?? e) : e);
      const target = (e) => inLabel(e).getBoundingClientRect();
      return [...document.querySelectorAll(wanted)]
        .filter((e) => seen(e) && Math.min(target(e).width, target(e).height) < 43.5)
        .map((e) => `${e.tagName} ${e.id || e.className} ${e.textContent.slice(0, 20)}`);
    });
    assert.deepEqual(small, [], where);
  };
  await look('an empty page');
  await sample(page);
  await look('a drawing');
  await page.locator('.readings .chip').first().waitFor();
  await settled(page);
  await eventually(
    () => Promise.all(['.legend', '.readings'].map((q) => page.locator(q).boundingBox())),
    ([legend, readings]) => legend.y >= readings.y + readings.height,
    'the legend covers no reading',
  );
  await shot('grove-phone');
  for (const key of ['t', 'c', 'o', 'Shift+L', 'Shift+M', 'Shift+O', 'Control+k', 'Control+e', 'Shift+S']) {
    await page.keyboard.press(key);
    const over = key === 'Shift+S' ? page.locator('.strip') : page.locator(OVER).first();
    if (key === 'Shift+S') await over.waitFor();
    else await opened(page);
    await look(key);
    await page.keyboard.press('Escape');
    await over.waitFor({ state: 'hidden' });
  }
  await page.keyboard.press(']');
  await page.locator('.card').first().waitFor();
  await look('the card of a stroke');
  await page.keyboard.press('Escape');
  await add(page, 'tree', 'hazel');
  await until(page, 'triangles', ['above', 1000], 'a hazel');
  await settled(page);
  await look('the panel of a tree');
  await page.click('.scene .fold');
  await look('the list of the scene');
  await page.click('.scene .fold');
  // On foot by a finger.
  await page.keyboard.press('n');
  await page.locator('#b-walk-stick').waitFor();
  await look('the stick');
  const eye = () => page.evaluate(() => JSON.parse(document.querySelector('.view').dataset.eye).position);
  await rested(page);
  const from = await eye();
  const box = await page.locator('#b-walk-stick').boundingBox();
  const at = { x: box.x + box.width / 2, y: box.y + box.height * 0.1, id: 1 };
  const client = await page.context().newCDPSession(page);
  await client.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [at] });
  await eventually(
    eye,
    (to) => Math.hypot(...to.map((x, i) => x - from[i])) > 0.05,
    `the stick leads from ${from}`,
  );
  await client.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  await shot('grove-walk');
  await page.click('#b-walk-end');
  await page.waitForFunction(() => document.body.dataset.walk === '');
  await page.locator('.walkpad').waitFor({ state: 'detached' });
}

const TABLET = { viewport: { width: 820, height: 1180 }, hasTouch: true };
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** A large tree is seen before it is whole, and what is seen at the end is the whole. */
async function seen({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'oak');
  await until(page, 'coarse', ['above', 0], 'a coarse oak');
  const oak = await settled(page);
  await until(page, 'triangles', ['above', 300_000], 'the whole oak');
  await shot('grove-oak');
  const looks = await data(page, 'coarse');
  await add(page, 'tree', 'maple');
  const maple = await changed(page, oak, 'a maple');
  assert.ok(Number(await data(page, 'coarse')) > Number(looks), 'a coarse maple');
  await page.keyboard.press('Control+z');
  await changed(page, maple, 'the oak again');
  await page.waitForFunction((d) => document.body.dataset.digest === d, oak);
}

/** From spring to winter and back: leaf by leaf, seen before it is exported; an evergreen has no autumn. */
async function seasons({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  await until(page, 'triangles', ['above', 1000], 'a hazel');
  const summer = await settled(page);
  const all = await count(page, 'triangles');
  const slide = (to) =>
    page.locator('[data-path=season]').evaluate((e, x) => {
      e.value = String(x);
      e.dispatchEvent(new Event('input', { bubbles: true }));
      e.dispatchEvent(new Event('change', { bubbles: true }));
    }, to);
  const word = page.locator('label:has([data-path=season]) output');
  const says = (what) => becomes(() => word.textContent(), what, 'the season');
  await says('summer');
  await slide(-0.7);
  const spring = await changed(page, summer, 'leaves unfold');
  assert.ok((await count(page, 'triangles')) < all);
  await says('unfolding');
  await rested(page);
  await shot('grove-spring');
  await slide(0.5);
  const autumn = await changed(page, spring, 'autumn');
  assert.equal(await count(page, 'triangles'), all, 'no leaf has fallen');
  await says('autumn');
  await rested(page);
  await shot('grove-autumn');
  await slide(0.8);
  const falling = await changed(page, autumn, 'leaves fall');
  const fewer = await count(page, 'triangles');
  assert.ok(fewer < all, `${fewer} of ${all}`);
  await slide(1);
  await changed(page, falling, 'bare');
  assert.ok((await count(page, 'triangles')) < fewer);
  // Each is a step of undo, by the keys too while the slider has them, and what is written is what is seen.
  await page.locator('[data-path=season]').focus();
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, falling);
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').waitFor();
  await page.click('#p-export-view');
  const lent = page.locator('#b-exportview [data-path=season]');
  await lent.waitFor();
  await slide(0.5);
  await page.waitForFunction((d) => document.body.dataset.digest === d, autumn);
  await page.click('#b-exportview-close');
  await page.locator('#b-maker [data-path=season]').waitFor();
  await add(page, 'tree', 'spruce');
  await page.waitForFunction(() => document.querySelector('#b-maker [data-path=season]')?.disabled);
}

/** A panel changes all plants that are chosen, as one step, and says where they differ. */
async function several({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  await until(page, 'triangles', ['above', 1000], 'a hazel');
  await settled(page);
  const rows = page.locator('.plant[data-plant=tree]');
  if ((await rows.count()) === 0) await page.click('.scene .fold');
  for (const n of [2, 3]) {
    await rows.first().click();
    await page.click('[id^=b-more-] >> nth=0');
    await page.click('.menu >> text=Duplicate');
    await until(page, 'plants', ['is', n], 'a copy');
    await settled(page);
  }
  const word = page.locator('label:has([data-path=season]) output');
  const length = page.locator('[data-path="/leaves/length_m"]').first();
  const slide = (to) =>
    page.locator('[data-path=season]').evaluate((e, x) => {
      e.value = String(x);
      e.dispatchEvent(new Event('input', { bubbles: true }));
      e.dispatchEvent(new Event('change', { bubbles: true }));
    }, to);
  /** Chooses each by itself and says its season. */
  const each = async () => {
    const said = [];
    for (const row of [0, 1, 2]) {
      await rows.nth(row).click();
      await page
        .locator(`.plant[data-plant=tree] >> nth=${row}`)
        .and(page.locator('[aria-current=true]'))
        .waitFor();
      await answered(page);
      said.push(await word.textContent());
    }
    return said;
  };
  const all = async () => {
    await rows.first().click();
    await page.keyboard.down('Shift');
    await rows.nth(2).click();
    await page.keyboard.up('Shift');
    await page.locator('.alike', { hasText: 'all 3' }).waitFor();
  };
  await rows.nth(1).click();
  await answered(page);
  await slide(0.5);
  await settled(page);
  await length.fill('0.05');
  await length.blur();
  await settled(page);
  assert.deepEqual(await each(), ['summer', 'autumn', 'summer']);
  await all();
  await becomes(() => word.textContent(), 'different', 'the season of all');
  assert.deepEqual(
    [await length.inputValue(), await length.getAttribute('placeholder')],
    ['', 'different'],
    'a number of which not all have the same',
  );
  // Where they stand is of all, too.
  await becomes(
    () => page.locator('[data-key=nx]').evaluate((f) => [f.value, f.placeholder]),
    ['', 'different'],
    'the places of all',
  );
  await page.fill('[data-key=nscale]', '1.2');
  await page.locator('[data-key=nscale]').blur();
  await page.locator('#b-undo[title*="place"]').waitFor();
  await rested(page);
  await shot('grove-several-mixed');
  for (const row of [2, 1, 0]) {
    await rows.nth(row).click();
    await becomes(() => field(page, 'nscale'), 1.2, `the size of ${row}`);
  }
  await page.keyboard.press('Control+z');
  await becomes(() => field(page, 'nscale'), 1, 'one step');
  await all();
  await slide(-0.7);
  await becomes(() => word.textContent(), 'unfolding', 'all have it');
  await settled(page);
  await length.fill('0.09');
  await length.blur();
  await settled(page);
  await rested(page);
  await shot('grove-several');
  assert.deepEqual(await each(), ['unfolding', 'unfolding', 'unfolding']);
  assert.equal(await length.inputValue(), '0.09');
  // Each is one step.
  for (const _ of [1, 2]) await page.keyboard.press('Control+z');
  await settled(page);
  assert.deepEqual(await each(), ['summer', 'autumn', 'summer']);
  // Another species for all.
  await all();
  await page.click('#b-maker [data-preset=birch]');
  await page.locator('#b-undo[title*="species"]').waitFor();
  await page.locator('#b-maker [data-preset=birch][aria-pressed=true]').waitFor();
  await page.keyboard.press('Control+z');
  await settled(page);
  assert.deepEqual(await each(), ['summer', 'autumn', 'summer']);
}

/** While plants are moved, turned or sized, numbers are typed. */
async function typed({ page, url, shot }) {
  await planted(page, url);
  await page.click('.scene .fold');
  await page.locator('[data-key=nx]').waitFor();
  const place = async () => [
    await field(page, 'nx'),
    await field(page, 'nz'),
    await field(page, 'nyaw'),
    await field(page, 'nscale'),
  ];
  const from = await place();
  const type = async (text) => {
    await page.keyboard.type(text);
    await page.locator('#b-typed').waitFor();
  };
  await page.keyboard.press('g');
  await type('2.55');
  await page.keyboard.press('Backspace');
  await page.locator('#b-typed', { hasText: '2.5 m' }).waitFor();
  await shot('grove-typed');
  await page.keyboard.press('Enter');
  await becomes(place, [from[0] + 2.5, ...from.slice(1)], 'moved along x');
  await type('-1,3');
  await page.keyboard.press('Enter');
  await becomes(place, [from[0] + 1.5, from[1] + 3, ...from.slice(2)], 'along both');
  await page.keyboard.press('r');
  await type('45');
  await page.keyboard.press('Enter');
  await becomes(place, [from[0] + 1.5, from[1] + 3, 45, 1], 'turned');
  await page.keyboard.press('s');
  await type('0');
  await page.keyboard.press('Enter');
  await page.locator('.note', { hasText: 'no such number' }).waitFor();
  await type('1.5');
  await page.keyboard.press('Enter');
  await becomes(place, [from[0] + 1.5, from[1] + 3, 45, 1.5], 'sized');
  for (let k = 0; k < 4; k += 1) await page.keyboard.press('Control+z');
  await becomes(place, from, 'four steps');
  // Escape leaves the number, and then the hand.
  await type('7');
  await page.keyboard.press('Escape');
  await page.locator('#b-typed').waitFor({ state: 'hidden' });
  await page.locator('[data-gizmo=scale][aria-pressed=true]').waitFor();
  await page.keyboard.press('Escape');
  await page.locator('[data-gizmo=scale][aria-pressed=false]').waitFor();
}

export const grove = [
  ['grove: a panel changes all that are chosen', several, WIDE],
  ['grove: numbers are typed', typed, WIDE],
  ['grove: seasons', seasons, WIDE],
  ['grove: a large tree is seen before it is whole', seen, WIDE],
  ['grove: how far it is', progress, WIDE],
  ['grove: copies share one plant', copies, WIDE],
  ['grove: gizmos by keys', gizmos, WIDE],
  ['grove: a plant goes where it is dragged, with its shadow', dragged, WIDE],
  ['grove: what is being typed stays', typing, WIDE],
  ['grove: chosen together, a group', groups, WIDE],
  ['grove: copies along a line and in an area', scatter, WIDE],
  ['grove: several files, and a model that is closed', files, WIDE],
  ['grove: tools keep to themselves', tools, WIDE],
  ['grove: panels for people', panel, WIDE],
  ['grove: settings of a drawing', settings, WIDE],
  ['grove: anybody can use it', anybody, WIDE],
  [
    'grove: anybody can use it in the dark, in Chinese',
    anybody,
    { ...WIDE, colorScheme: 'dark', locale: 'zh-CN' },
  ],
  ['grove: anybody can use it on a phone', anybody, { ...PHONE, colorScheme: 'dark' }],
  ['grove: fingers on a phone', fingers, PHONE],
  ['grove: fingers on a tablet', fingers, TABLET],
];
