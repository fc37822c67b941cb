// A tree in three.js, with levels of detail, shadows and wind; a stand of birches behind it; flowers before it.
import { bloom, BurgeonError, grow, TREES } from 'burgeon';
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const form = document.querySelector('form');
const say = (text) => {
  form.querySelector('output').textContent = text;
};
form.species.append(...TREES.map((key) => new Option(key, key, key === 'oak', key === 'oak')));
// ?detail=0.3: coarser, for machines without a graphics card.
const detail = Number(new URLSearchParams(location.search).get('detail') ?? 1);

const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.shadowMap.enabled = true;
renderer.toneMapping = THREE.ACESFilmicToneMapping;
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xcfdce6);
scene.fog = new THREE.Fog(0xcfdce6, 30, 90);
const camera = new THREE.PerspectiveCamera(40, 1, 0.1, 200);
camera.position.set(9, 4, 17);
const controls = new OrbitControls(camera, renderer.domElement);
controls.target.set(0, 4, 0);
const sun = new THREE.DirectionalLight(0xfff4e0, 3);
sun.position.set(8, 14, 9);
sun.castShadow = true;
sun.shadow.mapSize.set(2048, 2048);
Object.assign(sun.shadow.camera, { left: -14, right: 14, top: 14, bottom: -14, far: 50 });
sun.shadow.normalBias = 0.03;
scene.add(sun, new THREE.HemisphereLight(0xdfeeff, 0x6b6a50, 1.6));
const ground = new THREE.Mesh(
  new THREE.CircleGeometry(100, 64).rotateX(-Math.PI / 2),
  new THREE.MeshStandardMaterial({ color: 0x7f8f5a, roughness: 1 }),
);
ground.receiveShadow = true;
scene.add(ground);

let shown;
async function show() {
  const started = performance.now();
  say('growing …');
  try {
    const tree = await grow(form.species.value, { seed: form.seed.valueAsNumber, lods: 2, detail });
    shown?.removeFromParent();
    shown = tree.object3D();
    shown.userData.wind.strength.value = form.wind.valueAsNumber;
    scene.add(shown);
    say(
      `${tree.report.counts.triangles.toLocaleString('en')} triangles, ${Math.round(performance.now() - started)} ms`,
    );
  } catch (e) {
    if (!(e instanceof BurgeonError)) throw e;
    say(e.message);
  }
}

/** Thirty birches in a ring: three draws. */
async function stand() {
  const birch = await grow('birch', { seed: 4, detail: Math.min(detail, 0.3), lods: 2, texture_size: 256 });
  const places = Array.from({ length: 30 }, (_, k) => {
    const [turn, far] = [k * 2.4, 20 + ((k * 37) % 23)];
    return {
      x: far * Math.cos(turn),
      z: far * Math.sin(turn),
      yaw: k * 77,
      scale: 0.8 + 0.013 * ((k * 29) % 31),
    };
  });
  scene.add(birch.stand(places, { level: 2, wind: 0.3 }));
}

async function flowers() {
  const tulip = await bloom('tulip', { seed: 3 });
  for (let k = 0; k < 7; k++) {
    const object = tulip.object3D({ wind: 0.2 });
    object.position.set(2.6 + 0.12 * k * Math.cos(k * 2.4), 0, 4.6 + 0.12 * k * Math.sin(k * 2.4));
    object.rotation.y = k;
    object.scale.setScalar(2);
    scene.add(object);
  }
}

form.species.onchange = form.seed.onchange = show;
form.wind.oninput = () => {
  if (shown) shown.userData.wind.strength.value = form.wind.valueAsNumber;
};
const resize = () => {
  renderer.setSize(innerWidth, innerHeight);
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
};
addEventListener('resize', resize);
resize();
renderer.setAnimationLoop(() => {
  controls.update();
  renderer.render(scene, camera);
});
await Promise.all([show(), stand(), flowers()]);
document.body.dataset.ready = 'yes';
