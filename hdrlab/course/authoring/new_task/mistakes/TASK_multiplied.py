"""You multiply by flat instead of dividing by it, so dark corners become even darker."""


def TASK(Z, flat):
    return Z * flat / flat.mean()
