"""The course around the library: its assignments and their checks, a class, and what comes with them.

plan, materials           what is asked, and where notebooks, sheets and the specification are
handouts, stubs           the sheets, made of the prose and of the library's own functions
notebook, submission      a student's check(), and what stands in a file that is handed in
grading, running, plugin  the specification is run on it
subject, channel, worker, warden           the student's functions, in a process of their own
compare, misconceptions, results           what differs, which mistake that is, and what it is worth
feedback, gradebook       the same for the student, and for other systems
code                      Python that is read as text, and never run
sandbox                   where a student's functions run
classroom, archives       a whole class is graded, and what it sends is opened
projects, gallery         the students' own photographs, and the vote
export, site              other systems' forms of the course, and its pages
sheets, wording           tables and words of strangers, safe to be shown
"""
