"""The figures as text: a block per row, who did the work line by line, then what it must hold.

The floor is the time in which the machine reads the input and writes the result, and does nothing
else: bytes over the bandwidth of a copy, or a file's bytes read or written by one call, measured in
the same process and by turns with the others. A ratio that is short within a quarter of the floor
is "AT FLOOR": the machine's.
"""

from benchmarks.experiments import Experiment, Found, listed
from benchmarks.rows import Figures, Outcome, Results, Row, best_peer, verdicts

COLUMNS = ("one thread", "by default", "peak memory", "x the floor")


def block(row: Row, results: Results, missing: dict[str, str]) -> str:
    """Return the block of a row."""
    lines = [f"{row.name}: {row.title}", _line("", (*COLUMNS, row.accuracy))]
    best = best_peer(results)
    for who, figures in results.items():
        lines.append(
            _line(who + (" *" if who == best and len(results) > 2 else ""), _cells(figures))
        )
    lines += [f"  {peer}: missing, {reason}" for peer, reason in missing.items()]
    return "\n".join(lines + [verdict(row, n, results) for n in range(len(row.holds))])


def experiment(row: Experiment, figures: Found) -> str:
    """Return the block of an experiment: published, found, what must hold, and whether it does."""
    holds = {hold.what: hold for hold in row.holds}
    lines = [("", "published", "found", "hold", "")]
    for what, numbers in figures.items():
        hold = holds.get(what)
        published = hold.published if hold else row.published.get(what, "-")
        rest = (hold.limits, hold.verdict(figures)) if hold else ("-", "")
        lines.append((what, published, listed(numbers), *rest))
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    cells = [
        "   ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True))
        for line in lines
    ]
    return "\n".join([f"{row.name}: {row.title}", *(f"  {line}".rstrip() for line in cells)])


def verdict(row: Row, n: int, results: Results) -> str:
    """Return the line of a row's n-th hold: what it came to, what it must, and whether it does."""
    hold = row.holds[n]
    value = hold.figure(results)
    sign = ">=" if hold.least else "<="
    goal = "" if hold.goal is None else f", goal {hold.goal:g}"
    figure = "?" if value is None else f"{value:.3g}"
    return f"    {hold.verdict(results):<10} {figure:>7}  {hold.what}  (hold {sign} {hold.limit:g}{goal})"


def summary(outcomes: list[Outcome]) -> str:
    """Return how many holds are met, and which are not."""
    all_of_them = verdicts(outcomes)
    met = sum(message == "ok" for *_, message in all_of_them)
    rest = [
        f"  {message}: {row.name}, {hold.what}"
        for row, hold, message in all_of_them
        if message != "ok"
    ]
    return "\n".join([f"{met} of {len(all_of_them)} holds are met", *rest])


def _cells(figures: Figures) -> tuple[str, ...]:
    times = [
        f"{1e3 * seconds:.3g} ms" if seconds < 1 else f"{seconds:.2f} s" for seconds in figures[:2]
    ]
    memory = "-" if figures.megabytes is None else f"{figures.megabytes:.0f} MB"
    floor = "-" if not figures.floor else f"{figures.seconds / figures.floor:.3g}"
    return (*times, memory, floor, "-" if figures.error is None else f"{figures.error:.3g}")


def _line(who: str, cells: tuple[str, ...]) -> str:
    return f"  {who:<16}" + "".join(f"{cell:>14}" for cell in cells[:4]) + f"   {cells[4]}"
