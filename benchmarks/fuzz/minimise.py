"""A file made small: blocks are taken out as long as the same still goes wrong (Zeller's ddmin, in short)."""

from collections.abc import Callable

# readings that one finding may cost
TRIES = 300


def minimised(data: bytes, still: Callable[[bytes], bool], tries: int = TRIES) -> bytes:
    """Return as few bytes as a number of tries finds, of which `still` says that they go wrong alike."""
    size = max(len(data) // 2, 1)
    while data and tries > 0:
        data, tries, shorter = _without_blocks(data, size, still, tries)
        if size == 1 and not shorter:
            break
        size = max(size // 2, 1)
    return data


def _without_blocks(
    data: bytes, size: int, still: Callable[[bytes], bool], tries: int
) -> tuple[bytes, int, bool]:
    """Return the data without the blocks of a size that are not needed, the tries left, and if any went."""
    at = 0
    before = len(data)
    while at < len(data) and tries > 0:
        candidate = data[:at] + data[at + size :]
        tries -= 1
        if still(candidate):
            data = candidate
        else:
            at += size
    return data, tries, len(data) < before
