import * as THREE from 'three';
import { describe, expect, it } from 'vitest';
import type { Request } from '../worker/protocol';
import { obstacleAround } from '../view/obstacles';
import type { HandEdit } from '../wire';
import { Carried } from './carried';
import { Controller, indexOf, Pinch, Track } from './controller';
import { Lesson } from './lesson';
import { obstacleOf } from './placing';
import { Recorder } from './recorder';
import { Trace } from './trace';
import { World } from './world';
import { brokenLine, layOut } from './wrist';

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

describe('a place that is guessed', () => {
  /** A controller of which a picture after the other says where it is, and whether that is a guess. */
  const reading = (
    profiles = ['oculus-go'],
  ): ((x: number, guessed: boolean) => [boolean, boolean, number]) => {
    let pose: unknown;
    const frame = { getPose: () => pose } as unknown as XRFrame;
    const source = { profiles, targetRaySpace: {}, handedness: 'right' };
    const hand = new Controller(source as unknown as XRInputSource);
    return (x, guessed) => {
      const matrix = new THREE.Matrix4().setPosition(x, 1, 0).toArray();
      pose = { transform: { matrix, position: v(x, 1, 0) }, emulatedPosition: guessed };
      hand.read(frame, {} as XRReferenceSpace);
      return [hand.tracked, hand.isPointer, Number(hand.tip.x.toFixed(6))];
    };
  };

  it('is one to point from, of a controller whose place was never seen', () => {
    const read = reading();
    expect([read(0, true), read(0.1, true)]).toEqual([
      [true, true, 0],
      [true, true, 0.1],
    ]);
  });

  it('means nothing of a controller with a grip', () => {
    const read = reading(['meta-quest-touch-plus', 'generic-trigger-squeeze-thumbstick']);
    expect([read(0, true), read(0.1, true)]).toEqual([
      [true, false, 0],
      [true, false, 0.1],
    ]);
  });

  it('is as good as lost, once the place was seen', () => {
    const read = reading();
    expect([read(0, true)[1], read(0.1, false)[1]]).toEqual([true, false]);
    expect(read(0.2, true)).toEqual([false, false, 0.1]);
    expect(read(0.3, false)).toEqual([true, false, 0.3]);
  });
});

describe('a trace', () => {
  const rings = (trace: Trace): THREE.Vector3[][] => {
    const place = trace.mesh.geometry.getAttribute('position');
    const corner = (k: number): THREE.Vector3 => new THREE.Vector3().fromBufferAttribute(place, k);
    return Array.from({ length: trace.points }, (_, row) =>
      Array.from({ length: 5 }, (_, side) => corner(5 * row + side)),
    );
  };

  it('is a tube about the way of the hand, as thick as it presses', () => {
    const trace = new Trace();
    const way = Array.from({ length: 40 }, (_, k) =>
      v(Math.cos(k / 6), k / 20, Math.sin(k / 6)).multiplyScalar(0.2),
    );
    way.forEach((at, k) => trace.add(at, k < 20 ? 1 : 0, 2));
    // Where the hand stays, and where it is nowhere, nothing is added.
    trace.add(way.at(-1)!, 1, 2);
    trace.add(v(Number.NaN, 0, 0), 1, 2);
    expect(trace.points).toBe(40);
    const radius = (2 * trace.mm) / 2000;
    rings(trace).forEach((ring, k) => {
      for (const corner of ring)
        expect(corner.distanceTo(way[k]!)).toBeCloseTo(k < 20 ? radius : 0.4 * radius, 6);
    });
    // It does not twist: a corner goes straight on.
    const out = rings(trace).map((ring, k) => ring[0]!.sub(way[k]!).normalize());
    for (let k = 1; k < out.length; k += 1) expect(out[k]!.dot(out[k - 1]!)).toBeGreaterThan(0.95);
    expect(trace.mesh.geometry.drawRange.count).toBe(39 * 30);
    trace.begin();
    expect([trace.points, trace.mesh.geometry.drawRange.count]).toEqual([0, 0]);
  });

  it('has an end, colours and thicknesses', () => {
    const trace = new Trace();
    for (let k = 0; k < 3000; k += 1) trace.add(v(k, 0, 0), 1, 1);
    expect(trace.points).toBe(2048);
    const colours = new Set<number>();
    const thick = new Set<number>();
    for (let k = 0; k < 15; k += 1) {
      colours.add(trace.hex);
      thick.add(trace.mm);
      trace.nextColour();
      trace.nextThickness();
      expect(trace.mesh.material.color.getHex()).toBe(trace.hex);
    }
    expect([colours.size, [...thick]]).toEqual([5, [3, 6, 12]]);
  });
});

it('a long line is broken where a part of it ends', () => {
  expect(brokenLine('Trigger: the tool · Grip: turn a branch')).toEqual([
    'Trigger: the tool',
    'Grip: turn a branch',
  ]);
  expect(brokenLine('What you draw, brush or grow is made')).toEqual([
    'What you draw, brush',
    'or grow is made',
  ]);
  expect(brokenLine('绘制涂刷或生长的枝条会出现在两侧')).toEqual(['绘制涂刷或生长的', '枝条会出现在两侧']);
});

