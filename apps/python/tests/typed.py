"""A program that uses the package, for a checker of types; `test_types_are_those_of_the_docs` reads it."""

from typing import List, Tuple

import numpy as np

import burgeon as bg

oak: bg.Plant = bg.grow("oak", seed=2, age=30, leaves={"leaf_keep": 0.5})
height: float = oak.measures()["height_m"]
position: np.ndarray = oak.nodes.position
picture: np.ndarray = oak.render((64, 64), view="orbit", azimuth=40.0, elevation=10, shadow=False)
masks: bg.Masks = oak.masks(64, view="front")
cloud: bg.Cloud = oak.cloud(1000, noise=0.002)
mobile: bg.Cloud = oak.cloud(1000, beam=0.5, pulse=0.1, path=[(5, 2, -5), (5, 2, 5)])
png: bytes = oak.model.to_png((64, 64), background="white")
grove: bg.Grove = bg.grove({"oak": 3, "birch": 1}, area=(30, 30))
trees: np.ndarray = grove.masks(64).tree
stand: bg.GroveCloud = grove.cloud(1000)
stand.save("x.npz")
wood: bg.forest.Stand = bg.forest.grow({"species": [{"name": "oak"}]}, seed=2, years=40)
heights: np.ndarray = wood.height
tiles: bg.forest.Tiles = wood.tiles("wood", variants=2, workers=4)
law: bg.Law = bg.Law.fit([0, 1, 2], [0.1, 0.2, 0.3])
lily: bg.Plant = bg.bloom("lily", 2.5, law=law)
words: Tuple[List[str], List[str]] = bg.presets()
manifest = bg.dataset.generate("birch", 10, "birches", formats=("cloud", "mtg"), vary={"age": (8, 30)})
plants: int = manifest["plants"]

# The checker finds errors before the program runs.
oak.render((64, 64), view="back")  # type: ignore[arg-type]
oak.render((64, 64), sizes=3)  # type: ignore[call-arg]
oak.masks("large")  # type: ignore[arg-type]
bg.grow(3)  # type: ignore[arg-type]
bg.grove(spacing="wide")  # type: ignore[arg-type]
bg.forest.read("trees.csv", yearx=2024)  # type: ignore[call-arg]
bg.dataset.generate("birch", "ten", "birches")  # type: ignore[arg-type]
