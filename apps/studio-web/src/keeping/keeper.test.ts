import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Keeper, type Standing } from './keeper';
import { corrected, type Entry, type Mine, type Written } from './library';
import type * as Library from './library';
import type { Request } from '../worker/protocol';

/** Stands for the storage: what it holds, and whether it takes anything. */
const disk = vi.hoisted(() => ({
  rows: new Map<number, unknown>(),
  whole: undefined as string | undefined,
  full: undefined as Error | undefined,
  appends: 0,
  /** Of the stroke under the pen: the row before it, and what is asked. */
  pen: undefined as [number, readonly unknown[]] | undefined,
}));

vi.mock('./library', async (original) => {
  const { corrected, TakenError } = await original<typeof Library>();
  const write = async (act: () => void): Promise<void> => {
    if (disk.full) throw disk.full;
    act();
  };
  return {
    corrected,
    TakenError,
    append: (_: Mine, rows: Written[]) => {
      disk.appends += 1;
      return write(() => {
        if (rows.some((row) => disk.rows.has(row.seq))) throw new TakenError();
        for (const { seq, request } of rows) disk.rows.set(seq, request);
      });
    },
    create: () => write(() => undefined),
    underPen: (_: Mine, after: number, requests: readonly unknown[]) =>
      write(() => {
        disk.pen = requests.length > 0 ? [after, requests] : undefined;
      }),
    writeWhole: (_: Entry, whole: Uint8Array, seq: number) =>
      write(() => {
        disk.whole = new TextDecoder().decode(whole);
        for (const key of disk.rows.keys()) if (key <= seq) disk.rows.delete(key);
      }),
  };
});

const STROKE = { kind: 'stroke', mode: 'parts', samples: new Float64Array(4) } as const;
const stroke = (): Request => ({ ...STROKE });
const undo = (): Request => ({ kind: 'undo' });
const kinds = (): string[] => {
  const written = [...disk.rows].map(([seq, request]) => ({ seq, request: request as Request }));
  return corrected(written).map((row) => row.request.kind);
};
const settle = async (): Promise<void> => {
  for (let i = 0; i < 20; i += 1) await Promise.resolve();
};

let standing: Standing = 'empty';
let lost = 0;
let saves = 0;

function keeper(): Keeper {
  const made = new Keeper('me', {
    standing: (now) => {
      standing = now;
    },
    created: () => undefined,
    taken: () => {
      lost += 1;
    },
    save: async () => {
      saves += 1;
      return new TextEncoder().encode(`whole ${saves}`);
    },
    name: () => 'plant',
  });
  made.open(undefined, []);
  return made;
}

beforeEach(() => {
  vi.stubGlobal('window', globalThis);
  vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout'] });
  Object.assign(disk, { rows: new Map(), whole: undefined, full: undefined, appends: 0, pen: undefined });
  [standing, lost, saves] = ['empty', 0, 0];
});

describe('what is asked', () => {
  it('is written at once, and called saved when it is', async () => {
    const k = keeper();
    expect(standing).toBe('empty');
    k.record({ kind: 'select', plant: 0 });
    expect(k.mine, 'looking is no document').toBeUndefined();
    k.record(stroke());
    expect(standing).toBe('saving');
    await settle();
    expect(standing).toBe('saved');
    expect(kinds()).toEqual(['stroke']);
  });

  it('is written in one go where it was asked in one go', async () => {
    const k = keeper();
    k.record({ kind: 'begin', name: 'draw' });
    for (const request of [stroke(), stroke(), { kind: 'commit' } as const]) k.record(request);
    await settle();
    expect(disk.appends).toBe(1);
    expect(kinds()).toEqual(['begin', 'stroke', 'stroke', 'commit']);
  });

  it('is held back while a gesture is open, of which the last place counts', async () => {
    const k = keeper();
    const stage = (): Request => ({ kind: 'stage', command: { scene: { rename: 'x' } } });
    k.record({ kind: 'begin', name: 'move' });
    for (let i = 0; i < 9; i += 1) k.record(stage());
    await settle();
    expect(kinds()).toEqual([]);
    k.record({ kind: 'abandon' });
    await settle();
    expect(kinds()).toEqual([]);
    for (const request of [{ kind: 'begin', name: 'move' } as const, stage(), stage()]) k.record(request);
    k.record({ kind: 'commit' });
    await settle();
    expect(kinds()).toEqual(['begin', 'stage', 'commit']);
  });

  it('is forgotten if it was refused, before it was written and after', async () => {
    const k = keeper();
    const [early, late] = [stroke(), stroke()];
    k.record(early);
    k.forget(early);
    k.record(late);
    await settle();
    k.forget(late);
    k.record(undo());
    await settle();
    expect(kinds()).toEqual(['undo']);
  });

  it('is written again where it bears more than before', async () => {
    const k = keeper();
    const open = { kind: 'action', action: 'new', x: 0, y: 0 } as unknown as Request & { placed?: number };
    k.record(open);
    k.record(undo());
    await settle();
    open.placed = 3;
    k.again(open);
    await settle();
    const written = [...disk.rows].map(([seq, request]) => ({ seq, request: request as Request }));
    expect(corrected(written).map((row) => row.seq)).toEqual([1, 2]);
    expect(corrected(written)[0]!.request).toEqual(open);
    expect(corrected(written.slice(1)), 'what is in the whole file is not asked again').toHaveLength(1);
  });
});

