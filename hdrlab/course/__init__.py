"""The course around the library: its assignments and their checks, a class, and what comes with them.

plan                    what is asked, and what it is worth
notebook, submission    a student's check(), and what stands in a file that is handed in
grading                 the specification is run on it
checks                  the specification, the well-known mistakes, and what runs them
sandbox                 where a student's functions run, in a process of their own
reports                 what it is worth, for the student and for other systems
material                notebooks and handouts, made of the prose and of the library's own functions
code                    Python that is read as text, and never run
classroom, archives     a whole class is graded, and what it sends is opened
similarity              compares the code of all submissions of a class
projects, gallery       the students' own photographs, and the vote
export, site            other systems' forms of the course, and its pages
wording                 words of strangers, safe to be shown
"""
