// A tree as a component of react-three-fiber: it suspends while it grows, and grows anew when its species or seed changes.
import { Canvas } from '@react-three/fiber';
import { grow } from 'burgeon';
import { Suspense, use, useEffect, useMemo, useState } from 'react';
import { createRoot } from 'react-dom/client';

const growing = new Map();
function grown(species, options) {
  const key = JSON.stringify([species, options]);
  if (!growing.has(key)) growing.set(key, grow(species, options));
  return growing.get(key);
}

function Tree({ species, seed = 1, detail = 1, wind = 0.3, ...props }) {
  const tree = use(grown(species, { seed, detail, lods: 2 }));
  const object = useMemo(() => tree.object3D({ wind }), [tree, wind]);
  return <primitive object={object} {...props} />;
}

const detail = Number(new URLSearchParams(location.search).get('detail') ?? 1);

function Scene() {
  const [seed, setSeed] = useState(1);
  return (
    <>
      <hemisphereLight args={['#ffffff', '#7a7a60', 1.8]} />
      <directionalLight castShadow position={[8, 14, 9]} intensity={2.6} shadow-mapSize={[1024, 1024]}>
        <orthographicCamera attach="shadow-camera" args={[-14, 14, 14, -14, 0.1, 50]} />
      </directionalLight>
      <mesh receiveShadow rotation-x={-Math.PI / 2}>
        <circleGeometry args={[60, 48]} />
        <meshStandardMaterial color="#94a06e" roughness={1} />
      </mesh>
      <Suspense fallback={null}>
        <Tree species="maple" seed={seed} detail={detail} onClick={() => setSeed(seed + 1)} />
        <Tree species="birch" seed={3} detail={detail} position={[-7, 0, -4]} />
        <Tree species="pine" seed={2} detail={detail} position={[7, 0, -6]} />
        <Ready />
      </Suspense>
    </>
  );
}

/** Tells the tests that all trees stand. */
function Ready() {
  useEffect(() => {
    document.body.dataset.ready = 'yes';
  }, []);
  return null;
}

createRoot(document.getElementById('root')).render(
  <Canvas
    shadows="percentage"
    camera={{ position: [0, 4, 22], fov: 40 }}
    onCreated={({ camera }) => camera.lookAt(0, 4, 0)}
  >
    <Scene />
  </Canvas>,
);
