// node --test tests/node.mjs, with the tarball in BURGEON_TARBALL and the program in BURGEON: the package as it is
// installed, in Node. The same plants as the native program, to the bit.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import {
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  symlinkSync,
  writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';

const own = fileURLToPath(new URL('..', import.meta.url));
const root = join(own, '../..');
const { BURGEON_TARBALL: tarball, BURGEON: native } = process.env;
const away = mkdtempSync(join(tmpdir(), 'burgeon-npm-'));
after(() => rmSync(away, { recursive: true, force: true }));

/** A folder with the package installed; with three.js or without. */
function installed(name, three) {
  const folder = join(away, name);
  mkdirSync(folder);
  writeFileSync(join(folder, 'package.json'), '{"type":"module","private":true}');
  const npm = process.platform === 'win32' ? 'npm.cmd' : 'npm';
  const options = [
    '--offline',
    '--no-audit',
    '--no-fund',
    '--silent',
    '--omit=optional',
    '--legacy-peer-deps',
  ];
  execFileSync(npm, ['install', ...options, tarball], { cwd: folder });
  if (three) symlinkSync(join(own, 'node_modules/three'), join(folder, 'node_modules/three'), 'junction');
  return folder;
}

const withThree = installed('three', true);
const file = (path) => pathToFileURL(join(withThree, 'node_modules/burgeon/dist', path)).href;
const burgeon = await import(file('node.js'));
const { bloom, BurgeonError, FLOWERS, grow, leaf, PARTS, schema, sketch, TREES } = burgeon;
const expected = JSON.parse(readFileSync(join(root, 'fixtures/digests.json'), 'utf8'));

test('trees of all species are those of the native program, wind or none', async () => {
  const trees = Object.entries(expected).filter(([name]) => name.startsWith('tree '));
  assert.ok(trees.length >= TREES.length - 3, `${trees.length} trees, ${TREES.length} species`);
  for (const [name, wanted] of trees) {
    const tree = await grow(name.slice(5), { seed: 1, detail: 0.1, textures: false, wind: false });
    const { vertices, triangles } = tree.report.counts;
    assert.equal(`${tree.digest} ${vertices} ${triangles}`, wanted, name);
  }
  const blown = await grow('birch', { seed: 1, detail: 0.1, textures: false });
  assert.ok(expected['tree birch'].startsWith(blown.digest));
});

test('the small core makes the same trees, and says what it does not make', async () => {
  const small = await import(file('growth/node.js'));
  const tree = await small.grow('oak', { detail: 0.1, textures: false, wind: false });
  assert.ok(expected['tree oak'].startsWith(tree.digest));
  assert.equal(small.sketch, undefined);
  await assert.rejects(small.schema('leaf'), /tree, skin/);
});

test('all drawings and leaves are those of the native program', async () => {
  const folder = join(root, 'fixtures/sketches');
  const drawings = readdirSync(folder, { recursive: true }).filter((path) => path.endsWith('.svg'));
  const file = new Map(drawings.map((path) => [basename(path, '.svg'), join(folder, path)]));
  let compared = 0;
  for (const [name, wanted] of Object.entries(expected)) {
    const marks = join(root, 'fixtures/leaves', name);
    if (name.startsWith('drawing ')) {
      const word = name.slice(8);
      const plant = await sketch(readFileSync(file.get(word)), { name: `${word}.svg`, seed: 1 });
      assert.equal(plant.digest, wanted, name);
    } else if (/^leaf\d\.csv$/.test(name)) {
      const made = await leaf(readFileSync(marks, 'utf8'), { name: name.slice(0, -4), wind: false });
      assert.equal(made.digest, wanted, name);
    } else continue;
    compared += 1;
  }
  assert.ok(compared >= 28, `${compared} compared`);
});

