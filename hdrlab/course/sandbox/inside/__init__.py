"""What goes into a sandbox: these files need the standard library and numpy alone."""
