/** How wind moves what an export holds: as the documents tell other programs, and as the npm package does. */
import * as THREE from 'three';
import { BLOW } from '../../../npm/lib/blow';

/** Of one plant. */
export interface Gust {
  readonly time: { value: number };
  readonly gust: { value: THREE.Vector3 };
  /** Share of all movement, 0 to 1. */
  readonly strength: { value: number };
}

export function gustOf(): Gust {
  return { time: { value: 0 }, gust: { value: new THREE.Vector3() }, strength: { value: 0 } };
}

/** Has wind move whatever is drawn with a material. */
export function blown<M extends THREE.Material>(material: M, wind: Gust): M {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, wind);
    shader.vertexShader = shader.vertexShader
      .replace('void main() {', `${BLOW}\nuniform float strength;\nvoid main() {`)
      .replace('#include <begin_vertex>', 'vec3 transformed = mix(position, blow(position), strength);');
  };
  material.customProgramCacheKey = () => 'blown';
  return material;
}
