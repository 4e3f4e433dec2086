"""Tone mapping: luminance of any range to display luminance in [0, 1], one paper per module.

Every module here that has a function `tonemap(L, **knobs) -> Ld` is an operator, under the module's
name. It answers float32 (H, W), finite and in [0, 1] for any radiance, and refuses what is no
radiance. What else a module promises of its defaults stands in its LAWS, and the tests hold it to
that: "monotone" (one curve for all pixels: brighter in, never darker out), "exposure" (the unit of
L cancels). A module whose paper dulls the colours says how far in its SATURATION.
A view transform maps the three channels of a color together. Its module has a second function,
`tonemap_rgb(E, **knobs) -> (H, W, 3)`, which `pipeline.develop` uses for radiance in color; its
`tonemap` maps gray light.

`pipeline.catalogue` finds the operators.
"""
