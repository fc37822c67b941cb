"""Makes docs/pictures/labels.png: two potted shrubs, their instances with boxes and keypoints, their depth, their normals."""

import pathlib

import numpy as np
from PIL import Image, ImageDraw

import burgeon as bg

SIZE = (320, 320)
LARGE = 40
"""Pixels of instances whose keypoints are drawn."""
INSERTION, TIP = (230, 60, 50), (50, 140, 250)


def main():
    shrub = bg.grow("hazel", seed=5, age=2)
    scene = bg.scene(shrub, "pots", (1, 2), (0.9, 0.5), seed=2, pot=(0.12, 0.2), stones=20)
    camera = bg.Camera.around(scene, azimuth=20, elevation=20, size=SIZE)
    shot = bg.labels.take(scene, camera, sun=(230, 40))
    sheet = Image.fromarray(np.hstack([shot.image[:, :, :3], marked(shot), depth(shot), normals(shot)]))
    sheet.save(pathlib.Path(__file__).resolve().parents[3] / "docs/pictures/labels.png", optimize=True)


def marked(shot):
    over = Image.fromarray(bg.labels.drawn_over(shot))
    pen = ImageDraw.Draw(over)
    for left, top, wide, high in shot.box[np.argsort(-shot.area)[:8]].tolist():
        pen.rectangle([left, top, left + wide - 1, top + high - 1], outline=(255, 255, 255))
    for points in shot.keypoints[shot.area > LARGE].tolist():
        for (x, y, seen), colour in zip(points, (INSERTION, TIP)):
            if seen:
                # Hidden points are rings.
                pen.ellipse([x - 2, y - 2, x + 2, y + 2], outline=colour, fill=colour if seen == 2 else None)
    return np.asarray(over)


def depth(shot):
    there = np.isfinite(shot.depth)
    share = (shot.depth[there] - shot.depth[there].min()) / np.ptp(shot.depth[there])
    grey = np.full(shot.depth.shape, 255, np.uint8)
    grey[there] = 20 + 215 * share**0.5
    return np.repeat(grey[:, :, None], 3, axis=2)


def normals(shot):
    there = shot.masks.part >= 0
    return np.where(there[:, :, None], np.rint(127.5 * (shot.masks.normal + 1)), 255).astype(np.uint8)


if __name__ == "__main__":
    main()
