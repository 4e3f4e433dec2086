"""All in electrons, step as well, and divided by N squared at the end."""


def variance(X, D, N, R):
    return (X * N + R * R + (D * N) ** 2 / 12.0) / (N * N)
