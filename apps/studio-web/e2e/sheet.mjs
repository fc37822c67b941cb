// What a hand does on the sheet beside drawing: chooses with a lasso, aligns, waits for a plain figure, taps with several
// fingers, repeats round a centre, carries strokes to another document, takes colours, says what is meant.
import assert from 'node:assert/strict';
import { begin, blade, changed, count, draw, drawFlower, line, settled, until } from './journeys.mjs';
import { answered, becomes, eventually, pictures, reloaded, saved } from './waits.mjs';

const CLIPBOARD = { permissions: ['clipboard-read', 'clipboard-write'] };
export const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** What undo would take back. */
const step = (page, name) => page.locator(`#b-undo[title*="${name}"]`).waitFor();

/** How many strokes are chosen, by the title of their card. */
const chosen = (page, n) => page.locator('.card strong', { hasText: String(n) }).waitFor();

/** All strokes as their points, as the clipboard has them. */
async function inked(page) {
  await answered(page);
  await page.evaluate(() => navigator.clipboard.writeText(''));
  await page.keyboard.press('Control+a');
  await page.keyboard.press('Control+c');
  const text = await eventually(
    () => page.evaluate(() => navigator.clipboard.readText()),
    (now) => now.startsWith('{'),
    'the clipboard holds',
  );
  await page.keyboard.press('Escape');
  await page.keyboard.press('p');
  return JSON.parse(text).strokes;
}

/** Points of a stroke in the JSON of a drawing. */
const pointsOf = (stroke) => stroke.points.map(([x, y]) => [x, y]);

/** How far points are from the line through the first and the last. */
function bow(points) {
  const [[ax, ay], [bx, by]] = [points[0], points.at(-1)];
  const size = Math.hypot(bx - ax, by - ay);
  return Math.max(...points.map(([x, y]) => Math.abs((x - ax) * (by - ay) - (y - ay) * (bx - ax)) / size));
}

/** Two halves of an outline are chosen and said to be one leaf: one stroke, one organ, one step. */
async function oneLeaf({ page, url, shot }) {
  await begin(page, url);
  await drawFlower(page);
  const whole = await count(page, 'strokes');
  const half = (side) =>
    Array.from({ length: 15 }, (_, k) => [380 + 40 * side * Math.sin((k * Math.PI) / 14), 420 - 8 * k]);
  await draw(page, half(1));
  await draw(page, half(-1));
  await until(page, 'strokes', ['is', whole + 2], 'two halves');
  const apart = await settled(page);
  await page.click('#b-select');
  const box = await page.locator('.sheet').boundingBox();
  await page.mouse.click(box.x + 420, box.y + 364);
  await page.keyboard.down('Shift');
  await page.mouse.click(box.x + 340, box.y + 364);
  await page.keyboard.up('Shift');
  await chosen(page, 2);
  await shot('one-leaf-card');
  await page.locator('.card .chip', { hasText: 'One leaf or petal' }).click();
  await until(page, 'strokes', ['is', whole + 1], 'one outline');
  await changed(page, apart, 'one leaf');
  await page.locator('.card .chip[aria-pressed=true]', { hasText: 'petal or leaf' }).waitFor();
  await shot('one-leaf');
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, apart);
}

