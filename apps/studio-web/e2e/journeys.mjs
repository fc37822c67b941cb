// What people do with the Studio, step by step.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { answered, becomes, eventually, pictures, reloaded, rested, saved, take } from './waits.mjs';

export const data = (page, key) => page.evaluate((k) => document.body.dataset[k] ?? '', key);
export const count = async (page, key) => Number(await data(page, key));
const TESTS = { is: (n, m) => n === m, above: (n, m) => n > m };
// The page's policy allows no text to become code, so the tests are named.
export const until = (page, key, [test, value], what) =>
  eventually(
    () => count(page, key),
    (now) => TESTS[test](now, value),
    `${what}: ${key} is not ${test} ${value}, but`,
  );

export async function begin(page, url) {
  await page.goto(url);
  await page.waitForFunction(() => document.body.dataset.ready === 'true');
}

/** Waits until what is seen is the whole document, with all that was done so far, and says its digest. */
export async function settled(page) {
  await answered(page);
  await page.waitForFunction(() => {
    const { wanted, revision, digest } = document.body.dataset;
    return wanted === revision && digest !== '';
  });
  return data(page, 'digest');
}

/** Moves the mouse along points of the sheet (pixels from its upper left corner) with the button down. */
export async function draw(page, points) {
  const box = await page.locator('.sheet').boundingBox();
  const [first, ...rest] = points;
  await page.mouse.move(box.x + first[0], box.y + first[1]);
  await page.mouse.down();
  for (const [x, y] of rest) await page.mouse.move(box.x + x, box.y + y);
  await page.mouse.up();
}

export const line = (x0, y0, x1, y1, bow = 0, n = 7) =>
  Array.from({ length: n + 1 }, (_, i) => {
    const t = i / n;
    return [x0 + (x1 - x0) * t + bow * 4 * t * (1 - t), y0 + (y1 - y0) * t];
  });

/** A petal or leaf as a nearly closed outline from its root. */
export function blade(x, y, angle, length, half) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return Array.from({ length: 13 }, (_, i) => {
    const a = (i / 12) * Math.PI * 2;
    const [along, across] = [(length * (1 - Math.cos(a))) / 2, half * Math.sin(a)];
    return [x + along * c - across * s, y + along * s + across * c];
  });
}

export async function drawFlower(page) {
  const strokes = [
    line(250, 540, 250, 245, 8),
    ...[0, 1, 2, 3, 4].map((k) => blade(250, 210, -Math.PI / 2 + (k * 2 * Math.PI) / 5, 95, 28)),
    blade(255, 430, -0.6, 110, 25),
    blade(253, 480, Math.PI + 0.5, 100, 23),
  ];
  for (const [i, stroke] of strokes.entries()) {
    await draw(page, stroke);
    await until(page, 'strokes', ['is', i + 1], 'a stroke was drawn');
  }
  await until(page, 'flowers', ['above', 0], 'a flower was drawn');
  return strokes.length;
}

/** A sample, opened as a person does. */
export async function sample(page) {
  await page.click('#b-samples');
  await page.click('[data-sample=sample]');
  await until(page, 'flowers', ['is', 1], 'the sample is open');
  return 15;
}

