"""Wood and leaf in point clouds: a classifier that learns from scans of grown plants alone, and how well it does.

One learns from trees, one from small plants. Each is measured on plants of other seeds, on species that it never saw and, where
its files lie beside the repository, on a laser scan of a tomato plant (../shared/data/scans/tomato_series), of which the points
have no labels: they take that of the nearest edge of the skeleton that goes with the scan, stem or leaf.

    pip install scikit-learn
    python apps/python/notebooks/wood_and_leaf.py
"""

import pathlib
import time

import numpy as np
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.metrics import f1_score
from sklearn.neighbors import NearestNeighbors

import burgeon as bg

KINDS = {
    "trees": {
        "learnt": ("oak", "birch", "hazel", "maple", "alder", "lime"),
        "never seen": ("beech", "cherry", "ash", "apple"),
        "ages": range(8, 15),
        "cloud": {"points": 40_000, "stations": 4, "noise": 0.002},
    },
    "small plants": {
        "learnt": ("oak", "hazel", "maple", "alder", "lime", "elm", "magnolia-tree", "fig"),
        "never seen": ("beech", "cherry", "ash", "apple"),
        "ages": range(1, 3),
        "cloud": {"points": 20_000, "stations": 8, "elevation": 25, "noise": 0.0003},
    },
}
SAMPLE = 4000
"""Points of each plant for training, or for prediction."""
NEIGHBOURS = (15, 50, 150)
"""Points of the neighbourhoods, small to large."""
LEAF = [bg.PARTS.index(name) for name in ("leaf", "petal", "sepal")]
TOMATO = pathlib.Path(__file__).resolve().parents[3] / "../shared/data/scans/tomato_series"


def features(points, seed=0):
    """Returns the form of the neighbourhoods of a sample of points: how far they are lines, planes or balls, and their
    directions.

    The features do not depend on scale. Also returns the rows of the sample.
    """
    near = NearestNeighbors(n_neighbors=max(NEIGHBOURS)).fit(points)
    sample = np.random.default_rng(seed).permutation(len(points))[:SAMPLE]
    distance, row = near.kneighbors(points[sample])
    columns = []
    for count in NEIGHBOURS:
        own = points[row[:, :count]]
        own = own - own.mean(axis=1, keepdims=True)
        values, vectors = np.linalg.eigh(np.einsum("nki,nkj->nij", own, own))
        low, middle, high = np.maximum(values, 0).T / np.maximum(values.sum(axis=1), 1e-30)
        columns += [low, middle, high, np.abs(vectors[:, 1, 0]), np.abs(vectors[:, 1, 2])]
        columns += [
            np.linalg.norm(points[sample] - points[row[:, :count]].mean(axis=1), axis=1) / (distance[:, count - 1] + 1e-30)
        ]
    columns += [distance[:, a - 1] / (distance[:, b - 1] + 1e-30) for a, b in zip(NEIGHBOURS, NEIGHBOURS[1:])]
    return np.column_stack(columns), sample


def scanned(kind, species, seed):
    """A plant as scanners around it see it: features of some of its points, and whether each is leaf."""
    ages = KINDS[kind]["ages"]
    plant = bg.grow(species, seed=seed, age=ages[seed % len(ages)], textures=False)
    cloud = plant.cloud(seed=seed, **KINDS[kind]["cloud"])
    rows, sample = features(cloud.points, seed)
    return rows, np.isin(cloud.part[sample], LEAF)


def told(name, truth, found):
    wood, leaf = f1_score(~truth, ~found), f1_score(truth, found)
    shares = f"{len(truth):,} points, {np.mean(truth):.0%} of them leaf"
    print(f"{name}: {shares}: F1 of wood {wood:.3f}, of leaf {leaf:.3f}, mean {(wood + leaf) / 2:.3f}", flush=True)


def tomato():
    """The scan, and of each point whether the edge of the skeleton next to it is one of a leaf."""
    scan = np.loadtxt(TOMATO / "03-10.graph.txt", dtype=str, usecols=(0,))
    lines = (TOMATO / "03-10.graph.txt").read_text().splitlines()
    nodes = np.array([line.split()[1:5] for line, word in zip(lines, scan) if word == "v"], float)
    edges = np.array([line.split()[1:3] for line, word in zip(lines, scan) if word == "e"], int)
    data = (TOMATO / "03-10.ply").read_bytes()
    points = np.frombuffer(data[data.index(b"end_header\n") + 11 :], "<f4").reshape(-1, 3).astype(float)
    points = np.random.default_rng(1).permutation(points)[:20_000]
    start, way = nodes[edges[:, 0], :3], nodes[edges[:, 1], :3] - nodes[edges[:, 0], :3]
    off = points[:, None, :] - start[None]
    along = np.clip((off * way).sum(axis=2) / np.square(way).sum(axis=1), 0, 1)
    away = np.square(off - along[:, :, None] * way).sum(axis=2)
    of_leaf = (nodes[edges, 3] > 0).any(axis=1)
    # +y up, as grown trees are.
    return points[:, [0, 2, 1]] * [1, 1, -1], of_leaf[np.argmin(away, axis=1)]


def learn(kind):
    """A classifier of one kind of plants, measured on plants that were kept out."""
    began = time.monotonic()
    plants = [scanned(kind, species, seed) for species in KINDS[kind]["learnt"] for seed in (1, 2, 3)]
    rows, truth = (np.concatenate(columns) for columns in zip(*plants))
    model = HistGradientBoostingClassifier(max_iter=200, random_state=0).fit(rows, truth)
    print(f"{kind}: learnt from {len(truth):,} points of {len(plants)} plants in {time.monotonic() - began:.0f} s", flush=True)
    for name, among in (("other seeds", "learnt"), ("species never seen", "never seen")):
        kept = [scanned(kind, species, seed) for species in KINDS[kind][among] for seed in (11, 12)]
        rows, truth = (np.concatenate(columns) for columns in zip(*kept))
        told(f"{kind}, {name}", truth, model.predict(rows))
    return model


def main():
    models = {kind: learn(kind) for kind in KINDS}
    if not TOMATO.is_dir():
        print("skipped: the scan of a tomato plant is not there")
        return
    points, leaf = tomato()
    rows, sample = features(points)
    for kind, model in models.items():
        told(f"{kind}, a real tomato plant", leaf[sample], model.predict(rows))


if __name__ == "__main__":
    main()
