// What is drawn stays: crashes, two tabs, the list of documents, a browser that keeps nothing.
import assert from 'node:assert/strict';
import { begin, count, draw, line, sample, settled, until } from './journeys.mjs';
import { answered, becomes, eventually, reloaded, stored, take } from './waits.mjs';

const standing = (page, word) => page.waitForFunction((w) => document.body.dataset.kept === w, word);
const said = (page) => page.locator('#b-kept').textContent();
/** A stroke of its own place for each number. */
const stroke = (page, n) =>
  draw(
    page,
    line(
      90 + 25 * (n % 12),
      120 + 90 * Math.floor(n / 12),
      100 + 25 * (n % 12),
      60 + 90 * Math.floor(n / 12),
      3,
      4,
    ),
  );

async function another(context, url) {
  const page = await context.newPage();
  await begin(page, url);
  return page;
}

/** Has a page fall; the call that does it may never be answered. */
async function fall(page, context) {
  const cdp = await context.newCDPSession(page);
  const fell = page.waitForEvent('crash');
  cdp.send('Page.crash').catch(() => {});
  await fell;
}

/** The stroke under the pen, as far as it is written: points (of four numbers each), and the row that it comes after. */
async function underHand(page) {
  const { after, requests = [] } = (await stored(page, 'journal')).find((row) => row.requests) ?? {};
  return { after, points: (requests.find((r) => r.kind === 'stroke')?.samples ?? 0) / 4 };
}

/** The list of documents, as it is shown: what each row says. */
async function shelf(page) {
  await page.locator('.sheet').focus();
  await page.keyboard.press('Shift+O');
  await page.locator('dialog.shelf-dialog .shelf-open').first().waitFor();
  return page.locator('dialog .shelf:not(.shelf-gone .shelf) .shelf-open b').allTextContents();
}

/** A quick hand: forty strokes one after the other, and the page ends with the last. */
async function crash({ page, url, context }) {
  await begin(page, url);
  await becomes(() => said(page), '', 'what is said of what is not there');
  for (let i = 0; i < 40; i += 1) await stroke(page, i);
  await fall(page, context);
  const after = await another(context, url);
  await until(after, 'strokes', ['is', 40], 'every stroke is there after the crash');
  await standing(after, 'saved');
  assert.match(await said(after), /Saved in this browser/);
  await after.keyboard.press('Control+z');
  await until(after, 'strokes', ['is', 39], 'and can be undone');
  await standing(after, 'saved');
  await reloaded(after);
  await until(after, 'strokes', ['is', 39], 'as is the undoing');
  await after.close();
}

/** The stroke under the pen is written while it is drawn: the page may end before the stroke does. */
async function underPen({ page, url, context }) {
  await begin(page, url);
  await page.keyboard.press('m');
  const box = await page.locator('.sheet').boundingBox();
  const reach = async (of, steps) => {
    await of.mouse.move(box.x + 150, box.y + 400);
    await of.mouse.down();
    await of.mouse.move(box.x + 180, box.y + 250, { steps });
  };
  await reach(page, 12);
  const written = (of, before) =>
    eventually(
      () => underHand(of),
      ({ after, points }) => points > 9 && after !== before,
      'what is under the pen is written',
    );
  await written(page);
  assert.equal(await count(page, 'strokes'), 0, 'it is not finished');
  await fall(page, context);
  const after = await another(context, url);
  await until(after, 'strokes', ['is', 2], 'the stroke is there, with its mirror image');
  await standing(after, 'saved');
  await after.keyboard.press('Control+z');
  await until(after, 'strokes', ['is', 0], 'as one step of undo');
  await standing(after, 'saved');
  await reloaded(after);
  await until(after, 'strokes', ['is', 0], 'and does not come back');
  // What the system takes from the hand was no stroke.
  const { after: before } = await underHand(after);
  await reach(after, 12);
  await written(after, before);
  await after.locator('.sheet').dispatchEvent('pointercancel', { pointerId: 1, pointerType: 'mouse' });
  await becomes(async () => (await underHand(after)).points, 0, 'points of it that are written');
  await reloaded(after);
  await until(after, 'strokes', ['is', 0], 'a stroke that was taken back is none');
  await after.close();
}

