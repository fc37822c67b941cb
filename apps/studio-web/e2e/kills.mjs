// node e2e/kills.mjs CHROMIUM BURGEON [FOLDER] : a quick hand draws in several documents while their pages, or the whole
// browser, are killed at random moments. Every stroke that was finished must be there afterwards. Its end may lack where
// the kill comes within some milliseconds after it, since a browser drops what of a page it has not written yet; how many
// of those there are is printed. SEED and KILLS change what is done.
import { mkdtempSync, readlinkSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium } from 'playwright-core';
import { FLAGS } from './flags.mjs';
import { serve } from './server.mjs';

const [browserPath, burgeon, folder = 'dist-test'] = process.argv.slice(2);
const seed = Number(process.env.SEED ?? 1);
const kills = Number(process.env.KILLS ?? 200);
/** Documents that are drawn at the same time, each in a tab. */
const HANDS = 4;
/** In one round of so many the browser is killed with all its processes, in the others only those of its pages. */
const WHOLE = 5;
/** Where the pen is heard from while it draws, and how long the quick hand takes from one to the next, ms. */
const POINTS = 16;
const STEP = 10;
/** A hand takes a new document after so many strokes. */
const FULL = 150;
/**
 * A document that is not free after so many openings is held by a page that lives on where Playwright no longer sees it:
 * then the whole browser is killed. One that is not free in a browser that was just started is a fault, so often in a row.
 */
const TRIES = 8;
const STUCK = 3;
/** A call to a page that was killed may never be answered, ms; and all of it takes no longer than this. */
const ANSWER = 5000;
const LIMIT = 20 * 60_000;

let state = seed >>> 0;
/** A number from 0 to 1 (mulberry32). */
function random() {
  state = (state + 0x6d2b79f5) >>> 0;
  let t = Math.imul(state ^ (state >>> 15), state | 1);
  t = (t + Math.imul(t ^ (t >>> 7), t | 61)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
}

/** Ends the openings under way: one of them waits for an answer that never comes. */
const openings = new Set();

// A page that is killed while it opens may be told of by the browser after Playwright has forgotten it. Is it the answer
// to a call that is told so, then nobody hears it.
process.on('uncaughtException', (e) => {
  if (e.message.startsWith('Cannot find parent object page@')) return;
  if (e.message.endsWith('was not bound in the connection')) {
    for (const end of openings) end(new Error('Target crashed: it was forgotten before it answered'));
    return;
  }
  console.error(e);
  process.exit(1);
});

const { url } = await serve(burgeon, folder);
const profile = mkdtempSync(join(tmpdir(), 'burgeon-kills-'));
process.on('exit', () => {
  try {
    rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  } catch (e) {
    // Processes of the browser that are just ending may still write there.
    console.error(`${profile} is left behind: ${e.message}`);
  }
});

async function launch() {
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: browserPath,
    args: FLAGS,
    viewport: { width: 640, height: 480 },
    // It lives in the process of a page: killed with it, it sometimes leaves others without an answer for a minute.
    serviceWorkers: 'block',
  });
  context.pid = Number(/-(\d+)$/.exec(readlinkSync(join(profile, 'SingletonLock')))[1]);
  return context;
}

