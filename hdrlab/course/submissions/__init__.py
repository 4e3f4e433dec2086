"""Read submissions: find them in a class's folder, open archives, extract each task's code."""
