#!/usr/bin/env python3
"""The page of keyhole inspect in headless Chromium: what it shows is what the map holds, and user paths made by clicking
are user paths.

usage: inspect_page_test.py KEYHOLE SCENES [FOLDER [SCENE ...]]
FOLDER is where pages and screenshots stay; further scenes are opened as those of SCENES are. Where they lie beside the
source, as for tests/unit/pbrt_scene_test.cpp, dining-room and coffee are.
Ends with 77, which stands for a skipped test, where there is no Chromium.
"""
import pathlib
import subprocess
import sys
import tempfile

import browser
from inspect_controls import check_keyboard, check_labels, check_moving, check_widths
from inspect_page import QUICK, inspect, open_page
from inspect_shown import check_drawing, check_lamps, check_pixel, check_points, check_record, check_truth, check_warnings
from inspect_user_paths import check_user_paths

OUTSIDE = ["-D", "spp=1", "-D", "light_paths=40000", "-D", "cache_rays=50", "-D", "importons=5000"]


def check_scene(path):
    """Opens a page as it is; returns seconds to the first frame."""
    page = open_page(path)
    try:
        seconds = page.value("keyhole.firstFrame") / 1000
        assert seconds < 3, f"{path}: first frame after {seconds} s"
        assert path.stat().st_size < 12e6, path.stat().st_size
        check_labels(page)
        check_moving(page)
        check_drawing(page)
        check_pixel(page)
        check_keyboard(page)
        check_points(page)
        check_record(page)
        check_lamps(page)
        check_warnings(page)
        assert not page.errors, page.errors
        print(f"{path.stem}: first frame after {seconds:.2f} s, {path.stat().st_size / 1e6:.1f} MB")
    finally:
        page.close()


def main():
    if not browser.find():
        print("skipped: no Chromium here (on Debian: apt-get install chromium)")
        return 77
    keyhole, scenes = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else scratch)
        folder.mkdir(exist_ok=True)
        box = inspect(keyhole, folder, scenes / "box.yaml", *QUICK, "--photons", "4000", "--save-map", folder / "map")
        page = open_page(box)
        try:
            check_truth(page, folder / "map")
        finally:
            page.close()
        for name in ("box", "rooms", "lantern", "failures/keyhole"):
            check_scene(inspect(keyhole, folder, scenes / f"{name}.yaml", *QUICK))
        outside = [pathlib.Path(p) for p in sys.argv[4:]] or [
            p for n in ("dining-room", "coffee") if (p := scenes.parents[1] / "shared" / "scenes" / n / "scene.pbrt").exists()]
        for scene in outside:
            page = folder / f"{scene.parent.name}.html"
            subprocess.run([keyhole, "inspect", scene, "-o", page, *OUTSIDE], check=True)
            check_scene(page)
        check_widths(folder / "keyhole.html")
        check_user_paths(keyhole, folder, scenes / "failures" / "keyhole.yaml")
    return 0


if __name__ == "__main__":
    sys.exit(main())
