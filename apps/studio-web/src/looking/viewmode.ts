/** How the view shows a plant: its surface, the edges of its triangles, or its axes as lines. */
import type { Engine } from '../worker/engine';
import type { PlantView } from '../view/view';

export type ViewMode = 'solid' | 'wire' | 'skeleton';

export class ViewModes {
  mode: ViewMode = 'solid';

  constructor(
    private readonly engine: Engine,
    private readonly view: PlantView | undefined,
    private readonly changed: () => void,
  ) {}

  /** Shows a plant so, or as a surface again. */
  toggle(mode: ViewMode): void {
    this.mode = this.mode === mode ? 'solid' : mode;
    this.view?.setWire(this.mode === 'wire');
    if (this.mode === 'skeleton') this.refresh();
    else this.view?.setSkeleton(undefined);
    this.changed();
  }

  /** The plant changed: its axes are asked for again, if they are shown. */
  refresh(): void {
    if (this.mode !== 'skeleton') return;
    this.engine.ask<Float32Array>({ kind: 'skeleton' }).then(
      (pairs) => {
        if (this.mode === 'skeleton') this.view?.setSkeleton(pairs);
      },
      () => undefined,
    );
  }
}
