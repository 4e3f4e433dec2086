"""Your detail has the sign reversed, as one lecture prints it: detail = lL - base, so that both add up
to the picture."""

from hdrlab.tonemap import durand


def layers(lL, *, sigma_s, sigma_r=0.4):
    base, detail = durand.layers(lL, sigma_s=sigma_s, sigma_r=sigma_r)
    return base, -detail
