"""Which tests run when: the quick tier at `python -m pytest`, another at `python -m pytest --tier=papers`.

A test is quick unless another list below names it, and the longest name counts. Quick are units, laws, the
specification on the library, the layers, the handouts against their source, one homework through the sandbox;
a quick test takes at most 5 s.

notebooks  every notebook, run once; the site that is made of notebooks
browser    JupyterLab on three notebooks, the site and the gallery in Chromium
jupyterlab the other notebooks in JupyterLab; `.ci/run` leaves it to who asks for it
grading    attacks, kills, clusters, whole classes
papers     published experiments, and what takes many seconds: real brackets, twelve megapixels
scenes     the embedded scenes, rendered and computed again
wheel      the wheel, installed elsewhere
"""

# by tier, how the addresses of its tests begin: a folder, a file, or one test of a file
TIERS = {
    "quick": (
        "tests/course/test_grading.py::test_in_a_sandbox_the_library_has_all_points_and_a_blank_none[project]",
    ),
    "notebooks": (
        "tests/test_notebooks_run.py",
        "tests/course/test_handouts.py::test_building_writes_both",
        "tests/course/test_site.py",
    ),
    "browser": ("tests/browser/",),
    "jupyterlab": ("tests/browser/test_notebooks_in_jupyterlab.py::TestOthers",),
    "grading": (
        "tests/course/test_attacks",
        "tests/course/test_class_benchmark.py",
        "tests/course/test_classroom.py",
        "tests/course/test_cluster.py",
        "tests/course/test_equivalents.py",
        "tests/course/test_gallery.py::test_a_server_that_is_killed",
        "tests/course/test_gallery.py::test_voters_of_a_second_process",
        "tests/course/test_gallery_attacks.py",
        "tests/course/test_grading.py",
        "tests/course/test_hostile_class.py",
        "tests/course/test_hostile_code.py",
        "tests/course/test_killed.py",
        "tests/course/test_misconceptions.py::test_nine_in_ten_are_recognised",
        "tests/course/test_toy.py",
        "tests/course/test_traps_in_a_class.py",
        "tests/course/test_windows.py::test_an_instructor_grades_a_class",
    ),
    "papers": (
        "tests/test_papers.py",
        "tests/align/test_registration.py::test_a_walk_around_the_crusader",
        "tests/align/test_registration.py::test_auto_is_never_worse_than_no_alignment",
        "tests/align/test_registration.py::test_the_arch_is_registered_to_the_measured",
        "tests/calibration/test_wilburn.py::test_the_spline_reads_real_responses",
        "tests/cli/test_long_commands.py",
        "tests/diagnostics/test_motion.py::test_a_still_scene_through_sharpening",
        "tests/diagnostics/test_motion.py::test_leaves_and_water",
        "tests/diagnostics/test_times_estimate.py::test_a_calibration_estimates_times_in_the_same_words[all",
        "tests/diagnostics/test_times_estimate.py::test_real_photographs_agree_better",
        "tests/diagnostics/test_validation_of_bitmaps.py::test_the_arch_is_aligned_to_a_pixel",
        "tests/pipeline/test_pipeline.py::test_a_walk_around_the_crusader",
        "tests/pipeline/test_pipeline.py::test_alignment_can_be_left_out_and_named",
        "tests/pipeline/test_pipeline.py::test_photographs_of_two_scenes",
        "tests/pipeline/test_pipeline.py::test_the_map_explains_real_photographs",
        "tests/pipeline/test_pipeline.py::test_the_memorial_church",
        "tests/pipeline/test_pipeline.py::test_the_wrong_times_of_the_phone",
        "tests/pipeline/test_real_brackets.py",
        "tests/pipeline/test_recovery.py::test_every_recovery_by_name_is_validated[marginal",
        "tests/response/test_marginal.py::test_it_beats_the_published_scheme",
        "tests/response/test_response_agreement.py::test_on_real_brackets",
    ),
    "scenes": ("tests/scenes/",),
    "wheel": ("tests/test_wheel.py",),
}
QUICK, ALL = "quick", "all"


def tier_of(address: str) -> str:
    """Return the tier of a test, given its address from the repository's folder on: of the longest start."""
    found = [
        (len(start), tier) for tier, starts in TIERS.items() for start in starts if address.startswith(start)
    ]
    return max(found, default=(0, QUICK))[1]


def may_hold(address: str, tier: str) -> bool:
    """Return whether there can be tests of a tier at the address of a file, or of a folder: tests/course/."""
    below = any(start.startswith(address) for start in TIERS.get(tier, ()))
    return tier == ALL or below or tier_of(address) == tier
