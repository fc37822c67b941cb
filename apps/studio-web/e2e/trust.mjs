// What is seen is what there is, and each stroke is the sheet's.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import {
  add,
  begin,
  BUSH,
  bush,
  count,
  draw,
  drawFlower,
  exported,
  line,
  sample,
  settled,
  until,
} from './journeys.mjs';
import { filmed, lookedAt, palette, pixels, unzipped } from './staging.mjs';
import { answered, eventually, finished, pictures, rested, restingEye } from './waits.mjs';

/** The part of the view where no tools and lists are. */
const BESIDE_TOOLS = [0, 0.12, 0.85, 1];

const picture = async (page) => {
  const grain = await finished(page);
  // What is said of the last step goes by itself.
  await page.evaluate(() => {
    for (const note of document.querySelectorAll('.note')) note.remove();
  });
  return { grain, ...(await pixels(page, await page.locator('.view canvas').screenshot(), BESIDE_TOOLS)) };
};

/** The share of pixels that two pictures of one size do not have in common. */
function apart({ p }, { p: q }) {
  let differ = 0;
  for (let i = 0; i < p.length; i += 4)
    if (Math.abs(p[i] - q[i]) + Math.abs(p[i + 1] - q[i + 1]) + Math.abs(p[i + 2] - q[i + 2]) > 60)
      differ += 1;
  return (4 * differ) / p.length;
}

/** The box of the pixels of a kind in a picture: left, top, right, bottom. */
function boxOf({ p, across }, is) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i < p.length; i += 4) {
    if (!is(p[i], p[i + 1], p[i + 2])) continue;
    const [x, y] = [(i / 4) % across, Math.floor(i / 4 / across)];
    box[0] = Math.min(box[0], x);
    box[1] = Math.min(box[1], y);
    box[2] = Math.max(box[2], x);
    box[3] = Math.max(box[3], y);
  }
  return box;
}
const isYellow = (r, g, b) => r > 150 && g > 100 && b < 90;

/** The picture of the view, and that of what an export would write. */
async function drawnAndExported(page, file, shot) {
  const drawn = await picture(page);
  await palette(page, 'export-view');
  await page.locator('#b-exportview').waitFor();
  await lookedAt(page);
  const exported = await picture(page);
  await shot(file);
  await page.click('#b-exportview-close');
  return [drawn, exported];
}

async function parts({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'flower');
  for (const flower of ['sunflower', 'rose']) {
    await page.click(`[data-flower=${flower}]`);
    await settled(page);
    let drawn, exported;
    await eventually(
      async () => {
        [drawn, exported] = await drawnAndExported(page, `trust-${flower}`, shot);
        return [drawn.grain, exported.grain];
      },
      ([a, b]) => a === b,
      `pixels for each of the screen's, ${flower} in the view and exported`,
    );
    assert.ok(
      apart(drawn, exported) < 0.002,
      `${flower}: ${apart(drawn, exported)} of the view is not what is exported`,
    );
  }
}

/** Elements that take the pointer from the sheet although nothing can be pressed there. */
const blocked = (page) =>
  page.evaluate(() => {
    const box = document.querySelector('.sheet').getBoundingClientRect();
    const free = '.sheet, button, input, select, label, a, .tools, .day, .card, .tour';
    const found = new Set();
    for (let y = box.top + 2; y < box.bottom; y += 6)
      for (let x = box.left + 2; x < box.right; x += 6) {
        const top = document.elementFromPoint(x, y);
        if (top && !top.closest(free)) found.add(top.className || top.id || top.tagName);
      }
    return [...found];
  });

/** Pixels of selected strokes, but not of their frame, that lie under the card. */
const inkUnderCard = (page) =>
  page.evaluate(() => {
    const canvas = document.querySelectorAll('.sheet canvas')[1];
    const [of, card] = [canvas, document.querySelector('.card')].map((e) => e.getBoundingClientRect());
    const scale = canvas.width / of.width;
    const at = [card.x - of.x, card.y - of.y, card.width, card.height].map((n) => Math.round(n * scale));
    const { data } = canvas.getContext('2d').getImageData(...at);
    const FRAME = [23, 105, 170];
    let ink = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i + 3] > 200 && FRAME.some((c, k) => Math.abs(data[i + k] - c) > 60)) ink += 1;
    return ink;
  });