async function lasso({ page, url, shot }) {
  await begin(page, url);
  const strokes = await drawFlower(page);
  const plain = await settled(page);
  await page.click('#b-lasso');
  // Round both leaves; the stem between them lies mostly outside.
  const round = Array.from({ length: 25 }, (_, k) => [
    250 + 135 * Math.cos((k * Math.PI) / 12),
    440 + 85 * Math.sin((k * Math.PI) / 12),
  ]);
  const box = await page.locator('.sheet').boundingBox();
  await page.mouse.move(box.x + round[0][0], box.y + round[0][1]);
  await page.mouse.down();
  for (const [x, y] of round) await page.mouse.move(box.x + x, box.y + y);
  await pictures(page);
  await shot('lasso-drawn');
  await page.mouse.up();
  await chosen(page, 2);
  await shot('lasso-chosen');
  // Aligned with a key, and by a button of their card.
  await page.keyboard.press('Control+ArrowDown');
  await step(page, 'align');
  const low = await changed(page, plain, 'aligned at the bottom');
  await page.locator('.card .arrange button[aria-label="Align on the centre"]').click();
  await changed(page, low, 'and on the centre');
  for (const _ of [1, 2]) await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  // A chosen stroke is dragged; the other goes with it.
  const leaf = blade(255, 430, -0.6, 110, 25);
  await draw(page, line(leaf[3][0], leaf[3][1], leaf[3][0] + 30, leaf[3][1] + 40));
  await step(page, 'move');
  const moved = await changed(page, plain, 'moved');
  await page.locator('.card .chip', { hasText: 'Duplicate' }).click();
  await until(page, 'strokes', ['is', strokes + 2], 'both twice');
  await page.keyboard.press('Delete');
  await until(page, 'strokes', ['is', strokes], 'the copies were chosen, and go');
  // A tap takes one stroke, one with Shift another; three are spaced.
  await page.mouse.click(box.x + 440, box.y + 540);
  await page.locator('.card').waitFor({ state: 'hidden' });
  const petals = [0, 1, 2].map((k) => blade(250, 210, -Math.PI / 2 + (k * 2 * Math.PI) / 5, 95, 28)[3]);
  await page.keyboard.down('Shift');
  for (const [x, y] of petals) await page.mouse.click(box.x + x, box.y + y);
  await page.keyboard.up('Shift');
  await chosen(page, 3);
  await page.locator('.card .arrange button[aria-label^="Same room between them, bottom"]').click();
  await step(page, 'align');
  await changed(page, moved, 'spaced');
}

/** A hand that trembles along a line or round a middle. */
const trembling = (points) => points.map(([x, y], i) => [x + 2 * Math.sin(7 * i), y + 2 * Math.cos(5 * i)]);

async function hold({ page, url, shot }) {
  await begin(page, url);
  const held = async (points) => {
    const box = await page.locator('.sheet').boundingBox();
    await page.mouse.move(box.x + points[0][0], box.y + points[0][1]);
    await page.mouse.down();
    for (const [x, y] of points) await page.mouse.move(box.x + x, box.y + y);
  };
  // The pen rests: the line is straight before it is lifted.
  await held(trembling(line(250, 520, 262, 180, 6, 30)));
  await page.waitForTimeout(800);
  await shot('hold-line');
  await page.mouse.up();
  await until(page, 'strokes', ['is', 1], 'a stroke');
  await step(page, 'straighten');
  assert.ok(bow(pointsOf((await inked(page))[0])) < 1e-6, 'a straight line');
  // Undo gives back what was drawn, and then takes it away.
  await page.keyboard.press('Control+z');
  await step(page, 'draw');
  assert.ok(bow(pointsOf((await inked(page))[0])) > 2, 'the hand’s line');
  await page.keyboard.press('Control+Shift+z');
  await step(page, 'straighten');
  // A circle.
  const round = Array.from({ length: 40 }, (_, k) => [
    258 + 58 * Math.cos((k * Math.PI) / 20),
    130 + 58 * Math.sin((k * Math.PI) / 20),
  ]);
  await held(trembling(round));
  await page.waitForTimeout(800);
  await shot('hold-circle');
  await page.mouse.up();
  await until(page, 'strokes', ['is', 2], 'a second');
  await step(page, 'straighten');
  const circle = pointsOf((await inked(page))[1]).slice(1);
  const middle = [0, 1].map((k) => circle.reduce((sum, p) => sum + p[k] / circle.length, 0));
  const radii = circle.map(([x, y]) => Math.hypot(x - middle[0], y - middle[1]));
  assert.ok(Math.max(...radii) - Math.min(...radii) < 0.02 * radii[0], 'a circle');
  // Who goes on after a rest means no figure.
  await held(trembling(line(120, 500, 130, 350, 4, 20)));
  await page.waitForTimeout(800);
  const box = await page.locator('.sheet').boundingBox();
  for (const [x, y] of line(130, 350, 200, 300, 20)) await page.mouse.move(box.x + x, box.y + y);
  await page.mouse.up();
  await until(page, 'strokes', ['is', 3], 'a third');
  await step(page, 'draw');
}

