r"""Write questions as a package of QTI 2.1, which Canvas, Blackboard and other platforms import.

QTI is Question and Test Interoperability, a format of 1EdTech (formerly IMS). A package is a ZIP
file. It contains an item for each question, a test that names the items of each notebook, the
images, and the manifest imsmanifest.xml, which lists all files. See "IMS Question & Test
Interoperability Assessment Test, Section and Item Information Model" 2.1, and "IMS Content
Packaging" 1.1.

Formulas are written as TeX between \( and \). Images are PNG files, which all platforms show.
"""

import re
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Sequence
from html import escape
from io import BytesIO

from hdrlab.course.question_bank.markdown_html import to_html
from hdrlab.course.question_bank.questions import (
    ChoiceQuestion,
    LessonQuestions,
    NumberQuestion,
    Question,
)
from hdrlab.errors import InputError
from hdrlab.io import web

QTI = "http://www.imsglobal.org/xsd/imsqti_v2p1"
PACKAGING = "http://www.imsglobal.org/xsd/imscp_v1p1"
ITEM_TYPE = "imsqti_item_xmlv2p1"
TEST_TYPE = "imsqti_test_xmlv2p1"
TEST_FILE = "test.xml"
# of all files in the package, so that the same questions make the same bytes
FILE_DATE = (1980, 1, 1, 0, 0, 0)
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def to_package(lessons: Sequence[LessonQuestions]) -> bytes:
    """Return a question bank as the ZIP file of a QTI 2.1 package.

    Parameters
    ----------
    lessons : the questions of each notebook; each becomes a section of the test

    Raises
    ------
    InputError
        If two questions have the same name.
    """
    files: dict[str, bytes] = {}
    resources = []
    for lesson in lessons:
        for number, question in enumerate(lesson.questions, 1):
            item_id = to_identifier(question.name)
            file_name = f"items/{item_id}.xml"
            if file_name in files:
                raise InputError(f"two questions have the name {question.name!r}")
            images = to_images(question, item_id)
            title = f"{lesson.title}, question {number}"
            item = item_element(question, title, list(images), is_asked_again=lesson.is_asked_again)
            files[file_name] = to_bytes(item)
            in_package = {f"items/{name}": content for name, content in images.items()}
            files |= in_package
            resources.append(resource_element(item_id, ITEM_TYPE, [file_name, *in_package]))
    files[TEST_FILE] = to_bytes(test_element(lessons))
    item_ids = [resource.get("identifier", "") for resource in resources]
    resources.append(resource_element("test", TEST_TYPE, [TEST_FILE], item_ids))
    files["imsmanifest.xml"] = to_bytes(manifest_element(resources))
    return to_zip(files)


def to_identifier(name: str) -> str:
    """Return an identifier of XML: letters, digits, "-" and "_", with a letter first.

    Examples
    --------
    >>> to_identifier("04_response gsolve")
    'hdrlab-04_response-gsolve'
    """
    return "hdrlab-" + re.sub(r"[^A-Za-z0-9_-]", "-", name)


def to_images(question: Question, item_id: str) -> dict[str, bytes]:
    """Return the images of the answers as PNG files, by their names beside the item."""
    if isinstance(question, NumberQuestion):
        return {}
    images = {}
    for index, image in enumerate(question.images, 1):
        pixels = web.decode_picture(image.content)
        images[f"images/{item_id}-{index}.png"] = web.encode_png(pixels)
    return images


def item_element(
    question: Question, title: str, image_names: Sequence[str], *, is_asked_again: bool
) -> ET.Element:
    """Return an assessmentItem: the question, its answer, its points and its feedback."""
    item = ET.Element(
        "assessmentItem",
        xmlns=QTI,
        identifier=to_identifier(question.name),
        title=title,
        adaptive="false",
        timeDependent="false",
    )
    if isinstance(question, ChoiceQuestion):
        base_type = "identifier"
        right = LETTERS[question.right]
    else:
        base_type = "float"
        right = f"{question.truth:.6g}"
    response = ET.SubElement(
        item,
        "responseDeclaration",
        identifier="RESPONSE",
        cardinality="single",
        baseType=base_type,
    )
    add_value(ET.SubElement(response, "correctResponse"), right)
    score = ET.SubElement(
        item,
        "outcomeDeclaration",
        identifier="SCORE",
        cardinality="single",
        baseType="float",
        normalMaximum="1",
    )
    add_value(ET.SubElement(score, "defaultValue"), "0")
    ET.SubElement(
        item,
        "outcomeDeclaration",
        identifier="FEEDBACK",
        cardinality="single",
        baseType="identifier",
    )
    body = ET.SubElement(item, "itemBody")
    add_html(body, to_html(question.context))
    if isinstance(question, ChoiceQuestion):
        add_choices(body, question, image_names, is_shuffled=not is_asked_again)
        feedback = {} if is_asked_again else choice_feedback(question)
    else:
        add_number(body, question)
        feedback = {} if is_asked_again else {"explanation": [question.because]}
    add_processing(item, question)
    for identifier, paragraphs in feedback.items():
        shown = ET.SubElement(
            item,
            "modalFeedback",
            outcomeIdentifier="FEEDBACK",
            identifier=identifier,
            showHide="show",
        )
        add_html(shown, "".join(f"<p>{escape(text)}</p>" for text in paragraphs))
    return item


