// Plants for a program, and light on plants: what the page says is what the command says.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { add, begin, bush, settled } from './journeys.mjs';
import { palette, pixels, unzipped } from './staging.mjs';
import { answered, finished, rested } from './waits.mjs';

/** The JSON of a binary glTF file. */
const gltf = (glb) => JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString());

/** Chooses a program in the open dialogue and waits for what it was given. */
async function choose(page, program) {
  await page.selectOption('#b-for', program);
  await answered(page);
  await page.locator('#b-export-set').waitFor();
  return page.locator('#b-export-set').textContent();
}

async function saved(page, act) {
  const [download] = await Promise.all([page.waitForEvent('download'), act()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

const formats = (page) =>
  page
    .locator('.formats .format:visible input')
    .evaluateAll((radios) => radios.map((radio) => radio.dataset.format));

/** A program sets what it wants; what a person asks for wins; the files are as was said. */
async function programs({ page, url, shot }) {
  await bush(page, url);
  await page.click('#b-export');
  const said = await choose(page, 'unity');
  assert.match(said, /^Set for Unity: 3 coarser levels, levels as nodes .*, wind as texture coordinates/);
  assert.deepEqual(await formats(page), ['glb', 'gltf']);
  assert.equal(await page.inputValue('#b-levels'), '4');
  assert.ok(await page.isChecked('#b-wind'));
  await shot('programs-unity');
  // Two levels, and no wind: asked for.
  await page.selectOption('#b-levels', '2');
  await page.uncheck('#b-wind');
  await answered(page);
  const without = await page.locator('#b-export-set').textContent();
  assert.match(without, /^Set for Unity: levels as nodes .* materials and parts named/);
  assert.ok(!without.includes('wind'), without);
  const unity = await saved(page, () => page.click('#b-export-go'));
  const finest = gltf(unity.bytes);
  const names = finest.nodes.map(({ name }) => name);
  for (const name of ['bush_LOD0', 'bush_LOD1', 'bush_collider'])
    assert.ok(names.includes(name), JSON.stringify(names));
  assert.ok(
    finest.materials.every(({ name }) => name.startsWith('bush_')),
    JSON.stringify(finest.materials.map((m) => m.name)),
  );
  await page.locator('.note', { hasText: 'Set for Unity' }).waitFor();
  // It is remembered; another program begins anew.
  await page.click('#b-export');
  assert.equal(await page.inputValue('#b-for'), 'unity');
  await answered(page);
  assert.deepEqual([await page.inputValue('#b-levels'), await page.isChecked('#b-wind')], ['2', false]);
  assert.match(await choose(page, 'three'), /2 coarser levels, packed \(meshopt\), wind for shaders/);
  const three = await saved(page, () => page.click('#b-export-go'));
  const packed = gltf(unzipped(three.bytes, 'plant_LOD0.glb'));
  assert.ok(packed.extensionsRequired.includes('EXT_meshopt_compression'), 'packed');
  await page.click('#b-export');
  assert.match(await choose(page, 'isaac'), /up axis \+Z, unit m/);
  assert.ok(
    (await formats(page)).every((f) => f.startsWith('usd')),
    'USD alone',
  );
  // A print is one closed body in millimetres.
  assert.match(await choose(page, 'print'), /up axis \+Z, unit mm/);
  assert.deepEqual((await formats(page)).sort(), ['ply', 'stl']);
  await shot('programs-print');
  await page.click('[data-format=stl]');
  await answered(page);
  const print = await saved(page, () => page.click('#b-export-go'));
  assert.equal(print.bytes.length, 84 + 50 * print.bytes.readUInt32LE(80), 'a binary STL');
  await page.locator('.note', { hasText: /Printed at 1 : [\d.]+/ }).waitFor();
}

/** Sets a field of light and waits for what comes of it. */
async function lit(page, act) {
  await act();
  // The panel is a module of its own: it may still be on its way.
  await page.locator('#b-lightview').waitFor();
  await page.waitForFunction(() => {
    const { wanted, shown } = document.querySelector('#b-lightview').dataset;
    return shown !== undefined && wanted === shown;
  });
  return page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll('#b-lightview [data-figure]')].map((cell) => [
        cell.dataset.figure,
        Number(cell.dataset.value),
      ]),
    ),
  );
}

const put = (page, key, value) =>
  page.locator(`[data-light=${key}]`).evaluate((field, v) => {
    field.value = v;
    field.dispatchEvent(new Event('change', { bubbles: true }));
  }, String(value));

