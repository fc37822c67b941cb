"""The datasheet of a data set: answers to the questions of Datasheets for Datasets (Gebru et al. 2021)."""

from __future__ import annotations

import json
from typing import Any, Mapping, Sequence

HOLDS = {
    "glb": "a mesh (glTF)",
    "burgeon": "a project of the Studio",
    "cloud": "a point cloud in which each point says its part, axis, organ and instance",
    "laz": "the same as LAZ",
    "drawing": "what a person would have drawn (SVG)",
    "picture": "a picture with masks of part, axis and organ, and its depth",
    "labels": "pictures by calibrated cameras with masks, instances, keypoints, depth, normals and albedo",
}
"""Description of each format."""


def datasheet(recipe: "Mapping[str, Any]", shards: "Sequence[Mapping[str, Any]]") -> bytes:
    """Returns the page, from the recipe and the shards alone."""
    spec = recipe["spec"] if isinstance(recipe["spec"], str) else "a spec of its own (recipe.json)"
    size = sum(entry["bytes"] for entry in shards)
    holds = [f"- {HOLDS.get(kind, f'its structure ({kind})')}" for kind in recipe["formats"]]
    differ = [f"- `{name}`: {json.dumps(range_, sort_keys=True)}" for name, range_ in sorted(recipe["vary"].items())]
    lines = [
        f"# Datasheet: {recipe['n']} plants of {spec}",
        "",
        "The questions are those of Gebru et al., Datasheets for Datasets (2021).",
        "",
        "## Motivation",
        "",
        "Synthetic plants whose every point and pixel says what it belongs to, to train and to test programs that see.",
        "",
        "## Composition",
        "",
        f"{recipe['n']} instances, each of its own seed, in {len(shards)} shards ({size:,} bytes). Each has",
        "",
        *holds,
        "",
        "and a `.json` with its seed, its measures and what was drawn for it. Labels are exact: they are read from the",
        "meshes, not annotated. Nothing is missing, and nothing stems from or shows people. There is no split:",
        "`burgeon.dataset.export` makes one by plant.",
        "",
        "## Collection",
        "",
        f"Made by Burgeon {recipe['burgeon']} (`{recipe['maker']}`) from `recipe.json`; the same recipe gives the same bytes.",
        *(["", "What differs from plant to plant, beside the seed:", "", *differ] if differ else []),
        "",
        "## Preprocessing",
        "",
        "None.",
        "",
        "## Uses",
        "",
        "To train, and to compare methods on plants whose truth is known. What is learnt here must be measured on real",
        "plants before it is relied on: shapes follow models of growth, leaves have no damage or disease, light is a sun and",
        "an open sky, and the scanner has no mixed echoes.",
        "",
        "## Distribution and maintenance",
        "",
        "The plants are made by whoever ran the recipe, who says under which licence they are passed on. `manifest.json` has the",
        "SHA-256 of each shard (`burgeon.dataset.verify`), `croissant.json` says the same to programs.",
        "",
    ]
    return "\n".join(lines).encode()
