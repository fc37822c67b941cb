"""Makes docs/pictures/python.png: a tree's picture, what its masks show, and its cloud."""

import pathlib

import numpy as np
from PIL import Image

import burgeon as bg

SIZE = (420, 560)
VIEW = dict(view="orbit", azimuth=30, elevation=8)
COLOURS = np.uint8([[94, 60, 36], [178, 112, 54], [120, 150, 60], [160, 170, 70], [110, 80, 60], [74, 150, 58], [214, 92, 140]])
ORDERS = np.uint8([[60, 42, 110], [46, 110, 160], [40, 160, 120], [160, 190, 60], [230, 160, 50], [220, 90, 60]])


def main():
    tree = bg.grow("lime", seed=4)
    picture = tree.render(SIZE, **VIEW)[..., :3]
    masks = tree.masks(SIZE, **VIEW)
    organs, orders = np.full_like(picture, 246), np.full_like(picture, 246)
    seen = masks.part >= 0
    organs[seen] = COLOURS[np.minimum(masks.part[seen], len(COLOURS) - 1)]
    order = np.where(masks.axis >= 0, tree.axes.order[masks.axis], 0)
    orders[seen] = ORDERS[np.minimum(order[seen], len(ORDERS) - 1)]
    cloud = tree.cloud(30_000, stations=3, noise=0.004)
    sheet = Image.fromarray(np.hstack([picture, organs, orders, drawn(cloud)]))
    sheet.quantize(160).save(pathlib.Path(__file__).resolve().parents[3] / "docs/pictures/python.png", optimize=True)


def drawn(cloud):
    """The points from the front, nearer ones last, by what they lie on."""
    width, height = SIZE
    out = np.full((height, width, 3), 246, np.uint8)
    low, high = cloud.points.min(0), cloud.points.max(0)
    scale = min((width - 24) / (high - low)[0], (height - 24) / (high - low)[1])
    rows = np.argsort(cloud.points[:, 2])
    x = (width / 2 + (cloud.points[rows, 0] - (low + high)[0] / 2) * scale).astype(int)
    y = (height / 2 - (cloud.points[rows, 1] - (low + high)[1] / 2) * scale).astype(int)
    near = (cloud.points[rows, 2] - low[2]) / (high - low)[2]
    colour = COLOURS[np.minimum(cloud.part[rows], len(COLOURS) - 1)] * (0.55 + 0.45 * near)[:, None]
    for dx, dy in ((0, 0), (1, 0)):
        out[np.clip(y + dy, 0, height - 1), np.clip(x + dx, 0, width - 1)] = colour
    return out


main()