async function everyStroke({ page, link, shot }) {
  await begin(page, link);
  await until(page, 'triangles', ['above', 0], 'the file is open');
  await settled(page);
  await page.locator('.readings .chip').first().waitFor();
  assert.deepEqual(await blocked(page), [], 'what is no button lets the pen through');
  // Between the rows of readings a stroke begins.
  const strokes = await count(page, 'strokes');
  const sheet = await page.locator('.sheet').boundingBox();
  const [first, last] = await Promise.all(
    ['first', 'last'].map((which) => page.locator('.readings .chip')[which]().boundingBox()),
  );
  const [x, y] = [first.x - sheet.x - 12, first.y - sheet.y + first.height / 2];
  await draw(page, line(x, y, x - 40, y + 90));
  await until(page, 'strokes', ['is', strokes + 1], 'a stroke beside the readings');
  assert.ok(last.y >= first.y, 'readings are in rows');
  // Space moves the sheet, whatever button was pressed before.
  await page.click('#b-mirror');
  await page.click('#b-mirror');
  await page.mouse.move(sheet.x + 250, sheet.y + 400);
  await page.keyboard.down(' ');
  await page.mouse.down();
  await page.mouse.move(sheet.x + 290, sheet.y + 400, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up(' ');
  await answered(page);
  assert.equal(await count(page, 'strokes'), strokes + 1, 'Space draws nothing');
  assert.equal(await page.getAttribute('#b-mirror', 'aria-pressed'), 'false', 'and presses nothing');
  // The card lies over no part of what is selected, wherever that is.
  await page.keyboard.press('0');
  await draw(page, line(110, 520, 470, 120));
  await until(page, 'strokes', ['is', strokes + 2], 'a stroke across the sheet');
  await settled(page);
  for (let k = 0; k < 6; k += 1) {
    await page.keyboard.press('[');
    await page.locator('.card').waitFor();
    await pictures(page);
    assert.equal(await inkUnderCard(page), 0, `the stroke ${k} before the first is seen beside its card`);
    if (k === 0) await shot('trust-card');
  }
  // Another document begins with the pen.
  await page.keyboard.press('Escape');
  await page.click('#b-select');
  await page.click('#b-fresh');
  await page.locator('#b-parts[aria-pressed=true]').waitFor();
  await answered(page);
  await draw(page, line(250, 500, 260, 200));
  await until(page, 'strokes', ['is', 1], 'the pen draws');
}

/** Drags over the middle of the view, by so many pixels. */
async function orbit(page, by, steps = 1) {
  const box = await page.locator('.view').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + by, y, { steps });
  await page.mouse.up();
}

