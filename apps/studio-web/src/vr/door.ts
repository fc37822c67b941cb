/** The way into a headset, where the browser has one. The rest is loaded only there. */
import type { Shaping } from '../shaping/shaping';
import type { PlantView } from '../view/view';
import type { HeadsetEvents, Mode } from './events';
import type { Headset } from './headset';
import type { Recorder } from './recorder';

export type { Mode };

export class Door {
  /** What the browser offers. */
  modes: readonly Mode[] = [];
  private headset: Headset | undefined;

  constructor(
    private readonly view: PlantView | undefined,
    private readonly shaping: Shaping | undefined,
    private readonly events: HeadsetEvents,
    /** It is known what the browser offers. */
    private readonly known: () => void,
  ) {
    const { xr } = navigator as { xr?: XRSystem };
    if (!xr || !view) return;
    void this.look(xr);
    // A headset was plugged in, or out.
    xr.addEventListener('devicechange', () => void this.look(xr));
  }

  /** What writes down what hands do, once there is a headset. */
  get recorder(): Recorder | undefined {
    return this.headset?.recorder;
  }

  /** The plants were made again, and are seen. */
  seen(): void {
    this.headset?.seen();
  }

  get isOn(): boolean {
    return this.headset?.isOn ?? false;
  }

  /** Goes in, or comes out. */
  async pass(mode: Mode): Promise<void> {
    if (this.isOn) await this.headset?.leave();
    else await (await this.load())?.enter(mode);
  }

  /** Something else is shown, or chosen. */
  renewed(): void {
    this.headset?.renewed();
  }

  private async look(xr: XRSystem): Promise<void> {
    const all: readonly Mode[] = ['immersive-vr', 'immersive-ar'];
    const there = await Promise.all(all.map((m) => xr.isSessionSupported(m).catch(() => false)));
    this.modes = all.filter((_, i) => there[i]);
    // Loaded before it is asked for: a browser lets nobody in who thinks for long.
    if (this.modes.length > 0) await this.load();
    this.known();
  }

  private async load(): Promise<Headset | undefined> {
    const { view, shaping } = this;
    if (!view || !shaping) return undefined;
    const { Headset } = await import('./headset');
    this.headset ??= new Headset(view, shaping, this.events);
    return this.headset;
  }
}
