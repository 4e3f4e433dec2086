"""The course around the library: its notebooks, and what comes with them."""