async function taps({ page, url, context, shot }) {
  await begin(page, url);
  const cdp = await context.newCDPSession(page);
  const box = await page.locator('.sheet').boundingBox();
  const send = (type, points) =>
    cdp.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: points.map(([x, y], id) => ({ x: box.x + x, y: box.y + y, id })),
    });
  const path = line(150, 300, 200, 120, 8);
  await send('touchStart', [path[0]]);
  for (const p of path.slice(1)) await send('touchMove', [p]);
  await send('touchEnd', []);
  await until(page, 'strokes', ['is', 1], 'a finger draws');
  /** So many fingers, down and up again. */
  const tap = async (fingers) => {
    const at = Array.from({ length: fingers }, (_, k) => [100 + 60 * k, 90 + 10 * k]);
    await send('touchStart', at);
    await send('touchEnd', []);
  };
  await tap(2);
  await until(page, 'strokes', ['is', 0], 'two fingers undo');
  await tap(3);
  await until(page, 'strokes', ['is', 1], 'three do it again');
  // Fingers that move the sheet undo nothing.
  await send('touchStart', [
    [100, 200],
    [200, 200],
  ]);
  await send('touchMove', [
    [60, 200],
    [260, 200],
  ]);
  await send('touchEnd', []);
  await answered(page);
  assert.equal(await count(page, 'strokes'), 1);
  await shot('taps-phone');
}

async function radial({ page, url, shot }) {
  await begin(page, url);
  await page.keyboard.press('y');
  await page.locator('#b-turns-count').fill('40');
  await page.keyboard.press('Tab');
  await becomes(() => page.locator('#b-turns-count').inputValue(), '24', 'no more than it may be');
  await page.locator('#b-turns-count').fill('7');
  await page.keyboard.press('Tab');
  await shot('radial-panel');
  // The person puts the centre.
  const box = await page.locator('.sheet').boundingBox();
  await page.mouse.click(box.x + 260, box.y + 260);
  await page.locator('.popover').waitFor({ state: 'detached' });
  await page.locator('#b-turns[aria-pressed=true]').waitFor();
  assert.equal(await count(page, 'strokes'), 0, 'that was no stroke');
  await draw(page, blade(260, 230, -Math.PI / 2, 110, 24));
  await until(page, 'strokes', ['is', 7], 'seven petals');
  await page.locator('#b-counts', { hasText: 'Petals 7' }).waitFor();
  await shot('radial-petals');
  // What is closed round the centre is there once.
  const ring = Array.from({ length: 33 }, (_, k) => [
    260 + 26 * Math.cos((k * Math.PI) / 16),
    260 + 26 * Math.sin((k * Math.PI) / 16),
  ]);
  await draw(page, ring);
  await until(page, 'strokes', ['is', 8], 'one disc');
  for (const left of [7, 0]) {
    await page.keyboard.press('Control+z');
    await until(page, 'strokes', ['is', left], 'one step takes stroke and copies');
  }
  await page.keyboard.press('Control+Shift+z');
  await until(page, 'strokes', ['is', 7], 'and gives them back');
  // They are kept as one request, too.
  await saved(page);
  await reloaded(page);
  await until(page, 'strokes', ['is', 7], 'after a reload');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', 0], 'one step still');
}