test('a leaf of a vein graph is that of the native program', async () => {
  // The graph of `xtask/src/native.rs`: a midrib, and six veins of five pairs.
  const nodes = Array.from({ length: 41 }, (_, i) => [200, 500 - 10 * i, 8 - 0.15 * i]);
  const edges = Array.from({ length: 40 }, (_, i) => [i, i + 1]);
  for (const i of [4, 11, 18, 25, 32]) {
    for (const side of [-1, 1]) {
      const [x, y] = nodes[i];
      for (let k = 1; k <= 6; k += 1) {
        nodes.push([x + side * 16 * k, y - 9 * k, 3 - 0.3 * k]);
        edges.push([k === 1 ? i : nodes.length - 2, nodes.length - 1]);
      }
    }
  }
  const graph = JSON.stringify({ unit: 'pixel', nodes_xyr: nodes, edges });
  const made = await leaf(graph, { name: 'veins', wind: false });
  assert.equal(made.digest, expected['veins.json']);
});

test('all flowers, and leaves of chief veins, are those of the native program', {
  skip: native ? false : 'BURGEON names no program',
}, async () => {
  const report = join(away, 'report.json');
  const told = () => JSON.parse(readFileSync(report, 'utf8')).items[0].digest;
  for (const species of FLOWERS) {
    const args = ['bloom', 'run', species, '--day', '3', '--quiet', '--report', report];
    execFileSync(native, [...args, '-o', join(away, 'flower.glb')]);
    const flower = await bloom(species, { day: 3, wind: false });
    assert.equal(flower.digest, told(), species);
    assert.equal(flower.view.days.length, 2);
  }
  assert.ok(FLOWERS.length > 10);
  for (const venation of ['palmate', 'parallel']) {
    const marks = join(away, `${venation}.csv`);
    execFileSync(native, ['leaf', '--venation', venation, '--marks', marks, '--quiet']);
    const made = await leaf(readFileSync(marks, 'utf8'), { name: venation, wind: false });
    assert.equal(made.digest, expected[`${venation}.csv`], venation);
  }
});

test('columns, tables and files fit together', async () => {
  const tree = await grow('hazel', {
    seed: 5,
    detail: 0.3,
    lods: 2,
    files: ['glb', 'mtg', 'opf'],
    measures: true,
  });
  assert.equal(tree.levels, 3);
  for (const level of [0, 1, 2]) {
    for (const mesh of tree.meshes(level)) {
      const n = mesh.positions.length / 3;
      assert.deepEqual(
        [mesh.normals, mesh.uvs, mesh.wind, mesh.pivots].map((c) => c.length / n),
        [3, 2, 4, 3],
        mesh.name,
      );
      assert.ok(mesh.indices.every((i) => i < n));
      const told = mesh.pieces.reduce((sum, x, k) => sum + (k % 3 === 2 ? x : 0), 0);
      assert.equal(told, mesh.indices.length / 3);
    }
  }
  const count = (level) => tree.meshes(level).reduce((sum, m) => sum + m.indices.length / 3, 0);
  assert.equal(count(0), tree.report.counts.triangles);
  assert.ok(count(1) < 0.7 * count(0) && count(2) < 0.7 * count(1), [0, 1, 2].map(count).join());
  const { nodes, axes, organs } = tree.tables;
  assert.equal(nodes.position.length, 3 * nodes.radius.length);
  assert.equal(axes.end.at(-1), nodes.radius.length);
  assert.equal(tree.organs().length, 16 * organs.part.length);
  const leaves = organs.part.filter((p) => PARTS[p] === 'leaf').length;
  assert.equal(leaves, tree.report.counts.leaves);
  assert.equal(new TextDecoder().decode(tree.files.glb.subarray(0, 4)), 'glTF');
  assert.match(new TextDecoder().decode(tree.files.mtg), /^CODE:/m);
  const leafNodes = new TextDecoder().decode(tree.files.opf).match(/class="Leaf"/g);
  assert.equal(leafNodes.length, tree.report.counts.leaves);
  assert.ok(tree.measures.leaf_area_m2 > 0 && tree.bounds.max[1] > 1);
  assert.ok(tree.textures.every((t) => t.pixels.length === 4 * t.width * t.height));
});

