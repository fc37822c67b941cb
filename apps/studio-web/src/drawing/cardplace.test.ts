import { describe, expect, it } from 'vitest';
import { cardBeside } from './cardplace';
import type { Frame } from '../sheet/frame';

const ROOM: Frame = { left: 88, right: 590, top: 10, bottom: 590 };
const CARD = { width: 308, height: 300 };
const nowhere = (): number => 0;

describe('the card of a selection', () => {
  it('stands beside the strokes, right or left', () => {
    const frame = { left: 100, right: 200, top: 200, bottom: 300 };
    expect(cardBeside({ frame, covered: nowhere }, CARD, ROOM)).toEqual({ left: 214, top: 100 });
    const right = { left: 450, right: 560, top: 0, bottom: 20 };
    expect(cardBeside({ frame: right, covered: nowhere }, CARD, ROOM)).toEqual({ left: 128, top: 10 });
  });

  it('stands above or below strokes that are wide', () => {
    const frame = { left: 100, right: 560, top: 30, bottom: 100 };
    expect(cardBeside({ frame, covered: nowhere }, CARD, ROOM)).toEqual({ left: 176, top: 114 });
    const low = { left: 100, right: 560, top: 500, bottom: 590 };
    expect(cardBeside({ frame: low, covered: nowhere }, CARD, ROOM)).toEqual({ left: 176, top: 186 });
  });

  it('takes the corner that a slanting stroke leaves free', () => {
    const frame = { left: 90, right: 580, top: 20, bottom: 580 };
    // From the lower left to the upper right.
    const covered = ({ left, top, right, bottom }: Frame): number =>
      [...Array(99).keys()].filter((i) => {
        const [x, y] = [90 + 4.9 * i, 580 - 5.6 * i];
        return x > left && x < right && y > top && y < bottom;
      }).length;
    const free = cardBeside({ frame, covered }, { width: 200, height: 200 }, ROOM)!;
    expect(free).toEqual({ left: 390, top: 390 });
    expect(cardBeside({ frame, covered }, { width: 480, height: 300 }, ROOM)).toBeUndefined();
  });

  it('has no place on a sheet that is smaller', () => {
    const frame = { left: 20, right: 40, top: 20, bottom: 40 };
    expect(cardBeside({ frame, covered: nowhere }, CARD, { ...ROOM, right: 300 })).toBeUndefined();
  });
});
