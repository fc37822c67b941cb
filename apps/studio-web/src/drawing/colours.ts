/** Colours of strokes by what they were understood as, on light and on dark paper: each at least 3:1 against it. */
export interface Ink {
  light: string;
  dark: string;
}

const INKS: Record<string, Ink> = {
  petal: { light: '#c2356f', dark: '#ff8fb8' },
  leaf: { light: '#2f7d3c', dark: '#7fd08a' },
  branch: { light: '#7a4f26', dark: '#d9a878' },
  trunk: { light: '#5a3a1c', dark: '#c79a6c' },
  twig_contour: { light: '#0f766e', dark: '#5fd3c7' },
  leaf_contour: { light: '#5b7d12', dark: '#b9db62' },
  vein: { light: '#4e8f6a', dark: '#a7e0bd' },
  disc: { light: '#a66300', dark: '#ffc766' },
  fruit: { light: '#b3261e', dark: '#ff9a8f' },
  thorn: { light: '#6b5b95', dark: '#c5b5f0' },
  root: { light: '#8a6d3b', dark: '#e0c48f' },
  stamen: { light: '#8f6a00', dark: '#f3dc7a' },
  pot: { light: '#a04a2a', dark: '#f0a884' },
  ignored: { light: '#7b8088', dark: '#9aa1ab' },
};

const UNREAD: Ink = { light: '#2c3e36', dark: '#e6eee8' };

export function inkOf(organ: string | undefined, dark: boolean): string {
  const ink = (organ !== undefined && INKS[organ]) || UNREAD;
  return dark ? ink.dark : ink.light;
}

export const ORGANS = Object.keys(INKS);

/** A colour as the browser writes it, of shares of light (IEC 61966-2-1). */
export function hexOfLinear(shares: readonly number[]): string {
  const byte = (x: number): number =>
    Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
  return `#${shares
    .map((x) =>
      byte(Math.min(1, Math.max(0, x)))
        .toString(16)
        .padStart(2, '0'),
    )
    .join('')}`;
}

/** Shares of light of a colour as the browser writes it. */
export function linearOf(hex: string): number[] {
  const share = (x: number): number => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
  return [1, 3, 5].map((at) =>
    Number(share(Number.parseInt(hex.slice(at, at + 2), 16) / 255).toPrecision(4)),
  );
}
