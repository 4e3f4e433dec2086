"""Checks of ratio_steps(found, limit, tolerance, rounds), the ratio of two exposures: states (k,
used, V).
"""

from hdrlab.course.checks.compare import parts, points, same, states
from hdrlab.radiance import ratios


def draw_inputs(rng, off=10, scatter=0.1):
    """Return 60 equations of one ratio with some scatter; the first `off` of them show something
    that moved.
    """
    x = rng.uniform(10, 60, 60)
    v = rng.uniform(0.2, 1, 60)
    y = x * rng.uniform(2, 6) * (1 + rng.uniform(-scatter, scatter, 60))
    y[:off] *= rng.uniform(0.3, 0.5, off)
    return ratios.Equations(x, y, v)


def get_answer(subject, found, **options):
    """Return the student's states as (k, used, V), and the library's."""
    answer = states(subject.ratio_steps(found, **options), what="the states")
    student_states = [parts(state, 3, what="a state") for state in answer]
    return student_states, list(ratios.ratio_steps(found, **options))


# right iterations may differ in their steps, which small inputs show most
check_one_input = None


@points(3)
def test_the_first_ratio_is_that_of_least_squares(subject, rng):
    """Which k minimizes the sum of (v (y - k x))^2?

    Set the derivative to 0: k is a sum over all pairs divided by another one.

    k = sum v^2 x y / sum v^2 x^2, and V is the mean of (v (y - k x))^2.
    """
    (answer, *_), (expected, *_) = get_answer(subject, draw_inputs(rng))
    same(answer[0], expected.k, 1e-4 * expected.k, what="the first k")
    same(answer[2], expected.V, 1e-3 * expected.V, what="the first V")


@points(4)
def test_a_round_leaves_out_pairs_with_large_errors(subject, rng):
    """Which pairs show something that moved?

    Those whose squared error is larger than `limit` times V of the last state.

    Compute k and V again from the remaining pairs.
    """
    for limit in (3.0, 2.0):
        answer, expected = get_answer(
            subject, draw_inputs(rng), limit=limit, tolerance=0.0, rounds=1
        )
        same(
            answer[-1][1],
            expected[1].used,
            0,
            what="the pairs in use after one round",
            kind="values",
        )
        same(answer[-1][0], expected[1].k, 1e-4 * expected[1].k, what="k after one round")


@points(2, needs="test_a_round_leaves_out_pairs_with_large_errors")
def test_a_pair_that_fits_again_comes_back(subject, rng):
    """The first k is biased by what moved. It may have excluded pairs that fit a better k.

    In every round, test all pairs, including those that the last round left out.

    Compute `used` again in each round, from the errors of all pairs.
    """
    for _ in range(3):
        answer, expected = get_answer(
            subject, draw_inputs(rng, 25, 0.02), limit=1.2, tolerance=0.0, rounds=4
        )
        same(
            answer[-1][1],
            expected[-1].used,
            0,
            what="the pairs in use after four rounds",
            kind="values",
        )


@points(1, needs="test_a_round_leaves_out_pairs_with_large_errors")
def test_there_is_a_state_before_the_first_round_and_one_after_each(subject, rng):
    """How many states do you yield after three rounds?

    The first state uses all pairs and comes before the first round.

    Yield the state of a round before you test whether k has converged.
    """
    for options in ({"tolerance": 0.0, "rounds": 3}, {"tolerance": 1e9}):
        answer, expected = get_answer(subject, draw_inputs(rng), **options)
        same(len(answer), len(expected), 0, what="the number of states")
