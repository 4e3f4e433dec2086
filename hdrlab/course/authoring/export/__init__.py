"""The course in the forms of other systems: their tests call the same checks."""
