"""The lessons' functions, fast: same module and function name, same signature, same result."""