def add_choices(
    body: ET.Element, question: ChoiceQuestion, image_names: Sequence[str], *, is_shuffled: bool
) -> None:
    """Add a choiceInteraction with the question and its answers."""
    interaction = ET.SubElement(
        body,
        "choiceInteraction",
        responseIdentifier="RESPONSE",
        shuffle="true" if is_shuffled else "false",
        maxChoices="1",
    )
    ET.SubElement(interaction, "prompt").text = question.text
    for index, label in enumerate(question.labels):
        choice = ET.SubElement(interaction, "simpleChoice", identifier=LETTERS[index])
        ET.SubElement(choice, "p").text = label
        if question.images:
            paragraph = ET.SubElement(choice, "p")
            ET.SubElement(paragraph, "img", src=image_names[index], alt=question.images[index].alt)


def add_number(body: ET.Element, question: NumberQuestion) -> None:
    """Add the question and a textEntryInteraction for a number."""
    ET.SubElement(body, "p").text = f"{question.text} {question.instruction}"
    paragraph = ET.SubElement(body, "p")
    ET.SubElement(
        paragraph, "textEntryInteraction", responseIdentifier="RESPONSE", expectedLength="10"
    )


def choice_feedback(question: ChoiceQuestion) -> dict[str, list[str]]:
    """Return the paragraphs of feedback for each choice: its misconception, and the explanation."""
    feedback = {}
    for index in range(len(question.labels)):
        misconception = question.misconceptions[index] if question.misconceptions else ""
        feedback[LETTERS[index]] = [text for text in (misconception, question.because) if text]
    return feedback


def add_processing(item: ET.Element, question: Question) -> None:
    """Add the rules that give the point for the right answer, and choose the feedback."""
    processing = ET.SubElement(item, "responseProcessing")
    condition = ET.SubElement(processing, "responseCondition")
    rule = ET.SubElement(condition, "responseIf")
    if isinstance(question, ChoiceQuestion):
        test = ET.SubElement(rule, "match")
    else:
        tolerance = f"{question.tolerance:.6g}"
        test = ET.SubElement(
            rule, "equal", toleranceMode="absolute", tolerance=f"{tolerance} {tolerance}"
        )
    ET.SubElement(test, "variable", identifier="RESPONSE")
    ET.SubElement(test, "correct", identifier="RESPONSE")
    points = ET.SubElement(rule, "setOutcomeValue", identifier="SCORE")
    ET.SubElement(points, "baseValue", baseType="float").text = "1"
    chosen = ET.SubElement(processing, "setOutcomeValue", identifier="FEEDBACK")
    if isinstance(question, ChoiceQuestion):
        ET.SubElement(chosen, "variable", identifier="RESPONSE")
    else:
        ET.SubElement(chosen, "baseValue", baseType="identifier").text = "explanation"


def test_element(lessons: Sequence[LessonQuestions]) -> ET.Element:
    """Return an assessmentTest with a section for each notebook."""
    test = ET.Element("assessmentTest", xmlns=QTI, identifier="test", title="hdrlab")
    part = ET.SubElement(
        test,
        "testPart",
        identifier="part",
        navigationMode="nonlinear",
        submissionMode="individual",
    )
    for number, lesson in enumerate(lessons, 1):
        section = ET.SubElement(
            part,
            "assessmentSection",
            identifier=f"section-{number}",
            title=lesson.title,
            visible="true",
        )
        if lesson.instructions:
            rubric = ET.SubElement(section, "rubricBlock", view="candidate")
            ET.SubElement(rubric, "p").text = lesson.instructions
        for question in lesson.questions:
            identifier = to_identifier(question.name)
            href = f"items/{identifier}.xml"
            ET.SubElement(section, "assessmentItemRef", identifier=identifier, href=href)
    return test


def resource_element(
    identifier: str, kind: str, files: Sequence[str], depends_on: Sequence[str] = ()
) -> ET.Element:
    """Return a resource of the manifest; its first file is the one to open."""
    resource = ET.Element("resource", identifier=identifier, type=kind, href=files[0])
    for name in files:
        ET.SubElement(resource, "file", href=name)
    for other in depends_on:
        ET.SubElement(resource, "dependency", identifierref=other)
    return resource


def manifest_element(resources: Sequence[ET.Element]) -> ET.Element:
    """Return the manifest of a package."""
    manifest = ET.Element("manifest", xmlns=PACKAGING, identifier="manifest")
    metadata = ET.SubElement(manifest, "metadata")
    ET.SubElement(metadata, "schema").text = "QTIv2.1 Package"
    ET.SubElement(metadata, "schemaversion").text = "1.0.0"
    ET.SubElement(manifest, "organizations")
    ET.SubElement(manifest, "resources").extend(resources)
    return manifest


def add_value(parent: ET.Element, text: str) -> None:
    """Add the element `value`."""
    ET.SubElement(parent, "value").text = text


def add_html(parent: ET.Element, html: str) -> None:
    """Add the elements of well-formed HTML."""
    parent.extend(ET.fromstring(f"<div>{html}</div>"))


def to_bytes(element: ET.Element) -> bytes:
    """Return an element as the bytes of an XML file."""
    ET.indent(element)
    return ET.tostring(element, "utf-8", xml_declaration=True) + b"\n"


def to_zip(files: dict[str, bytes]) -> bytes:
    """Return files by their names as a ZIP file; the manifest comes first."""
    package = BytesIO()
    with zipfile.ZipFile(package, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files, key=lambda name: (name != "imsmanifest.xml", name)):
            info = zipfile.ZipInfo(name, FILE_DATE)
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, files[name])
    return package.getvalue()
