/**
 * The document of this tab: which one it is, that no other tab writes into it, and the way to another.
 *
 * A lock of the browser says which documents are open in some tab. Where there are none, the tab that opened a document
 * last has it, and the other one is told when it writes next.
 */
import { type Standing, Keeper, newId } from './keeper';
import { documents, type Kept, lockOf, portray, take } from './library';
import type { Request } from '../worker/protocol';
import { setTabSetting, tabSetting } from './store';
import { t } from '../text';
import { note } from '../page/ui';

export interface DocumentsEvents {
  ask(request: Request): Promise<unknown>;
  save(): Promise<Uint8Array>;
  name(): string;
  /** What the view shows; undefined if it shows nothing. */
  picture(): Promise<Blob> | undefined;
  /** Another document is here. */
  opened(): void;
  standing(now: Standing): void;
}

/** How long a tab that is being reloaded may hold on to its document. */
const SOON_MS = 400;
/** How long a document that is only to be looked at is waited for: a tab that fell has it until the system has cleared up. */
const LATER_MS = 10_000;
/** How long another tab may take to hand a document over before it is taken. */
const HAND_OVER_MS = 1500;
/** A picture is made when nothing was grown for so long. */
const REST_MS = 1500;
/** Pixels of the longer side of the small picture. */
const SMALL = 200;

type Free = () => void;

export class Documents {
  readonly keeper: Keeper;
  private free: Free | undefined;
  private readonly channel = 'BroadcastChannel' in globalThis ? new BroadcastChannel('burgeon') : undefined;
  private timer = 0;
  /** Ends waiting for the document that is here. */
  private waiting = new AbortController();
  /** The small picture is not of what is seen now. */
  private stale = false;
  /** What the list was told that the document is called. */
  private called: string | undefined;
  private id: string | undefined;

  constructor(private readonly events: DocumentsEvents) {
    this.keeper = new Keeper(newId(), {
      standing: (now) => events.standing(now),
      save: () => events.save(),
      name: () => events.name(),
      created: (id) => {
        this.here(id);
        void hold(id, { lost: () => this.lose() }).then((free) => {
          this.free = free;
        });
      },
      taken: () => this.lose(),
    });
    this.channel?.addEventListener('message', ({ data }) => {
      if (data === this.id && this.id !== undefined && this.keeper.standing !== 'readonly') this.lose();
    });
    // The tab that had it may have gone.
    document.addEventListener('visibilitychange', () => {
      if (document.hidden) void this.portray();
      else void this.retry();
    });
  }

  /** The document that is here, if anything of it is kept. */
  get current(): string | undefined {
    return this.id;
  }

  /** Why the document may not be changed now. */
  refusal(): string | undefined {
    const { standing } = this.keeper;
    if (standing === 'readonly') return t('note.readonly');
    return standing === 'opening' ? t('status.loading') : undefined;
  }

  // Opening ------------------------------------------------------------------------------------------------------

  /** What this tab showed last, else what was changed last; whether there was anything. */
  async restore(): Promise<boolean> {
    try {
      const all = (await documents()).filter((e) => e.deleted === 0);
      const last = all.find((e) => e.id === tabSetting('document')) ?? all[0];
      if (last) return await this.show(last.id);
      this.keeper.open(undefined, []);
      return false;
    } catch (e) {
      this.keeper.broken(e as Error);
      return false;
    }
  }

  /** Opens another document of the list. */
  async open(id: string): Promise<void> {
    if (id === this.id) return;
    await this.leave();
    await this.show(id);
  }

  /** Starts a new document. The one that was here stays in the list; if it is not kept, it is one step of undo away. */
  async fresh(quiet = false): Promise<void> {
    await this.keeper.settled();
    if (typeof this.keeper.standing === 'object') {
      await this.events.ask({ kind: 'action', action: 'new' });
      this.events.opened();
      return;
    }
    // A stroke that came to nothing is no document.
    const before = this.keeper.standing === 'empty' ? undefined : this.id;
    const name = this.events.name();
    await this.leave();
    await this.empty();
    if (before !== undefined && !quiet)
      note(t('note.new', { name }), 'good', {
        label: t('note.new.back'),
        act: () => void this.open(before),
      });
  }

  /** Works on the document that another tab has: that tab may look at it from now on. */
  async takeOver(): Promise<void> {
    const { id } = this;
    if (id === undefined) return;
    this.waiting.abort();
    this.channel?.postMessage(id);
    const lost = (): void => this.lose();
    const free = (await hold(id, { wait: HAND_OVER_MS, lost })) ?? (await hold(id, { steal: true, lost }));
    await this.show(id, free);
  }

  /** The document may be free now, or soon. */
  private async retry(wait = SOON_MS): Promise<void> {
    const { id } = this;
    if (this.keeper.standing !== 'readonly' || id === undefined) return;
    this.waiting.abort();
    this.waiting = new AbortController();
    const free = await hold(id, { wait, until: this.waiting.signal, lost: () => this.lose() });
    // Meanwhile another document may have been asked for.
    if (this.id === id && this.keeper.standing === 'readonly') {
      if (free) await this.show(id, free);
    } else free?.();
  }

