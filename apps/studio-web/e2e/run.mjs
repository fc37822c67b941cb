// node e2e/run.mjs CHROMIUM BURGEON OUT [FOLDER] : the main journeys through the Studio, in a real browser, against the
// real server. Pictures of each go to OUT. FOLDER: the built page, if not that of the tests.
import { mkdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { chromium } from 'playwright-core';
import { FLAGS } from './flags.mjs';
import { grove } from './grove.mjs';
import { headset, headsetCore } from './headset.mjs';
import { headsetCosts } from './headset-costs.mjs';
import { headsetHabits } from './headset-habits.mjs';
import { journeys } from './journeys.mjs';
import { keeping } from './keeping.mjs';
import { materialJourneys } from './materials.mjs';
import { serve } from './server.mjs';
import { network } from './network.mjs';
import { programJourneys } from './programs.mjs';
import { shaping } from './shaping.mjs';
import { sheet } from './sheet.mjs';
import { staging } from './staging.mjs';
import { strokes } from './strokes.mjs';
import { trust } from './trust.mjs';
import { overhear } from './waits.mjs';

const [browserPath, burgeon, out, folder = 'dist-test'] = process.argv.slice(2);
rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });

/** Journeys at a time: while one waits another walks. */
const WALKERS = Number(process.env.WALKERS ?? 2);

const { url, link } = await serve(burgeon, folder, '../../fixtures/sketches/gallery/tulip.svg');

const only = process.env.ONLY;
const all = [
  ...journeys,
  ...keeping,
  ...strokes,
  ...sheet,
  ...trust,
  ...programJourneys,
  ...materialJourneys,
  ...shaping,
  ...staging,
  ...grove,
  ...network,
];
const wanted = ([name]) => !only || name.includes(only);
// Two pictures a frame: minutes without a graphics card. So one of them in each run, in which a gesture in the air becomes
// an edit; the others when they are asked for, all but those that measure by HEADSETS=all.
const alone = headsetCore.filter(([name]) => name === 'headset: astray');
if (process.env.HEADSETS === 'all') alone.splice(0, 1, ...headsetCore, ...headset, ...headsetHabits);
if (only?.startsWith('headset'))
  alone.splice(0, alone.length, ...headsetCore, ...headset, ...headsetHabits, ...headsetCosts);

let failed = 0;

/** Walks through one journey and says how it went. */
async function walk(browser, [name, journey, options]) {
  const context = await browser.newContext({
    viewport: { width: 1000, height: 640 },
    locale: 'en-GB',
    acceptDownloads: true,
    ...options,
  });
  if (!options?.fresh) await context.addInitScript(() => localStorage.setItem('burgeon.tour', 'done'));
  await context.addInitScript(overhear);
  const page = await context.newPage();
  const troubles = [];
  const foreign = [];
  // A journey may start a server of its own.
  const own = [url];
  page.on('pageerror', (e) => troubles.push(`error in the page: ${e.message}`));
  page.on('console', (m) => {
    if (m.type() === 'error') troubles.push(`console: ${m.text()}`);
  });
  page.on('request', (r) => {
    if (!/^(blob|data):/.test(r.url()) && !own.some((o) => r.url().startsWith(o))) foreign.push(r.url());
  });
  page.setDefaultTimeout(60_000);
  const began = Date.now();
  try {
    await journey({
      page,
      context,
      url,
      link,
      own,
      burgeon,
      folder,
      out,
      shot: (file, of = page) => of.screenshot({ path: join(out, `${file}.png`) }),
      troubles,
    });
    if (foreign.length > 0) throw new Error(`asked other hosts: ${foreign.join(', ')}`);
    if (troubles.length > 0) throw new Error(troubles.join('\n'));
    console.log(`ok      ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (e) {
    failed += 1;
    const where = (e.stack ?? '').split('\n').filter((l) => l.includes('/e2e/'));
    const data = await page
      .evaluate(() => JSON.stringify(document.body.dataset))
      .catch(() => 'the page is gone');
    const more = [...troubles, ...where.map((l) => l.trim()), data.slice(0, 2000)];
    console.log(`FAILED  ${name}: ${e.message}\n        ${more.join('\n        ')}`);
    await page.screenshot({ path: join(out, `failed-${name.replace(/\W+/g, '-')}.png`) }).catch(() => {});
  }
  await context.close();
}

/** Takes one journey after another from a list, with a browser of its own: clipboard and keyboard are shared by none. */
async function walker(list) {
  const browser = await chromium.launch({ executablePath: browserPath, args: FLAGS });
  for (let next = list.shift(); next; next = list.shift()) await walk(browser, next);
  await browser.close();
}

const list = all.filter(wanted);
await Promise.all(Array.from({ length: Math.min(WALKERS, list.length) }, () => walker(list)));
await walker(alone.filter(wanted));
console.log(`Studio journeys: ${failed} failed; pictures in ${out}`);
process.exit(failed > 0 ? 1 : 0);
