"""Times the peers of `cargo bench -p burgeon-bench --bench bloom`: a plain NumPy sum for the deformation, scipy for the
fits, geomdl and splipy for the surface. `pip install numpy scipy geomdl splipy`; prints medians."""
import time

import numpy as np


def median(job, runs):
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        job()
        times.append(time.perf_counter() - start)
    return sorted(times)[runs // 2]


def deform():
    from math import comb

    count, points = 4, 200_000
    stu = np.random.default_rng(1).random((points, 3))
    lattice = np.random.default_rng(2).random((count, count, count, 3))
    degree = count - 1
    b = [np.stack([comb(degree, i) * (1 - x) ** (degree - i) * x**i for i in range(count)], 1) for x in stu.T]
    # Weights are kept between shapes, as ours are.
    weights = np.einsum("pi,pj,pk->pijk", *b)
    return median(lambda: np.einsum("pijk,ijkc->pc", weights, lattice), 15)


def logistic():
    from scipy.optimize import curve_fit

    days = np.arange(25.0)
    values = 60 / (1 + (60 / 6 - 1) * np.exp(-0.4 * days)) + 0.6 * np.sin(37.0 * days)
    law = lambda x, k, p0, r: k / (1 + (k / p0 - 1) * np.exp(-r * x))
    return median(lambda: curve_fit(law, days, values, p0=[62, 5, 0.3]), 41)


def marks():
    u, v = np.meshgrid(np.linspace(-1, 1, 7), np.linspace(0, 1, 10))
    return np.stack([0.1 * u * (1.2 - v), v, 0.05 * u * u + 0.1 * v * v], -1)


def surface_geomdl():
    from geomdl import fitting

    points = [list(p) for p in marks().reshape(-1, 3)]
    return median(lambda: fitting.interpolate_surface(points, 10, 7, 3, 3), 15)


def surface_splipy():
    from splipy import BSplineBasis, surface_factory

    grid = marks()
    bases = [BSplineBasis(4, [0] * 4 + list(range(1, n - 3)) + [n - 3] * 4) for n in (10, 7)]
    return median(lambda: surface_factory.interpolate(grid, bases), 41)


for name, job in [
    ("NumPy einsum, 4 x 4 x 4, 200,000 points", deform),
    ("scipy curve_fit, 25 points", logistic),
    ("geomdl interpolate_surface, 10 x 7", surface_geomdl),
    ("splipy interpolate, 10 x 7", surface_splipy),
]:
    print(f"{name}: {job() * 1e3:.3f} ms")
