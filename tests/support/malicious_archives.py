"""Archives that hdrlab must refuse to unpack, whatever its limits, and functions that write archives.

They are harmless all the same: names lead to /tmp/planted, and archive bombs hold a few megabytes of
zeros.
"""

import io
import os
import stat
import struct
import tarfile
import zipfile
import zlib

HARMLESS_FILES = {
    "report.html": b"<p>hello",
    "photographs/a.jpg": b"\xff\xd8" * 500,
    "source/hdr.py": b"print()\n",
}
LINK_MODE = stat.S_IFLNK | 0o777
DEVICE_MODE = stat.S_IFCHR | 0o666
FIFO_MODE = stat.S_IFIFO | 0o666
CREATED_ON_UNIX = 3  # of the ZIP format: the upper 16 bits of the attributes are a file mode
# offsets in the headers of the ZIP format, in bytes
CENTRAL_HEADER_SIGNATURE = b"PK\1\2"
LOCAL_FLAGS_OFFSET = 6
LOCAL_SIZE_OFFSET = 22
CENTRAL_FLAGS_OFFSET = 8
CENTRAL_SIZE_OFFSET = 24
CENTRAL_LOCAL_HEADER_OFFSET = 42  # where the member begins
# offsets in the headers of the tar format, in bytes
TAR_CHECKSUM_OFFSET = 148
TAR_TYPE_OFFSET = 156
TAR_HEADER_BYTES = 512


def write_zip(path, files, **options):
    """Write a ZIP file and return its path.

    Parameters
    ----------
    path : a path, or a file that is open for writing
    files : a dict of bytes by name, or a list of (name or ZipInfo, bytes)
    options : of zipfile.ZipFile
    """
    members = files.items() if isinstance(files, dict) else files
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, **options) as archive:
        for name, data in members:
            archive.writestr(name, data)
    return path


def write_tar(path, members, mode="w", **options):
    """Write a tar file and return its path.

    Parameters
    ----------
    members : a list of (TarInfo, bytes)
    mode, options : of tarfile.open
    """
    with tarfile.open(path, mode, **options) as archive:
        for header, data in members:
            if header.isreg():
                header.size = len(data)
            archive.addfile(header, io.BytesIO(data))
    return path


def tar_member(name, kind=tarfile.REGTYPE, link="", **fields):
    """Return the header of a member of a tar file.

    Parameters
    ----------
    kind : tarfile.REGTYPE, SYMTYPE, ...
    link : the target of a link
    fields : other attributes of the TarInfo
    """
    header = tarfile.TarInfo(name)
    header.type = kind
    header.linkname = link
    for field, value in fields.items():
        setattr(header, field, value)
    return header


def zip_member(name, mode):
    """Return the header of a member of a ZIP file with a file mode of Unix, such as LINK_MODE."""
    header = zipfile.ZipInfo(name)
    header.create_system = CREATED_ON_UNIX
    header.external_attr = mode << 16
    return header


def write_encrypted_zip(path):
    """Write a ZIP file with one member and set the flag for encryption in both of its headers."""
    write_zip(path, {"a.txt": b"secret"})
    data = bytearray(path.read_bytes())
    central = data.rfind(CENTRAL_HEADER_SIGNATURE)
    data[LOCAL_FLAGS_OFFSET] |= 1
    data[central + CENTRAL_FLAGS_OFFSET] |= 1
    path.write_bytes(data)
    return path


def write_overlapping_zip(path):
    """Write a ZIP file whose two members share their bytes, as an archive bomb does a million times."""
    write_zip(path, {"a.txt": b"0" * 9000, "b.txt": b"0" * 9000})
    data = bytearray(path.read_bytes())
    start = data.rfind(CENTRAL_HEADER_SIGNATURE) + CENTRAL_LOCAL_HEADER_OFFSET
    data[start : start + 4] = struct.pack("<L", 0)
    path.write_bytes(data)
    return path


def write_zip_with_wrong_size(path):
    """Write a ZIP file whose member is larger than its headers say."""
    write_zip(path, {"a.txt": b"0" * 50_000})
    data = bytearray(path.read_bytes())
    central = data.rfind(CENTRAL_HEADER_SIGNATURE)
    for start in (LOCAL_SIZE_OFFSET, central + CENTRAL_SIZE_OFFSET):
        data[start : start + 4] = struct.pack("<L", 100)
    path.write_bytes(data)
    return path


def write_long_tar_header(path, size=10_000_000, kind=tarfile.XHDTYPE):
    """Write a tar file that announces an extended header of many bytes, which readers load into memory."""
    header = tar_member("x", kind, size=size).tobuf(tarfile.USTAR_FORMAT)
    path.write_bytes(header + bytes(1024))
    return path


def write_resizing_tar(path):
    """Write a tar file whose extended header contradicts the size in the header of a member."""
    member = tar_member("a.txt", pax_headers={"size": "7"})
    return write_tar(path, [(member, b"0" * 600)], format=tarfile.PAX_FORMAT)


def write_resizing_solaris_tar(path):
    """Write the same file with the type that Solaris gave to extended headers."""
    data = bytearray(write_resizing_tar(path).read_bytes())
    data[TAR_TYPE_OFFSET : TAR_TYPE_OFFSET + 1] = tarfile.SOLARIS_XHDTYPE
    before = sum(data[:TAR_CHECKSUM_OFFSET])
    after = sum(data[TAR_TYPE_OFFSET:TAR_HEADER_BYTES])
    checksum = before + 8 * ord(" ") + after  # the checksum itself counts as spaces
    data[TAR_CHECKSUM_OFFSET:TAR_TYPE_OFFSET] = b"%06o\0 " % checksum
    path.write_bytes(data)
    return path


