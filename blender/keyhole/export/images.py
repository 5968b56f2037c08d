"""Pictures: files where they lie; those that are packed, painted or computed are written to the scene's folder."""

import os
import struct
import zlib

import bpy
import numpy as np

LINEAR = {"Linear", "Raw", "Non-Color"}


def write_png(path, pixels):
    """`pixels`: (height, width, channels) bytes of 1 or 3 channels, first row on top."""
    height, width, channels = pixels.shape

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    lines = np.zeros((height, 1 + width * channels), np.uint8)  # each begins with its filter: none
    lines[:, 1:] = pixels.reshape(height, -1)
    head = struct.pack(">2I5B", width, height, 8, {1: 0, 3: 2}[channels], 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines.tobytes(), 1)) +
                   chunk(b"IEND", b""))


def write_pfm(path, pixels):
    """`pixels`: (height, width, 3) floats, first row at the bottom."""
    height, width, _ = pixels.shape
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, height))
        np.ascontiguousarray(pixels, "<f4").tofile(file)


def pixels_of(image):
    """(height, width, channels) floats as the file has them, first row at the bottom."""
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], image.channels)


def has_holes(image):
    """Whether alpha counts, and is less than 1 anywhere."""
    counts = image.channels == 4 and image.alpha_mode in {"STRAIGHT", "PREMUL"}
    return counts and not image.colorspace_settings.is_data and bool(pixels_of(image)[:, :, 3].min() < 1)


def as_bytes(pixels):
    return (np.clip(pixels[::-1], 0, 1) * 255 + 0.5).astype(np.uint8)


class Images:
    """Files for Blender's images, each written once."""

    def __init__(self, folder):
        self.folder, self.files = folder, {}

    def path(self, kind, ending):
        return os.path.join(self.folder, f"{kind}-{len(self.files) + 1}{ending}")

    def file(self, image, faded=False):
        """The path of a file with the image, `faded` with colours times alpha. Raises FileNotFoundError."""
        key = image.name_full, faded
        if key not in self.files:
            self.files[key] = self.write_pixels(image, faded) if faded else self.find(image)
        return self.files[key]

    def find(self, image):
        path = bpy.path.abspath(image.filepath, library=image.library)
        if image.packed_file and not image.is_dirty:
            ending = os.path.splitext(path)[1] or "." + image.file_format.lower()
            written = self.path("image", ending)
            with open(written, "wb") as file:
                file.write(image.packed_file.data)
            return written
        if image.source == "FILE" and not image.is_dirty:
            if not os.path.isfile(path):
                raise FileNotFoundError(path)
            return path
        return self.write_pixels(image)

    def write_pixels(self, image, faded=False):
        pixels = pixels_of(image)
        if faded:
            pixels = pixels * pixels[:, :, 3:]
        if pixels.shape[2] < 3:
            pixels = np.repeat(pixels[:, :, :1], 3, 2)
        written = self.path("image", ".pfm" if image.is_float else ".png")
        if image.is_float:
            write_pfm(written, pixels[:, :, :3])
        else:
            write_png(written, as_bytes(pixels[:, :, :3]))
        return written

    def alpha_file(self, image):
        """The path of a file with the image's alpha channel, as numbers."""
        key = image.name_full, "alpha"
        if key not in self.files:
            written = self.path("alpha", ".png")
            write_png(written, as_bytes(pixels_of(image)[:, :, 3:4]))
            self.files[key] = written
        return self.files[key]


def encoding(image):
    """Of integers, as scene files have it; None for a colour space that they don't know."""
    name = image.colorspace_settings.name
    if image.colorspace_settings.is_data or name in LINEAR:
        return "linear"
    return "srgb" if name == "sRGB" else None
