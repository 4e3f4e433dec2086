"""Light to numbers: scenes whose radiance is known, and a camera that photographs them."""
