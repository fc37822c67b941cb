import { beforeEach, describe, expect, it, vi } from 'vitest';
import type { EngineEvents } from './engine';
import type { Request } from './protocol';
import { Session, type SessionEvents } from './session';
import type { DocumentState, SceneView } from '../wire';

/** Stands for the worker: keeps what it was asked, and says what a test lets it say. */
const worker = vi.hoisted(() => ({
  asked: [] as Request[],
  growing: false,
  refuses: false,
  /** What it answers. */
  value: {} as unknown,
  events: undefined as EngineEvents | undefined,
}));

vi.mock('./engine', () => ({
  Engine: class {
    constructor(events: EngineEvents) {
      worker.events = events;
    }
    get growing(): boolean {
      return worker.growing;
    }
    set growing(on: boolean) {
      worker.growing = on;
    }
    async ask(request: Request): Promise<unknown> {
      worker.asked.push(request);
      if (worker.refuses) throw new Error('no');
      return worker.value;
    }
  },
}));

const MARKS = new Float64Array(4);
const ALONE = { samples: MARKS, copies: [] };
const TWICE = { samples: MARKS, copies: [MARKS] };
const kinds = (): string[] => worker.asked.map((r) => r.kind);

/** Two drawings, of which one is on the sheet. */
const documentAt = (current: number): DocumentState =>
  ({ current, plants: [0, 1].map((id) => ({ id, sketch: { strokes: [] } })) }) as unknown as DocumentState;

function sessionWith(events: Partial<SessionEvents> = {}): Session {
  const names = [
    'ready',
    'state',
    'view',
    'coarse',
    'busy',
    'progress',
    'failed',
    'fault',
    'dead',
    'refused',
    'drawing',
    'undrawn',
  ];
  const quiet = Object.fromEntries(names.map((name) => [name, () => {}]));
  return new Session({ ...quiet, ...events } as SessionEvents);
}

beforeEach(() => Object.assign(worker, { asked: [], growing: false, refuses: false, value: {} }));

describe('a session', () => {
  it('says when another plant comes onto the sheet, but not for the first', () => {
    const others: boolean[] = [];
    sessionWith({ state: (_fresh, _photo, other) => others.push(other) });
    for (const current of [0, 0, 1]) worker.events!.state(documentAt(current), [], null);
    expect(others).toEqual([false, false, true]);
  });

  it('asks the plant on the sheet, and nothing where there is none', () => {
    const session = sessionWith();
    session.draw('clear');
    expect(worker.asked).toEqual([]);
    worker.events!.state(documentAt(1), [], null);
    session.draw('clear');
    expect(worker.asked).toEqual([{ kind: 'command', command: { sketch: [1, 'clear'] } }]);
  });

  it('makes a stroke and its mirror image one step of undo', () => {
    const session = sessionWith();
    session.stroke('parts', ALONE);
    session.stroke('parts', TWICE);
    expect(worker.asked).toEqual([
      { kind: 'stroke', mode: 'parts', samples: MARKS },
      { kind: 'stroke', mode: 'parts', samples: MARKS, copies: [MARKS] },
    ]);
  });

  it('says of the stroke under the pen what it asks when the stroke ends', () => {
    let told: Request[] = [];
    const session = sessionWith({ drawing: (requests) => (told = requests()) });
    for (const inked of [ALONE, TWICE]) {
      session.setDraft('parts', inked);
      worker.asked = [];
      session.stroke('parts', inked);
      expect(told).toEqual(worker.asked);
    }
    expect(told).toMatchObject([{ copies: [MARKS] }]);
  });

  it('sends one draft at a time, the newest', () => {
    const session = sessionWith();
    for (const mode of ['parts', 'leaf-contour', 'branch-contour'] as const) session.setDraft(mode, ALONE);
    expect(kinds()).toEqual(['draft']);
    worker.events!.view({ plants: [] } as unknown as SceneView, []);
    expect(worker.asked.slice(1)).toEqual([{ kind: 'draft', mode: 'branch-contour', samples: MARKS }]);
  });

  it('takes back a draft only if it was sent', () => {
    const session = sessionWith();
    session.dropDraft();
    expect(worker.asked).toEqual([]);
    session.setDraft('parts', ALONE);
    session.dropDraft();
    expect(worker.asked[1]).toEqual({ kind: 'draft', mode: 'parts', samples: new Float64Array() });
    session.dropDraft();
    expect(worker.asked.length).toBe(2);
  });

  it('asks several commands as one stage of one step, and says which was refused', async () => {
    const refused = vi.fn();
    const session = sessionWith({ refused });
    const [one, two] = ['a', 'b'].map((name) => ({ scene: { rename: name } }));
    session.runAll('tree', [one!]);
    session.runAll('tree', [one!, two!]);
    expect(worker.asked).toEqual([
      { kind: 'command', command: one },
      { kind: 'begin', name: 'tree' },
      { kind: 'stage', command: one, more: [two] },
      { kind: 'commit' },
    ]);
    session.runAll('tree', []);
    expect(worker.asked.length).toBe(4);
    worker.value = { refused: { code: 'locked', fields: {}, message: 'it is locked' } };
    session.stage(one!);
    await vi.waitFor(() =>
      expect(refused).toHaveBeenCalledWith({ kind: 'stage', command: one }, 'it is locked'),
    );
  });

  it('reports what was refused', async () => {
    const refused = vi.fn();
    const session = sessionWith({ refused });
    session.end(true);
    worker.refuses = true;
    session.end(false);
    await vi.waitFor(() => expect(refused).toHaveBeenCalledWith({ kind: 'abandon' }, 'no'));
    expect(refused).toHaveBeenCalledTimes(1);
  });
});
