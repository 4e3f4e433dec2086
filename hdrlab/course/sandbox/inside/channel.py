"""Messages between the grader and a student's process: frames of plain values and arrays.

frame   4 bytes, the length of the header (big-endian); the header, as JSON; the raw bytes of its
        arrays, in order
header  {"kind": word, "call": number, "value": tree, "arrays": [label, ...]}
label   {"name": "0", "dtype": "float64", "shape": [2, 3], "bytes": 48}
tree    null, true, 7, 0.5, "text", [tree, ...], or one of {"tuple": [tree, ...]}, {"float": "nan"},
        {"dict": [[key, tree], ...]}, {"array": name}

Both ends read with this module, and neither trusts the other: sizes are checked before memory is
allocated, a dtype must be one of DTYPES, nothing is unpickled or evaluated, and every value that is
built is a plain number, text, bytes, list, tuple, dict or array. This file goes into the sandbox,
where hdrlab is not: it needs the standard library and numpy alone.
"""

import json
import math
import struct
import time
from collections import deque
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

HEADER_LENGTH_BYTES = 4
# enough for the source of a submission
MAX_HEADER_BYTES = 2**20
# numbers and texts outside of arrays, which each cost the reader more memory than one in an array
MAX_VALUES = 2**14
# all arrays of a frame: twenty photos of a megapixel in RGB
MAX_ARRAY_BYTES = 64 * 2**20
# of lists within lists
MAX_DEPTH = 16
MAX_DIMENSIONS = 8
# integers lie between -2**64 and 2**64
INTEGER_BOUND = 2**64
DTYPES = (
    "bool",
    "uint8",
    "uint16",
    "uint32",
    "uint64",
    "int8",
    "int16",
    "int32",
    "int64",
    "float32",
    "float64",
)
# what a label has in place of a dtype for a bytes object
BYTES = "bytes"
HEADER_FIELDS = {"kind", "call", "value", "arrays"}
LABEL_FIELDS = {"name", "dtype", "shape", "bytes"}
MAX_NAME_CHARACTERS = 80
MIN_SOCKET_TIMEOUT_SECONDS = 1e-3


class Connection(Protocol):
    """What this module needs of a socket."""

    def sendall(self, data: Any, /) -> None:
        """Send all bytes."""

    def recv_into(self, buffer: Any, /) -> int:
        """Receive bytes into a buffer, and return how many; 0 at the end."""

    def settimeout(self, seconds: float | None, /) -> None:
        """Set for how long `recv_into` may wait."""


class ProtocolError(ValueError):
    """Raised if what was received is not a valid frame."""


class UnsupportedValue(TypeError):
    """Raised if a value cannot be sent."""


@dataclass(frozen=True, kw_only=True)
class ArrayLabel:
    """What the header of a frame says about an array; dtype is BYTES for a bytes object."""

    dtype: str
    shape: tuple[int, ...]
    byte_count: int


def pack(value: Any, arrays: list[np.ndarray | bytes], depth: int = 0) -> Any:
    """Return a value as a tree, and append its arrays and bytes objects to a list.

    Parameters
    ----------
    value : object
        The value to send.
    arrays : list
        The arrays of the frame so far.
    depth : int
        How many lists, tuples and dicts the value lies in.

    Raises
    ------
    UnsupportedValue
        If the value contains something that cannot be sent.
    """
    if depth > MAX_DEPTH:
        raise UnsupportedValue(f"lists within lists, more than {MAX_DEPTH} deep")
    # str(), int() and float() also turn instances of subclasses into plain values
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, str):
        return str(value)
    if isinstance(value, bytes | bytearray | memoryview):
        arrays.append(bytes(value))
        return {"array": str(len(arrays) - 1)}
    if isinstance(value, np.ndarray | np.generic):
        arrays.append(_as_plain_array(np.asarray(value)))
        return {"array": str(len(arrays) - 1)}
    if isinstance(value, int):
        if not -INTEGER_BOUND < value < INTEGER_BOUND:
            raise UnsupportedValue("an integer of more than 64 bits")
        return int(value)
    if isinstance(value, float):
        # JSON has no NaN and no infinity
        return float(value) if math.isfinite(value) else {"float": repr(float(value))}
    if isinstance(value, dict):
        if not all(isinstance(key, str | int) for key in value):
            raise UnsupportedValue("a dict with a key that is neither text nor integer")
        entries = []
        for key, item in value.items():
            packed_key = pack(key, arrays, depth + 1)
            entries.append([packed_key, pack(item, arrays, depth + 1)])
        return {"dict": entries}
    if isinstance(value, list):
        return [pack(item, arrays, depth + 1) for item in value]
    if isinstance(value, tuple):
        return {"tuple": [pack(item, arrays, depth + 1) for item in value]}
    raise UnsupportedValue(f"an object of the class {type(value).__name__[:MAX_NAME_CHARACTERS]}")


