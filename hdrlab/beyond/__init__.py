"""Beyond one shot after another: other cameras, other brackets, one paper per module."""
