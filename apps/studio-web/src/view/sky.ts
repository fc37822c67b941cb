/** The sky, drawn once for each light into a cube: it is the background, and it lights. Loaded when it is first wanted. */
import * as THREE from 'three';
import { RoomEnvironment } from 'three/examples/jsm/environments/RoomEnvironment.js';
import { Sky } from 'three/examples/jsm/objects/Sky.js';
import { ALBEDO, litBy } from './ground';
import type { GroundKind, Light, StageSetting } from './moods';

export interface Baked {
  /** What is seen behind everything; none for the studio, whose sky the stage draws itself. */
  readonly background: THREE.CubeTexture | undefined;
  /** What glossy surfaces are lit by; only where surfaces are glossy. */
  readonly environment: THREE.Texture | undefined;
  /** Mean radiance at the horizon and of the upper half, linear. */
  readonly horizon: THREE.Color;
  readonly up: THREE.Color;
  dispose(): void;
}

const DOME_VERTEX = `
varying vec3 way;
void main() {
  way = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
// The brightness of an overcast sky rises to the zenith as (1 + 2 sin h) / 3 (CIE); other domes use the same law.
const DOME_FRAGMENT = `
uniform vec3 zenith;
uniform vec3 horizon;
varying vec3 way;
void main() {
  float h = max(0.0, normalize(way).y);
  gl_FragColor = vec4(mix(horizon, zenith, pow(h, 0.6)), 1.0);
}`;

// Nothing is brighter than white, and keeps its hue: haze and fog mix with the sky alike on the screen and in pictures.
const BELOW_WHITE = `
float top = max( texColor.r, max( texColor.g, texColor.b ) );
if ( top > 0.6 ) texColor *= ( 0.6 + 0.36 * ( 1.0 - exp( ( 0.6 - top ) / 0.36 ) ) ) / top;
gl_FragColor = vec4( texColor, 1.0 );`;

/** Linear radiances. */
const OVERCAST = { zenith: [0.7, 0.74, 0.79], horizon: [0.56, 0.6, 0.63] } as const;
const NIGHT = { zenith: [0.008, 0.016, 0.05], horizon: [0.036, 0.062, 0.12] } as const;
const GOLDEN = [0.62, 0.3, 0.1] as const;
const EDGE = { fine: 512, fast: 256 } as const;

function dome(zenith: THREE.Color, horizon: THREE.Color, additive: boolean): THREE.Mesh {
  return new THREE.Mesh(
    new THREE.SphereGeometry(90, 32, 32),
    new THREE.ShaderMaterial({
      uniforms: { zenith: { value: zenith }, horizon: { value: horizon } },
      vertexShader: DOME_VERTEX,
      fragmentShader: DOME_FRAGMENT,
      side: THREE.BackSide,
      depthTest: false,
      depthWrite: false,
      ...(additive ? { blending: THREE.AdditiveBlending, transparent: true } : {}),
    }),
  );
}

const colour = (c: readonly [number, number, number], times = 1): THREE.Color =>
  new THREE.Color(c[0] * times, c[1] * times, c[2] * times);

/** The sky alone, in linear radiance. */
function skyScene(setting: StageSetting, light: Light): THREE.Scene {
  const scene = new THREE.Scene();
  const day = 1 - light.night;
  if (setting.sky === 'overcast') {
    const dim = 0.04 + 0.96 * day;
    scene.add(dome(colour(OVERCAST.zenith, dim), colour(OVERCAST.horizon, dim), false));
    return scene;
  }
  if (light.sun[1] > -0.2) {
    const sky = new Sky();
    sky.scale.setScalar(100);
    sky.material.fragmentShader = sky.material.fragmentShader.replace(
      'gl_FragColor = vec4( texColor, 1.0 );',
      BELOW_WHITE,
    );
    const set = (name: string, value: unknown): void => {
      sky.material.uniforms[name]!.value = value;
    };
    const low = 1 - Math.min(1, Math.max(0, light.sun[1] / 0.5));
    set('turbidity', 2 + 6 * low);
    set('rayleigh', 1 + 0.7 * low);
    set('mieCoefficient', 0.004);
    set('mieDirectionalG', 0.8);
    set('cloudCoverage', 0.36);
    set('cloudDensity', 0.35);
    set('cloudElevation', 0.55);
    // A disc smaller than a pixel of the cube would only flicker.
    set('showSunDisc', 0);
    sky.material.uniforms['sunPosition']!.value.set(...light.sun);
    scene.add(sky);
  }
  // The belt of dust that makes low suns golden all round.
  const golden = Math.max(0, 1 - Math.abs(light.sun[1] - 0.1) / 0.22);
  if (golden > 0) scene.add(dome(new THREE.Color(0, 0, 0), colour(GOLDEN, golden), true));
  if (light.night > 0)
    scene.add(dome(colour(NIGHT.zenith, light.night), colour(NIGHT.horizon, light.night), true));
  return scene;
}

/** Means of single pixels of a cube's faces. */
function read(
  renderer: THREE.WebGLRenderer,
  target: THREE.WebGLCubeRenderTarget,
  faces: readonly number[],
  places: readonly (readonly [number, number])[],
  most: number,
): THREE.Color {
  const sum = new THREE.Color(0, 0, 0);
  const pixel = new Uint16Array(4);
  for (const face of faces)
    for (const [x, y] of places) {
      const at = (share: number): number => Math.min(target.width - 1, Math.floor(share * target.width));
      renderer.readRenderTargetPixels(target, at(x), at(y), 1, 1, pixel, face);
      const part = (i: number): number => Math.min(most, THREE.DataUtils.fromHalfFloat(pixel[i]!));
      sum.add(new THREE.Color(part(0), part(1), part(2)));
    }
  return sum.multiplyScalar(1 / (faces.length * places.length));
}

/** How much of a sky's own colour its light keeps. */
const TINT = 0.4;

function paler(c: THREE.Color): THREE.Color {
  const grey = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
  return new THREE.Color(grey, grey, grey).lerp(c, TINT);
}

/** The floor of what lights from below: it is lit itself. */
function floor(ground: GroundKind, light: Light, up: THREE.Color): THREE.Mesh {
  const lit = up
    .clone()
    .multiplyScalar(light.ambient)
    .add(colour(light.colour, (light.power * litBy(ground, light.way)) / Math.PI));
  const mesh = new THREE.Mesh(
    new THREE.CircleGeometry(80, 32),
    new THREE.MeshBasicMaterial({ color: lit.multiply(ALBEDO[ground]), depthTest: false }),
  );
  mesh.rotation.x = -Math.PI / 2;
  mesh.position.y = -1;
  mesh.renderOrder = 1;
  return mesh;
}

function empty(scene: THREE.Scene): void {
  scene.traverse((o) => {
    if (!(o instanceof THREE.Mesh)) return;
    o.geometry.dispose();
    (o.material as THREE.Material).dispose();
  });
}

/** Draws the sky of a light. `fine`: surfaces are glossy. */
export function bake(
  renderer: THREE.WebGLRenderer,
  setting: StageSetting,
  light: Light,
  fine: boolean,
): Baked {
  if (setting.sky === 'studio') return studio(renderer, fine);
  const scene = skyScene(setting, light);
  const target = new THREE.WebGLCubeRenderTarget(fine ? EDGE.fine : EDGE.fast, {
    type: THREE.HalfFloatType,
    generateMipmaps: false,
  });
  const eye = new THREE.CubeCamera(0.1, 1000, target);
  eye.update(renderer, scene);
  const horizon = read(
    renderer,
    target,
    [0, 1, 4, 5],
    [
      [0.15, 0.5],
      [0.5, 0.5],
      [0.85, 0.5],
    ],
    2,
  );
  const top = read(
    renderer,
    target,
    [2],
    [
      [0.3, 0.3],
      [0.7, 0.3],
      [0.3, 0.7],
      [0.7, 0.7],
      [0.5, 0.5],
    ],
    1.5,
  );
  // A sky as blue as it looks would dye every leaf: the eye takes most of that away.
  const zenith = paler(top);
  const around = paler(horizon);
  const up = zenith.clone().lerp(around, 0.45);
  let lighting: THREE.WebGLRenderTarget | undefined;
  if (fine) {
    empty(scene);
    scene.clear();
    scene.add(dome(zenith, around, false), floor(setting.ground, light, up));
    const generator = new THREE.PMREMGenerator(renderer);
    lighting = generator.fromScene(scene, 0, 0.1, 1000);
    generator.dispose();
  }
  empty(scene);
  return {
    background: target.texture,
    environment: lighting?.texture,
    horizon,
    up,
    dispose: () => {
      target.dispose();
      lighting?.dispose();
    },
  };
}

/** A room with soft boxes, for gloss; nothing of it is seen. */
function studio(renderer: THREE.WebGLRenderer, fine: boolean): Baked {
  let lighting: THREE.WebGLRenderTarget | undefined;
  if (fine) {
    const room = new RoomEnvironment();
    const generator = new THREE.PMREMGenerator(renderer);
    lighting = generator.fromScene(room, 0.04);
    generator.dispose();
    room.dispose();
  }
  return {
    background: undefined,
    environment: lighting?.texture,
    horizon: new THREE.Color(1, 1, 1),
    up: new THREE.Color(1, 1, 1),
    dispose: () => lighting?.dispose(),
  };
}

/** Stars about the stage: few bright, many faint, always the same. */
export function stars(): THREE.Points {
  const n = 900;
  const [positions, colors] = [new Float32Array(3 * n), new Float32Array(3 * n)];
  let seed = 12345;
  const next = (): number => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return seed / 2 ** 32;
  };
  for (let i = 0; i < n; i += 1) {
    const y = 0.02 + 0.98 * next();
    const a = 2 * Math.PI * next();
    const r = Math.sqrt(1 - y * y);
    positions.set([80 * r * Math.cos(a), 80 * y, 80 * r * Math.sin(a)], 3 * i);
    const bright = (0.12 + 0.88 * next() ** 6) * Math.min(1, y * 4);
    const warm = next();
    colors.set([bright * (0.8 + 0.2 * warm), bright * 0.9, bright * (1 - 0.25 * warm)], 3 * i);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(colors, 3));
  const points = new THREE.Points(
    geometry,
    new THREE.PointsMaterial({
      size: 1.8,
      sizeAttenuation: false,
      vertexColors: true,
      blending: THREE.AdditiveBlending,
      transparent: true,
      depthWrite: false,
      fog: false,
    }),
  );
  points.frustumCulled = false;
  return points;
}
