/** The plant as three.js meshes, updated in place where only numbers changed. */
import * as THREE from 'three';
import type { PartArrays, Sent, TexturePixels } from '../worker/protocol';
import type { CarriedPose, MaterialView, ObstacleView, PlantView, TextureView } from '../wire';
import { Carrying, type HeldRows } from './carry';

/** What a plant is built of. */
export type Buildable = Pick<Sent, 'parts' | 'textures'> & {
  readonly view: Pick<PlantView, 'parts' | 'materials'>;
};

/** Whether a surface has its colours from a photograph, by the name that the core gives it. */
const isTraced = ({ name, kind, texture }: MaterialView): boolean =>
  texture !== null && name === `${kind}-traced`;

type Look = THREE.MeshStandardMaterial | THREE.MeshLambertMaterial | THREE.MeshBasicMaterial;

/** Textures and materials of all plants. */
/** The key of the material of plain colours: others are JSON. */
const PLAIN = 'plain';

export class Looks {
  /** What photographs write into alpha: 0 where a picture is toned later, which leaves them as they are. */
  readonly photoAlpha = { value: 1 };
  private textures = new Map<number, THREE.DataTexture>();
  private materials = new Map<string, Look>();
  private wire = false;
  private photosLit = true;

  /** `matt`: without gloss, which costs a machine without a graphics card as much as all else. */
  constructor(private matt: boolean) {}

  /** Materials of the other kind from now on; plants have to take them. */
  setMatt(matt: boolean): void {
    this.matt = matt;
    this.dropMaterials();
  }

  /** Whether light falls on photographs, which have light and shade of their own; plants have to take the other materials. */
  setPhotosLit(lit: boolean): void {
    this.photosLit = lit;
    this.dropMaterials();
  }

  private dropMaterials(): void {
    for (const m of this.materials.values()) m.dispose();
    this.materials.clear();
  }

  /** A plant of its own that shares textures and materials; the caller disposes its geometries. */
  build({ view, parts, textures }: Buildable): THREE.Group {
    for (const t of textures) this.addTexture(t);
    const group = new THREE.Group();
    view.parts.forEach(({ material }, i) => {
      const [columns, look] = [parts?.[i], view.materials[material]];
      if (!columns || !look) return;
      const mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.material(look, columns.colors.length > 0));
      fill(mesh.geometry, columns);
      mesh.castShadow = mesh.receiveShadow = true;
      group.add(mesh);
    });
    return group;
  }

  setWire(wire: boolean): void {
    this.wire = wire;
    for (const m of this.materials.values()) m.wireframe = wire;
  }

  /** A new worker numbers its textures anew. */
  forget(): void {
    for (const t of this.textures.values()) t.dispose();
    this.textures.clear();
    this.dropMaterials();
  }

  /** Forgets textures that nothing shows any more, and what is made of them. */
  keep(numbers: ReadonlySet<number>): void {
    const gone = new Set<THREE.Texture>();
    for (const [number, texture] of this.textures) {
      if (numbers.has(number)) continue;
      texture.dispose();
      gone.add(texture);
      this.textures.delete(number);
    }
    for (const [key, material] of this.materials) {
      const { map, aoMap } = material;
      const normalMap = 'normalMap' in material ? material.normalMap : null;
      if (![map, normalMap, aoMap].some((t) => t && gone.has(t))) continue;
      material.dispose();
      this.materials.delete(key);
    }
  }

  addTexture({ number, width, height, pixels }: TexturePixels): void {
    const texture = new THREE.DataTexture(new Uint8Array(pixels), width, height, THREE.RGBAFormat);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.magFilter = THREE.LinearFilter;
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.generateMipmaps = true;
    texture.anisotropy = 4;
    texture.needsUpdate = true;
    this.textures.get(number)?.dispose();
    this.textures.set(number, texture);
  }

  /** Normals, occlusion and roughness: numbers, no colours. */
  private relief({ normal, orm }: MaterialView): THREE.MeshStandardMaterialParameters {
    const numbers = (t: TextureView | null): THREE.DataTexture | null => {
      const texture = t ? (this.textures.get(t.number) ?? null) : null;
      if (texture) texture.colorSpace = THREE.NoColorSpace;
      return texture;
    };
    const [normalMap, ormMap] = [numbers(normal), numbers(orm)];
    // Textures begin at the top here, so that the map's green, which points up, points against v.
    const normalScale = new THREE.Vector2(1, -1);
    return { normalMap, normalScale, aoMap: ormMap, roughnessMap: ormMap };
  }

  /** A surface in the very colours of its picture. */
  private photo(shown: THREE.MeshBasicMaterialParameters): THREE.MeshBasicMaterial {
    const material = new THREE.MeshBasicMaterial({ ...shown, toneMapped: false });
    material.onBeforeCompile = (shader) => {
      shader.uniforms['photoAlpha'] = this.photoAlpha;
      shader.fragmentShader = `uniform float photoAlpha;\n${shader.fragmentShader.replace(
        '#include <opaque_fragment>',
        '#include <opaque_fragment>\ngl_FragColor.a = photoAlpha;',
      )}`;
    };
    return material;
  }

  /** A surface in the very colours of its vertices. */
  plain(): THREE.Material {
    const known = this.materials.get(PLAIN);
    if (known) return known;
    const plain = this.photo({ vertexColors: true, side: THREE.DoubleSide, wireframe: this.wire });
    this.materials.set(PLAIN, plain);
    return plain;
  }

  material(look: MaterialView, tinted: boolean): THREE.Material {
    const map = look.texture ? (this.textures.get(look.texture.number) ?? null) : null;
    const key = JSON.stringify([look, tinted]);
    const known = this.materials.get(key);
    if (known) return known;
    const shown = {
      map,
      color: new THREE.Color().setRGB(...look.color, THREE.LinearSRGBColorSpace),
      vertexColors: tinted,
      side: look.two_sided ? THREE.DoubleSide : THREE.FrontSide,
      alphaTest: look.masked ? 0.5 : 0,
      wireframe: this.wire,
    };
    if (!this.photosLit && isTraced(look)) {
      const photo = this.photo(shown);
      this.materials.set(key, photo);
      return photo;
    }
    const material = this.matt
      ? new THREE.MeshLambertMaterial(shown)
      : new THREE.MeshStandardMaterial({
          ...shown,
          ...this.relief(look),
          roughness: look.roughness,
          metalness: 0,
        });
    if (look.translucency > 0) {
      // Light through a thin blade: a little of its own colour shines from the shaded side.
      material.emissive.setRGB(1, 1, 1);
      material.emissiveMap = map;
      material.emissiveIntensity = 0.16 * look.translucency;
      if (!map) material.emissive.copy(material.color);
    }
    this.materials.set(key, material);
    return material;
  }
}