  /** Another tab has it. What was done here is written before it is let go. */
  private lose(): void {
    const free = this.free;
    this.free = undefined;
    void this.keeper.close('readonly').then(free);
  }

  private async leave(): Promise<void> {
    this.waiting.abort();
    await this.portray();
    await this.keeper.close('opening');
    this.free?.();
    this.free = undefined;
  }

  private async empty(): Promise<void> {
    await this.events.ask({ kind: 'load', journal: [] });
    this.here(undefined);
    this.keeper.open(undefined, []);
    this.events.opened();
  }

  /** Reads a document and shows it, for writing if no other tab does; one that cannot be read gives an empty one. */
  private async show(id: string, held?: Free): Promise<boolean> {
    this.waiting.abort();
    await this.keeper.close('opening');
    const lost = (): void => this.lose();
    const free = held ?? (await hold(id, { wait: SOON_MS, lost }));
    // Where there are no locks, the tab that has it hears of it.
    if (free && !navigator.locks) this.channel?.postMessage(id);
    let kept: Kept | undefined;
    try {
      kept = await take(id, free && this.keeper.owner);
      if (!kept) throw new Error(t('documents.gone'));
      await this.events.ask({ kind: 'load', journal: journalOf(kept) });
    } catch (e) {
      free?.();
      const name = kept?.entry.name ?? t('documents.title');
      note(t('note.unreadable', { name, why: (e as Error).message }), 'bad');
      await this.empty();
      return false;
    }
    this.free = free;
    this.here(id);
    this.keeper.open(id, kept.rows, free ? undefined : 'readonly');
    this.events.opened();
    if (!free) void this.retry(LATER_MS);
    return true;
  }

  private here(id: string | undefined): void {
    this.id = id;
    this.called = undefined;
    this.stale = false;
    setTabSetting('document', id ?? '');
  }

  /** The document that is here may have another name: the list tells it at once. */
  async rename(name: string): Promise<void> {
    const { id } = this;
    if (!this.isKept || name === this.called) return;
    this.called = name;
    await this.keeper.settled();
    const { mine } = this.keeper;
    if (mine && this.isKept && this.id === id) await portray(mine, { name }).catch(() => undefined);
  }

  private get isKept(): boolean {
    return this.keeper.standing === 'saved' || this.keeper.standing === 'saving';
  }

  /** The document that is here has another name. */
  async named(name: string): Promise<void> {
    const { mine } = this.keeper;
    if (mine) await portray(mine, { name, time: Date.now() });
  }

  // The small picture --------------------------------------------------------------------------------------------

  /** Something else is seen. */
  seen(): void {
    this.stale = true;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.portray(), REST_MS);
  }

  /** Makes the small picture, if it is to be made. */
  async portray(): Promise<void> {
    const { mine } = this.keeper;
    if (!this.stale || !mine || !this.isKept) return;
    this.stale = false;
    const name = this.events.name();
    const { changed } = this.keeper;
    const picture = await small(this.events.picture()).catch(() => '');
    await portray(mine, changed > 0 ? { name, time: changed } : { name }, picture).catch(() => undefined);
  }
}

/** Everything that was asked of a document. */
function journalOf({ whole, rows }: Kept): Request[] {
  const asked = rows.map((row) => row.request);
  const gesture = asked.findLast((r) => ['begin', 'commit', 'abandon', 'undo', 'redo'].includes(r.kind));
  return [
    ...(whole
      ? [{ kind: 'open', name: 'autosave.burgeon', bytes: whole, row: 0, fresh: true } as const]
      : []),
    ...asked,
    // The page went in the middle of a gesture.
    ...(gesture?.kind === 'begin' ? [{ kind: 'abandon' } as const] : []),
  ];
}

/** Has a document for this tab alone, until it is let go; undefined if another tab does not let go of it in time. */
function hold(
  id: string,
  { wait, until, steal, lost }: { wait?: number; until?: AbortSignal; steal?: true; lost: () => void },
): Promise<Free | undefined> {
  if (!navigator.locks) return Promise.resolve(() => undefined);
  return new Promise((resolve) => {
    let granted = false;
    const patience = new AbortController();
    const end = (): void => patience.abort();
    if (wait !== undefined) setTimeout(end, wait);
    until?.addEventListener('abort', end);
    const options = wait === undefined ? { steal: steal ?? false } : { signal: patience.signal };
    navigator.locks
      .request(lockOf(id), options, () => {
        granted = true;
        return new Promise<void>((free) => resolve(free));
      })
      .catch(() => (granted ? lost() : resolve(undefined)));
  });
}

async function small(picture: Promise<Blob> | undefined): Promise<string> {
  if (!picture) return '';
  const image = await createImageBitmap(await picture);
  const scale = SMALL / Math.max(image.width, image.height);
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [image.width * scale, image.height * scale];
  canvas.getContext('2d')?.drawImage(image, 0, 0, canvas.width, canvas.height);
  image.close();
  return canvas.toDataURL('image/jpeg', 0.85);
}
