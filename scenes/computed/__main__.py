"""Compute the room or a subject again: `python -m scenes.computed room -o room.exr`."""

import argparse
from pathlib import Path

from scenes.computed.subjects import SUBJECTS
from scenes.computed.view import room
from scenes.files import write_layers

SHAPE = (512, 768)
SAMPLES = 4


def main() -> None:
    """Write a layer of an OpenEXR file: the room's radiance, 16 lines of sight to a pixel, or a subject."""
    parser = argparse.ArgumentParser(prog="python -m scenes.computed", description=__doc__)
    parser.add_argument("name", choices=["room", *SUBJECTS])
    parser.add_argument("-o", "--out", type=Path, required=True, help="the .exr file to write")
    asked = parser.parse_args()
    subject = SUBJECTS.get(asked.name)
    layers = {"subject": subject()} if subject else {"radiance": room(SHAPE, samples=SAMPLES)}
    write_layers(asked.out, layers)


if __name__ == "__main__":
    main()
