import { createHash } from 'node:crypto';
import { existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync, constants } from 'node:zlib';
import { defineConfig, type Plugin } from 'vite';

/** Pictures of species that are there: the page shows the name alone where one is missing. */
const folder = new URL('./public/presets', import.meta.url);
const pictures = existsSync(folder)
  ? readdirSync(folder)
      .filter((f) => f.endsWith('.png'))
      .sort()
  : [];

/** Writes `sw.js`: every built file by name, so that the Studio works offline after the first visit. */
function offline(): Plugin {
  return {
    name: 'offline',
    apply: 'build',
    enforce: 'post',
    generateBundle(_options, bundle) {
      const files = Object.keys(bundle)
        .filter((name) => !name.endsWith('.map'))
        .sort();
      const version = createHash('sha256')
        .update([...files, ...pictures].join('\n'))
        .digest('hex')
        .slice(0, 12);
      const source = `// Built files bear their content in their name: they never change, the page itself may.
const CACHE = 'burgeon-${version}';
const FILES = ${JSON.stringify(['./', './icon.svg', ...pictures.map((f) => `./presets/${f}`), ...files.filter((f) => f !== 'index.html').map((f) => `./${f}`)])};
self.addEventListener('install', (e) => {
  e.waitUntil(caches.open(CACHE).then((c) => c.addAll(FILES)).then(() => self.skipWaiting()));
});
self.addEventListener('activate', (e) => {
  const old = (names) => names.filter((n) => n.startsWith('burgeon-') && n !== CACHE);
  e.waitUntil(caches.keys().then((n) => Promise.all(old(n).map((k) => caches.delete(k)))).then(() => self.clients.claim()));
});
self.addEventListener('fetch', (e) => {
  const url = new URL(e.request.url);
  if (e.request.method !== 'GET' || url.origin !== location.origin) return;
  if (e.request.mode === 'navigate') {
    e.respondWith(fetch(e.request).catch(() => caches.match('./', { ignoreSearch: true })));
  } else if (/\\/(assets|presets)\\/|\\/icon\\.svg$/.test(url.pathname)) {
    e.respondWith(caches.match(e.request).then((hit) => hit || fetch(e.request)));
  }
});
`;
      this.emitFile({ type: 'asset', fileName: 'sw.js', source });
    },
  };
}

/** Files below this many bytes travel in one packet or two, whatever is done to them. */
const WORTH_PACKING = 2048;

/** Writes each large file of text or code a second time, packed by Brotli: what `burgeon studio` and good hosts send. */
function packed(): Plugin {
  let folder = '';
  return {
    name: 'packed',
    apply: 'build',
    enforce: 'post',
    configResolved(config) {
      // A page for tests is thrown away: it is not worth the seconds that this takes.
      folder = config.mode === 'test' ? '' : config.build.outDir;
    },
    closeBundle() {
      const files = folder === '' ? [] : readdirSync(folder, { recursive: true, encoding: 'utf8' });
      for (const name of files.filter((f) => /\.(?:js|css|html|svg|json|wasm)$/.test(f))) {
        const path = join(folder, name);
        const bytes = readFileSync(path);
        if (bytes.length < WORTH_PACKING) continue;
        const params = {
          [constants.BROTLI_PARAM_LGWIN]: 24,
          [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
        };
        writeFileSync(`${path}.br`, brotliCompressSync(bytes, { params }));
      }
    },
  };
}

export default defineConfig({
  base: './',
  plugins: [offline(), packed()],
  define: { PRESET_PICTURES: JSON.stringify(pictures.map((f) => f.slice(0, -4))) },
  worker: { format: 'es' },
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: false,
    // three.js alone is beyond the usual warning; what is sent is measured by the tests.
    chunkSizeWarningLimit: 1200,
  },
  // Drawings that serve as samples lie outside this folder.
  server: { host: '127.0.0.1', fs: { allow: ['../..'] } },
  // The contrast of colours is read from the style sheet itself.
  test: { include: ['src/**/*.test.ts'], css: true },
} as Parameters<typeof defineConfig>[0]);
