import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { BLOW } from '../../../npm/lib/blow';
import { blown, gustOf } from './wind';
import * as THREE from 'three';

const words = (text: string): string => text.replace(/\s+/g, ' ').trim();

describe('wind', () => {
  it('moves the view as the documents tell other programs to', () => {
    const page = readFileSync(new URL('../../../../docs/exports.md', import.meta.url));
    expect(words(new TextDecoder().decode(page))).toContain(words(BLOW));
  });

  it('finds its place in the shaders of three.js', () => {
    for (const name of ['standard', 'lambert', 'depth'] as const) {
      const material = blown(new THREE.MeshLambertMaterial(), gustOf());
      const { vertexShader } = THREE.ShaderLib[name];
      const shader = { vertexShader, uniforms: {} };
      material.onBeforeCompile(shader as never, undefined as never);
      expect(shader.vertexShader).toContain('blow(position), strength)');
      expect(shader.vertexShader.split('uniform float strength;')).toHaveLength(2);
      expect(Object.keys(shader.uniforms).sort()).toEqual(['gust', 'strength', 'time']);
    }
  });
});
