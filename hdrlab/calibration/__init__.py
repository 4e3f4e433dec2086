"""The response without a bracket: from a chart, a display, or a moving edge."""