/** The columns of a plant's meshes on the graphics card, in the order of its parts, whose names may repeat; copies share them. */
export type Shapes = THREE.BufferGeometry[];

/** Puts columns into shapes, in the place of what they were. */
export function fillShapes(shapes: Shapes, parts: readonly PartArrays[]): void {
  for (const geometry of shapes.splice(parts.length)) geometry.dispose();
  parts.forEach((columns, i) => {
    shapes[i] ??= new THREE.BufferGeometry();
    fill(shapes[i], columns);
  });
}

/** One plant: its meshes within a group that stands where the plant stands. */
export class PlantMeshes {
  /** Where it stands. */
  readonly place = new THREE.Group();
  readonly group = new THREE.Group();
  readonly obstacles = new THREE.Group();
  view: PlantView | undefined;
  shapes: Shapes = [];

  /** One for each of its parts. */
  private readonly meshes: THREE.Mesh[] = [];
  private carrying: Carrying | undefined;

  constructor(private readonly looks: Looks) {
    this.place.add(this.group, this.obstacles);
  }

  /** The name of the meshes of which a hand carries something. */
  get carried(): number | undefined {
    return this.carrying?.number;
  }

  /** A hand carries some of its triangles from now on, if it still has the meshes that are meant. */
  carry(mesh: number, rows: HeldRows): void {
    this.putBack();
    if (this.view?.mesh !== mesh || rows.length === 0) return;
    this.carrying = new Carrying(mesh, this.group, this.meshes, rows);
  }

  pose(pose: CarriedPose): void {
    this.carrying?.pose(pose);
  }

  /** What was carried is where it was. */
  putBack(): void {
    this.carrying?.end();
    this.carrying = undefined;
  }

  /** Shows these shapes with the materials of the view. */
  update(view: PlantView, shapes: Shapes): void {
    this.putBack();
    this.view = view;
    this.shapes = shapes;
    for (const mesh of this.meshes.splice(shapes.length)) mesh.removeFromParent();
    shapes.forEach((geometry, i) => {
      const mesh = this.meshes[i] ?? new THREE.Mesh();
      mesh.geometry = geometry;
      mesh.name = view.parts[i]?.name ?? '';
      mesh.castShadow = mesh.receiveShadow = true;
      this.meshes[i] = mesh;
      this.group.add(mesh);
    });
    this.relook();
  }

