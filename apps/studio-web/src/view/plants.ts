/** The plants of the scene as they are shown: their meshes, where they stand, and what stands in their place. */
import * as THREE from 'three';
import { texturesOf, type Sent } from '../worker/protocol';
import type { PlantState, PlantView as Seen, SceneView } from '../wire';
import { Crowd } from './crowd';
import { fillShapes, type Looks, PlantMeshes, type Shapes } from './plant';
import { SharedShapes } from './shapes';

/** Meshes in the place of the plants, by the plants' names. */
export interface StandIn {
  readonly groups: ReadonlyMap<number, THREE.Group>;
  /** All plants as one thing, in the coordinates of the scene. */
  readonly whole: THREE.Group | undefined;
  /** It is drawn again and again. */
  readonly moves: boolean;
  tick(seconds: number): void;
  /** Takes its materials anew. */
  relook(): void;
  dispose(): void;
}

/** How they are shown. */
export interface Shown {
  /** As they were drawn. */
  front: boolean;
  /** The chosen plant as lines. */
  boned: boolean;
}

export class Plants {
  readonly named = new Map<number, PlantMeshes>();
  private readonly shapes = new SharedShapes();
  private readonly crowd: Crowd;
  /** A model that is viewed instead of the scene. */
  guest: PlantMeshes | undefined;
  standIn: StandIn | undefined;
  private states: PlantState[] = [];
  current: number | null = null;
  /** Those that a hand moves, while it does. */
  held: ReadonlySet<number> = new Set();

  /** `holder`: holds what is shown of them. */
  constructor(
    private readonly looks: Looks,
    private readonly holder: THREE.Group,
  ) {
    this.crowd = new Crowd(holder);
  }

  get chosen(): PlantMeshes | undefined {
    return this.guest ?? (this.current === null ? undefined : this.named.get(this.current));
  }

  get all(): PlantMeshes[] {
    return [...this.named.values(), ...(this.guest ? [this.guest] : [])];
  }

  /** Of the chosen plant. */
  get state(): PlantState | undefined {
    return this.current === null ? undefined : this.stateOf(this.current);
  }

  stateOf(plant: number): PlantState | undefined {
    return this.states.find((s) => s.id === plant);
  }

  /** How wide it is seen from above, metres; 0 before it is made. */
  widthOf(plant: number): number {
    const seen = this.named.get(plant)?.view;
    if (!seen || seen.parts.length === 0) return 0;
    const wide = Math.max(seen.max[0] - seen.min[0], seen.max[2] - seen.min[2]);
    return wide * (this.stateOf(plant)?.scale ?? 1);
  }

  setStates(states: PlantState[], current: number | null): void {
    [this.states, this.current] = [states, current];
  }

  /** Where the only plant stands: x and z. */
  get only(): [number, number] {
    const [x, , z] = this.states[0]?.position ?? [0, 0, 0];
    return [x, z];
  }

  /** A new worker names meshes anew. */
  forget(): void {
    this.shapes.clear();
  }

  update(view: SceneView, fresh: Sent[]): void {
    this.looks.keep(texturesOf(view.guest ? [view.guest, ...view.plants] : view.plants));
    for (const { textures } of fresh) for (const texture of textures) this.looks.addTexture(texture);
    const meshes = new Map(fresh.map((sent) => [sent.view.id, sent]));
    const before = new Set(this.all.map((p) => p.shapes));
    const take = (known: PlantMeshes | undefined, seen: Seen): PlantMeshes => {
      const plant = known ?? new PlantMeshes(this.looks);
      if (!known) this.holder.add(plant.place);
      plant.view = seen;
      const sent = meshes.get(seen.id);
      if (sent) {
        plant.update(seen, this.shapes.of(plant, sent, view, this.all));
        plant.setObstacles(seen.obstacles, sent.obstacles);
      }
      return plant;
    };
    if (view.guest) this.guest = take(this.guest, view.guest);
    else if (this.guest) {
      this.guest.dispose();
      this.guest = undefined;
    }
    const there = new Set(view.plants.map((p) => p.id));
    for (const [id, plant] of this.named) {
      if (there.has(id)) continue;
      plant.dispose();
      this.named.delete(id);
    }
    for (const seen of view.plants) this.named.set(seen.id, take(this.named.get(seen.id), seen));
    this.shapes.sweep(before, this.all, view.plants);
  }

  /** Much coarser plants until they are whole: with shapes of their own, which the next view replaces. */
  coarse(fresh: Sent[]): void {
    const before = new Set(this.all.map((p) => p.shapes));
    for (const sent of fresh) {
      const { id } = sent.view;
      const plant = this.named.get(id) ?? new PlantMeshes(this.looks);
      this.named.set(id, plant);
      this.holder.add(plant.place);
      plant.view = { ...sent.view, obstacles: plant.view?.obstacles ?? [] };
      const shapes: Shapes = [];
      fillShapes(shapes, sent.parts ?? []);
      plant.update(plant.view, shapes);
    }
    const seen = this.all.flatMap((p) => (p.view ? [p.view] : []));
    this.shapes.sweep(before, this.all, seen);
  }

  /** What stands in their place from now on; none shows them again. It is given what they look like. */
  setStandIn(make: ((looks: Looks) => StandIn) | undefined): void {
    this.standIn?.dispose();
    this.standIn = make?.(this.looks);
    if (this.standIn?.whole) this.holder.add(this.standIn.whole);
    if (this.guest) {
      const other = this.standIn?.groups.get(this.guest.view?.id ?? -1);
      if (other) this.guest.place.add(other);
      this.guest.group.visible = !other;
    }
  }

  /** Puts them where they stand. */
  stand({ front, boned }: Shown): void {
    const alone = front || this.guest !== undefined;
    for (const [id, plant] of this.named) {
      const state = this.stateOf(id);
      const mine = id === this.current;
      plant.place.visible = this.guest === undefined && (mine || !alone) && !(state?.hidden ?? false);
      const other = this.standIn?.groups.get(id);
      if (other) {
        plant.place.add(other);
        other.visible = !(boned && mine);
      }
      plant.group.visible = !(boned && mine) && !other && !this.standIn?.whole;
      if (!state || this.held.has(id)) continue;
      // The front view is the drawing, wherever the plant stands.
      const [x, y, z] = front ? [0, 0, 0] : state.position;
      plant.place.position.set(x, y, z);
      plant.place.rotation.set(0, front ? 0 : THREE.MathUtils.degToRad(state.yaw_deg), 0);
      plant.place.scale.setScalar(front ? 1 : state.scale);
    }
    // What a hand may take is drawn by itself.
    const still = [...this.named].filter(
      ([id, plant]) =>
        id !== this.current && !this.held.has(id) && plant.place.visible && plant.group.visible,
    );
    this.crowd.show(still.map(([, plant]) => plant));
  }

  /** Takes materials anew. */
  relook(): void {
    for (const plant of this.all) plant.relook();
    this.crowd.relook(this.all);
  }

  /** The box around all that is seen, metres. */
  bounds(): THREE.Box3 {
    const box = new THREE.Box3();
    if (this.guest) box.union(this.guest.box());
    else for (const plant of this.named.values()) box.union(plant.box());
    return box;
  }
}
