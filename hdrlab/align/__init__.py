"""Where every photograph of a hand-held bracket must move: `align` finds it; `shift` and `resample` do it."""