test('a budget is kept, and an impossible one names the least', async () => {
  const asked = { seed: 3, detail: 0.2, wind: false, files: ['glb'], fields: { age: 4 } };
  const own = ['grow', 'hazel', '--seed', '3', '--detail', '0.2', '--age', '4', '--quiet', '-o'];
  const theirs = (name, ...more) => {
    const path = join(away, name);
    execFileSync(native, [...own, path, ...more]);
    return readFileSync(path);
  };
  const whole = await grow('hazel', asked);
  const light = await grow('hazel', { ...asked, megabytes: 0.5 });
  assert.ok(light.files.glb.length <= 500_000 && whole.files.glb.length > 500_000);
  assert.ok(theirs('light.glb', '--megabytes', '0.5').equals(light.files.glb));
  assert.match(light.report.warnings.join(), /to keep within the budget/);
  const few = await grow('hazel', { ...asked, wind: true, triangles: 4000, lods: 1, engine: 'unity' });
  const counts = [0, 1].map((level) => few.meshes(level).reduce((sum, m) => sum + m.indices.length / 3, 0));
  assert.ok(counts[0] <= 4000 && counts[1] < counts[0] && few.levels === 2, counts.join());
  assert.equal(few.report.counts.triangles, counts[0]);
  assert.ok(theirs('few.glb', '--triangles', '4000', '--lods', '1', '--for', 'unity').equals(few.files.glb));
  await assert.rejects(grow('hazel', { ...asked, triangles: 100 }), /at least \d+ triangles/);
  await assert.rejects(grow('hazel', { ...asked, megabytes: 0.001 }), /at least 0\.\d+ megabytes/);
  await assert.rejects(grow('hazel', { megabytes: 1 }), /megabytes is of a file glb/);
  await assert.rejects(grow('hazel', { triangles: 99 }), /triangles must be a whole number, 100 to/);
});

test('a file for a program arrives with those beside it', async () => {
  const asked = { seed: 3, detail: 0.2, files: ['glb'], fields: { age: 3 } };
  const three = await grow('hazel', { ...asked, engine: 'three' });
  assert.deepEqual(Object.keys(three.files), ['glb', 'lod1.glb', 'lod2.glb']);
  assert.ok(Object.values(three.files).every((file) => file.length > 1000));
  const unreal = await grow('hazel', { ...asked, engine: 'unreal' });
  assert.deepEqual(Object.keys(unreal.files), ['glb', 'pivots.exr', 'axes.png']);
});

test('a tree grows to a height or a diameter as by the command', async () => {
  const asked = { seed: 3, detail: 0.2, wind: false, measures: true };
  for (const [name, value] of [
    ['height', 2.5],
    ['dbh', 0.05],
  ]) {
    const mine = await grow('hazel', { ...asked, [name]: value });
    const words = ['grow', 'hazel', '--seed', '3', '--detail', '0.2', `--${name}`, String(value), '--json'];
    const theirs = JSON.parse(execFileSync(native, words, { encoding: 'utf8' }));
    assert.equal(mine.digest, theirs.items[0].digest, name);
  }
  await assert.rejects(grow('hazel', { height: 60 }), /60 m is out of reach/);
  await assert.rejects(grow('hazel', { height: 2, dbh: 0.1 }), /height and dbh exclude each other/);
  await assert.rejects(grow('hazel', { dbh: 0.1, fields: { age: 3 } }), /dbh and age exclude each other/);
});

