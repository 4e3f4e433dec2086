"""A whole class is graded: who handed in what, who is at work on it, and what instructors get.

roster, handins, late    who is in the class, what is whose, and what lateness costs
run                      a class's grading: its pieces, their results, the feedback
journal                  work that is done once, whatever happens meanwhile
executors                who does it: processes of this machine, workers of a Dask cluster
overview, marks          what comes of it: gradebooks, and a page about the class
toy                      a class of made submissions
"""
