"""What passes between the grader and a student's process: frames of plain values and arrays.

frame   4 bytes, the header's length (big-endian); the header, JSON; its arrays' raw bytes, in order
header  {"kind": word, "call": number, "value": tree, "arrays": [{"name", "dtype", "shape", "bytes"}, ...]}
tree    null, true, 7, 0.5, "text", [tree, ...], or one of {"tuple": [tree, ...]}, {"float": "nan"},
        {"dict": [[key, tree], ...]}, {"array": name}

Both ends read with this module, and neither believes the other: sizes are capped before anything is
allocated, a dtype comes from a short list, nothing is unpickled or evaluated, and what is built is
a plain number, text, bytes, list, tuple, dict or array. It needs numpy alone: it goes into the
sandbox, where hdrlab is not.
"""

import json
import math
import socket
import struct
import time
from collections import deque
from typing import Any

import numpy as np

HEADER = 1 << 20  # bytes of a header: the text of a submission passes
VALUES = (
    1 << 14
)  # numbers and texts outside of arrays: each costs the reader more than one in an array
BODY = 1 << 26  # bytes of all arrays of a frame, 64 MiB: twenty photographs of a megapixel in RGB
DEPTH = 16  # lists in lists
DIMENSIONS = 8
WHOLE = 1 << 64  # integers lie within
DTYPES = (
    *("bool", "uint8", "uint16", "uint32", "uint64", "int8", "int16", "int32", "int64"),
    *("float32", "float64"),
)
BYTES = "bytes"  # the one other kind of raw bytes


class ProtocolError(ValueError):
    """A frame that is none."""


class UnsupportedValue(TypeError):
    """A value that does not travel."""


def pack(value: Any, arrays: list[np.ndarray | bytes], depth: int = 0) -> Any:
    """Return `value` as a tree, and append its arrays and bytes to `arrays`.

    Raises UnsupportedValue for a value that cannot be sent.
    """
    if depth > DEPTH:
        raise UnsupportedValue(f"lists within lists, more than {DEPTH} deep")
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, str):
        return str(value)
    if isinstance(value, bytes | bytearray | memoryview):
        arrays.append(bytes(value))
        return {"array": str(len(arrays) - 1)}
    if isinstance(value, np.ndarray | np.generic):
        arrays.append(_plain(np.asarray(value)))
        return {"array": str(len(arrays) - 1)}
    if isinstance(value, int):
        if not -WHOLE < value < WHOLE:
            raise UnsupportedValue("an integer of more than 64 bits")
        return int(value)
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else {"float": repr(float(value))}
    if isinstance(value, dict):
        if not all(isinstance(key, str | int) for key in value):
            raise UnsupportedValue("a dict with a key that is neither text nor integer")
        return {"dict": [[pack(one, arrays, depth + 1) for one in pair] for pair in value.items()]}
    if isinstance(value, list | tuple):
        items = [pack(one, arrays, depth + 1) for one in value]
        return items if isinstance(value, list) else {"tuple": items}
    raise UnsupportedValue(f"an object of the class {type(value).__name__[:80]}")


def _plain(array: np.ndarray) -> np.ndarray:
    """Return an array of a dtype from the list, contiguous and little-endian, or raise UnsupportedValue."""
    if array.dtype.name not in DTYPES:
        raise UnsupportedValue(
            f"an array of dtype {array.dtype.name[:80]}, and not of {', '.join(DTYPES)}"
        )
    if array.ndim > DIMENSIONS:
        raise UnsupportedValue(
            f"an array of {array.ndim} dimensions, and not of {DIMENSIONS} at most"
        )
    if array.nbytes > BODY:  # before it is copied: a broadcast array claims much and holds little
        raise UnsupportedValue(f"an array of {array.nbytes} bytes, and not of {BODY} at most")
    return np.array(array, dtype=array.dtype.newbyteorder("<"), order="C", copy=None)


def _is_large(tree: Any) -> bool:
    """Return whether a tree has more values outside of arrays than VALUES."""
    waiting, count = [tree], 0
    while waiting and count <= VALUES:
        one = waiting.pop()
        if isinstance(one, dict):
            waiting += [] if "array" in one else one.values()
        elif isinstance(one, list):
            waiting += one
        else:
            count += 1
    return count > VALUES


def _label(name: int, array: np.ndarray | bytes) -> dict[str, Any]:
    """Return what the header says of the raw bytes that follow it."""
    if isinstance(array, bytes):
        return {"name": str(name), "dtype": BYTES, "shape": [len(array)], "bytes": len(array)}
    shape = list(array.shape)
    return {"name": str(name), "dtype": array.dtype.name, "shape": shape, "bytes": array.nbytes}


def send(to: socket.socket, kind: str, value: Any = None, call: int = 0) -> None:
    """Send one frame; UnsupportedValue, and nothing sent, where the value does not travel."""
    arrays: list[np.ndarray | bytes] = []
    tree = pack(value, arrays)
    if _is_large(tree):
        raise UnsupportedValue(f"more than {VALUES} values outside of arrays")
    labels = [_label(j, array) for j, array in enumerate(arrays)]
    whole = {"kind": kind, "call": call, "value": tree, "arrays": labels}
    header = json.dumps(whole, allow_nan=False).encode()
    if len(header) > HEADER:
        raise UnsupportedValue(
            f"{len(header)} bytes of values outside of arrays, and not {HEADER} at most"
        )
    if sum(label["bytes"] for label in labels) > BODY:
        raise UnsupportedValue(f"arrays of more than {BODY} bytes in all")
    to.sendall(struct.pack(">I", len(header)) + header)
    for array in arrays:
        raw = array if isinstance(array, bytes) else array.reshape(-1).view(np.uint8).data
        if len(raw):
            to.sendall(raw)


