/** What the stage is set to, and the light that follows from it. Numbers only: nothing here is drawn. */

export const PRESETS = ['studio', 'noon', 'golden', 'overcast', 'night'] as const;
export type Preset = (typeof PRESETS)[number];
export const SKIES = ['studio', 'clear', 'overcast'] as const;
export const GROUNDS = ['plain', 'grass', 'soil', 'none'] as const;
export type GroundKind = (typeof GROUNDS)[number];
export const BACKGROUNDS = ['sky', 'colour', 'picture'] as const;
export const QUALITIES = ['auto', 'fast', 'fine'] as const;
export type Quality = (typeof QUALITIES)[number];

export interface StageSetting {
  sky: (typeof SKIES)[number];
  /** Time of day, hours; the sun stands highest at 12. */
  hour: number;
  /** Turns the compass about the plant, degrees. */
  turn: number;
  ground: GroundKind;
  /** 0 to 1. */
  fog: number;
  /** Depth of field, 0 to 1. */
  blur: number;
  background: (typeof BACKGROUNDS)[number];
  /** Of the background, `#rrggbb`. */
  colour: string;
  quality: Quality;
}

/** What a preset decides; the rest stays as the person set it. */
export const OF_PRESET: Record<Preset, Pick<StageSetting, 'sky' | 'hour' | 'turn' | 'ground' | 'fog'>> = {
  studio: { sky: 'studio', hour: 10, turn: 0, ground: 'plain', fog: 0 },
  noon: { sky: 'clear', hour: 12.5, turn: 35, ground: 'grass', fog: 0 },
  golden: { sky: 'clear', hour: 18.5, turn: 48, ground: 'grass', fog: 0.12 },
  overcast: { sky: 'overcast', hour: 11, turn: 0, ground: 'grass', fog: 0.18 },
  night: { sky: 'clear', hour: 23, turn: 0, ground: 'grass', fog: 0.1 },
};

export const FIRST: StageSetting = {
  ...OF_PRESET.studio,
  blur: 0,
  background: 'sky',
  colour: '#e9e6dc',
  quality: 'auto',
};

/** The preset that these settings are, if they are one. */
export function presetOf(setting: StageSetting): Preset | undefined {
  return PRESETS.find((p) =>
    Object.entries(OF_PRESET[p]).every(([key, value]) => setting[key as keyof StageSetting] === value),
  );
}

/** What was kept, as far as it can be used; the rest is as at first. */
export function settingFrom(kept: unknown): StageSetting {
  const known = (typeof kept === 'object' && kept !== null ? kept : {}) as Record<string, unknown>;
  const word = <T extends string>(key: string, words: readonly T[], else_: T): T =>
    words.find((w) => w === known[key]) ?? else_;
  const number = (key: string, low: number, high: number, else_: number): number => {
    const n = known[key];
    return typeof n === 'number' && Number.isFinite(n) ? Math.min(high, Math.max(low, n)) : else_;
  };
  const { colour } = known;
  return {
    sky: word('sky', SKIES, FIRST.sky),
    hour: number('hour', 0, 24, FIRST.hour),
    turn: number('turn', -180, 180, FIRST.turn),
    ground: word('ground', GROUNDS, FIRST.ground),
    fog: number('fog', 0, 1, FIRST.fog),
    blur: number('blur', 0, 1, FIRST.blur),
    background: word('background', BACKGROUNDS, FIRST.background),
    colour: typeof colour === 'string' && /^#[0-9a-f]{6}$/i.test(colour) ? colour : FIRST.colour,
    quality: word('quality', QUALITIES, FIRST.quality),
  };
}

export type Vec3 = readonly [number, number, number];

/** Where the days are spent: 48° north, in May. */
const LATITUDE = (48 * Math.PI) / 180;
const DECLINATION = (18 * Math.PI) / 180;

