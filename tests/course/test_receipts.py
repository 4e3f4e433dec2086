"""A receipt proves the points of a submission: any change is found, and nothing else is needed."""

import hashlib
import html
import json
import os
import re
import shutil
import stat
import subprocess
import sys
import zipfile

import numpy as np
import pytest
from support.small_class import make_result

from hdrlab import cli
from hdrlab.cli import common
from hdrlab.course.grading import results
from hdrlab.errors import FileFormatError, InputError

receipts = pytest.importorskip("hdrlab.course.reports.receipts", reason="needs cryptography")

TRIALS = 1000
NOTEBOOK = b'{"cells": [], "nbformat": 4, "note": "a submission"}\n' * 3
RESULT = make_result(
    "t",
    "",
    "late",
    submission=hashlib.sha256(NOTEBOOK).hexdigest(),
    specification="ab" * 32,
    versions={"hdrlab": "0.2.0", "numpy": "2.0", "python": "3.11"},
)
SIGN_IN_A_PROCESS = """
import sys
from pathlib import Path
from hdrlab.course.grading import results
from hdrlab.course.reports import receipts
result = results.from_json(Path(sys.argv[1]).read_bytes())
key, _ = receipts.read_private_key(Path(sys.argv[2]))
print(receipts.sign(result, ["b1", "b2"], key))
"""


@pytest.fixture
def key(tmp_path):
    """Return a new private key; its file is key.pem."""
    private_key, is_new = receipts.read_private_key(tmp_path / "key.pem")
    assert is_new
    return private_key


@pytest.fixture
def receipt(key, tmp_path):
    """Return the file of a receipt, as a student gets it."""
    path = tmp_path / "receipt.txt"
    path.write_text(receipts.sign(RESULT, ["b1", "b2"], key) + "\n")
    return path


def change_one_byte(data, trial, rng):
    """Return data with another byte at one position; a thousand trials cover all positions."""
    position = trial * len(data) // TRIALS if len(data) <= TRIALS else rng.integers(len(data))
    changed = bytearray(data)
    changed[position] ^= rng.integers(1, 256)
    return bytes(changed)


def run(*words):
    """Run a command of hdrlab, and return its exit code."""
    with pytest.raises(SystemExit) as ended:
        cli.run([str(word) for word in words])
    return ended.value.code


def test_a_receipt_says_who_got_how_many_points_for_which_file(receipt, key):
    (content,) = receipts.verify_file(receipt, key.public_key())
    assert (content["homework"], content["students"]) == ("hw2", ["b1", "b2"])
    assert (content["points"], content["of"], content["tasks"]) == (1, 2, {"a": [1, 2]})
    assert content["submission"] == hashlib.sha256(NOTEBOOK).hexdigest()
    assert content["checks"] == "ab" * 32 and content["hdrlab"] == "0.2.0"


def test_each_of_a_thousand_changed_bytes_of_a_receipt_is_found(receipt, key):
    original = receipt.read_bytes()
    assert len(original) <= TRIALS  # so that the trials reach every byte
    rng = np.random.default_rng(1)
    found = 0
    for trial in range(TRIALS):
        receipt.write_bytes(change_one_byte(original, trial, rng))
        with pytest.raises(receipts.ReceiptError, match=re.escape(receipt.name)):
            receipts.verify_file(receipt, key.public_key())
        found += 1
    assert found == TRIALS


def test_each_of_a_thousand_changed_bytes_of_a_submission_is_found(receipt, key, tmp_path):
    contents = receipts.verify_file(receipt, key.public_key())
    submission = tmp_path / "hw2.ipynb"
    submission.write_bytes(NOTEBOOK)
    receipts.verify_submission(contents, submission)
    rng = np.random.default_rng(2)
    found = 0
    for trial in range(TRIALS):
        submission.write_bytes(change_one_byte(NOTEBOOK, trial, rng))
        with pytest.raises(receipts.ReceiptError, match=submission.name):
            receipts.verify_submission(contents, submission)
        found += 1
    assert found == TRIALS


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.replace(b'"points": 1.0', b'"points": 2.0'),
        lambda data: data.upper(),
        lambda data: data[:-3],
        lambda data: data.replace(b'"points": 1.0', b'"points": 2.0, "points": 1.0'),
        lambda data: data.replace(b", ", b","),
        lambda data: data + b"\n",
        lambda data: data + data[:-9],
        lambda data: b"",
        lambda data: b"\xff" * 500,
    ],
)
def test_other_changes_of_a_receipt_are_found(receipt, key, change):
    receipt.write_bytes(change(receipt.read_bytes()))
    with pytest.raises(receipts.ReceiptError):
        receipts.verify_file(receipt, key.public_key())


