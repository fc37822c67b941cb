"""Stem and leaf in point clouds of herbs: a classifier that learns from scans of made seedlings alone, and how well it does.

The seedlings are one stem with up to a dozen or two large leaves of any form, whole or pinnate. The features were chosen on
seedlings that were kept out. It is measured on these and, where its files lie beside the repository, on a laser scan of a tomato
plant (../shared/data/scans/tomato_series): see `tomato` in wood_and_leaf.py.

    pip install scikit-learn
    OMP_NUM_THREADS=1 python apps/python/notebooks/stem_and_leaf.py
"""

import random
import time

import numpy as np
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.neighbors import NearestNeighbors
from wood_and_leaf import LEAF, TOMATO, features, told, tomato

import burgeon as bg

LEARNT, KEPT = range(1000, 1090), range(2000, 2030)
"""Seeds of the seedlings for training, and of those that were kept out."""
FORMS = (
    *("ovate", "elliptic", "obovate", "lanceolate", "cordate", "deltoid", "lobed", "palmate", "pinnate", "pinnate", "fingered"),
    "tricuspid",
)
"""Forms of blades; pinnate ones twice: compound leaves are common among herbs."""
JOINTS = 8
"""Joints of a stem."""
BALLS = (0.02, 0.04, 0.08, 0.16)
"""Radii of neighbourhoods as shares of the plant's size: where a plant has few leaves, their number of points says little."""
THINNED = 5000
"""Points of the plant that the balls see."""
SAMPLE = 2000
"""Points of each seedling for training."""


def herb(seed):
    """The spec of a seedling: a stem that wanders a little, and its leaves."""
    chance = random.Random(f"herb:{seed}")
    draw = chance.uniform
    tall, wanted = draw(0.03, 0.4), chance.choice(range(1, 10))
    length, wander = tall * draw(0.25, 0.9), draw(0, 0.06) * tall
    stem, x, z = [], 0.0, 0.0
    for joint in range(1, JOINTS + 1):
        x, z = x + draw(-wander, wander), z + draw(-wander, wander)
        stem.append([x, tall * joint / JOINTS, z])
    turn = {"kind": "spiral", "divergence_deg": draw(130, 145)}
    arrangement = chance.choice((turn, {"kind": "distichous"}, {"kind": "opposite"}, {"kind": "decussate"}))
    at_node = 2 if arrangement["kind"] in ("opposite", "decussate") else 1
    spacing = tall * draw(0.5, 0.95) / max(1, -(-wanted // at_node))
    steps = {"attraction_m": tall, "kill_m": tall / JOINTS * 0.6, "step_m": tall / JOINTS / 2}
    return {
        "method": {"kind": "points", "points": stem, "steps": steps},
        "wood": {"tip_radius_m": tall * draw(0.008, 0.03), "internode_share": draw(0, 0.1)},
        "leaves": {
            "angle_deg": draw(30, 95),
            "arrangement": arrangement,
            "droop": draw(-0.2, 0.7),
            "gather": draw(0, 0.6),
            "length_m": length,
            "spacing_m": spacing,
            "max_radius_m": 1.0,
            "size_variation": draw(0.05, 0.35),
        },
        "blade": {"form": chance.choice(FORMS), "width": draw(0.7, 1.6), "bend": draw(-0.2, 0.8), "fold": draw(-0.2, 0.6)},
    }


def cloud_of(seed):
    """A scan of a seedling from many sides: points, and whether each is leaf."""
    plant = bg.grow(herb(seed), seed=seed, textures=False)
    chance = np.random.default_rng(seed)
    stations, elevation = int(chance.integers(6, 16)), float(chance.uniform(10, 45))
    noise = float(plant.measures()["height_m"] * chance.uniform(0, 0.004))
    cloud = plant.cloud(20_000, stations=stations, elevation=elevation, noise=noise, seed=seed)
    return cloud.points, np.isin(cloud.part, LEAF)


def balls(points, sample):
    """The form of the neighbourhoods of a sample of points within balls: how flat, how round, their direction, their share."""
    low, high = np.quantile(points, [0.005, 0.995], axis=0)
    size = np.linalg.norm(high - low)
    thinned = points[np.random.default_rng(0).permutation(len(points))[:THINNED]]
    near = NearestNeighbors().fit(thinned)
    columns = []
    for radius in BALLS:
        own = np.zeros((len(sample), 5))
        for row, found in enumerate(near.radius_neighbors(points[sample], radius * size, return_distance=False)):
            if len(found) < 3:
                continue
            off = thinned[found] - thinned[found].mean(axis=0)
            values, vectors = np.linalg.eigh(off.T @ off)
            values = np.maximum(values, 0) / max(values.sum(), 1e-30)
            own[row] = [values[0], values[1], abs(vectors[1, 2]), abs(vectors[1, 0]), len(found) / len(thinned)]
        columns.append(own)
    return np.hstack(columns)


def rows_of(points, most, seed=0):
    """Returns the features of at most so many points, and their rows."""
    near, sample = features(points, seed)
    return np.hstack([near[:most], balls(points, sample[:most])]), sample[:most]


def scanned(seeds):
    """Features and truth of all seedlings."""
    columns = []
    for seed in seeds:
        points, leaf = cloud_of(seed)
        rows, sample = rows_of(points, SAMPLE, seed)
        columns.append((rows, leaf[sample]))
    return tuple(np.concatenate(column) for column in zip(*columns))


def main():
    began = time.monotonic()
    rows, truth = scanned(LEARNT)
    model = HistGradientBoostingClassifier(max_iter=80, random_state=0).fit(rows, truth)
    print(f"learnt from {len(truth):,} points of {len(LEARNT)} seedlings in {time.monotonic() - began:.0f} s", flush=True)
    rows, truth = scanned(KEPT)
    told("seedlings that were kept out", truth, model.predict(rows))
    if not TOMATO.is_dir():
        print("skipped: the scan of a tomato plant is not there")
        return
    points, leaf = tomato()
    rows, sample = rows_of(points, len(points))
    told("a real tomato plant", leaf[sample], model.predict(rows))


if __name__ == "__main__":
    main()
