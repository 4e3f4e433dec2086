"""A room, a garden, and cards: scenes whose radiance is known, to be photographed by `capture.camera`."""
