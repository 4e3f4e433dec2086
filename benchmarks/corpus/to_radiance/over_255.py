def to_radiance(pixels):
    m = pixels[..., :3] / 255.0
    e = pixels[..., 3].astype(int)
    out = m * (2.0 ** (e - 128))[..., None]
    out[e == 0] = 0
    return out
