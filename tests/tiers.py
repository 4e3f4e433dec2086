"""Which tests run when: the quick tier at `python -m pytest`, another at `python -m pytest --tier=papers`.

A test is quick unless another list below names it, and the longest name counts. Quick are units,
laws, the specification on the library, the layers, the handouts against their source, the sandbox
and a homework in it; a quick test takes at most 5 s.

notebooks  every notebook, run once; what they say of their numbers; the site that is made of them
browser    JupyterLab on three notebooks, the site and the gallery in Chromium
jupyterlab the other notebooks in JupyterLab; `.ci/run` leaves it to who asks for it
grading    attacks, kills, clusters, whole classes, their likeness; how points are earned or not
papers     published experiments, and what takes seconds: real brackets, films, registration, a tethered
           camera, twelve megapixels
scenes     the embedded scenes, rendered and computed again
wheel      the wheel, installed elsewhere
"""

# by tier, how the addresses of its tests begin: a folder, a file, or one test of a file
TIERS = {
    "quick": (
        "tests/beyond/test_patches.py::test_only_what_a_longer",
        "tests/calibration/test_wilburn.py::test_a_picture_that_shows_no_grid",
        "tests/calibration/test_wilburn.py::test_curves_that_differ",
        "tests/response/test_response_laws.py::test_every_recovery[marginal-film-leaves_the_photographs",
        "tests/response/test_response_laws.py::test_every_recovery[marginal-film-refuses",
        "tests/response/test_response_laws.py::test_every_recovery_that_asks_the_photographs[marginal-film-refuses",
        "tests/course/test_grading.py::test_in_a_sandbox_the_library_has_all_points_and_a_blank_none[project]",
        "tests/course/test_hostile_files.py::test_a_reader_that_is_killed",
        "tests/course/test_journal.py::test_an_older_result",
        "tests/course/test_toy.py::test_a_folder_that_holds_something",
        "tests/course/test_toy.py::test_a_toy_class_has",
        "tests/course/test_toy.py::test_the_readme",
        "tests/course/test_toy.py::test_two_toy_classes",
        "tests/course/test_variants.py::test_each_variant_has_checks",
        "tests/diagnostics/test_motion.py::test_gray",
        "tests/pipeline/test_alignment.py::test_another_percentile",
        "tests/pipeline/test_alignment.py::test_the_simplest_search",
        "tests/pipeline/test_recovery.py::test_linear_and",
        "tests/pipeline/test_recovery.py::test_one_curve",
        "tests/pipeline/test_timing.py::test_a_rough_time_is",
    ),
    "notebooks": (
        "tests/test_notebooks_run.py",
        "tests/cli/test_faults.py::test_a_disk_that_refuses_is_told_in_a_line[site",
        "tests/course/test_handouts.py::test_building_writes_both",
        "tests/course/test_site.py",
    ),
    "browser": ("tests/browser/",),
    "jupyterlab": ("tests/browser/test_notebooks_in_jupyterlab.py::TestOthers",),
    "grading": (
        "tests/cli/test_check_command.py::test_a_secret_is_made",
        "tests/cli/test_check_command.py::test_check_gives_as_many",
        "tests/cli/test_check_command.py::test_check_says",
        "tests/cli/test_check_command.py::test_check_writes",
        "tests/cli/test_check_command.py::test_grade_draws",
        "tests/cli/test_check_command.py::test_grade_writes",
        "tests/cli/test_check_command.py::test_that_a_score_is_for_practice",
        "tests/course/test_attacks",
        "tests/course/test_channel.py::test_plain_values",
        "tests/course/test_check.py::test_a_bar_grows",
        "tests/course/test_class_benchmark.py",
        "tests/course/test_classroom.py::test_a_class_is_graded",
        "tests/course/test_classroom.py::test_a_part_of_the_class_is_graded",
        "tests/course/test_cluster.py",
        "tests/course/test_equivalents.py",
        "tests/course/test_execute.py",
        "tests/course/test_exports.py::test_an_autograder_grades",
        "tests/course/test_exports.py::test_an_autograder_holds",
        "tests/course/test_exports.py::test_an_autograder_that_cannot",
        "tests/course/test_exports.py::test_nbgrader_makes",
        "tests/course/test_fairness.py",
        "tests/course/test_gallery.py::test_a_server_that_is_killed",
        "tests/course/test_gallery.py::test_voters_are_answered",
        "tests/course/test_gallery.py::test_voters_of_a_second_process",
        "tests/course/test_gallery_attacks.py",
        "tests/course/test_gaming.py",
        "tests/course/test_grading.py",
        "tests/course/test_hostile_class.py",
        "tests/course/test_hostile_code.py",
        "tests/course/test_hostile_files.py",
        "tests/course/test_imitation.py",
        "tests/course/test_journal.py",
        "tests/course/test_killed.py",
        "tests/course/test_misconceptions.py::test_a_mistake_costs",
        "tests/course/test_misconceptions.py::test_a_mistake_is_named_in",
        "tests/course/test_misconceptions.py::test_nine_in_ten_are_recognised",
        "tests/course/test_misconceptions.py::test_nonsense",
        "tests/course/test_misconceptions.py::test_the_library_has_no",
        "tests/course/test_own_task.py::test_it_is_graded",
        "tests/course/test_own_task.py::test_its_own_tests",
        "tests/course/test_own_task.py::test_without_solution",
        "tests/course/test_regrade.py::test_after_any_history",
        "tests/course/test_sandbox.py::test_no_package",
        "tests/course/test_sandbox.py::test_the_grader_that_is_killed",
        "tests/course/test_similarity.py",
        "tests/course/test_specification.py::test_a_blank_stub",
        "tests/course/test_specification.py::test_two_students_draw",
        "tests/course/test_systems.py",
        "tests/course/test_toy.py",
        "tests/course/test_traps_in_a_class.py",
        "tests/course/test_variants.py",
        "tests/course/test_viva.py",
        "tests/course/test_windows.py",
    ),
    "papers": (
        "tests/test_papers.py",
        "tests/align/test_cerman.py",
        "tests/align/test_registration.py",
        "tests/beyond/test_patches.py",
        "tests/beyond/test_video.py::test_each_frame_is_nearer",
        "tests/beyond/test_video.py::test_the_times_of_a_turn",
        "tests/calibration/test_chart.py::test_the_reflectances",
        "tests/calibration/test_wilburn.py",
        "tests/capture/test_hand_motion.py::test_a_moved_camera",
        "tests/cli/test_calibrate.py::test_the_plot_carries",
        "tests/cli/test_cli.py::test_a_doubtful_map",
        "tests/cli/test_cli.py::test_a_map_is_written_with",
        "tests/cli/test_cli.py::test_assembling_loads",
        "tests/cli/test_cli.py::test_lab_opens",
        "tests/cli/test_cli.py::test_numbers_in_a_list",
        "tests/cli/test_cli.py::test_the_files_may_be_named",
        "tests/cli/test_cli.py::test_times_that_nobody",
        "tests/cli/test_demo.py::test_the_demo_announces",
        "tests/cli/test_demo.py::test_the_demo_on_real",
        "tests/cli/test_demo.py::test_the_same_seed",
        "tests/cli/test_exposures_command.py::test_meter_names",
        "tests/cli/test_faults.py",
        "tests/cli/test_long_commands.py",
        "tests/diagnostics/test_motion.py",
        "tests/diagnostics/test_noise.py",
        "tests/diagnostics/test_times_estimate.py",
        "tests/diagnostics/test_validation_of_bitmaps.py",
        "tests/diagnostics/test_validation_of_light.py",
        "tests/enhance/test_mertens.py::test_opencv_differs",
        "tests/io/test_curves_files.py::test_gray_curves",
        "tests/io/test_jpegxl.py::test_a_header_says",
        "tests/io/test_photos.py::test_real_brackets",
        "tests/io/test_sequence.py",
        "tests/io/test_tethered.py",
        "tests/io/test_times.py::test_any_text",
        "tests/pipeline/test_alignment.py",
        "tests/pipeline/test_certainty.py",
        "tests/pipeline/test_ghosts_in_the_pipeline.py",
        "tests/pipeline/test_pipeline.py::test_a_border_that",
        "tests/pipeline/test_pipeline.py::test_a_photograph_that_contradicts",
        "tests/pipeline/test_pipeline.py::test_a_stage_is",
        "tests/pipeline/test_pipeline.py::test_a_walk_around_the_crusader",
        "tests/pipeline/test_pipeline.py::test_alignment_can_be_left_out_and_named",
        "tests/pipeline/test_pipeline.py::test_in_place",
        "tests/pipeline/test_pipeline.py::test_of_two_photographs",
        "tests/pipeline/test_pipeline.py::test_photographs_of_two_scenes",
        "tests/pipeline/test_pipeline.py::test_the_arch_is_aligned",
        "tests/pipeline/test_pipeline.py::test_the_map_explains_real_photographs",
        "tests/pipeline/test_pipeline.py::test_the_memorial_church",
        "tests/pipeline/test_pipeline.py::test_the_wrong_times_of_the_phone",
        "tests/pipeline/test_pipeline.py::test_times_that_the_photographs",
        "tests/pipeline/test_real_brackets.py",
        "tests/pipeline/test_recovery.py",
        "tests/pipeline/test_timing.py",
        "tests/radiance/test_flare.py::test_real_photographs_without",
        "tests/radiance/test_ratios.py::test_the_darkest_pair_of_real_radiance",
        "tests/response/test_marginal.py::test_it_beats_the_published_scheme",
        "tests/response/test_marginal.py::test_it_climbs",
        "tests/response/test_marginal.py::test_the_ratios_of_the_canon",
        "tests/response/test_mitsunaga.py::test_of_201",
        "tests/response/test_mitsunaga.py::test_other_seeds",
        "tests/response/test_mitsunaga.py::test_the_stop_bounds",
        "tests/response/test_response_agreement.py::test_contradictions",
        "tests/response/test_response_agreement.py::test_on_real_brackets",
        "tests/response/test_response_laws.py::test_every_recovery[marginal",
        "tests/response/test_response_laws.py::test_every_recovery_that_asks_the_photographs[marginal",
        "tests/response/test_space.py::test_the_response_of_measured",
        "tests/show/test_show_nearest.py::test_a_picture_is_drawn_to_the_bit",
        "tests/show/test_widgets.py::test_a_plot_on_ground",
        "tests/show/test_widgets.py::test_a_press_means",
        "tests/show/test_widgets.py::test_a_saved_notebook",
        "tests/test_fuzz.py::test_a_reader_that_waits",
        "tests/test_fuzz.py::test_whatever_is_neither",
        "tests/test_fuzz.py::test_words_past",
        "tests/test_mutation.py",
        "tests/tonemap/test_quality.py::test_structural_fidelity",
    ),
    "scenes": ("tests/scenes/",),
    "wheel": ("tests/test_wheel.py",),
}
QUICK, ALL = "quick", "all"
STARTS = tuple(start for starts in TIERS.values() for start in starts)
# begun first, in this order: what is long, or what the others of its tier wait for; begun last, one
# worker would be busy with it alone
FIRST = (
    "tests/course/test_site.py",
    "tests/browser/test_site_in_a_browser.py",
    "tests/course/test_killed.py",
    "tests/course/test_toy.py",
    "tests/course/test_viva.py",
    "tests/course/test_regrade.py",
    "tests/course/test_variants.py",
    "tests/course/test_exports.py",
    "tests/course/test_hostile_class.py",
    "tests/course/test_attacks_class.py",
    "tests/course/test_cluster.py",
    "tests/course/test_traps_in_a_class.py",
    "tests/course/test_windows.py",
    "tests/course/test_hostile_code.py",
    "tests/course/test_fairness.py",
    "tests/course/test_misconceptions.py",
    "tests/course/test_gaming.py",
    "tests/test_papers.py",
    "tests/pipeline/test_pipeline.py",
    "tests/pipeline/test_real_brackets.py",
    "tests/diagnostics/test_times_estimate.py",
    "tests/cli/test_faults.py",
)


def turn(address: str) -> int:
    """Return when a test's turn is: the place in FIRST of how its address begins, or behind them all."""
    return next((k for k, start in enumerate(FIRST) if address.startswith(start)), len(FIRST))


def tier_of(address: str) -> str:
    """Return the tier of a test, given its address from the repository's folder on: of the longest start."""
    if not address.startswith(STARTS):  # most are in no list
        return QUICK
    found = [
        (len(start), tier)
        for tier, starts in TIERS.items()
        for start in starts
        if address.startswith(start)
    ]
    return max(found)[1]


def may_hold(address: str, tier: str) -> bool:
    """Return whether there can be tests of a tier at the address of a file, or of a folder: tests/course/."""
    below = any(start.startswith(address) for start in TIERS.get(tier, ()))
    return tier == ALL or below or tier_of(address) == tier
