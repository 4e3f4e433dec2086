"""A grader with all common weaknesses, to show that the attacks work. Never grade with it.

    python naive_grader.py submission.py

It runs in one process: it imports the submission, calls its function, compares the answers, and prints
PASS or FAIL. Its score adds up what such graders read: the file results.json, the lines with PASS, and an
exit code of 0 without a line with FAIL.
"""

import importlib.util
import io
import pickle
import sys

import numpy as np


class Grader:
    """Compare answers with a solution in the same process."""

    def check_all_values(self, answer, expected):
        """Compare with numpy's own function."""
        np.testing.assert_allclose(answer, expected)

    def check_largest_difference(self, answer, x):
        """Compare with the solution for the input, which the submission may have changed."""
        if np.max(np.abs(answer - solution(x))) > 1e-6:
            raise AssertionError("the answer is wrong")


def solution(x):
    return 2 * x


def transfer(answer):
    """Return an answer as if it came from another process, without any caution."""
    if hasattr(answer, "__next__"):
        return list(answer)
    if isinstance(answer, bytes):
        return np.load(io.BytesIO(answer), allow_pickle=True)
    if "Pickled" in type(answer).__name__:
        return pickle.loads(pickle.dumps(answer))
    return answer


def main(path):
    """Grade a submission with two checks."""
    grader = Grader()
    spec = importlib.util.spec_from_file_location("submission", path)
    submission = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(submission)
    for seed in (0, 1):
        x = np.random.default_rng(seed).random((4, 4))
        expected = solution(x)
        try:
            answer = transfer(submission.double(x))
            if seed == 0:
                grader.check_all_values(answer, expected)
            else:
                grader.check_largest_difference(answer, x)
            print("PASS", flush=True)
        except Exception as error:
            print("FAIL", error, flush=True)


if __name__ == "__main__":
    sys.path.insert(0, ".")
    main(sys.argv[1])