/** The way to the sun: x right, y up, z towards the first camera. South is behind the camera, so noon lights the plant. */
export function sunAt(hour: number, turnDeg: number): Vec3 {
  const angle = ((hour - 12) / 12) * Math.PI;
  const [sl, cl, sd, cd] = [
    Math.sin(LATITUDE),
    Math.cos(LATITUDE),
    Math.sin(DECLINATION),
    Math.cos(DECLINATION),
  ];
  const up = sl * sd + cl * cd * Math.cos(angle);
  const west = cd * Math.sin(angle);
  const south = sl * cd * Math.cos(angle) - cl * sd;
  const turn = (turnDeg * Math.PI) / 180;
  const [c, s] = [Math.cos(turn), Math.sin(turn)];
  return [-west * c + south * s, up, west * s + south * c];
}

export interface Light {
  /** To the sun, or to the moon by night; never below the horizon. */
  readonly way: Vec3;
  /** To the sun, wherever it is. */
  readonly sun: Vec3;
  /** Linear red, green, blue. */
  readonly colour: Vec3;
  readonly power: number;
  /** How much darker than lit ground its shadow is drawn, 0 to 1. */
  readonly shade: number;
  /** How strongly the sky lights. */
  readonly ambient: number;
  /** 0 by day, 1 by night. */
  readonly night: number;
  readonly exposure: number;
}

/** Colour and power of the light by the sun's height above the horizon, degrees. */
const KEYS: readonly (readonly [at: number, colour: Vec3, power: number, ambient: number])[] = [
  [-10, [0.62, 0.74, 1], 1.1, 6],
  [-5, [0.6, 0.65, 0.95], 0.5, 4],
  [0, [1, 0.42, 0.16], 1, 1.6],
  [5, [1, 0.55, 0.26], 5.4, 2.1],
  [14, [1, 0.74, 0.48], 4.4, 1.05],
  [30, [1, 0.9, 0.76], 3.3, 1.05],
  [60, [1, 0.95, 0.87], 3.1, 1],
];

const mix = (a: number, b: number, t: number): number => a + (b - a) * t;
/** Below this height of the sun, degrees, the moon lights instead. */
const MOONRISE = -5;
/** The moon's height where it stands, so that night has shadows of a good length. */
const MOON_UP = 0.62;

export function lightOf(setting: Pick<StageSetting, 'sky' | 'hour' | 'turn'>): Light {
  const sun = sunAt(setting.hour, setting.turn);
  const height = (Math.asin(Math.min(1, Math.max(-1, sun[1]))) * 180) / Math.PI;
  const next = KEYS.findIndex(([at]) => at >= height);
  const high = KEYS[next === -1 ? KEYS.length - 1 : next]!;
  const low = KEYS[next === -1 ? KEYS.length - 1 : Math.max(0, next - 1)]!;
  const t = high[0] === low[0] ? 0 : (height - low[0]) / (high[0] - low[0]);
  const colour = [0, 1, 2].map((i) => mix(low[1][i]!, high[1][i]!, t)) as unknown as Vec3;
  const night = Math.min(1, Math.max(0, (0 - height) / 8));
  const moon = height < MOONRISE;
  const flat = Math.hypot(sun[0], sun[2]) || 1;
  // The moon stands on the viewer's side, over the left shoulder, whatever the hour: what it lights is seen.
  const turn = (setting.turn * Math.PI) / 180;
  const moonWay: Vec3 = [
    -0.55 * Math.cos(turn) + 0.55 * Math.sin(turn),
    MOON_UP,
    0.55 * Math.sin(turn) + 0.55 * Math.cos(turn),
  ];
  const up = Math.max(sun[1], 0.06);
  const side = Math.sqrt(1 - up * up) / flat;
  const way: Vec3 = moon ? moonWay : [sun[0] * side, up, sun[2] * side];
  const overcast = setting.sky === 'overcast';
  const day = 1 - night;
  return {
    way: overcast ? [way[0] * 0.35, 1, way[2] * 0.35] : way,
    sun,
    colour: overcast ? [0.95, 0.98, 1] : colour,
    power: mix(low[2], high[2], t) * (overcast ? 0.3 : 1),
    shade: overcast ? 0.5 : 1,
    ambient: overcast ? mix(1.35, 6, night) : mix(low[3], high[3], t),
    night,
    exposure: 1.08 * mix(1.05, 1, day),
  };
}
