/** Waiting for what a page comes to, however slow the machine is: for the condition itself, never for some time. */
import { isDeepStrictEqual } from 'node:util';

/** So long something may take on a slow machine, ms. */
const PATIENCE_MS = 60_000;

/** Reads again and again until it is as it is to be, and says what was read then. */
export async function eventually(read, test, what) {
  const began = Date.now();
  for (;;) {
    const now = await read();
    if (test(now)) return now;
    if (Date.now() - began > PATIENCE_MS) throw new Error(`${what}: ${JSON.stringify(now)}`);
    await new Promise((done) => {
      setTimeout(done, 40);
    });
  }
}

/** Reads until it is this. */
export const becomes = (read, value, what) =>
  eventually(
    read,
    (now) => isDeepStrictEqual(now, value),
    `${what ?? 'it'} is not ${JSON.stringify(value)}, but`,
  );

/**
 * In the page, before it loads: listens to what is asked of the worker and what it says, and lets a test ask it something
 * that changes nothing. The worker works in order: when it answers that, all that was asked before is done.
 */
export function overhear() {
  const { postMessage } = Worker.prototype;
  const overheard = { asked: 0, grows: false, hands: 0, ask: () => {} };
  const hands = new Set();
  globalThis.overheard = overheard;
  Worker.prototype.postMessage = function post(message, ...rest) {
    if (message?.kind === 'start') {
      Object.assign(overheard, { asked: 0, grows: false });
      overheard.ask = () => this.postMessage({ kind: 'ask', seq: -1, request: { kind: 'held' } });
      // The page listens already: it hears everything first.
      this.addEventListener('message', ({ data: { kind, seq } }) => {
        if (hands.delete(seq)) overheard.hands += 1;
        if (kind === 'done' || kind === 'refused') overheard.asked -= 1;
        if (kind === 'busy') overheard.grows = true;
        if (kind === 'view' || kind === 'failed') overheard.grows = false;
      });
    }
    if (message?.kind === 'ask') overheard.asked += 1;
    if (message?.request?.kind === 'shape') hands.add(message.seq);
    return postMessage.call(this, message, ...rest);
  };
}

/** Two pictures of the page: what was pressed is heard, and what has another size is laid out. */
export const pictures = (page) =>
  page.evaluate(
    () =>
      new Promise((done) => {
        requestAnimationFrame(() => requestAnimationFrame(() => done()));
      }),
  );

/** Until all that was done on the page so far is asked of the worker and answered, and no plant is growing. */
export async function answered(page) {
  await pictures(page);
  await page.evaluate(() => globalThis.overheard?.ask());
  await page.waitForFunction(() => {
    const { asked = 0, grows = false } = globalThis.overheard ?? {};
    // A hand in a headset asks without end.
    return document.body.dataset.headset === 'on' || (asked <= 0 && !grows);
  });
}

/** Does something with a hand that asks without end, until it is answered: the first answer may be to what was before. */
export async function felt(page, act) {
  const before = await page.evaluate(() => globalThis.overheard.hands);
  await act();
  await page.waitForFunction((n) => globalThis.overheard.hands > n, before + 1);
}

/** Until the view shows what there is: its last picture is seen, none is coming, the camera stands still. */
export async function rested(page) {
  await answered(page);
  await pictures(page);
  await page.waitForSelector('.view[data-rests="1"]');
}

/**
 * Until the view is as fine as it becomes, and how fine that is, in pixels for each of the screen's. A busy machine leaves
 * out the finest picture: pictures are comparable when they are equally fine.
 */
export async function finished(page) {
  await rested(page);
  const view = await page.waitForSelector('.view[data-finished]');
  return Number(await view.getAttribute('data-finished'));
}

/** Until a piece of the page that comes when it is first asked for is there, and what waited for it is shown. */
export async function loaded(page, piece) {
  const address = await eventually(
    () =>
      page.evaluate(
        (name) =>
          performance
            .getEntriesByType('resource')
            .map((e) => e.name)
            .find((url) => url.includes(`/${name}-`) && url.endsWith('.js')),
        piece,
      ),
    (url) => url !== undefined,
    `the piece ${piece}`,
  );
  // The page asked first, and hears first.
  await page.evaluate((url) => import(url).then(() => {}), address);
  await rested(page);
}

/** Where the camera is, once it stands still. */
export async function restingEye(page) {
  await rested(page);
  return JSON.parse(await page.locator('.view').getAttribute('data-eye'));
}

/** Loads the page again, until it has its document back and may change it. */
export async function reloaded(page) {
  await page.reload();
  await page.waitForFunction(() => document.body.dataset.ready === 'true');
  await answered(page);
}

/** What is done for the document is kept in the browser. */
export const saved = (page) => page.waitForFunction(() => document.body.dataset.kept === 'saved');

/** What a store of the browser's database holds, columns of numbers only by their length; `how`: `getAllKeys` for its keys. */
export const stored = (page, store, how = 'getAll') =>
  page.evaluate(
    ([name, ask]) =>
      new Promise((resolve) => {
        indexedDB.open('burgeon').onsuccess = ({ target: { result: base } }) => {
          base.transaction(name).objectStore(name)[ask]().onsuccess = ({ target }) => {
            base.close();
            const short = (_, v) => (ArrayBuffer.isView(v) ? v.length : v);
            resolve(JSON.parse(JSON.stringify(target.result, short)));
          };
        };
      }),
    [store, how],
  );

/** Presses what a note offers. It goes by itself after some seconds: there is no time to look at it first. */
export const take = (page, note, word) =>
  page.locator('.note', { hasText: note }).locator('button', { hasText: word }).dispatchEvent('click');