test('a large tree is shown coarse first, and is the same afterwards', async () => {
  const usual = await grow('oak', { seed: 2, detail: 0.2, lods: 1 });
  const seen = [];
  const tree = await grow('oak', { seed: 2, detail: 0.2, lods: 1, first: (coarse) => seen.push(coarse) });
  const count = (plant) => plant.meshes().reduce((sum, m) => sum + m.indices.length / 3, 0);
  assert.equal(seen.length, 1);
  assert.ok(
    count(seen[0]) > 1000 && 2 * count(seen[0]) < count(usual),
    `${count(seen[0])} of ${count(usual)}`,
  );
  assert.equal(seen[0].report.counts.triangles, count(seen[0]));
  assert.equal(seen[0].textures.length, 0);
  const [low, high] = [usual, seen[0]].map((plant) => plant.bounds.max[1]);
  assert.ok(Math.abs(low - high) < 0.05 * low, `${low} m, ${high} m`);
  const plain = ({ report, ...view }) => ({ ...view, report: { ...report, timings_ms: 0 } });
  assert.deepEqual(plain(tree.view), plain(usual.view));
  for (const level of [0, 1]) assert.deepEqual(tree.meshes(level), usual.meshes(level));
  assert.deepEqual(tree.textures, usual.textures);
  await grow('hazel', { detail: 0.1, fields: { age: 2 }, first: () => assert.fail('it is small') });
  const broken = () => {
    throw new Error('the scene is gone');
  };
  await assert.rejects(grow('oak', { detail: 0.1, textures: false, first: broken }), /the scene is gone/);
});

test('strokes as points make a plant', async () => {
  const stem = Array.from({ length: 40 }, (_, i) => [0.2 * Math.sin(i / 9), i]);
  const up = await sketch([stem], { seed: 1 });
  const down = await sketch([Float64Array.from(stem.flatMap(([x, y]) => [x, -y]))], { yUp: false });
  assert.ok(up.report.counts.triangles > 100);
  assert.equal(up.digest, down.digest);
});

test('what is wrong is named: field, value and range', async () => {
  const wrong = async (promise, expected) => {
    const error = await promise.then(
      () => assert.fail('made'),
      (e) => e,
    );
    assert.ok(error instanceof BurgeonError, String(error));
    const { code, field, value, range } = error;
    assert.deepEqual(
      { code, field, value, range: range?.slice(0, 20) },
      { value: undefined, range: undefined, ...expected },
    );
    assert.ok(error.message.length > 10);
  };
  const trees = TREES.join(', ').slice(0, 20);
  await wrong(grow('oka'), { code: 'spec-choice', field: 'preset', value: 'oka', range: trees });
  await wrong(grow('oak', { sed: 3 }), { code: 'spec-unknown', field: 'sed', range: 'seed, wind, lods, en' });
  await wrong(bloom('rose', { detail: 1 }), {
    code: 'spec-unknown',
    field: 'detail',
    range: 'seed, wind, lods, en',
  });
  await wrong(grow('oak', { fields: { agee: 3 } }), { code: 'spec-unknown', field: 'agee' });
  await wrong(grow('oak', { fields: { leaves: { leaf_kept: 1 } } }), {
    code: 'spec-unknown',
    field: 'leaves.leaf_kept',
  });
  await assert.rejects(grow('oak', { fields: { agee: 3 } }), /; is `age` meant\?$/);
  await assert.rejects(grow('oka'), /; is `oak` meant\?$/);
  await wrong(grow('oak', { detail: 99 }), {
    code: 'field-range',
    field: 'detail',
    value: '99',
    range: '0.1 to 8',
  });
  await wrong(grow('oak', { fields: { age: 'old' } }), {
    code: 'spec-kind',
    field: 'age',
    value: 'old',
    range: 'a whole number',
  });
  await wrong(grow('oak', { fields: { age: Number.NaN } }), {
    code: 'field-range',
    field: 'age',
    value: 'NaN',
    range: 'a finite number',
  });
  await wrong(grow('oak', { seed: -1 }), {
    code: 'field-range',
    field: 'seed',
    value: '-1',
    range: 'a whole number, 0 to',
  });
  await wrong(grow('oak', { seed: 1.5 }), {
    code: 'field-range',
    field: 'seed',
    value: '1.5',
    range: 'a whole number, 0 to',
  });
  await wrong(grow('oak', { lods: 7 }), {
    code: 'field-range',
    field: 'lods',
    value: '7',
    range: 'a whole number, 0 to',
  });
  await wrong(grow('oak', { budget: 9 }), {
    code: 'field-range',
    field: 'budget',
    value: '9',
    range: '1 to 4',
  });
  await wrong(grow({ toml: 'name = ' }), { code: 'spec-syntax', field: undefined });
  await wrong(
    sketch([
      [
        [0, 0],
        [1, Number.NaN],
      ],
    ]),
    { code: 'field-range', field: 'strokes[0][1]', value: 'NaN', range: 'a finite number' },
  );
  await wrong(sketch([Float64Array.of(1, 2, 3)]), {
    code: 'field-range',
    field: 'strokes[0]',
    value: '"3 numbers"',
    range: 'pairs of x and y',
  });
  await wrong(sketch([]), { code: 'no-strokes', field: undefined });
  await wrong(sketch('<svg', { name: 'x.svg' }), { code: 'file-line', field: undefined });
  await wrong(bloom('tulp'), {
    code: 'spec-choice',
    field: 'preset',
    value: 'tulp',
    range: FLOWERS.join(', ').slice(0, 20),
  });
  // What is too much is said before it is made, and the core goes on.
  const much = await grow('oak', { detail: 8, fields: { age: 40 } }).then(
    () => 'made',
    (e) => e.code,
  );
  assert.ok(['over-budget', 'made', 'field-range'].includes(much), much);
  assert.ok((await grow('grass', { detail: 0.2 })).digest);
  await assert.rejects(grow('oak', { signal: AbortSignal.abort() }), { name: 'AbortError' });
});

