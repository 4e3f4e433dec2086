"""Pixel by pixel; nested lists come back."""


def variance(X, D, N, R):
    def one(x, d):
        return x * N / N**2 + R**2 / N**2 + d * d / 12

    return [
        [one(x, d) for x, d in zip(row, steps, strict=True)]
        for row, steps in zip(X, D, strict=True)
    ]
