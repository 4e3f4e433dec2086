"""Which tests run when: the quick tier at `python -m pytest`, another at `python -m pytest --tier=papers`.

A test is quick unless a list below names it: units, laws, the specification on the library, the layers, the
handouts against their source, a homework through the sandbox. A quick test takes at most 5 s.

notebooks  every notebook, run once; the site that is made of notebooks
browser    JupyterLab, the site and the gallery in Chromium
grading    attacks, kills, clusters, whole classes
papers     published experiments, and what takes many seconds on real photographs
scenes     the embedded scenes, rendered and computed again
wheel      the wheel, installed elsewhere
"""

# by tier, how the addresses of its tests begin: a folder, a file, or one test of a file
TIERS = {
    "notebooks": ("tests/test_notebooks_run.py", "tests/course/test_site.py"),
    "browser": ("tests/browser/",),
    "grading": (
        "tests/course/test_attacks",
        "tests/course/test_class_benchmark.py",
        "tests/course/test_classroom.py",
        "tests/course/test_cluster.py",
        "tests/course/test_equivalents.py",
        "tests/course/test_gallery.py::test_a_server_that_is_killed",
        "tests/course/test_gallery.py::test_voters_of_a_second_process",
        "tests/course/test_gallery_attacks.py",
        "tests/course/test_hostile_class.py",
        "tests/course/test_hostile_code.py",
        "tests/course/test_killed.py",
        "tests/course/test_traps_in_a_class.py",
    ),
    "papers": (
        "tests/test_papers.py",
        "tests/align/test_registration.py::test_a_walk_around_the_crusader",
        "tests/calibration/test_wilburn.py::test_the_spline_reads_real_responses",
        "tests/response/test_marginal.py::test_it_beats_the_published_scheme",
    ),
    "scenes": ("tests/scenes/",),
    "wheel": ("tests/test_wheel.py",),
}
QUICK, ALL = "quick", "all"


def tier_of(address: str) -> str:
    """Return the tier of a test, given its address from the repository's folder on."""
    return next((tier for tier, starts in TIERS.items() if address.startswith(starts)), QUICK)


def may_hold(address: str, tier: str) -> bool:
    """Return whether there can be tests of a tier at the address of a file, or of a folder: tests/course/."""
    if tier in (QUICK, ALL):
        return tier == ALL or tier_of(address) == QUICK
    return any(start.startswith(address) or address.startswith(start) for start in TIERS[tier])
