/**
 * A plant alone, on the Studio's stage: what a notebook shows of it, as one piece of HTML that needs nothing else.
 * `burgeonShow(packed)` fills the page; the Python package puts both together (apps/python/burgeon/_view.py).
 */
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { LENS } from '../view/camera';
import { FIRST, OF_PRESET, PRESETS } from '../view/moods';
import { type Buildable, Looks } from '../view/plant';
import { drawnBySoftware } from '../view/quality';
import { awayOf, stand } from '../view/snapshot';
import { SHADOW, Stage } from '../view/stage';
import type { MaterialView, PartView } from '../wire';

/** Where numbers lie among the bytes after the contents: the first byte, and how many numbers. */
type Rows = readonly [at: number, count: number];

/** What comes before the bytes. */
interface Contents {
  /** Corners of its bounds, metres. */
  readonly min: readonly [number, number, number];
  readonly max: readonly [number, number, number];
  readonly textures: readonly { width: number; height: number; pixels: Rows }[];
  readonly materials: MaterialView[];
  readonly parts: readonly (PartView & {
    /** Metres, as 32-bit floats; normals as bytes, -127 to 127; texture coordinates as floats; colours as 16 bits, linear. */
    readonly positions: Rows;
    readonly normals: Rows;
    readonly uvs: Rows;
    readonly colors: Rows;
    readonly indices: Rows;
  })[];
}

/** Not below the ground. */
const LOWEST = 0.495 * Math.PI;
/** How far an arrow key turns, radians, and how much nearer a plus comes. */
const TURN = 0.1;
const NEARER = 0.9;

/** The plant as the Studio has it. */
function plantOf({ textures, materials, parts }: Contents, bytes: ArrayBuffer): Buildable {
  return {
    view: { parts: [...parts], materials },
    parts: parts.map(({ positions, normals, uvs, colors, indices }) => ({
      positions: new Float32Array(bytes, ...positions),
      normals: Float32Array.from(new Int8Array(bytes, ...normals), (x) => x / 127),
      uvs: new Float32Array(bytes, ...uvs),
      colors: Float32Array.from(new Uint16Array(bytes, ...colors), (x) => x / 65535),
      indices: new Uint32Array(bytes, ...indices),
    })),
    textures: textures.map(({ width, height, pixels }, number) => ({
      number,
      width,
      height,
      pixels: new Uint8Array(bytes, ...pixels),
    })),
  };
}

async function unpacked(base64: string): Promise<ArrayBuffer> {
  const raw = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  return new Response(new Blob([raw]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

/** Fills the page: `packed` is the length of the contents (32 bits), the contents as JSON, and numbers; gzip in base64. */
async function show(packed: string): Promise<void> {
  const bytes = await unpacked(packed);
  const length = new DataView(bytes).getUint32(0, true);
  const contents: Contents = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const numbers = bytes.slice(4 + length);
  const slow = drawnBySoftware();
  const renderer = new THREE.WebGLRenderer({ antialias: !slow, preserveDrawingBuffer: true });
  const canvas = renderer.domElement;
  canvas.tabIndex = 0;
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', document.title);
  document.body.append(canvas);
  renderer.setPixelRatio(slow ? 1 : Math.min(2, devicePixelRatio));

  let asked = false;
  const redraw = (): void => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(draw);
  };
  const stage = new Stage(slow ? SHADOW.fast : SHADOW.fine, renderer, redraw);
  const camera = new THREE.PerspectiveCamera(LENS.first, 1, 0.01, 200);
  const holder = new Looks(slow).build(plantOf(contents, numbers));
  const { metre, middle, radius } = stand(holder, contents);
  stage.scene.add(holder);
  stage.setMetre(metre);
  stage.shadeUpTo(Math.hypot(middle.x, middle.z) + radius);
  stage.setDark(matchMedia('(prefers-color-scheme: dark)').matches);

  const controls = new OrbitControls(camera, canvas);
  controls.maxPolarAngle = LOWEST;
  controls.minDistance = 0.1 * radius;
  controls.maxDistance = 8;
  controls.zoomToCursor = true;
  controls.target.copy(middle);
  controls.addEventListener('change', redraw);

  /** Far enough that all of it is seen, from the front right and a little above. */
  function frame(): void {
    camera.position.set(1.25, 0.55, 2.6).setLength(awayOf(radius, camera)).add(middle);
    controls.update();
  }
  function draw(): void {
    asked = false;
    stage.prepare(true, camera.aspect, holder);
    renderer.render(stage.scene, camera);
    canvas.dataset['drawn'] = '1';
  }
  function resize(): void {
    const { clientWidth: width, clientHeight: height } = document.documentElement;
    if (width === 0 || height === 0) return;
    const first = !canvas.dataset['sized'];
    canvas.dataset['sized'] = '1';
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (first) frame();
    redraw();
  }
  /** Turns about the plant and comes nearer, by keys. */
  function step(turn: number, rise: number, nearer: number): void {
    const arm = new THREE.Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    arm.theta += turn;
    arm.phi = Math.min(LOWEST, Math.max(0.01, arm.phi + rise));
    arm.radius = Math.min(controls.maxDistance, Math.max(controls.minDistance, arm.radius * nearer));
    camera.position.setFromSpherical(arm).add(controls.target);
    controls.update();
    redraw();
  }
  const steps: Record<string, readonly [number, number, number]> = {
    ArrowLeft: [-TURN, 0, 1],
    ArrowRight: [TURN, 0, 1],
    ArrowUp: [0, -TURN, 1],
    ArrowDown: [0, TURN, 1],
    '+': [0, 0, NEARER],
    '-': [0, 0, 1 / NEARER],
  };
  canvas.addEventListener('keydown', (e) => {
    const by = steps[e.key];
    if (!by) return;
    e.preventDefault();
    step(...by);
  });
  // The next stage: studio, noon, evening, clouds, night.
  let shown = 0;
  const set = (): void => stage.set({ ...FIRST, ...OF_PRESET[PRESETS[shown]!] }, !slow);
  const next = document.createElement('button');
  next.textContent = '☀';
  next.title = 'Another light';
  next.addEventListener('click', () => {
    shown = (shown + 1) % PRESETS.length;
    set();
  });
  document.body.append(next);
  set();
  new ResizeObserver(resize).observe(document.documentElement);
  resize();
}

Object.assign(globalThis, {
  burgeonShow: (packed: string) =>
    show(packed).catch((e: Error) => {
      document.body.append(`This browser cannot show the plant (${e.message}): see the picture instead.`);
    }),
});
