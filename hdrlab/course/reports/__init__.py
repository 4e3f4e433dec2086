"""What checking comes to: results, the feedback to a student, gradebooks and tables."""
