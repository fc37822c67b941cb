/** A plant as objects of three.js. */
import type * as Three from 'three';
import { type Copies, type Parted, part } from './leaves.js';
import type { Answer, PartArrays } from './protocol.js';
import { lit } from './through.js';
import { type Blown, blown, type Wind } from './wind.js';
import type { LevelView, MaterialView } from './wire.js';

/** The module `three`. */
export type ThreeModule = typeof Three;

/** How a plant stands in a scene. */
export interface ObjectOptions {
  /** The module itself, where it is not the one that `import 'three'` gives. */
  readonly three?: ThreeModule;
  /** Leaves that are copies of one shape are drawn as instances: a fifth of the memory. Default true. */
  readonly instances?: boolean;
  /** Share of all movement in wind, 0 to 1, for all objects of the plant; false: this one is still. Default 0.3 where the
   * plant has columns for wind. */
  readonly wind?: number | false;
  /** The level of detail that is shown; default all that there are, by distance, as a `THREE.LOD`. */
  readonly level?: number;
  /** Casts and receives shadows. Default true. */
  readonly shadows?: boolean;
}

/** One copy of a plant in a stand. */
export interface Place {
  readonly x: number;
  readonly y?: number;
  readonly z: number;
  /** Degrees about the vertical. */
  readonly yaw?: number;
  readonly scale?: number;
}

/** The strongest wind moves the top so far, in heights of the plant. */
const LEAN = 0.1;
/** Another level where the plant is so many of its own heights away. */
const FURTHER = 2.2;

/** What all meshes of a plant share on the graphics card; made when it is first shown. */
export class Looks {
  readonly wind: Wind;
  private readonly textures: (Three.DataTexture | undefined)[] = [];
  private readonly materials = new Map<string, Three.Material>();
  private readonly parted = new Map<PartArrays, Parted>();

  constructor(
    private readonly three: ThreeModule,
    private readonly answer: Answer,
  ) {
    const { min, max } = answer.view;
    const lean = LEAN * Math.max(max[1] - Math.min(min[1], 0), 0);
    const gust = new three.Vector3(0.97, 0, 0.26).multiplyScalar(lean);
    this.wind = { time: { value: 0 }, gust: { value: gust }, strength: { value: 0.3 }, running: true };
  }

  /** Gives back the memory of the graphics card that materials and textures take. */
  dispose(): void {
    for (const texture of this.textures) texture?.dispose();
    for (const material of this.materials.values()) material.dispose();
    this.textures.length = 0;
    this.materials.clear();
    this.parted.clear();
  }

  /** The plant once. */
  object(options: ObjectOptions): Three.Object3D {
    const { view } = this.answer;
    this.blow(options.wind);
    const group = (level: number): Three.Group => this.level(level, options);
    let object: Three.Object3D;
    if (options.level !== undefined || view.levels.length === 1) {
      object = group(options.level ?? 0);
    } else {
      const lod = new this.three.LOD();
      const height = Math.max(...view.max.map((m, i) => m - view.min[i]!));
      view.levels.forEach((_, level) => {
        // Each level is made for half the size in a picture.
        lod.addLevel(group(level), level === 0 ? 0 : FURTHER * height * 2 ** (level - 1), 0.05);
      });
      object = lod;
    }
    object.name = view.name;
    object.userData['wind'] = this.wind;
    return object;
  }

  /** The plant many times: each of its meshes is one draw. */
  stand(places: readonly Place[], options: ObjectOptions): Three.Group {
    const { three } = this;
    this.blow(options.wind);
    const { view, levels } = this.answer;
    const level = options.level ?? 0;
    const [turn, up, matrix] = [new three.Quaternion(), new three.Vector3(0, 1, 0), new three.Matrix4()];
    const group = new three.Group();
    group.name = view.name;
    group.userData['wind'] = this.wind;
    view.levels[level]!.parts.forEach(({ name, material }, i) => {
      const arrays = levels[level]![i]!;
      if (arrays.indices.length === 0) return;
      const look = this.material(view.levels[level]!.materials[material]!, arrays, 'copies', options);
      const mesh = new three.InstancedMesh(this.geometry(arrays, arrays.indices), look, places.length);
      places.forEach(({ x, y = 0, z, yaw = 0, scale = 1 }, row) => {
        turn.setFromAxisAngle(up, (yaw * Math.PI) / 180);
        matrix.compose(new three.Vector3(x, y, z), turn, new three.Vector3(scale, scale, scale));
        mesh.setMatrixAt(row, matrix);
      });
      this.finish(mesh, name, arrays, 'copies', options);
      group.add(mesh);
    });
    return group;
  }

