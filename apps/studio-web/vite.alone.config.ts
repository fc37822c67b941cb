import { readFileSync, writeFileSync } from 'node:fs';
import { gzipSync } from 'node:zlib';
import { defineConfig, type Plugin } from 'vite';

const OUT = 'dist-alone';

/** Writes the script a second time, packed, as the Python package holds it. */
const packed: Plugin = {
  name: 'packed',
  closeBundle() {
    writeFileSync(`${OUT}/alone.js.gz`, gzipSync(readFileSync(`${OUT}/alone.js`), { level: 9 }));
  },
};

/** `src/alone`: one script, for HTML that needs nothing else. */
export default defineConfig({
  publicDir: false,
  plugins: [packed],
  build: {
    target: 'es2022',
    outDir: OUT,
    lib: { entry: 'src/alone/alone.ts', formats: ['iife'], name: 'burgeonAlone', fileName: () => 'alone.js' },
    chunkSizeWarningLimit: 1200,
  },
});
