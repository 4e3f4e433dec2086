"""Which tests run when: the quick tier at `python -m pytest`, another at `python -m pytest --tier=papers`.

A test is quick unless another list below names it, and the longest name counts. Quick are units, laws, the
specification on the library, the layers, the handouts against their source, the sandbox and a homework in it;
a quick test takes at most 5 s.

notebooks  every notebook, run once; what they say of their numbers; the site that is made of them
browser    JupyterLab on three notebooks, the site and the gallery in Chromium
jupyterlab the other notebooks in JupyterLab; `.ci/run` leaves it to who asks for it
grading    attacks, kills, clusters, whole classes, their likeness; how points are earned or not
papers     published experiments, and what takes seconds: real brackets, films, twelve megapixels
scenes     the embedded scenes, rendered and computed again
wheel      the wheel, installed elsewhere
"""

# by tier, how the addresses of its tests begin: a folder, a file, or one test of a file
TIERS = {
    "quick": (
        "tests/response/test_response_laws.py::test_every_recovery[marginal-film-leaves_the_photographs",
        "tests/response/test_response_laws.py::test_every_recovery[marginal-film-refuses",
        "tests/response/test_response_laws.py::test_every_recovery_that_asks_the_photographs[marginal-film-refuses",
        "tests/course/test_grading.py::test_in_a_sandbox_the_library_has_all_points_and_a_blank_none[project]",
        "tests/course/test_toy.py::test_a_folder_that_holds_something",
        "tests/course/test_toy.py::test_the_readme",
        "tests/course/test_toy.py::test_two_toy_classes",
    ),
    "notebooks": (
        "tests/test_notebooks_run.py",
        "tests/cli/test_faults.py::test_a_disk_that_refuses_is_told_in_a_line[site",
        "tests/cli/test_faults.py::test_a_site",
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
        "tests/course/test_class_benchmark.py",
        "tests/course/test_classroom.py::test_a_class_is_graded",
        "tests/course/test_classroom.py::test_a_part_of_the_class_is_graded",
        "tests/course/test_cluster.py",
        "tests/course/test_equivalents.py",
        "tests/course/test_exports.py::test_an_autograder_grades",
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
        "tests/course/test_journal.py::test_a_run_that_is_killed",
        "tests/course/test_killed.py",
        "tests/course/test_misconceptions.py::test_a_mistake_costs",
        "tests/course/test_misconceptions.py::test_nine_in_ten_are_recognised",
        "tests/course/test_own_task.py::test_it_is_graded",
        "tests/course/test_own_task.py::test_its_own_tests",
        "tests/course/test_own_task.py::test_without_solution",
        "tests/course/test_regrade.py::test_after_any_history",
        "tests/course/test_similarity.py",
        "tests/course/test_specification.py::test_two_students_draw",
        "tests/course/test_toy.py",
        "tests/course/test_traps_in_a_class.py",
        "tests/course/test_variants.py::test_a_class_is_graded",
        "tests/course/test_variants.py::test_grading_asks",
        "tests/course/test_viva.py::test_a_change_that_never_ends",
        "tests/course/test_viva.py::test_a_function_that_breaks",
        "tests/course/test_viva.py::test_an_attack_breaks",
        "tests/course/test_viva.py::test_five_questions",
        "tests/course/test_viva.py::test_of_one_function",
        "tests/course/test_viva.py::test_the_command_writes",
        "tests/course/test_viva.py::test_the_same_seed",
        "tests/course/test_windows.py",
    ),
    "papers": (
        "tests/test_papers.py",
        "tests/io/test_tethered.py::test_a_bracket_is_taken",
        "tests/io/test_tethered.py::test_a_run_that_is_stopped",
        "tests/align/test_cerman.py::test_frames_in_another_order",
        "tests/align/test_cerman.py::test_gray_and_colour",
        "tests/align/test_cerman.py::test_shift_and_rotation",
        "tests/align/test_registration.py::test_a_bracket_that_turned",
        "tests/align/test_registration.py::test_a_step_ahead_with_a_tilted_camera",
        "tests/align/test_registration.py::test_a_walk_around_the_crusader",
        "tests/align/test_registration.py::test_auto_is_never_worse_than_no_alignment",
        "tests/align/test_registration.py::test_the_arch_is_registered_to_the_measured",
        "tests/beyond/test_patches.py::test_a_moving_visitor",
        "tests/beyond/test_patches.py::test_the_steps_go",
        "tests/calibration/test_wilburn.py::test_his_polynomial",
        "tests/calibration/test_wilburn.py::test_linear_motion",
        "tests/calibration/test_wilburn.py::test_the_spline_reads_real_responses",
        "tests/capture/test_hand_motion.py::test_a_moved_camera",
        "tests/cli/test_calibrate.py::test_the_plot_carries",
        "tests/cli/test_cli.py::test_a_doubtful_map",
        "tests/cli/test_demo.py::test_the_demo_announces",
        "tests/cli/test_demo.py::test_the_demo_on_real",
        "tests/cli/test_demo.py::test_the_same_seed",
        "tests/cli/test_faults.py",
        "tests/cli/test_long_commands.py",
        "tests/diagnostics/test_motion.py::test_a_still_scene_through_sharpening",
        "tests/diagnostics/test_motion.py::test_leaves_and_water",
        "tests/diagnostics/test_times_estimate.py::test_a_calibration_estimates_times",
        "tests/diagnostics/test_times_estimate.py::test_a_frame_of_another_scene",
        "tests/diagnostics/test_times_estimate.py::test_an_estimate_far_from",
        "tests/diagnostics/test_times_estimate.py::test_corners_that_darken",
        "tests/diagnostics/test_times_estimate.py::test_of_three_photographs_a_correction",
        "tests/diagnostics/test_times_estimate.py::test_real_photographs_agree_better",
        "tests/diagnostics/test_times_estimate.py::test_the_command_corrects",
        "tests/diagnostics/test_times_estimate.py::test_the_phone",
        "tests/diagnostics/test_times_estimate.py::test_the_pipeline",
        "tests/diagnostics/test_times_estimate.py::test_times_off",
        "tests/diagnostics/test_times_estimate.py::test_weak_local",
        "tests/diagnostics/test_times_estimate.py::test_where_one_end",
        "tests/diagnostics/test_validation_of_bitmaps.py",
        "tests/diagnostics/test_validation_of_light.py",
        "tests/enhance/test_mertens.py::test_opencv_differs",
        "tests/io/test_sequence.py::test_a_bar_shows",
        "tests/io/test_sequence.py::test_a_film_comes",
        "tests/io/test_sequence.py::test_gray_frames",
        "tests/pipeline/test_certainty.py::test_half_of_a_real_map",
        "tests/pipeline/test_pipeline.py::test_a_walk_around_the_crusader",
        "tests/pipeline/test_pipeline.py::test_alignment_can_be_left_out_and_named",
        "tests/pipeline/test_pipeline.py::test_photographs_of_two_scenes",
        "tests/pipeline/test_pipeline.py::test_the_arch_is_aligned",
        "tests/pipeline/test_pipeline.py::test_the_map_explains_real_photographs",
        "tests/pipeline/test_pipeline.py::test_the_memorial_church",
        "tests/pipeline/test_pipeline.py::test_the_wrong_times_of_the_phone",
        "tests/pipeline/test_real_brackets.py",
        "tests/pipeline/test_recovery.py::test_every_recovery_by_name_is_validated[marginal",
        "tests/pipeline/test_timing.py::test_rough_times",
        "tests/radiance/test_ratios.py::test_the_darkest_pair_of_real_radiance",
        "tests/response/test_marginal.py::test_it_beats_the_published_scheme",
        "tests/response/test_marginal.py::test_it_climbs",
        "tests/response/test_marginal.py::test_the_ratios_of_the_canon",
        "tests/response/test_mitsunaga.py::test_of_201",
        "tests/response/test_mitsunaga.py::test_other_seeds",
        "tests/response/test_mitsunaga.py::test_the_stop_bounds",
        "tests/response/test_response_agreement.py::test_on_real_brackets",
        "tests/response/test_response_laws.py::test_every_recovery[marginal",
        "tests/response/test_response_laws.py::test_every_recovery_that_asks_the_photographs[marginal",
        "tests/show/test_widgets.py::test_a_plot_on_ground",
        "tests/test_fuzz.py::test_a_reader_that_waits",
        "tests/test_fuzz.py::test_whatever_is_neither",
        "tests/test_mutation.py::test_a_mutant_is_killed",
        "tests/tonemap/test_quality.py::test_structural_fidelity",
    ),
    "scenes": ("tests/scenes/",),
    "wheel": ("tests/test_wheel.py",),
}
QUICK, ALL = "quick", "all"
STARTS = tuple(start for starts in TIERS.values() for start in starts)
# begun first, in this order: what is long, or what the others of its tier wait for; begun last, one worker
# would be busy with it alone
FIRST = (
    "tests/course/test_site.py",
    "tests/browser/test_site_in_a_browser.py",
    "tests/course/test_killed.py",
    "tests/course/test_toy.py",
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
        (len(start), tier) for tier, starts in TIERS.items() for start in starts if address.startswith(start)
    ]
    return max(found)[1]


def may_hold(address: str, tier: str) -> bool:
    """Return whether there can be tests of a tier at the address of a file, or of a folder: tests/course/."""
    below = any(start.startswith(address) for start in TIERS.get(tier, ()))
    return tier == ALL or below or tier_of(address) == tier
