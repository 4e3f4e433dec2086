"""Pages that stand by themselves: the report, the contact sheet, the display."""
