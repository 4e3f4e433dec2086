"""Who does the work of grading a class: processes of this machine, or a Dask cluster."""