export async function exported(page, format, levels, what, wind) {
  await page.click('#b-export');
  await page.click(`[data-format=${format}]`);
  if (levels) await page.selectOption('#b-levels', String(levels));
  if (what) await page.selectOption('#b-what', what);
  if (wind !== undefined) await page.setChecked('#b-wind', wind);
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#b-export-go')]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

async function flower({ page, url, shot }) {
  await begin(page, url);
  await page.locator('.empty').waitFor();
  await shot('empty');
  await drawFlower(page);
  await page.locator('.empty').waitFor({ state: 'hidden' });
  await until(page, 'triangles', ['above', 500], 'it has leaves and petals');
  await rested(page);
  await shot('flower');
  const glb = await exported(page, 'glb');
  assert.match(glb.name, /\.glb$/);
  assert.equal(glb.bytes.subarray(0, 4).toString(), 'glTF');
  for (const [format, start] of [
    ['obj', 'PK'],
    ['ply', 'ply'],
    ['png', '\x89PNG'],
  ]) {
    const file = await exported(page, format);
    assert.equal(file.bytes.subarray(0, start.length).toString('latin1'), start, format);
    assert.ok(file.bytes.length > 2000, format);
  }
  assert.ok(!glb.bytes.includes('_WIND'), 'no wind unless it is asked for');
  const blown = await exported(page, 'glb', undefined, undefined, true);
  assert.ok(blown.bytes.includes('_WIND') && blown.bytes.includes('_PIVOT'), 'wind for shaders');
  const usd = await exported(page, 'usda', undefined, undefined, false);
  assert.ok(usd.bytes.includes('plant.usda'), usd.name);
  const levels = await exported(page, 'glb', 3);
  assert.match(levels.name, /\.glb\.zip$/);
  assert.ok(levels.bytes.includes('plant_LOD2.glb'), 'three levels of detail');
  await page.keyboard.press('d');
  await page.locator('#b-front[aria-pressed=true]').waitFor();
  await rested(page);
  await shot('front');
}

async function live({ page, url }) {
  await begin(page, url);
  const box = await page.locator('.sheet').boundingBox();
  await page.mouse.move(box.x + 250, box.y + 480);
  await page.mouse.down();
  for (const [x, y] of line(250, 480, 265, 130, 12)) await page.mouse.move(box.x + x, box.y + y);
  await until(page, 'triangles', ['above', 0], 'the plant follows the pen before it is lifted');
  assert.equal(await count(page, 'strokes'), 0);
  await page.mouse.up();
  await until(page, 'strokes', ['is', 1], 'the stroke is kept');
}

async function undo({ page, url }) {
  await begin(page, url);
  const n = 100;
  // A quick hand: the strokes come faster than plants can be made of them.
  await page.evaluate((count) => {
    const sheet = document.querySelector('.sheet');
    sheet.setPointerCapture = () => {};
    const box = sheet.getBoundingClientRect();
    for (let i = 0; i < count; i += 1) {
      const [x, y] = [box.left + 120 + 28 * (i % 10), box.top + 530 - 45 * Math.floor(i / 10)];
      const send = (type, k) =>
        sheet.dispatchEvent(
          new PointerEvent(type, {
            pointerType: 'mouse',
            pointerId: 1,
            clientX: x + 2 * k,
            clientY: y - 8 * k,
            buttons: 1,
            bubbles: true,
            isPrimary: true,
          }),
        );
      send('pointerdown', 0);
      for (let k = 1; k < 4; k += 1) send('pointermove', k);
      send('pointerup', 4);
    }
  }, n);
  await until(page, 'strokes', ['is', n], 'a hundred strokes');
  await until(page, 'triangles', ['above', 0], 'a plant');
  for (let i = 0; i < n; i += 1) await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', 0], 'undo of all');
  await until(page, 'parts', ['is', 0], 'nothing is left');
  await page.locator('#b-undo:disabled').waitFor();
  for (let i = 0; i < n; i += 1) await page.keyboard.press('Control+Shift+z');
  await until(page, 'strokes', ['is', n], 'redo of all');
  await until(page, 'triangles', ['above', 0], 'the plant is back');
}

async function habits({ page, url, shot }) {
  await begin(page, url);
  const n = await sample(page);
  const digest = await settled(page);
  await page.locator('.sheet').focus();
  await page.keyboard.press('Control+a');
  await page.keyboard.press('Control+d');
  await until(page, 'strokes', ['is', 2 * n], 'everything twice');
  await page.keyboard.press('Delete');
  await until(page, 'strokes', ['is', n], 'the copies were selected, and go');
  await page.keyboard.press(']');
  await page.keyboard.press('Control+c');
  await page.keyboard.press('Control+v');
  await until(page, 'strokes', ['is', n + 1], 'one stroke pasted');
  await page.keyboard.press('Control+x');
  await until(page, 'strokes', ['is', n], 'and cut');
  for (let i = 0; i < 4; i += 1) await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').fill('skel');
  await shot('palette');
  await page.keyboard.press('Enter');
  await page.waitForFunction(
    () => document.querySelector('#b-skeleton').getAttribute('aria-pressed') === 'true',
  );
  await page.keyboard.press('i');
  await page.locator('.statsbox', { hasText: 'Height' }).waitFor();
  await rested(page);
  await shot('skeleton');
  await page.keyboard.press('k');
  await page.keyboard.press('i');
  await page.click('#b-lock');
  await page.locator('#b-lock[aria-pressed=true]').waitFor();
  await page.keyboard.press('Shift+R');
  await page.locator('.note', { hasText: 'locked' }).waitFor();
  await page.locator('#b-grid:disabled').waitFor();
  await page.click('#b-lock');
  await page.locator('#b-lock[aria-pressed=false]').waitFor();
  await page.keyboard.press('Shift+G');
  await page.locator('.variations[data-full=true]').waitFor();
  assert.equal(await page.locator('.variations canvas').count(), 9);
  await shot('variations');
  assert.equal(await settled(page), digest, 'looking changes nothing');
  await page.locator('.variations button').nth(4).click();
  await page.waitForFunction((d) => document.body.dataset.digest !== d, digest);
}

async function share({ page, url, shot, context }) {
  await begin(page, url);
  await sample(page);
  await settled(page);
  const counts = async (of) => (await of.locator('#b-counts').textContent()).split('Triangles')[0];
  const petals = await counts(page);
  await page.click('#b-share');
  const link = await page.locator('dialog textarea').inputValue();
  await shot('share');
  assert.ok(link.startsWith(url) && link.length < 32_000, `${link.length}`);
  const other = await context.newPage();
  await other.goto(url);
  await other.waitForFunction(() => document.body.dataset.ready === 'true');
  await other.goto('about:blank');
  await other.goto(link);
  await until(other, 'flowers', ['is', 1], 'the link opens');
  await becomes(() => counts(other), petals, 'what the link holds');
  assert.equal(await other.evaluate(() => location.hash), '', 'the link is taken out of the address');
  for (const hash of ['#d=AAAA', '#d=%3Cscript%3E', `#d=${'A'.repeat(40_000)}`]) {
    const before = await settled(other);
    await saved(other);
    await other.goto('about:blank');
    await other.goto(url + hash);
    await other.locator('.note.bad', { hasText: 'cannot be opened' }).waitFor();
    await until(other, 'flowers', ['is', 1], 'what was here is still here');
    assert.equal(await settled(other), before);
  }
  await other.close();
}

async function photo({ page, url, shot }) {
  await begin(page, url);
  // A photograph made here: a red flower's petal on green.
  await page.evaluate(async () => {
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [600, 800];
    const c = canvas.getContext('2d');
    c.fillStyle = '#c8d8b0';
    c.fillRect(0, 0, 600, 800);
    c.fillStyle = '#3f7d2a';
    c.fillRect(290, 300, 20, 500);
    for (let k = 0; k < 5; k += 1) {
      c.save();
      c.translate(300, 280);
      c.rotate((k * 2 * Math.PI) / 5);
      const g = c.createLinearGradient(0, 0, 0, -200);
      g.addColorStop(0, '#f7d14a');
      g.addColorStop(0.4, '#e2502a');
      g.addColorStop(1, '#7a0f3a');
      c.fillStyle = g;
      c.beginPath();
      c.ellipse(0, -110, 50, 100, 0, 0, 7);
      c.fill();
      c.restore();
    }
    const blob = await new Promise((r) => canvas.toBlob(r, 'image/jpeg', 0.9));
    const transfer = new DataTransfer();
    transfer.items.add(new File([blob], 'flower.jpg', { type: 'image/jpeg' }));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
  });
  await page.locator('.note', { hasText: 'Trace' }).waitFor();
  const box = await page.locator('.sheet').boundingBox();
  // The photograph fills 86 % of the height, in the middle.
  const k = (box.height * 0.86) / 800;
  const [ox, oy] = [box.width / 2 - 300 * k, box.height * 0.07];
  const at = (points) => points.map(([x, y]) => [ox + x * k, oy + y * k]);
  let n = 0;
  const trace = async (points) => {
    await draw(page, at(points));
    n += 1;
    await until(page, 'strokes', ['is', n], 'traced');
  };
  await trace(line(300, 790, 300, 300, 4));
  for (let i = 0; i < 5; i += 1) await trace(blade(300, 275, -Math.PI / 2 + (i * 2 * Math.PI) / 5, 195, 48));
  await until(page, 'flowers', ['is', 1], 'a traced flower');
  await settled(page);
  await rested(page);
  await shot('photo');
  const glb = await exported(page, 'glb');
  assert.ok(glb.bytes.includes('petals-traced'), 'petals have the photograph as their texture');
  await page.click('#b-photo');
  await page.getByText('Traced parts take its colours').click();
  await page.keyboard.press('Escape');
  await settled(page);
  assert.ok(!(await exported(page, 'glb')).bytes.includes('petals-traced'), 'not when that is switched off');
  await page.waitForFunction(() => /Saved/.test(document.querySelector('#b-kept').textContent));
  await reloaded(page);
  await until(page, 'strokes', ['is', n], 'drawing and photograph are recovered');
  await settled(page);
  await page.click('#b-photo');
  const traced = page.getByText('Traced parts take its colours').locator('xpath=..').locator('input');
  await becomes(() => traced.isChecked(), false, 'that its colours are taken');
}

/** A browser without WebGL 2 whose storage is shut, as in private mode: both are told, and the work goes on. */
async function poor({ page, url, shot }) {
  await page.addInitScript(() => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function get(kind, ...rest) {
      return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...rest);
    };
    IDBFactory.prototype.open = () => {
      throw new DOMException('shut', 'QuotaExceededError');
    };
  });
  await begin(page, url);
  await page.locator('.note.bad', { hasText: 'WebGL 2' }).waitFor();
  await page.locator('.note.bad', { hasText: 'Save your work as a file' }).waitFor();
  await shot('poor');
  await drawFlower(page);
  assert.equal((await exported(page, 'glb')).bytes.subarray(0, 4).toString(), 'glTF');
}

