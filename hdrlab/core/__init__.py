"""What every chapter stands on: arrays, weights, samples, colour, steps."""
