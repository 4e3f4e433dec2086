"""Scripts that maintainers run by hand, from the top of the repository: `python -m tools.NAME`.

fold_cells        folds the cells of the notebooks that only draw
course_minutes    writes the minutes of notebooks and tasks into the course plan
teachers_sheets   writes the minutes into the teacher's sheets
methods_page      writes the page that lists all methods, from methods.txt
reading_distance  prints how many files and lines of code a task needs
junit_summary     prints what failed and what was slow, from the reports of pytest
"""
