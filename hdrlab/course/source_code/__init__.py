"""Python that is read as text and never run.

names     the names that a piece of code binds, and those that it uses
source    find the definition of a name in the library's source
inline    a function of the library with everything that it needs, as one text
closure   the same for a function in a student's cells
"""
