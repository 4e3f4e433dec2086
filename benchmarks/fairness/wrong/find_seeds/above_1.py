"""A threshold alone."""


def find_seeds(score):
    return score > 1
