"""What works on whole pictures: blur, bilateral filter, pyramids, Poisson equation, mosaics, homographies."""
