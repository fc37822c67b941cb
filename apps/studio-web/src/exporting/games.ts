/** An export for games in one press: levels of detail and views from all sides, packed; what will be written is counted before. */
import type { Engine } from '../worker/engine';
import { choice, type ExportOptions, levelRows, type OptionKey, PLAIN } from './exporting';
import { ForProgram, isGiven, keepChoice, nameOfProgram, type Program, PROGRAMS } from './programs';
import { megabytes, number, t } from '../text';
import type { EngineAnswer, WrittenFigures } from '../wire';
import { dialog, download, el, note } from '../page/ui';

/** What engines take: each level a file of its own, the last of them views from all sides. */
const FOR_GAMES: ExportOptions = { ...PLAIN, levels: 3, impostor: true, packed: true };

/** Where the end of a zip says how many files it has and where their list begins, and the fields of a row of that list; bytes. */
const ZIP = { end: 22, count: 10, list: 16, row: 46, size: 24, name: 28, extra: 30, comment: 32 } as const;
/** The first bytes of a zip. */
const ZIP_MARK = [0x50, 0x4b] as const;

export interface PackedFile {
  readonly name: string;
  readonly bytes: number;
}

/** The files of a zip, as large as they are unpacked. */
export function filesOfZip(zip: Uint8Array): PackedFile[] {
  const view = new DataView(zip.buffer, zip.byteOffset, zip.byteLength);
  const end = zip.byteLength - ZIP.end;
  let at = view.getUint32(end + ZIP.list, true);
  return Array.from({ length: view.getUint16(end + ZIP.count, true) }, () => {
    const length = view.getUint16(at + ZIP.name, true);
    const name = new TextDecoder().decode(zip.subarray(at + ZIP.row, at + ZIP.row + length));
    const bytes = view.getUint32(at + ZIP.size, true);
    at += ZIP.row + length + view.getUint16(at + ZIP.extra, true) + view.getUint16(at + ZIP.comment, true);
    return { name, bytes };
  });
}

/** Whether bytes are a zip of several files. */
export const isZip = (bytes: Uint8Array): boolean => ZIP_MARK.every((b, k) => bytes[k] === b);

/** `stem`: of the file's name; `whole`: the scene, else the chosen plant; `look`: shows the meshes that will be written. */
export function exportForGames(engine: Engine, stem: string, whole: boolean, look: () => void): void {
  new GamesDialogue(engine, stem, whole, look).open();
}

class GamesDialogue {
  private readonly options: ExportOptions;
  private readonly program: ForProgram;
  private readonly fine: ReturnType<typeof levelRows>;
  private readonly body = el('div', { class: 'written', 'aria-live': 'polite' });
  private readonly said = el('p', { id: 'b-games-set', role: 'status' });
  private readonly save = el(
    'button',
    { type: 'button', class: 'primary', id: 'b-games-save', onclick: () => this.take() },
    t('games.save.none'),
  );
  private dialog: HTMLDialogElement | undefined;
  private bytes: Uint8Array<ArrayBuffer> | undefined;
  /** How many times something was chosen, and whether that is being written. */
  private wanted = 0;
  private writing = false;

  constructor(
    private readonly engine: Engine,
    private readonly stem: string,
    whole: boolean,
    private readonly look: () => void,
  ) {
    this.options = { ...FOR_GAMES, whole };
    this.program = new ForProgram(
      this.options,
      {},
      (ask) => engine.ask<EngineAnswer>({ kind: 'settle', ask }),
      () => this.show(),
    );
    this.fine = levelRows(this.options, (key) => this.ask(key), 'b-games-');
  }

  private ask(key: OptionKey): void {
    this.program.ask(key, 'glb');
    this.renew();
  }

  private choose(program: Program | null): void {
    const { whole } = this.options;
    if (program === null) Object.assign(this.options, FOR_GAMES, { whole });
    this.program.choose(program, 'glb');
    this.renew();
  }

  private show(): void {
    this.fine.show('glb');
    this.said.textContent = this.program.said;
    this.said.hidden = this.program.said === '';
  }