describe('an obstacle that is drawn out', () => {
  it('is a ball about its middle or a box between corners, whichever way the hand goes', () => {
    expect(obstacleOf('ball', [1, 2, 3], [1, 2, 3.5], 0.1)).toEqual({
      shape: 'sphere',
      centre: [1, 2, 3],
      radius_m: 0.5,
    });
    const box = { shape: 'box', min: [0, 0, 0], max: [1, 2, 3] };
    expect(obstacleOf('box', [0, 2, 0], [1, 0, 3], 0.1)).toEqual(box);
    expect(obstacleOf('box', [1, 0, 3], [0, 2, 0], 0.1)).toEqual(box);
  });

  it('has a size of its own where the hand stays, and is nowhere flat', () => {
    expect(obstacleOf('ball', [0, 1, 0], [0, 1, 0.01], 0.2)).toMatchObject({ radius_m: 0.2 });
    expect(obstacleOf('box', [0, 1, 0], [0, 1, 0], 0.2)).toEqual({
      shape: 'box',
      min: [-0.1, 0.9, -0.1],
      max: [0.1, 1.1, 0.1],
    });
    const flat = obstacleOf('box', [0, 1, 0], [2, 1, 0], 0.2);
    expect(flat).toEqual({ shape: 'box', min: [0, 0.95, -0.05], max: [2, 1.05, 0.05] });
  });
});

/** A hand of which the tips of three fingers are seen, or nothing; `gaps` of the thumb to the others. */
function fingers(): { hand: Controller; see(at: THREE.Vector3 | undefined, gaps?: [number, number]): void } {
  const names = ['thumb-tip', 'index-finger-tip', 'middle-finger-tip'] as const;
  let places: (THREE.Vector3 | undefined)[] = [];
  const joints = new Map(names.map((name) => [name, { name }]));
  const pose = (p: THREE.Vector3 | undefined) =>
    p && { transform: { position: p, matrix: new THREE.Matrix4().setPosition(p).toArray() } };
  const frame = {
    getPose: () => pose(places[0]),
    getJointPose: ({ name }: { name: (typeof names)[number] }) => pose(places[names.indexOf(name)]),
  } as unknown as XRFrame;
  const source = { hand: joints, profiles: ['generic-hand'], targetRaySpace: {}, handedness: 'right' };
  const hand = new Controller(source as unknown as XRInputSource);
  return {
    hand,
    see(at, [fore, middle] = [0.1, 0.1]) {
      places = at ? [at, v(at.x + fore, at.y, at.z), v(at.x, at.y + middle, at.z)] : [];
      hand.read(frame, {} as XRReferenceSpace);
    },
  };
}

describe('a hand without a controller', () => {
  it('pinches when the gap closes, and lets go further apart', () => {
    const pinch = new Pinch();
    const said = [0.05, 0.02, 0.017, 0.025, 0.031, undefined, Number.NaN, 0.04, 0.02].map((g) =>
      pinch.read(g),
    );
    expect(said).toEqual([false, false, true, true, true, true, true, false, false]);
  });

  it('has its forefinger for a trigger and its middle finger for a grip, never both', () => {
    const { hand, see } = fingers();
    const at = v(0, 1, 0);
    see(at);
    expect([hand.isHand, hand.holds('trigger'), hand.holds('grip')]).toEqual([true, false, false]);
    see(at, [0.01, 0.01]);
    expect([hand.pressed('trigger'), hand.holds('grip')]).toEqual([true, false]);
    // It draws between the fingertips.
    expect(hand.tip.toArray()).toEqual([0.005, 1, 0]);
    see(at);
    expect(hand.released('trigger')).toBe(true);
    see(at, [0.1, 0.01]);
    expect([hand.holds('trigger'), hand.pressed('grip')]).toEqual([false, true]);
  });

  it('that is lost while it pinches keeps pinching, and jumps where it comes back elsewhere', () => {
    const { hand, see } = fingers();
    see(v(0, 1, 0), [0.01, 0.1]);
    for (let k = 0; k < 30; k += 1) {
      see(undefined);
      expect([hand.tracked, hand.holds('trigger'), hand.released('trigger')]).toEqual([false, true, false]);
    }
    see(v(0.02, 1, 0), [0.01, 0.1]);
    expect([hand.tracked, hand.jumped, hand.holds('trigger')]).toEqual([true, false, true]);
    // Open again, but elsewhere: where it was last counts.
    const states = Array.from({ length: 6 }, () => {
      see(v(2, 1, 0));
      return hand.jumped ? 'jumped' : hand.tracked ? 'here' : 'lost';
    });
    expect(states).toEqual(['lost', 'lost', 'lost', 'lost', 'jumped', 'here']);
  });
});

