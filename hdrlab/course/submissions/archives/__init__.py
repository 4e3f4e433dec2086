"""Unpack archives from students without trust: unpack them whole, or reject them with one line.

members   what an archive may contain, and how much of it
tarball   tar archives, compressed or not
unpack    zip archives, and the function for all kinds of archives
packing   zip archives that hdrlab writes
"""
