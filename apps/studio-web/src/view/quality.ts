/** What draws, and how much may be asked of it. */

/** Without a graphics card everything is drawn by the processor: then less is asked of it. Throws without WebGL 2. */
export function drawnBySoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) throw new Error('no WebGL 2');
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/** Pictures that follow one another this far apart, milliseconds, are too slow to turn a plant by. */
const TOO_SLOW = 45;
/** So many in a row decide. */
const JUDGED = 16;

/** Times pictures that follow one another, and says once that they are too slow. */
export class Pace {
  private readonly times: number[] = [];
  private last = -Infinity;

  /** A picture was drawn at `now`; true if the machine is too slow for what is asked of it. */
  drew(now: number): boolean {
    const apart = now - this.last;
    this.last = now;
    // A pause is no slow picture.
    if (apart > 500) {
      this.times.length = 0;
      return false;
    }
    this.times.push(apart);
    if (this.times.length < JUDGED) return false;
    const middle = [...this.times].sort((a, b) => a - b)[JUDGED >> 1]!;
    this.times.length = 0;
    return middle > TOO_SLOW;
  }
}
