"""A question bank for a quiz: predictions of notebooks and a concept inventory, with computed answers.

questions  collects the questions of an executed notebook
task_questions  asks what the functions of the tasks return, and what known mistakes change
inventory  has thirty questions to ask before and after the course
answers    reads what a class answered to the inventory
gain       computes what the class has learned of each concept, and writes a page about it
moodle     writes questions as Moodle XML
qti        writes questions as a package of QTI 2.1
paper      writes questions as a page to print, with the answers at its end
"""
