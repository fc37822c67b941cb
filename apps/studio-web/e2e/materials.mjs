// Materials of organs, the width of the pen, layers: from the pen to the exported file and back.
import assert from 'node:assert/strict';
import { Buffer } from 'node:buffer';
import {
  add,
  begin,
  blade,
  changed,
  count,
  data,
  draw,
  drawFlower,
  exported,
  line,
  settled,
  until,
} from './journeys.mjs';
import { becomes, reloaded, rested, saved } from './waits.mjs';

const wears = (page, name) =>
  page.waitForFunction((n) => (document.body.dataset.materials ?? '').split(' ').includes(n), name);
const sheds = (page, name) =>
  page.waitForFunction((n) => !(document.body.dataset.materials ?? '').split(' ').includes(n), name);

/** The JSON of a GLB, read without our own code. */
function gltfOf({ bytes }) {
  const length = bytes.readUInt32LE(12);
  assert.equal(bytes.readUInt32LE(16), 0x4e4f534a, 'the first chunk is JSON');
  return JSON.parse(bytes.subarray(20, 20 + length).toString());
}

/** A PNG of 2 by 2 pixels, red. */
const RED = Buffer.from(
  'iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAE0lEQVR4nGO4oGAARAxA/OtOFAAkLgWRsd1VVgAAAABJRU5ErkJggg==',
  'base64',
);