@pytest.mark.parametrize("end", [b"", b"\n", b"\r\n"])
def test_a_receipt_may_be_copied_by_programs_with_other_line_ends(receipt, key, end):
    receipt.write_bytes(receipt.read_bytes().rstrip(b"\n") + end)
    assert len(receipts.verify_file(receipt, key.public_key())) == 1


def test_another_computer_gives_the_same_receipt(receipt, tmp_path):
    result = tmp_path / "result.json"
    result.write_bytes(results.to_json(RESULT))
    environment = os.environ | {"TZ": "Asia/Tokyo", "LC_ALL": "C", "PYTHONHASHSEED": "7"}
    words = [sys.executable, "-W", "ignore", "-c", SIGN_IN_A_PROCESS, result, tmp_path / "key.pem"]
    signed = subprocess.run(words, env=environment, capture_output=True, check=True, cwd="/")
    assert signed.stdout.decode().splitlines() == receipt.read_text().splitlines()


@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs OpenSSL's program")
def test_openssl_verifies_a_receipt_without_hdrlab(receipt, tmp_path):
    match = re.fullmatch(r'(.*), "signature": "(.*)"\}\n', receipt.read_text())
    (tmp_path / "text").write_text(match[1] + "}")
    (tmp_path / "signature").write_bytes(bytes.fromhex(match[2]))
    words = ["openssl", "pkeyutl", "-verify", "-rawin", "-pubin", "-inkey", "key.pem.pub"]
    words += ["-in", "text", "-sigfile", "signature"]
    assert subprocess.run(words, cwd=tmp_path, capture_output=True).returncode == 0
    (tmp_path / "text").write_text(match[1] + " }")
    assert subprocess.run(words, cwd=tmp_path, capture_output=True).returncode != 0


def test_a_receipt_of_another_key_is_refused_with_both_keys(receipt, key, tmp_path):
    other, _ = receipts.read_private_key(tmp_path / "other.pem")
    with pytest.raises(receipts.ReceiptError, match="another key signed it") as error:
        receipts.verify_file(receipt, other.public_key())
    for public_key in (key.public_key(), other.public_key()):
        assert receipts.key_id(public_key) in str(error.value)
    # a forger may write the id of the course's key into a receipt of their own
    ids = [receipts.key_id(other.public_key()), receipts.key_id(key.public_key())]
    forged = receipts.sign(RESULT, ["b1"], other).replace(*ids)
    with pytest.raises(receipts.ReceiptError, match="signature"):
        receipts.verify(forged.encode(), key.public_key())


def test_the_submission_may_be_in_an_archive(receipt, key, tmp_path):
    contents = receipts.verify_file(receipt, key.public_key())
    archive = tmp_path / "hw2.zip"
    for data, is_same in ((NOTEBOOK, True), (NOTEBOOK + b" ", False)):
        with zipfile.ZipFile(archive, "w") as file:
            file.writestr("hw2.ipynb", data)
        if is_same:
            receipts.verify_submission(contents, archive)
        else:
            with pytest.raises(receipts.ReceiptError, match="as it was submitted"):
                receipts.verify_submission(contents, archive)


@pytest.mark.parametrize("digest", ["", hashlib.sha256(b"").hexdigest()])
def test_a_receipt_without_a_submission_matches_no_file(key, tmp_path, digest):
    line = receipts.sign(make_result("t", versions={"hdrlab": "1"}, submission=digest), ["t"], key)
    empty = tmp_path / "empty.py"
    empty.touch()
    with pytest.raises(receipts.ReceiptError, match="could not read"):
        receipts.verify_submission([receipts.verify(line.encode(), key.public_key())], empty)


