"""Pages without outside parts: the report and the contact sheet."""