  /** The box around it and what it grows around, metres of the scene; empty where it is not seen. */
  box(): THREE.Box3 {
    const { place, obstacles, view } = this;
    const box = new THREE.Box3();
    if (!view || !place.visible) return box;
    place.updateMatrix();
    for (const mesh of obstacles.children as THREE.Mesh[]) {
      mesh.updateMatrix();
      mesh.geometry.computeBoundingBox();
      if (mesh.geometry.boundingBox)
        box.union(mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrix).applyMatrix4(place.matrix));
    }
    const own = new THREE.Box3(new THREE.Vector3(...view.min), new THREE.Vector3(...view.max));
    if (view.parts.length > 0) box.union(own.applyMatrix4(place.matrix));
    return box;
  }

  /** The material of one of its parts. */
  materialOf(part: number): THREE.Material {
    return this.meshes[part]!.material as THREE.Material;
  }

  /** Takes its materials anew. */
  relook(): void {
    this.meshes.forEach((mesh, i) => {
      const part = this.view?.parts[i];
      const look = part && this.view?.materials[part.material];
      if (look) mesh.material = this.looks.material(look, mesh.geometry.hasAttribute('color'));
    });
  }

  /** What the plant grows around; `corners` has the triangles of those that are meshes. */
  setObstacles(shapes: ObstacleView[], corners: (Float32Array | null)[]): void {
    for (const mesh of this.obstacles.children) (mesh as THREE.Mesh).geometry.dispose();
    this.obstacles.clear();
    shapes.forEach((shape, row) => {
      const mesh = solid(shape, corners[row] ?? null);
      if (!mesh) return;
      mesh.userData['row'] = row;
      mesh.castShadow = mesh.receiveShadow = true;
      this.obstacles.add(mesh);
    });
  }

  /** Takes it out of the view. Its shapes may be those of copies: they stay. */
  dispose(): void {
    for (const mesh of this.obstacles.children) (mesh as THREE.Mesh).geometry.dispose();
    this.place.removeFromParent();
  }
}

const STONE = new THREE.MeshStandardMaterial({ color: 0x9a9891, roughness: 0.95, side: THREE.DoubleSide });

function solid(shape: ObstacleView, corners: Float32Array | null): THREE.Mesh | undefined {
  const fields = shape as Record<string, unknown>;
  const vec = (key: string): THREE.Vector3 => new THREE.Vector3(...(fields[key] as [number, number, number]));
  const num = (key: string): number => Number(fields[key]);
  if (shape.shape === 'box') {
    const [min, max] = [vec('min'), vec('max')];
    const mesh = new THREE.Mesh(new THREE.BoxGeometry(max.x - min.x, max.y - min.y, max.z - min.z), STONE);
    mesh.position.copy(min.add(max).multiplyScalar(0.5));
    return mesh;
  }
  if (shape.shape === 'sphere') {
    const mesh = new THREE.Mesh(new THREE.SphereGeometry(num('radius_m'), 40, 24), STONE);
    mesh.position.copy(vec('centre'));
    return mesh;
  }
  if (shape.shape === 'cylinder') {
    const mesh = new THREE.Mesh(
      new THREE.CylinderGeometry(num('radius_m'), num('radius_m'), num('height_m'), 40),
      STONE,
    );
    mesh.position.copy(vec('base')).y += num('height_m') / 2;
    return mesh;
  }
  if (shape.shape === 'plane') {
    // Ten metres of it: a plane has no end.
    const mesh = new THREE.Mesh(new THREE.PlaneGeometry(10, 10), STONE);
    mesh.position.copy(vec('point'));
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), vec('normal').normalize());
    return mesh;
  }
  if (!corners || corners.length === 0) return undefined;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(corners, 3));
  geometry.computeVertexNormals();
  return new THREE.Mesh(geometry, STONE);
}

function fill(
  geometry: THREE.BufferGeometry,
  { positions, normals, uvs, colors, indices }: PartArrays,
): void {
  const set = (name: string, array: Float32Array, size: number): void => {
    const now = geometry.getAttribute(name) as THREE.BufferAttribute | undefined;
    if (array.length === 0) {
      geometry.deleteAttribute(name);
    } else if (now && now.array.length === array.length) {
      now.copyArray(array);
      now.needsUpdate = true;
    } else {
      geometry.setAttribute(name, new THREE.BufferAttribute(array, size));
    }
  };
  // Buffers of another length need new names on the graphics card.
  const before = geometry.getAttribute('position') as THREE.BufferAttribute | undefined;
  if (before && before.array.length !== positions.length) geometry.dispose();
  set('position', positions, 3);
  set('normal', normals, 3);
  set('uv', uvs, 2);
  set('color', colors, 3);
  geometry.setIndex(new THREE.BufferAttribute(indices, 1));
  geometry.computeBoundingSphere();
}