async function symmetry({ page, url, shot }) {
  await begin(page, url);
  await draw(page, line(250, 530, 250, 150, 2));
  await until(page, 'strokes', ['is', 1], 'a stem');
  await until(page, 'triangles', ['above', 0], 'a plant');
  await page.keyboard.press('m');
  await draw(page, blade(252, 400, -0.5, 120, 28));
  await until(page, 'strokes', ['is', 3], 'a leaf on each side');
  await until(page, 'parts', ['above', 1], 'leaves');
  await rested(page);
  await shot('symmetry');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', 1], 'one step of undo');
}

async function firstRun({ page, url, shot }) {
  await page.goto(url);
  await page.locator('.tour').waitFor();
  await shot('tour');
  for (const title of ['See it grow', 'Say what is what', 'Take it with you']) {
    await page.locator('.tour .primary').click();
    await becomes(() => page.locator('.tour strong').textContent(), title, 'the card');
  }
  await page.locator('.tour .primary').click();
  await page.locator('.tour').waitFor({ state: 'detached' });
  await reloaded(page);
  assert.equal(await page.locator('.tour').count(), 0, 'it comes once');
  const again = async () => {
    await page.evaluate(() => localStorage.removeItem('burgeon.tour'));
    await reloaded(page);
    await page.locator('.tour').waitFor();
  };
  await again();
  await page.locator('.sheet').focus();
  await page.keyboard.press('Escape');
  // Escape ends it wherever the keyboard is.
  await page.locator('.tour').waitFor({ state: 'detached' });
  await again();
  const [card, sheet] = [
    await page.locator('.tour').boundingBox(),
    await page.locator('.sheet').boundingBox(),
  ];
  const [x, y] = [card.x + card.width / 2 - sheet.x, card.y + card.height / 3 - sheet.y];
  await draw(page, line(x, y, x + 10, y - 200));
  await until(page, 'strokes', ['is', 1], 'a stroke that begins on the card');
}

