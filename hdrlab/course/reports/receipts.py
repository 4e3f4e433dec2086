"""Sign receipts for the points of submissions, and verify them.

A receipt is one line of JSON: homework, team, students, points, and digests of the submission, of
the checks and of the inputs. It ends with the id of the instructor's key and an Ed25519 signature
(RFC 8032) of everything before the signature. Whoever has the public key can verify it, without the
course's secret, without the network, and also with OpenSSL. A receipt has no time, so the same
result and key always give the same bytes.
"""

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import (
    Ed25519PrivateKey,
    Ed25519PublicKey,
)

from hdrlab.course.grading import results
from hdrlab.course.grading.results import Result
from hdrlab.course.submissions import reader
from hdrlab.errors import FileFormatError, InputError
from hdrlab.io.files import write
from hdrlab.io.temporary import move_new, temporary_folder

SigningKey = Ed25519PrivateKey
VERSION = 1
KEY_ID_LENGTH = 16  # hexadecimal digits
# digests of submissions that could not be read, or had no bytes
UNREAD_DIGESTS = ("", hashlib.sha256(b"").hexdigest())
# The signed text is the JSON object without its last entry, the signature.
RECEIPT = re.compile(
    rb'(?P<unclosed>\{.*"key": "(?P<key>[0-9a-f]{16})"), "signature": "(?P<signature>[0-9a-f]{128})"\}'
)


class ReceiptError(InputError):
    """A receipt was changed, or was not signed with this key."""


def public_key_path(path: Path) -> Path:
    """Return the file of the public key that belongs to the file of a private key."""
    return path.with_name(f"{path.name}.pub")


def read_private_key(path: Path) -> tuple[SigningKey, bool]:
    """Return the key that signs receipts, and whether this call created it.

    If the file does not exist, a new key is written, which only its owner can read. The public key
    is written beside it. No file is ever overwritten.

    Raises
    ------
    FileFormatError
        If the file holds no private Ed25519 key in PEM, or a key with a password.
    InputError
        If the file beside it holds another public key.
    """
    is_new = not path.exists()
    if is_new:
        with temporary_folder(path.parent, target=path) as folder:
            unfinished = folder / "key"
            unfinished.touch(mode=0o600)
            unfinished.write_bytes(_private_pem(Ed25519PrivateKey.generate()))
            move_new(unfinished, path)
    try:
        key = serialization.load_pem_private_key(path.read_bytes(), password=None)
    except (ValueError, TypeError, UnsupportedAlgorithm):
        key = None
    if not isinstance(key, Ed25519PrivateKey):
        raise FileFormatError(
            f"{path}: expected a private Ed25519 key in PEM without a password; pass the name of a "
            "file that does not exist, and hdrlab creates a key"
        )
    public_path = public_key_path(path)
    public_pem = _public_pem(key.public_key())
    if not public_path.exists():
        write(public_path, public_pem)
    elif public_path.read_bytes() != public_pem:
        raise InputError(
            f"{public_path}: this is not the public key of {path}; move it to another folder"
        )
    return key, is_new


def read_public_key(path: Path) -> Ed25519PublicKey:
    """Return the key that verifies receipts.

    Raises
    ------
    FileFormatError
        If the file holds no public Ed25519 key in PEM.
    """
    try:
        key = serialization.load_pem_public_key(path.read_bytes())
    except (ValueError, UnsupportedAlgorithm):
        key = None
    if not isinstance(key, Ed25519PublicKey):
        raise FileFormatError(
            f"{path}: expected a public Ed25519 key in PEM, such as the file that ends in .pub "
            "beside the key of `hdrlab grade --receipt-key`"
        )
    return key


def _private_pem(key: SigningKey) -> bytes:
    return key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )


def _public_pem(key: Ed25519PublicKey) -> bytes:
    return key.public_bytes(
        serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo
    )


def key_id(key: Ed25519PublicKey) -> str:
    """Return the id by which receipts name a key: the first digits of its SHA-256."""
    return hashlib.sha256(key.public_bytes_raw()).hexdigest()[:KEY_ID_LENGTH]


