#!/usr/bin/env python3
"""The page of keyhole chart in headless Chromium: a click, a drag, a screenshot, and no network.

usage: page_test.py KEYHOLE [FOLDER]     FOLDER: where chart and screenshot stay
Ends with 77, which stands for a skipped test, where there is no Chromium.
"""
import pathlib
import subprocess
import sys
import tempfile

import browser

SCENE = """
film: {resolution: [32, 24]}
camera: {from: [0, 0, 4], to: [0, 0, 0]}
materials: {white: {type: diffuse}, mirror: {type: mirror}}
shapes:
  - {type: rectangle, corner: [-2, -1, -2], u: [0, 0, 4], v: [4, 0, 0], material: white}
  - {type: sphere, material: mirror, radius: 0.6}
  - {type: rectangle, corner: [-1, 3, -1], u: [2, 0, 0], v: [0, 0, 2], emission: {power: 60}}
"""


def make_chart(keyhole, folder):
    for name in ("one", "two"):
        (folder / f"{name}.yaml").write_text(SCENE)
    subprocess.run([keyhole, "chart", folder / "one.yaml", folder / "two.yaml", "--methods", "ipm,path", "--times", "0.2,0.5",
                    "--memory", "1M", "--repeats", "2", "--reference-time", "3", "-o", folder / "report"], check=True)
    return folder / "report" / "index.html"


def check(page):
    rows = "[...document.querySelectorAll('#methods tbody tr')].map(r => r.cells[0].textContent)"
    assert sorted(page.value(rows)) == ["ipm", "path"], page.value(rows)

    # A click on a heading sorts, another one turns the order round.
    page.click("#methods th:nth-child(1)")
    first = page.value(rows)
    page.click("#methods th:nth-child(1)")
    assert page.value(rows) == first[::-1], first

    # A click on a name hides its curve.
    page.click("#time .label")
    assert page.value("document.querySelectorAll('#time .series.off').length") == 1

    # A drag of the level changes what the table asks for.
    heading = "document.querySelector('#methods th:nth-child(4)').textContent"
    before = page.value(heading)
    left, top, width, height = page.box("#time .threshold .grip")
    page.drag(left + width / 2, top, left + width / 2, top + 60)
    assert page.value(heading) != before, before

    # A drag of the handle moves the border between the pictures, which are there.
    left, top, width, height = page.box("#pictures .viewer")
    page.drag(left + width / 2, top + height / 2, left + width / 4, top + height / 2)
    assert page.value("document.querySelector('.handle').style.left").startswith("25"), "the handle didn't follow"
    lit = ("(() => { const c = document.querySelector('#pictures canvas'); return c.getContext('2d')"
           ".getImageData(0, 0, c.width, c.height).data.some((v, i) => i % 4 < 3 && v > 40); })()")
    assert page.value(lit), "the picture is black"
    page.click("#pictures button[data-value=error]")
    assert page.value("document.querySelector('#pictures .side').textContent").endswith("error")

    # The other scene.
    page.click("#scenes button:nth-child(2)")
    assert page.value("document.getElementById('summary').textContent").startswith("two")
    assert page.value("document.querySelectorAll('#memory svg').length") == 1
    assert page.screenshot()[:4] == b"\x89PNG"
    assert not page.errors, page.errors


def main():
    if not browser.find():
        print("skipped: no Chromium here (on Debian: apt-get install chromium)")
        return 77
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else scratch)
        folder.mkdir(exist_ok=True)
        index = make_chart(sys.argv[1], folder)
        assert index.stat().st_size < 5e6
        page = browser.Page(index.resolve().as_uri())
        try:
            check(page)
            if len(sys.argv) > 2:
                (folder / "page.png").write_bytes(page.screenshot())
        finally:
            page.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