/** A pen with pressure; a palm that rests on the glass meanwhile draws nothing. */
async function pen({ page, url, shot }) {
  await begin(page, url);
  const box = await page.locator('.sheet').boundingBox();
  await page.evaluate(() => {
    const sheet = document.querySelector('.sheet');
    sheet.setPointerCapture = () => {};
    window.pointer = (type, kind, id, x, y, pressure) => {
      const box = sheet.getBoundingClientRect();
      sheet.dispatchEvent(
        new PointerEvent(type, {
          pointerType: kind,
          pointerId: id,
          clientX: box.left + x,
          clientY: box.top + y,
          pressure,
          buttons: type === 'pointerup' ? 0 : 1,
          bubbles: true,
          isPrimary: true,
        }),
      );
    };
  });
  const send = (...a) => page.evaluate((args) => window.pointer(...args), a);
  const path = line(box.width / 2, box.height - 60, box.width / 2 + 20, 80, 10, 20);
  await send('pointerdown', 'pen', 5, path[0][0], path[0][1], 0.2);
  await send('pointerdown', 'touch', 6, box.width - 40, box.height - 40, 0.5);
  for (const [i, [x, y]] of path.entries()) await send('pointermove', 'pen', 5, x, y, 0.2 + 0.035 * i);
  await send('pointermove', 'touch', 6, box.width - 44, box.height - 44, 0.5);
  await send('pointerup', 'touch', 6, box.width - 44, box.height - 44, 0);
  await send('pointerup', 'pen', 5, path.at(-1)[0], path.at(-1)[1], 0);
  await until(page, 'strokes', ['is', 1], 'the pen draws, the palm does not');
  await send('pointerdown', 'touch', 7, 100, 300, 0.5);
  for (let i = 1; i < 8; i += 1) await send('pointermove', 'touch', 7, 100 + 20 * i, 300, 0.5);
  await send('pointerup', 'touch', 7, 240, 300, 0);
  await answered(page);
  assert.equal(await count(page, 'strokes'), 1, 'with a pen at hand a finger moves the sheet');
  await shot('pen');
}

async function reload({ page, url }) {
  await begin(page, url);
  const n = (await sample(page)) + 1;
  await draw(page, line(100, 400, 120, 250, 6));
  await until(page, 'strokes', ['is', n], 'a stroke was drawn');
  await page.keyboard.press('Shift+R');
  const digest = await settled(page);
  await page.waitForFunction(() => /Saved/.test(document.querySelector('#b-kept').textContent));
  await reloaded(page);
  await until(page, 'strokes', ['is', n], 'the drawing is recovered');
  await page
    .waitForFunction((d) => document.body.dataset.digest === d, digest)
    .catch(async () => {
      throw new Error(`another plant after reload: ${await data(page, 'digest')} instead of ${digest}`);
    });
}

async function chinese({ page, url, shot }) {
  await begin(page, url);
  await page.locator('.empty h1', { hasText: '画一株植物' }).waitFor();
  assert.equal(await page.evaluate(() => document.documentElement.lang), 'zh-Hans');
  await page.click('#b-samples');
  await page.click('[data-sample=sunflower]');
  await until(page, 'triangles', ['above', 0], 'a sample in Chinese');
  await shot('chinese');
  await page.click('#b-language');
  await page.locator('#b-export', { hasText: 'Export' }).waitFor();
  await reloaded(page);
  await page.locator('#b-export', { hasText: 'Export' }).waitFor();
}

async function correct({ page, link, shot }) {
  await begin(page, link);
  await until(page, 'triangles', ['above', 0], 'the file named on the command line is open');
  const before = await settled(page);
  await page.locator('.sheet').focus();
  await page.keyboard.press(']');
  await page.locator('.card').waitFor();
  await rested(page);
  await shot('correct');
  await page.locator('.card .chip', { hasText: 'fruit' }).click();
  await page.waitForFunction((d) => document.body.dataset.digest !== d, before);
  const pressed = page.locator('.card .chip[aria-pressed=true]', { hasText: 'fruit' });
  await becomes(() => pressed.count(), 1, 'what is pressed');
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, before);
}

async function fault({ page, url, troubles }) {
  await begin(page, url);
  const n = await sample(page);
  const digest = await settled(page);
  const [worker] = page.workers();
  await worker
    .evaluate(() => {
      setTimeout(() => {
        throw new Error('made to fall by the test');
      });
    })
    .catch(() => {});
  await page.locator('.note.bad', { hasText: 'started again' }).waitFor();
  await draw(page, line(150, 300, 150, 100, 8));
  await until(page, 'strokes', ['is', n + 1], 'the stroke after the fault');
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  const others = troubles.splice(0).filter((t) => !t.includes('made to fall by the test'));
  assert.deepEqual(others, []);
}

async function refuse({ page, url }) {
  await begin(page, url);
  await sample(page);
  const digest = await settled(page);
  for (const [name, text] of [
    ['broken.svg', '<svg'],
    ['broken.burgeon', 'PK\x03\x04'],
    ['word.docx', 'no'],
    ['x.glb', 'glTF'],
  ]) {
    await page.evaluate(
      ([n, t]) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([t], n));
        document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
      },
      [name, text],
    );
    await page.locator('.note.bad', { hasText: name }).waitFor();
  }
  assert.equal(await settled(page), digest);
}

