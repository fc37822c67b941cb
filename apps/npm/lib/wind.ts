/** How wind moves a plant. */
import type * as Three from 'three';
import { BLOW } from './blow.js';

/** The wind of a plant; its numbers may be changed at any time. */
export interface Wind {
  /** Seconds; follows the clock of the page while `running`. */
  readonly time: { value: number };
  /** Metres at the top of the plant, in its own coordinates. */
  readonly gust: { value: Three.Vector3 };
  /** Share of all movement, 0 (still) to 1. */
  readonly strength: { value: number };
  /** Whether `time` follows the clock of the page. */
  running: boolean;
}

/** Which vertices a material moves: those of a mesh, of leaves that are instances, of copies of a plant. */
export type Blown = 'mesh' | 'leaves' | 'copies';

const UNIFORMS = `
uniform float uTime;
uniform vec3 uGust;
uniform float uStrength;
float time;
vec3 gust;
`;

/** Of leaves: what a mesh has in each vertex is of the instance, all but the flutter. */
const LEAF = `
attribute vec3 _sway;    // of the instance: sway of the plant, of the limb, phase
attribute float _flutter;
vec4 _wind;
vec3 _pivot;
vec3 placed;
`;

function shader(of: Blown): { head: string; body: string } {
  const rest = BLOW.replace(/^uniform .*\n/gm, '');
  const plain = 'time = uTime; gust = uGust;';
  // From the coordinates of a plant to those of an instance, which is turned and scaled alike in all directions.
  const inverse = 'mat3 turned = mat3(instanceMatrix); float sized = dot(turned[0], turned[0]);';
  if (of === 'leaves') {
    const body = `${plain} ${inverse}
      placed = (instanceMatrix * vec4(position, 1.0)).xyz;
      _pivot = instanceMatrix[3].xyz;
      _wind = vec4(_sway.xy, _flutter, _sway.z);
      vec3 transformed = position + uStrength * ((blow(placed) - placed) * turned) / sized;`;
    const own = rest.replace(/^attribute .*\n/m, '').replace('position - _pivot', 'placed - _pivot');
    return { head: UNIFORMS + LEAF + own, body };
  }
  if (of === 'copies') {
    // Copies are not in step, and the wind blows to one side for all of them.
    const body = `${inverse} time = uTime + 3.7 * float(gl_InstanceID); gust = (uGust * turned) / sized;
      vec3 transformed = mix(position, blow(position), uStrength);`;
    return { head: UNIFORMS + rest, body };
  }
  return {
    head: UNIFORMS + rest,
    body: `${plain} vec3 transformed = mix(position, blow(position), uStrength);`,
  };
}

/** Has wind move whatever is drawn with a material. */
export function blown<M extends Three.Material>(material: M, wind: Wind, of: Blown): M {
  const { head, body } = shader(of);
  material.onBeforeCompile = (program) => {
    Object.assign(program.uniforms, { uTime: wind.time, uGust: wind.gust, uStrength: wind.strength });
    program.vertexShader = program.vertexShader
      .replace('void main() {', `${head}\nvoid main() {`)
      .replace('#include <begin_vertex>', body);
  };
  material.customProgramCacheKey = () => `burgeon-${of}`;
  return material;
}