test('an error inside another has its own code, from the worker and from this thread', async () => {
  const here = await import(file('in-thread.js'));
  for (const [where, make] of [
    ['worker', burgeon],
    ['thread', here],
  ]) {
    const error = await make.sketch('<svg><path></svg>', { name: 'x.svg' }).catch((e) => e);
    assert.equal(error.code, 'file-line', where);
    const [[field, cause], ...others] = Object.entries(error.causes);
    assert.ok(cause instanceof BurgeonError && others.length === 0, where);
    assert.ok(
      cause.code !== error.code && error.message.includes(cause.message),
      `${where}: ${cause.message}`,
    );
    assert.equal(error.fields[field], cause.message, where);
  }
  const plain = await grow('oka').catch((e) => e);
  assert.deepEqual(plain.causes, {});
});

test('whatever is passed makes a plant or is named', async () => {
  // Numbers that follow from a seed, so that what fails can be done again.
  let state = 20;
  const below = (n) => {
    state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
    return Math.floor((state / 2 ** 32) * n);
  };
  const one = (list) => list[below(list.length)];
  const ODD = [
    ...[undefined, null, true, 0, -1, 1, 0.5, 3, 1e9, -0, Number.NaN, Infinity, 2 ** 53, 7n, 2n ** 70n],
    ...['', 'oak', 'ünïcode\0', 'a'.repeat(5000), Symbol.iterator, new Date(0), () => 1, new Map(), /x/],
    ...[
      new Uint8Array(0),
      new Uint8Array([0x50, 0x4b, 3, 4]),
      new Float32Array([1, Number.NaN]),
      new ArrayBuffer(8),
    ],
  ];
  const odd = (depth = 2) => {
    if (depth === 0 || below(3) > 0) return one(ODD);
    const some = Array.from({ length: below(4) }, () => odd(depth - 1));
    return below(2) ? some : Object.fromEntries(some.map((x, i) => [one(NAMES) ?? String(i), x]));
  };
  const NAMES = [
    ...[
      'age',
      'leaves',
      'method',
      'roots',
      'envelope',
      'kind',
      'form',
      'lobes',
      'detail',
      'day',
      'seed',
      'fields',
    ],
    ...['wind', 'lods', 'files', 'measures', 'budget', 'name', 'toml', '__proto__', 'constructor', 'points'],
  ];
  const fields = (base) => {
    const some = Array.from({ length: below(3) }, () => [one(NAMES), odd()]);
    return { ...base, ...Object.fromEntries(some) };
  };
  const calls = [
    () => grow('hazel', { detail: 0.1, textures: false, fields: fields({ age: 2 }) }),
    () => grow(one(['hazel', null, odd()]), fields({ detail: 0.1, textures: false, fields: { age: 2 } })),
    () => sketch(odd(3), fields({ textures: false })),
    () => leaf(odd(), fields({ fields: fields({}) })),
    () => bloom(one(['rose', odd()]), fields({ day: odd() })),
  ];
  let [made, refused] = [0, 0];
  for (let k = 0; k < 400; k += 1) {
    const from = state;
    try {
      const plant = await one(calls)();
      assert.ok(plant.report, `seed ${from}`);
      made += 1;
    } catch (error) {
      assert.ok(error instanceof BurgeonError, `seed ${from}: ${error?.stack ?? String(error)}`);
      assert.ok(error.message.length > 5, `seed ${from}`);
      refused += 1;
    }
  }
  assert.ok(made > 5 && refused > 100, `${made} made, ${refused} refused`);
  // The core is whole nevertheless.
  assert.ok((await grow('hazel', { detail: 0.1, textures: false, fields: { age: 2 } })).report);
});

