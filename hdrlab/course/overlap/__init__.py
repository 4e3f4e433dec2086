"""What the works of a class have in common, for instructors' eyes."""