/** In the page: the document of this hand; and one stroke after another, as soon as it is told to. */
function inPage({ id, points, step }) {
  // The view is of no use here, and drawing it without a graphics card takes most of the time.
  const { getContext } = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function get(kind, ...rest) {
    return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...rest);
  };
  localStorage.setItem('burgeon.tour', 'done');
  sessionStorage.setItem('burgeon.document', id);
  window.draw = (gap) => {
    const sheet = document.querySelector('.sheet');
    sheet.setPointerCapture = () => {};
    const kept = document.querySelector('#b-kept');
    let done = Number(document.body.dataset.strokes);
    const tell = (what) =>
      window.told(what, done, sessionStorage.getItem('burgeon.document'), kept.textContent);
    const saved = () => {
      if (/^Saved/.test(kept.textContent)) tell('saved');
    };
    new MutationObserver(saved).observe(kept, { childList: true, characterData: true, subtree: true });
    const box = sheet.getBoundingClientRect();
    const send = (type, x, y) =>
      sheet.dispatchEvent(
        new PointerEvent(type, {
          pointerType: 'mouse',
          pointerId: 1,
          clientX: box.left + x,
          clientY: box.top + y,
          buttons: 1,
          bubbles: true,
          isPrimary: true,
        }),
      );
    const stroke = (k) => {
      const [x, y] = [90 + 9 * (done % 16) + k / 2, 50 + 9 * (Math.floor(done / 16) % 10) + 3 * k];
      if (k < points - 1) {
        send(k === 0 ? 'pointerdown' : 'pointermove', x, y);
        setTimeout(stroke, step, k + 1);
        return;
      }
      done += 1;
      send('pointerup', x, y);
      // Done when the page has heard of it, as it has of a real pen before anything else happens.
      queueMicrotask(() => tell('done'));
      setTimeout(stroke, gap, 0);
    };
    stroke(0);
  };
}

/** In the page: how many points each stroke has in the journal of a document. */
function lengthsOf(id) {
  return new Promise((resolve) => {
    indexedDB.open('burgeon').onsuccess = ({ target: { result: base } }) => {
      const range = IDBKeyRange.bound([id, 0], [id, Infinity]);
      base.transaction('journal').objectStore('journal').getAll(range).onsuccess = ({ target }) => {
        base.close();
        resolve(target.result.filter((r) => r.kind === 'stroke').map((r) => r.samples.length / 4));
      };
    };
  });
}

const sums = { pages: 0, browsers: 0, strokes: 0, loading: 0, short: 0, under: 0, waited: 0, stuck: 0 };
const wrong = [];
const hands = Array.from({ length: HANDS }, () => ({ id: '', done: 0, saved: 0, known: 0, end: '' }));
const pause = (ms) =>
  new Promise((r) => {
    setTimeout(r, ms);
  });

const close = (page) => Promise.race([page.close().catch(() => {}), pause(ANSWER)]);

/** Not with each frame: a tab behind another has none. */
const until = (page, test) => page.waitForFunction(test, undefined, { polling: 50 });

/** Opens the document of a hand and looks whether everything is there. */
async function open(hand) {
  const { page } = hand;
  page.setDefaultTimeout(60_000);
  await page.addInitScript(inPage, { id: hand.id, points: POINTS, step: STEP });
  await page.exposeFunction('told', (what, n, id, said) => {
    hand[what] = Math.max(hand[what], n);
    [hand.id, hand.said] = [id, said];
  });
  await page.goto(url);
  await until(page, () => document.body.dataset.ready === 'true');
}

class NotFree extends Error {}

/**
 * A page may fall with one that is killed beside it, before it has a process of its own. And one that was killed may have
 * its document still, while the system takes its process apart: until then the document can only be looked at.
 */
async function openSurely(hand) {
  for (let k = 0; k < TRIES; k += 1) {
    hand.page = await context.newPage();
    let end;
    const ended = new Promise((_, reject) => {
      end = reject;
      openings.add(end);
    });
    try {
      await Promise.race([open(hand), ended]);
      if (hand.id === '' || !(await readonly(hand))) return;
      sums.waited += 1;
    } catch (e) {
      if (!e.message.includes('Target crashed')) throw e;
    } finally {
      openings.delete(end);
    }
    await close(hand.page);
  }
  throw new NotFree(`the document ${hand.id} was not free after ${TRIES} openings (${hand.end})`);
}

const readonly = ({ page }) => page.evaluate(() => document.body.dataset.kept === 'readonly');

async function check(hand) {
  if (hand.id === '') return;
  const found = await hand.page.evaluate(() => Number(document.body.dataset.strokes));
  if (found < hand.done)
    wrong.push(
      `${found} strokes of ${hand.done}, of which ${hand.saved} were called saved (${hand.id}, ${hand.end}; it opened with ${hand.known} and said last: ${hand.said})`,
    );
  const lengths = await hand.page.evaluate(lengthsOf, hand.id);
  const last = lengths.at(-1) ?? POINTS;
  if (found > hand.done) sums.under += 1;
  else if (hand.done > hand.known && last < POINTS) sums.short += 1;
  [hand.done, hand.saved, hand.known] = [found, found, found];
}

