/** The plant as three.js meshes, updated in place where only numbers changed. */
import * as THREE from 'three';
import type { PartArrays, Sent, TexturePixels, View } from '../protocol';

type MaterialView = View['materials'][number];

export class PlantMeshes {
  readonly group = new THREE.Group();
  private textures = new Map<number, THREE.DataTexture>();
  private materials = new Map<string, THREE.MeshStandardMaterial>();
  private wire = false;

  update(view: View, parts: PartArrays[], textures: TexturePixels[]): void {
    for (const t of textures) this.addTexture(t);
    const old = new Map(this.group.children.map((m) => [m.name, m as THREE.Mesh]));
    view.parts.forEach(({ name, material }, i) => {
      const columns = parts[i];
      const look = view.materials[material];
      if (!columns || !look) return;
      let mesh = old.get(name);
      old.delete(name);
      if (!mesh) {
        mesh = new THREE.Mesh(new THREE.BufferGeometry());
        mesh.name = name;
        mesh.castShadow = true;
        mesh.receiveShadow = true;
        this.group.add(mesh);
      }
      fill(mesh.geometry, columns);
      mesh.material = this.material(look, columns.colors.length > 0);
    });
    for (const mesh of old.values()) {
      mesh.geometry.dispose();
      this.group.remove(mesh);
    }
  }

  /** A plant of its own that shares textures and materials; the caller disposes its geometries. */
  build({ view, parts, textures }: Sent): THREE.Group {
    for (const t of textures) this.addTexture(t);
    const group = new THREE.Group();
    view.parts.forEach(({ material }, i) => {
      const [columns, look] = [parts[i], view.materials[material]];
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
    for (const m of this.materials.values()) m.dispose();
    this.textures.clear();
    this.materials.clear();
  }

  private addTexture({ number, width, height, pixels }: TexturePixels): void {
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

  private material(look: MaterialView, tinted: boolean): THREE.MeshStandardMaterial {
    const map = look.texture ? (this.textures.get(look.texture.number) ?? null) : null;
    const key = JSON.stringify([look, tinted]);
    const known = this.materials.get(key);
    if (known) return known;
    const material = new THREE.MeshStandardMaterial({
      map,
      color: new THREE.Color().setRGB(...look.color, THREE.LinearSRGBColorSpace),
      roughness: look.roughness,
      metalness: 0,
      vertexColors: tinted,
      side: look.two_sided ? THREE.DoubleSide : THREE.FrontSide,
      alphaTest: look.masked ? 0.5 : 0,
      wireframe: this.wire,
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

function fill(geometry: THREE.BufferGeometry, { positions, normals, uvs, colors, indices }: PartArrays): void {
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
