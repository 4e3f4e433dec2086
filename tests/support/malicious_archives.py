"""Archives that no class is to unpack: each has a trap, and each is refused, whatever the limits.

What is harmful in them is harmless here: names lead to /tmp/planted, bombs hold a few megabytes of
zeros.
"""

import io
import os
import stat
import struct
import tarfile
import zipfile
import zlib

FILES = {
    "report.html": b"<p>hello",
    "photographs/a.jpg": b"\xff\xd8" * 500,
    "source/hdr.py": b"print()\n",
}


def zipped(path, files, **knobs):
    """Write a zip of (name or ZipInfo, bytes)."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, **knobs) as archive:
        for name, data in files.items() if isinstance(files, dict) else files:
            archive.writestr(name, data)
    return path


def tarred(path, members, mode="w", **knobs):
    """Write a tar of TarInfo and bytes."""
    with tarfile.open(path, mode, **knobs) as archive:
        for info, data in members:
            info.size = len(data) if info.isreg() else info.size
            archive.addfile(info, io.BytesIO(data))
    return path


def info(name, kind=tarfile.REGTYPE, link="", **knobs):
    """Return the header of a member of a tar."""
    made = tarfile.TarInfo(name)
    made.type, made.linkname = kind, link
    for knob, value in knobs.items():
        setattr(made, knob, value)
    return made


def entry(name, mode):
    """Return the entry of a zip with a file type of Unix."""
    made = zipfile.ZipInfo(name)
    made.create_system, made.external_attr = 3, mode << 16
    return made


def encrypted(path):
    """Set the flag of encryption in both headers of a zip of one member."""
    zipped(path, {"a.txt": b"secret"})
    data = bytearray(path.read_bytes())
    data[6] |= 1
    data[data.rfind(b"PK\1\2") + 8] |= 1
    path.write_bytes(data)
    return path


def overlapping(path):
    """Write a zip whose two members have the same bytes: the bomb that grows with its list."""
    zipped(path, {"a.txt": b"0" * 9000, "b.txt": b"0" * 9000})
    data = bytearray(path.read_bytes())
    second = data.rfind(b"PK\1\2")
    data[second + 42 : second + 46] = struct.pack("<L", 0)
    path.write_bytes(data)
    return path


def lying(path):
    """Write a zip whose member is larger than its headers say."""
    zipped(path, {"a.txt": b"0" * 50_000})
    data = bytearray(path.read_bytes())
    for at in (22, data.rfind(b"PK\1\2") + 24):
        data[at : at + 4] = struct.pack("<L", 100)
    path.write_bytes(data)
    return path


def long_header(path, size=10_000_000, kind=tarfile.XHDTYPE):
    """Write a tar with an extended header of many bytes, which a reader takes into memory."""
    header = info("x", kind, size=size).tobuf(tarfile.USTAR_FORMAT)
    path.write_bytes(header + bytes(1024))
    return path


def resizing(path):
    """Write a tar whose extended header gives a member another size than its own header."""
    return tarred(
        path, [(info("a.txt", pax_headers={"size": "7"}), b"0" * 600)], format=tarfile.PAX_FORMAT
    )


def resizing_as_solaris(path):
    """Write the same with the header's older type."""
    data = bytearray(resizing(path).read_bytes())
    data[156:157] = tarfile.SOLARIS_XHDTYPE
    total = sum(data[:148]) + 8 * ord(" ") + sum(data[156:512])
    data[148:156] = b"%06o\0 " % total
    path.write_bytes(data)
    return path


