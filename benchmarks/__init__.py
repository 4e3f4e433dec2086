"""hdrlab beside its peers and beside the papers: `python -m benchmarks`, from the folder above this.

A subject is a module or a folder here that has a tuple ROWS; it is found by existing. What must
hold stands beside each row, and a hold that is missed makes the exit code 1.

A `rows.Row` is work that others do, too. It prepares the work and names who does it: hdrlab, and
the peers that are installed. `measure` times them in turn, each row in a process of its own, once
with one thread and once with as many as each takes by itself; memory is measured in a fresh process
for each.

An `experiments.Experiment` was published. It is run again, and what it finds is printed beside what
the paper says.
"""
