r"""Write questions as Moodle XML, which Moodle imports into the question bank of a course.

See "Moodle XML format" in Moodle's documentation. Formulas are written as TeX between \( and \),
which Moodle's MathJax filter draws.
"""

import base64
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from html import escape

from hdrlab.course.question_bank.markdown_html import to_html
from hdrlab.course.question_bank.questions import (
    ChoiceQuestion,
    LessonQuestions,
    NumberQuestion,
    Question,
)

BANK = "$course$/top/hdrlab"  # the category of all questions
# percent of the points
RIGHT_PERCENT = "100"
WRONG_PERCENT = "0"


def to_moodle(lessons: Sequence[LessonQuestions]) -> str:
    """Return a question bank as Moodle XML, with a category for each notebook.

    Parameters
    ----------
    lessons : the questions of each notebook
    """
    quiz = ET.Element("quiz")
    for lesson in lessons:
        category = ET.SubElement(quiz, "question", type="category")
        _add_text(category, "category", f"{BANK}/{lesson.title.replace('/', '//')}")
        # Moodle sorts questions by name: 02 comes before 10
        digits = len(str(len(lesson.questions)))
        for number, question in enumerate(lesson.questions, 1):
            name = f"{lesson.title}, question {number:0{digits}}"
            _add_question(quiz, question, name, is_asked_again=lesson.is_asked_again)
    ET.indent(quiz)
    return ET.tostring(quiz, "unicode", xml_declaration=True) + "\n"


def _add_question(quiz: ET.Element, question: Question, name: str, *, is_asked_again: bool) -> None:
    is_choice = isinstance(question, ChoiceQuestion)
    element = ET.SubElement(quiz, "question", type="multichoice" if is_choice else "numerical")
    _add_text(element, "name", name)
    asked = f"<p><b>{escape(question.text)}</b></p>"
    if isinstance(question, NumberQuestion):
        asked += f"<p>{escape(question.instruction)}</p>"
    _add_html(element, "questiontext", to_html(question.context) + asked)
    explanation = "" if is_asked_again else f"<p>{escape(question.because)}</p>"
    _add_html(element, "generalfeedback", explanation)
    ET.SubElement(element, "defaultgrade").text = "1"
    ET.SubElement(element, "idnumber").text = f"hdrlab-{question.name}"
    if isinstance(question, ChoiceQuestion):
        _add_choices(element, question, shuffled=not is_asked_again)
    else:
        answer = _add_answer(element, RIGHT_PERCENT, f"{question.truth:.6g}", "moodle_auto_format")
        ET.SubElement(answer, "tolerance").text = f"{question.tolerance:.6g}"


def _add_choices(element: ET.Element, question: ChoiceQuestion, *, shuffled: bool) -> None:
    ET.SubElement(element, "single").text = "true"
    ET.SubElement(element, "shuffleanswers").text = "true" if shuffled else "false"
    ET.SubElement(element, "answernumbering").text = "abc"
    for index, label in enumerate(question.labels):
        fraction = RIGHT_PERCENT if index == question.right else WRONG_PERCENT
        html = f"<p>{escape(label)}</p>"
        if not question.images:
            _add_answer(element, fraction, html, "html")
            continue
        image = question.images[index]
        file_name = f"{question.name}-{index + 1}.webp"
        html += f'<img src="@@PLUGINFILE@@/{file_name}" alt="{escape(image.alt)}">'
        answer = _add_answer(element, fraction, html, "html")
        file = ET.SubElement(answer, "file", name=file_name, path="/", encoding="base64")
        file.text = base64.b64encode(image.content).decode()


def _add_answer(element: ET.Element, fraction: str, text: str, text_format: str) -> ET.Element:
    answer = ET.SubElement(element, "answer", fraction=fraction, format=text_format)
    ET.SubElement(answer, "text").text = text
    return answer


def _add_text(element: ET.Element, name: str, text: str) -> ET.Element:
    child = ET.SubElement(element, name)
    ET.SubElement(child, "text").text = text
    return child


def _add_html(element: ET.Element, name: str, html: str) -> None:
    _add_text(element, name, html).set("format", "html")