async function carried({ page, url }) {
  await begin(page, url);
  const n = await drawFlower(page);
  const plain = await settled(page);
  await page.locator('.sheet').focus();
  await page.keyboard.press('Control+a');
  await page.keyboard.press('Control+c');
  await eventually(
    () => page.evaluate(() => navigator.clipboard.readText()),
    (now) => now.startsWith('{'),
    'the clipboard holds',
  );
  // Another page of the browser, which copied nothing: the system's clipboard carries them.
  const other = await page.context().newPage();
  await begin(other, url);
  await other.click('#b-fresh');
  await until(other, 'strokes', ['is', 0], 'an empty document');
  await other.locator('.sheet').focus();
  await other.keyboard.press('Control+v');
  await until(other, 'strokes', ['is', n], 'strokes of the other document');
  assert.notEqual(await settled(other), '', plain);
  await other.keyboard.press('Control+z');
  await until(other, 'strokes', ['is', 0], 'one step');
  // By the palette, for those without such keys; and what another program wrote.
  const svg =
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><path d="M50 90L52 60L50 20" stroke="#c02060"/></svg>';
  await other.evaluate((text) => navigator.clipboard.writeText(text), svg);
  await other.keyboard.press('Control+k');
  await other.locator('.palette input').fill('paste');
  await other.keyboard.press('Enter');
  await until(other, 'strokes', ['is', 1], 'a line of an SVG');
  await other.close();
}

