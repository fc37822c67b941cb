/** Files in and out: opening, saving, exporting, and what the page begins with. */
import type { Documents } from './documents';
import type { Engine } from '../worker/engine';
import type { EngineAnswer, MakerWord, Opened, PrintFigures } from '../wire';
import { openExport } from '../exporting/dialogue';
import { fileOf, isModel, PLAIN, type Target, type ExportOptions } from '../exporting/exporting';
import { exportForGames, isZip } from '../exporting/games';
import { decode, isLink, link } from './share';
import { isPhoto } from '../drawing/photo';
import { SAMPLES } from './samples';
import { measured } from '../page/measure';
import { t, warning } from '../text';
import { dialog, download, el, note } from '../page/ui';

/** Larger files are refused before they are read into memory. */
const MAX_MB = 256;
const ACCEPT =
  '.burgeon,.svg,.svgz,.excalidraw,.tldr,.inkml,.ndjson,.json,.csv,.toml,.glb,.gltf,.obj,.ply,.stl,image/*';

export interface FilesEvents {
  opened(): void;
  picture(): Promise<Blob> | undefined;
  name(): string;
  empty(): boolean;
  /** A model is viewed instead of the plants. */
  viewed(name: string): void;
  /** The scene has more than one plant. */
  several(): boolean;
  /** The maker of the plant that is chosen. */
  kind(): MakerWord;
  /** A picture was given: it goes under the drawing. */
  photo(file: File): Promise<void>;
  /** The export is to be seen before it is written. */
  look(): void;
  /** Another export was chosen. */
  exportChosen(): void;
  /** Nothing is drawn or planted. */
  blank(): boolean;
  /** The file with which the page was opened came in, of this version. */
  offered(name: string, version: string | null): void;
}

export class Files {
  constructor(
    private readonly engine: Engine,
    private readonly documents: Documents,
    private readonly events: FilesEvents,
  ) {}

  /** Files may be dropped anywhere, and pasted. */
  listen(host: HTMLElement): void {
    const over =
      (on: boolean) =>
      (e: DragEvent): void => {
        e.preventDefault();
        host.classList.toggle('dropping', on && (e.dataTransfer?.types.includes('Files') ?? false));
        host.dataset['drop'] = t('note.dropped');
      };
    host.addEventListener('dragover', over(true));
    host.addEventListener('dragleave', (e) => {
      if (!e.relatedTarget) over(false)(e);
    });
    host.addEventListener('drop', (e) => {
      over(false)(e);
      void this.openAll([...(e.dataTransfer?.files ?? [])]);
    });
  }

  choose(accept = ACCEPT): void {
    const input = el('input', { type: 'file', accept, multiple: '' });
    input.addEventListener('change', () => void this.openAll([...(input.files ?? [])]));
    input.click();
  }

  pickFile(accept: string, act: (file: File) => void): void {
    const input = el('input', { type: 'file', accept });
    input.addEventListener('change', () => {
      const file = input.files?.[0];
      if (file) act(file);
    });
    input.click();
  }

  /** One after another, in the order in which they were given: a file that cannot be read keeps none from coming in. */
  async openAll(files: readonly File[]): Promise<void> {
    for (const file of files) await this.openFile(file);
  }

  async openFile(file: File): Promise<void> {
    if (file.size > MAX_MB << 20) {
      note(t('note.unreadable', { name: file.name, why: t('note.large', { limit: MAX_MB }) }), 'bad');
      return;
    }
    try {
      if (isPhoto(file)) await this.events.photo(file);
      else await this.open(file.name, new Uint8Array(await file.arrayBuffer()));
    } catch (e) {
      note(t('note.unreadable', { name: file.name, why: (e as Error).message }), 'bad');
    }
  }

  /** Opens bytes; a file of several drawings asks which. */
  async open(name: string, bytes: Uint8Array, row = 0, fresh = false, quiet = false): Promise<void> {
    const start = performance.now();
    const opened = await this.engine.ask<Opened>({ kind: 'open', name, bytes, row, fresh });
    measured('open', start);
    if (opened.kind === 'model') this.events.viewed(opened.name || name);
    this.events.opened();
    if (!quiet) {
      note(t('note.opened', { name }));
      if (opened.warnings.length > 0) note(opened.warnings.slice(0, 3).map(warning).join(' · '), 'bad');
    }
    if (opened.names.length > 1 && row === 0) this.pick(name, bytes, opened.names);
  }

  private pick(name: string, bytes: Uint8Array, names: string[]): void {
    const list = el('div', { class: 'menu' });
    names.forEach((each, row) =>
      list.append(
        el(
          'button',
          {
            type: 'button',
            onclick: () => {
              d.close();
              if (row > 0) this.open(name, bytes, row).catch((e: Error) => note(e.message, 'bad'));
            },
          },
          `${row + 1}. ${each}`,
        ),
      ),
    );
    const d = dialog(
      t('dialog.pick'),
      el('p', { class: 'muted' }, t('dialog.pick.hint', { count: names.length })),
      list,
    );
  }

  samples(): void {
    const list = el('div', { class: 'samples' });
    for (const { name, url } of SAMPLES) {
      list.append(
        el(
          'button',
          {
            type: 'button',
            'data-sample': name,
            onclick: () => {
              d.close();
              void this.openUrl(`${name}.svg`, url);
            },
          },
          el('img', { src: url, alt: '', loading: 'lazy' }),
          el('span', {}, name.replaceAll('-', ' ')),
        ),
      );
    }
    const d = dialog(t('dialog.samples'), list);
  }

