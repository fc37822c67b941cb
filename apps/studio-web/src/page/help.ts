/** The dialog that says how the page is used, with the sheet of keys. */
import { keySheet } from './commands';
import { areNamesShown, toggleNames } from './names';
import { t } from '../text';
import { tour } from './tour';
import { dialog, el } from './ui';

export function openHelp(): void {
  const keys = el('dl', { class: 'keys' });
  for (const row of keySheet()) keys.append(el('dt', {}, el('kbd', {}, row.keys)), el('dd', {}, t(row.text)));
  const texts = (
    ['help.draw', 'help.pan', 'help.hold', 'help.taps', 'help.correct', 'help.shape', 'help.drop'] as const
  ).map((k) => el('li', {}, t(k)));
  const again = el(
    'button',
    {
      type: 'button',
      class: 'link',
      onclick: () => {
        d.close();
        tour();
      },
    },
    t('tour.again'),
  );
  const sayNames = (): string => t(areNamesShown() ? 'act.names.hide' : 'act.names.show');
  const names = el(
    'button',
    {
      type: 'button',
      class: 'link',
      id: 'b-names',
      onclick: () => {
        toggleNames();
        names.textContent = sayNames();
      },
    },
    sayNames(),
  );
  const d = dialog(t('dialog.help'), el('ul', {}, ...texts), keys, el('p', { class: 'row' }, again, names));
}