async function materials({ page, url, shot }) {
  await begin(page, url);
  await drawFlower(page);
  const plain = await settled(page);
  // All petals from the library.
  await page.keyboard.press('Shift+M');
  await page.selectOption('#b-material-of', 'petal');
  await page.click('[data-material=picotee]');
  await wears(page, 'petal-picotee-1');
  await page.locator('[data-material=picotee][aria-pressed=true]').waitFor();
  assert.equal(await settled(page), plain, 'the plant is the same');
  // Its second colour, by the form.
  await page.locator('.materials [data-path="/second"]').evaluate((field) => {
    field.value = '#2040d0';
    field.dispatchEvent(new Event('input', { bubbles: true }));
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await page.locator('[data-material=picotee][aria-pressed=false]').waitFor();
  await settled(page);
  await rested(page);
  await shot('materials');
  // All leaves.
  await page.selectOption('#b-material-of', 'leaf');
  await page.click('[data-material=hosta]');
  await wears(page, 'leaf-variegated-1');
  await page.keyboard.press('Escape');
  // One petal wears a picture.
  await page.keyboard.press('v');
  const box = await page.locator('.sheet').boundingBox();
  const petal = blade(250, 210, -Math.PI / 2, 95, 28);
  await page.mouse.click(box.x + petal[3][0], box.y + petal[3][1]);
  await page.locator('.card .chip', { hasText: 'Materials' }).click();
  await becomes(() => page.inputValue('#b-material-of'), 'strokes', 'what wears it');
  const chooser = page.waitForEvent('filechooser');
  await page.click('#b-material-picture');
  await (await chooser).setFiles({ name: 'red.png', mimeType: 'image/png', buffer: RED });
  await wears(page, 'petal-picture-3');
  await page.keyboard.press('Escape');
  await settled(page);
  await shot('materials-picture');
  // The file has them, as a reader that is not ours sees it.
  const gltf = gltfOf(await exported(page, 'glb'));
  const names = gltf.materials.map((m) => m.name);
  for (const name of ['petal-picotee-2', 'leaf-variegated-1', 'petal-picture-3']) {
    const material = gltf.materials.find((m) => m.name === name);
    assert.ok(material, `${name} of ${names}`);
    assert.ok(material.pbrMetallicRoughness.baseColorTexture, `${name} has a texture`);
  }
  const hosta = gltf.materials.find((m) => m.name === 'leaf-variegated-1');
  assert.ok(Math.abs(hosta.pbrMetallicRoughness.roughnessFactor - 0.6) < 1e-6);
  // It is kept, and taken back step by step.
  await saved(page);
  await reloaded(page);
  await wears(page, 'petal-picture-3');
  assert.equal(await settled(page), plain);
  for (const gone of ['petal-picture-3', 'leaf-variegated-1']) {
    await page.keyboard.press('Control+z');
    await sheds(page, gone);
  }
}

/** Opens the materials by their name and gives one to all organs of a kind. */
async function clothe(page, organ, material) {
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').fill('materials');
  await page.keyboard.press('Enter');
  await page.selectOption('#b-material-of', organ);
  await page.click(`[data-material=${material}]`);
}

async function flowers({ page, url, shot }) {
  await begin(page, url);
  await page.click('#b-add');
  await page.click('[data-add=flower]');
  await until(page, 'plants', ['is', 1], 'a flower in place of the empty sheet');
  await settled(page);
  await clothe(page, 'petal', 'tiger-lily');
  await wears(page, 'petal-speckled-1');
  await settled(page);
  await shot('materials-flower');
  await page.click('#b-material-none');
  await sheds(page, 'petal-speckled-1');
}

/** The leaves of a species in a colour of the library, and in the file. */
async function tree({ page, url, shot }) {
  await begin(page, url);
  await add(page, 'tree', 'hazel');
  const plain = await settled(page);
  await clothe(page, 'leaf', 'hosta');
  await wears(page, 'leaf-variegated-1');
  assert.equal(await settled(page), plain, 'the tree is the same');
  await page.keyboard.press('Escape');
  await shot('materials-tree');
  const { materials, textures, images } = gltfOf(await exported(page, 'glb'));
  const leaf = materials.find((m) => m.name === 'leaf-variegated-1');
  assert.ok(images[textures[leaf.pbrMetallicRoughness.baseColorTexture.index].source], 'with its picture');
  await page.keyboard.press('Control+z');
  await sheds(page, 'leaf-variegated-1');
}

async function pen({ page, url, shot }) {
  await begin(page, url);
  await page.click('#b-pen');
  await page.locator('#b-pen-width').fill('12');
  await page.locator('#b-pen-colour').evaluate((field) => {
    field.value = '#b02060';
    field.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await page.keyboard.press('Escape');
  await draw(page, line(250, 540, 250, 245, 8));
  await until(page, 'strokes', ['is', 1], 'a wide stroke');
  await settled(page);
  await shot('pen-wide');
  const svg = (await exported(page, 'svg')).bytes.toString();
  assert.match(svg, /stroke="#b02060"/);
  assert.match(svg, /stroke-width:12/);
  // The width is no matter for the plant.
  const wide = await settled(page);
  await page.keyboard.press('v');
  const box = await page.locator('.sheet').boundingBox();
  await page.mouse.click(box.x + 254, box.y + 400);
  await page.click('#b-pen');
  await page.locator('#b-pen-width').fill('0');
  await page.locator('#b-undo[title*="width"]').waitFor();
  assert.equal(await settled(page), wide);
  await page.keyboard.press('Escape');
  await page.locator('.sheet').focus();
  await page.keyboard.press('Control+z');
  await page.locator('#b-undo[title*="draw"]').waitFor();
}

async function layers({ page, url, shot }) {
  await begin(page, url);
  const strokes = await drawFlower(page);
  const plain = await settled(page);
  const petals = await count(page, 'flowers');
  const named = async (name) => {
    await page.locator('dialog .field').fill(name);
    await page.locator('dialog [type=submit]').click();
  };
  await page.keyboard.press('Shift+L');
  await page.click('#b-layer-add');
  await named('leaves');
  await page.waitForFunction(() => document.body.dataset.layers === 'leaves');
  // A new stroke goes there.
  await page.keyboard.press('Escape');
  await page.keyboard.press('p');
  await draw(page, blade(252, 310, 0.3, 90, 18));
  await until(page, 'strokes', ['is', strokes + 1], 'a leaf on its layer');
  const more = await changed(page, plain, 'with one leaf more');
  // Hidden, it is no part of the plant; locked, it stays as it is.
  await page.keyboard.press('Shift+L');
  await shot('layers');
  await page.click('.layers [data-key="eye leaves"]');
  await page.waitForFunction(() => document.body.dataset.layers === 'leaves hidden');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await becomes(() => count(page, 'flowers'), petals, 'the flowers');
  await shot('layers-hidden');
  await page.click('.layers [data-key="eye leaves"]');
  await page.waitForFunction((d) => document.body.dataset.digest === d, more);
  await page.click('.layers [data-key="lock leaves"]');
  await page.waitForFunction(() => document.body.dataset.layers === 'leaves locked');
  await page.keyboard.press('Escape');
  await page.keyboard.press('e');
  await draw(page, line(310, 318, 312, 346));
  // What is erased next is all that was: the locked leaf was not.
  await draw(page, line(230, 520, 270, 515));
  await until(page, 'strokes', ['is', strokes], 'the stem is erased, the leaf is not');
  await page.keyboard.press('Control+z');
  await until(page, 'strokes', ['is', strokes + 1], 'the stem is back');
  await page.keyboard.press('Control+z');
  await page.waitForFunction(() => document.body.dataset.layers === 'leaves');
  // By the palette: the layer in use is hidden. Saved and opened again, and as SVG.
  await page.keyboard.press('Control+k');
  await page.locator('.palette input').fill('hide or show the layer');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => document.body.dataset.layers === 'leaves hidden');
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  const svg = (await exported(page, 'svg')).bytes.toString();
  assert.match(svg, /inkscape:groupmode="layer" inkscape:label="leaves" style="display:none"/);
  await saved(page);
  await reloaded(page);
  await page.waitForFunction((d) => document.body.dataset.digest === d, plain);
  await becomes(() => data(page, 'layers'), 'leaves hidden', 'what is said of the layers');
  await page.keyboard.press('Shift+L');
  await page.click('.layers [data-key="eye leaves"]');
  await page.waitForFunction((d) => document.body.dataset.digest === d, more);
}

export const materialJourneys = [
  ['materials of organs', materials],
  ['materials of a flower', flowers],
  ['materials of a tree', tree],
  ['the width of the pen', pen],
  ['layers of a drawing', layers],
];