  private blow(wind: number | false | undefined): void {
    if (typeof wind === 'number') this.wind.strength.value = wind;
  }

  private level(level: number, options: ObjectOptions): Three.Group {
    const group = new this.three.Group();
    const view = this.answer.view.levels[level];
    const meshes = this.answer.levels[level];
    if (!view || !meshes) {
      throw new RangeError(`level must be 0 to ${this.answer.view.levels.length - 1}, not ${level}`);
    }
    view.parts.forEach((_, i) => {
      const arrays = meshes[i]!;
      if (arrays.indices.length > 0) group.add(...this.meshes(view, i, arrays, level, options));
    });
    return group;
  }

  private meshes(
    view: LevelView,
    i: number,
    arrays: PartArrays,
    level: number,
    options: ObjectOptions,
  ): Three.Mesh[] {
    const { name, material } = view.parts[i]!;
    const look = view.materials[material]!;
    const out: Three.Mesh[] = [];
    const parted =
      (options.instances ?? true)
        ? (this.parted.get(arrays) ?? part(arrays, this.answer.organs[level]!))
        : { copies: [], rest: arrays.indices };
    this.parted.set(arrays, parted);
    for (const copies of parted.copies) {
      const mesh = this.instanced(copies, this.material(look, arrays, 'leaves', options));
      this.finish(mesh, name, arrays, 'leaves', options);
      out.push(mesh);
    }
    if (parted.rest.length > 0) {
      const own = parted.copies.length > 0 ? shortened(arrays, parted.rest) : arrays;
      const mesh = new this.three.Mesh(
        this.geometry(own, own.indices),
        this.material(look, arrays, 'mesh', options),
      );
      this.finish(mesh, name, arrays, 'mesh', options);
      out.push(mesh);
    }
    return out;
  }

  /** A geometry of those of its columns that there are. */
  private columns(indices: Uint32Array, of: Record<string, [Float32Array, number]>): Three.BufferGeometry {
    const geometry = new this.three.BufferGeometry();
    for (const [name, [array, size]] of Object.entries(of)) {
      if (array.length > 0) geometry.setAttribute(name, new this.three.BufferAttribute(array, size));
    }
    geometry.setIndex(new this.three.BufferAttribute(indices, 1));
    return geometry;
  }

  private geometry(arrays: PartArrays, indices: Uint32Array): Three.BufferGeometry {
    return this.columns(indices, {
      position: [arrays.positions, 3],
      normal: [arrays.normals, 3],
      uv: [arrays.uvs, 2],
      color: [arrays.colors, 3],
      _wind: [arrays.wind, 4],
      _pivot: [arrays.pivots, 3],
    });
  }

  private instanced(copies: Copies, material: Three.Material): Three.InstancedMesh {
    const { three } = this;
    const geometry = this.columns(copies.indices, {
      position: [copies.positions, 3],
      normal: [copies.normals, 3],
      uv: [copies.uvs, 2],
      color: [copies.colors, 3],
      _flutter: [copies.flutter, 1],
    });
    if (copies.sways.length > 0) {
      geometry.setAttribute('_sway', new three.InstancedBufferAttribute(copies.sways, 3));
    }
    const mesh = new three.InstancedMesh(geometry, material, copies.matrices.length / 16);
    mesh.instanceMatrix = new three.InstancedBufferAttribute(copies.matrices, 16);
    mesh.instanceColor = new three.InstancedBufferAttribute(copies.tints, 3);
    return mesh;
  }