def sign(result: Result, students: Sequence[str], key: SigningKey) -> str:
    r"""Return the receipt for a result: a line of ASCII without its line break.

    Parameters
    ----------
    result : the result of a submission
    students : the ids of its students
    key : the instructor's private key

    Raises
    ------
    InputError
        If the score is not for credit.

    Examples
    --------
    >>> result = Result("t", "hw2", "", "strict", (), {}, (), "", "", "seed", {"hdrlab": "1"})
    >>> key = Ed25519PrivateKey.generate()
    >>> line = sign(result, ["b1", "b2"], key)
    >>> verify(line.encode(), key.public_key())["students"]
    ['b1', 'b2']
    """
    if not result.for_credit:
        raise InputError(f"no receipt for {result.student or 'a student'}: {result.why_practice}")
    content: dict[str, Any] = {
        "receipt": VERSION,
        "homework": result.homework,
        "team": result.student,
        "students": list(students),
        "points": result.score,
        "of": result.max_score,
        "tasks": {task: results.points(result.of(task)) for task in result.tasks},
        "submission": result.submission,
        "checks": result.specification,
        "inputs": result.seed,
        "tier": result.tier,
        "hdrlab": result.versions["hdrlab"],
        "key": key_id(key.public_key()),
    }
    signed = json.dumps(content)
    signature = key.sign(signed.encode()).hex()
    return f'{signed[:-1]}, "signature": "{signature}"}}'


def verify(line: bytes, key: Ed25519PublicKey) -> dict[str, Any]:
    """Return what a receipt says, if it is exactly the line that the owner of the key signed.

    Raises
    ------
    ReceiptError
        If any byte of the receipt was changed, or if another key signed it.
    """
    match = RECEIPT.fullmatch(line)
    if match is None:
        raise ReceiptError(
            'this is not a receipt, or it was changed: expected one line from {"receipt" to the '
            "128 digits of its signature"
        )
    named_key = match["key"].decode()
    if named_key != key_id(key):
        raise ReceiptError(
            f"the receipt names the key {named_key}, but this is the key {key_id(key)}: another "
            "key signed it, or it was changed"
        )
    signed = match["unclosed"] + b"}"
    try:
        key.verify(bytes.fromhex(match["signature"].decode()), signed)
    except InvalidSignature:
        raise ReceiptError("the receipt was changed: its signature does not match") from None
    content: dict[str, Any] = json.loads(signed)
    if content["receipt"] != VERSION:
        raise ReceiptError(
            f"expected a receipt of version {VERSION}, got {content['receipt']!r:.20}; "
            "use a newer version of hdrlab"
        )
    return content


def verify_file(path: Path, key: Ed25519PublicKey) -> list[dict[str, Any]]:
    """Return what each receipt of a file says; a file has one receipt in each line.

    Raises
    ------
    ReceiptError
        At the first line that is not a receipt of this key; the message has its number.
    """
    lines = path.read_bytes().replace(b"\r\n", b"\n").removesuffix(b"\n").split(b"\n")
    contents = []
    for number, line in enumerate(lines, 1):
        try:
            contents.append(verify(line, key))
        except ReceiptError as error:
            raise ReceiptError(f"{path}, line {number}: {error}") from None
    return contents


def verify_submission(contents: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Verify that a file is the submission of a receipt, byte for byte.

    Of an archive, the notebook or Python file in it is the submission.

    Parameters
    ----------
    contents : what `verify_file` returned
    path : the submitted file

    Raises
    ------
    ReceiptError
        If the receipt is for another file, or hdrlab could not read the submission when it was
        graded.
    InputError
        If there are several receipts.
    """
    if len(contents) != 1:
        raise InputError(
            f"expected one receipt for {path.name}, got {len(contents)}; "
            "pass a file with the line of this submission only"
        )
    digest = contents[0]["submission"]
    if digest in UNREAD_DIGESTS:
        raise ReceiptError(
            "the receipt names no submission: hdrlab could not read the submitted file"
        )
    if _submission_digest(path, contents[0]["homework"]) != digest:
        raise ReceiptError(
            f"{path}: this is not the file of the receipt; pass the file as it was submitted, "
            "because a program that opens and saves a notebook changes it"
        )


def _submission_digest(path: Path, homework: str) -> str:
    """Return the digest of a submission, as its result has it."""
    if path.suffix.lower() in reader.ARCHIVE_SUFFIXES:
        return reader.read(path, homework, ()).hash
    return hashlib.sha256(path.read_bytes()).hexdigest()
