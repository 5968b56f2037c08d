"""Reads and writes EXR files with numpy alone: scan lines, ZIP (only read) or none, 32-bit floats."""

import struct
import zlib

import numpy as np

FLOAT = 2
LINES = {0: 1, 2: 1, 3: 16}  # scan lines in a block, by compression: none, ZIPS, ZIP


def text(data, at):
    """The string that ends with a zero, and where the next thing begins."""
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def header(data):
    """Attributes by name, and where the table of offsets begins."""
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("found no EXR file")
    attributes, at = {}, 8
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channels(attribute):
    """Names in the order of the file."""
    names, at = [], 0
    while attribute[at]:
        name, at = text(attribute, at)
        kind, = struct.unpack_from("<i", attribute, at)
        if kind != FLOAT:
            raise ValueError(f"found channel {name} of type {kind}, expected 32-bit floats")
        names.append(name)
        at += 16
    return names


def unzip(block, size):
    """Undoes OpenEXR's ZIP: deflate, differences of bytes, even bytes before odd ones."""
    if len(block) == size:
        return block  # stored: compression would have made it longer
    steps = np.frombuffer(zlib.decompress(block), np.uint8).copy()
    steps[1:] -= 128
    halves = np.cumsum(steps, dtype=np.uint8)
    whole = np.empty(size, np.uint8)
    whole[0::2] = halves[:(size + 1) // 2]
    whole[1::2] = halves[(size + 1) // 2:]
    return whole.tobytes()


def texts(path, prefix):
    """{name: value} of the attributes whose names begin so, which are strings."""
    with open(path, "rb") as file:
        found, _ = header(file.read())
    return {name: value.decode() for name, value in found.items() if name.startswith(prefix)}


def read(path):
    """{channel: array (height, width), float32, first row on top}. Raises ValueError for files of other kinds."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = header(data)
    names = channels(attributes["channels"])
    compression = attributes["compression"][0]
    if compression not in LINES:
        raise ValueError(f"found compression {compression}, expected none or ZIP")
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height, lines = right - left + 1, bottom - top + 1, LINES[compression]
    picture = np.empty((height, len(names), width), np.float32)
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at):
        y, size = struct.unpack_from("<2i", data, offset)
        rows = picture[y - top:y - top + lines]
        block = data[offset + 8:offset + 8 + size]
        if compression:
            block = unzip(block, rows.nbytes)
        rows[:] = np.frombuffer(block, "<f4").reshape(rows.shape)
    return {name: picture[:, k] for k, name in enumerate(names)}


def attribute(name, kind, value):
    return b"%s\0%s\0%s%s" % (name, kind, struct.pack("<i", len(value)), value)


def write(path, channels):
    """The opposite of read(), without compression. Blender reads such files far faster than it takes arrays."""
    names = sorted(channels)
    height, width = channels[names[0]].shape
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iB3x2i", FLOAT, 0, 1, 1) for name in names) + b"\0"
    head = b"\x76\x2f\x31\x01" + struct.pack("<i", 2 if max(map(len, names)) < 32 else 2 | 1 << 10)
    head += attribute(b"channels", b"chlist", listed) + attribute(b"compression", b"compression", b"\0")
    head += attribute(b"dataWindow", b"box2i", window) + attribute(b"displayWindow", b"box2i", window)
    head += attribute(b"lineOrder", b"lineOrder", b"\0") + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    head += attribute(b"screenWindowCenter", b"v2f", bytes(8))
    head += attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0"
    rows = np.empty(height, [("y", "<i4"), ("size", "<i4"), ("pixels", "<f4", (len(names), width))])
    rows["y"], rows["size"] = np.arange(height), 4 * len(names) * width
    for k, name in enumerate(names):
        rows["pixels"][:, k] = channels[name]
    offsets = len(head) + 8 * height + rows.itemsize * np.arange(height, dtype="<u8")
    with open(path, "wb") as file:
        file.write(head)
        offsets.astype("<u8").tofile(file)
        rows.tofile(file)