/** A gesture that is not finished is nothing; one that is finished is there with all its parts. */
async function gestures({ page, url }) {
  await begin(page, url);
  await page.keyboard.press('m');
  await draw(page, line(150, 400, 180, 250, 8));
  await until(page, 'strokes', ['is', 2], 'both sides');
  await page.keyboard.press('v');
  await page.keyboard.press('Control+a');
  const box = await page.locator('.sheet').boundingBox();
  await page.mouse.move(box.x + 165, box.y + 330);
  await page.mouse.down();
  await page.mouse.move(box.x + 200, box.y + 300);
  await standing(page, 'saved');
  await reloaded(page);
  await until(page, 'strokes', ['is', 2], 'both sides are there');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', 0], 'the half of a drag is no step of undo');
  await page.mouse.up();
}

async function tabs({ page, url, context, shot }) {
  await begin(page, url);
  for (let i = 0; i < 3; i += 1) await stroke(page, i);
  await until(page, 'strokes', ['is', 3], 'drawn in the first tab');
  let second = await another(context, url);
  await until(second, 'strokes', ['is', 3], 'the second tab shows it');
  await second.locator('#b-readonly').waitFor();
  await becomes(() => said(second), 'Read only', 'what is said');
  // The first is closed a moment later, as one that fell is cleared up: the second has it without a word.
  await page.close();
  await second.locator('#b-readonly').waitFor({ state: 'hidden' });
  page = second;
  second = await another(context, url);
  await second.locator('#b-readonly').waitFor();
  await stroke(second, 3);
  await second.locator('.note.bad', { hasText: 'open in another tab' }).waitFor();
  assert.equal(await count(second, 'strokes'), 3, 'nothing is drawn there');
  await shot('read-only', second);
  await stroke(page, 4);
  await until(page, 'strokes', ['is', 4], 'the first goes on');
  await second.click('#b-takeover');
  await until(second, 'strokes', ['is', 4], 'taken over with all that was drawn meanwhile');
  await second.locator('#b-readonly').waitFor({ state: 'hidden' });
  await page.locator('#b-readonly').waitFor();
  await stroke(second, 5);
  await until(second, 'strokes', ['is', 5], 'the second draws');
  await stroke(page, 6);
  await page.locator('.note.bad', { hasText: 'open in another tab' }).waitFor();
  await standing(second, 'saved');
  await reloaded(second);
  await until(second, 'strokes', ['is', 5], 'nothing was overwritten');
  await second.locator('#b-readonly').waitFor({ state: 'hidden' });
  // The other tab is gone: the document comes back by one click, with everything.
  await second.close();
  await page.click('#b-takeover');
  await until(page, 'strokes', ['is', 5], 'all of it');
  await page.locator('#b-readonly').waitFor({ state: 'hidden' });
  // A second tab may have a document of its own.
  const third = await another(context, url);
  await third.click('#b-readonly-new');
  await until(third, 'strokes', ['is', 0], 'a new document');
  await standing(third, 'empty');
  await stroke(third, 1);
  await until(third, 'strokes', ['is', 1], 'drawn there');
  await stroke(page, 7);
  await until(page, 'strokes', ['is', 6], 'both draw');
  await standing(third, 'saved');
  await reloaded(third);
  await until(third, 'strokes', ['is', 1], 'each its own');
  await third.close();
}

/** Without locks the tab that came last has the document; the other is told, and writes nothing. */
async function lockless({ page, url, context }) {
  await context.addInitScript(() =>
    Object.defineProperty(Navigator.prototype, 'locks', { value: undefined }),
  );
  await begin(page, url);
  await stroke(page, 0);
  await standing(page, 'saved');
  const second = await another(context, url);
  await stroke(second, 1);
  await until(second, 'strokes', ['is', 2], 'the last tab draws');
  await standing(second, 'saved');
  await page.locator('#b-readonly').waitFor();
  await reloaded(second);
  await until(second, 'strokes', ['is', 2], 'it is kept');
  await second.close();
}