  open(): void {
    const words = PROGRAMS.filter((p) => isGiven(p, 'glb')).map((p) => [p, nameOfProgram(p)] as const);
    const goal = choice(
      'export.for',
      [['', t('engine.any')], ...words],
      '' as Program | '',
      (word) => this.choose(word === '' ? null : word),
      'b-games-for',
    );
    const see = el(
      'button',
      { type: 'button', class: 'link', id: 'b-games-look', onclick: () => this.see() },
      t('exported.title'),
    );
    this.dialog = dialog(
      t('games.title'),
      el(
        'div',
        { class: 'games' },
        el('form', { class: 'export' }, goal, ...this.fine.rows),
        el('div', {}, this.body, this.said),
      ),
      el('p', { class: 'muted' }, t('games.hint')),
      el('div', { class: 'row' }, see, el('span', { class: 'space' }), this.save),
    );
    this.dialog.id = 'b-games';
    this.dialog.querySelector('form')!.addEventListener('submit', (e) => e.preventDefault());
    this.dialog.addEventListener('close', () => {
      this.wanted += 1;
    });
    this.show();
    this.renew();
  }

  /** The meshes that will be written, in the view. */
  private see(): void {
    keepChoice('glb', { ...this.options }, this.program.asked);
    this.dialog?.close();
    this.look();
  }

  /** Writes anew what was chosen last; one at a time. */
  private renew(): void {
    this.wanted += 1;
    this.bytes = undefined;
    this.save.disabled = true;
    this.save.textContent = t('games.save.none');
    this.body.replaceChildren(el('p', { class: 'muted' }, t('games.working')));
    if (!this.writing) void this.write();
  }

  private async write(): Promise<void> {
    this.writing = true;
    for (let done = -1; this.dialog?.open && done !== this.wanted; ) {
      done = this.wanted;
      await this.program.pending;
      if (done !== this.wanted) continue;
      const request = { format: 'glb', ...this.options } as const;
      try {
        const bytes = await this.engine.ask<Uint8Array<ArrayBuffer>>({ kind: 'export', request });
        const figures = await this.engine.ask<WrittenFigures>({ kind: 'written' });
        if (done === this.wanted) this.tell(bytes, figures);
      } catch (e) {
        if (done === this.wanted)
          this.body.replaceChildren(el('p', { class: 'bad', role: 'alert' }, (e as Error).message));
      }
    }
    this.writing = false;
  }

  /** What the files hold, and what became of the plant to keep within the budget. */
  private tell(bytes: Uint8Array<ArrayBuffer>, { triangles, level, halvings }: WrittenFigures): void {
    const files = isZip(bytes) ? filesOfZip(bytes) : [{ name: `${this.stem}.glb`, bytes: bytes.byteLength }];
    const counts = files.length === triangles.length ? triangles.map((n) => [n]) : [triangles];
    const rows = files.map(({ name, bytes: size }, k) =>
      el(
        'tr',
        { 'data-file': name, 'data-bytes': String(size), 'data-triangles': (counts[k] ?? []).join(' ') },
        el('th', { scope: 'row' }, name),
        el('td', {}, (counts[k] ?? []).map(number).join(' · ')),
        el('td', {}, `${megabytes(size)} MB`),
      ),
    );
    const heads = [t('games.file'), t('exported.triangles'), t('games.size')];
    const reduced = [
      ...(level > 0 ? [t('games.reduced.level', { level })] : []),
      ...(halvings > 0 ? [t('games.reduced.textures', { share: `1/${2 ** halvings}` })] : []),
    ];
    this.body.replaceChildren(
      el(
        'div',
        { class: 'figures' },
        el(
          'table',
          {},
          el('thead', {}, el('tr', {}, ...heads.map((head) => el('th', { scope: 'col' }, head)))),
          el('tbody', {}, ...rows),
        ),
      ),
      ...reduced.map((text) => el('p', { class: 'reduced' }, text)),
    );
    this.bytes = bytes;
    this.save.disabled = false;
    this.save.textContent = t('games.save', { count: files.length, size: megabytes(bytes.byteLength) });
  }

  private take(): void {
    const { bytes } = this;
    if (!bytes) return;
    this.dialog?.close();
    const zipped = isZip(bytes);
    const name = zipped ? `${this.stem}.glb.zip` : `${this.stem}.glb`;
    download(name, bytes, zipped ? 'application/zip' : 'model/gltf-binary');
    note([t('note.exported', { name }), this.program.said].filter(Boolean).join(' · '));
  }
}
