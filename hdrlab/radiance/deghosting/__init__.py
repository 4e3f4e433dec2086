"""What moved between the photographs, and a map without it."""
