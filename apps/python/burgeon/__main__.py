"""``python -m burgeon``: a plant from the command line, where the command ``burgeon`` is not installed.

A small part of that command: species and flowers to files. ``burgeon --help`` of the command has the rest.
"""

from __future__ import annotations

import argparse
import os
import sys
from typing import List, Optional

import burgeon as bg
from burgeon._files import write_whole


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m burgeon", description="Makes a plant and writes it to a file.")
    parser.add_argument("--version", action="version", version=f"burgeon {bg.__version__}")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("presets", help="list the species and flowers")
    for name, what, of in (
        ("grow", "SPECIES|SPEC.toml", "a tree"),
        ("bloom", "FLOWER|SPEC.toml", "a flower"),
        ("sketch", "DRAWING", "the plant of a drawing"),
    ):
        make = commands.add_parser(name, help=f"make {of}")
        make.add_argument("what", metavar=what)
        make.add_argument("-o", "--output", required=True, metavar="OUT", help="the model or structure, by its ending")
        make.add_argument("--png", metavar="FILE.png", help="also make a picture")
        make.add_argument("--seed", type=int, default=1, metavar="N", help="seed of all chance [default: 1]")
        if name == "grow":
            make.add_argument("--age", type=int, metavar="N", help="years [default: full-grown]")
        if name == "bloom":
            make.add_argument("--day", type=float, metavar="D", help="day since the bud [default: in full bloom]")
    return parser


def main(arguments: "Optional[List[str]]" = None) -> int:
    """Runs a command; returns 2 for a request that cannot be made."""
    asked = _parser().parse_args(arguments)
    if asked.command == "presets":
        trees, flowers = bg.presets()
        print("trees: " + ", ".join(trees))
        print("flowers: " + ", ".join(flowers))
        return 0
    try:
        if asked.command == "grow":
            fields = {} if asked.age is None else {"age": asked.age}
            plant = bg.grow(asked.what, seed=asked.seed, **fields)
        elif asked.command == "bloom":
            plant = bg.bloom(asked.what, asked.day, seed=asked.seed)
        else:
            plant = bg.sketch(asked.what, seed=asked.seed)
        plant.save(asked.output)
        if asked.png is not None:
            folder, name = os.path.split(asked.png)
            write_whole(folder, [(name, plant.model.to_png())])
    except (bg.BurgeonError, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    for warning in plant.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    print(f"{asked.output}: {plant.model.triangle_count:,} triangles")
    return 0


if __name__ == "__main__":
    sys.exit(main())