async function colours({ page, url, shot }) {
  await begin(page, url);
  await draw(page, line(250, 520, 250, 200, 8));
  await until(page, 'strokes', ['is', 1], 'a stem');
  await draw(page, blade(252, 400, -0.5, 120, 28));
  await until(page, 'strokes', ['is', 2], 'a leaf');
  // The leaf has a colour; the dropper takes it up and the pen has it then.
  const box = await page.locator('.sheet').boundingBox();
  const leaf = blade(252, 400, -0.5, 120, 28);
  await page.keyboard.press('v');
  await page.mouse.click(box.x + leaf[3][0], box.y + leaf[3][1]);
  await page.locator('.card input[type=color]').evaluate((field) => {
    field.value = '#b03090';
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await step(page, 'colour');
  await page.keyboard.press('p');
  await page.click('#b-pen');
  await page.click('#b-pen-take');
  await page.locator('#b-dropper[aria-pressed=true]').waitFor();
  await page.mouse.click(box.x + 440, box.y + 540);
  await page.locator('.note', { hasText: 'no colour here' }).waitFor();
  await page.mouse.click(box.x + leaf[3][0], box.y + leaf[3][1]);
  await page.locator('#b-parts[aria-pressed=true]').waitFor();
  await draw(page, blade(248, 330, Math.PI + 0.5, 110, 26));
  await until(page, 'strokes', ['is', 3], 'another leaf');
  await page.click('#b-pen');
  await page.locator('.colour-row', { hasText: '× 2' }).waitFor();
  await shot('colours-panel');
  // What the colour means is said once for all strokes of it.
  await page.selectOption('.colour-row select', 'fruit');
  await step(page, 'change what a stroke is');
  await page.keyboard.press('Escape');
  await page.keyboard.press('v');
  await page.mouse.click(box.x + leaf[3][0], box.y + leaf[3][1]);
  await page.locator('.card .chip[aria-pressed=true]', { hasText: 'fruit' }).waitFor();
  await page.locator('.card .chip', { hasText: 'All 2 of this colour' }).click();
  await chosen(page, 2);
  await page.locator('.card .chip[aria-pressed=true]', { hasText: 'fruit' }).waitFor();
  await page.keyboard.press('Control+z');
  await step(page, 'draw');
}

async function meets({ page, url, shot }) {
  await begin(page, url);
  await draw(page, line(250, 520, 250, 120, 0, 20));
  await until(page, 'strokes', ['is', 1], 'a stem');
  const toward = line(400, 250, 256, 330, 0, 14);
  const box = await page.locator('.sheet').boundingBox();
  await page.mouse.move(box.x + 400, box.y + 250);
  await page.mouse.down();
  for (const [x, y] of toward) await page.mouse.move(box.x + x, box.y + y);
  await pictures(page);
  await shot('meets-ring');
  await page.mouse.up();
  await until(page, 'strokes', ['is', 2], 'a branch that ends just before it');
  const [stem, branch] = (await inked(page)).map(pointsOf);
  const off = (line) => Math.abs(line.at(-1)[0] - stem[0][0]);
  assert.ok(off(branch) < 1e-6, `the branch meets the stem: ${off(branch)}`);
  await page.keyboard.press('j');
  await page.locator('.note', { hasText: 'stay where they are drawn' }).waitFor();
  await draw(page, line(110, 250, 244, 330, 0, 14));
  await until(page, 'strokes', ['is', 3], 'another');
  assert.ok(off(pointsOf((await inked(page))[2])) > 1, 'it ends where it was drawn');
  // That is remembered.
  await reloaded(page);
  await page.keyboard.press('j');
  await page.locator('.note', { hasText: 'meet what is drawn' }).waitFor();
}

async function meant({ page, url, shot }) {
  await begin(page, url);
  await draw(page, line(250, 520, 250, 200, 8));
  await until(page, 'strokes', ['is', 1], 'a stem');
  // The pen draws leaves next: of a line, too.
  await page.keyboard.press('2');
  await page.locator('#b-meant', { hasText: 'petal or leaf' }).waitFor();
  await draw(page, blade(252, 400, -0.5, 120, 28));
  await until(page, 'strokes', ['is', 2], 'a leaf');
  await settled(page);
  await shot('meant-pen');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', 1], 'stroke and class are one step');
  await page.keyboard.press('Control+Shift+z');
  await until(page, 'strokes', ['is', 2], 'both are back');
  await page.click('#b-meant');
  await page.locator('#b-meant').waitFor({ state: 'hidden' });
  const box = await page.locator('.sheet').boundingBox();
  const leaf = blade(252, 400, -0.5, 120, 28);
  await page.keyboard.press('v');
  await page.mouse.click(box.x + leaf[3][0], box.y + leaf[3][1]);
  await page.locator('.card .chip[aria-pressed=true]', { hasText: 'petal or leaf' }).waitFor();
  // By key, of what is chosen; and left to the page again.
  await page.keyboard.press('6');
  await page.locator('.card .chip[aria-pressed=true]', { hasText: 'fruit' }).waitFor();
  await page.keyboard.press('`');
  await page.locator('.card .chip[aria-pressed=true]', { hasText: 'Automatic' }).waitFor();
  await page.keyboard.press('Escape');
  // In the panel of the pen, for fingers.
  await page.click('#b-pen');
  await page.click('[data-means=fruit]');
  await page.locator('#b-meant', { hasText: 'fruit' }).waitFor();
}

/** What is no part of the plant looks so, and is said to be something by two clicks. */
async function left({ page, url, shot }) {
  await begin(page, url);
  const n = await drawFlower(page);
  await settled(page);
  assert.equal(await count(page, 'left'), 0);
  const spiral = Array.from({ length: 31 }, (_, k) => [380 + k * Math.cos(k / 2), 480 + k * Math.sin(k / 2)]);
  await draw(page, spiral);
  await until(page, 'strokes', ['is', n + 1], 'a spiral beside it');
  const chip = page.locator('.readings .left-out', { hasText: '1 not in the plant' });
  await chip.waitFor();
  await settled(page);
  await shot('left-out');
  await chip.click();
  await page.locator('.card', { hasText: 'no part of the plant' }).waitFor();
  await shot('left-out-card');
  await page.locator('.card .chip', { hasText: 'fruit' }).click();
  await until(page, 'left', ['is', 0], 'it is something now');
  await chip.waitFor({ state: 'detached' });
  await page.keyboard.press('Control+z');
  await until(page, 'left', ['is', 1], 'it is left out again');
}

export const sheet = [
  ['what is no part of the plant is told', left],
  ['a lasso chooses strokes, which are aligned', lasso],
  ['a pen that rests draws a plain figure', hold, CLIPBOARD],
  ['taps of several fingers undo and redo', taps, PHONE],
  ['strokes are repeated round a centre', radial],
  ['strokes go to another document', carried, CLIPBOARD],
  ['colours are taken and mean something', colours],
  ['ends of strokes meet what is drawn', meets, CLIPBOARD],
  ['what is drawn is said by key', meant],
  ['two strokes are one leaf', oneLeaf],
];
