/** Strokes on the clipboard: copy, cut, paste, duplicate. What is copied is our JSON as text. */
import type { Engine } from '../worker/engine';
import type { SketchCommand } from '../wire';
import type { Sheet } from '../sheet/sheet';
import { t } from '../text';
import { note } from '../page/ui';

export interface ClipboardEvents {
  /** Asked of the drawing. */
  run(command: SketchCommand): void;
  openFile(file: File): Promise<void>;
  /** Selects strokes. */
  choose(ids: number[]): void;
}

export class Clipboard {
  private clip = '';
  /** A copy that the core has not answered yet. */
  private copying: Promise<boolean> | undefined;
  /** How many strokes at the end of the document shall be selected when they are there. */
  private fresh = 0;

  constructor(
    private readonly engine: Engine,
    private readonly sheet: Sheet,
    private readonly page: ClipboardEvents,
  ) {}

  /** Selects what was duplicated, once it is among these strokes. */
  select(strokes: readonly { id: number }[]): void {
    if (this.fresh === 0) return;
    this.page.choose(strokes.slice(-this.fresh).map((s) => s.id));
    this.fresh = 0;
  }

  async copy(): Promise<boolean> {
    const ids = this.sheet.selected;
    if (ids.length === 0) return false;
    const asked = this.engine.ask<string>({ kind: 'copy', ids }).then(
      (clip) => {
        this.clip = clip;
        return true;
      },
      () => false,
    );
    this.copying = asked;
    const done = await asked;
    if (this.copying === asked) this.copying = undefined;
    if (!done) return false;
    await navigator.clipboard.writeText(this.clip).catch(() => undefined); // our own copy serves this page
    return true;
  }

  async cut(): Promise<void> {
    const ids = this.sheet.selected;
    if (await this.copy()) this.page.run({ 'remove-strokes': ids });
  }

  paste(e: ClipboardEvent): void {
    if ((e.target as HTMLElement).matches('input, textarea') || document.querySelector('dialog[open]'))
      return;
    const file = e.clipboardData?.files[0];
    if (file) {
      void this.page.openFile(file);
      return;
    }
    void this.pasteText(e.clipboardData?.getData('text/plain') ?? '');
  }

  async pasteText(given: string): Promise<void> {
    // While the core is busy a copy may still be on its way: it is newer than what the clipboard holds.
    const newer = this.copying !== undefined && (await this.copying);
    const text = !newer && /^\s*[{<]/.test(given) ? given : this.clip;
    if (text === '') return;
    const step = 24 * this.sheet.unitsPerPixel;
    try {
      // The state comes before the answer.
      this.fresh = 0;
      const ids = await this.engine.ask<Uint32Array>({ kind: 'paste', text, x: step, y: -step });
      this.page.choose([...ids]);
    } catch (error) {
      note(t('note.refused', { why: (error as Error).message }), 'bad');
    }
  }

  /** Pastes what the system's clipboard holds, where the browser lets a page read it, or else what was copied here. */
  async pasteHeld(): Promise<void> {
    const held = await navigator.clipboard.readText().catch(() => '');
    await this.pasteText(held);
  }

  duplicate(): void {
    const ids = this.sheet.selected;
    if (ids.length === 0) return;
    const step = 24 * this.sheet.unitsPerPixel;
    this.fresh = ids.length;
    this.page.run({ duplicate: [ids, [step, -step]] });
  }
}