  /** `offered`: the server may take it back. */
  private async openUrl(name: string, url: string, offered = false): Promise<void> {
    try {
      const answer = await fetch(url);
      if (answer.status === 401) throw new Error(t('note.file.locked'));
      if (!answer.ok) throw new Error(`${answer.status}`);
      await this.open(name, new Uint8Array(await answer.arrayBuffer()));
      if (offered) this.events.offered(name, answer.headers.get('ETag'));
    } catch (e) {
      note(t('note.unreadable', { name, why: (e as Error).message }), 'bad');
    }
  }

  async save(): Promise<void> {
    const bytes = await this.engine.ask<Uint8Array<ArrayBuffer>>({ kind: 'save' });
    const name = `${safe(this.events.name())}.burgeon`;
    download(name, bytes, 'application/zip');
    note(t('note.exported', { name }));
  }

  /** A link with the whole document in it, onto the clipboard. */
  async share(): Promise<void> {
    try {
      const to = link(await this.engine.ask<Uint8Array>({ kind: 'share' }));
      if (to === undefined) {
        note(t('note.link.long'), 'bad');
        return;
      }
      const field = el('textarea', {
        class: 'field',
        readonly: '',
        rows: '4',
        'aria-label': t('share.title'),
      });
      field.value = to;
      dialog(
        t('share.title'),
        el('p', { class: 'muted' }, t('share.hint', { size: Math.ceil(to.length / 1000) })),
        field,
      );
      field.select();
      await navigator.clipboard.writeText(to).then(
        () => note(t('note.link.copied')),
        () => undefined,
      );
    } catch (e) {
      note(t('note.refused', { why: (e as Error).message }), 'bad');
    }
  }

  /** A picture of the view as it is. */
  async picture(): Promise<void> {
    await this.exportAs('png', { ...PLAIN, whole: true });
  }

  /** The whole scene as a model, without questions. */
  async model(format: Target = 'glb'): Promise<void> {
    await this.exportAs(format, { ...PLAIN, whole: this.events.several() });
  }

  chooseExport(): void {
    openExport(this.events.several(), this.events.kind(), {
      write: (format, options, said) => {
        this.events.exportChosen();
        void this.exportAs(format, options, said);
      },
      look: () => this.events.look(),
      games: (whole) => {
        if (this.events.empty()) note(t('note.nothing'), 'bad');
        else exportForGames(this.engine, safe(this.events.name()), whole, () => this.events.look());
      },
      settle: (ask) => this.engine.ask<EngineAnswer>({ kind: 'settle', ask }),
    });
  }

  private async exportAs(format: Target, options: ExportOptions, said = ''): Promise<void> {
    if (format !== 'json' && this.events.empty()) {
      note(t('note.nothing'), 'bad');
      return;
    }
    try {
      if (!isModel(format)) options.levels = 1;
      const stem = safe(this.events.name());
      const { type, ending } = fileOf(format);
      let name = `${stem}.${ending}`;
      if (format === 'png') {
        const picture = await this.events.picture();
        if (!picture) throw new Error(t('note.nowebgl'));
        download(name, picture, type);
      } else {
        const request = { format, ...options };
        const bytes = await this.engine.ask<Uint8Array<ArrayBuffer>>({ kind: 'export', request });
        // Several files come as a zip.
        const zipped = isZip(bytes);
        if (zipped) name = `${stem}.${format}.zip`;
        download(name, bytes, zipped ? 'application/zip' : type);
      }
      note([t('note.exported', { name }), said, await this.printed(options)].filter(Boolean).join(' · '));
    } catch (e) {
      note(t('note.refused', { why: (e as Error).message }), 'bad');
    }
  }

  /** What became of a plant in a print; empty for all else. */
  private async printed({ engine }: ExportOptions): Promise<string> {
    if (engine !== 'print') return '';
    const figures = await this.engine.ask<PrintFigures | null>({ kind: 'printed' });
    if (!figures) return '';
    const { scale, wall_mm, loose } = figures;
    return t('note.printed', { scale: scale.toFixed(scale < 10 ? 2 : 0), wall: wall_mm, loose });
  }

  // Starting -----------------------------------------------------------------------------------------------------

  /** What the address asks for, else what this browser kept; what is asked for comes as a document of its own. */
  async restore(): Promise<void> {
    const { documents } = this;
    const wanted = new URLSearchParams(location.search).get('open');
    // Only what this very server offers: a link must not make the page fetch from elsewhere.
    const offered = wanted && /^opened\/[^/\\?#]+$/.test(wanted) ? wanted.slice('opened/'.length) : undefined;
    const shared = isLink(location.hash) ? location.hash : '';
    if (offered || shared) history.replaceState(null, '', location.pathname);
    const restored = await documents.restore();
    if (offered) {
      await documents.fresh(true);
      await this.openUrl(offered, `./opened/${encodeURIComponent(offered)}`, true);
    } else if (shared) await this.openShared(shared);
    else if (restored && !this.events.blank()) note(t('note.restored'));
  }

  private async openShared(hash: string): Promise<void> {
    const { documents } = this;
    const before = documents.current;
    try {
      const bytes = decode(hash);
      if (!bytes) throw new Error(t('note.link.bad'));
      await documents.fresh(true);
      await this.open('link.burgeon', bytes, 0, false, true);
      note(t('note.link.opened'));
    } catch (e) {
      if (before !== undefined) await documents.open(before);
      note(t('note.unreadable', { name: t('share.title'), why: (e as Error).message }), 'bad');
    }
  }
}

/** A file name of the plant's name. */
export function safe(name: string): string {
  return (
    name
      .replace(/[\\/:*?"<>|\u0000-\u001f]+/g, '-')
      .replace(/^[.\s-]+|[.\s-]+$/g, '')
      .slice(0, 80) || 'plant'
  );
}
