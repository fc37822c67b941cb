/** The soft darkness where plants touch the ground: their lowest parts seen from below, blurred (three's example). */
import * as THREE from 'three';
import { FullScreenQuad } from 'three/examples/jsm/postprocessing/Pass.js';
import { HorizontalBlurShader } from 'three/examples/jsm/shaders/HorizontalBlurShader.js';
import { VerticalBlurShader } from 'three/examples/jsm/shaders/VerticalBlurShader.js';

/** Side of the square that is seen, and how high parts still darken it, in heights of a plant. */
const SIDE = 2.4;
const HEIGHT = 0.16;
const PIXELS = 512;
const DARKNESS = 1.3;

export class Contact {
  readonly plane: THREE.Mesh<THREE.PlaneGeometry, THREE.MeshBasicMaterial>;
  private readonly camera = new THREE.OrthographicCamera(-SIDE / 2, SIDE / 2, SIDE / 2, -SIDE / 2, 0, HEIGHT);
  private readonly seen = new THREE.WebGLRenderTarget(PIXELS, PIXELS);
  private readonly between = new THREE.WebGLRenderTarget(PIXELS, PIXELS);
  private readonly depth = new THREE.MeshDepthMaterial();
  private readonly across = blurred(HorizontalBlurShader);
  private readonly along = blurred(VerticalBlurShader);

  constructor() {
    this.plane = new THREE.Mesh(
      new THREE.PlaneGeometry(SIDE, SIDE),
      new THREE.MeshBasicMaterial({
        map: this.seen.texture,
        transparent: true,
        depthWrite: false,
        toneMapped: false,
        fog: false,
      }),
    );
    this.plane.rotation.x = -Math.PI / 2;
    this.plane.position.y = 0.0012;
    this.plane.renderOrder = -0.5;
    this.camera.rotation.x = Math.PI / 2;
    // The nearer to the ground, the darker.
    this.depth.onBeforeCompile = (shader) => {
      shader.fragmentShader = shader.fragmentShader.replace(
        'gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );',
        `gl_FragColor = vec4( vec3( 0.0 ), ( 1.0 - fragCoordZ ) * ${DARKNESS.toFixed(2)} );`,
      );
    };
    this.depth.depthTest = this.depth.depthWrite = false;
    this.depth.side = THREE.DoubleSide;
  }

  /** `only`: what throws it. */
  update(renderer: THREE.WebGLRenderer, scene: THREE.Scene, only: THREE.Object3D): void {
    const hidden = scene.children.filter((c) => c !== only && c.visible);
    for (const c of hidden) c.visible = false;
    const { background, fog, environment } = scene;
    scene.background = scene.fog = scene.environment = null;
    scene.overrideMaterial = this.depth;
    renderer.setRenderTarget(this.seen);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(scene, this.camera);
    scene.overrideMaterial = null;
    scene.background = background;
    scene.fog = fog;
    scene.environment = environment;
    for (const c of hidden) c.visible = true;
    for (const width of [3.4, 1.4]) {
      this.blur(renderer, this.across, this.seen, this.between, width);
      this.blur(renderer, this.along, this.between, this.seen, width);
    }
    renderer.setRenderTarget(null);
    renderer.setClearColor(0, 1);
  }

  private blur(
    renderer: THREE.WebGLRenderer,
    quad: FullScreenQuad,
    from: THREE.WebGLRenderTarget,
    to: THREE.WebGLRenderTarget,
    width: number,
  ): void {
    const { uniforms } = quad.material as THREE.ShaderMaterial;
    uniforms['tDiffuse']!.value = from.texture;
    for (const name of ['h', 'v']) if (uniforms[name]) uniforms[name].value = width / 256;
    renderer.setRenderTarget(to);
    quad.render(renderer);
  }
}

function blurred(shader: typeof HorizontalBlurShader | typeof VerticalBlurShader): FullScreenQuad {
  return new FullScreenQuad(
    new THREE.ShaderMaterial({
      uniforms: THREE.UniformsUtils.clone(shader.uniforms),
      vertexShader: shader.vertexShader,
      fragmentShader: shader.fragmentShader,
      depthTest: false,
      depthWrite: false,
      blending: THREE.NoBlending,
    }),
  );
}
