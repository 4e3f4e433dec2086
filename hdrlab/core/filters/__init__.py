"""What works on whole pictures: blur, bilateral and guided filter, pyramids, Poisson, mosaics, warps."""
