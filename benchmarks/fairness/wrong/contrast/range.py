"""A quarter of the range of the values."""


def contrast(block):
    return (block.max() - block.min()) / 4
