/** What the tools of the view are set to, each by itself, and how the core is told. */
import { t, type TextKey, tOf } from '../text';
import { isBrush, isChoice, isNumber, type NumberSetting, rowOf, SHAPE_WORDS, type ShapeTool } from './tools';
import type { ToolKind, ViewPlane } from '../wire';

type Values = Record<string, number | boolean>;

/** To hundredths. */
const rounded = (x: number): string => String(Math.round(x * 100) / 100);

/** None takes over what another was set to. */
export class ToolSettings {
  /** Where outlines are drawn, if that was placed in space. */
  plane: ViewPlane | undefined;
  private readonly values = new Map<ShapeTool, Values>(
    SHAPE_WORDS.map((word) => [
      word,
      Object.fromEntries(Object.entries(rowOf(word).settings).map(([name, { is }]) => [name, is])),
    ]),
  );

  of(word: ShapeTool): Values {
    return this.values.get(word)!;
  }

  set(word: ShapeTool, name: string, value: number | boolean): void {
    const s = rowOf(word).settings[name]!;
    this.of(word)[name] =
      isNumber(s) && typeof value === 'number' ? Math.min(s.high, Math.max(s.low, value)) : value;
  }

  /** The radius of a brush, metres of a plant that is so large; of the brush of branches, where the tool is none. */
  radius(word: ShapeTool | undefined, size: number): number {
    return Number(this.of(word && isBrush(word) ? word : 'brush')['radius_m']) * size;
  }

  /** What a tool is set to as the core knows it, on a plant of this size, metres. */
  fields(word: ShapeTool, size: number): Values {
    return Object.fromEntries(
      Object.entries(this.of(word)).map(([name, value]) => {
        const s = rowOf(word).settings[name]!;
        return [name, isNumber(s) && s.ofPlant ? Number(value) * size : value];
      }),
    );
  }

  /** The tool as the core knows it. */
  wire(word: ShapeTool, size: number): ToolKind {
    const fields = this.fields(word, size);
    if (Object.keys(fields).length === 0) return word as ToolKind;
    const placed = rowOf(word).trace === 'outline' && this.plane ? { plane: this.plane } : {};
    return { [word]: { ...fields, ...placed } } as unknown as ToolKind;
  }

  /** A number more or less, by so many of its notches; a choice or a switch is turned to its other value. */
  turn(word: ShapeTool, name: string, notches: number): void {
    const setting = rowOf(word).settings[name]!;
    if (!isNumber(setting)) {
      const values = isChoice(setting) ? Object.values(setting.words) : [false, true];
      const next = (values.indexOf(this.of(word)[name]!) + 1) % values.length;
      this.set(word, name, values[next]!);
      return;
    }
    const { notch = 0 } = setting;
    const now = Number(this.of(word)[name]);
    this.set(
      word,
      name,
      typeof notch === 'number' ? now + notch * notches : now * (1 + notch.share) ** notches,
    );
  }

  /** A number with its unit, on a plant of this size, metres. */
  shown(word: ShapeTool, size: number, name: string): string {
    const { ofPlant, unit = '' } = rowOf(word).settings[name] as NumberSetting;
    const value = Number(this.of(word)[name]);
    return ofPlant ? `${rounded(value * size)} m` : `${rounded(value)}${unit}`;
  }

  /** Settings in words. */
  text(word: ShapeTool, size: number, ...names: string[]): string {
    const now = this.of(word);
    const said = (name: string): string => {
      const setting = rowOf(word).settings[name]!;
      if (isNumber(setting)) return `${tOf('shape.set', name)} ${this.shown(word, size, name)}`;
      if (!isChoice(setting))
        return `${t(`shape.${word}.${setting.word}` as TextKey)} ${now[name] ? '✓' : '–'}`;
      const chosen = Object.keys(setting.words).find((w) => setting.words[w] === now[name]);
      return t(`shape.${word}.${chosen}` as TextKey);
    };
    return names.map(said).join(' · ');
  }
}