async function keyboard({ page, url }) {
  await begin(page, url);
  await page.keyboard.press('Tab');
  await page.waitForFunction(() => document.activeElement.tagName !== 'BODY');
  await page.locator('#b-samples').focus();
  await page.keyboard.press('Enter');
  await page.locator('[data-sample=sample]').focus();
  await page.keyboard.press('Enter');
  await until(page, 'triangles', ['above', 0], 'a sample by keyboard');
  const before = await settled(page);
  await page.locator('.sheet').focus();
  await page.keyboard.press('[');
  await page.keyboard.press('Delete');
  await until(page, 'strokes', ['is', 14], 'a stroke erased by keyboard');
  await page.waitForFunction((d) => document.body.dataset.digest !== d, before);
  await page.keyboard.press('?');
  await page.locator('dialog[open]').waitFor();
  await page.keyboard.press('Escape');
  await page.locator('dialog[open]').waitFor({ state: 'detached' });
}

async function touch({ page, url, shot, context }) {
  await begin(page, url);
  const cdp = await context.newCDPSession(page);
  const box = await page.locator('.sheet').boundingBox();
  const send = (type, points) =>
    cdp.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: points.map(([x, y], id) => ({ x: box.x + x, y: box.y + y, id })),
    });
  // The tools lie along the lower edge of an upright sheet.
  const path = line(box.width / 2, box.height - 100, box.width / 2, 60, 12);
  await send('touchStart', [path[0]]);
  for (const p of path.slice(1)) await send('touchMove', [p]);
  await send('touchEnd', []);
  await until(page, 'strokes', ['is', 1], 'a finger draws');
  await send('touchStart', [[100, 200]]);
  await send('touchStart', [
    [100, 200],
    [200, 200],
  ]);
  await send('touchMove', [
    [60, 200],
    [260, 220],
  ]);
  await send('touchEnd', []);
  await answered(page);
  assert.equal(await count(page, 'strokes'), 1, 'two fingers do not draw');
  await shot('tablet');
}

/** Adds a plant by the list of the scene. */
export async function add(page, maker, preset) {
  await page.click('#b-add');
  await page.click(`[data-add=${maker}]`);
  if (preset) await page.click(`dialog [data-preset=${preset}]`);
  await page.waitForFunction((m) => document.body.dataset.current === m, maker);
}

/** Waits until another plant is seen than before. More may be coming: a hand holds it, or it is played. */
export async function stirred(page, before, what) {
  await page
    .waitForFunction((d) => document.body.dataset.digest !== d && document.body.dataset.digest !== '', before)
    .catch(() => {
      throw new Error(`${what}: nothing changed`);
    });
  return data(page, 'digest');
}

/** Waits until another plant is seen than before, and all of the change. */
export async function changed(page, before, what) {
  await stirred(page, before, what);
  return settled(page);
}

/** Drags a slider to a share of its way: one step of undo. */
export async function slide(page, path, share) {
  const slider = page.locator(`input[data-path="${path}"]`);
  await slider.evaluate((e, to) => {
    const [low, high] = [Number(e.min || 0), Number(e.max || 100)];
    for (const part of [0.5, 1]) {
      e.value = String(Number(e.value) + (low + to * (high - low) - Number(e.value)) * part);
      e.dispatchEvent(new Event('input', { bubbles: true }));
    }
    e.dispatchEvent(new Event('change', { bubbles: true }));
  }, share);
}

export async function drop(page, name, text) {
  await page.evaluate(
    ([n, t]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([t], n));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
    },
    [name, text],
  );
}

export const BUSH = 'name = "bush"\n[method]\nkind = "competition"\npoints = 260\nlifespan = 2\n';

/** A small tree, grown. */
export async function bush(page, url) {
  await begin(page, url);
  await drop(page, 'bush.toml', BUSH);
  await until(page, 'triangles', ['above', 1000], 'a bush has grown');
  return settled(page);
}

const WALL =
  'v 0.3 0 -3\nv 1 0 -3\nv 1 0 3\nv 0.3 0 3\nv 0.3 4 -3\nv 1 4 -3\nv 1 4 3\nv 0.3 4 3\n' +
  'f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n';

async function tree({ page, url, shot }) {
  await begin(page, url);
  await page.click('#b-add');
  await page.click('[data-add=tree]');
  await page.locator('dialog [data-preset]').first().waitFor();
  assert.ok((await page.locator('dialog [data-preset]').count()) >= 10);
  await shot('tree-species');
  await page.click('dialog [data-preset=hazel]');
  await until(page, 'triangles', ['above', 1000], 'a hazel has grown');
  assert.equal(await count(page, 'plants'), 1, 'the blank sheet gave way');
  let digest = await settled(page);
  const plain = digest;
  await page.click('[data-obstacle=ball]');
  digest = await changed(page, digest, 'a ball in its way');
  const chooser = page.waitForEvent('filechooser');
  await page.click('[data-obstacle=file]');
  await (await chooser).setFiles({ name: 'wall.obj', mimeType: 'model/obj', buffer: Buffer.from(WALL) });
  digest = await changed(page, digest, 'a wall in its way');
  await becomes(() => page.locator('.obstacles li').count(), 2, 'the obstacles');
  await rested(page);
  await shot('tree');
  await slide(page, 'keep', 0.2);
  digest = await changed(page, digest, 'fewer leaves');
  await page.locator('#b-undo').click();
  await changed(page, digest, 'one step takes the drag back');
  await settled(page);
  await page.locator('.f-group > summary').first().click();
  await eventually(
    () => page.locator('.form .f-row').count(),
    (n) => n > 3,
    'a row for each field of the schema',
  );
  await page.locator('.maker').evaluate((e) => e.scrollTo(0, 500));
  await shot('tree-panel');
  for (const [format, start] of [
    ['glb', 'glTF'],
    ['mtg', 'CODE'],
    ['opf', '<opf'],
    ['qsm', 'radius'],
  ]) {
    const file = await exported(page, format);
    assert.ok(
      file.bytes.subarray(0, 200).toString('latin1').includes(start),
      `${format}: ${file.bytes.subarray(0, 20)}`,
    );
  }
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
}