test('a plant is made beside the program: timers go on, and a signal stops it', async () => {
  let ticks = 0;
  const timer = setInterval(() => (ticks += 1), 5);
  const started = performance.now();
  const tree = await grow('oak', { seed: 2, detail: 1 });
  const took = performance.now() - started;
  clearInterval(timer);
  assert.ok(tree.report && ticks > Math.max(2, took / 100), `${ticks} ticks in ${took} ms`);
  // One that takes much longer than it is given; the one that waits goes to another thread.
  const long = { seed: 2, detail: 8, fields: { age: 40 } };
  const stopped = new AbortController();
  const first = grow('oak', { ...long, signal: stopped.signal });
  const second = grow('hazel', { detail: 0.1, textures: false, wind: false });
  setTimeout(() => stopped.abort(), 50);
  const from = performance.now();
  await assert.rejects(first, { name: 'AbortError' });
  assert.ok(performance.now() - from < 1000, 'it was waited for');
  assert.ok(expected['tree hazel'].startsWith((await second).digest));
});

test('a program that is one line of a command line has its plants, too', () => {
  const line = `const { grow } = await import('burgeon'); const tree = await grow('hazel', { seed: 1, detail: 0.1 });
    console.log(tree.report.counts.triangles); process.exit(0);`;
  const options = { cwd: withThree, encoding: 'utf8' };
  const said = execFileSync(process.execPath, ['--input-type=module', '-e', line], options);
  assert.ok(Number(said) > 100, said);
});

test('in this thread it makes the same plants', async () => {
  for (const place of ['in-thread.js', 'growth/in-thread.js']) {
    const here = await import(file(place));
    let ticks = 0;
    await here.grow('grass', { detail: 0.1, textures: false });
    const timer = setInterval(() => (ticks += 1), 1);
    const tree = await here.grow('oak', { detail: 0.1, textures: false, wind: false });
    assert.equal(ticks, 0, 'in another thread');
    clearInterval(timer);
    assert.ok(expected['tree oak'].startsWith(tree.digest));
    if (place.startsWith('growth'))
      await assert.rejects(here.grow('oak', { triangles: 900 }), /not by `burgeon\/growth`/);
  }
});