  /** Name, shadows, the room that wind needs, and the clock. */
  private finish(
    mesh: Three.Mesh,
    name: string,
    arrays: PartArrays,
    of: Blown,
    { shadows = true, wind }: ObjectOptions,
  ): void {
    const { three } = this;
    mesh.name = name;
    mesh.castShadow = mesh.receiveShadow = shadows;
    const instances = mesh as Three.InstancedMesh;
    if (instances.isInstancedMesh) instances.computeBoundingSphere();
    else mesh.geometry.computeBoundingSphere();
    const blows = arrays.wind.length > 0 && wind !== false;
    if (!blows) return;
    const sphere = instances.isInstancedMesh ? instances.boundingSphere : mesh.geometry.boundingSphere;
    if (sphere) sphere.radius += 2 * this.wind.gust.value.length();
    const shown = mesh.material as Three.MeshStandardMaterial;
    if (shadows) {
      const depth = new three.MeshDepthMaterial({
        depthPacking: three.RGBADepthPacking,
        map: shown.map,
        alphaTest: shown.alphaTest,
        side: shown.side,
      });
      mesh.customDepthMaterial = blown(depth, this.wind, of);
    }
    mesh.onBeforeRender = () => {
      if (this.wind.running) this.wind.time.value = performance.now() / 1000;
    };
  }

  private texture(row: number | null, colour: boolean): Three.DataTexture | null {
    if (row === null) return null;
    const { three } = this;
    const known = this.textures[row];
    if (known) return known;
    const { width, height } = this.answer.view.textures[row]!;
    const texture = new three.DataTexture(this.answer.textures[row]!, width, height, three.RGBAFormat);
    texture.colorSpace = colour ? three.SRGBColorSpace : three.NoColorSpace;
    texture.wrapS = texture.wrapT = three.RepeatWrapping;
    texture.magFilter = three.LinearFilter;
    texture.minFilter = three.LinearMipmapLinearFilter;
    texture.generateMipmaps = true;
    texture.anisotropy = 4;
    texture.needsUpdate = true;
    this.textures[row] = texture;
    return texture;
  }

  private material(
    look: MaterialView,
    arrays: PartArrays,
    of: Blown,
    { wind }: ObjectOptions,
  ): Three.Material {
    const { three } = this;
    const blows = arrays.wind.length > 0 && wind !== false;
    const tinted = arrays.colors.length > 0;
    const key = JSON.stringify([look, tinted, blows ? of : '']);
    const known = this.materials.get(key);
    if (known) return known;
    const map = this.texture(look.texture, true);
    const orm = this.texture(look.orm, false);
    const material = new three.MeshStandardMaterial({
      name: look.name,
      map,
      color: new three.Color().setRGB(...look.color, three.LinearSRGBColorSpace),
      vertexColors: tinted,
      side: look.two_sided ? three.DoubleSide : three.FrontSide,
      alphaTest: look.masked ? 0.5 : 0,
      normalMap: this.texture(look.normal, false),
      // Textures begin at the top here, so that the map's green, which points up, points against v.
      normalScale: new three.Vector2(1, -1),
      aoMap: orm,
      roughnessMap: orm,
      roughness: look.roughness,
      metalness: 0,
    });
    if (blows) blown(material, this.wind, of);
    if (look.translucency > 0) lit(material, look.translucency);
    this.materials.set(key, material);
    return material;
  }
}

/** A mesh of those vertices alone that these triangles use. */
function shortened(arrays: PartArrays, indices: Uint32Array): PartArrays {
  const rows = new Int32Array(arrays.positions.length / 3).fill(-1);
  const kept: number[] = [];
  const own = indices.map((i) => {
    if (rows[i]! < 0) rows[i] = kept.push(i) - 1;
    return rows[i]!;
  });
  const take = (column: Float32Array, size: number): Float32Array => {
    const out = new Float32Array(column.length > 0 ? size * kept.length : 0);
    if (column.length > 0)
      kept.forEach((i, k) => out.set(column.subarray(size * i, size * (i + 1)), size * k));
    return out;
  };
  return {
    positions: take(arrays.positions, 3),
    normals: take(arrays.normals, 3),
    uvs: take(arrays.uvs, 2),
    colors: take(arrays.colors, 3),
    wind: take(arrays.wind, 4),
    pivots: take(arrays.pivots, 3),
    indices: own,
    pieces: arrays.pieces,
  };
}
