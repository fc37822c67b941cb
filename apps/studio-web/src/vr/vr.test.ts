import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import { indexOf, Track } from './controller';
import { World } from './world';
import { layOut } from './wrist';

const v = (x: number, y: number, z: number): THREE.Vector3 => new THREE.Vector3(x, y, z);

describe('a controller', () => {
  it('has its buttons by component, whatever the profile', () => {
    const quest = ['meta-quest-touch-plus', 'oculus-touch-v3', 'generic-trigger-squeeze-thumbstick'];
    expect([indexOf('trigger', quest), indexOf('upper', quest)]).toEqual([0, 5]);
    expect(indexOf('upper', ['pico-4u', 'generic-trigger-squeeze-thumbstick'])).toBe(5);
    // One button above the pad alone, or none.
    expect([indexOf('lower', ['valve-index']), indexOf('upper', ['valve-index'])]).toEqual([4, undefined]);
    expect(indexOf('upper', ['htc-vive', 'generic-trigger-squeeze-touchpad'])).toBeUndefined();
  });

  it('is lost while its tracker jumps, and somewhere else if that lasts', () => {
    const track = new Track();
    expect(track.read(v(0, 1, 0))).toBe('here');
    expect(track.read(v(0.1, 1, 0))).toBe('here');
    expect(track.read(undefined)).toBe('lost');
    expect(track.read(v(Number.NaN, 1, 0))).toBe('lost');
    expect(track.read(v(3, 1, 0))).toBe('lost');
    expect(track.read(v(0.1, 1, 0)), 'one frame astray').toBe('here');
    const far = Array.from({ length: 6 }, () => track.read(v(3, 1, 0)));
    expect(far).toEqual(['lost', 'lost', 'lost', 'lost', 'jumped', 'here']);
  });
});

describe('the world', () => {
  const scene = (w: World, p: THREE.Vector3): number[] => w.toScene(p, v(0, 0, 0)).toArray();
  const near = (a: readonly number[], b: readonly number[]): void =>
    a.forEach((x, i) => expect(x).toBeCloseTo(b[i]!, 9));

  it('stays in the hands that hold it', () => {
    const w = new World();
    w.stand(false, 0.2, 0.4, 0);
    const [a, b] = [v(-0.3, 1, -0.4), v(0.2, 1.3, -0.5)];
    const before = [scene(w, a), scene(w, b)];
    w.grasp([a, b]);
    // Turned about the vertical, moved and parted: each hand still holds what it held.
    const to = (p: THREE.Vector3): THREE.Vector3 =>
      p
        .clone()
        .applyAxisAngle(v(0, 1, 0), 0.7)
        .multiplyScalar(1.4)
        .add(v(0.1, -0.2, 0.3));
    w.grasp([to(a), to(b)]);
    near(scene(w, to(a)), before[0]!);
    near(scene(w, to(b)), before[1]!);
    w.grasp([]);
    // One hand moves it, and neither turns nor scales it.
    const [size, held] = [w.size, scene(w, a)];
    w.grasp([a]);
    w.grasp([a.clone().add(v(0.2, 0.1, 0))]);
    near(scene(w, a.clone().add(v(0.2, 0.1, 0))), held);
    expect(w.size).toBe(size);
  });

  it('turns about the head and goes where it is pointed', () => {
    const w = new World();
    w.stand(true, 0.1, 0.5, 0.2);
    const head = v(0.3, 1.6, -0.2);
    const at = scene(w, head);
    w.turn(Math.PI / 6, head);
    near(scene(w, head), at);
    w.go(v(2, 0, -3), head);
    const [x, y, z] = scene(w, head);
    near([x!, y!, z!], [2, at[1]!, -3]);
    const landing = w.landing(v(0, 1.2 * w.size, 0), v(0, 0, -1), v(0, 0, 0));
    // 1.2 m fall in 0.495 s.
    expect(landing!.z / w.size).toBeCloseTo(-7 * Math.sqrt(2.4 / 9.81), 9);
    expect(w.landing(v(0, 1, 0), v(0, 1, 0), v(0, 0, 0))?.toArray()).toBeUndefined();
  });

  it('brings a tree of any size to arm’s length, and a person to a tree', () => {
    for (const metre of [0.02, 0.125, 2]) {
      const w = new World();
      w.stand(false, metre, 0.4, 0);
      // A plant is one unit tall.
      expect(1 / w.size).toBeCloseTo(1.2, 9);
      w.stand(true, metre, 0.4, 0);
      expect(w.size).toBeCloseTo(metre, 9);
      expect(w.rig.position.z).toBeGreaterThan(0.4);
    }
  });
});

it('keys lie in rows', () => {
  const key = (id: string, wide: number) => ({ id, label: id, wide, act: () => undefined });
  const placed = layOut([[key('a', 2), key('b', 4)], [key('c', 3)]]);
  expect(placed.map((k) => [k.id, k.x * 6, k.y, k.w * 6])).toEqual([
    ['a', 0, 0, 2],
    ['b', 2, 0, 4],
    ['c', 0, 1, 3],
  ]);
});
