"""Burst photography: align equal, short exposures tile by tile, and merge them (Hasinoff et al., 2016)."""
