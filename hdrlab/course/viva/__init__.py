"""Questions for an oral examination on a student's own functions, answered by running them.

changed     change one token of a function, or make a line superfluous
inputs      the inputs of a changed function, and what a page shows of its answer
examining   make questions after the checks; each version runs in the sandbox
pages       write the pages: for the student, for the examiner, on paper, and a practice notebook
self_check  the notebook's cell that says whether a letter is right
"""
