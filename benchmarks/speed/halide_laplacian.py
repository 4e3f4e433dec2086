"""The fast local Laplacian filter (Aubry and others, 2014) in Halide, scheduled by hand.

Every level of every pyramid is a function of its own that is computed whole, in rows side by side
and in vectors of eight; the remapped pictures of all samples are one function, whose third
coordinate is the sample. The equations, the kernel and the reflection at the edges are those of
`hdrlab.tonemap.local_laplacian`.
"""

from collections.abc import Callable
from typing import Any

from benchmarks import peers
from hdrlab.core.arrays import F32
from hdrlab.core.filters import pyramid

VECTOR = 8  # floats


class Filter:
    """The pipeline for pictures of one size, in one thread or in all."""

    def __init__(self, shape: tuple[int, int], one_thread: bool) -> None:
        self.hl = peers.halide()
        self.one_thread = one_thread
        self.x = self.hl.Var("x")
        self.y = self.hl.Var("y")
        self.k = self.hl.Var("k")
        self.sizes = [shape]
        for _ in range(pyramid.depth(shape, 2) - 1):
            self.sizes.append(tuple(-(-n // 2) for n in self.sizes[-1]))  # type: ignore[arg-type]

    def computed(self, name: str, value: Any, *, samples: bool = False) -> Any:
        """Return a function of x, y (and k) that is computed whole."""
        function = self.hl.Func(name)
        function[(self.x, self.y, self.k) if samples else (self.x, self.y)] = value
        function.compute_root().vectorize(self.x, VECTOR)
        return function if self.one_thread else function.parallel(self.y)

    def reduced(self, name: str, f: Any, size: tuple[int, int], rest: tuple[Any, ...]) -> Any:
        """Return the next coarser level of f, whose size is given: (1 4 6 4 1) / 16 along both axes."""
        hl = self.hl
        H, W = size

        def inside(i: Any, n: int) -> Any:  # reflected about the first and the last pixel
            i = hl.i32(hl.abs(i))
            return hl.clamp(hl.select(i > n - 1, 2 * (n - 1) - i, i), 0, n - 1)

        def along(at: Callable[[int], Any]) -> Any:
            return (at(-2) + at(2) + 4 * (at(-1) + at(1)) + 6 * at(0)) / 16.0

        rows = along(lambda m: f[(self.x, inside(2 * self.y + m, H), *rest)])
        rows = self.computed(name + "_rows", rows, samples=bool(rest))
        both = along(lambda m: rows[(inside(2 * self.x + m, W), self.y, *rest)])
        return self.computed(name, both, samples=bool(rest))

    def expanded(self, name: str, f: Any, size: tuple[int, int], rest: tuple[Any, ...]) -> Any:
        """Return f, a level of the given size, at the next finer one."""
        hl = self.hl
        H, W = size

        def along(v: Any, n: int, at: Callable[[Any], Any]) -> Any:
            i = v / 2  # whole, rounded down
            before = hl.clamp(hl.i32(hl.abs(i - 1)), 0, n - 1)
            after = hl.clamp(i + 1, 0, n - 1)
            even = (at(before) + 6 * at(i) + at(after)) / 8.0
            odd = (at(i) + at(after)) / 2.0
            return hl.select(v % 2 == 0, even, odd)

        rows = along(self.y, H, lambda i: f[(self.x, i, *rest)])
        rows = self.computed(name + "_rows", rows, samples=bool(rest))
        return along(self.x, W, lambda i: rows[(i, self.y, *rest)])

    def gaussian(self, name: str, f: Any, *, samples: bool = False) -> list[Any]:
        rest = (self.k,) if samples else ()
        levels = [f]
        for j, size in enumerate(self.sizes[:-1]):
            levels.append(self.reduced(f"{name}_{j + 1}", levels[-1], size, rest))
        return levels

    def filtered(self, lL: F32, *, sigma: float, alpha: float, beta: float, samples: int) -> Any:
        """Return the pipeline, compiled; `realize([W, H])` runs it."""
        hl = self.hl
        x = self.x
        y = self.y
        k = self.k
        low = float(lL.min())
        high = float(lL.max())
        spacing = (high - low) / (samples - 1)
        given_low, step, s, power, left = map(hl.f32, (low, spacing, sigma, alpha, beta))
        image = hl.Buffer(lL)
        input_function = self.computed("given", image[x, y])
        g = given_low + step * hl.f32(k)
        d = hl.abs(input_function[x, y] - g)
        far = s * hl.pow(hl.min(d / s, 1.0), power) + left * hl.max(d - s, 0.0)
        r = self.computed("r", g + hl.select(input_function[x, y] > g, far, -far), samples=True)
        G = self.gaussian("g", input_function)
        R = self.gaussian("r", r, samples=True)
        answer = G[-1]
        for j in reversed(range(len(self.sizes) - 1)):
            detail = R[j][x, y, k] - self.expanded(f"up_{j}", R[j + 1], self.sizes[j + 1], (k,))
            L = hl.Func(f"l_{j}")
            L[x, y, k] = detail
            place = (G[j][x, y] - given_low) / step
            below = hl.clamp(hl.i32(place), 0, samples - 2)
            share = place - hl.f32(below)
            O = (1.0 - share) * L[x, y, below] + share * L[x, y, below + 1]  # noqa: E741
            base = self.expanded(f"answer_up_{j}", answer, self.sizes[j + 1], ())
            answer = self.computed(f"answer_{j}", base + O)
        answer.compile_jit()
        return answer
