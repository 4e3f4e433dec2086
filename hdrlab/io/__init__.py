"""Photographs in, radiance files in and out: the one room that knows image codecs."""