async function camera({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  await settled(page);
  // From behind, then another document: from the front again.
  await orbit(page, 230, 6);
  const behind = await restingEye(page);
  assert.ok(Math.abs(behind.position[0] - behind.target[0]) > 0.5, `turned: ${behind.position}`);
  await page.click('#b-fresh');
  await sample(page);
  await settled(page);
  const { position, target } = await restingEye(page);
  assert.ok(Math.abs(position[0] - target[0]) < 1e-3 && position[2] > target[2], `from ${position}`);
  // The front view is zoomed with the sheet, at the place under the wheel.
  await page.keyboard.press('d');
  const plain = boxOf(await picture(page), isYellow);
  const view = await page.locator('.view').boundingBox();
  await page.mouse.move(view.x + view.width / 2, view.y + view.height / 2);
  await page.mouse.wheel(0, -200);
  await pictures(page);
  const near = boxOf(await picture(page), isYellow);
  const wide = (box) => box[2] - box[0];
  const grew = wide(near) / wide(plain);
  assert.ok(Math.abs(grew - Math.exp(0.3)) < 0.05, `the wheel makes it ${grew} times as wide`);
  await shot('trust-front');
  // From there into orbit nothing jumps.
  await orbit(page, 1);
  await page.locator('#b-front[aria-pressed=false]').waitFor();
  const orbited = boxOf(await picture(page), isYellow);
  await shot('trust-orbit');
  const jump = Math.max(...orbited.map((at, i) => Math.abs(at - near[i])));
  assert.ok(jump < 0.05 * wide(near), `${jump} pixels: ${near} became ${orbited}`);
  // The view or the sheet alone, and both again.
  const main = await page.locator('main').boundingBox();
  const widths = () =>
    page.evaluate(() => ['.sheet', '.view'].map((q) => document.querySelector(q).clientWidth));
  const both = await widths();
  await page.keyboard.press('Shift+F');
  await pictures(page);
  const [none, all] = await widths();
  assert.ok(none === 0 && all > main.width - 10, `the view alone: ${none}, ${all}`);
  await shot('trust-view-alone');
  await page.keyboard.press('Shift+F');
  await page.keyboard.press('Shift+P');
  await pictures(page);
  assert.ok((await widths())[0] > main.width - 10, 'the sheet alone');
  await page.keyboard.press('Shift+P');
  await pictures(page);
  assert.deepEqual(await widths(), both);
}

/** What was composed by hand is what a film of growth shows: its middle is the picture of that day. */
async function composed({ page, url }) {
  await begin(page, url);
  await add(page, 'flower');
  await settled(page);
  const { days } = await page.evaluate(() => ({
    days: Number(document.querySelector('[data-path=day] input, input[data-path=day]').max),
  }));
  await page
    .locator('[data-path=day] input, input[data-path=day]')
    .first()
    .evaluate((e, day) => {
      e.value = String(day);
      e.dispatchEvent(new Event('input', { bubbles: true }));
      e.dispatchEvent(new Event('change', { bubbles: true }));
    }, days / 2);
  await settled(page);
  const view = await page.locator('.view').boundingBox();
  await page.mouse.move(view.x + view.width / 2, view.y + view.height / 3);
  await page.mouse.wheel(0, -300);
  await rested(page);
  const size = { width: 120, height: 160 };
  const still = await filmed(page, { shot: 'picture', ...size, transparent: false });
  const sheet = await filmed(page, {
    shot: 'growth',
    format: 'sheet',
    ...size,
    seconds: 1,
    fps: 3,
    transparent: false,
  });
  const [, columns, rows] = /-(\d)x(\d)\.png$/.exec(sheet.name).map(Number);
  const middle = [1 % columns, Math.floor(1 / columns)];
  const part = [middle[0] / columns, middle[1] / rows, (middle[0] + 1) / columns, (middle[1] + 1) / rows];
  const [alone, among] = [await pixels(page, still.bytes), await pixels(page, sheet.bytes, part)];
  assert.equal(alone.p.length, among.p.length);
  assert.ok(apart(alone, among) < 0.02, `${apart(alone, among)} of the picture is elsewhere in the film`);
}

/** Organs that were traced have the colours of the photograph. */
async function colours({ page, url, shot }) {
  await begin(page, url);
  await page.evaluate(async () => {
    const canvas = new OffscreenCanvas(60, 80);
    const c = canvas.getContext('2d');
    c.fillStyle = 'rgb(205 59 115)';
    c.fillRect(0, 0, 60, 80);
    const transfer = new DataTransfer();
    transfer.items.add(new File([await canvas.convertToBlob()], 'red.png', { type: 'image/png' }));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
  });
  await page.locator('.note', { hasText: 'Trace' }).waitFor();
  await drawFlower(page);
  await settled(page);
  const { p } = await picture(page);
  let [red, exact] = [0, 0];
  for (let i = 0; i < p.length; i += 4) {
    if (p[i] < 90 || p[i] < 2 * p[i + 1]) continue;
    red += 1;
    if ([205, 59, 115].every((c, k) => Math.abs(p[i + k] - c) <= 3)) exact += 1;
  }
  await shot('trust-colours');
  assert.ok(red > 3000 && exact > 0.9 * red, `${exact} of ${red} pixels are of the photograph`);
}

/** On a phone, too, plants are framed beside the list and above the tools. */
async function phone({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'flower');
  await page.click('[data-flower=sunflower]');
  await settled(page);
  await page.click('.scene .fold');
  await palette(page, 'frame');
  await rested(page);
  await shot('trust-phone');
  const whole = await pixels(page, await page.locator('.view canvas').screenshot());
  const [left, , , bottom] = boxOf(whole, isYellow);
  const scale = await page.evaluate(() => devicePixelRatio);
  const [view, list, tools] = await Promise.all(
    ['.view', '.scene', '.right-tools'].map((q) => page.locator(q).boundingBox()),
  );
  const [beside, above] = [(list.x + list.width - view.x) * scale, (tools.y - view.y) * scale];
  assert.ok(
    left >= beside - 2 && bottom <= above,
    `yellow from ${left}, ${bottom}; list to ${beside}, ${above}`,
  );
  assert.deepEqual(await blocked(page), [], 'what is no button lets the pen through');
}

/** An export for games: what is written is told before, and is what is saved; how large the plant is stands beside it. */
async function games({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'flower');
  await page.click('[data-flower=tulip]');
  await settled(page);
  await rested(page);
  assert.match(await page.locator('#b-extent').textContent(), /^\d[\d.]* m high, \d[\d.]* m wide$/);
  const plain = await exported(page, 'glb', 1);
  await page.click('#b-export');
  await page.click('#b-export-games');
  const told = await toldForGames(page);
  await shot('trust-games');
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#b-games-save')]);
  assert.equal(download.suggestedFilename(), 'tulip.glb.zip', 'it is called after the species');
  const zip = readFileSync(await download.path());
  assert.equal(told.length, 4, 'three levels and views from all sides');
  for (const [name, bytes, triangles] of told) {
    const file = unzipped(zip, name);
    assert.equal(file.length, bytes, name);
    assert.equal(trianglesOf(file), triangles, name);
  }
  assert.ok(told[0][1] < 0.3 * plain.bytes.length, `${told[0][1]} of ${plain.bytes.length} bytes`);
}

/** Waits until an export for games is counted: file, bytes and triangles of each row. */
async function toldForGames(page) {
  await page.locator('#b-games-save:enabled').waitFor();
  return page
    .locator('#b-games [data-file]')
    .evaluateAll((rows) =>
      rows.map((r) => [r.dataset.file, Number(r.dataset.bytes), Number(r.dataset.triangles)]),
    );
}

/** How many triangles a binary glTF shows: those of all its meshes. */
function trianglesOf(glb) {
  const { meshes, accessors } = JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());
  const counts = meshes.flatMap(({ primitives }) =>
    primitives.map(({ indices }) => accessors[indices].count / 3),
  );
  return counts.reduce((sum, n) => sum + n, 0);
}