@pytest.mark.parametrize("fields", [{"tier": "practice"}, {"seed": ""}])
def test_a_score_for_practice_gets_no_receipt(key, fields):
    with pytest.raises(InputError, match="not for credit"):
        receipts.sign(make_result("t", **fields), ["t"], key)


def test_a_key_is_private_and_never_replaced(key, tmp_path):
    path = tmp_path / "key.pem"
    public = receipts.public_key_path(path)
    before = (path.read_bytes(), public.read_bytes())
    if os.name == "posix":
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
    public.unlink()
    again, is_new = receipts.read_private_key(path)
    assert not is_new and again.private_bytes_raw() == key.private_bytes_raw()
    assert (path.read_bytes(), public.read_bytes()) == before
    public.write_bytes(b"another key")
    with pytest.raises(InputError, match=r"key\.pem\.pub"):
        receipts.read_private_key(path)
    assert public.read_bytes() == b"another key"


@pytest.mark.parametrize("text", ["", "no key\n", None])
def test_a_file_that_is_no_key_of_this_kind_stays_as_it_is(key, tmp_path, text):
    public = tmp_path / "key.pem.pub"
    path = tmp_path / "wrong.pem"
    path.write_text(public.read_text() if text is None else text)
    before = path.read_bytes()
    with pytest.raises(FileFormatError, match=r"wrong\.pem: expected a private"):
        receipts.read_private_key(path)
    assert path.read_bytes() == before
    for wrong in (tmp_path / "key.pem", path):
        if wrong != path or text is not None:
            with pytest.raises(FileFormatError, match=f"{wrong.name}: expected a public"):
                receipts.read_public_key(wrong)


def test_one_command_verifies_a_receipt_and_its_submission(receipt, tmp_path, capsys):
    submission = tmp_path / "hw2.ipynb"
    submission.write_bytes(NOTEBOOK)
    words = ["receipt", receipt, "--key", tmp_path / "key.pem.pub", "--submission", submission]
    assert run(*words) in (None, 0)
    output = capsys.readouterr().out
    assert "hw2, b1, b2: 1 of 2 points" in output and "hw2.ipynb is the submission" in output
    receipt.write_bytes(receipt.read_bytes() * 2)
    assert run(*words) == 2
    assert "got 2" in capsys.readouterr().err
    receipt.write_bytes(receipt.read_bytes().replace(b"1.0", b"2.0"))
    assert run(*words) == 2
    output = capsys.readouterr()
    assert "receipt.txt, line 1: the receipt was changed" in output.err and not output.out


def test_only_scores_for_credit_can_be_signed_by_the_command(tmp_path, capsys):
    submission = tmp_path / "hw2.py"
    submission.write_text("pass\n")
    key = tmp_path / "new.pem"
    words = ["grade", submission, "--receipt-key", key, "-o", tmp_path / "out"]
    assert run(*words, "--tier", "practice") == 2
    message = capsys.readouterr().err
    assert all(name in message for name in ("--tier", "--secret-file", "--student"))
    assert not key.exists()


def test_without_cryptography_a_line_says_what_to_install(receipt, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(common, "find_spec", lambda name: None)
    assert run("receipt", receipt, "--key", tmp_path / "key.pem.pub") == 2
    assert 'missing cryptography; run: pip install "hdrlab[class]"' in capsys.readouterr().err


@pytest.mark.grading
def test_a_submission_graded_alone_gets_a_receipt(tmp_path, capsys):
    submission = tmp_path / "hw2.py"
    submission.write_text("def hat():\n    return 0\n")
    out = tmp_path / "out"
    words = ["grade", submission, "--student", "4711", "--secret-file", tmp_path / "secret.txt"]
    assert run(*words, "--receipt-key", tmp_path / "key.pem", "-o", out) in (None, 0)
    assert "do not lose or share this file" in capsys.readouterr().err
    line = (out / "receipt.txt").read_text()
    assert json.loads(line)["points"] == json.loads((out / "result.json").read_text())["score"]
    words = ["receipt", out / "receipt.txt", "--key", tmp_path / "key.pem.pub"]
    assert run(*words, "--submission", submission) in (None, 0)
    assert "hw2, 4711: " in capsys.readouterr().out
    assert line.strip() in html.unescape((out / "feedback.html").read_text())
