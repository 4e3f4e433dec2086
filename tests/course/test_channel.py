"""The channel between grader and student's process: round trips, and early refusal of wrong messages."""

import json
import socket
import struct
import threading
import time

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as arrays

from hdrlab.course.sandbox.inside import channel

PLAIN = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**64 - 1)
    | st.floats()
    | st.text(max_size=9)
    | st.binary(),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.lists(inner, max_size=3).map(tuple)
        | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=8,
)
ARRAYS = st.sampled_from(channel.DTYPES).flatmap(
    lambda dtype: arrays.arrays(
        dtype, arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=4)
    )
)


@pytest.fixture
def pair():
    """The two ends of a channel."""
    ours, theirs = socket.socketpair()
    with ours, theirs:
        yield ours, theirs


def passed(value):
    """Send a value through a channel and return what arrives."""
    ours, theirs = socket.socketpair()
    with ours, theirs:
        channel.send(ours, "word", value, 7)
        kind, call, received = channel.receive(theirs, time.monotonic() + 10)
    assert (kind, call) == ("word", 7)
    return received


@pytest.mark.grading
@given(PLAIN)
def test_plain_values_survive_the_channel(value):
    assert repr(passed(value)) == repr(value)


@given(ARRAYS)
def test_arrays_keep_dtype_shape_and_bits(array):
    received = passed({"array": [array]})["array"][0]
    assert received.dtype == array.dtype and received.shape == array.shape
    assert received.tobytes() == array.tobytes()


def test_arrays_of_any_memory_layout_survive_the_channel():
    x = np.arange(24.0).reshape(4, 6)
    for array in (
        x[::-1, ::-2],
        x.T,
        np.asfortranarray(x),
        np.broadcast_to(x[0], (3, 6)),
        x.astype(">f8"),
    ):
        np.testing.assert_array_equal(passed(array), array)
        assert passed(array).flags.writeable and passed(array).flags.c_contiguous


def test_an_array_subclass_arrives_as_a_plain_array():
    assert type(passed(np.ma.masked_array([1.0, 2.0]))) is np.ndarray


def test_an_array_larger_than_the_socket_buffer_arrives(pair):
    ours, theirs = pair
    array = np.random.default_rng(0).random(1 << 20)
    sender = threading.Thread(target=channel.send, args=(ours, "word", array))
    sender.start()
    _, _, received = channel.receive(theirs, time.monotonic() + 30)
    sender.join()
    np.testing.assert_array_equal(received, array)


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (object(), "class object"),
        (len, "class builtin_function_or_method"),
        (1j, "class complex"),
        (np.zeros(3, complex), "dtype complex128"),
        (np.array([None]), "dtype object"),
        (np.zeros(2, "f8,f8"), "dtype void"),
        (np.array(["a"]), "dtype str"),
        (np.zeros(2, np.float16), "dtype float16"),
        (np.broadcast_to(0.0, (10**6, 10**6)), "8000000000000 bytes"),
        ([np.zeros(1 << 22)] * 3, "in all"),
        (np.zeros((1,) * 9), "9 dimensions"),
        (1 << 64, "64 bits"),
        (list(range(400_000)), "outside of arrays"),
        ({(1, 2): 3}, "key"),
    ],
)
def test_an_unsupported_value_is_refused_before_any_byte_is_sent(pair, value, reason):
    ours, theirs = pair
    with pytest.raises(channel.UnsupportedValue, match=reason):
        channel.send(ours, "word", value)
    theirs.setblocking(False)
    with pytest.raises(BlockingIOError):
        theirs.recv(1)


def nested(depth):
    """Return lists within lists."""
    value = []
    for _ in range(depth):
        value = [value]
    return value


def test_lists_nested_too_deeply_are_refused():
    assert passed(nested(10)) == nested(10)
    with pytest.raises(channel.UnsupportedValue, match="deep"):
        passed(nested(40))


def frame(value=None, arrays=(), body=b"", **changed):
    """Return the bytes of a frame."""
    head = {"kind": "answer", "call": 7, "value": value, "arrays": list(arrays)} | changed
    text = json.dumps(head).encode()
    return struct.pack(">I", len(text)) + text + body


def label(name="0", dtype="float64", shape=(2,), nbytes=16):
    """Return the header of an array in a message."""
    return {"name": name, "dtype": dtype, "shape": list(shape), "bytes": nbytes}


