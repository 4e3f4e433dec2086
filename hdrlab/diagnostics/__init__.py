"""May I trust it? What asks whether a result of the lessons is to be believed."""
