import numpy as np


def compress(base, low, high, *, contrast=50.0):
    compression_factor = np.log(contrast) / (high - low) if high > low else 1
    compression_factor = min(compression_factor, 1)
    log_absolute = compression_factor * high
    return base * compression_factor - log_absolute
