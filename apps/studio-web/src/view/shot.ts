/** The view as pixels of any size: tile by tile, so that no size is too large for the graphics card. */
import * as THREE from 'three';
import type { Effects, Pipeline } from './post';
import type { Stage } from './stage';

export interface ShotSize {
  /** Pixels. */
  readonly width: number;
  readonly height: number;
  /** The plants and their shadow alone. */
  readonly transparent: boolean;
}

/** The longest side of a picture, pixels: more than browsers hold in one canvas of any kind. */
export const LONGEST = 8192;
/** Side of a tile, pixels, and how much more is drawn around it where effects look at what is near. */
const TILE = 1536;
const MARGIN = 96;

export interface Studio {
  readonly renderer: THREE.WebGLRenderer;
  readonly stage: Stage;
  /** What stands on the stage. */
  readonly plants: THREE.Object3D;
  readonly pipeline: Pipeline;
  /** Set to the shape of the picture already. */
  readonly camera: Camera;
  readonly effects: Omit<Effects, 'transparent' | 'zoom'>;
}

type Camera = THREE.PerspectiveCamera | THREE.OrthographicCamera;

/**
 * A camera for a picture: what the screen shows is in it, whatever its shape. `screen`: the screen's own; `turn`: about the
 * vertical through the target, radians.
 */
export function cameraFor(
  from: Camera,
  { width, height }: ShotSize,
  screen: number,
  target: THREE.Vector3,
  turn: number,
): Camera {
  const aspect = width / height;
  const camera = from.clone();
  camera.clearViewOffset();
  if (camera instanceof THREE.PerspectiveCamera) {
    const wider = Math.max(1, Math.min(1, screen) / aspect);
    const half = Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)) * wider;
    camera.fov = 2 * THREE.MathUtils.radToDeg(Math.atan(half));
    camera.aspect = aspect;
    camera.position.sub(target).applyAxisAngle(camera.up, turn).add(target);
    if (turn !== 0) camera.lookAt(target);
  } else {
    const [middle, wide] = [(camera.left + camera.right) / 2, ((camera.top - camera.bottom) / 2) * aspect];
    [camera.left, camera.right] = [middle - wide, middle + wide];
  }
  camera.updateProjectionMatrix();
  return camera;
}

/** Called before each tile is drawn, when it is, and with the share of them that is; the last may throw. */
export interface Steps {
  before(): void;
  after(): void;
  watch(share: number): void;
}

/** Rows from the top, four bytes for each pixel. */
export async function shoot(
  { renderer, stage, plants, pipeline, camera, effects }: Studio,
  { width, height, transparent }: ShotSize,
  { before, after, watch }: Steps,
): Promise<Uint8ClampedArray<ArrayBuffer>> {
  const pixels = new Uint8ClampedArray(width * height * 4);
  const one = width <= TILE && height <= TILE;
  const margin = !one && (effects.occlusion || effects.blur > 0) ? MARGIN : 0;
  const [w, h] = [Math.min(TILE, width), Math.min(TILE, height)];
  const [tw, th] = [w + 2 * margin, h + 2 * margin];
  const target = new THREE.WebGLRenderTarget(tw, th, { depthBuffer: false });
  const read = new Uint8Array(tw * th * 4);
  try {
    for (let y = 0; y < height; y += h)
      for (let x = 0; x < width; x += w) {
        before();
        try {
          if (!one) camera.setViewOffset(width, height, x - margin, y - margin, tw, th);
          camera.updateMatrixWorld();
          stage.prepare(false, width / height, plants);
          pipeline.render(stage.scene, camera, tw, th, target, {
            ...effects,
            transparent,
            zoom: width / tw,
          });
          renderer.readRenderTargetPixels(target, 0, 0, tw, th, read);
        } finally {
          after();
        }
        const [cw, ch] = [Math.min(w, width - x), Math.min(h, height - y)];
        for (let row = 0; row < ch; row += 1) {
          const from = ((th - 1 - margin - row) * tw + margin) * 4;
          pixels.set(read.subarray(from, from + cw * 4), ((y + row) * width + x) * 4);
        }
        watch(Math.min(1, (y * width + (x + cw) * ch) / (width * height)));
        // The page breathes between tiles.
        if (!one)
          await new Promise((resolve) => {
            setTimeout(resolve);
          });
      }
  } finally {
    target.dispose();
  }
  if (!transparent) for (let i = 3; i < pixels.length; i += 4) pixels[i] = 255;
  return pixels;
}
