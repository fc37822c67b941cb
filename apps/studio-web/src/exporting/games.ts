/** An export for games in one press: levels of detail and views from all sides, packed; how large they are is seen before. */
import type { Engine } from '../worker/engine';
import { type ExportOptions, PLAIN } from './exporting';
import { megabytes, t } from '../text';
import { dialog, download, el, note } from '../page/ui';

/** What engines take: each level a file of its own, the last of them views from all sides. */
const FOR_GAMES: ExportOptions = { ...PLAIN, levels: 3, impostor: true, packed: true };

/** Where the end of a zip says how many files it has and where their list begins, and the fields of a row of that list; bytes. */
const ZIP = { end: 22, count: 10, list: 16, row: 46, size: 24, name: 28, extra: 30, comment: 32 } as const;

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

/** `stem`: of the file's name; `whole`: the scene, else the chosen plant. */
export async function exportForGames(engine: Engine, stem: string, whole: boolean): Promise<void> {
  const body = el('div', {});
  const copies = el('input', { type: 'checkbox', id: 'b-games-copies', onchange: () => void write() });
  const d = dialog(
    t('games.title'),
    el(
      'label',
      { class: 'option', title: t('export.instances.help') },
      el('span', {}, t('export.instances')),
      copies,
    ),
    body,
  );
  d.id = 'b-games';
  const write = async (): Promise<void> => {
    copies.disabled = true;
    body.replaceChildren(el('p', { class: 'muted' }, t('games.working')));
    try {
      const request = { format: 'glb', ...FOR_GAMES, whole, instances: copies.checked } as const;
      const zip = await engine.ask<Uint8Array<ArrayBuffer>>({ kind: 'export', request });
      body.replaceChildren(...written(zip, `${stem}.glb.zip`, () => d.close()));
      copies.disabled = false;
      body.querySelector('button')?.focus();
    } catch (e) {
      d.close();
      note(t('note.refused', { why: (e as Error).message }), 'bad');
    }
  };
  await write();
}

/** The files of a zip, how large they are, and a button that saves them. */
function written(zip: Uint8Array<ArrayBuffer>, name: string, done: () => void): HTMLElement[] {
  const rows = filesOfZip(zip).map(({ name: file, bytes }) =>
    el(
      'tr',
      { 'data-file': file, 'data-bytes': String(bytes) },
      el('th', { scope: 'row' }, file),
      el('td', {}, `${megabytes(bytes)} MB`),
    ),
  );
  const save = el(
    'button',
    {
      type: 'button',
      class: 'primary',
      id: 'b-games-save',
      onclick: () => {
        done();
        download(name, zip, 'application/zip');
        note(t('note.exported', { name }));
      },
    },
    t('games.save', { size: megabytes(zip.byteLength) }),
  );
  return [
    el('div', { class: 'figures' }, el('table', {}, el('tbody', {}, ...rows))),
    el('p', { class: 'muted' }, t('games.hint')),
    el('div', { class: 'row' }, el('span', { class: 'space' }), save),
  ];
}
