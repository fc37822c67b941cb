import { createHash } from 'node:crypto';
import { existsSync, readdirSync } from 'node:fs';
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
  } else if (/\\/(assets|presets)\\//.test(url.pathname)) {
    e.respondWith(caches.match(e.request).then((hit) => hit || fetch(e.request)));
  }
});
`;
      this.emitFile({ type: 'asset', fileName: 'sw.js', source });
    },
  };
}

export default defineConfig({
  base: './',
  plugins: [offline()],
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
