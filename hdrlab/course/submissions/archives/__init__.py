"""Archives from strangers: opened where nothing in them can do harm, else refused in a line.

members   what an archive may hold, and how much of it
tarball   tar, with and without compression
unpack    any of them, into an empty folder
"""