/** What is odd about a file that is opened is told in the language of the page. */
async function oddFile({ page, url, shot }) {
  await begin(page, url);
  await page.click('#b-language');
  await page.locator('#b-language', { hasText: 'English' }).waitFor();
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99"><text>a</text>
<path id="p" stroke="black" fill="none" d="M10 10L20 60L30 5 L"/></svg>`;
  await drop(page, 'odd.svg', svg);
  const told = await page.locator('.note.bad').textContent();
  assert.match(told, /第 2 行.*没有读取：文字（1）/);
  assert.doesNotMatch(told, /left out|broken|attribute/, 'none of it is English');
  await shot('odd-file-zh');
}

/** On a laptop each icon bears its name until the person hides names, and all of them fit. */
async function names({ page, url, shot }) {
  await begin(page, url);
  const seen = (of) => page.locator(`${of} .caption:visible`).count();
  const all = (of) => page.locator(`${of} button:visible`).count();
  for (const width of [1280, 1366]) {
    await page.setViewportSize({ width, height: 650 });
    await pictures(page);
    // Of the commands of the bar, one has its name beside its icon; the language is a word.
    assert.equal(await seen('.bar'), (await all('.bar')) - 2, `names in the bar at ${width} pixels`);
    for (const of of ['.left > .tools', '.right-tools']) {
      assert.equal(await seen(of), await all(of), `names of ${of} at ${width} pixels`);
      const fits = await page.locator(of).evaluate((e) => e.scrollHeight <= e.clientHeight);
      assert.ok(fits, `${of} need not be scrolled at ${width} pixels`);
    }
    const inside = await page.locator('.bar').evaluate((bar) => {
      const right = bar.getBoundingClientRect().right;
      const boxes = [...bar.querySelectorAll('button')].map((b) => b.getBoundingClientRect());
      return boxes.every((b) => b.width >= 28 && b.right <= right);
    });
    assert.ok(inside, `the bar holds its buttons at ${width} pixels`);
  }
  await shot('names-laptop');
  await page.click('#b-wire');
  await page.click('#b-grid');
  await page.keyboard.press('Escape');
  assert.equal(
    await page.locator('#b-wire .caption, #b-grid .caption').count(),
    2,
    'names of what was used stay',
  );
  await page.keyboard.press('?');
  await page.click('#b-names');
  await page.keyboard.press('Escape');
  assert.equal(await page.locator('.caption').count(), 0, 'hidden names');
  await page.reload();
  await page.waitForFunction(() => document.body.dataset.ready === 'true');
  assert.equal(await page.locator('.caption').count(), 0, 'names stay hidden');
  await shot('names-hidden');
  await page.keyboard.press('?');
  await page.click('#b-names');
  await page.keyboard.press('Escape');
  await page.click('#b-language');
  await page.waitForFunction(() => document.documentElement.lang === 'zh-Hans');
  await pictures(page);
  await shot('names-laptop-zh');
}

/** A tree that was changed is kept as a preset, comes back by a click, and travels as a file. */
async function own({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  await until(page, 'triangles', ['above', 1000], 'a hazel has grown');
  const plain = await settled(page);
  await slide(page, 'keep', 0.3);
  // What the head changed goes back to what the species has.
  const back = page.locator('.maker-head .f-reset');
  await changed(page, plain, 'fewer leaves');
  await becomes(() => back.count(), 1, 'values that are others than at first');
  await back.click();
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await becomes(() => back.count(), 0, 'and none any more');
  await slide(page, 'keep', 0.3);
  const mine = await changed(page, plain, 'fewer leaves');
  await page.click('#b-own-keep');
  await page.locator('dialog .field').fill('Thin hazel');
  await page.keyboard.press('Enter');
  await page.locator('[data-own="Thin hazel"]').waitFor();
  await page.click('.maker [data-preset=birch]');
  const birch = await changed(page, mine, 'a birch');
  await rested(page);
  await shot('own-preset');
  // Kept under the name of another by mistake: the other comes back.
  await page.click('#b-own-keep');
  await page.locator('dialog .field').fill('Thin hazel');
  await page.keyboard.press('Enter');
  await take(page, 'other values', 'Undo');
  await page.click('[data-own="Thin hazel"]');
  await page.waitForFunction((d) => document.body.dataset.digest === d, mine);
  assert.notEqual(birch, mine);
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    page.locator('.own .icon').first().click(),
  ]);
  assert.equal(download.suggestedFilename(), 'Thin hazel.toml');
  const text = readFileSync(await download.path(), 'utf8');
  // After a reload it is there, and can be dropped and brought back.
  await saved(page);
  await reloaded(page);
  await page.waitForFunction((d) => document.body.dataset.digest === d, mine);
  await page.locator('.own .icon').nth(1).click();
  await page.waitForFunction(() => !document.querySelector('[data-own]'));
  await take(page, '', 'Undo');
  await page.locator('[data-own="Thin hazel"]').waitFor();
  // Flowers have presets of their own.
  await add(page, 'flower');
  await until(page, 'triangles', ['above', 1000], 'a flower has opened');
  const lily = await settled(page);
  await becomes(() => page.locator('[data-own]').count(), 0, 'presets of trees');
  await page.click('#b-own-keep');
  await page.locator('dialog .field').fill('My lily');
  await page.keyboard.press('Enter');
  await page.locator('[data-own="My lily"]').waitFor();
  await page.click('[data-flower=tulip]');
  const tulip = await changed(page, lily, 'a tulip');
  await page.click('[data-own="My lily"]');
  assert.notEqual(await changed(page, tulip, 'the lily again'), tulip);
  // Another person opens the file.
  await page.click('#b-fresh');
  await until(page, 'triangles', ['is', 0], 'a new document');
  await drop(page, 'thin.toml', text);
  await page.waitForFunction((d) => document.body.dataset.digest === d, mine);
}

async function leaf({ page, url, shot }) {
  await begin(page, url);
  await drop(page, 'tobacco.csv', readFileSync('../../fixtures/leaves/leaf1.csv', 'utf8'));
  await until(page, 'triangles', ['above', 500], 'a leaf from marks');
  await becomes(() => data(page, 'current'), 'leaf', 'the plant');
  let digest = await settled(page);
  for (const surface of ['bezier', 'nurbs', 'approximate']) {
    await page.selectOption('[data-path="/surface"]', surface);
    digest = await changed(page, digest, surface);
  }
  await slide(page, '/curl#', 0.75);
  await changed(page, digest, 'curled');
  digest = await settled(page);
  await rested(page);
  await shot('leaf');
  await drop(page, 'broken.csv', 'row,mark,x\n1,1,zero');
  await page.locator('.note.bad', { hasText: 'broken.csv' }).waitFor();
  assert.equal(await settled(page), digest, 'a bad table changes nothing');
}

async function bloom({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'flower');
  await until(page, 'triangles', ['above', 200], 'a lily');
  let digest = await settled(page);
  // Its spec is the document's own: the petals of one ring in another colour, and a ring more.
  const lily = digest;
  const field = (path) => page.locator(`.maker [data-path="${path}"]`).first();
  await field('/whorls/0/tip_color').evaluate((box) => {
    box.value = '#2040d0';
    box.dispatchEvent(new Event('change', { bubbles: true }));
  });
  digest = await changed(page, digest, 'blue petals');
  await page.locator('.maker summary', { hasText: 'All settings' }).click();
  await field('/whorls').click();
  await field('/whorls+').click();
  digest = await changed(page, digest, 'a ring more');
  await shot('flower-own');
  await page.keyboard.press('Control+z');
  digest = await changed(page, digest, 'a ring less');
  await page.keyboard.press('Control+z');
  assert.equal(await changed(page, digest, 'its own colour'), lily);
  digest = await settled(page);
  await page.click('[data-flower=rose]');
  digest = await changed(page, digest, 'a rose');
  await slide(page, 'day', 0);
  digest = await changed(page, digest, 'a bud');
  await shot('bud');
  await page.click('.play');
  await stirred(page, digest, 'it opens');
  await page.waitForFunction(() => /Play/.test(document.querySelector('.play')?.textContent ?? ''));
  await shot('bloom');
  assert.equal(await page.locator('.note.bad').count(), 0, 'nothing was refused');
  digest = await settled(page);
  await page.keyboard.press('Control+z');
  await changed(page, digest, 'the whole play is one step');
  // A flower of a file of one's own.
  await drop(page, 'star.toml', 'name = "star"\nstalk_m = 0.1\n[[whorls]]\ncount = 5\nlength_m = 0.03');
  await until(page, 'plants', ['is', 2], 'a flower from a file');
  await page.waitForFunction(() => document.body.dataset.current === 'flower');
  await settled(page);
  await becomes(() => field('/whorls/0/count').inputValue(), '5', 'the petals of its ring');
}

async function opens({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  const before = await count(page, 'revision');
  await page.click('#b-opens');
  await page.locator('.bloom .play').waitFor();
  await until(page, 'revision', ['above', before], 'the drawn flower at a day');
  await slide(page, 'day', 0.15);
  await settled(page);
  await rested(page);
  await shot('sketch-opens');
  await page.click('#b-opens');
  await page.locator('.bloom .play').waitFor({ state: 'detached' });
}

async function garden({ page, url, shot }) {
  await begin(page, url);
  await sample(page);
  await add(page, 'flower');
  await until(page, 'triangles', ['above', 200], 'a flower beside the drawing');
  await drop(page, 'tobacco.csv', readFileSync('../../fixtures/leaves/leaf1.csv', 'utf8'));
  await until(page, 'plants', ['is', 3], 'three plants');
  await page.waitForFunction(() => document.body.dataset.current === 'leaf');
  await page.locator('[data-key=nx]').fill('0.5');
  await page.locator('[data-key=nx]').press('Enter');
  await page.click('[data-gizmo=translate]');
  await settled(page);
  await rested(page);
  await shot('scene');
  await page.click('[data-plant=sketch]');
  await until(page, 'strokes', ['is', 15], 'its sheet is back');
  await page.click('[data-gizmo=translate]');
  const glb = await exported(page, 'glb');
  const one = await exported(page, 'glb', undefined, 'plant');
  assert.ok(glb.bytes.length > one.bytes.length, 'the scene has more than the plant');
  const [project] = await Promise.all([page.waitForEvent('download'), page.click('#b-save')]);
  const path = await project.path();
  const digest = await settled(page);
  await page.click('#b-fresh');
  await until(page, 'plants', ['is', 1], 'a new scene');
  const chooser = page.waitForEvent('filechooser');
  await page.click('#b-open');
  await (await chooser).setFiles({
    name: 'scene.burgeon',
    mimeType: 'application/zip',
    buffer: readFileSync(path),
  });
  await until(page, 'plants', ['is', 3], 'the scene is open again');
  await page.waitForFunction((d) => document.body.dataset.digest === d, digest);
  await settled(page);
  await page.locator('[data-plant=flower]').focus();
  await page.keyboard.press('Delete');
  await until(page, 'plants', ['is', 2], 'deleted by keyboard');
  await page.keyboard.press('Control+z');
  await until(page, 'plants', ['is', 3], 'and back');
  await page.locator('li:has([data-plant=flower]) button').nth(1).click();
  await page.locator('li.is-hidden').waitFor();
  await page.keyboard.press('Control+z');
  await page.locator('li.is-hidden').waitFor({ state: 'detached' });
  await page.click('#b-language');
  await page.click('[data-plant=leaf]');
  // The panel is drawn anew a moment after the click.
  await eventually(
    () => page.locator('.form .f-row > span:first-child').allTextContents(),
    (labels) => labels.length > 8 && labels.every((l) => /[\u4e00-\u9fff]/.test(l)),
    'settings in Chinese',
  );
  await page.click('#b-theme');
  await page.click('#b-theme');
  await rested(page);
  await shot('scene-dark-chinese');
}

async function guarded({ page, url, link, troubles }) {
  // The file that was opened is for browsers that came by the whole link; the page is no secret.
  const file = new URL('opened/tulip.svg', url).href;
  const told = await page.request.get(file);
  assert.equal(told.status(), 401);
  assert.match(await told.text(), /Copy the link from the terminal/);
  await page.goto(`${url}?open=opened%2Ftulip.svg`);
  await page.locator('.note.bad', { hasText: 'whole link' }).waitFor();
  // An answer of 401, which the console calls an error.
  troubles.length = 0;
  await page.goto(link);
  await page.waitForFunction(() => document.body.dataset.ready === 'true');
  assert.equal((await page.request.get(file)).status(), 200);
  const kept = (await page.context().cookies(url)).find((c) => c.name === `burgeon-${new URL(url).port}`);
  assert.ok(kept?.httpOnly && kept.sameSite === 'Strict', 'the cookie');
  assert.ok(!page.url().includes('key='), 'the key does not stay in the address');
  const page_ = await page.goto(url);
  const headers = page_.headers();
  assert.match(headers['content-security-policy'], /default-src 'none'/);
  assert.equal(headers['x-content-type-options'], 'nosniff');
  await page.waitForFunction(() => document.body.dataset.ready === 'true');
  assert.equal(await page.evaluate(() => crossOriginIsolated), true);
  for (const path of ['/..%2fpackage.json', '/%2e%2e/package.json', '/.gitignore', '/opened/x.svg']) {
    const answer = await page.request.get(new URL(path, url).href);
    assert.equal(answer.status(), 404, path);
  }
  const rebound = await page.request.get(url, { headers: { Host: 'evil.example' } });
  assert.equal(rebound.status(), 421);
  assert.equal((await page.request.post(url, { data: 'x' })).status(), 413);
  assert.equal((await page.request.get(url, { headers: { Origin: 'http://evil.example' } })).status(), 403);
}

export const journeys = [
  ['the first run', firstRun, { fresh: true }],
  ['draw a flower and export it', flower],
  ['the plant follows the pen', live],
  ['undo and redo a hundred steps', undo],
  ['copy, palette, skeleton, lock, variations', habits],
  ['a link to a drawing', share],
  ['trace a photograph', photo],
  ['symmetry', symmetry],
  ['no WebGL 2 and no storage', poor],
  ['a pen on a tablet, and a palm', pen, { viewport: { width: 820, height: 1180 }, hasTouch: true }],
  ['reload and recover', reload],
  ['Chinese', chinese, { locale: 'zh-CN' }],
  ['say what a stroke is', correct],
  ['the worker dies', fault],
  ['files that cannot be read', refuse],
  ['keyboard only', keyboard],
  [
    'a tablet with fingers',
    touch,
    { viewport: { width: 600, height: 800 }, hasTouch: true, isMobile: false },
  ],
  ['a tree with an obstacle', tree],
  ['a file with oddities is told of in Chinese', oddFile],
  ['names under icons on a laptop', names],
  ["a preset of one's own", own],
  ['a leaf from marks', leaf],
  ['a flower that opens: play', bloom],
  ['a drawn flower that opens', opens],
  ['three plants: saved, reopened, undone', garden],
  ['the server is guarded', guarded],
];