def receive(source: socket.socket, deadline: float | None = None) -> tuple[str, int, Any]:
    """Return (kind, call, value) of the next frame, which is whole before `deadline` in time.monotonic().

    Raises
    ------
    EOFError
        Where the other end has closed.
    TimeoutError
        Where the deadline passes.
    ProtocolError
        Where what came is no frame, or is cut short.
    """
    (size,) = struct.unpack(">I", _exactly(source, 4, deadline, first=True))
    if size > HEADER:
        raise ProtocolError(f"a header that claims {size} bytes, more than {HEADER}")
    head = _parse(bytes(_exactly(source, size, deadline)))
    labels = [_check_label(label, j) for j, label in enumerate(head["arrays"])]
    if sum(nbytes for *_, nbytes in labels) > BODY:
        raise ProtocolError(f"arrays that claim more than {BODY} bytes in all")
    arrays = [_build(dtype, shape, _exactly(source, n, deadline)) for dtype, shape, n in labels]
    if _is_large(head["value"]):
        raise ProtocolError(f"more than {VALUES} values outside of arrays")
    waiting = deque((str(j), array) for j, array in enumerate(arrays))
    return head["kind"], head["call"], _unpack(head["value"], waiting)


def _exactly(
    source: socket.socket, size: int, deadline: float | None, first: bool = False
) -> bytearray:
    """Return the next `size` bytes."""
    data = bytearray(size)
    view, got = memoryview(data), 0
    while got < size:
        if deadline is not None:
            source.settimeout(max(deadline - time.monotonic(), 1e-3))
        came = source.recv_into(view[got:])
        if came == 0 and (got or not first):
            raise ProtocolError("a frame that is cut short")
        if came == 0:
            raise EOFError("the other end has closed")
        got += came
        if deadline is not None and time.monotonic() > deadline:  # it may drip, a byte at a time
            raise TimeoutError
    return data


def _parse(header: bytes) -> dict[str, Any]:
    """Return the header, or raise ProtocolError where it is no JSON object with the four fields."""
    try:
        head = json.loads(header.decode(), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise ProtocolError("a header that is no JSON") from error
    if not isinstance(head, dict) or set(head) != {"kind", "call", "value", "arrays"}:
        raise ProtocolError("a header without its four fields")
    if not (
        type(head["kind"]) is str and type(head["call"]) is int and type(head["arrays"]) is list
    ):
        raise ProtocolError("a header whose fields are of other types")
    return head


def _no_constant(word: str) -> Any:
    raise ValueError(f"{word} is no JSON")


def _check_label(label: Any, j: int) -> tuple[str, tuple[int, ...], int]:
    """Return (dtype, shape, bytes) of the j-th array, which agree with each other, or raise ProtocolError."""
    if not isinstance(label, dict) or set(label) != {"name", "dtype", "shape", "bytes"}:
        raise ProtocolError("an array without name, dtype, shape and bytes")
    dtype, shape, nbytes = label["dtype"], label["shape"], label["bytes"]
    if label["name"] != str(j) or dtype not in (*DTYPES, BYTES) or type(nbytes) is not int:
        raise ProtocolError("an array of another name or dtype")
    if type(shape) is not list or len(shape) > DIMENSIONS:
        raise ProtocolError("an array without a shape")
    if not all(type(n) is int and 0 <= n <= BODY for n in shape):
        raise ProtocolError("an array of an absurd shape")
    if math.prod(shape) * (1 if dtype == BYTES else np.dtype(dtype).itemsize) != nbytes:
        raise ProtocolError("an array whose bytes do not fill its shape")
    return dtype, tuple(shape), nbytes


def _build(dtype: str, shape: tuple[int, ...], data: bytearray) -> Any:
    """Return a plain array over `data`, a numpy scalar for the shape (), or bytes."""
    if dtype == BYTES:
        return bytes(data)
    if dtype == "bool":  # any byte but 0 and 1 would be a boolean that is neither
        return (np.frombuffer(data, np.uint8).reshape(shape) != 0)[()]
    little = np.dtype(dtype).newbyteorder("<")
    return np.frombuffer(data, little).reshape(shape).astype(dtype, copy=False)[()]


def _unpack(tree: Any, arrays: deque[tuple[str, Any]], depth: int = 0) -> Any:
    """Return the value that a tree stands for, or raise ProtocolError; each array is used once, in order.

    One that stood in a list a thousand times would be small here, and huge where the list becomes
    an array.
    """
    if depth > DEPTH:
        raise ProtocolError(f"a tree that is more than {DEPTH} deep")
    if tree is None or isinstance(tree, bool | str | float):
        return tree
    if isinstance(tree, int) and -WHOLE < tree < WHOLE:
        return tree
    if isinstance(tree, list):
        return [_unpack(one, arrays, depth + 1) for one in tree]
    match tree:
        case {"tuple": list(items), **rest} if not rest:
            return tuple(_unpack(one, arrays, depth + 1) for one in items)
        case {"dict": list(pairs), **rest} if not rest:
            return dict(_pair(pair, arrays, depth) for pair in pairs)
        case {"float": "nan" | "inf" | "-inf" as word, **rest} if not rest:
            return float(word)
        case {"array": str(name), **rest} if not rest and arrays and arrays[0][0] == name:
            return arrays.popleft()[1]
    raise ProtocolError("a tree with a branch of no kind")


def _pair(pair: Any, arrays: deque[tuple[str, Any]], depth: int) -> tuple[Any, Any]:
    """Return the key, a text or an integer, and the value of an entry of a dict."""
    if not (isinstance(pair, list) and len(pair) == 2 and isinstance(pair[0], str | int)):
        raise ProtocolError("a dict with a key that is neither text nor integer")
    return pair[0], _unpack(pair[1], arrays, depth + 1)
