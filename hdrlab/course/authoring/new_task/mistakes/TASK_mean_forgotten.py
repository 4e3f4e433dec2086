"""You divide by flat, which makes all pixel values small. Multiply by the mean of flat, too."""


def TASK(Z, flat):
    return Z / flat