/** Light on a bush under three skies, equal to what the command says of the same project. */
async function light({ page, url, shot, burgeon }) {
  await bush(page, url);
  await finished(page);
  const before = await pixels(page, await page.locator('.view canvas').screenshot());
  const sky = await lit(page, () => palette(page, 'light'));
  await page.locator('#b-light-legend').waitFor();
  await rested(page);
  const after = await pixels(page, await page.locator('.view canvas').screenshot());
  let differ = 0;
  for (let i = 0; i < before.p.length; i += 4)
    if (Math.abs(before.p[i] - after.p[i]) + Math.abs(before.p[i + 2] - after.p[i + 2]) > 60) differ += 1;
  assert.ok(differ > 500, `the plant has other colours: ${differ} pixels`);
  await shot('light-overcast');
  const project = await saved(page, () => palette(page, 'save'));
  const folder = mkdtempSync(join(tmpdir(), 'burgeon-light-'));
  const file = join(folder, 'bush.burgeon');
  writeFileSync(file, project.bytes);
  const told = (...options) => {
    const report = join(folder, 'light.json');
    execFileSync(burgeon, ['light', file, '--quiet', '--rays', '32768', '--report', report, ...options]);
    return JSON.parse(readFileSync(report, 'utf8')).light;
  };
  const same = async (figures, ...options) => {
    const { incoming_per_m2, absorbed, leaf_absorbed, leaf_share, leaf_area_m2, sunlit, colours_to_per_m2 } =
      told(...options);
    const legend = await page.locator('#b-light-legend').getAttribute('data-brightest');
    assert.deepEqual(
      [figures.incoming, figures.absorbed, figures.leaves, figures.share, figures.area, Number(legend)],
      [incoming_per_m2, absorbed, leaf_absorbed, leaf_share, leaf_area_m2, colours_to_per_m2],
      options.join(' '),
    );
    if (sunlit !== null) assert.equal(figures.sunlit, sunlit, options.join(' '));
  };
  await same(sky);
  const sun = await lit(page, () => page.selectOption('[data-light=source]', 'sun'));
  await same(sun, '--sun', '180,45', '--direct', '200', '--diffuse', '100', '--sky', 'clear');
  assert.ok(sun.sunlit > 0 && sun.absorbed > sky.absorbed);
  await page.selectOption('[data-light=unit]', 'percent');
  assert.match(await page.locator('#b-light-legend .ends span').last().textContent(), /^[\d.]+ %$/);
  await shot('light-sun');
  const place = await lit(page, () => page.selectOption('[data-light=source]', 'place'));
  await same(place, '--place', '48.1,11.6', '--date', '2026-06-21', '--hour', '12');
  // At night there is none, and it is said why.
  await lit(page, () => put(page, 'hour', 1));
  assert.match(await page.locator('#b-light-why').textContent(), /below the horizon/);
  assert.ok(await page.locator('#b-light-legend').isHidden());
  const day = await lit(page, () => page.selectOption('[data-light=span]', 'day'));
  await same(day, '--place', '48.1,11.6', '--date', '2026-06-21', '--daily');
  await shot('light-day');
  // Stopped on the way: the plant is as it was.
  await page.selectOption('[data-light=rays]', 'fine');
  await page.click('#b-light-stop');
  await page.locator('#b-light-why', { hasText: 'Stopped' }).waitFor();
  await page.click('#b-lightview-close');
  await page.locator('#b-light-legend').waitFor({ state: 'detached' });
}

/** On a phone, in Chinese: settings, legend and view do not lie over each other. */
async function lightOnPhone({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'flower');
  await page.click('[data-flower=tulip]');
  await settled(page);
  await page.click('#b-language');
  await lit(page, () => palette(page, 'light'));
  await rested(page);
  await shot('light-phone');
  const [panel, legend] = await Promise.all(
    ['#b-lightview', '#b-light-legend'].map((q) => page.locator(q).boundingBox()),
  );
  const apart =
    legend.y >= panel.y + panel.height - 1 ||
    panel.y >= legend.y + legend.height - 1 ||
    legend.x >= panel.x + panel.width - 1;
  assert.ok(apart, JSON.stringify([panel, legend]));
}

export const programJourneys = [
  ['plants for a program', programs],
  ['light on the plants', light],
  ['light on a phone', lightOnPhone, { viewport: { width: 390, height: 844 }, hasTouch: true }],
];
