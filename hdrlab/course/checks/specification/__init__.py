"""The specification: a file for each task of the course, each test a promise that a student keeps too."""
