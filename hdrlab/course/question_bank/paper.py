"""Write questions as a page to print, with the answers at its end."""

from collections.abc import Sequence
from pathlib import Path

from hdrlab.course.question_bank.questions import ChoiceQuestion, LessonQuestions
from hdrlab.course.slides.render import to_html
from hdrlab.io import web
from hdrlab.show.pages.templates import render_page


def to_page(lessons: Sequence[LessonQuestions]) -> str:
    """Return a question bank as an HTML page that loads nothing.

    Parameters
    ----------
    lessons : the questions of each notebook
    """
    contexts = {}
    uris = {}
    for lesson in lessons:
        for question in lesson.questions:
            contexts[question.name] = to_html(question.context, for_notes=True)
            if isinstance(question, ChoiceQuestion):
                uris[question.name] = [web.data_uri(image.content) for image in question.images]
    return render_page(
        Path(__file__).parent,
        "paper.html",
        lessons=lessons,
        contexts=contexts,
        uris=uris,
    )