def _as_plain_array(array: np.ndarray) -> np.ndarray:
    """Return a contiguous, little-endian array of one of DTYPES, or raise UnsupportedValue."""
    if array.dtype.name not in DTYPES:
        dtype = array.dtype.name[:MAX_NAME_CHARACTERS]
        raise UnsupportedValue(f"an array of dtype {dtype}, expected one of {', '.join(DTYPES)}")
    if array.ndim > MAX_DIMENSIONS:
        raise UnsupportedValue(
            f"an array of {array.ndim} dimensions, expected at most {MAX_DIMENSIONS}"
        )
    # checked before the copy: a broadcast array may be large and take little memory
    if array.nbytes > MAX_ARRAY_BYTES:
        raise UnsupportedValue(
            f"an array of {array.nbytes} bytes, expected at most {MAX_ARRAY_BYTES}"
        )
    return np.array(array, dtype=array.dtype.newbyteorder("<"), order="C", copy=None)


def _has_too_many_values(tree: Any) -> bool:
    """Return whether a tree has more than MAX_VALUES values outside of arrays."""
    waiting = [tree]
    value_count = 0
    while waiting and value_count <= MAX_VALUES:
        branch = waiting.pop()
        if isinstance(branch, dict):
            if "array" not in branch:
                waiting += branch.values()
        elif isinstance(branch, list):
            waiting += branch
        else:
            value_count += 1
    return value_count > MAX_VALUES


def _make_label(index: int, array: np.ndarray | bytes) -> dict[str, Any]:
    """Return what the header says about an array or a bytes object."""
    if isinstance(array, bytes):
        dtype = BYTES
        shape = [len(array)]
        byte_count = len(array)
    else:
        dtype = array.dtype.name
        shape = list(array.shape)
        byte_count = array.nbytes
    return {"name": str(index), "dtype": dtype, "shape": shape, "bytes": byte_count}


def send(to: Connection, kind: str, value: Any = None, call: int = 0) -> None:
    """Send a frame.

    Parameters
    ----------
    to : socket
        The other end of the channel.
    kind : str
        What the message is.
    value : object
        Its content.
    call : int
        The number of the call, or of the check, that it belongs to.

    Raises
    ------
    UnsupportedValue
        If the value cannot be sent; then nothing is sent.
    """
    arrays: list[np.ndarray | bytes] = []
    tree = pack(value, arrays)
    if _has_too_many_values(tree):
        raise UnsupportedValue(f"more than {MAX_VALUES} values outside of arrays")
    labels = [_make_label(index, array) for index, array in enumerate(arrays)]
    fields = {"kind": kind, "call": call, "value": tree, "arrays": labels}
    header = json.dumps(fields, allow_nan=False).encode()
    if len(header) > MAX_HEADER_BYTES:
        raise UnsupportedValue(
            f"{len(header)} bytes of values outside of arrays, expected at most {MAX_HEADER_BYTES}"
        )
    if sum(label["bytes"] for label in labels) > MAX_ARRAY_BYTES:
        raise UnsupportedValue(f"arrays of more than {MAX_ARRAY_BYTES} bytes in all")
    to.sendall(struct.pack(">I", len(header)) + header)
    for array in arrays:
        # reshape, because an array without dimensions has no view of bytes
        raw = array if isinstance(array, bytes) else array.reshape(-1).view(np.uint8).data
        if len(raw) > 0:
            to.sendall(raw)


def receive(source: Connection, deadline: float | None = None) -> tuple[str, int, Any]:
    """Receive a frame, and return its kind, its call number and its value.

    Parameters
    ----------
    source : socket
        The other end of the channel.
    deadline : float, optional
        When the whole frame must have arrived, in the time of time.monotonic().

    Raises
    ------
    EOFError
        If the other end has closed the channel before a frame.
    TimeoutError
        If the deadline passes.
    ProtocolError
        If what came is not a frame, or it is cut short.
    """
    length_bytes = _receive_bytes(source, HEADER_LENGTH_BYTES, deadline, is_start_of_frame=True)
    (header_size,) = struct.unpack(">I", length_bytes)
    if header_size > MAX_HEADER_BYTES:
        raise ProtocolError(
            f"a header that claims {header_size} bytes, more than {MAX_HEADER_BYTES}"
        )
    header = _parse_header(bytes(_receive_bytes(source, header_size, deadline)))
    labels = [_parse_label(label, index) for index, label in enumerate(header["arrays"])]
    if sum(label.byte_count for label in labels) > MAX_ARRAY_BYTES:
        raise ProtocolError(f"arrays that claim more than {MAX_ARRAY_BYTES} bytes in all")
    arrays: deque[tuple[str, Any]] = deque()
    for index, label in enumerate(labels):
        data = _receive_bytes(source, label.byte_count, deadline)
        arrays.append((str(index), _build_array(label, data)))
    if _has_too_many_values(header["value"]):
        raise ProtocolError(f"more than {MAX_VALUES} values outside of arrays")
    return header["kind"], header["call"], _unpack(header["value"], arrays)


