/** What a command would make, seen before it is done. */
import type { Session } from '../worker/session';
import { number, t } from '../text';
import { dialog, el } from '../page/ui';
import type { Command, HandEdit, PlantState } from '../wire';

/** How long a plant may take to be made, milliseconds. */
const PATIENCE_MS = 120_000;
/** How often it is looked whether it is there, milliseconds. */
const LOOK_MS = 10;

/** Within a gesture: stages a command and waits until the plants that it makes are seen. */
export async function stageSeen(session: Session, command: Command, signal?: AbortSignal): Promise<void> {
  const before = session.scene;
  const began = performance.now();
  await session.engine.ask({ kind: 'stage', command });
  const isSeen = (): boolean =>
    session.scene !== before && session.scene?.revision === session.state?.revision;
  while (!isSeen()) {
    signal?.throwIfAborted();
    if (performance.now() - began > PATIENCE_MS) throw new Error(t('film.late'));
    await new Promise((resolve) => {
      setTimeout(resolve, LOOK_MS);
    });
  }
}

/** The edit that an outline makes. */
export type Outline = Extract<HandEdit, { op: 'silhouette' }>;

/** Branches and leaves of the plant that is worked on. */
function countsOf(session: Session): { branches: number; leaves: number } {
  const counts = session.seen?.item?.counts;
  return { branches: counts?.branches ?? 0, leaves: counts?.leaves ?? 0 };
}

/**
 * An outline that also cuts: what it would cut is counted and shown first, and a person says whether it is cut, or the outline
 * only filled, or nothing done.
 */
export async function cutWhenAsked(session: Session, plant: PlantState, outline: Outline): Promise<void> {
  const command = (trim: boolean): Command => ({ shape: [plant.id, { add: { ...outline, trim } }] });
  await session.engine.ask({ kind: 'begin', name: 'silhouette' });
  let keeps = false;
  try {
    await stageSeen(session, command(false));
    const filled = countsOf(session);
    await stageSeen(session, command(true));
    const cut = countsOf(session);
    const [branches, leaves] = [filled.branches - cut.branches, filled.leaves - cut.leaves];
    const wanted = branches > 0 || leaves > 0 ? await askToCut(branches, leaves) : 'cut';
    if (wanted === 'fill') await session.engine.ask({ kind: 'stage', command: command(false) });
    keeps = wanted !== undefined;
  } finally {
    session.end(keeps);
  }
}

/** Undefined where neither is wanted. */
function askToCut(branches: number, leaves: number): Promise<'cut' | 'fill' | undefined> {
  return new Promise((resolve) => {
    const choice = (id: 'cut' | 'fill', kind: string): HTMLButtonElement =>
      el(
        'button',
        {
          type: 'button',
          class: kind,
          id: `b-outline-${id}`,
          onclick: () => {
            resolve(id);
            d.close();
          },
        },
        t(`shape.cut.${id}`),
      );
    const d = dialog(
      t('shape.cut.title'),
      el('p', {}, t('shape.cut.count', { branches: number(branches), leaves: number(leaves) })),
      el('div', { class: 'row' }, choice('cut', 'chip danger'), choice('fill', 'primary')),
    );
    d.addEventListener('close', () => resolve(undefined));
  });
}
