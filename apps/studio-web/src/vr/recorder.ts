/** What hands do, written down as `burgeon.gestures/1`: every request in the order in which the core did it. */
import type { Request } from '../worker/protocol';
import type { GestureDeed, GestureRecord, HandEdit, PlantNumbers, ShapeAnswer } from '../wire';

/** Most steps of a record, as the core reads them. */
const MOST = 300_000;

/** What a project does not say of the document that was saved. */
export interface Found {
  /** The plant that is worked on. */
  readonly plant: number | undefined;
  /** By which numbers steps name plants. */
  readonly numbers: PlantNumbers | undefined;
}

export class Recorder {
  private record: { project: string; found: Found; steps: GestureRecord['steps'] } | undefined;
  private began = 0;
  /** What the last gesture made, if it is not asked for yet. */
  private made: HandEdit | undefined;

  constructor(private readonly now: () => number = () => performance.now()) {}

  get isOn(): boolean {
    return this.record !== undefined;
  }

  /** `project`: the document as the hands find it, a file. */
  start(project: Uint8Array, found: Found): void {
    this.record = { project: base64(project), found, steps: [] };
    this.began = this.now();
    this.made = undefined;
  }

  /** The core did this. */
  did(request: Request, answer: unknown): void {
    if (!this.record) return;
    if (request.kind === 'shape') this.made = (answer as ShapeAnswer).commit ?? this.made;
    const deed = deedOf(request, this.made);
    if (deed === 'keep') this.made = undefined;
    if (deed !== undefined) this.add(deed);
  }

  /** The plants were made again, and are seen. */
  seen(): void {
    this.add('seen');
  }

  private add(did: GestureDeed): void {
    const steps = this.record?.steps;
    if (!steps || steps.length >= MOST) return;
    steps.push({ ms: Math.round(this.now() - this.began), did });
  }

  /** The record; nothing if none was begun. `digest`: of the plant that is worked on, as it is seen. */
  stop(digest: string | undefined): GestureRecord | undefined {
    const { record } = this;
    if (!record) return undefined;
    this.record = this.made = undefined;
    return {
      schema: 'burgeon.gestures/1',
      project: record.project,
      numbers: record.found.numbers ?? null,
      plant: record.found.plant ?? null,
      steps: record.steps,
      digest: digest ?? null,
    };
  }
}

/** How a request stands in a record; nothing where it changes nothing, or no hand in space can ask for it. */
export function deedOf(request: Request, made: HandEdit | undefined): GestureDeed | undefined {
  switch (request.kind) {
    case 'shape':
      return { hand: { tool: request.tool, reach: request.reach, input: request.input } };
    case 'command': {
      const { command } = request;
      const shaped = 'shape' in command ? command.shape[1] : undefined;
      // The very edit that came back from the gesture: it is made anew when the record is.
      if (made && shaped && typeof shaped === 'object' && 'add' in shaped && shaped.add === made)
        return 'keep';
      return { command };
    }
    case 'action':
      return { action: [request.action, request.placed ?? null] };
    case 'select':
      return { select: request.plant };
    case 'begin':
      return { begin: request.name };
    case 'stage':
      return { stage: request.command };
    case 'commit':
    case 'abandon':
    case 'undo':
    case 'redo':
      return request.kind;
    default:
      return undefined;
  }
}

/** In pieces: a call takes so many arguments only. */
function base64(bytes: Uint8Array): string {
  let text = '';
  for (let i = 0; i < bytes.length; i += 0x8000)
    text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return btoa(text);
}
