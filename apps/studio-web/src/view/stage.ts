/** Sky, ground and light around the plant. Everything is about one unit high: the plant is scaled, not the world. */
import * as THREE from 'three';

/** The ground's, in heights of a plant. */
const RADIUS = 6;
/** As far as shadows fall. */
const SHADED = 2.4;

// Colours are mixed at the corners, in many rows: without a graphics card each pixel costs as much as a corner.
const SRGB = `
vec3 shown(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(vec3(0.0031308), c));
}`;
const SKY_VERTEX = `
uniform vec3 zenith;
uniform vec3 horizon;
uniform vec3 below;
varying vec3 color;
${SRGB}
void main() {
  float h = normalize(position).y;
  color = shown(h > 0.0 ? mix(horizon, zenith, pow(h, 0.55)) : mix(horizon, below, min(1.0, -h * 4.0)));
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const SKY_FRAGMENT = `
varying vec3 color;
void main() { gl_FragColor = vec4(color, 1.0); }`;
const GROUND_VERTEX = `
uniform vec3 ground;
varying vec4 color;
${SRGB}
void main() {
  float r = length(position) / ${RADIUS.toFixed(1)};
  color = vec4(shown(ground), r < 0.35 ? mix(1.0, 0.75, r / 0.35) : mix(0.75, 0.0, (r - 0.35) / 0.65));
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
const GROUND_FRAGMENT = `
varying vec4 color;
void main() { gl_FragColor = color; }`;

interface Mood {
  zenith: number;
  horizon: number;
  below: number;
  ground: number;
  sun: number;
  sunPower: number;
  ambient: number;
}

const LIGHT: Mood = {
  zenith: 0x8fbfe8,
  horizon: 0xf1f5ee,
  below: 0xe6e8da,
  ground: 0xdfe2cf,
  sun: 0xfff1d6,
  sunPower: 2.9,
  ambient: 0.75,
};
const DARK: Mood = {
  zenith: 0x0b1420,
  horizon: 0x23343f,
  below: 0x1a2626,
  ground: 0x202d2a,
  sun: 0xffe6c0,
  sunPower: 3.2,
  ambient: 0.95,
};

export class Stage {
  readonly scene = new THREE.Scene();
  private readonly sky: THREE.Mesh<THREE.SphereGeometry, THREE.ShaderMaterial>;
  private readonly ground: THREE.Mesh<THREE.RingGeometry, THREE.ShaderMaterial>;
  private readonly shadow: THREE.Mesh<THREE.CircleGeometry, THREE.ShadowMaterial>;
  private readonly sun = new THREE.DirectionalLight();
  private readonly fill = new THREE.HemisphereLight();

  private readonly sheet = new THREE.Color();

  /** `shadowSize`: pixels along an edge of the shadow map. */
  constructor(shadowSize: number) {
    const uniforms = {
      zenith: { value: new THREE.Color() },
      horizon: { value: new THREE.Color() },
      below: { value: new THREE.Color() },
    };
    this.sky = new THREE.Mesh(
      new THREE.SphereGeometry(60, 32, 96),
      new THREE.ShaderMaterial({
        uniforms,
        vertexShader: SKY_VERTEX,
        fragmentShader: SKY_FRAGMENT,
        side: THREE.BackSide,
        depthWrite: false,
      }),
    );
    // Fades into the sky's lower half, so that there is no edge of the world.
    this.ground = new THREE.Mesh(
      new THREE.RingGeometry(0, RADIUS, 64, 20),
      new THREE.ShaderMaterial({
        uniforms: { ground: { value: new THREE.Color() } },
        vertexShader: GROUND_VERTEX,
        fragmentShader: GROUND_FRAGMENT,
        transparent: true,
        depthWrite: false,
      }),
    );
    this.shadow = new THREE.Mesh(
      new THREE.CircleGeometry(SHADED, 48),
      new THREE.ShadowMaterial({ opacity: 0.26 }),
    );
    for (const [disc, y] of [
      [this.ground, -0.002],
      [this.shadow, 0],
    ] as const) {
      disc.rotation.x = -Math.PI / 2;
      disc.position.y = y;
    }
    this.ground.renderOrder = -1;
    this.shadow.receiveShadow = true;
    this.sun.position.set(1.6, 3.2, 2.2);
    this.sun.target.position.set(0, 0.45, 0);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(shadowSize, shadowSize);
    this.sun.shadow.radius = 5;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.004;
    const box = this.sun.shadow.camera;
    [box.left, box.right, box.bottom, box.top, box.near, box.far] = [-1.1, 1.1, -1.1, 1.1, 0.5, 8];
    this.scene.add(this.sky, this.ground, this.shadow, this.sun, this.sun.target, this.fill);
  }

  setDark(dark: boolean): void {
    const mood = dark ? DARK : LIGHT;
    const { uniforms } = this.sky.material;
    uniforms['zenith']!.value.set(mood.zenith);
    uniforms['horizon']!.value.set(mood.horizon);
    uniforms['below']!.value.set(mood.below);
    this.sheet.set(mood.horizon);
    this.ground.material.uniforms['ground']!.value.set(mood.ground);
    this.shadow.material.opacity = dark ? 0.5 : 0.26;
    this.sun.color.set(mood.sun);
    this.sun.intensity = mood.sunPower;
    this.fill.color.set(dark ? 0x9db4cc : 0xdfeeff);
    this.fill.groundColor.set(dark ? 0x2b3226 : 0x9a9a78);
    this.fill.intensity = mood.ambient * 2;
  }

  /** The front view is a plain sheet: no ground in perspective. */
  setFlat(flat: boolean): void {
    this.sky.visible = !flat;
    this.ground.visible = !flat;
    this.shadow.visible = !flat;
    this.scene.background = flat ? this.sheet : null;
  }
}
