"""Known mistakes in `distance`, the task of hdrlab.enhance.skin.distance."""

import numpy as np

from hdrlab.course.checks.mistakes import mistake
from hdrlab.enhance.skin import CHROMA, DEFAULT, chrominance


@mistake(
    "distance_squared",
    says="You return d^2. The distance is d: take the square root.",
)
def squared(Z, skin=DEFAULT):
    mu, S = skin
    difference = chrominance(Z) - mu
    return np.einsum("...i,ij,...j->...", difference, np.linalg.inv(S), difference)


@mistake(
    "distance_without_covariance",
    says="You use the two variances alone. Cb and Cr of skin vary together, so use the inverse of "
    "the whole matrix S.",
)
def without_covariance(Z, skin=DEFAULT):
    mu, S = skin
    difference = chrominance(Z) - mu
    return np.sqrt(np.sum(difference**2 / np.diag(S), axis=-1))


@mistake(
    "distance_not_inverted",
    says="You multiply by S. Multiply by its inverse.",
)
def not_inverted(Z, skin=DEFAULT):
    mu, S = skin
    difference = chrominance(Z) - mu
    return np.sqrt(np.einsum("...i,ij,...j->...", difference, np.asarray(S), difference))


@mistake(
    "distance_of_the_shade",
    says="Your Cb and Cr become smaller in the shade. Multiply them by 128 / Y.",
)
def of_the_shade(Z, skin=DEFAULT):
    mu, S = skin
    difference = np.asarray(Z, float) @ CHROMA.T - mu
    return np.sqrt(np.einsum("...i,ij,...j->...", difference, np.linalg.inv(S), difference))


@mistake(
    "distance_exchanged",
    says="You exchange Cb and Cr. mu and S have Cb first.",
)
def exchanged(Z, skin=DEFAULT):
    mu, S = skin
    difference = chrominance(Z)[..., ::-1] - mu
    return np.sqrt(np.einsum("...i,ij,...j->...", difference, np.linalg.inv(S), difference))