/** A budget, smaller textures, cards and a program: each is counted before it is saved, and as large as the command's. */
async function budgets({ page, url, shot, burgeon }) {
  await bush(page, url);
  await page.click('#b-export');
  await page.click('#b-export-games');
  const [whole] = await toldForGames(page);
  const set = (field, value) =>
    page.locator(`#b-games-${field}`).evaluate((input, v) => {
      input.value = v;
      input.dispatchEvent(new Event('change', { bubbles: true }));
    }, String(value));
  await page.click('#b-games-sizes summary');
  const most = Math.floor(whole[2] / 3);
  await set('triangles', most);
  const [fewer] = await toldForGames(page);
  assert.ok(fewer[2] <= most && fewer[2] > most / 4, `${fewer[2]} triangles of ${most}`);
  await page.locator('#b-games .reduced', { hasText: 'level of detail' }).waitFor();
  await shot('games-budget');
  // As large as what the command makes of the same plant.
  const folder = mkdtempSync(join(tmpdir(), 'burgeon-games-'));
  const [file, out] = ['bush.toml', 'bush.glb'].map((name) => join(folder, name));
  writeFileSync(file, BUSH);
  execFileSync(burgeon, [
    'grow',
    file,
    '--quiet',
    '--pack',
    'meshopt',
    '--triangles',
    String(most),
    '-o',
    out,
  ]);
  const command = readFileSync(out);
  assert.equal(trianglesOf(command), fewer[2], 'as many triangles as the command writes');
  assert.ok(Math.abs(command.length / fewer[1] - 1) < 0.01, `${command.length} and ${fewer[1]} bytes`);
  // Small textures make small files; cards take fewer triangles than outlines.
  await set('triangles', '');
  await set('texture_size', '128');
  const [small] = await toldForGames(page);
  assert.ok(small[1] < whole[1] && small[2] === whole[2], `${small} of ${whole}`);
  await set('foliage', 'cards');
  const [cards] = await toldForGames(page);
  assert.ok(cards[2] < whole[2], `${cards[2]} triangles of ${whole[2]}`);
  // Nothing is as small as that: it is said, and nothing can be saved.
  await set('megabytes', '0.001');
  await page.locator('#b-games [role=alert]', { hasText: /has at least [\d.]+ megabytes/ }).waitFor();
  assert.ok(await page.locator('#b-games-save').isDisabled());
  await shot('games-too-small');
  await set('megabytes', '');
  await page.selectOption('#b-games-for', 'unity');
  const unity = await toldForGames(page);
  assert.equal(unity.length, 1, 'levels are nodes of one file');
  await page.locator('#b-games-set', { hasText: 'Set for Unity' }).waitFor();
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#b-games-save')]);
  assert.equal(readFileSync(await download.path()).length, unity[0][1]);
}