test('no option is ignored: it changes what comes out, or is refused by its name', async () => {
  const stem = Array.from({ length: 40 }, (_, i) => [0.2 * Math.sin(i / 9), i]);
  const file = new TextEncoder().encode(
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 40"><path d="M4 39C5 20 3 12 4 1" stroke="#000"/></svg>',
  );
  const common = { wind: false, lods: 1, files: ['glb'], measures: true };
  const skin = { detail: 0.3, sides: 9, textures: false, texture_size: 64 };
  const uses = [
    [(o) => grow('hazel', { fields: { age: 3 }, ...o }), { ...common, ...skin, height_m: 1 }],
    [(o) => grow('hazel', { detail: 0.2, ...o }), { height: 2, dbh: 0.05, triangles: 9000, first: 'soon' }],
    [(o) => grow('hazel', { detail: 0.2, files: ['glb'], ...o }), { megabytes: 0.5 }],
    [(o) => grow('hazel', { fields: { age: 3 }, textures: false, ...o }), { texture_size: 64 }],
    [(o) => sketch([stem], o), { ...common, detail: 0.3, name: 'mine', yUp: false }],
    [(o) => sketch(file, o), { ...common, detail: 0.3, name: 'mine', yUp: true, classes: { 0: 'blade' } }],
    [(o) => leaf('', o), { ...common, name: 'mine' }],
    [(o) => bloom('lily', o), { ...common, day: 1 }],
  ];
  const look = (plant) =>
    JSON.stringify([
      plant.name,
      plant.digest,
      { ...plant.report, timings_ms: 0 },
      plant.levels,
      plant.textures.map((t) => [t.width, t.height]),
      Object.keys(plant.files),
      plant.measures,
      plant.meshes().map((m) => [m.name, m.wind.length, m.positions.length, m.material.texture]),
    ]);
  for (const [make, options] of uses) {
    const usual = look(await make({}));
    for (const [name, value] of Object.entries(options))
      await make({ [name]: value }).then(
        (plant) => assert.notEqual(look(plant), usual, name),
        (e) => assert.match(e.message, new RegExp(`\\b${name}\\b`)),
      );
  }
  await assert.rejects(grow('oak', { fields: { age: 5000 } }), /age must be 1 to 40, not 5000/);
  await assert.rejects(sketch(Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a)), /a picture \(PNG\)/);
});

test('schemas say what there is', async () => {
  const tree = await schema('tree');
  assert.equal(tree.properties.age.description.length > 5, true);
  await assert.rejects(schema('pot'), BurgeonError);
});

