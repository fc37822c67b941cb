// A browser of the network: in by the code, and the project that was opened is written back to its file.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { add, changed, settled, until } from './journeys.mjs';
import { serveNetwork } from './server.mjs';
import { eventually, reloaded } from './waits.mjs';

const words = (page, text) => page.locator('footer, .status').filter({ hasText: text }).first().waitFor();

async function lan({ page, own, burgeon, folder, out, shot, troubles }) {
  const project = join(out, 'garden.burgeon');
  copyFileSync('../../fixtures/projects/version-4.burgeon', project);
  const { url, link, code, fingerprint } = await serveNetwork(burgeon, folder, project);
  own.push(url);
  // A link that a messenger looks at, too, asks for one press of a button; the certificate can be compared.
  await page.request.head(link);
  await page.goto(link);
  await page.locator('input[name=key]').waitFor({ state: 'attached' });
  await page.locator('code', { hasText: fingerprint }).waitFor();
  await shot('network-link');
  await page.goto(url);
  await page.fill('input[name=code]', '12345678');
  await page.click('button');
  await page.locator('[role=alert]', { hasText: 'not the code' }).waitFor();
  await shot('network-door');
  // Pages that say 401, which the console calls an error.
  troubles.length = 0;
  await page.fill('input[name=code]', code);
  await page.click('button');
  await page.waitForFunction(() => document.body.dataset.ready === 'true');
  await until(page, 'plants', ['is', 4], 'the project is open');
  const before = readFileSync(project);
  const digest = await settled(page);
  await words(page, 'Written to garden.burgeon');
  await page.waitForTimeout(2000);
  assert.ok(readFileSync(project).equals(before), 'what nobody changed is not written');
  await add(page, 'tree', 'hazel');
  await until(page, 'plants', ['is', 5], 'a tree more');
  await changed(page, digest, 'a hazel');
  await eventually(
    async () => readFileSync(project).equals(before),
    (same) => !same,
    'the file is as it was',
  );
  await words(page, 'Written to garden.burgeon');
  await shot('network-written');
  execFileSync(burgeon, ['sketch', '-q', project, '--report', join(out, 'garden.json')]);
  const report = JSON.parse(readFileSync(join(out, 'garden.json'), 'utf8'));
  assert.equal(report.items.length, 4, 'three that are shown, and the hazel');
  // After a reload the page still knows its file.
  await reloaded(page);
  await until(page, 'plants', ['is', 5], 'kept in the browser');
  await settled(page);
  await words(page, 'Written to garden.burgeon');
  // Another program writes the file: that stays, and it is said.
  copyFileSync('../../fixtures/projects/version-4.burgeon', project);
  await page.click('#b-dice');
  await page.locator('.note.bad', { hasText: 'another program' }).waitFor();
  await shot('network-left');
  assert.ok(readFileSync(project).equals(before), 'the file of the desktop is as it wrote it');
  // Nor does a browser take a worker that stays from a server whose certificate it does not know.
  troubles.length = 0;
}

export const network = [
  ['network: a code, and a project that is written back', lan, { ignoreHTTPSErrors: true }],
];
