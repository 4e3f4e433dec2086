"""A question bank for a quiz: predictions of notebooks and a concept inventory, with computed answers.

questions  collects the questions of an executed notebook
inventory  has thirty questions to ask before and after the course
answers    reads what a class answered to the inventory
gain       computes what the class has learned of each concept, and writes a page about it
moodle     writes questions as Moodle XML
paper      writes questions as a page to print, with the answers at its end
"""
