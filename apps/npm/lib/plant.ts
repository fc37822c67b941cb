/** A plant that was made. */
import { wrong } from './errors.js';
import { Looks, type ObjectOptions, type Place, type ThreeModule } from './object.js';
import type { Answer, PartArrays, Tables } from './protocol.js';
import type {
  CheckReport,
  EngineReport,
  ItemReport,
  Json,
  MaterialView,
  PlantView,
  TextureView,
} from './wire.js';

/** A mesh with its name and material. */
export interface PlantMesh extends PartArrays {
  readonly name: string;
  readonly material: MaterialView;
}

/** A picture: RGBA, rows from the top. */
export interface Picture extends TextureView {
  readonly pixels: Uint8Array;
}

let found: ThreeModule | undefined;
let looked: Promise<void> | undefined;

/** Looks for three.js, which need not be there. */
export function findThree(): Promise<void> {
  looked ??= import('three').then(
    (three) => {
      found = three;
    },
    () => {},
  );
  return looked;
}

/** A plant, which nothing changes: typed arrays, and objects of three.js. */
export class Plant {
  private looks: Looks | undefined;

  /** @internal */
  constructor(private readonly answer: Answer) {}

  get name(): string {
    return this.answer.view.name;
  }

  /** `tree`, `sketch`, `leaf` or `flower`, bounds in metres, levels, materials. */
  get view(): PlantView {
    return this.answer.view;
  }

  /** The entry of the report, as the command line writes it. */
  get report(): ItemReport {
    return this.answer.view.report;
  }

  /** What was checked of it: whether a person would accept it. Those that failed are among the report's warnings. */
  get checks(): readonly CheckReport[] {
    return this.answer.view.report.checks;
  }

  /** The fingerprint of the plant: the same on every machine, and as the command line's. */
  get digest(): string {
    return this.answer.view.report.digest;
  }

  /** Lower and upper corner, metres. */
  get bounds(): { readonly min: readonly number[]; readonly max: readonly number[] } {
    const { min, max } = this.answer.view;
    return { min, max };
  }

  /** How many levels of detail there are, the finest included. */
  get levels(): number {
    return this.answer.levels.length;
  }

  /** Nodes, axes and organs. */
  get tables(): Tables {
    return this.answer.tables;
  }

  /** The program that the files are for, and what was set for it, as options of the command. */
  get engine(): EngineReport | null {
    return this.answer.view.for;
  }

  /** What was asked for as `files`, such as `glb`; for a program also `lod1.glb` and so on,
   * or `pivots.exr` and `axes.png`. */
  get files(): Readonly<Record<string, Uint8Array>> {
    return this.answer.files;
  }

  /** What can be measured (docs/measures.md), where it was asked for. */
  get measures(): Record<string, Json> | undefined {
    return this.answer.measures ? (JSON.parse(this.answer.measures) as Record<string, Json>) : undefined;
  }

  /** The pictures that materials name by row. */
  get textures(): readonly Picture[] {
    const { view, textures } = this.answer;
    return view.textures.map((size, row) => ({ ...size, pixels: textures[row]! }));
  }

  /** The meshes of a level of detail: columns as they lie in memory. */
  meshes(level = 0): readonly PlantMesh[] {
    const view = this.answer.view.levels[level];
    const arrays = this.answer.levels[level];
    if (!view || !arrays) throw wrong('level', level, `0 to ${this.levels - 1}`);
    return view.parts.map(({ name, material }, i) => ({
      name,
      material: view.materials[material]!,
      ...arrays[i]!,
    }));
  }

  /** The organs of a level: a matrix of 16 numbers for each, column by column. */
  organs(level = 0): Float32Array {
    const organs = this.answer.organs[level];
    if (!organs) throw wrong('level', level, `0 to ${this.levels - 1}`);
    return organs;
  }

  /** The plant as an object of three.js: a group, or a `THREE.LOD` where it has levels. Objects of one plant share textures
   * and materials, and the wind, which is `object.userData.wind`. */
  object3D(options: ObjectOptions = {}): import('three').Object3D {
    this.check(options);
    return this.shown(options).object(options);
  }

  /** The plant at many places: each of its meshes is one draw. */
  stand(places: readonly Place[], options: ObjectOptions = {}): import('three').Group {
    this.check(options);
    places.forEach(({ x, y = 0, z, yaw = 0, scale = 1 }, row) => {
      const numbers = { x, y, z, yaw, scale };
      for (const [name, value] of Object.entries(numbers))
        if (!Number.isFinite(value)) throw wrong(`places[${row}].${name}`, value, 'a finite number');
      if (scale <= 0) throw wrong(`places[${row}].scale`, scale, 'above 0');
    });
    return this.shown(options).stand(places, options);
  }

  /** Gives back the memory of the graphics card; geometries go with the objects that have them. */
  dispose(): void {
    this.looks?.dispose();
    this.looks = undefined;
  }

  private check({ level, wind }: ObjectOptions): void {
    if (level !== undefined && !this.answer.levels[level])
      throw wrong('level', level, `0 to ${this.levels - 1}`);
    if (typeof wind === 'number' && !(wind >= 0 && wind <= 1)) throw wrong('wind', wind, '0 to 1');
  }

  private shown({ three }: ObjectOptions): Looks {
    const module = three ?? found;
    if (!module) {
      throw new Error(
        'three.js was not found: install it (npm install three), or pass it as { three: THREE }',
      );
    }
    this.looks ??= new Looks(module, this.answer);
    return this.looks;
  }
}
