"""hdrlab beside its peers, on the same work, in one run: `python -m benchmarks`, from the folder above this.

A subject is a module or a folder here that has a tuple ROWS of `rows.Row`; it is found by existing. A row
prepares its work and names who does it: hdrlab, and the peers that are installed. `measure` times them in
turn, each row in a process of its own, once with one thread and once with as many as each takes by itself;
memory is measured in a fresh process for each. What a row must hold stands beside it, and a hold that is
missed makes the exit code 1.
"""
