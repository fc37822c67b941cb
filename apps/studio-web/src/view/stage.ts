/** Sky, ground and light around the plant. Everything is about one unit high: the plant is scaled, not the world. */
import * as THREE from 'three';
import type { Contact } from './contact';
import { ALBEDO, Ground, litBy } from './ground';
import { FIRST, type Light, lightOf, type StageSetting } from './moods';
import type { Baked } from './sky';

/** The ground's, in heights of a plant. */
const RADIUS = 6;
/** As far as shadows fall. */
const SHADED = 2.4;
/** What lies no further than this from the middle of the stage throws a shadow, unless it is told to reach further. */
const SHADING = 1.1;

// Colours are mixed at the corners, in many rows: without a graphics card each pixel costs as much as a corner.
const SRGB = `
uniform float encoded;
// Onto the screen: as it is to look. Into a picture that is toned later: linear, and marked as not to be toned.
vec3 shown(vec3 c) {
  if (encoded < 0.5) return c;
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
uniform float encoded;
void main() { gl_FragColor = vec4(color, encoded); }`;
const GROUND_VERTEX = `
uniform vec3 ground;
varying vec4 color;
${SRGB}
void main() {
  float r = length(position) / ${RADIUS.toFixed(1)};
  color = vec4(shown(ground), 1.0 - smoothstep(0.0, 1.0, r));
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;
// One colour, or a picture cut to the shape of what is drawn.
const BACKDROP_VERTEX = `
varying vec2 at;
uniform vec2 part;
void main() {
  at = (uv - 0.5) * part + 0.5;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}`;
const BACKDROP_FRAGMENT = `
varying vec2 at;
uniform vec3 paint;
uniform sampler2D picture;
uniform float pictured;
${SRGB}
void main() {
  gl_FragColor = vec4(shown(pictured > 0.5 ? texture2D(picture, at).rgb : paint), encoded);
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

/** Black over colours that are toned later is weaker than over those that are shown. */
const black = (share: number, onScreen: boolean): number => (onScreen ? share : 1 - (1 - share) ** 2.2);
const PLAIN = { blending: THREE.NormalBlending } as const;
/** Blends colours and leaves the mark of what lies below. */
const KEEP_MARK = {
  blending: THREE.CustomBlending,
  blendSrc: THREE.SrcAlphaFactor,
  blendDst: THREE.OneMinusSrcAlphaFactor,
  blendSrcAlpha: THREE.ZeroFactor,
  blendDstAlpha: THREE.OneFactor,
} as const;
/** Light of the sky on surfaces without gloss is this times its mean radiance. */
const DIFFUSE = Math.PI;
/** Thickness of the densest fog, for each height of a plant. */
const FOG = 0.32;

/** Pixels along an edge of the shadow map, without a graphics card and with one. */
export const SHADOW = { fast: 512, fine: 2048 } as const;

export class Stage {
  readonly scene = new THREE.Scene();
  private readonly sky: THREE.Mesh<THREE.SphereGeometry, THREE.ShaderMaterial>;
  private readonly plain: THREE.Mesh<THREE.RingGeometry, THREE.ShaderMaterial>;
  private readonly shadow: THREE.Mesh<THREE.CircleGeometry, THREE.ShadowMaterial>;
  private readonly backdrop: THREE.Mesh<THREE.PlaneGeometry, THREE.ShaderMaterial>;
  private readonly ground = new Ground();
  private readonly sun = new THREE.DirectionalLight();
  private readonly fill = new THREE.HemisphereLight();
  private readonly shared = { encoded: { value: 1 } };
  private readonly sheet = new THREE.Color();
  private picture: THREE.Texture | undefined;
  private stars: THREE.Points | undefined;
  private contact: Contact | undefined;
  private touched = true;
  private shade = 0.26;
  private baked: Baked | undefined;
  /** What the baked sky was made for. */
  private bakedFor = '';
  private setting: StageSetting = FIRST;
  private light: Light = lightOf(FIRST);
  private dark = false;
  private flat = false;
  private bare = false;
  /** The name of the colour behind everything, once it was read. */
  private paint: string | undefined;
  private fine = false;
  private metre = 1;

  /** What draws it is set up for it. `shadowSize`: as in `SHADOW`; `changed`: what came late is to be drawn. */
  constructor(
    shadowSize: number,
    private readonly renderer: THREE.WebGLRenderer,
    private readonly changed: () => void,
  ) {
    renderer.shadowMap.enabled = true;
    // The light stands still: its shadows change with the plant only.
    renderer.shadowMap.autoUpdate = false;
    renderer.shadowMap.type = THREE.PCFShadowMap;
    renderer.toneMapping = THREE.NeutralToneMapping;
    renderer.toneMappingExposure = 1.08;
    const uniforms = {
      zenith: { value: new THREE.Color() },
      horizon: { value: new THREE.Color() },
      below: { value: new THREE.Color() },
      ...this.shared,
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
    this.plain = new THREE.Mesh(
      new THREE.RingGeometry(0, RADIUS, 64, 20),
      new THREE.ShaderMaterial({
        uniforms: { ground: { value: new THREE.Color() }, ...this.shared },
        vertexShader: GROUND_VERTEX,
        fragmentShader: GROUND_FRAGMENT,
        transparent: true,
        depthWrite: false,
        ...KEEP_MARK,
      }),
    );
    this.backdrop = new THREE.Mesh(
      new THREE.PlaneGeometry(2, 2),
      new THREE.ShaderMaterial({
        uniforms: {
          paint: { value: new THREE.Color() },
          picture: { value: null },
          pictured: { value: 0 },
          part: { value: new THREE.Vector2(1, 1) },
          ...this.shared,
        },
        vertexShader: BACKDROP_VERTEX,
        fragmentShader: BACKDROP_FRAGMENT,
        depthTest: false,
        depthWrite: false,
      }),
    );
    this.backdrop.renderOrder = -2;
    this.backdrop.frustumCulled = false;
    this.shadow = new THREE.Mesh(
      new THREE.CircleGeometry(SHADED, 48),
      new THREE.ShadowMaterial({ opacity: 0.26 }),
    );
    for (const [disc, y] of [
      [this.plain, -0.002],
      [this.shadow, 0],
    ] as const) {
      disc.rotation.x = -Math.PI / 2;
      disc.position.y = y;
    }
    this.plain.renderOrder = -1;
    this.shadow.receiveShadow = true;
    this.sun.target.position.set(0, 0.45, 0);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(shadowSize, shadowSize);
    this.sun.shadow.radius = 5;
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.004;
    const box = this.sun.shadow.camera;
    [box.left, box.right, box.bottom, box.top] = [-SHADING, SHADING, -SHADING, SHADING];
    [box.near, box.far] = [0.5, 8];
    this.scene.add(this.backdrop, this.sky, this.plain, this.ground.group, this.shadow);
    this.scene.add(this.sun, this.sun.target, this.fill);
  }

  get current(): StageSetting {
    return this.setting;
  }

  /** Whether what lies in the ground is hidden by it. */
  get covers(): boolean {
    return this.setting.ground === 'grass' || this.setting.ground === 'soil';
  }

  setDark(dark: boolean): void {
    this.dark = dark;
    this.apply();
  }

  /** `fine`: surfaces are glossy and lit by the whole sky. */
  set(setting: StageSetting, fine: boolean): void {
    this.setting = setting;
    this.fine = fine;
    this.light = lightOf(setting);
    this.apply();
  }

  /** A metre, in heights of what stands here. */
  setMetre(metre: number): void {
    if (metre === this.metre) return;
    this.metre = metre;
    this.ground.set(this.setting.ground, metre, this.fine);
  }

  /** A picture behind everything; none takes it away. */
  setPicture(image: TexImageSource | undefined): void {
    this.picture?.dispose();
    this.picture = image === undefined ? undefined : new THREE.Texture(image);
    if (this.picture) {
      this.picture.colorSpace = THREE.SRGBColorSpace;
      this.picture.needsUpdate = true;
    }
    this.apply();
  }

  /** The front view is a plain sheet: no ground in perspective. */
  setFlat(flat: boolean): void {
    this.flat = flat;
    this.lightBySky();
    this.show();
  }

  /** Nothing but the plant and its shadow, for pictures with transparency. */
  setBare(bare: boolean): void {
    this.bare = bare;
    this.lightBySky();
    this.show();
  }

  /** Plants or lights moved: their shadows are drawn anew with the next picture. */
  touch(): void {
    this.renderer.shadowMap.needsUpdate = true;
    this.touched = true;
  }

  /** Plants up to this far from the middle keep their shadows: a hand may move them off the stage. */
  shadeUpTo(distance: number): void {
    const reach = Math.max(SHADING, Math.min(4 * SHADING, distance));
    const box = this.sun.shadow.camera;
    if (Math.abs(box.right - reach) < 0.05 * reach) return;
    [box.left, box.right, box.bottom, box.top] = [-reach, reach, -reach, reach];
    box.updateProjectionMatrix();
    this.shadow.scale.setScalar(reach / SHADING);
    this.touch();
  }

  /** A sharper shadow, for pictures that are kept. */
  sharpen(pixels: number): void {
    const { shadow } = this.sun;
    if (shadow.mapSize.x === pixels) return;
    shadow.map?.dispose();
    shadow.map = null;
    shadow.mapSize.set(pixels, pixels);
    this.renderer.shadowMap.needsUpdate = true;
  }

  get shadowSize(): number {
    return this.sun.shadow.mapSize.x;
  }

  /** Where plants touch the ground it is darker, but not where each picture is dear and none asked for it. */
  private touchGround(plants: THREE.Object3D): void {
    const wanted = (this.fine || this.covers) && !this.flat && this.setting.ground !== 'none';
    if (this.contact) this.contact.plane.visible = wanted && !this.bare;
    if (!wanted || !this.touched) return;
    if (!this.contact) {
      void import('./contact').then(({ Contact }) => {
        if (this.contact) return;
        this.contact = new Contact();
        this.scene.add(this.contact.plane);
        this.changed();
      });
      return;
    }
    this.touched = false;
    this.contact.update(this.renderer, this.scene, plants);
  }

  /**
   * Before each picture: whether it goes onto the screen as it is, and the shape that a picture behind it is cut to.
   * `plants` stand on the ground.
   */
  prepare(onScreen: boolean, aspect: number, plants: THREE.Object3D): void {
    this.touchGround(plants);
    this.shared.encoded.value = onScreen ? 1 : 0;
    const g = this.baked?.horizon.g ?? 1;
    this.ground.setToned(onScreen ? undefined : g * this.renderer.toneMappingExposure);
    this.shadow.material.opacity = black(this.shade, onScreen);
    // What is marked as not to be toned stays so under a shadow, unless the shadow is all that is there.
    const blending = this.bare ? PLAIN : KEEP_MARK;
    this.shadow.material.setValues(blending);
    if (this.contact) {
      this.contact.plane.material.setValues(blending);
      this.contact.plane.material.opacity = black(0.5, onScreen);
    }
    const { uniforms } = this.backdrop.material;
    // A sheet needs no drawing on the screen.
    const painted = this.isPainted;
    const sheet = this.flat && !this.bare && !onScreen;
    this.backdrop.visible = sheet || (painted && !this.flat && !this.bare);
    const pictured = !sheet && this.setting.background === 'picture' && this.picture !== undefined;
    uniforms['pictured']!.value = pictured ? 1 : 0;
    uniforms['picture']!.value = this.picture ?? null;
    // A colour that is named takes time to read.
    const paint = sheet ? undefined : this.setting.colour;
    if (sheet) uniforms['paint']!.value.copy(this.sheet);
    else if (paint !== this.paint) uniforms['paint']!.value.set(paint);
    this.paint = paint;
    const image = this.picture?.image as { width: number; height: number } | undefined;
    if (!image) return;
    const own = image.width / Math.max(1, image.height);
    uniforms['part']!.value.set(Math.min(1, aspect / own), Math.min(1, own / aspect));
  }

  /** A colour or a picture stands behind everything. */
  private get isPainted(): boolean {
    const { background } = this.setting;
    return background === 'colour' || (background === 'picture' && this.picture !== undefined);
  }

  private apply(): void {
    const { setting, light } = this;
    const studio = setting.sky === 'studio';
    const mood = this.dark ? DARK : LIGHT;
    const { uniforms } = this.sky.material;
    uniforms['zenith']!.value.set(mood.zenith);
    uniforms['horizon']!.value.set(mood.horizon);
    uniforms['below']!.value.set(mood.below);
    this.sheet.set(mood.horizon);
    this.plain.material.uniforms['ground']!.value.set(mood.ground);
    if (studio) {
      // At ten the light falls as it does in the studio; other hours turn it.
      this.sun.color.set(mood.sun);
      this.sun.intensity = mood.sunPower;
      this.shade = this.dark ? 0.5 : 0.26;
      this.fill.color.set(this.dark ? 0x9db4cc : 0xdfeeff);
      this.fill.groundColor.set(this.dark ? 0x2b3226 : 0x9a9a78);
      this.fill.intensity = mood.ambient * 2;
      this.renderer.toneMappingExposure = 1.08;
      this.sun.position.set(...studioSun(setting.hour, setting.turn));
    } else {
      this.sun.color.setRGB(...light.colour, THREE.LinearSRGBColorSpace);
      this.sun.intensity = light.power;
      this.shade = 0.34 * light.shade;
      this.sun.position
        .set(...light.way)
        .setLength(4.2)
        .add(this.sun.target.position);
      this.renderer.toneMappingExposure = light.exposure;
    }
    this.ground.set(setting.ground, this.metre, this.fine);
    const { x, y, z } = this.sun.position.clone().sub(this.sun.target.position).normalize();
    this.ground.setSun([x, y, z]);
    this.wantSky();
    this.lightBySky();
    this.show();
    this.touch();
    this.changed();
  }

  /** The sky of now is drawn, if it is another; until it is there the one before stays. */
  private wantSky(): void {
    const { setting, fine } = this;
    const key =
      setting.sky === 'studio'
        ? fine && 'studio'
        : [setting.sky, setting.hour, setting.turn, setting.ground, fine].join(' ');
    if (key === false) {
      this.baked?.dispose();
      this.baked = undefined;
      this.bakedFor = '';
      return;
    }
    if (key === this.bakedFor) return;
    this.bakedFor = key;
    void import('./sky').then(({ bake, stars }) => {
      if (key !== this.bakedFor) return;
      const old = this.baked;
      this.baked = bake(this.renderer, this.setting, this.light, this.fine);
      old?.dispose();
      if (this.light.night > 0 && !this.stars) {
        this.stars = stars();
        this.scene.add(this.stars);
      }
      this.lightBySky();
      this.show();
      this.changed();
    });
  }

  private lightBySky(): void {
    const { baked, light, setting, fine } = this;
    const studio = setting.sky === 'studio';
    const glossy = fine && baked?.environment !== undefined;
    this.scene.environment = glossy ? baked.environment! : null;
    this.scene.environmentIntensity = studio ? (this.dark ? 0.4 : 0.4) : light.ambient;
    if (studio) this.fill.intensity = (this.dark ? DARK : LIGHT).ambient * (glossy ? 0.7 : 2);
    else if (glossy) this.fill.intensity = 0;
    else if (baked) {
      this.fill.color.copy(baked.up);
      this.fill.groundColor
        .copy(baked.up)
        .multiplyScalar(light.ambient)
        .add(
          this.sun.color.clone().multiplyScalar((light.power * litBy(setting.ground, light.way)) / Math.PI),
        )
        .multiply(ALBEDO[setting.ground])
        .multiplyScalar(1 / light.ambient);
      this.fill.intensity = DIFFUSE * light.ambient;
    }
    const haze = studio || !baked ? this.sheet : baked.horizon;
    const density = FOG * setting.fog ** 1.5;
    this.scene.fog = density > 0 && !this.flat && !this.bare ? new THREE.FogExp2(haze, density) : null;
  }

  private show(): void {
    const { flat, bare, setting, baked } = this;
    const { sky } = setting;
    const open = !flat && !bare;
    const painted = this.isPainted;
    this.sky.visible = open && !painted && (sky === 'studio' || !baked?.background);
    this.plain.visible = open && setting.ground === 'plain' && !painted;
    this.ground.group.visible = open && this.covers;
    this.shadow.visible = !flat && !(open && this.covers);
    if (this.stars) {
      this.stars.visible = open && !painted && sky === 'clear' && this.light.night > 0.4;
      (this.stars.material as THREE.PointsMaterial).opacity = this.light.night;
    }
    this.scene.background =
      flat && !bare ? this.sheet : !open || painted ? null : (baked?.background ?? null);
    if (!open) this.scene.fog = null;
  }
}

/** Where the studio's lamp stands: at ten where it always stood, turned by the hour and the compass. */
function studioSun(hour: number, turnDeg: number): [number, number, number] {
  const turn = THREE.MathUtils.degToRad(turnDeg + (10 - hour) * 15);
  const [x, z] = [1.6, 2.2];
  return [x * Math.cos(turn) + z * Math.sin(turn), 3.2, z * Math.cos(turn) - x * Math.sin(turn)];
}