/** The same without any word between the tabs: the row of the journal is taken. */
async function mute({ page, url, context }) {
  await context.addInitScript(() => {
    Object.defineProperty(Navigator.prototype, 'locks', { value: undefined });
    delete globalThis.BroadcastChannel;
  });
  await begin(page, url);
  await stroke(page, 0);
  await standing(page, 'saved');
  const second = await another(context, url);
  await stroke(second, 1);
  await standing(second, 'saved');
  await stroke(page, 2);
  await standing(page, 'readonly');
  await reloaded(second);
  await until(second, 'strokes', ['is', 2], 'the other tab wrote nothing into it');
  await second.close();
}

async function list({ page, url, shot }) {
  await begin(page, url);
  await page.locator('.sheet').focus();
  await page.keyboard.press('Shift+O');
  await page.locator('dialog', { hasText: 'Nothing is here yet' }).waitFor();
  await page.keyboard.press('Escape');
  await sample(page);
  await settled(page);
  await page.click('#b-fresh');
  await until(page, 'strokes', ['is', 0], 'a new document');
  await page.locator('.note', { hasText: 'in your documents' }).waitFor();
  await standing(page, 'empty');
  assert.equal(await page.locator('#b-undo').isDisabled(), true, 'with a history of its own');
  await stroke(page, 1);
  await standing(page, 'saved');
  await settled(page);
  const names = await shelf(page);
  assert.equal(names.length, 2);
  assert.equal(await page.locator('.shelf-open img').count(), 2, 'both have a picture');
  await shot('documents');
  // Another name is in the list at once.
  await page.keyboard.press('Escape');
  await page.fill('#b-name', 'A stroke');
  await page.keyboard.press('Enter');
  await eventually(
    async () => {
      const now = await shelf(page);
      await page.keyboard.press('Escape');
      return now;
    },
    (now) => now[0] === 'A stroke',
    'the list tells the new name',
  );
  await shelf(page);
  // By keyboard alone: down to the sample, another name, a copy, away with it and back.
  await page.locator('.shelf .shelf-open').first().focus();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('F2');
  await page.locator('.shelf input:focus').waitFor();
  await page.keyboard.type('A rose');
  await page.keyboard.press('Enter');
  const rose = page.locator('.shelf-open', { hasText: 'A rose' });
  await rose.waitFor();
  await page.click('.shelf li:has-text("A rose") [data-act=copy]');
  await page.locator('.shelf-open', { hasText: 'A rose (copy)' }).waitFor();
  await page.locator('.shelf-open', { hasText: 'A rose (copy)' }).focus();
  await page.keyboard.press('Delete');
  await page.locator('.shelf-gone', { hasText: 'A rose (copy)' }).waitFor();
  await becomes(
    () => page.evaluate(() => document.activeElement.textContent),
    'Put back',
    'what has the keys',
  );
  await shot('documents-deleted');
  await page.keyboard.press('Enter');
  await page.locator('.shelf-gone').waitFor({ state: 'hidden' });
  await page.locator('.shelf-open', { hasText: 'A rose (copy)' }).click();
  await until(page, 'strokes', ['is', 15], 'the copy is open');
  await becomes(() => page.locator('#b-name').inputValue(), 'A rose (copy)', 'the name');
  // The one that is here may be deleted, too.
  await shelf(page);
  await page.locator('.shelf li:has([aria-current=true]) [data-act=delete]').click();
  await until(page, 'strokes', ['is', 0], 'another one is here');
  await page.locator('[data-back]').click();
  // The list is made anew, in another order.
  await page.locator('.shelf-gone').waitFor({ state: 'hidden' });
  await page.locator('.shelf-open', { hasText: 'A rose (copy)' }).click();
  await until(page, 'strokes', ['is', 15], 'and back');
  await reloaded(page);
  await until(page, 'strokes', ['is', 15], 'this tab stays with it');
}

async function listOnPhone({ page, url, shot }) {
  await begin(page, url);
  await page.click('#b-samples');
  await page.click('[data-sample=tulip]');
  await until(page, 'triangles', ['above', 0], 'a tulip');
  await settled(page);
  await page.click('#b-documents');
  await page.locator('.shelf-open').first().waitFor();
  const box = await page.locator('dialog').boundingBox();
  assert.ok(box.x >= 0 && box.x + box.width <= 390, 'it fits');
  assert.ok(
    await page.locator('dialog').evaluate((d) => d.scrollWidth <= d.clientWidth),
    'nothing sticks out',
  );
  await shot('documents-phone');
}

