/** How often a picture is asked whether it is done, and how long at most, milliseconds. */
const [ASK_MS, MOST_MS] = [8, 4000];

/**
 * Pictures that the processor draws. A page waits for a canvas that is drawn on and stands on it; so these are drawn on one
 * that does not stand there, and copied to one that does when they are done. Until then the page listens to the pen.
 */
export class Easel {
  /** Stands on the page. */
  readonly canvas = document.createElement('canvas');
  private readonly pen = this.canvas.getContext('2d');
  private asked = 0;

  /** `gl`: draws, and keeps what it drew. */
  constructor(private readonly gl: WebGL2RenderingContext) {}

  /** Shows what was asked to be drawn just now, as soon as it is; the end of a picture that another has followed shows nothing. */
  show(): Promise<void> {
    const { gl } = this;
    this.asked += 1;
    const picture = this.asked;
    const start = performance.now();
    const drawn = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return new Promise((resolve) => {
      const look = (): void => {
        const waits = drawn && gl.clientWaitSync(drawn, 0, 0) === gl.TIMEOUT_EXPIRED;
        if (waits && performance.now() - start < MOST_MS) {
          window.setTimeout(look, ASK_MS);
          return;
        }
        gl.deleteSync(drawn);
        if (picture === this.asked) this.copy();
        resolve();
      };
      window.setTimeout(look, ASK_MS);
    });
  }

  /** What is being drawn is not shown: it is cut off. */
  discard(): void {
    this.asked += 1;
  }

  private copy(): void {
    const { width, height } = this.gl.canvas;
    const { canvas, pen } = this;
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    else pen?.clearRect(0, 0, width, height);
    pen?.drawImage(this.gl.canvas, 0, 0);
  }
}
