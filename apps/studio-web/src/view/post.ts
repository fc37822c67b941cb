/**
 * Pictures that are drawn into a buffer first: with ambient occlusion and depth of field, at any size, with
 * transparency. Loaded when it is first wanted.
 */
import * as THREE from 'three';
import { GTAOPass } from 'three/examples/jsm/postprocessing/GTAOPass.js';
import { OutputPass } from 'three/examples/jsm/postprocessing/OutputPass.js';
import { FullScreenQuad } from 'three/examples/jsm/postprocessing/Pass.js';
import { BokehShader } from 'three/examples/jsm/shaders/BokehShader.js';

export interface Effects {
  /** Corners and crowns are darker. */
  occlusion: boolean;
  /** Depth of field, 0 to 1, and the distance that is sharp. */
  blur: number;
  focus: number;
  /** Colours are not multiplied by their share. */
  transparent: boolean;
  /** How much wider the whole picture is than the part of it that is drawn. */
  zoom: number;
}

/** How far an occluder works, in heights of a plant. */
const REACH = 0.09;
/** Blur at its strongest, of the height of the picture. */
const MOST_BLUR = 0.012;
const SAMPLES = 4;

/** What only copies: with divided colours, so that the tone curve sees the colours of half-seen edges as they are. */
const DIVIDE = {
  vertexShader: 'varying vec2 vUv; void main() { vUv = uv; gl_Position = vec4(position.xy, 1.0, 1.0); }',
  fragmentShader: `
uniform sampler2D tDiffuse;
varying vec2 vUv;
void main() {
  vec4 c = texture2D(tDiffuse, vUv);
  gl_FragColor = vec4(c.a > 0.0 ? c.rgb / c.a : vec3(0.0), c.a);
}`,
};

/** Sky, sheet and backdrop of the stage have no share (alpha 0): they are shown as they are and not toned. */
function keepMarked(output: OutputPass): void {
  const { material } = output;
  material.uniforms['marked'] = { value: 1 };
  material.fragmentShader = material.fragmentShader
    .replace('uniform sampler2D tDiffuse;', 'uniform sampler2D tDiffuse;\nuniform float marked;')
    .replace(
      'gl_FragColor = texture2D( tDiffuse, vUv );',
      'gl_FragColor = texture2D( tDiffuse, vUv );\nvec4 raw = gl_FragColor;',
    )
    .replace(
      '// color space',
      'gl_FragColor.rgb = mix( raw.rgb, gl_FragColor.rgb, marked > 0.5 ? clamp( raw.a, 0.0, 1.0 ) : 1.0 );\n' +
        'gl_FragColor.a = max( marked, raw.a );\n// color space',
    );
}

export class Pipeline {
  private readonly first: THREE.WebGLRenderTarget;
  private readonly second: THREE.WebGLRenderTarget;
  private readonly occlusion: GTAOPass;
  private readonly output = new OutputPass();
  private readonly bokeh: FullScreenQuad;
  private readonly divide: FullScreenQuad;
  private width = 1;
  private height = 1;

  constructor(private readonly renderer: THREE.WebGLRenderer) {
    keepMarked(this.output);
    const depthTexture = new THREE.DepthTexture(1, 1, THREE.UnsignedIntType);
    this.first = new THREE.WebGLRenderTarget(1, 1, {
      type: THREE.HalfFloatType,
      samples: SAMPLES,
      depthTexture,
    });
    this.second = new THREE.WebGLRenderTarget(1, 1, { type: THREE.HalfFloatType, depthBuffer: false });
    this.occlusion = new GTAOPass(new THREE.Scene(), new THREE.PerspectiveCamera(), 1, 1, { depthTexture });
    this.occlusion.updateGtaoMaterial({
      radius: REACH,
      distanceExponent: 1,
      thickness: 0.4,
      scale: 1.2,
      samples: 12,
    });
    this.occlusion.blendIntensity = 0.85;
    this.bokeh = new FullScreenQuad(
      new THREE.ShaderMaterial({
        defines: { DEPTH_PACKING: 0, PERSPECTIVE_CAMERA: 1 },
        uniforms: THREE.UniformsUtils.clone(BokehShader.uniforms),
        vertexShader: BokehShader.vertexShader,
        // What is not there stays so.
        fragmentShader: BokehShader.fragmentShader.replace('gl_FragColor.a = 1.0;', ''),
        depthTest: false,
        depthWrite: false,
      }),
    );
    this.divide = new FullScreenQuad(
      new THREE.ShaderMaterial({
        ...DIVIDE,
        uniforms: { tDiffuse: { value: null } },
        depthTest: false,
        depthWrite: false,
        blending: THREE.NoBlending,
      }),
    );
  }