/** A new document: the old one is full, or there is none yet. */
async function turn(hand) {
  await hand.page.click('#b-fresh');
  await until(hand.page, () => document.body.dataset.kept === 'empty');
  if (hand.id !== '') sums.strokes += hand.done;
  Object.assign(hand, { id: '', done: 0, saved: 0, known: 0 });
}

const began = Date.now();
setTimeout(() => {
  console.error(
    `not done after ${LIMIT / 60_000} minutes: ${JSON.stringify(sums)} ${JSON.stringify(hands.map((h) => h.end))}`,
  );
  process.exit(1);
}, LIMIT).unref();
let context = await launch();
let stuckInARow = 0;

/** Kills the browser with all its processes, and starts another. */
async function killBrowser() {
  // Playwright gives the browser a group of its own.
  process.kill(-context.pid, 'SIGKILL');
  await Promise.race([context.close().catch(() => {}), pause(ANSWER)]);
  context = await launch();
}

for (let round = 0; sums.pages + sums.browsers * HANDS < kills; round += 1) {
  const whole = round % WHOLE === WHOLE - 1;
  const browserAt = 300 + 1500 * random();
  // Some are killed while their document is still being opened.
  const plans = hands.map(() => ({ early: random() < 0.1, at: 1000 * random(), gap: 30 + 200 * random() }));
  const work = hands.map(async (hand, i) => {
    const { early, at, gap } = plans[i];
    const end = `${whole ? 'the whole browser' : 'the page'} killed ${early ? 'while it opened' : `after ${at.toFixed(0)} ms`}`;
    if (early) {
      hand.page = await context.newPage();
      const opening = open(hand);
      opening.catch(() => {});
      await Promise.race([pause(at), opening]).catch(() => {});
      sums.loading += 1;
    } else {
      await openSurely(hand);
      await check(hand);
      if (hand.id === '' || hand.done >= FULL) await turn(hand);
      await hand.page.evaluate((g) => window.draw(g), gap);
      await pause(at);
    }
    hand.end = end;
    if (whole) return;
    const crash = context.newCDPSession(hand.page).then((cdp) => cdp.send('Page.crash'));
    // A page that is only being opened does not always say that it fell.
    const fell = hand.page.waitForEvent('crash', { timeout: ANSWER }).catch(() => {});
    await Promise.race([crash.catch(() => {}), fell]);
    sums.pages += 1;
    await close(hand.page);
  });
  const failed = (await Promise.allSettled(work)).flatMap((w) => (w.status === 'rejected' ? [w.reason] : []));
  const other = failed.find((e) => !(e instanceof NotFree));
  if (other) throw other;
  stuckInARow = failed.length > 0 ? stuckInARow + 1 : 0;
  if (stuckInARow === STUCK) throw failed[0];
  if (whole || failed.length > 0) {
    if (failed.length === 0) await pause(browserAt);
    await killBrowser();
    if (failed.length === 0) sums.browsers += 1;
    else sums.stuck += 1;
  }
}
// In a browser of its own: nothing is held by a page of before.
await killBrowser();
for (const hand of hands) {
  await openSurely(hand);
  await check(hand);
  sums.strokes += hand.done;
}
await context.close();
const pages = sums.pages + HANDS * sums.browsers;
console.log(
  `${wrong.length === 0 ? 'ok      ' : 'FAILED  '}${pages} pages killed while ${sums.strokes} strokes were drawn: ` +
    `${sums.pages} by themselves, ${sums.browsers} times ${HANDS} with the whole browser, ${sums.loading} while they opened; ` +
    `${sums.under} strokes that were under the pen are there, ${sums.short} finished ones lack their end; ${sums.waited} documents were not free at once, ${sums.stuck} times the browser was killed for it (seed ${seed}, ` +
    `${((Date.now() - began) / 1000).toFixed(0)} s)`,
);
for (const each of wrong) console.log(`        ${each}`);
process.exit(wrong.length === 0 ? 0 : 1);