test('objects of three.js: levels, leaves as instances, copies', async () => {
  const THREE = await import(pathToFileURL(join(withThree, 'node_modules/three/build/three.module.js')).href);
  const tree = await grow('birch', { seed: 3, detail: 0.3, lods: 2 });
  const lod = tree.object3D({ three: THREE });
  assert.ok(lod.isLOD && lod.levels.length === 3);
  const fine = lod.levels[0].object;
  const instances = fine.children.filter((m) => m.isInstancedMesh);
  assert.ok(instances.length > 0);
  // Every vertex of every leaf is where the columns have it.
  const drawn = new Map();
  for (const mesh of instances) {
    const { position, color, uv } = mesh.geometry.attributes;
    const [v, m, c] = [new THREE.Vector3(), new THREE.Matrix4(), new THREE.Color()];
    for (let i = 0; i < mesh.count; i++) {
      mesh.getMatrixAt(i, m);
      mesh.getColorAt(i, c);
      for (let k = 0; k < position.count; k++) {
        v.fromBufferAttribute(position, k).applyMatrix4(m);
        const row = [
          v.x,
          v.y,
          v.z,
          c.r * color.getX(k),
          c.g * color.getY(k),
          c.b * color.getZ(k),
          uv.getX(k),
          uv.getY(k),
        ];
        drawn.set(mesh.name, [...(drawn.get(mesh.name) ?? []), ...row]);
      }
      if (i > 400) break;
    }
  }
  const leaves = tree.meshes().find((m) => m.name === 'leaves');
  const got = drawn.get('leaves');
  const all = new Map();
  for (let k = 0; k < leaves.uvs.length / 2; k++) {
    const at = [0, 1, 2].map((i) => leaves.positions[3 * k + i]);
    const key = at.map((x) => Math.round(x * 500)).join();
    const row = [
      ...at,
      ...[0, 1, 2].map((i) => leaves.colors[3 * k + i]),
      leaves.uvs[2 * k],
      leaves.uvs[2 * k + 1],
    ];
    all.set(key, [...(all.get(key) ?? []), row]);
  }
  for (let k = 0; k < got.length; k += 8) {
    const row = got.slice(k, k + 8);
    const near = [0, 1, 2].map((i) => [-1, 0, 1].map((d) => Math.round(row[i] * 500) + d));
    const there = near[0].flatMap((x) =>
      near[1].flatMap((y) => near[2].flatMap((z) => all.get(`${x},${y},${z}`) ?? [])),
    );
    const found = there.some((r) => r.every((x, i) => Math.abs(x - row[i]) < (i < 3 ? 1e-4 : 1e-3)));
    assert.ok(found, `vertex ${k / 8}: ${row}`);
  }
  const total = instances.reduce((sum, m) => sum + (m.count * m.geometry.index.count) / 3, 0);
  const rest = fine.children
    .filter((m) => !m.isInstancedMesh)
    .reduce((sum, m) => sum + m.geometry.index.count / 3, 0);
  assert.equal(total + rest, tree.report.counts.triangles);
  const bytes = (object) => {
    let sum = 0;
    object.traverse(({ geometry, instanceMatrix, instanceColor }) => {
      for (const a of [
        ...Object.values(geometry?.attributes ?? {}),
        geometry?.index,
        instanceMatrix,
        instanceColor,
      ])
        sum += a?.array.byteLength ?? 0;
    });
    return sum;
  };
  const plain = tree.object3D({ three: THREE, level: 0, instances: false });
  assert.ok(plain.isGroup && bytes(fine) < 0.6 * bytes(plain), `${bytes(fine)} of ${bytes(plain)}`);
  const stand = tree.stand(
    [
      { x: 0, z: 0 },
      { x: 5, z: 1, yaw: 90, scale: 2 },
    ],
    { three: THREE, level: 2 },
  );
  assert.ok(stand.children.length > 0 && stand.children.every((m) => m.isInstancedMesh && m.count === 2));
  assert.throws(() => tree.stand([{ x: Number.NaN, z: 0 }], { three: THREE }), { field: 'places[0].x' });
  assert.throws(() => tree.object3D({ three: THREE, level: 3 }), { field: 'level', range: '0 to 2' });
  assert.ok(tree.object3D().isLOD, 'found by itself');
  tree.dispose();
});

test('without three.js there are arrays, and a word on what to install', async () => {
  const folder = installed('bare', false);
  const script = join(folder, 'bare.js');
  writeFileSync(
    script,
    `import { grow } from 'burgeon'; import * as small from 'burgeon/growth';
     const tree = await grow('grass', { detail: 0.2 });
     let said = ''; try { tree.object3D(); } catch (e) { said = e.message; }
     const again = await small.grow('grass', { detail: 0.2 });
     console.log(JSON.stringify([tree.meshes()[0].positions.length > 0, said, again.digest === tree.digest]));`,
  );
  const said = JSON.parse(execFileSync(process.execPath, [script], { encoding: 'utf8' }));
  assert.deepEqual([said[0], said[2]], [true, true]);
  assert.match(said[1], /npm install three/);
});

test('the wind is the one that docs/exports.md gives to other programs', () => {
  const page = readFileSync(join(root, 'docs/exports.md'), 'utf8');
  const text = /```glsl\n([\s\S]*?)\/\/ in main/.exec(page)[1];
  assert.equal(burgeon.BLOW.trim(), text.trim());
});