ONE = {"array": "0"}
LIES = {
    "a header of four gigabytes": b"\xff\xff\xff\xff",
    "a header that is no JSON": struct.pack(">I", 4) + b"{'a'",
    "bytes that are no text": struct.pack(">I", 2) + b"\xff\xfe",
    "a list for a header": struct.pack(">I", 2) + b"[]",
    "NaN in JSON": struct.pack(">I", 53) + b'{"kind": "a", "call": 1, "value": NaN, "arrays": [] }',
    "brackets without end": struct.pack(">I", 100_000) + b"[" * 100_000,
    "digits without end": frame(value=0).replace(b'"value": 0', b'"value": ' + b"9" * 6000),
    "a field more": frame(pickle="gASV"),
    "a kind that is no word": frame(kind=3),
    "a call that is no number": frame(call="7"),
    "a branch of no kind": frame({"pickle": "gASV"}),
    "two branches": frame({"array": "0", "tuple": []}, [label()], bytes(16)),
    "a float of another word": frame({"float": "1e999"}),
    "a key that is a list": frame({"dict": [[[], 1]]}),
    "an integer of many bits": frame(1 << 70),
    "a tree too deep": frame(nested(40)),
    "an array that is not there": frame(ONE),
    "an array used twice": frame([ONE, ONE], [label()], bytes(16)),
    "an array of objects": frame(ONE, [label(dtype="object")], bytes(16)),
    "a dtype with fields": frame(ONE, [label(dtype="f8,O")], bytes(16)),
    "a dtype that is a list": frame(ONE, [label(dtype=["f8"])], bytes(16)),
    "a shape below nought": frame(ONE, [label(shape=(-2, -1))], bytes(16)),
    "a shape of floats": frame(ONE, [label(shape=(2.0,))], bytes(16)),
    "a shape of truths": frame(ONE, [label(shape=(True, 2))], bytes(16)),
    "a shape of many axes": frame(ONE, [label(shape=(1,) * 40 + (2,))], bytes(16)),
    "bytes that do not fill it": frame(ONE, [label(nbytes=8)], bytes(8)),
    "bytes below nought": frame(ONE, [label(nbytes=-16)], bytes(16)),
    "an exabyte": frame(ONE, [label(shape=(1 << 57,), nbytes=1 << 60)]),
    "too much in all": frame(
        ONE, [label(str(j), shape=(1 << 22,), nbytes=1 << 25) for j in range(3)]
    ),
    "another name": frame({"array": "x"}, [label("x")], bytes(16)),
    "a name of digits without end": frame({"array": "1" * 5000}, [label()], bytes(16)),
}


@pytest.mark.parametrize("lie", LIES)
def test_a_frame_with_a_false_header_is_refused(pair, lie):
    ours, theirs = pair
    sender = threading.Thread(
        target=lambda: (ours.sendall(LIES[lie]), ours.shutdown(socket.SHUT_WR))
    )
    sender.start()
    with pytest.raises(channel.ProtocolError):
        channel.receive(theirs, time.monotonic() + 10)
    sender.join()


@given(st.binary(max_size=400), st.integers(0, 200))
def test_arbitrary_bytes_are_refused_without_any_other_error(noise, cut):
    whole = frame({"tuple": [ONE, {"float": "nan"}]}, [label()], bytes(16))
    for data in (noise, struct.pack(">I", len(noise)) + noise, whole[:cut], whole[:cut] + noise):
        ours, theirs = socket.socketpair()
        with theirs:
            with ours:
                ours.sendall(data)
            try:
                kind, _, value = channel.receive(theirs, time.monotonic() + 10)
            except (channel.ProtocolError, EOFError):
                continue
            assert (kind, type(value)) == ("answer", tuple)


def test_any_nonzero_byte_of_a_boolean_array_becomes_true(pair):
    ours, theirs = pair
    ours.sendall(frame(ONE, [label(dtype="bool", shape=(3,), nbytes=3)], b"\x00\x01\xff"))
    _, _, received = channel.receive(theirs)
    assert received.tolist() == [False, True, True] and received.sum() == 2


def test_a_frame_that_arrives_too_slowly_times_out(pair):
    ours, theirs = pair
    stop = threading.Event()

    def drip():
        for byte in frame(list(range(500))):
            if stop.wait(0.01):
                return
            ours.sendall(bytes([byte]))

    dripping = threading.Thread(target=drip)
    dripping.start()
    with pytest.raises(TimeoutError):
        channel.receive(theirs, time.monotonic() + 0.2)
    assert dripping.is_alive()  # the rest of the frame is still to come
    stop.set()
    dripping.join()


def test_a_closed_connection_raises_end_of_file_and_a_truncated_frame_an_error(pair):
    ours, theirs = pair
    ours.close()
    with pytest.raises(EOFError):
        channel.receive(theirs)
