/** Drawings of this repository that a person can start from. */
const FILES = import.meta.glob('../../../../fixtures/sketches/**/*.svg', {
  query: '?url',
  import: 'default',
  eager: true,
}) as Record<string, string>;

const WANTED = [
  'sample',
  'gallery/sunflower',
  'gallery/tulip',
  'gallery/lily',
  'gallery/house-plant',
  'gallery/apple-tree',
  'gallery/oak',
  'gallery/palm',
];

export interface Sample {
  name: string;
  url: string;
}

export const SAMPLES: readonly Sample[] = WANTED.flatMap((path) => {
  const url = FILES[`../../../../fixtures/sketches/${path}.svg`];
  return url ? [{ name: path.split('/').at(-1)!, url }] : [];
});

/** The table of a measured leaf to start from. Loaded when it is first asked for. */
export async function leafSample(): Promise<string> {
  return (await import('../../../../fixtures/leaves/leaf1.csv?raw')).default;
}
