"""The mean as it is."""


def fix_uncertain(mean, k, *, sigma_s):
    return mean
