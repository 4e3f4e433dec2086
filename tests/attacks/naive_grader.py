"""A grader as they are often written, for the attacks to be tried on: one process, and every common weakness.

    python naive_grader.py submission.py

It imports what was handed in, calls it, compares, and prints PASS or FAIL. Who ran it takes for the
score what is best: the file results.json, the lines that say PASS, or an end without an error.
Never grade with it.
"""

import importlib.util
import io
import pickle
import sys

import numpy as np


class Grader:
    """Compares answers with a solution that lies beside them."""

    def close(self, came, expected):
        """The first check: numpy's own comparison."""
        np.testing.assert_allclose(came, expected)

    def near(self, came, x):
        """The second: that the largest difference is not too large, from what x is by now."""
        if np.max(np.abs(came - solution(x))) > 1e-6:
            raise AssertionError("too far away")


def solution(x):
    return 2 * x


def carried(came):
    """Carry an answer as if from another process, in the ways that come first to mind."""
    if hasattr(came, "__next__"):
        return list(came)
    if isinstance(came, bytes):
        return np.load(io.BytesIO(came), allow_pickle=True)
    return pickle.loads(pickle.dumps(came)) if "Pickled" in type(came).__name__ else came


def main(path):
    grader = Grader()
    found = importlib.util.spec_from_file_location("submission", path)
    submission = importlib.util.module_from_spec(found)
    found.loader.exec_module(submission)
    for seed, check in enumerate((grader.close, grader.near)):
        x = np.random.default_rng(seed).random((4, 4))
        expected = solution(x)
        try:
            came = submission.double(x)
            came = carried(came)
            check(came, expected if seed == 0 else x)
            print("PASS", flush=True)
        except Exception as error:
            print("FAIL", error, flush=True)


if __name__ == "__main__":
    sys.path.insert(0, ".")
    main(sys.argv[1])
