"""A student's own photograph: the page about it, and all of it in one archive.

project          the folder: words, photographs, radiance map, artifact
words, report    what was written, and the page made of it
review           what is missing, in plain words
submit           the archive, photos without personal metadata
"""