describe('the stroke under the pen', () => {
  const part = (length: number): Request => ({ ...STROKE, samples: new Float64Array(length) });

  it('is written at once, and then with its latest points now and then', async () => {
    const k = keeper();
    k.drawing(() => [part(12)]);
    expect(disk.pen).toEqual([0, [part(12)]]);
    for (const length of [16, 20]) k.drawing(() => [part(length)]);
    expect(disk.pen, 'not with each event').toEqual([0, [part(12)]]);
    await vi.advanceTimersByTimeAsync(50);
    expect(disk.pen).toEqual([0, [part(20)]]);
    expect(standing, 'nothing is kept yet').toBe('empty');
    k.record(part(24));
    await settle();
    k.drawing(() => [part(12)]);
    await vi.advanceTimersByTimeAsync(50);
    expect(disk.pen, 'behind the one before').toEqual([1, [part(12)]]);
  });

  it('is not written again when it has ended', async () => {
    const k = keeper();
    for (const length of [12, 16]) k.drawing(() => [part(length)]);
    k.record(part(20));
    await vi.advanceTimersByTimeAsync(200);
    await settle();
    expect(disk.pen).toEqual([0, [part(12)]]);
    expect(kinds()).toEqual(['stroke']);
  });

  it('is forgotten if it was none', async () => {
    const k = keeper();
    for (const length of [12, 16]) k.drawing(() => [part(length)]);
    k.undrawn();
    await vi.advanceTimersByTimeAsync(200);
    expect(disk.pen).toBeUndefined();
    expect(standing).toBe('empty');
    k.record(stroke());
    await settle();
    expect(standing).toBe('saved');
  });

  it('is not written into a document that another tab has', () => {
    const k = keeper();
    k.open('x', [], 'readonly');
    k.drawing(() => [part(12)]);
    expect(disk.pen).toBeUndefined();
  });
});

describe('a document', () => {
  it('is written whole when its journal is long, with what comes meanwhile behind it', async () => {
    const k = keeper();
    for (let i = 0; i < 501; i += 1) k.record(stroke());
    // The whole is on its way.
    await Promise.resolve();
    k.record(stroke());
    await settle();
    expect(disk.whole).toBe('whole 1');
    expect(kinds()).toEqual(['stroke']);
    expect(standing).toBe('saved');
  });

  it('is written whole again where a step is undone that its journal does not hold', async () => {
    const k = keeper();
    for (let i = 0; i < 501; i += 1) k.record(stroke());
    // The whole is on its way: it does not hold the steps either.
    await Promise.resolve();
    k.record(undo());
    expect(standing).toBe('saving');
    await settle();
    expect(disk.whole).toBe('whole 2');
    expect(kinds()).toEqual([]);
    expect(standing).toBe('saved');
  });

  it('is written whole after the step that made it necessary, not before it', async () => {
    // What the worker was asked, in its order.
    const asked: string[] = [];
    const kept = new Keeper('me', {
      standing: () => undefined,
      created: () => undefined,
      taken: () => undefined,
      save: async () => {
        asked.push('save');
        return new Uint8Array();
      },
      name: () => 'plant',
    });
    kept.open(undefined, []);
    const ask = (request: Request): void => {
      kept.record(request);
      asked.push(request.kind);
    };
    for (let i = 0; i <= 500; i += 1) ask(stroke());
    await settle();
    expect(asked.at(-1)).toBe('save');
    for (let i = 0; i < 3; i += 1) {
      ask(undo());
      await settle();
      expect(asked.slice(-2)).toEqual(['undo', 'save']);
    }
  });

  it('can be opened long, and is made short', async () => {
    const k = keeper();
    const rows = Array.from({ length: 300 }, (_, i) => ({ seq: i + 1, request: stroke() }));
    for (const { seq, request } of rows) disk.rows.set(seq, request);
    k.open('x', rows);
    await settle();
    expect([disk.whole, disk.rows.size]).toEqual(['whole 1', 0]);
    k.open('x', rows.slice(0, 9), 'readonly');
    k.forget(rows[0]!.request);
    expect(standing).toBe('readonly');
  });

  it('is said not to be saved as long as that is so, and then written whole', async () => {
    const k = keeper();
    k.record(stroke());
    await settle();
    disk.full = new DOMException('full', 'QuotaExceededError');
    k.record(stroke());
    await settle();
    expect(standing).toEqual({ failed: disk.full });
    k.record(stroke());
    await settle();
    disk.full = undefined;
    expect(saves, 'not with every stroke').toBe(0);
    await vi.advanceTimersByTimeAsync(6000);
    await settle();
    expect(standing).toBe('saved');
    expect([disk.whole, disk.rows.size]).toEqual(['whole 1', 0]);
  });

  it('that another tab took is left alone', async () => {
    const k = keeper();
    k.record(stroke());
    await settle();
    disk.rows.set(2, { kind: 'abandon' });
    k.record(stroke());
    await settle();
    expect(lost).toBe(1);
    await k.close('readonly');
    k.again(stroke());
    expect(kinds()).toEqual(['stroke', 'abandon']);
  });
});
