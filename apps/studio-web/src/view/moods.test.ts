import { describe, expect, it } from 'vitest';
import { sheetShape } from '../exporting/film';
import { posesFrom } from './camera';
import { metres, stepFor } from './guides';
import { FIRST, lightOf, OF_PRESET, PRESETS, presetOf, settingFrom, sunAt } from './moods';
import { Pace } from './quality';

describe('the sun', () => {
  it('rises in the east, stands highest in the south at noon, and sets in the west', () => {
    expect(sunAt(6, 0)[0]).toBeGreaterThan(0.5);
    expect(sunAt(18, 0)[0]).toBeLessThan(-0.5);
    const noon = sunAt(12, 0);
    // 48° north at a declination of 18°: the sun stands 60° high.
    expect((Math.asin(noon[1]) * 180) / Math.PI).toBeCloseTo(60, 6);
    expect(noon[0]).toBeCloseTo(0, 12);
    for (let hour = 0; hour <= 24; hour += 0.5) {
      expect(sunAt(hour, 33)[1]).toBeLessThanOrEqual(noon[1] + 1e-12);
      expect(Math.hypot(...sunAt(hour, -70))).toBeCloseTo(1, 12);
    }
  });

  it('turns with the compass', () => {
    const [x, y, z] = sunAt(15, 0);
    const turned = sunAt(15, 90);
    expect(turned[0]).toBeCloseTo(z, 12);
    expect(turned[1]).toBeCloseTo(y, 12);
    expect(turned[2]).toBeCloseTo(-x, 12);
  });

  it('lights from above at every hour, warm when it is low, and the moon takes its place', () => {
    for (const sky of ['clear', 'overcast'] as const)
      for (let hour = 0; hour <= 24; hour += 0.25) {
        const light = lightOf({ sky, hour, turn: 10 });
        expect(light.way[1], `${hour}`).toBeGreaterThan(0);
        expect(light.power).toBeGreaterThan(0);
        expect(light.colour.every((c) => c >= 0 && c <= 1)).toBe(true);
      }
    const [low, high] = [lightOf(OF_PRESET.golden), lightOf(OF_PRESET.noon)];
    expect(low.colour[0] / low.colour[2]).toBeGreaterThan(1.5 * (high.colour[0] / high.colour[2]));
    expect(lightOf(OF_PRESET.night).night).toBe(1);
    expect(high.night).toBe(0);
  });
});

describe('what is kept', () => {
  it('is read as it was written', () => {
    for (const preset of PRESETS) {
      const setting = { ...FIRST, ...OF_PRESET[preset] };
      expect(settingFrom(JSON.parse(JSON.stringify(setting)))).toEqual(setting);
      expect(presetOf(setting)).toBe(preset);
    }
    expect(presetOf({ ...FIRST, hour: 3 })).toBeUndefined();
  });

  it('is mended where it cannot be used', () => {
    for (const bad of [null, 3, 'x', [], { sky: 'green', hour: 'noon', colour: 'red', fog: Number.NaN }])
      expect(settingFrom(bad)).toEqual(FIRST);
    expect(settingFrom({ hour: 99, fog: -1 })).toMatchObject({ hour: 24, fog: 0 });
    const pose = { position: [1, 2, 3], target: [0, 0, 0], lens: 32 };
    expect(posesFrom([pose, null, { position: [1] }, { ...pose, target: [1e9, 0, 0] }])).toEqual([pose]);
    expect(posesFrom('no')).toEqual([]);
  });
});

describe('measures', () => {
  it('are divided by 1, 2 or 5', () => {
    for (const length of [0.003, 0.07, 0.31, 1, 4.2, 23, 110])
      for (const most of [4, 8]) {
        const step = stepFor(length, most);
        expect(length / step).toBeLessThanOrEqual(most + 1e-9);
        expect(length / step).toBeGreaterThan(most / 2.6);
        expect(['1', '2', '5']).toContain(step.toExponential(3)[0]);
      }
  });

  it('are written as people write them', () => {
    expect([0, 0.004, 0.25, 1, 17.5].map(metres)).toEqual(['0', '4 mm', '25 cm', '1 m', '17.5 m']);
  });
});

describe('a sheet of frames', () => {
  it('is nearly square and holds every frame', () => {
    for (let n = 1; n <= 64; n += 1) {
      const [columns, rows] = sheetShape(n);
      expect(columns * rows).toBeGreaterThanOrEqual(n);
      expect((rows - 1) * columns).toBeLessThan(n);
      expect(columns - rows).toBeLessThanOrEqual(1);
    }
  });
});

describe('a machine', () => {
  const judged = (apart: number): boolean => {
    const pace = new Pace();
    return Array.from({ length: 40 }, (_, i) => pace.drew(i * apart)).some(Boolean);
  };

  it('is too slow only if pictures in a row are', () => {
    expect(judged(16)).toBe(false);
    expect(judged(120)).toBe(true);
    expect(judged(900)).toBe(false);
  });
});
