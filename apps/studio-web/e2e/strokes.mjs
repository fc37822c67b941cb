// Strokes that were drawn are changed: bent, scaled, turned, cut, joined, rubbed out, smoothed, coloured.
import assert from 'node:assert/strict';
import { begin, blade, changed, count, draw, drawFlower, line, settled, until } from './journeys.mjs';
import { pixels } from './staging.mjs';
import { answered, becomes, eventually, reloaded, rested, saved } from './waits.mjs';

/** The middle of the knob over the frame round some points, and its lower right corner. */
function handles(points) {
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  const [left, right] = [Math.min(...xs), Math.max(...xs)];
  return {
    knob: [(left + right) / 2, Math.min(...ys) - 36],
    corner: [right + 10, Math.max(...ys) + 10],
  };
}

/** What undo would take back. */
const step = (page, name) => page.locator(`#b-undo[title*="${name}"]`).waitFor();

async function edit({ page, url, shot }) {
  await begin(page, url);
  const strokes = await drawFlower(page);
  const plain = await settled(page);
  const box = await page.locator('.sheet').boundingBox();
  const at = ([x, y]) => [box.x + x, box.y + y];
  // A petal is pulled longer at its tip.
  await page.keyboard.press('a');
  await draw(page, line(250, 122, 250, 82));
  const bent = await changed(page, plain, 'bent');
  await step(page, 'bend');
  // A leaf is chosen, scaled by a corner and turned by the knob.
  await page.keyboard.press('v');
  const leaf = blade(255, 430, -0.6, 110, 25);
  await page.mouse.click(...at(leaf[3]));
  await page.locator('.card').waitFor();
  await shot('strokes-frame');
  const { corner } = handles(leaf);
  await draw(page, line(corner[0], corner[1], corner[0] + 60, corner[1] + 40));
  await step(page, 'turn or scale');
  await changed(page, bent, 'scaled');
  await page.keyboard.press('Control+z');
  await step(page, 'bend');
  // It is pulled elsewhere, and put back.
  await page.mouse.click(...at(leaf[3]));
  await draw(page, line(leaf[3][0], leaf[3][1], leaf[3][0] + 30, leaf[3][1] + 45));
  await step(page, 'move');
  await changed(page, bent, 'moved');
  await page.keyboard.press('Control+z');
  await step(page, 'bend');
  const { knob } = handles(leaf);
  await draw(page, line(knob[0], knob[1], knob[0] - 70, knob[1] + 20));
  await step(page, 'turn or scale');
  await changed(page, bent, 'turned');
  await page.keyboard.press('Control+z');
  await step(page, 'bend');
  // It is cut where it was pressed, and made whole again.
  await page.mouse.click(...at(leaf[3]));
  await page.locator('.card .chip', { hasText: 'Cut here' }).click();
  await until(page, 'strokes', ['is', strokes + 1], 'cut in two');
  await page.keyboard.press('Escape');
  await page.mouse.click(...at(leaf[2]));
  await page.keyboard.down('Shift');
  await page.mouse.click(...at(leaf[4]));
  await page.keyboard.up('Shift');
  await page.locator('.card .chip', { hasText: 'Join' }).click();
  await until(page, 'strokes', ['is', strokes], 'joined');
  // A rubber across the stem leaves two pieces.
  await page.keyboard.press('Escape');
  await page.keyboard.press('Shift+E');
  await draw(page, line(225, 350, 285, 352));
  await until(page, 'strokes', ['is', strokes + 1], 'rubbed in two');
  await step(page, 'rub out');
  await shot('strokes-rubbed');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', strokes], 'the stem is whole');
  // One petal in a colour of its own.
  await page.keyboard.press('v');
  const petal = blade(250, 210, -Math.PI / 2 + (2 * Math.PI) / 5, 95, 28);
  await page.mouse.click(...at(petal[3]));
  const before = await settled(page);
  await page.locator('.card input[type=color]').evaluate((field) => {
    field.value = '#d02040';
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  const red = await changed(page, before, 'coloured');
  await rested(page);
  await shot('strokes-coloured');
  await page.locator('.card .chip', { hasText: 'Smooth' }).click();
  await changed(page, red, 'smoothed');
  // All of it can be taken back.
  for (const name of ['smooth', 'colour', 'join', 'cut', 'bend']) {
    await step(page, name);
    await page.keyboard.press('Control+z');
  }
  await step(page, 'draw');
  await page.waitForFunction((digest) => document.body.dataset.digest === digest, plain);
  await becomes(() => count(page, 'strokes'), strokes, 'the number of strokes');
}

/** The whole is read as something else by one click, and a stroke that another one turned is turned back. */
async function readings({ page, link, shot }) {
  await begin(page, link);
  await until(page, 'triangles', ['above', 0], 'the file is open');
  const plain = await settled(page);
  const chips = page.locator('.readings .chip[data-reading]');
  await becomes(() => chips.count(), 3, 'the number of readings');
  await becomes(() => page.locator('.readings .chip[aria-pressed=true]').count(), 1, 'those pressed');
  await page.locator('.readings .chip[data-reading=flower][aria-pressed=true]').waitFor();
  await shot('readings');
  const other = page.locator('.readings .chip[data-reading][aria-pressed=false]').first();
  const kind = await other.getAttribute('data-reading');
  await other.click();
  const read = await changed(page, plain, `read as ${kind}`);
  await page.locator(`.readings .chip[data-reading="${kind}"][aria-pressed=true]`).waitFor();
  await shot('readings-other');
  // The document remembers it.
  await saved(page);
  await reloaded(page);
  await page.waitForFunction((d) => document.body.dataset.digest === d, read);
  await page.locator('.readings .chip', { hasText: 'automatic' }).click();
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
}

/** What a stroke turned into something else is said, and turned back by one click. */
async function turned({ page, url, shot }) {
  await begin(page, url);
  const ring = Array.from({ length: 33 }, (_, k) => [
    250 + 34 * Math.cos((k * Math.PI) / 16),
    230 + 34 * Math.sin((k * Math.PI) / 16),
  ]);
  const strokes = [
    ring,
    line(250, 540, 250, 262, 8),
    ...[0, 1, 2, 3, 4, 5].map((k) => blade(250, 230, -Math.PI / 2 + (k * Math.PI) / 3, 130, 34)),
  ];
  const chip = page.locator('.readings .chip.turned');
  let drawn = 0;
  while (drawn < strokes.length && (await chip.count()) === 0) {
    const before = drawn > 0 ? await settled(page) : '';
    await draw(page, strokes[drawn]);
    drawn += 1;
    await until(page, 'strokes', ['is', drawn], 'a stroke was drawn');
    await changed(page, before, 'it is read');
  }
  assert.equal(await chip.count(), 1, 'a ring alone is something else than one among petals');
  await shot('readings-turned');
  const read = await settled(page);
  await chip.click();
  await step(page, 'change what a stroke is');
  const back = await changed(page, read, 'turned back');
  await chip.waitFor({ state: 'detached' });
  // It is theirs now: the next stroke does not turn it.
  await draw(page, line(250, 480, 330, 420, 6));
  await changed(page, back, 'one stroke more');
  assert.equal(await chip.count(), 0);
}

/** What is hardly understood is drawn faintly, until a person says what it is. */
async function doubtful({ page, url, shot }) {
  await begin(page, url);
  // Leaves stay where the hand drew them: where they meet the stem, the spiral is clearly one of them.
  await page.keyboard.press('j');
  await drawFlower(page);
  await settled(page);
  const spiral = Array.from({ length: 31 }, (_, k) => [330 + k * Math.cos(k / 2), 480 + k * Math.sin(k / 2)]);
  await draw(page, spiral);
  await until(page, 'strokes', ['is', 9], 'a spiral beside it');
  await settled(page);
  /** The darkest that the sheet is within three pixels of points, of 255, mean of all. */
  const dark = async (points) => {
    await page.mouse.move(5, 300);
    await answered(page);
    const { p, across, width, height } = await pixels(page, await page.locator('.sheet').screenshot());
    const least = points.map(([x, y]) => {
      let low = 255;
      for (let v = Math.max(0, Math.round(y) - 3); v <= Math.min(height - 1, Math.round(y) + 3); v += 1)
        for (let u = Math.max(0, Math.round(x) - 3); u <= Math.min(width - 1, Math.round(x) + 3); u += 1) {
          const [r, g, b] = p.subarray(4 * (v * across + u));
          low = Math.min(low, (r + g + b) / 3);
        }
      return low;
    });
    return least.reduce((sum, l) => sum + l, 0) / least.length;
  };
  const box = await page.locator('.sheet').boundingBox();
  const some = spiral.slice(12, 28);
  const faint = await dark(some);
  await shot('strokes-doubtful');
  await page.keyboard.press('v');
  await page.mouse.click(box.x + spiral[24][0], box.y + spiral[24][1]);
  await page.locator('.card .chip', { hasText: 'fruit' }).click();
  await step(page, 'change what a stroke is');
  await settled(page);
  await page.keyboard.press('Escape');
  await page.mouse.click(box.x + 60, box.y + 60);
  await eventually(
    () => dark(some),
    (clear) => clear < faint - 40,
    `it was ${faint} when it was hardly understood, and is now`,
  );
}

export const strokes = [
  ['what is hardly understood looks so', doubtful],
  ['a stroke that was turned is turned back', turned],
  ['another reading of the whole', readings],
  ['strokes are edited', edit],
];
