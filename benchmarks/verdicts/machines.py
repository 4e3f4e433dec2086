"""Do the verdicts depend on the machine? The same brackets with other instruction sets and layouts.

A child process assembles every bracket and prints, as JSON, what it says of each. Its environment
selects the instruction sets of NumPy and of OpenBLAS, and the number of threads. It stores the photos
in another memory layout on request: MACHINE is one of MACHINES.

    python -m benchmarks.verdicts.machines MACHINE FOLDER
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path

import numpy as np

from benchmarks.experiments import Skipped, real
from benchmarks.measure import ROOT, THREADS
from benchmarks.verdicts import brackets, ills
from benchmarks.verdicts.claims import blamed_causes, contradict
from hdrlab import pipeline
from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.core.bracket import Bracket
from hdrlab.errors import HdrlabError

# the real brackets, and the stops between photos that state no times
REAL = {"window": None, "frobisher": None, "tripod_phone": None, "mertens_house": 3.0}
# pixels: of larger photos every second, third ... is taken
MAX_SIDE = 400
# simulated brackets of each ill
SIMULATED_COUNT = 1


@dataclass(frozen=True)
class Machine:
    """A change of the environment, and of the memory layout of the photos."""

    environment: Mapping[str, str]
    layout: str = "C"


def list_instruction_sets() -> str:
    """Return the instruction sets that NumPy chooses at run time, as NPY_DISABLE_CPU_FEATURES wants them."""
    numpy_core = import_module("numpy._core._multiarray_umath")
    features = numpy_core.__cpu_features__
    return " ".join(name for name in numpy_core.__cpu_dispatch__ if features.get(name))


MACHINES = {
    "as it is": Machine({}),
    "older NumPy code": Machine({"NPY_DISABLE_CPU_FEATURES": list_instruction_sets()}),
    "OpenBLAS for Haswell": Machine({"OPENBLAS_CORETYPE": "Haswell"}),
    "OpenBLAS for Nehalem": Machine({"OPENBLAS_CORETYPE": "Nehalem"}),
    "two threads": Machine(dict.fromkeys(THREADS, "2")),
    "columns first": Machine({}, "F"),
    "every second pixel": Machine({}, "strided"),
}


def lay_out(images: Array, layout: str) -> Array:
    """Return the same photos in another memory layout."""
    if layout == "F":
        return np.asfortranarray(images)
    if layout == "strided":
        shape = (len(images), 2 * images.shape[1], 2 * images.shape[2], *images.shape[3:])
        padded = np.zeros(shape, images.dtype)
        padded[:, ::2, ::2] = images
        return padded[:, ::2, ::2]
    return images


def list_brackets(folder: Path) -> Iterator[tuple[str, Bracket]]:
    """Yield the name and the photos of each bracket: real ones, and simulated ones with an ill."""
    from hdrlab.cli.brackets import read_bracket

    for name, stops in REAL.items():
        try:
            photos = real(folder, name)
        except Skipped:
            continue
        taken = read_bracket((photos,), "exif", None, stops, note=str, detail=str)
        step = max(1, round(max(taken.images.shape[1:3]) / MAX_SIDE))
        yield name, replace(taken, images=taken.images[:, ::step, ::step].copy())
    for name, ill in ills.ILLS.items():
        for i in range(SIMULATED_COUNT):
            yield f"{name} {i}", brackets.shoot(brackets.plan(folder, i), ill)


def main(machine: str, folder: str) -> None:
    """Print the warnings and notes, and the causes that they blame, of each bracket."""
    layout = MACHINES[machine].layout
    found = {}
    for name, taken in list_brackets(Path(folder)):
        images = lay_out(taken.images, layout)
        try:
            assembly = pipeline.assemble(replace(taken, images=images))
        except HdrlabError as error:
            found[name] = {"sentences": [str(error)], "causes": []}
            continue
        sentences = [*assembly.warnings, *assembly.notes]
        found[name] = {"sentences": sentences, "causes": sorted(blamed_causes(assembly))}
    print(json.dumps(found))


def compare(folder: Path) -> Mapping[str, ArrayLike]:
    """Return on how many brackets each machine says something else, and how often the opposite."""
    results = {}
    for name, machine in MACHINES.items():
        environment = os.environ | dict.fromkeys(THREADS, "1") | dict(machine.environment)
        command = [sys.executable, "-m", "benchmarks.verdicts.machines", name, str(folder)]
        done = subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True
        )
        results[name] = json.loads(done.stdout.splitlines()[-1])
    first, *others = results
    counts: dict[str, ArrayLike] = {"brackets": len(results[first])}
    opposite_count = 0
    for name in others:
        different = []
        for bracket, expected in results[first].items():
            found = results[name][bracket]
            if found["causes"] == expected["causes"]:
                continue
            different.append(bracket)
            print(f"  {name}, {bracket}: {found['sentences']} instead of {expected['sentences']}")
            opposite_count += contradict(frozenset(found["causes"]), frozenset(expected["causes"]))
        counts[name] = len(different)
    return counts | {"opposite verdicts": opposite_count}


if __name__ == "__main__":
    main(*sys.argv[1:])
