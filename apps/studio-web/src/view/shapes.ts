/** What copies share, by the name that the core gives to the meshes. */
import type { Sent } from '../worker/protocol';
import type { PlantView as Seen, SceneView } from '../wire';
import { fillShapes, type PlantMeshes, type Shapes } from './plant';

export class SharedShapes {
  private readonly named = new Map<number, Shapes>();

  clear(): void {
    this.named.clear();
  }

  /** What a plant of `all` is shown with: shapes that are there already, or its own with what was sent. */
  of(plant: PlantMeshes, { view: { id, mesh }, parts }: Sent, scene: SceneView, all: PlantMeshes[]): Shapes {
    const known = mesh === null ? undefined : this.named.get(mesh);
    if (!parts) return known ?? [];
    // What a copy is shown with, or will be, is not written over.
    const names = new Set(scene.plants.filter((p) => p.id !== id).map((p) => p.mesh));
    const wanted = [...this.named].some(([name, s]) => s === plant.shapes && names.has(name));
    const shared = all.some((p) => p !== plant && p.shapes === plant.shapes);
    const shapes: Shapes = wanted || shared ? [] : plant.shapes;
    fillShapes(shapes, parts);
    for (const [name, s] of this.named) if (s === shapes) this.named.delete(name);
    if (mesh !== null) this.named.set(mesh, shapes);
    return shapes;
  }

  /** Gives back what none of `all`, which are shown as `seen`, shows any more. */
  sweep(before: ReadonlySet<Shapes>, all: PlantMeshes[], seen: readonly Seen[]): void {
    const shown = new Set(all.map((p) => p.shapes));
    for (const shapes of before) if (!shown.has(shapes)) for (const geometry of shapes) geometry.dispose();
    const names = new Set(seen.map((p) => p.mesh));
    for (const name of this.named.keys()) if (!names.has(name)) this.named.delete(name);
  }
}