  private size(width: number, height: number): void {
    if (width === this.width && height === this.height) return;
    [this.width, this.height] = [width, height];
    this.first.setSize(width, height);
    this.second.setSize(width, height);
    this.occlusion.setSize(width, height);
  }

  /** Draws into `to`, or onto the screen. `width`, `height`: pixels. */
  render(
    scene: THREE.Scene,
    camera: THREE.PerspectiveCamera | THREE.OrthographicCamera,
    width: number,
    height: number,
    to: THREE.WebGLRenderTarget | null,
    { occlusion, blur, focus, transparent, zoom }: Effects,
  ): void {
    const { renderer } = this;
    this.size(width, height);
    renderer.setRenderTarget(this.first);
    renderer.setClearColor(0, transparent ? 0 : 1);
    renderer.clear();
    renderer.render(scene, camera);
    let [now, next] = [this.first, this.second];
    const swap = (): void => {
      [now, next] = [next, now];
    };
    const deep = camera instanceof THREE.PerspectiveCamera;
    if (occlusion && deep) {
      this.occlusion.scene = scene;
      this.occlusion.camera = camera;
      this.occlusion.render(renderer, next, now, 0, false);
      swap();
    }
    if (blur > 0 && deep) {
      const { uniforms } = this.bokeh.material as THREE.ShaderMaterial;
      uniforms['tColor']!.value = now.texture;
      uniforms['tDepth']!.value = this.first.depthTexture;
      uniforms['focus']!.value = focus;
      uniforms['aspect']!.value = width / height;
      uniforms['aperture']!.value = 0.02 * blur * zoom;
      uniforms['maxblur']!.value = MOST_BLUR * blur * zoom;
      uniforms['nearClip']!.value = camera.near;
      uniforms['farClip']!.value = camera.far;
      // The depth that is read may not be written meanwhile.
      const into = now === this.first ? this.second : this.third();
      renderer.setRenderTarget(into);
      this.bokeh.render(renderer);
      now = into;
    }
    if (transparent) {
      const into = now === this.second ? this.third() : this.second;
      (this.divide.material as THREE.ShaderMaterial).uniforms['tDiffuse']!.value = now.texture;
      renderer.setRenderTarget(into);
      this.divide.render(renderer);
      now = into;
    }
    this.output.material.uniforms['marked']!.value = transparent ? 0 : 1;
    this.output.renderToScreen = to === null;
    this.output.material.blending = THREE.NoBlending;
    this.output.render(renderer, to as THREE.WebGLRenderTarget, now, 0, false);
    renderer.setRenderTarget(null);
    renderer.setClearColor(0, 1);
  }

  private spare: THREE.WebGLRenderTarget | undefined;

  private third(): THREE.WebGLRenderTarget {
    this.spare ??= new THREE.WebGLRenderTarget(1, 1, { type: THREE.HalfFloatType, depthBuffer: false });
    this.spare.setSize(this.width, this.height);
    return this.spare;
  }

  dispose(): void {
    this.first.dispose();
    this.second.dispose();
    this.spare?.dispose();
    this.occlusion.dispose();
    this.output.dispose();
    this.bokeh.dispose();
    this.divide.dispose();
  }
}
