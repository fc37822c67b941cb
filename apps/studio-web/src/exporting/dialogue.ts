/** The export dialogue: for what program, which format, how fine. */
import { dialog, el } from '../page/ui';
import { helpOf, t } from '../text';
import { type EngineAnswer, type EngineAsk, ENGINES, type MakerWord } from '../wire';
import {
  aboutOf,
  choice,
  DRAWINGS,
  type ExportOptions,
  FORMATS,
  holds,
  isModel,
  levelRows,
  nameOf,
  type OptionKey,
  type Target,
  tick,
} from './exporting';
import {
  ForProgram,
  isGiven,
  keepChoice,
  lastChoice,
  nameOfProgram,
  type Program,
  PROGRAMS,
} from './programs';

/** What the dialogue of the export asks of the page. */
export interface ExportDeeds {
  /** Writes it. `said`: what a program was given besides. */
  write(format: Target, options: ExportOptions, said: string): void;
  look(): void;
  games(whole: boolean): void;
  /** What a program wants of an export. */
  settle(ask: EngineAsk): Promise<EngineAnswer>;
}

/** `several`: there is a scene to choose; `kind`: the maker of the plant that is chosen. */
export function openExport(several: boolean, kind: MakerWord, deeds: ExportDeeds): void {
  new ExportDialogue(several, kind, deeds).open();
}

class ExportDialogue {
  private format: Target;
  private readonly options: ExportOptions;
  private readonly offered: readonly Target[];
  private readonly program: ForProgram;
  private readonly radios: readonly HTMLInputElement[];
  private readonly what: HTMLLabelElement;
  private readonly up: HTMLLabelElement;
  private readonly unit: HTMLLabelElement;
  private readonly wind: HTMLLabelElement;
  private readonly fine: ReturnType<typeof levelRows>;
  private readonly about = el('p', { class: 'muted', id: 'b-export-about' });
  private readonly said = el('p', { id: 'b-export-set', role: 'status' });
  /** First the view, then the file. */
  private readonly see: HTMLButtonElement;
  private readonly play: HTMLButtonElement;
  private dialog: HTMLDialogElement | undefined;

  constructor(
    private readonly several: boolean,
    kind: MakerWord,
    private readonly deeds: ExportDeeds,
  ) {
    const { format, options, asked } = lastChoice();
    this.options = { ...options, whole: several };
    this.offered = FORMATS.filter((f) => !DRAWINGS.includes(f) || kind === 'sketch');
    this.format = this.offered.includes(format) ? format : 'glb';
    this.program = new ForProgram(this.options, { ...asked }, deeds.settle, () => this.show());
    const changed = (key: OptionKey): void => this.program.ask(key, this.format);
    this.radios = this.offered.map((f) => this.radioOf(f));
    this.what = choice(
      'export.what',
      [
        ['scene', t('export.what.scene')],
        ['plant', t('export.what.plant')],
      ],
      'scene',
      (v) => {
        this.options.whole = v === 'scene';
      },
      'b-what',
    );
    this.up = this.axisRow('up', { y: '+Y', z: '+Z' });
    this.unit = this.axisRow('unit', { m: 'm', cm: 'cm', mm: 'mm' });
    this.fine = levelRows(this.options, changed, 'b-');
    this.wind = tick(this.options, 'wind', changed, 'b-');
    this.see = this.button('link', 'b-export-look', t('exported.title'), () => {
      this.keep();
      deeds.look();
    });
    this.play = this.button('chip', 'b-export-games', t('games.title'), () =>
      deeds.games(this.options.whole),
    );
  }

  /** What is written: a print is of one plant. */
  private get wanted(): ExportOptions {
    return { ...this.options, whole: this.options.whole && this.options.engine !== 'print' };
  }

  private keep(): void {
    keepChoice(this.format, this.wanted, this.program.asked);
  }

  /** A button that closes the dialogue. */
  private button(kind: string, id: string, text: string, act: () => void): HTMLButtonElement {
    const onclick = (): void => {
      act();
      this.dialog?.close();
    };
    return el('button', { type: 'button', class: kind, id, onclick }, text);
  }

  private goalRow(): HTMLLabelElement {
    const words: [Program | '', string][] = PROGRAMS.map((p) => [p, nameOfProgram(p)]);
    return choice(
      'export.for',
      [['', t('engine.any')], ...words],
      this.options.engine ?? '',
      (word) => {
        const chosen = word === '' ? null : word;
        if (chosen && !isGiven(chosen, this.format))
          this.format = this.offered.find((f) => isGiven(chosen, f)) ?? this.format;
        this.program.choose(chosen, this.format);
      },
      'b-for',
    );
  }

  private axisRow<K extends 'up' | 'unit'>(key: K, labels: Record<string, string>): HTMLLabelElement {
    return choice(
      `export.${key}`,
      Object.entries(labels),
      this.options[key],
      (word) => {
        this.options[key] = word as ExportOptions[K];
        this.program.ask(key, this.format);
      },
      `b-${key}`,
    );
  }

  private radioOf(format: Target): HTMLInputElement {
    return el('input', {
      type: 'radio',
      name: 'format',
      value: format,
      'data-format': format,
      onchange: () => {
        this.format = format;
        this.program.renew(format);
      },
    });
  }

  private formatList(): HTMLElement {
    const row = (radio: HTMLInputElement): HTMLElement => {
      const format = radio.value as Target;
      const about = el('span', { class: 'muted' }, aboutOf(format));
      return el('label', { class: 'format' }, radio, el('b', {}, nameOf(format)), about);
    };
    const label = { role: 'radiogroup', 'aria-label': t('menu.export') };
    return el('div', { class: 'formats', ...label }, ...this.radios.map(row));
  }

  private show(): void {
    const { format, options, program } = this;
    const { engine } = options;
    for (const radio of this.radios) {
      const own = radio.value as Target;
      radio.checked = own === format;
      radio.parentElement!.hidden = engine !== null && !isGiven(engine, own);
    }
    this.see.hidden = !isModel(format);
    this.play.hidden = engine !== null;
    // A print is one body.
    this.what.hidden = !this.several || engine === 'print';
    this.up.hidden = this.unit.hidden = !holds(format, 'axes');
    this.up.querySelector('select')!.value = options.up;
    this.unit.querySelector('select')!.value = options.unit;
    this.wind.hidden = !holds(format, 'wind') || options.instances;
    this.wind.querySelector('input')!.checked = options.wind;
    this.fine.show(format);
    this.about.hidden = engine === null;
    this.about.textContent = engine === null ? '' : helpOf(`engine.${engine}`, ENGINES[engine].about);
    this.said.hidden = program.said === '';
    this.said.textContent = program.said;
  }

  open(): void {
    const go = el('button', { type: 'submit', class: 'primary', id: 'b-export-go' }, t('menu.export'));
    const onsubmit = (e: Event): void => {
      e.preventDefault();
      void this.program.pending.then(() => {
        this.keep();
        this.dialog?.close();
        this.deeds.write(this.format, this.wanted, this.program.said);
      });
    };
    const form = el(
      'form',
      { class: 'export', onsubmit },
      this.goalRow(),
      this.about,
      this.formatList(),
      this.what,
      ...this.fine.rows,
      this.wind,
      this.up,
      this.unit,
      this.said,
      el('p', { class: 'muted' }, t('export.note')),
      el('div', { class: 'row' }, this.see, this.play, el('span', { class: 'space' }), go),
    );
    this.dialog = dialog(t('export.title'), form);
    this.program.renew(this.format);
    this.radios.find((radio) => radio.checked)?.focus();
  }
}
