import { describe, expect, it } from 'vitest';
import { decode, encode, MAX_LINK } from './share';

describe('links', () => {
  it('bring back every byte', () => {
    for (let n = 0; n < 600; n += 7) {
      const bytes = Uint8Array.from({ length: n + 1 }, (_, i) => (i * 37 + n) & 255);
      expect(decode(`#d=${encode(bytes)}`)).toEqual(bytes);
    }
  });

  it('are refused when they cannot be ours', () => {
    for (const hash of [
      '',
      '#',
      '#d=',
      '#d=a b',
      '#d=%00',
      '#d=<script>',
      '#x=abcd',
      `#d=${'A'.repeat(MAX_LINK + 1)}`,
      '#d=A',
    ]) {
      expect(decode(hash), hash.slice(0, 20)).toBeUndefined();
    }
  });
});