# By what is wrong with it, the function that writes such an archive to a path.
MALICIOUS_ARCHIVES = {
    "a symbolic link in a zip": lambda path: write_zip(
        path, [(zip_member("a", LINK_MODE), "/etc/passwd")]
    ),
    "a symbolic link in a tar": lambda path: write_tar(
        path, [(tar_member("a", tarfile.SYMTYPE, "/etc"), b"")]
    ),
    "a file behind a link": lambda path: write_tar(
        path, [(tar_member("a", tarfile.SYMTYPE, "/tmp"), b""), (tar_member("a/b"), b"x")]
    ),
    "a hard link": lambda path: write_tar(
        path, [(tar_member("a"), b"x"), (tar_member("b", tarfile.LNKTYPE, "a"), b"")]
    ),
    "an absolute name in a zip": lambda path: write_zip(path, {"/tmp/planted": b"x"}),
    "an absolute name in a tar": lambda path: write_tar(path, [(tar_member("/tmp/planted"), b"x")]),
    "a drive's name": lambda path: write_zip(path, {"C:/planted": b"x"}),
    "a member that climbs out, zip": lambda path: write_zip(path, {"a/../../planted": b"x"}),
    "a member that climbs out, tar": lambda path: write_tar(
        path, [(tar_member("../planted"), b"x")]
    ),
    "a member that climbs out by backslashes": lambda path: write_zip(
        path, [(zip_member("..\\planted", 0o100644), b"x")]
    ),
    "a device in a zip": lambda path: write_zip(path, [(zip_member("tty", DEVICE_MODE), b"")]),
    "a device in a tar": lambda path: write_tar(
        path, [(tar_member("null", tarfile.CHRTYPE, devmajor=1, devminor=3), b"")]
    ),
    "a block device": lambda path: write_tar(
        path, [(tar_member("sda", tarfile.BLKTYPE, devmajor=8), b"")]
    ),
    "a pipe": lambda path: write_tar(path, [(tar_member("pipe", tarfile.FIFOTYPE), b"")]),
    "a pipe in a zip": lambda path: write_zip(path, [(zip_member("pipe", FIFO_MODE), b"")]),
    "a device's name": lambda path: write_zip(path, {"photographs/CON.jpg": b"x"}),
    "a bomb in a zip": lambda path: write_zip(
        path, {f"{k}.raw": bytes(2_000_000) for k in range(9)}
    ),
    "a bomb of one member": lambda path: write_zip(path, {"zeros.raw": bytes(10_000_000)}),
    "a bomb in a tar.gz": lambda path: write_tar(
        path, [(tar_member("zeros"), bytes(3_000_000))], "w:gz"
    ),
    "a bomb in a tar.xz": lambda path: write_tar(
        path, [(tar_member("zeros"), bytes(3_000_000))], "w:xz"
    ),
    "a bomb in a tar.bz2": lambda path: write_tar(
        path, [(tar_member("zeros"), bytes(3_000_000))], "w:bz2"
    ),
    "members that share bytes": write_overlapping_zip,
    "a member larger than it says": write_zip_with_wrong_size,
    "a sparse file": lambda path: write_tar(
        path, [(tar_member("a", tarfile.GNUTYPE_SPARSE, size=0), b"")], format=tarfile.GNU_FORMAT
    ),
    "an extended header too large": write_long_tar_header,
    "an extended header that changes a size": write_resizing_tar,
    "Solaris' extended header, too large": lambda path: write_long_tar_header(
        path, kind=tarfile.SOLARIS_XHDTYPE
    ),
    "Solaris' extended header that changes a size": write_resizing_solaris_tar,
    "a name twice in a zip": lambda path: write_zip(path, [("a.txt", b"1"), ("./a.txt", b"2")]),
    "a name twice in a tar": lambda path: write_tar(
        path, [(tar_member("a"), b"1"), (tar_member("a"), b"2")]
    ),
    "names that differ by case": lambda path: write_zip(
        path, {"Report.html": b"1", "report.HTML": b"2"}
    ),
    "a file that is a folder too": lambda path: write_zip(path, {"a": b"1", "a/b": b"2"}),
    "too many members, zip": lambda path: write_zip(path, {f"{k}.txt": b"" for k in range(2001)}),
    "too many members, tar": lambda path: write_tar(
        path, [(tar_member(f"{k}"), b"") for k in range(2001)]
    ),
    "too deep": lambda path: write_zip(path, {"a/" * 13 + "e.txt": b"x"}),
    "a name too long": lambda path: write_zip(path, {"n" * 201: b"x"}),
    "a control character in a name": lambda path: write_tar(
        path, [(tar_member("a\x1b[2Jb"), b"x")]
    ),
    "a turn of direction in a name": lambda path: write_zip(path, {"photo\u202egpj.exe": b"x"}),
    "an encrypted member": write_encrypted_zip,
    "a zip cut short": lambda path: path.write_bytes(
        write_zip(path, HARMLESS_FILES).read_bytes()[:-40]
    ),
    "a tar.gz cut short": lambda path: path.write_bytes(
        write_tar(path, [(tar_member("a"), os.urandom(4000))], "w:gz").read_bytes()[:-1000]
    ),
    "no archive": lambda path: path.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(2000)),
    "nothing": lambda path: path.write_bytes(b""),
    "a stream that ends in rubbish": lambda path: path.write_bytes(b"\x1f\x8b" + os.urandom(300)),
    "a wrong checksum": lambda path: path.write_bytes(
        write_zip(path, {"a": b"hello"})
        .read_bytes()
        .replace(struct.pack("<L", zlib.crc32(b"hello")), b"abcd")
    ),
}
