"""The course: assignments with checks, the grading of a class, and what comes with it.

Each part imports only the parts above it in this list (held by `tests/test_layers.py`).

sanitize       text from strangers, made safe for a terminal and a page
scratch        a command's temporary folder, and locks between processes
materials      where the notebooks and the assignments are
source_code    Python that is read as text and never run
variants       the same task with other parameters
plan           homeworks, tasks, points, dates, and each student's inputs and variants
students       the list of students, late days, CSV tables
sandbox        where a student's functions run, in a process of their own
checks         the specification, the known mistakes, and the code that runs them
submissions    finds, unpacks and reads what students hand in
grading        grades one submission
reports        what one graded submission looks like: feedback, gradebook row, JUnit
notebook       `check()` in a student's notebook
classroom      grades a class: jobs, executors, gradebook, Moodle, regrading
authoring      builds assignments and solutions, new tasks, a toy class, exports to other systems

Nothing above imports the following five, so that each may be left out.

projects       the students' own photos and reports
gallery        the class vote
similarity     compares the code of all submissions of a class
viva           oral exams about a student's own code
site           the website
"""
