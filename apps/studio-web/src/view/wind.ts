/** How wind moves what an export holds: the formula that docs/exports.md gives to other programs, word for word. */
import * as THREE from 'three';

/** A test compares it with the page for people who write shaders. */
export const BLOW = `
attribute vec4 _wind;  attribute vec3 _pivot;
uniform float time;    // seconds
uniform vec3 gust;     // metres at the top, such as a tenth of the height: vec3(1.5, 0.0, 0.4)
vec3 blow(vec3 p) {
    float tau = 6.2832;
    p += gust * _wind.x * (0.6 + 0.4 * sin(1.1 * time));             // the whole plant leans and sways
    p += gust * _wind.y * sin(2.3 * time + tau * _wind.w);           // each limb in its own time
    float own = _wind.w + dot(_pivot, vec3(7.1, 5.3, 3.7));          // each leaf in its own time
    vec3 turn = cross(vec3(0.60, 0.64, 0.48), position - _pivot);    // about the point where it is fixed
    return p + turn * 0.25 * _wind.z * sin(9.0 * time + tau * own);
}
`;

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