def _receive_bytes(
    source: Connection, size: int, deadline: float | None, is_start_of_frame: bool = False
) -> bytearray:
    """Return the next `size` bytes."""
    data = bytearray(size)
    view = memoryview(data)
    received = 0
    while received < size:
        if deadline is not None:
            time_left = deadline - time.monotonic()
            source.settimeout(max(time_left, MIN_SOCKET_TIMEOUT_SECONDS))
        count = source.recv_into(view[received:])
        if count == 0:
            if is_start_of_frame and received == 0:
                raise EOFError("the other end has closed")
            raise ProtocolError("a frame that is cut short")
        received += count
        # the timeout of the socket does not stop a sender of one byte at a time
        if deadline is not None and time.monotonic() > deadline:
            raise TimeoutError
    return data


def _parse_header(header: bytes) -> dict[str, Any]:
    """Return the header as a dict with fields of the right types, or raise ProtocolError."""
    try:
        fields = json.loads(header.decode(), parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise ProtocolError("a header that is no JSON") from error
    if not isinstance(fields, dict) or set(fields) != HEADER_FIELDS:
        raise ProtocolError("a header without its four fields")
    # type() and not isinstance(), because True is an int
    types_are_right = (
        type(fields["kind"]) is str
        and type(fields["call"]) is int
        and type(fields["arrays"]) is list
    )
    if not types_are_right:
        raise ProtocolError("a header whose fields are of other types")
    return fields


def _refuse_constant(word: str) -> Any:
    """Refuse NaN and the infinities, which Python's json would accept."""
    raise ValueError(f"{word} is no JSON")


def _parse_label(label: Any, index: int) -> ArrayLabel:
    """Return the label of an array if its fields agree with each other, or raise ProtocolError."""
    if not isinstance(label, dict) or set(label) != LABEL_FIELDS:
        raise ProtocolError("an array without name, dtype, shape and bytes")
    dtype = label["dtype"]
    shape = label["shape"]
    byte_count = label["bytes"]
    if label["name"] != str(index) or dtype not in (*DTYPES, BYTES) or type(byte_count) is not int:
        raise ProtocolError("an array of another name or dtype")
    if type(shape) is not list or len(shape) > MAX_DIMENSIONS:
        raise ProtocolError("an array without a shape")
    if not all(type(length) is int and 0 <= length <= MAX_ARRAY_BYTES for length in shape):
        raise ProtocolError("an array of an absurd shape")
    item_bytes = 1 if dtype == BYTES else np.dtype(dtype).itemsize
    if math.prod(shape) * item_bytes != byte_count:
        raise ProtocolError("an array whose bytes do not fill its shape")
    return ArrayLabel(dtype=dtype, shape=tuple(shape), byte_count=byte_count)


def _build_array(label: ArrayLabel, data: bytearray) -> Any:
    """Return a plain array over the data, a numpy scalar if it has no dimensions, or bytes."""
    if label.dtype == BYTES:
        return bytes(data)
    if label.dtype == "bool":
        # any byte but 0 and 1 would make a boolean that is neither True nor False
        array = np.frombuffer(data, np.uint8) != 0
    else:
        little_endian = np.dtype(label.dtype).newbyteorder("<")
        array = np.frombuffer(data, little_endian).astype(label.dtype, copy=False)
    # [()] turns an array without dimensions into a scalar
    return array.reshape(label.shape)[()]


def _unpack(tree: Any, arrays: deque[tuple[str, Any]], depth: int = 0) -> Any:
    """Return the value that a tree stands for, or raise ProtocolError.

    Each array is used once, in order. If a list could contain the same array a thousand times, a
    small frame would become a huge array where the list is turned into one.

    Parameters
    ----------
    tree : object
        The tree, as JSON gives it.
    arrays : deque
        The arrays that were not used yet, with their names.
    depth : int
        How many branches the tree lies in.
    """
    if depth > MAX_DEPTH:
        raise ProtocolError(f"a tree that is more than {MAX_DEPTH} deep")
    if tree is None or isinstance(tree, bool | str | float):
        return tree
    if isinstance(tree, int) and -INTEGER_BOUND < tree < INTEGER_BOUND:
        return tree
    if isinstance(tree, list):
        return [_unpack(item, arrays, depth + 1) for item in tree]
    if isinstance(tree, dict) and len(tree) == 1:
        match tree:
            case {"tuple": list(items)}:
                return tuple(_unpack(item, arrays, depth + 1) for item in items)
            case {"dict": list(entries)}:
                return dict(_unpack_entry(entry, arrays, depth) for entry in entries)
            case {"float": "nan" | "inf" | "-inf" as word}:
                return float(word)
            case {"array": str(name)} if arrays and arrays[0][0] == name:
                return arrays.popleft()[1]
    raise ProtocolError("a tree with a branch of no kind")


def _unpack_entry(entry: Any, arrays: deque[tuple[str, Any]], depth: int) -> tuple[Any, Any]:
    """Return the key and the value of a dict's entry, or raise ProtocolError."""
    if not (isinstance(entry, list) and len(entry) == 2 and isinstance(entry[0], str | int)):
        raise ProtocolError("a dict with a key that is neither text nor integer")
    key, value = entry
    return key, _unpack(value, arrays, depth + 1)
