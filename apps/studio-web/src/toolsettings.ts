/** What the tools of the view are set to, each by itself, and how the core is told. */
import { t } from './text';
import type { ShapeTool } from './tools';
import type { Growth, ToolKind, ViewPlane } from './wire';

/** One step of a number, by a key of the wrist or a notch of the wheel; of the vigour, the share of it. */
const GROWTH_STEPS: Record<keyof Growth, number> = {
  vigour: 0.12,
  apical: 0.04,
  angle_deg: 5,
  lift: 0.04,
  apart: 0.2,
};
/** Within these its numbers are set by hand. */
export const GROWTH = {
  vigour: [0.5, 8],
  apical: [0, 1],
  angle_deg: [15, 110],
  lift: [-0.6, 0.6],
  apart: [0, 4],
} as const satisfies Record<keyof Growth, readonly [number, number]>;

/** None takes over what another was set to. */
export class ToolSettings {
  readonly prune = { whole: false };
  readonly sketch = { twigs: 1, tilt_deg: 0 };
  readonly brush = { share: 0.07, density: 1 };
  silhouette: { density: number; trim: boolean; plane?: ViewPlane } = { density: 1, trim: true };
  readonly leaves = { share: 0.07, more: false };
  readonly grow: Growth = { vigour: 2, apical: 0.54, angle_deg: 55, lift: 0.12, apart: 1 };

  /** The tool as the core knows it. `radius_m`: of the brush. */
  wire(word: ShapeTool | undefined, radius_m: number): ToolKind {
    switch (word) {
      case undefined:
        return 'pick';
      case 'prune':
        return { prune: { ...this.prune } };
      case 'sketch':
        return { sketch: { ...this.sketch } };
      case 'brush':
        return { brush: { radius_m, density: this.brush.density } };
      case 'silhouette':
        return { silhouette: { ...this.silhouette } };
      case 'grow':
        return { grow: { ...this.grow } };
      case 'leaves':
        return { leaves: { radius_m, keep: this.leaves.more ? 2 : 0.25 } };
      default:
        return word;
    }
  }

  /** A number of growth more or less, by so many of its steps. */
  turnGrowth(of: keyof Growth, steps: number): void {
    const { grow } = this;
    const [[low, high], step] = [GROWTH[of], GROWTH_STEPS[of]];
    // Vigour by shares: it counts by how many times more.
    const to = of === 'vigour' ? grow[of] * (1 + step) ** steps : grow[of] + step * steps;
    grow[of] = Math.min(high, Math.max(low, to));
  }

  /** Numbers of growth in words. */
  growthText(...of: (keyof Growth)[]): string {
    const { grow } = this;
    const shown = (key: keyof Growth): string =>
      key === 'angle_deg' ? `${Math.round(grow[key])}°` : String(Math.round(grow[key] * 100) / 100);
    return of.map((key) => `${t(`shape.grow.${key}`)} ${shown(key)}`).join(' · ');
  }
}
