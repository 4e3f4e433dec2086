"""Question banks as packages of QTI 2.1: what a learning platform reads in them."""

import io
import xml.etree.ElementTree as ET
import zipfile
from importlib.util import find_spec
from pathlib import PurePosixPath

import numpy as np
import pytest
from PIL import Image

from hdrlab import cli
from hdrlab.course.question_bank import bank, qti
from hdrlab.course.question_bank.questions import (
    ChoiceQuestion,
    Image as AnswerImage,
    LessonQuestions,
    NumberQuestion,
)
from hdrlab.io import web

pytestmark = pytest.mark.skipif(
    any(find_spec(name) is None for name in ("mdit_py_plugins", "ziamath")),
    reason='question banks need pip install ".[site]"',
)
NAMES = {"q": "http://www.imsglobal.org/xsd/imsqti_v2p1", "p": qti.PACKAGING}
# The children of an assessmentItem, in the order of the information model of QTI 2.1.
ITEM_CHILDREN = [
    "responseDeclaration",
    "outcomeDeclaration",
    "itemBody",
    "responseProcessing",
    "modalFeedback",
]
LEVELS = (20, 200)
SHARED = {"context": "With $\\beta < 1$ & *light*.", "because": "It is < lit."}
CHOICE = ChoiceQuestion(
    name="01 sky",
    text="Sky or <wall>?",
    labels=("the sky", "the wall", "neither"),
    right=1,
    misconceptions=("Looks up.", "", "Looks away."),
    **SHARED,
)
IMAGES = ChoiceQuestion(
    name="dark",
    text="Which is darker?",
    labels=("left", "right"),
    right=0,
    images=tuple(
        AnswerImage(web.encode_webp(np.full((9, 9), level, np.uint8), lossless=True), str(level))
        for level in LEVELS
    ),
    **SHARED,
)
NUMBER = NumberQuestion(
    name="stops", text="How many?", truth=11.4, low=0, high=20, unit="stops", **SHARED
)
LESSONS = [
    LessonQuestions("Light & shade", (CHOICE, IMAGES)),
    LessonQuestions("Numbers", (NUMBER,), instructions="Answer all."),
]


class Package:
    """A package as a platform reads it: from the manifest to the test, and to the items."""

    def __init__(self, content):
        self.archive = zipfile.ZipFile(io.BytesIO(content))
        self.manifest = ET.fromstring(self.archive.read("imsmanifest.xml"))
        self.resources = {
            resource.get("identifier"): resource
            for resource in self.manifest.findall("p:resources/p:resource", NAMES)
        }
        (test,) = [
            resource
            for resource in self.resources.values()
            if resource.get("type") == "imsqti_test_xmlv2p1"
        ]
        self.test_resource = test
        self.test = ET.fromstring(self.archive.read(test.get("href")))
        references = self.test.iterfind(".//q:assessmentItemRef", NAMES)
        self.items = {
            reference.get("identifier"): ET.fromstring(self.archive.read(reference.get("href")))
            for reference in references
        }


def outcomes(item, response):
    """Return SCORE and the text of the feedback for a response, by the item's own rules."""
    declared = {
        outcome.get("identifier"): outcome.findtext("q:defaultValue/q:value", None, NAMES)
        for outcome in item.findall("q:outcomeDeclaration", NAMES)
    }
    correct = item.findtext("q:responseDeclaration/q:correctResponse/q:value", None, NAMES)

    def value(expression):
        kind = expression.tag.rpartition("}")[2]
        if kind == "variable":
            return response
        return correct if kind == "correct" else expression.text

    def holds(expression):
        first, second = map(value, expression)
        if expression.tag.endswith("match"):
            return first == second
        below, above = map(float, expression.get("tolerance").split())
        assert expression.get("toleranceMode") == "absolute"
        return float(second) - below <= float(first) <= float(second) + above

    for rule in item.find("q:responseProcessing", NAMES):
        setters = [rule]
        if rule.tag.endswith("responseCondition"):
            condition, *setters = rule.find("q:responseIf", NAMES)
            setters = setters if holds(condition) else []
        for setter in setters:
            assert setter.get("identifier") in declared
            declared[setter.get("identifier")] = value(setter[0])
    shown = [
        "".join(feedback.itertext())
        for feedback in item.findall("q:modalFeedback", NAMES)
        if feedback.get("identifier") == declared[feedback.get("outcomeIdentifier")]
    ]
    return float(declared["SCORE"]), " ".join(" ".join(shown).split())


@pytest.fixture(scope="module")
def package():
    return Package(qti.to_package(LESSONS))


