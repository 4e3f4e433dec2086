"""What a reader sees: arrays as Axes (`plots`), pictures with alt text (`pictures`), steps (`widgets`).

One agreement holds for every `draw` function, the library's or your own: it takes a state (or a
result) and returns a picture: a uint8 array (H, W) or (H, W, 3), a matplotlib Axes or a matplotlib
Figure.
"""
