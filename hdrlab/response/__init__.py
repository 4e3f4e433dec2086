"""The camera's response: photographs -> g = ln f^-1, the ln exposure of each pixel level, g[128] = 0.

Every module offers `recover(images, times, ...) -> g`, (256,) for gray and (256, 3) for RGB, so
that every response serves every merge.
"""
