"""All of it in electrons squared, and divided by N squared at the end."""


def variance(X, D, N, R):
    electrons = X * N + R * R + (D * N) ** 2 / 12
    return electrons / (N * N)
