"""An oral examination that writes itself: questions on a student's own functions, answered by running them.

changed    a function with one token changed, or with a line that nothing needs
examining  the questions, made beside the checks: each version runs in the sandbox
pages      what is written: for the student, for the examiner, on paper, as a notebook
"""