it('the first steps are told one after another, and kept', () => {
  const kept: number[] = [];
  const lesson = new Lesson(0, (n) => kept.push(n));
  expect([lesson.did('undo'), lesson.did('turn'), lesson.step]).toEqual([false, true, 'draw']);
  expect([lesson.did('draw'), lesson.did('undo'), lesson.step]).toEqual([true, true, undefined]);
  lesson.again();
  expect([kept, lesson.step, new Lesson(3, () => undefined).step]).toEqual([[1, 2, 3, 0], 'turn', undefined]);
  // What a browser kept of another version is no fault.
  expect(new Lesson(Number.NaN, () => undefined).step).toBeUndefined();
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

describe('a record', () => {
  const at = {
    origin: [0, 0, 0],
    direction: [0, 0, -1],
    forward: [0, 0, -1],
    up: [0, 1, 0],
    pressure: 1,
    tip: null,
  };
  const reach = { metres: 0.1, per_metre: 0.02, bearers: 0, mirror: null };
  const shape = (input: unknown): Request => ({ kind: 'shape', tool: 'rotate', reach, input }) as Request;

  it('has every request in the order in which the core did it', () => {
    let now = 100;
    const recorder = new Recorder(() => now);
    const edit = { op: 'prune' } as unknown as HandEdit;
    // Before it begins and after it ends nothing is written down.
    recorder.did(shape({ down: at }), {});
    const numbers = { plants: [1, 3], next: 4 };
    recorder.start(new Uint8Array([110, 111, 110, 101]), { plant: 3, numbers });
    now = 112.4;
    recorder.did(shape({ down: at }), { commit: null });
    recorder.seen();
    recorder.did(shape({ up: at }), { commit: edit });
    recorder.did({ kind: 'command', command: { shape: [3, { add: edit }] } }, null);
    // The same edit by another hand is a command of its own.
    recorder.did({ kind: 'command', command: { shape: [3, { add: edit }] } }, null);
    recorder.did({ kind: 'undo' }, null);
    recorder.did({ kind: 'save' }, null);
    recorder.did({ kind: 'select', plant: 2 }, null);
    const record = recorder.stop('d1');
    expect(record).toMatchObject({
      schema: 'burgeon.gestures/1',
      project: 'bm9uZQ==',
      plant: 3,
      numbers,
      digest: 'd1',
    });
    expect(record?.steps.map((s) => (typeof s.did === 'string' ? s.did : Object.keys(s.did)[0]))).toEqual([
      'hand',
      'seen',
      'hand',
      'keep',
      'command',
      'undo',
      'select',
    ]);
    expect(record?.steps[0]?.ms).toBe(12);
    recorder.did({ kind: 'undo' }, null);
    expect(recorder.stop('d2')).toBeUndefined();
  });
});

it('an obstacle is taken where the hand is in it', () => {
  const ball = new THREE.Mesh(new THREE.SphereGeometry(0.5));
  ball.position.set(1, 0, 0);
  const box = new THREE.Mesh(new THREE.BoxGeometry(1, 1, 1));
  const wall = new THREE.Mesh(new THREE.PlaneGeometry(10, 10));
  [wall, ball, box].forEach((mesh, row) => {
    mesh.userData['row'] = row;
  });
  const row = (at: [number, number, number]): number | undefined =>
    obstacleAround([wall, ball, box], at)?.row;
  expect([row([1.3, 0.2, 0]), row([1.4, 0.4, 0]), row([-0.4, 0.4, 0.4])]).toEqual([1, undefined, 2]);
});

describe('an obstacle in the hand', () => {
  const turned = (angle: number): THREE.Quaternion =>
    new THREE.Quaternion().setFromAxisAngle(v(1, 2, -0.5).normalize(), angle);
  const thing = (): THREE.Object3D => {
    const made = new THREE.Object3D();
    made.position.set(0.3, 2, -1);
    return made;
  };

  it('is seen where the core will set it down', () => {
    const seen = thing();
    const corner = v(0.4, -0.2, 0.7);
    const before = corner.clone().add(seen.position);
    const carried = new Carried(3, seen, [0.2, 1.9, -1.1], turned(0.4));
    carried.follow([1.2, 2.5, -0.6], turned(1.3));
    carried.size(1.5);
    seen.updateMatrix();
    const { about, turn, times, by } = carried.done()!;
    const wanted = before
      .sub(v(...about))
      .applyQuaternion(new THREE.Quaternion(...turn))
      .multiplyScalar(times)
      .add(v(...about))
      .add(v(...by));
    expect(corner.applyMatrix4(seen.matrix).distanceTo(wanted)).toBeLessThan(1e-5);
    expect(2 * Math.acos(turn[3])).toBeCloseTo(0.9, 4);
  });

  it('stays where it was if the hand only trembles', () => {
    const seen = thing();
    const carried = new Carried(0, seen, [0, 2, 0], turned(0));
    carried.follow([0.0001, 2, 0], turned(0.001));
    expect(carried.done()).toBeUndefined();
    carried.putBack();
    expect(seen.position.toArray()).toEqual([0.3, 2, -1]);
  });
});
