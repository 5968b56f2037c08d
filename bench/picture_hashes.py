#!/usr/bin/env python3
"""Hashes of small pictures by every method on a dozen scenes: what a change of the code alone must not change.

    bench/picture_hashes.py BEFORE AFTER     # two programs: lists the pictures that differ, and then ends with 1
    bench/picture_hashes.py PROGRAM          # prints the hashes

Which picture a method makes depends on the processor (Embree takes other instructions) and on the C library; so no hash
is recorded here: two programs are compared on one machine. A hash is of the values of all channels, not of their names.
Needs python3-openimageio.
"""
import argparse
import concurrent.futures
import hashlib
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
METHODS = ["mps", "ipm", "pm", "mlt", "path", "bdpt", "pssmlt", "mmlt", "rjmlt", "auto"]
# Diffuse; mirror and glass; a lens; coats; environments; a mesh; media's absorption; what photons find hard.
SCENES = ["box", "rooms", "lantern", "disco", "egg", "glossy", "tube", "ball", "failures/keyhole", "failures/sds",
          "failures/inside_glass", "failures/sun_glass", "failures/many_lights"]
SMALL = ["spp=4", "mutations=20000", "light_paths=20000", "photons=4000", "brightness_samples=4000", "importons=3000",
         "chains=40", "cache_rays=60"]
# scene, method, more options of the command line
VARIANTS = [
    ("box", "ipm", ["-D", "passes=3"]), ("box", "mps", ["-D", "passes=3"]), ("rooms", "pm", ["-D", "passes=2"]),
    ("box", "ipm", ["-D", "equalise=true"]), ("rooms", "mps", ["-D", "equalise=true"]),
    ("rooms", "mps", ["--user-paths", "userpaths/rooms.yaml"]), ("rooms", "ipm", ["--user-paths", "userpaths/rooms.yaml"]),
    ("box", "mlt", ["--user-paths", "userpaths/box.yaml"]),
    ("failures/keyhole", "mps", ["--user-paths", "userpaths/keyhole.yaml"]),
    ("failures/keyhole", "ipm", ["--user-paths", "userpaths/keyhole.yaml"]),
    ("box", "mps", ["-D", "power=reciprocal"]), ("box", "mps", ["-D", "power=literal"]),
    ("box", "mps", ["-D", "paths=all"]), ("box", "mps", ["-D", "tune_proposals=false"]),
    ("rooms", "mps", ["-D", "plan=all"]), ("rooms", "ipm", ["-D", "reach=off"]),
    ("box", "ipm", ["-D", "irradiance_cache=false"]), ("lantern", "pm", ["-D", "irradiance_cache=false"]),
    ("box", "pssmlt", ["-D", "builder=path"]), ("box", "pssmlt", ["-D", "builder=endpoints"]),
    ("box", "pssmlt", ["-D", "failures=exclude"]), ("box", "mmlt", ["-D", "failures=delay"]),
    ("box", "rjmlt", ["-D", "failures=exclude_large"]), ("box", "mmlt", ["-D", "large_step_mis=off"]),
    ("box", "mmlt", ["-D", "p_large=0.3"]), ("box", "bdpt", ["-D", "mis=balance"]), ("box", "bdpt", ["-D", "mis=maximum"]),
    ("box", "path", ["-D", "filter=triangle"]), ("box", "mlt", ["-D", "filter=box"]),
]


def cases():
    for scene in SCENES:
        for method in METHODS:
            yield f"{scene} {method}", scene, method, []
    for scene, method, options in VARIANTS:
        yield " ".join([scene, method, *[o for o in options if o != "-D"]]), scene, method, options


def digest(picture):
    """The values of all channels, in an order that doesn't hang on their names."""
    import OpenImageIO as oiio
    file = oiio.ImageInput.open(str(picture))
    names = file.spec().channelnames
    pixels = file.read_image(oiio.FLOAT)
    file.close()
    channels = sorted(hashlib.sha256(pixels[..., i].tobytes()).hexdigest() for i in range(len(names)))
    return hashlib.sha256("".join(channels).encode()).hexdigest()[:16]


def render(program, scene, method, options, picture):
    command = [program, "render", str(ROOT / "scenes" / f"{scene}.yaml"), "-q", "-t", "1", "--no-png", "--resolution", "32x24",
               "-o", str(picture), "-D", f"method={method}"]
    for setting in SMALL:
        command += ["-D", setting]
    done = subprocess.run(command + options, cwd=ROOT, capture_output=True, text=True)
    return "" if done.returncode == 0 else f"exit {done.returncode}: {done.stderr.strip().splitlines()[-1:]}"


def save_and_load(program, folder):
    photons = str(folder / "photons.map")
    return (render(program, "box", "ipm", ["--save-map", photons], folder / "saved.exr") or
            render(program, "box", "ipm", ["--load-map", photons, "-D", "cache_rays=90"], folder / "loaded.exr"))


def hashes(program, jobs, only):
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        folder = pathlib.Path(name)
        made = {folder / f"{i}.exr": (label, pool.submit(render, program, scene, method, options, folder / f"{i}.exr"))
                for i, (label, scene, method, options) in enumerate(cases()) if only in label}
        made[folder / "loaded.exr"] = ("box ipm, saved and loaded", pool.submit(save_and_load, program, folder))
        # Pictures are read on this thread: OpenImageIO's module waits for itself on others.
        return {label: future.result() or digest(picture) for picture, (label, future) in made.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="PROGRAM")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="pictures whose name holds this")
    given = parser.parse_args()
    if len(given.programs) > 2:
        parser.error("one program, or two")
    found = [hashes(str(pathlib.Path(p).resolve()), given.jobs, given.only) for p in given.programs]
    if len(found) == 1:
        for name, value in found[0].items():
            print(f"{value} {name}")
        return 0
    different = [name for name in found[0] if found[0][name] != found[1][name]]
    for name in different:
        print(f"{name}: {found[0][name]} before, {found[1][name]} after")
    print(f"{len(found[0]) - len(different)} of {len(found[0])} pictures are the same")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