LINK, DEVICE, FIFO = stat.S_IFLNK | 0o777, stat.S_IFCHR | 0o666, stat.S_IFIFO | 0o666
TRAPS = {
    "a symbolic link in a zip": lambda p: zipped(p, [(entry("a", LINK), "/etc/passwd")]),
    "a symbolic link in a tar": lambda p: tarred(p, [(info("a", tarfile.SYMTYPE, "/etc"), b"")]),
    "a file behind a link": lambda p: tarred(
        p, [(info("a", tarfile.SYMTYPE, "/tmp"), b""), (info("a/b"), b"x")]
    ),
    "a hard link": lambda p: tarred(p, [(info("a"), b"x"), (info("b", tarfile.LNKTYPE, "a"), b"")]),
    "an absolute name in a zip": lambda p: zipped(p, {"/tmp/planted": b"x"}),
    "an absolute name in a tar": lambda p: tarred(p, [(info("/tmp/planted"), b"x")]),
    "a drive's name": lambda p: zipped(p, {"C:/planted": b"x"}),
    "a member that climbs out, zip": lambda p: zipped(p, {"a/../../planted": b"x"}),
    "a member that climbs out, tar": lambda p: tarred(p, [(info("../planted"), b"x")]),
    "a member that climbs out by backslashes": lambda p: zipped(
        p, [(entry("..\\planted", 0o100644), b"x")]
    ),
    "a device in a zip": lambda p: zipped(p, [(entry("tty", DEVICE), b"")]),
    "a device in a tar": lambda p: tarred(
        p, [(info("null", tarfile.CHRTYPE, devmajor=1, devminor=3), b"")]
    ),
    "a block device": lambda p: tarred(p, [(info("sda", tarfile.BLKTYPE, devmajor=8), b"")]),
    "a pipe": lambda p: tarred(p, [(info("pipe", tarfile.FIFOTYPE), b"")]),
    "a pipe in a zip": lambda p: zipped(p, [(entry("pipe", FIFO), b"")]),
    "a device's name": lambda p: zipped(p, {"photographs/CON.jpg": b"x"}),
    "a bomb in a zip": lambda p: zipped(p, {f"{k}.raw": bytes(2_000_000) for k in range(9)}),
    "a bomb of one member": lambda p: zipped(p, {"zeros.raw": bytes(10_000_000)}),
    "a bomb in a tar.gz": lambda p: tarred(p, [(info("zeros"), bytes(3_000_000))], "w:gz"),
    "a bomb in a tar.xz": lambda p: tarred(p, [(info("zeros"), bytes(3_000_000))], "w:xz"),
    "a bomb in a tar.bz2": lambda p: tarred(p, [(info("zeros"), bytes(3_000_000))], "w:bz2"),
    "members that share bytes": overlapping,
    "a member larger than it says": lying,
    "a sparse file": lambda p: tarred(
        p, [(info("a", tarfile.GNUTYPE_SPARSE, size=0), b"")], format=tarfile.GNU_FORMAT
    ),
    "an extended header too large": long_header,
    "an extended header that changes a size": resizing,
    "Solaris' extended header, too large": lambda p: long_header(p, kind=tarfile.SOLARIS_XHDTYPE),
    "Solaris' extended header that changes a size": resizing_as_solaris,
    "a name twice in a zip": lambda p: zipped(p, [("a.txt", b"1"), ("./a.txt", b"2")]),
    "a name twice in a tar": lambda p: tarred(p, [(info("a"), b"1"), (info("a"), b"2")]),
    "names that differ by case": lambda p: zipped(p, {"Report.html": b"1", "report.HTML": b"2"}),
    "a file that is a folder too": lambda p: zipped(p, {"a": b"1", "a/b": b"2"}),
    "too many members, zip": lambda p: zipped(p, {f"{k}.txt": b"" for k in range(2001)}),
    "too many members, tar": lambda p: tarred(p, [(info(f"{k}"), b"") for k in range(2001)]),
    "too deep": lambda p: zipped(p, {"a/" * 13 + "e.txt": b"x"}),
    "a name too long": lambda p: zipped(p, {"n" * 201: b"x"}),
    "a control character in a name": lambda p: tarred(p, [(info("a\x1b[2Jb"), b"x")]),
    "a turn of direction in a name": lambda p: zipped(p, {"photo\u202egpj.exe": b"x"}),
    "an encrypted member": encrypted,
    "a zip cut short": lambda p: p.write_bytes(zipped(p, FILES).read_bytes()[:-40]),
    "a tar.gz cut short": lambda p: p.write_bytes(
        tarred(p, [(info("a"), os.urandom(4000))], "w:gz").read_bytes()[:-1000]
    ),
    "no archive": lambda p: p.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(2000)),
    "nothing": lambda p: p.write_bytes(b""),
    "a stream that ends in rubbish": lambda p: p.write_bytes(b"\x1f\x8b" + os.urandom(300)),
    "a wrong checksum": lambda p: p.write_bytes(
        zipped(p, {"a": b"hello"})
        .read_bytes()
        .replace(struct.pack("<L", zlib.crc32(b"hello")), b"abcd")
    ),
}
