"""Where every photograph of a hand-held bracket must move: `mtb` finds the offsets, `shift` applies them."""