def text_of(item):
    return " ".join("".join(item.find("q:itemBody", NAMES).itertext()).split())


def test_the_manifest_lists_each_file_of_the_package_once(package):
    listed = [file.get("href") for file in package.manifest.iterfind(".//p:file", NAMES)]
    assert sorted([*listed, "imsmanifest.xml"]) == sorted(package.archive.namelist())
    for resource in package.resources.values():
        assert resource.get("href") in [file.get("href") for file in resource]
    depended = {one.get("identifierref") for one in package.test_resource} - {None}
    assert depended == set(package.items) == set(package.resources) - {"test"}


def test_each_notebook_is_a_section_with_its_questions_in_order(package):
    sections = package.test.findall(".//q:assessmentSection", NAMES)
    assert [section.get("title") for section in sections] == ["Light & shade", "Numbers"]
    texts = [text_of(item) for item in package.items.values()]
    for question, text in zip((CHOICE, IMAGES, NUMBER), texts, strict=True):
        assert question.text in text
    assert "Answer all." in "".join(sections[1].itertext())


def test_an_item_has_the_elements_of_qti_in_their_order(package):
    for identifier, item in package.items.items():
        assert item.tag == f"{{{NAMES['q']}}}assessmentItem"
        assert item.get("identifier") == identifier and item.get("adaptive") == "false"
        kinds = [child.tag.rpartition("}")[2] for child in item]
        assert kinds == sorted(kinds, key=ITEM_CHILDREN.index)
        (interaction,) = [one for one in item.iter() if one.get("responseIdentifier")]
        (declared,) = item.findall("q:responseDeclaration", NAMES)
        assert interaction.get("responseIdentifier") == declared.get("identifier")


def test_the_right_choice_alone_gets_the_point_and_each_choice_its_feedback(package):
    item = package.items["hdrlab-01-sky"]
    choices = {
        "".join(choice.itertext()).strip(): choice.get("identifier")
        for choice in item.iterfind(".//q:simpleChoice", NAMES)
    }
    assert list(choices) == list(CHOICE.labels)
    assert outcomes(item, choices["the sky"]) == (0, "Looks up. It is < lit.")
    assert outcomes(item, choices["the wall"]) == (1, "It is < lit.")
    assert outcomes(item, choices["neither"]) == (0, "Looks away. It is < lit.")


def test_a_number_gets_the_point_within_the_tolerance_of_the_notebook(package):
    item = package.items["hdrlab-stops"]
    scores = [outcomes(item, answer)[0] for answer in ("9.3", "9.5", "11.4", "13.3", "13.5")]
    assert scores == [0, 1, 1, 1, 0]
    assert outcomes(item, "1")[1] == "It is < lit."


def test_context_and_formulas_are_in_the_item(package):
    assert r"With \(\beta < 1\) & light." in text_of(package.items["hdrlab-01-sky"])


def test_images_are_files_beside_their_item_and_keep_their_pixels(package):
    (resource,) = [package.resources["hdrlab-dark"]]
    folder = PurePosixPath(resource.get("href")).parent
    shown = list(package.items["hdrlab-dark"].iterfind(".//q:img", NAMES))
    assert [image.get("alt") for image in shown] == ["20", "200"]
    for image, level in zip(shown, LEVELS, strict=True):
        path = str(folder / image.get("src"))
        assert path in [file.get("href") for file in resource]
        pixels = np.asarray(Image.open(io.BytesIO(package.archive.read(path))).convert("L"))
        assert np.all(pixels == level)


def test_the_same_questions_make_the_same_bytes():
    assert qti.to_package(LESSONS) == qti.to_package(LESSONS)


def test_two_questions_with_one_name_are_refused():
    with pytest.raises(ValueError, match="01 sky"):
        qti.to_package([LessonQuestions("Twice", (CHOICE, CHOICE))])


def test_the_inventory_shows_no_explanation_and_keeps_the_order_of_its_answers(tmp_path, capsys):
    with pytest.raises(SystemExit):
        cli.run(["course", "questions", "--inventory", "-o", str(tmp_path / "inventory.zip")])
    assert "30 questions" in capsys.readouterr().out
    package = Package((tmp_path / "inventory.zip").read_bytes())
    lesson = bank.inventory_lesson()
    for question in lesson.questions:
        item = package.items[qti.to_identifier(question.name)]
        interaction = item.find(".//q:choiceInteraction", NAMES)
        assert interaction.get("shuffle") == "false"
        labels = ["".join(choice.itertext()).strip() for choice in interaction[1:]]
        assert labels == list(question.labels)
        letter = interaction[1 + question.right].get("identifier")
        assert outcomes(item, letter) == (1, "")
