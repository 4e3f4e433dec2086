"""Compare the code of all submissions of a class, for instructors."""
