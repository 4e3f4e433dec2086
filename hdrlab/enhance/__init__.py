"""Better pictures without a radiance map: numbers to numbers, one paper per module."""
