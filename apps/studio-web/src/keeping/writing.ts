/**
 * The file that the page was opened with, written back to the server that offers it. Only a server that gives the file a
 * version (`burgeon studio --lan`) takes it back, and only over the version that is known here: what another program wrote
 * meanwhile stays.
 */
import type { Engine } from '../worker/engine';
import { t } from '../text';

/** After so much quiet a change is written, and at the latest after so long. */
const QUIET_MS = 800;
const LATEST_MS = 5000;
/** Until the next try where the server is out of reach. */
const AGAIN_MS = 3000;
const KEY = 'burgeon.writes';

async function versionOf(bytes: Uint8Array<ArrayBuffer>): Promise<string> {
  const hash = new Uint8Array(await crypto.subtle.digest('SHA-256', bytes));
  return `"${[...hash].map((b) => b.toString(16).padStart(2, '0')).join('')}"`;
}

interface File {
  name: string;
  /** The SHA-256 of its bytes, as the server gives it. */
  version: string;
  /** That of the bytes that were sent last: a page that is closed meanwhile hears of no success. */
  sent?: string;
  /** The document that it was opened as. */
  document: string;
}

export interface WritingEvents {
  /** The document that is open, and its revision. */
  document(): string | undefined;
  revision(): number;
  /** What is true of the file. */
  standing(text: string): void;
  /** Another program wrote the file: it is left alone. */
  left(name: string): void;
}

export class Writing {
  private file: File | undefined;
  private revision = -1;
  private wanted = 0;
  private timer = 0;
  private busy = false;

  constructor(
    private readonly engine: Engine,
    private readonly events: WritingEvents,
  ) {
    try {
      this.file = JSON.parse(sessionStorage.getItem(KEY) ?? 'null') ?? undefined;
    } catch {
      this.file = undefined;
    }
  }

  /** The page was opened with a file that has this version; without one it is not written. */
  opened(name: string, version: string | null): void {
    const document = this.events.document();
    this.revision = this.events.revision();
    this.keep(version !== null && document !== undefined ? { name, version, document } : undefined);
    if (this.file) this.events.standing(t('file.written', { name }));
  }

  /** After a reload the browser's document is here again, perhaps with a change that was not written any more. */
  begun(): void {
    if (!this.file || this.revision >= 0) return;
    this.revision = this.events.revision();
    if (this.file.document === this.events.document()) this.later(0);
  }

  /** The document has this revision now. */
  changed(revision: number): void {
    const { file, revision: before } = this;
    if (!file || file.document !== this.events.document() || revision === before || before < 0) return;
    this.revision = revision;
    const now = performance.now();
    if (this.wanted === 0) this.wanted = now;
    this.later(Math.max(0, Math.min(QUIET_MS, this.wanted + LATEST_MS - now)));
    this.events.standing(t('file.writing', { name: file.name }));
  }

  private later(ms: number): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.write(), ms);
  }

  private async write(): Promise<void> {
    const { file } = this;
    if (!file || file.document !== this.events.document()) return;
    if (this.busy) {
      this.later(QUIET_MS);
      return;
    }
    this.busy = true;
    this.wanted = 0;
    try {
      const body = await this.engine.ask<Uint8Array<ArrayBuffer>>({ kind: 'save' });
      const sent = await versionOf(body);
      this.keep({ ...file, sent });
      const answer = await fetch(`./opened/${encodeURIComponent(file.name)}`, {
        method: 'PUT',
        body,
        headers: { 'If-Match': file.version },
      });
      const version = answer.headers.get('ETag');
      if (answer.status === 204 && version !== null) {
        this.keep({ ...file, version });
        if (this.wanted === 0) this.events.standing(t('file.written', { name: file.name }));
      } else if (answer.status === 412 && version !== null && version === file.sent) {
        this.keep({ ...file, version });
        this.later(0);
      } else if (answer.status === 412 || answer.status === 404) {
        this.keep(undefined);
        this.events.standing(t('file.left', { name: file.name }));
        this.events.left(file.name);
      } else throw new Error(await answer.text());
    } catch {
      this.events.standing(t('file.away', { name: file.name }));
      if (this.wanted === 0) this.wanted = performance.now();
      this.later(AGAIN_MS);
    } finally {
      this.busy = false;
    }
  }

  /** What is known of the file. */
  private keep(file: File | undefined): void {
    this.file = file;
    try {
      if (file) sessionStorage.setItem(KEY, JSON.stringify(file));
      else sessionStorage.removeItem(KEY);
    } catch {
      // After a reload the file is opened anew by its link.
    }
  }
}