/** A plant is as high, as wide or as thick as is asked beside it; one step takes it back. */
async function sizes({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  await until(page, 'triangles', ['above', 1000], 'a hazel has grown');
  const plain = await settled(page);
  const extent = async () => {
    await rested(page);
    const text = await page.locator('#b-extent').textContent();
    return text.match(/[\d.]+/g).map(Number);
  };
  const ask = async (goal, value) => {
    await page.click('#b-extent');
    const field = page.locator(`#b-sizing [data-size=${goal}]`);
    await field.fill(String(value));
    await field.press('Enter');
    await page.locator('#b-sizing').waitFor({ state: 'detached' });
    return settled(page);
  };
  const before = await extent();
  await page.click('#b-extent');
  await page.locator('#b-sizing').waitFor();
  await shot('sizes');
  await page.keyboard.press('Escape');
  const small = await ask('height', 2);
  assert.notEqual(small, plain, 'a younger tree');
  const [high] = await extent();
  assert.ok(high > 1.9 && high < 2.4, `${high} m high, ${before} before`);
  await ask('width', 8);
  assert.equal((await extent())[1], 8);
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  // Out of reach: it is said how high and thick they become.
  await page.click('#b-extent');
  const girth = page.locator('#b-sizing [data-size=dbh]');
  await girth.fill('9');
  await girth.press('Enter');
  await page.locator('#b-sizing [role=status]', { hasText: 'out of reach' }).waitFor();
  await shot('sizes-out-of-reach');
  await page.keyboard.press('Escape');
}

/** Without a network the page comes from the browser, its picture too. */
async function offline({ page, context, url }) {
  await begin(page, url);
  await page.evaluate(() => navigator.serviceWorker.ready.then(() => {}));
  await page.waitForFunction(() => navigator.serviceWorker.controller !== null);
  await context.setOffline(true);
  await page.reload();
  await page.waitForFunction(() => document.body.dataset.ready === 'true');
  await page.waitForFunction(() => {
    const { complete, naturalWidth } = document.querySelector('.logo img');
    return complete && naturalWidth > 0;
  });
}

const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** A finger that selects a stroke presses nothing of the card that opens. */
async function tap({ page, link }) {
  await begin(page, link);
  await until(page, 'triangles', ['above', 0], 'the file is open');
  const digest = await settled(page);
  await page.click('#b-select');
  const sheet = await page.locator('.sheet').boundingBox();
  let opened = 0;
  for (const [x, y] of [
    [0.5, 0.75],
    [0.5, 0.6],
    [0.48, 0.5],
  ]) {
    await page.touchscreen.tap(sheet.x + x * sheet.width, sheet.y + y * sheet.height);
    await answered(page);
    if (await page.locator('.card').isVisible()) opened += 1;
    await page.keyboard.press('Escape');
  }
  assert.ok(opened > 0, 'a stroke was selected');
  assert.equal(await settled(page), digest, 'nothing was pressed');
}

export const trust = [
  ['what is drawn is what is exported', parts],
  ['every stroke is the sheet’s', everyStroke],
  ['camera: from the front, zoomed, into orbit', camera],
  ['a film of a composed view', composed],
  ['colours of a photograph', colours],
  ['for games', games],
  ['for games: budgets', budgets],
  ['height and width', sizes],
  ['height and width on a phone', sizes, PHONE],
  ['without a network', offline],
  ['plants beside the panels of a phone', phone, PHONE],
  ['a tap selects', tap, PHONE],
];
