"""Compute the room again: `python -m scenes.computed -o room.exr`."""

import argparse
from pathlib import Path

from scenes.computed.view import room
from scenes.files import write_layers

SHAPE, SAMPLES = (512, 768), 4


def main() -> None:
    """Write the room's radiance, 16 lines of sight to a pixel, as the layer of an OpenEXR file."""
    parser = argparse.ArgumentParser(prog="python -m scenes.computed", description=__doc__)
    parser.add_argument("-o", "--out", type=Path, required=True, help="the .exr file to write")
    write_layers(parser.parse_args().out, {"radiance": room(SHAPE, samples=SAMPLES)})


if __name__ == "__main__":
    main()
