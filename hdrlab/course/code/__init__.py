"""Python read as text, and never run.

names     which names a piece of code binds, and which it uses
source    the module of a function of the library, statement by statement
inline    a function with all it needs from the library, in one piece
closure   the same for a function in a student's cells
"""
