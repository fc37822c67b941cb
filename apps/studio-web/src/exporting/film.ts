/** Frames of a film into a file: WebM or MP4 by the browser's own encoder, or one picture of all of them. */

import { t } from '../text';

export type FilmFormat = 'webm' | 'mp4' | 'sheet';
export interface FilmSpec {
  readonly format: FilmFormat;
  readonly width: number;
  readonly height: number;
  readonly fps: number;
  readonly frames: number;
}

/** What takes frames and makes a file of them. */
export interface Recorder {
  add(pixels: Uint8ClampedArray<ArrayBuffer>, frame: number): Promise<void>;
  finish(): Promise<Blob>;
  /** Nothing is made of it. */
  cancel(): void;
}

type Codec = 'vp9' | 'vp8' | 'avc' | 'av1';

/** Names of codecs for the browser and for the file, the best first. */
const CODECS: Record<'webm' | 'mp4', readonly (readonly [string, Codec])[]> = {
  webm: [
    ['vp09.00.41.08', 'vp9'],
    ['vp8', 'vp8'],
  ],
  mp4: [
    ['avc1.640033', 'avc'],
    ['avc1.42003e', 'avc'],
    ['vp09.00.41.08', 'vp9'],
    ['av01.0.08M.08', 'av1'],
  ],
};
/** Bits for each pixel of each second: foliage is full of detail. */
const BITS = 6;
/** So many frames may wait for the encoder. */
const WAITING = 6;
/** Each so many seconds a frame stands alone, so that players can jump there. */
const KEY_S = 1;

async function configOf({ format, width, height, fps }: FilmSpec): Promise<[VideoEncoderConfig, Codec]> {
  if (format === 'sheet' || typeof VideoEncoder === 'undefined') throw new Error(t('fault.film'));
  for (const [codec, name] of CODECS[format]) {
    const config: VideoEncoderConfig = {
      codec,
      width,
      height,
      framerate: fps,
      bitrate: Math.round(Math.min(40e6, Math.max(1e6, BITS * width * height))),
      ...(name === 'avc' ? { avc: { format: 'avc' as const } } : {}),
    };
    const { supported } = await VideoEncoder.isConfigSupported(config).catch(() => ({ supported: false }));
    if (supported) return [config, name];
  }
  throw new Error(t('fault.film'));
}

/** Whether this browser writes such films. */
export async function canFilm(format: FilmFormat): Promise<boolean> {
  if (format === 'sheet') return true;
  return configOf({ format, width: 640, height: 480, fps: 25, frames: 1 }).then(
    () => true,
    () => false,
  );
}

/** A file that encoded frames are written into, in their order. */
interface FilmFile {
  add(chunk: EncodedVideoChunk, meta?: EncodedVideoChunkMetadata): Promise<void>;
  finish(): Promise<ArrayBuffer>;
  cancel(): Promise<void>;
}

async function fileOf({ format, fps }: FilmSpec, codec: Codec): Promise<FilmFile> {
  const { BufferTarget, EncodedPacket, EncodedVideoPacketSource, Mp4OutputFormat, Output, WebMOutputFormat } =
    await import('mediabunny');
  const target = new BufferTarget();
  const kind = format === 'webm' ? new WebMOutputFormat() : new Mp4OutputFormat({ fastStart: 'in-memory' });
  const output = new Output({ format: kind, target });
  const source = new EncodedVideoPacketSource(codec);
  output.addVideoTrack(source, { frameRate: fps });
  await output.start();
  return {
    add: (chunk, meta) => source.add(EncodedPacket.fromEncodedChunk(chunk), meta),
    async finish() {
      await output.finalize();
      return target.buffer!;
    },
    cancel: () => output.cancel(),
  };
}

async function video(spec: FilmSpec): Promise<Recorder> {
  const [config, codec] = await configOf(spec);
  const file = await fileOf(spec, codec);
  let failed: Error | undefined;
  const fail = (e: Error): void => {
    failed ??= e;
  };
  /** Frames are written one after another. */
  let written: Promise<void> = Promise.resolve();
  const encoder = new VideoEncoder({
    output: (chunk, meta) => {
      written = written.then(() => file.add(chunk, meta)).catch(fail);
    },
    error: fail,
  });
  encoder.configure(config);
  const second = 1e6;
  return {
    async add(pixels, frame) {
      while (encoder.encodeQueueSize > WAITING && !failed)
        await new Promise((resolve) => {
          setTimeout(resolve, 5);
        });
      if (failed) throw failed;
      const image = new VideoFrame(pixels, {
        format: 'RGBX',
        codedWidth: spec.width,
        codedHeight: spec.height,
        timestamp: Math.round((frame * second) / spec.fps),
        duration: Math.round(second / spec.fps),
      });
      encoder.encode(image, { keyFrame: frame % Math.max(1, Math.round(spec.fps * KEY_S)) === 0 });
      image.close();
    },
    async finish() {
      await encoder.flush();
      encoder.close();
      await written;
      if (failed) throw failed;
      return new Blob([await file.finish()], { type: spec.format === 'webm' ? 'video/webm' : 'video/mp4' });
    },
    cancel() {
      if (encoder.state !== 'closed') encoder.close();
      void file.cancel().catch(() => undefined);
    },
  };
}

/** Columns and rows of a sheet of frames: nearly square. */
export function sheetShape(frames: number): [number, number] {
  const columns = Math.ceil(Math.sqrt(frames));
  return [columns, Math.ceil(frames / columns)];
}

function sheet({ width, height, frames }: FilmSpec): Recorder {
  const [columns, rows] = sheetShape(frames);
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [columns * width, rows * height];
  const c = canvas.getContext('2d')!;
  return {
    async add(pixels, frame) {
      const [x, y] = [frame % columns, Math.floor(frame / columns)];
      c.putImageData(new ImageData(pixels, width, height), x * width, y * height);
    },
    finish: () => png(canvas),
    cancel() {
      canvas.width = canvas.height = 0;
    },
  };
}

function png(canvas: HTMLCanvasElement): Promise<Blob> {
  return new Promise((resolve, reject) => {
    canvas.toBlob((b) => (b ? resolve(b) : reject(new Error(t('fault.picture')))), 'image/png');
  });
}

export async function recorder(spec: FilmSpec): Promise<Recorder> {
  return spec.format === 'sheet' ? sheet(spec) : await video(spec);
}

/** Pixels as a PNG file. */
export function pngOf(pixels: Uint8ClampedArray<ArrayBuffer>, width: number, height: number): Promise<Blob> {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [width, height];
  canvas.getContext('2d')!.putImageData(new ImageData(pixels, width, height), 0, 0);
  return png(canvas);
}
