"""Lets plants that `burgeon` wrote as MJCF stand in gusts, and says how fast MuJoCo steps.

    burgeon grow oak -o oak.xml
    python gust.py oak.xml --seconds 60 --speed 12
    python gust.py oak.xml --seconds 6 --speed 35 --film oak.webp --strip oak.png

It needs the packages `mujoco` and `numpy`, and for films `pillow` and a library of OpenGL that draws without a window
(`MUJOCO_GL=egl` or `osmesa`). It ends with 1 if anything is not finite, or bends further than its limits.
"""

import argparse
import math
import sys
import time

AIR = 1.2  # kg/m3
WOOD_DRAG, LEAF_DRAG = 1.0, 0.25  # of cylinders, and of leaves that fold and hide one another


class Gusts:
    """A wind along x that swells and falls, and turns a little; it grows with the height by the power of 1/5."""

    def __init__(self, speed):
        self.speed = speed

    def at(self, time_s, heights):
        import numpy as np

        swell = 0.5 + 0.3 * math.sin(0.9 * time_s) + 0.2 * math.sin(2.7 * time_s + 1.0)
        side = 0.3 * math.sin(0.5 * time_s)
        level = self.speed * swell * np.clip(heights / 10.0, 0.01, None) ** 0.2
        return np.stack([level, side * level, 0 * level], axis=1)


def push(model, data, gusts):
    """Sets the drag of all bodies: half the density of air times area times the square of the speed."""
    import numpy as np

    # Velocities are known about the centre of each tree of bodies.
    arms = data.xipos - data.subtree_com[model.body_rootid]
    velocity = data.cvel[:, 3:] + np.cross(data.cvel[:, :3], arms)
    wind = gusts.at(data.time, data.xipos[:, 2]) - velocity
    # A file without plants has no areas.
    areas = model.body_user[:, :2] if model.nuser_body >= 2 else np.zeros((model.nbody, 2))
    drag = 0.5 * AIR * (areas @ np.array([WOOD_DRAG, LEAF_DRAG]))
    data.xfrc_applied[:, :3] = drag[:, None] * np.linalg.norm(wind, axis=1)[:, None] * wind


def stalks(model):
    """The welds that hold fruits, each with the force at which it breaks, newtons."""
    import mujoco

    found = {}
    for row in range(model.neq):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_EQUALITY, row) or ""
        limit = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_NUMERIC, name.replace("stalk_", "break_force_", 1))
        if limit >= 0:
            found[row] = float(model.numeric_data[model.numeric_adr[limit]])
    return found


def break_stalks(data, limits):
    """Lets go of each fruit whose stalk is pulled harder than it bears; how many were let go of."""
    import mujoco
    import numpy as np

    rows = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    broken = 0
    for weld, limit in limits.items():
        if not data.eq_active[weld]:
            continue
        # The first three of its six rows are forces.
        own = np.flatnonzero(rows & (data.efc_id == weld))[:3]
        if np.linalg.norm(data.efc_force[own]) > limit:
            data.eq_active[weld] = 0
            broken += 1
    return broken