/** The palette once forgot the document for good, by the letters of "layer". */
async function palette({ page, url }) {
  await begin(page, url);
  const n = await sample(page);
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').fill('zlayer');
  await page.locator('.palette .muted', { hasText: 'Nothing is called that' }).waitFor();
  await page.locator('.palette input').fill('layer');
  await page.locator('.palette .muted').waitFor({ state: 'detached' });
  await page.keyboard.press('Enter');
  await page.keyboard.press('Escape');
  await answered(page);
  assert.equal(await count(page, 'strokes'), n);
  // Every command of the palette that empties the sheet can be taken back.
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').fill('new');
  await page.click('#p-new');
  await until(page, 'strokes', ['is', 0], 'New');
  await take(page, '', 'Go back');
  await until(page, 'strokes', ['is', n], 'and back');
  await standing(page, 'saved');
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').fill('erase every');
  await page.keyboard.press('Enter');
  await until(page, 'strokes', ['is', 0], 'erased');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', n], 'undone');
}

/** A storage that is full for a while: it is said, and all is there when there is room again. */
async function full({ page, url, shot }) {
  await page.addInitScript(() => {
    const { add, put } = IDBObjectStore.prototype;
    const unless = (act) =>
      function write(...rest) {
        if (sessionStorage.getItem('full')) throw new DOMException('full', 'QuotaExceededError');
        return act.apply(this, rest);
      };
    Object.assign(IDBObjectStore.prototype, { add: unless(add), put: unless(put) });
  });
  await begin(page, url);
  await stroke(page, 0);
  await standing(page, 'saved');
  await page.evaluate(() => sessionStorage.setItem('full', 'yes'));
  await stroke(page, 1);
  await page.locator('.note.bad', { hasText: 'storage is full' }).waitFor();
  assert.match(await said(page), /Not saved: the browser’s storage is full/);
  await shot('full');
  // What cannot be kept is not left behind: New is a step of undo.
  await page.click('#b-fresh');
  await until(page, 'strokes', ['is', 0], 'New');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', 2], 'and back');
  await page.evaluate(() => sessionStorage.removeItem('full'));
  await stroke(page, 2);
  await standing(page, 'saved');
  await reloaded(page);
  await until(page, 'strokes', ['is', 3], 'all is there');
}

/** The document is written whole now and then: what was done before can still be undone, and is gone afterwards, too. */
async function long({ page, url }) {
  await begin(page, url);
  await page.evaluate(() => {
    const transfer = new DataTransfer();
    // More in one request than the journal is to hold.
    const strokes = Array.from({ length: 60 }, (_, k) => ({
      points: [
        [k, 0],
        [k, 5],
        [k + 1, 9],
      ],
    }));
    const text = JSON.stringify({ burgeon: 'drawing/1', name: 'long', y: 'up', strokes }).padEnd(17 << 20);
    transfer.items.add(new File([text], 'long.json'));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true }));
  });
  await until(page, 'strokes', ['is', 60], 'a large file');
  await standing(page, 'saved');
  await becomes(async () => (await stored(page, 'wholes')).length, 1, 'documents written whole');
  await becomes(async () => (await stored(page, 'journal')).length, 0, 'rows of the journal');
  await stroke(page, 0);
  await until(page, 'strokes', ['is', 61], 'a stroke');
  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', 0], 'undone beyond what was written whole');
  await stroke(page, 1);
  await until(page, 'strokes', ['is', 1], 'another stroke');
  await standing(page, 'saved');
  await reloaded(page);
  await until(page, 'strokes', ['is', 1], 'it is as it was left');
}

export const keeping = [
  ['kept: forty quick strokes and a crash', crash],
  ['kept: the stroke under the pen', underPen],
  ['kept: gestures', gestures],
  ['kept: two tabs', tabs],
  ['kept: two tabs without locks', lockless],
  ['kept: two tabs that cannot speak', mute],
  ['kept: the list of documents', list, { viewport: { width: 1280, height: 800 } }],
  ['kept: the list on a phone', listOnPhone, { viewport: { width: 390, height: 844 }, hasTouch: true }],
  ['kept: the palette destroys nothing', palette],
  ['kept: a storage that is full', full],
  ['kept: a large document', long],
];
