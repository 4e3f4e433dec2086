"""Known mistakes in `log_average`, the task of hdrlab.tonemap.reinhard.log_average."""

import numpy as np

from hdrlab.course.checks.mistakes import Question, mistake


@mistake(
    "log_average_base_2",
    says="You took the logarithm to one base and the power of another one. Use log and exp, or "
    "log2 and exp2.",
)
def base_2(L, *, delta=1e-06):
    median = np.median(L[L > 0]) if np.any(L) else 1.0
    return float(np.exp(np.log2(L + delta * float(median)).mean(dtype=np.float64)))


@mistake(
    "log_average_black_left_out",
    says="You average log L only where L is above 0. Black pixels are part of the scene; delta "
    "keeps their logarithm finite.",
)
def black_left_out(L, *, delta=1e-06):
    return float(np.exp(np.log(L[L > 0]).mean(dtype=np.float64)))


@mistake(
    "log_average_stays_a_logarithm",
    says="You return the mean of the logarithms. Take exp of it, so that Lav has the unit of L.",
)
def stays_a_logarithm(L, *, delta=1e-06):
    median = np.median(L[L > 0]) if np.any(L) else 1.0
    return float(np.log(L + delta * float(median)).mean(dtype=np.float64))


@mistake(
    "log_average_linear",
    says="You average L itself, so one lamp decides how bright the scene is. Take the mean of the"
    " logarithms.",
    misses_method=True,
)
def linear(L, *, delta=1e-06):
    median = np.median(L[L > 0]) if np.any(L) else 1.0
    return float(np.mean(L + delta * float(median)))


@mistake(
    "log_average_absolute_delta",
    says="You add delta itself, whatever the unit of L is. Add delta times the median of the pixels "
    "that are not black.",
    questions=(
        Question(
            code="log_average(np.array([[1.0]]), delta=1.0)",
            why="The median is 1, so 1 is added: exp(ln(1 + 1)).",
            because=r"$\delta$ is `delta` times",
        ),
        Question(
            code="log_average(np.array([[10.0]]), delta=1.0)",
            why="The median is 10, so 10 is added: exp(ln(10 + 10)).",
            because=r"$\delta$ is `delta` times",
        ),
        Question(
            code="log_average(np.array([[0.001]]), delta=1.0)",
            why="The median is 0.001, so 0.001 is added. In any unit, this image gives "
            "twice its luminance.",
            because=r"$\delta$ is `delta` times",
        ),
    ),
    fixes=(("delta", "delta * np.median(L[L > 0])"),),
)
def absolute_delta(L, *, delta=1e-06):
    return float(np.exp(np.log(L + delta).mean(dtype=np.float64)))


@mistake(
    "log_average_black_in_the_median",
    says="Your median counts black pixels, so it is too small. Take the median of the pixels that "
    "are not black.",
)
def black_in_the_median(L, *, delta=1e-06):
    return float(np.exp(np.log(L + delta * float(np.median(L))).mean(dtype=np.float64)))


@mistake(
    "log_average_log10_and_exp",
    says="You took the logarithm to base 10, but exp is the inverse of the natural one. Use log and "
    "exp.",
)
def log10_and_exp(L, *, delta=1e-06):
    median = np.median(L[L > 0]) if np.any(L) else 1.0
    return float(np.exp(np.log10(L + delta * float(median)).mean(dtype=np.float64)))
