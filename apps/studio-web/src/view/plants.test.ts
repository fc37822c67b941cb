import { readFileSync } from 'node:fs';
import * as THREE from 'three';
import { afterEach, beforeAll, beforeEach, describe, expect, it, vi } from 'vitest';
import type { PartArrays, Sent } from '../worker/protocol';
import { initSync, studio_schema, StudioSession } from '../wasm/burgeon_wasm';
import type { DocumentState, ExportRequest, NewMaker, PlantView, SceneView } from '../wire';
import { Looks } from './plant';
import { Plants } from './plants';

const DRAWINGS = import.meta.glob('../../../../fixtures/sketches/gallery/*.svg', {
  query: '?raw',
  import: 'default',
  eager: true,
}) as Record<string, string>;
/** Years: young trees have nearly all parts of old ones, and are made sooner. */
const YOUNG = 3;
/** Trees with parts that only old ones have: dead wood, and twigs of a palm. */
const GROWN = ['cherry', 'dead-oak', 'palm'];

/** One file of all plants, as fine as they are shown. */
const WHOLE: ExportRequest = {
  format: 'stl',
  levels: 1,
  up: 'y',
  unit: 'm',
  whole: true,
  wind: false,
  one_file: false,
  sway: false,
  impostor: false,
  packed: false,
  instances: false,
  foliage: null,
  texture_size: null,
  triangles: null,
  megabytes: null,
  named: false,
  engine: null,
};
/** So long a test may take on a slow machine, ms. */
const PATIENCE_MS = 120_000;
/** Where a binary STL says how many triangles it has; bytes. */
const TRIANGLES_AT = 80;

interface Species {
  readonly trees: { key: string }[];
  readonly flowers: { key: string }[];
}
let species: Species;
let session: StudioSession;

beforeAll(() => {
  Object.assign(globalThis, { burgeonStop: () => false });
  initSync({ module: readFileSync(new URL('../wasm/burgeon_wasm_bg.wasm', import.meta.url)) });
  species = JSON.parse(studio_schema()) as Species;
});

function sentBy(view: PlantView): Sent {
  const columns = (_: unknown, i: number): PartArrays => ({
    positions: session.positions(view.id, i),
    normals: session.normals(view.id, i),
    uvs: session.uvs(view.id, i),
    colors: session.colors(view.id, i),
    indices: session.indices(view.id, i),
  });
  return { view, parts: view.parts.map(columns), textures: [], obstacles: view.obstacles.map(() => null) };
}

/** Triangles of all meshes that the view shows. */
function drawn(view: SceneView): number {
  const plants = new Plants(new Looks(true), new THREE.Group());
  plants.update(view, view.plants.map(sentBy));
  const meshes = plants.all.flatMap(({ group }) => group.children as THREE.Mesh[]);
  return meshes.reduce((sum, { geometry }) => sum + (geometry.index?.count ?? 0) / 3, 0);
}

/** Triangles of the file that is written, by its header. */
function exported(): number {
  const { buffer, byteOffset } = session.export(JSON.stringify(WHOLE));
  return new DataView(buffer, byteOffset).getUint32(TRIANGLES_AT, true);
}

const stateNow = (): DocumentState => JSON.parse(session.state());

/** Adds a plant and says what it is called in the document. */
function add(maker: NewMaker): number {
  session.act(JSON.stringify({ add: { name: 'plant', maker } }));
  return stateNow().current!;
}

function expectAll(name: string): void {
  const shown = drawn(JSON.parse(session.evaluate()));
  expect(shown, name).toBeGreaterThan(0);
  expect(shown, name).toBe(exported());
}

vi.setConfig({ testTimeout: PATIENCE_MS });

describe('the view', () => {
  beforeEach(() => {
    session = new StudioSession();
  });
  afterEach(() => session.free());

  it('shows all that is exported of drawings', () => {
    expect(Object.keys(DRAWINGS).length).toBeGreaterThan(10);
    for (const [path, text] of Object.entries(DRAWINGS)) {
      session.open(path.split('/').at(-1)!, new TextEncoder().encode(text), 0, true);
      expectAll(path);
    }
  });

  it('shows all that is exported of flowers', () => {
    expect(species.flowers.length).toBeGreaterThan(10);
    for (const { key } of species.flowers) {
      session.close();
      add({ flower: key });
      expectAll(key);
    }
  });

  it('shows all that is exported of trees', () => {
    expect(species.trees.length).toBeGreaterThan(40);
    for (const { key } of species.trees) {
      session.close();
      const plant = add({ tree: key });
      // Pictures of bark take longer than all else.
      const { tree } = stateNow().plants[0]!;
      for (const command of [
        { 'set-skin': { ...tree!.skin, textures: false } },
        { 'set-field': ['/age', YOUNG] },
      ])
        session.run(JSON.stringify({ tree: [plant, command] }));
      const view: SceneView = JSON.parse(session.evaluate());
      // The life of some ends before: they are small as they are.
      if (view.plants[0]!.error?.code === 'age-beyond' || GROWN.includes(key)) session.undo();
      expectAll(key);
    }
  });

  it('shows all that is exported of a leaf and of a scene', () => {
    session.close();
    add('leaf');
    expectAll('leaf');
    for (const { key } of species.flowers.slice(0, 3)) add({ flower: key });
    expectAll('scene');
  });
});
