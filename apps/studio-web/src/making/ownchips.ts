/** Presets of a person's own, as they stand in a panel: taken by a click, given away as a file, dropped. */
import { safe } from '../keeping/files';
import type { Fields } from './form';
import { asToml, dropPreset, hasFile, keepPreset, type OwnPreset, ownPresets } from './own';
import { t } from '../text';
import { askName, button, download, el, note } from '../page/ui';
import type { MakerWord } from '../wire';

export interface OwnEvents {
  readonly maker: MakerWord;
  /** The plant as it is. */
  now(): { name: string; spec: Fields };
  take(spec: Fields): void;
  /** Shows the panel anew. */
  renew(): void;
}

export function ownChips(events: OwnEvents): HTMLElement {
  const { maker, renew } = events;
  /** Says what was done, and brings the preset back as it was. */
  const undoable = (done: string, preset: OwnPreset): void => {
    const act = (): void => {
      if (!keepPreset(preset)) note(t('own.full'), 'bad');
      renew();
    };
    note(done, 'good', { label: t('undo'), act });
  };
  const keep = (): void => {
    const { spec, name: own } = events.now();
    askName(t('own.keep'), t('own.name'), own, (name) => {
      const before = ownPresets(maker).find((p) => p.name === name);
      if (!keepPreset({ maker, name, spec })) {
        note(t('own.full'), 'bad');
        return;
      }
      renew();
      if (before) undoable(t('own.replaced', { name }), before);
    });
  };
  const chips = ownPresets(maker).map((preset) => {
    const { name, spec } = preset;
    const take = el(
      'button',
      { type: 'button', class: 'chip', 'data-own': name, onclick: () => events.take(spec) },
      name,
    );
    const give = button('export', t('own.give', { name }), () => {
      const saved = asToml(preset).then((text) => download(`${safe(name)}.toml`, text, 'application/toml'));
      saved.catch((e: Error) => note(t('note.refused', { why: e.message }), 'bad'));
    });
    const drop = button('close', t('own.drop', { name }), () => {
      dropPreset(preset);
      renew();
      undoable(t('own.dropped', { name }), preset);
    });
    return el('span', { class: 'own' }, take, ...(hasFile(maker) ? [give] : []), drop);
  });
  const more = el(
    'button',
    { type: 'button', class: 'chip', id: 'b-own-keep', onclick: keep },
    t('own.keep'),
  );
  return el('div', { class: 'chips' }, ...chips, more);
}
