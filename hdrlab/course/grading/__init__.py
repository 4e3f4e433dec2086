"""Grade one submission: read it, run the checks, and divide the points among them."""
