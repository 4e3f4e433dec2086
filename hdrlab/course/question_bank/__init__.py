"""A question bank for a quiz: the predictions of the notebooks, with their computed answers.

questions  collects the questions of an executed notebook
moodle     writes them as Moodle XML
paper      writes them as a page to print, with the answers at its end
"""
