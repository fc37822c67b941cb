"""Times free-form deformation, logistic fits, surfaces and nearest points beside NumPy, scipy, geomdl and splipy, in one
run.

    pip install numpy scipy geomdl splipy
    python bench/peers_bloom.py            # builds `cargo bench -p burgeon-bench --bench bloom` first
    python bench/peers_bloom.py FILE       # takes the built benchmark target/release/deps/bloom-...

    python bench/peers_bloom.py --compare  # nearest points only; takes a built example peer_compare, too

Without the build it ends in two minutes. Prints tables: the least and the median time of each, and how many times as
long as ours the peer takes (of the least times, which other work on the machine disturbs least). Ours run before and
after the peers, the lesser counts."""

import json
import re
import subprocess
import sys
import tempfile
import time
from math import comb
from pathlib import Path

import numpy as np


def times(job, runs, seconds=3.0):
    """Least and median of at most so many runs, fewer if they would take longer; milliseconds."""
    out = []
    end = time.perf_counter() + seconds
    while len(out) < runs and (len(out) < 3 or time.perf_counter() < end):
        start = time.perf_counter()
        job()
        out.append(time.perf_counter() - start)
    return min(out) * 1e3, sorted(out)[len(out) // 2] * 1e3


def deform_kept():
    count, points = 4, 200_000
    stu = np.random.default_rng(1).random((points, 3))
    lattice = np.random.default_rng(2).random((count, count, count, 3))
    degree = count - 1
    b = [np.stack([comb(degree, i) * (1 - x) ** (degree - i) * x**i for i in range(count)], 1) for x in stu.T]
    # All 64 weights of a point are kept between shapes.
    weights = np.einsum("pi,pj,pk->pijk", *b)
    return times(lambda: np.einsum("pijk,ijkc->pc", weights, lattice), 15)


def deform_blas():
    count, points = 4, 200_000
    weights = np.random.default_rng(1).random((points, count**3))
    lattice = np.random.default_rng(2).random((count**3, 3))
    # The same sum as a product of matrices, which NumPy hands to its BLAS.
    return times(lambda: weights @ lattice, 25)


def logistic():
    from scipy.optimize import curve_fit

    # The series of the benchmark.
    days = np.arange(25.0)
    wobble = 0.6 * ((np.arange(25) * 37) % 11 / 5.0 - 1.0)
    values = 60 / (1 + (60 / 6 - 1) * np.exp(-0.4 * days)) + wobble

    def law(x, k, p0, r):
        return k / (1 + (k / p0 - 1) * np.exp(-r * x))

    return times(lambda: curve_fit(law, days, values, p0=[62, 5, 0.3]), 201)


def marks():
    u, v = np.meshgrid(np.linspace(-1, 1, 7), np.linspace(0, 1, 10))
    return np.stack([0.1 * u * (1.2 - v), v, 0.05 * u * u + 0.1 * v * v], -1)


def surface_geomdl():
    from geomdl import fitting

    points = [list(p) for p in marks().reshape(-1, 3)]
    return times(lambda: fitting.interpolate_surface(points, 10, 7, 3, 3), 51)


def surface_splipy():
    from splipy import BSplineBasis, surface_factory

    grid = marks()
    bases = [BSplineBasis(4, [0] * 4 + list(range(1, n - 3)) + [n - 3] * 4) for n in (10, 7)]
    return times(lambda: surface_factory.interpolate(grid, bases), 201)


def built():
    """The benchmark as cargo builds it."""
    command = ["cargo", "bench", "--no-run", "-p", "burgeon-bench", "--bench", "bloom"]
    root = Path(__file__).parent.parent
    told = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stderr
    found = re.search(r"Executable .*\((.*)\)", told)
    return str(root / found[1])


def ours(bench):
    """Least and median of each of our benchmarks, milliseconds, as divan prints them."""
    few = ["--bench", "--sample-count", "400", "--sample-size", "1", "--max-time", "1"]
    command = [bench, *few, "deform_200_000", "logistic_25", "surface_through"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    unit = {"ns": 1e-6, "µs": 1e-3, "ms": 1.0, "s": 1e3}
    found, group = {}, ""
    for line in text.splitlines():
        name = re.match(r"[│ ]*[├╰]─ (\S+)", line)
        if not name:
            continue
        cells = re.findall(r"([\d.]+) (ns|µs|ms|s)\b", line)
        if line[0] in "├╰":
            group = name[1]
        key = group if line[0] in "├╰" else f"{group} {name[1]}"
        if len(cells) >= 3:
            values = [float(x) * unit[u] for x, u in cells]
            found[key] = (values[0], values[2])
    return found


def sheet(points, seed):
    """A wavy sheet of 10 cm with noise, as a scan of a leaf is."""
    rng = np.random.default_rng(seed)
    x, y = rng.random((2, points)) * 0.1
    return np.stack([x, 0.005 * np.sin(60 * x) + 0.0002 * rng.normal(size=points), y], 1)


def example(name):
    """An example of ours as cargo builds it."""
    root = Path(__file__).parent.parent
    build = ["cargo", "build", "--release", "-q", "-p", "burgeon-bench", "--example", name]
    subprocess.run(build, cwd=root, check=True)
    told = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    target = json.loads(subprocess.run(told, cwd=root, capture_output=True, check=True).stdout)["target_directory"]
    return Path(target) / "release" / "examples" / name


def compare(program=None):
    """Distances of two clouds, both ways: ours with its trees, scipy's queries alone and with its trees."""
    from scipy.spatial import cKDTree

    program = program or example("peer_compare")
    print("| points, both ways | ours, 2 threads, ms | ours, 1 thread | cKDTree.query, 1 thread | with its trees |")
    print("|---|---|---|---|---|")
    for points in (200_000, 1_000_000):
        for name, scale, shift in (("one on the other", 1, 0), ("2 m apart", 1, 2), ("a hundredth as large, 2 m apart", 0.01, 2)):
            a, b = sheet(points, 1), sheet(points, 2) * scale + [shift, 0, 0]
            with tempfile.TemporaryDirectory() as folder:
                files = [Path(folder) / n for n in "ab"]
                for file, cloud in zip(files, (a, b)):
                    file.write_bytes(cloud.astype("<f8").tobytes())
                told = subprocess.run([program, *files], capture_output=True, text=True, check=True).stdout
            mine = json.loads(told)
            start = time.perf_counter()
            trees = cKDTree(a), cKDTree(b)
            built = time.perf_counter()
            there, back = trees[1].query(a)[0], trees[0].query(b)[0]
            end = time.perf_counter()
            for own, peer in ((mine["mean"], there.mean()), (mine["back_mean"], back.mean())):
                assert abs(own - peer) <= 1e-9 * peer, (own, peer)
            print(
                f"| {points:,}, {name} | {mine['two_threads_ms']:.0f} | {mine['one_thread_ms']:.0f} "
                f"| {(end - built) * 1e3:.0f} | {(end - start) * 1e3:.0f} |"
            )


def main():
    if sys.argv[1:2] == ["--compare"]:
        return compare(*sys.argv[2:3])
    bench = sys.argv[1] if len(sys.argv) > 1 else built()
    before = ours(bench)
    theirs = {}
    rows = [
        ("FFD, 4 x 4 x 4, 200,000 points, two threads", "deform_200_000_on_two_threads 4", None),
        ("the same, one thread", "deform_200_000 4", None),
        ("NumPy einsum of the same sum, weights kept", "deform_200_000 4", deform_kept),
        ("NumPy matrix product, weights kept", "deform_200_000 4", deform_blas),
        ("logistic fit of 25 points", "logistic_25", None),
        ("scipy curve_fit, one start near the answer", "logistic_25", logistic),
        ("surface through 10 x 7 marks", "surface_through_10_by_7", None),
        ("splipy interpolate", "surface_through_10_by_7", surface_splipy),
        ("geomdl interpolate_surface", "surface_through_10_by_7", surface_geomdl),
    ]
    for name, _, peer in rows:
        if peer:
            theirs[name] = peer()
    after = ours(bench)
    own = {key: min(before[key], after[key]) for key in before}
    print("| | least, ms | median, ms | times ours |\n|---|---|---|---|")
    for name, key, peer in rows:
        low, median = theirs[name] if peer else own[key]
        ratio = f"{low / own[key][0]:.1f}" if peer else ""
        print(f"| {name} | {low:.4g} | {median:.4g} | {ratio} |")
    print()
    compare()


if __name__ == "__main__":
    main()