class Film:
    """Pictures of a simulation at even times, from the side that the wind blows across."""

    RATE = 20  # pictures a second
    WIDTH, HEIGHT = 320, 320

    def __init__(self, model, data):
        import mujoco
        import numpy as np

        model.vis.headlight.ambient[:] = 0.5
        model.vis.headlight.diffuse[:] = 0.6
        model.vis.global_.offwidth, model.vis.global_.offheight = self.WIDTH, self.HEIGHT
        self.renderer = mujoco.Renderer(model, self.HEIGHT, self.WIDTH)
        self.camera = mujoco.MjvCamera()
        tops = data.geom_xpos[:, 2] + model.geom_rbound
        self.camera.lookat[:] = [0, 0, 0.5 * tops.max()]
        self.camera.distance = 1.35 * max(tops.max(), 2 * np.abs(data.geom_xpos[:, :2]).max())
        self.camera.azimuth, self.camera.elevation = 90, -5
        self.option = mujoco.MjvOption()
        # Groups 2 and 3 are what is seen and what is touched.
        self.option.geomgroup[:] = [1, 1, 1, 0, 0, 0]
        self.pictures = []

    def take(self, data):
        """Takes a picture if it is time."""
        if data.time * self.RATE < len(self.pictures):
            return
        import numpy as np

        self.renderer.update_scene(data, self.camera, self.option)
        picture = self.renderer.render().copy()
        # What nothing was drawn on is black: make it the sky.
        self.renderer.enable_segmentation_rendering()
        empty = self.renderer.render()[..., 0] < 0
        self.renderer.disable_segmentation_rendering()
        picture[empty] = np.array([214, 228, 240], np.uint8)
        self.pictures.append(picture)

    def save(self, film=None, strip=None, across=6):
        """Writes the pictures as a film, and `across` of them side by side."""
        import numpy as np
        from PIL import Image

        if film:
            first, *others = [Image.fromarray(p) for p in self.pictures]
            first.save(film, save_all=True, append_images=others, duration=1000 // self.RATE, loop=0, quality=70)
        if strip:
            rows = np.linspace(0, len(self.pictures) - 1, across).round().astype(int)
            whole = Image.fromarray(np.concatenate([self.pictures[k] for k in rows], axis=1))
            whole.quantize(48, dither=Image.Dither.NONE).save(strip, optimize=True)


def run(path, seconds=60.0, speed=12.0, film=None, strip=None):
    """Simulates a plant in gusts; what became of it."""
    import mujoco
    import numpy as np

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    gusts, limits = Gusts(speed), stalks(model)
    hinges = model.jnt_qposadr[model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE]
    steps = math.ceil(seconds / model.opt.timestep)
    most, broken, stepping = 0.0, 0, 0.0
    mujoco.mj_forward(model, data)
    taken = Film(model, data) if film or strip else None
    for step in range(steps):
        push(model, data, gusts)
        if taken:
            taken.take(data)
        start = time.thread_time()
        mujoco.mj_step(model, data)
        stepping += time.thread_time() - start
        if limits:
            broken += break_stalks(data, limits)
        if len(hinges):
            most = max(most, float(np.abs(data.qpos[hinges]).max()))
        if not math.isfinite(most) or not np.isfinite(data.qvel).all():
            break
    if taken:
        taken.save(film, strip)
    bad = sum(
        int(data.warning[w].number)
        for w in (mujoco.mjtWarning.mjWARN_BADQPOS, mujoco.mjtWarning.mjWARN_BADQVEL, mujoco.mjtWarning.mjWARN_BADQACC)
    )
    finite = bool(np.isfinite(data.qpos).all() and np.isfinite(data.qvel).all())
    return {
        "hinges": len(hinges),
        "bodies": model.nbody - 1,
        "kilograms": float(model.body_mass.sum()),
        "step_ms": 1e3 * model.opt.timestep,
        "simulated_s": float(data.time),
        "steps_a_second": steps / stepping,
        "most_rad": most,
        "stalks": len(limits),
        "broken": broken,
        "exploded": not finite or bad > 0 or most > 2.0,
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--speed", type=float, default=12.0, help="metres a second at a height of 10 m")
    parser.add_argument("--film", help="a film of the first file, .webp or .gif")
    parser.add_argument("--strip", help="six pictures of the first file side by side, .png")
    asked = parser.parse_args()
    try:
        import mujoco  # noqa: F401
    except ImportError:
        sys.exit("skipped: the package `mujoco` is not there; `pip install mujoco numpy` installs it")
    failed = False
    for row, path in enumerate(asked.files):
        shown = (asked.film, asked.strip) if row == 0 else (None, None)
        made = run(path, asked.seconds, asked.speed, *shown)
        failed |= made["exploded"]
        print(
            path, ", ".join(f"{key} {value:.3g}" if isinstance(value, float) else f"{key} {value}" for key, value in made.items())
        )
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
