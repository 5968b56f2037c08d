#!/usr/bin/env python3
"""Makes the five pictures of docs/inspect.md from the page as it is.

usage: inspect_pictures.py KEYHOLE SCENES FOLDER     FOLDER: docs/images
"""
import pathlib
import sys
import tempfile

import browser
import inspect_page as test
from inspect_user_paths import BEHIND, CORNERS, begin_path

TURNED = """(() => { const c = keyhole.view.camera; c.eye = [3.3, 1.9, 2.6]; c.lookAt([0, 0.95, -0.35]); keyhole.view.redraw(); })()"""


def settled(page):
    page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return page.screenshot(False)


def main():
    keyhole, scenes, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
    scene = scenes / "failures" / "keyhole.yaml"
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        page = test.open_page(test.inspect(keyhole, scratch, scene), width=1040, height=680)
        keep = lambda n: (folder / f"inspect-{n}.png").write_bytes(settled(page))
        try:
            test.change(page, "#layer", "error:indirect")
            page.value("keyhole.picture.choose(30, 50)")
            keep(1)
            test.change(page, "#layer", "picture")
            page.value(TURNED)
            page.click("#tab-photons")
            test.change(page, "#colour", "bounces")
            page.value("document.getElementById('layers').scrollIntoView()")
            keep(2)
            page.value("keyhole.view.camera.reset(), keyhole.view.camera.zoom(0.4)")
            begin_path(page)
            for corner in CORNERS[:2]:
                test.click_at(page, corner)
            keep(3)
            page.value("keyhole.view.camera.reset()")
            test.click_at(page, CORNERS[2])
            test.click_at(page, BEHIND)
            page.value(TURNED)
            keep(4)
            file = scratch / "paths.yaml"
            file.write_text(page.value("document.getElementById('yaml').value"))
        finally:
            page.close()
        page = test.open_page(test.inspect(keyhole, scratch, scene, "--user-paths", file), width=1040, height=680)
        try:
            page.value(TURNED)
            page.click("#tab-photons")
            test.change(page, "#colour", "sampler")
            keep(5)
        finally:
            page.close()
    return 0


if __name__ == "__main__":
    sys.exit(main() if browser.find() else 77)
