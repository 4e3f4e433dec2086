"""The students of a course: their list, their late days, and the CSV tables that hold both."""
