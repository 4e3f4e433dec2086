"""The concept inventory: thirty questions to ask before and after the course.

Each question is a function that computes its right answer with the library, and its wrong answers
as misconceptions compute them. Each module holds the three questions of a concept.
"""

from hdrlab.course.question_bank.inventory import (
    alignment,
    edges,
    exposure,
    files_and_displays,
    least_squares,
    merging,
    noise,
    response,
    stops,
    tone_curves,
)
from hdrlab.course.question_bank.inventory.question import Concept, ConceptQuestion

CONCEPTS: tuple[Concept, ...] = (
    stops.CONCEPT,
    exposure.CONCEPT,
    noise.CONCEPT,
    response.CONCEPT,
    least_squares.CONCEPT,
    merging.CONCEPT,
    alignment.CONCEPT,
    tone_curves.CONCEPT,
    edges.CONCEPT,
    files_and_displays.CONCEPT,
)


def all_questions() -> tuple[ConceptQuestion, ...]:
    """Return the questions of all concepts, in the order of the inventory."""
    return tuple(question for concept in CONCEPTS for question in concept.questions)
