"""Broken glTF files: one line that says what was found."""

import os
import subprocess
import tempfile

from gltf_files import File, flat
from harness import test
from khronos_test import GREEN, OPTIONS


def broken(change, says, how="glb"):
    """`change`: of the document, or of the bytes of the file."""
    file = File()
    file.node(mesh=file.quad(flat(GREEN), uvs=True))
    with tempfile.TemporaryDirectory() as folder:
        if how == "json":
            change(file.json)
        path = file.write(folder)
        if how == "glb":
            with open(path, "rb") as old:
                data = change(old.read())
            with open(path, "wb") as new:
                new.write(data)
        done = subprocess.run([os.environ["KEYHOLE"], "render", path, "-o", os.path.join(folder, "x.exr"), *OPTIONS],
                              capture_output=True, text=True, timeout=60)
        lines = done.stderr.splitlines()
        assert done.returncode == 2, (done.returncode, done.stderr)
        assert len(lines) <= 3 and all(line.startswith("keyhole: ") for line in lines), lines
        assert path in done.stderr and says in done.stderr, (says, done.stderr)


@test
def broken_files_are_errors():
    def put(*keys, value):
        def change(document):
            for key in keys[:-1]:
                document = document[key]
            document[keys[-1]] = value
        return change
    broken(lambda data: data[:len(data) // 2], "broken GLB")
    broken(lambda data: data[:4] + b"\7" + data[5:], "found version 7 of GLB")
    broken(lambda data: data.replace(b'"version"', b'"version", '), "broken JSON")
    broken(lambda data: b"", "broken JSON")
    broken(put("asset", "version", value="3.0"), "version '3.0'", "json")
    broken(put("accessors", 0, "count", value=4000), "out of range", "json")
    broken(put("accessors", 0, "bufferView", value=77), "index 77", "json")
    broken(put("meshes", 0, "primitives", 0, "material", value=9), "index 9", "json")
    broken(put("nodes", 0, "camera", value=9), "no entry 9 of 'cameras'", "json")
    broken(put("nodes", 1, "mesh", value=9), "no entry 9 of 'meshes'", "json")
    broken(put("nodes", 1, "children", value=[1]), "recursive", "json")
