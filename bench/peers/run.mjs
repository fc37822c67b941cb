// Times other makers of trees beside ours, in one go, and prints a table: `node bench/peers/run.mjs [--bevy]`.
// They are installed outside the repository, from their registries, and removed at the end.

import { execFileSync, spawnSync } from 'node:child_process';
import { cpSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, loadavg, tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const repository = join(here, '../..');
const away = mkdtempSync(join(tmpdir(), 'burgeon-peers-'));
const rows = [];

/** Runs a peer; a row of the table, or the reason why there is none. */
function peer(name, work) {
  try {
    rows.push({ name, ...work() });
  } catch (e) {
    const why = String(e.stderr ?? e.message).trim().split('\n').filter(Boolean).pop() ?? 'no reason given';
    rows.push({ name, why: why.slice(0, 160) });
  }
}

const call = (program, args, folder, ms = 600_000) =>
  execFileSync(program, args, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'], timeout: ms });
const lastLine = text => JSON.parse(text.trim().split('\n').pop());

function ours(args) {
  const build = ['run', '--release', '--quiet', '-p', 'burgeon-bench', '--example', 'peer_oak', '--', ...args];
  return lastLine(call('cargo', build, repository, 3_600_000));
}

// The oak of our own benchmark, and one with about as many triangles as the most used web peer's.
peer('Burgeon, oak of the benchmark', () => ours(['full', '1']));
peer('Burgeon, the same on two threads', () => ours(['full', '2']));
peer('Burgeon, small oak', () => ours(['small', '1']));

peer('ez-tree (npm), Oak Large', () => {
  writeFileSync(join(away, 'package.json'), '{"type":"module"}');
  call('npm', ['install', '--no-audit', '--no-fund', '@dgreenheck/ez-tree', 'three'], away);
  cpSync(join(here, 'ez-tree.mjs'), join(away, 'ez-tree.mjs'));
  return lastLine(call('node', ['ez-tree.mjs'], away));
});

peer('pyhelios3d (PyPI), almond of one year', () => {
  call('python3', ['-m', 'venv', 'venv'], away);
  const bin = join(away, 'venv', process.platform === 'win32' ? 'Scripts' : 'bin');
  call(join(bin, 'python'), ['-m', 'pip', 'install', '--quiet', '--only-binary', ':all:', 'pyhelios3d'], away);
  return lastLine(call(join(bin, 'python'), [join(here, 'helios.py')], away));
});

if (process.argv.includes('--bevy')) {
  peer('bevy_procedural_tree (crates.io), default tree', () => {
    cpSync(join(here, 'bevy'), join(away, 'bevy'), { recursive: true });
    return lastLine(call('cargo', ['run', '--release', '--quiet'], join(away, 'bevy'), 3_600_000));
  });
} else {
  rows.push({ name: 'bevy_procedural_tree (crates.io)', why: 'only with --bevy: it builds the whole engine first' });
}

rmSync(away, { recursive: true, force: true });

const base = rows.find(r => r.triangles);
const perThousand = r => (1000 * r.best_ms) / r.triangles;
const load = loadavg()[0].toFixed(1);
console.log(`${cpus().length} processors (${cpus()[0]?.model.trim()}), load ${load}; least of the runs\n`);
console.log('| program | ms, best | ms, median | triangles | us a triangle | ratio to ours |\n|---|---|---|---|---|---|');
for (const r of rows) {
  if (r.why) {
    console.log(`| ${r.name} | – | – | – | – | not run: ${r.why.replaceAll('|', '/')} |`);
    continue;
  }
  const ratio = base ? (perThousand(r) / perThousand(base)).toFixed(2) : '–';
  const count = r.triangles.toLocaleString('en');
  const cells = [r.best_ms.toFixed(1), r.median_ms.toFixed(1), count, perThousand(r).toFixed(2), ratio];
  console.log(`| ${r.name} | ${cells.join(' | ')} |`);
}
console.log('\nRatios are times a triangle. See bench/peers/README.md for what is not comparable.');
process.exitCode = base ? 0 : 1;
