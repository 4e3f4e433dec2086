"""Tone mapping: luminance of any range to display luminance in [0, 1], one paper per module.

Each module with a function `tonemap(L, **knobs) -> Ld` is an operator with the module's name. It
returns float32 (H, W), finite and in [0, 1], for any radiance, and raises an error for anything else.
LAWS of a module lists what else holds for its default parameters: "monotone" (a brighter pixel never
becomes darker than another one) and "exposure" (the unit of L does not matter). The tests check this.
SATURATION of a module is the saturation of the colors that its paper uses.

A view transform maps the three channels of a color together. Its module has a second function,
`tonemap_rgb(E, **knobs) -> (H, W, 3)`, which `pipeline.develop` uses for radiance in color; its
`tonemap` maps gray light.

`pipeline.catalogue` finds the operators.
"""
