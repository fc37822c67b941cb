/** What the tools of the view are set to, each by itself, and how the core is told. */
import { tOf } from './text';
import { isBrush, isNumber, type NumberSetting, rowOf, SHAPE_WORDS, type ShapeTool } from './tools';
import type { ToolKind, ViewPlane } from './wire';

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

  /** A number more or less, by so many of its notches. */
  turn(word: ShapeTool, name: string, notches: number): void {
    const { notch = 0 } = rowOf(word).settings[name] as NumberSetting;
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

  /** Numbers in words. */
  text(word: ShapeTool, size: number, ...names: string[]): string {
    return names.map((name) => `${tOf('shape.set', name)} ${this.shown(word, size, name)}`).join(' · ');
  }
}
