#!/usr/bin/env python3
"""The page of keyhole inspect in headless Chromium: what it shows is what the map holds, and user paths made by clicking
are user paths.

usage: inspect_page_test.py KEYHOLE SCENES [FOLDER]     FOLDER: where pages and screenshots stay
Ends with 77, which stands for a skipped test, where there is no Chromium.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

import browser

QUICK = ["--resolution", "80x60", "-D", "spp=1", "-D", "light_paths=40000", "-D", "cache_rays=50", "-D", "importons=5000"]
CONTROLS = {"button", "combobox", "textbox", "slider", "checkbox", "spinbutton", "tab", "application"}


def inspect(keyhole, folder, scene, *more):
    page = folder / f"{scene.stem}.html"
    subprocess.run([keyhole, "inspect", scene, "-o", page, *more], check=True)
    return page


def open_page(path, **options):
    page = browser.Page(path.resolve().as_uri(), **options)
    for _ in range(200):
        if page.errors or page.value("window.keyhole !== undefined"):
            break
        time.sleep(0.05)
    assert not page.errors, page.errors
    return page


def photons_of(file):
    """The main photons of both maps as --save-map wrote them: (place, power) each."""
    data = file.read_bytes()
    counts = struct.unpack_from("<4Q", data, 40)
    maps, at = [], 80
    for part, count in enumerate(counts):
        found = []
        for i in range(count):
            x, y, z, *words = struct.unpack_from("<3f3H", data, at + 24 * i)
            exponent = sum((w >> 13) << (3 * k) for k, w in enumerate(words)) - 256 - 13
            found.append(((x, y, z), tuple((w & 8191) * 2.0 ** exponent for w in words)))
        at += 24 * count
        if part % 2 == 1:  # behind its pilot photons
            maps.append(found)
    return maps


def check_truth(page, file):
    """Counts, places and powers on the page are those of the map; a path leads to its photon."""
    maps = photons_of(file)
    counts = page.value("keyhole.page.counts")
    for name, photons in zip(("global", "caustic"), maps):
        assert counts[name]["mainPhotons"] == len(photons), (name, counts)
        power = sum(0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2] for _, p in photons)
        assert abs(counts[name]["power"] - power) <= 1e-9 * power, (name, counts[name]["power"], power)
    shown = page.value("[...keyhole.arrays.photons]"), page.value("[...keyhole.arrays.photonPowers]")
    kinds = page.value("[...keyhole.arrays.photonKinds]")
    known = [dict(photons) for photons in maps]
    for i, kind in enumerate(kinds):
        power = known[kind & 1].get(tuple(shown[0][3 * i:3 * i + 3]))
        assert power is not None, f"photon {i} is in no map"
        assert all(abs(a - b) <= 1e-6 * max(power) for a, b in zip(shown[1][3 * i:3 * i + 3], power)), (i, power)
    off = page.value("""Math.max(...[...keyhole.arrays.photonTrails].map((t, i) => {
        if (t < 0) return 0;
        const path = trail(t);
        return Math.sqrt(distance2(path.points[path.photon], photonPlace(i)));
    }))""")
    size = page.value("length(sub(keyhole.page.air.upper, keyhole.page.air.lower))")
    assert off < 2e-5 * size, off


def check_labels(page):
    page.call("Accessibility.enable")
    for tab in ("pixel", "photons", "paths", "figures"):
        page.click("#tab-" + tab)
        seen = 0
        for node in page.call("Accessibility.getFullAXTree")["nodes"]:
            role = node.get("role", {}).get("value")
            if not node["ignored"] and role in CONTROLS:
                seen += 1
                assert node.get("name", {}).get("value", "").strip(), (tab, node)
        assert seen > 10, (tab, seen)


def check_drawing(page):
    """Lines and points are really drawn: pixels of the view differ with them and without."""
    read = """(() => { const v = keyhole.view, gl = v.gl; v.draw();
        const p = new Uint8Array(4 * v.canvas.width * v.canvas.height);
        gl.readPixels(0, 0, v.canvas.width, v.canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, p);
        let s = 0; for (const x of p) s = (s * 31 + x) % 1000003; return s; })()"""
    seen = {page.value(read)}
    page.click("#tab-photons")
    page.click("#show-photons")
    seen.add(page.value(read))
    page.click("#show-photons")
    page.value("keyhole.picture.choose(40, 45)")
    seen.add(page.value(read))
    assert len(seen) == 3, "what is drawn doesn't change"


def check_moving(page):
    eye = "keyhole.view.camera.eye.join()"
    left, top, width, height = page.box("#view")
    x, y = left + width / 2, top + height / 2
    before = page.value(eye)
    page.drag(x, y, x + 60, y + 20)
    turned = page.value(eye)
    assert turned != before, "the mouse doesn't turn the view"
    page.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
    page.call("Input.dispatchTouchEvent", type="touchMove", touchPoints=[{"x": x + 40, "y": y}])
    page.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
    touched = page.value(eye)
    assert touched != turned, "a finger doesn't turn the view"
    page.call("Input.dispatchKeyEvent", type="keyDown", key="+")
    assert page.value(eye) != touched, "keys don't move the view"
    page.call("Input.dispatchKeyEvent", type="keyDown", key="c")
    assert page.value(eye) == before, "C doesn't go back to the camera"


def check_pixel(page):
    """A click in the picture says where its light comes from, and the lines begin at the eye."""
    left, top, width, height = page.box("#film")
    page.mouse("mousePressed", left + 40.5 / 80 * width, top + 48.5 / 60 * height)
    page.mouse("mouseReleased", left + 40.5 / 80 * width, top + 48.5 / 60 * height)
    assert page.value("keyhole.picture.pixel.join()") == "40,48", page.value("keyhole.picture.pixel")
    lit = page.value("LAYERS.some((l) => keyhole.arrays[l + 'A'][48 * 80 + 40] + keyhole.arrays[l + 'B'][48 * 80 + 40] > 0)")
    said = page.value("document.getElementById('answer').textContent")
    assert said.startswith("Mostly" if lit else "No light was found"), said
    off = page.value("Math.sqrt(distance2(keyhole.picture.light.trail[0], keyhole.page.camera.origin))")
    assert off < 1e-3 * page.value("keyhole.view.camera.size"), off


def check_widths(path):
    for width, dark in ((360, False), (820, True), (2560, False)):
        page = open_page(path, width=width, height=800, dark=dark)
        try:
            over = page.value("document.documentElement.scrollWidth - innerWidth")
            assert over <= 0, f"{over} pixels too wide at {width}"
            background = page.value("getComputedStyle(document.getElementById('stage')).backgroundColor")
            assert (int(background[4:].split(",")[0]) < 60) == dark, background
        finally:
            page.close()


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
        assert not page.errors, page.errors
        print(f"{path.stem}: first frame after {seconds:.2f} s, {path.stat().st_size / 1e6:.1f} MB")
    finally:
        page.close()


def click_at(page, place):
    """Clicks where a place of the scene is drawn."""
    left, top, _, _ = page.box("#view")
    x, y = page.value(f"keyhole.picking.project({json.dumps(place)})")
    page.mouse("mouseMoved", left + x, top + y)
    page.mouse("mousePressed", left + x, top + y)
    page.mouse("mouseReleased", left + x, top + y)


def change(page, selector, value):
    page.value(f"""(() => {{ const e = document.querySelector({json.dumps(selector)}); e.value = {json.dumps(value)};
        e.dispatchEvent(new Event("change")); }})()""")


def make_path(page):
    """Lamp, bounces, an opening by clicking three of its corners, a place behind it."""
    page.click("#tab-paths")
    page.click("#new-path")
    change(page, "#field-begins-at", "0")
    change(page, "#editor input[aria-label^=largest]", "15")
    page.click("#editor [data-mode=opening]")
    for corner in ([-0.022, 0.958, -0.5], [0.022, 0.958, -0.5], [-0.022, 1.042, -0.5]):
        click_at(page, corner)
    click_at(page, [0.3, 0, 0.5])
    assert not page.errors, page.errors
    return page.value("document.getElementById('yaml').value")


def squared_error(keyhole, folder, scene, seed, *more):
    out = folder / "small.exr"
    subprocess.run([keyhole, "render", scene, "--resolution", "64x48", "--method", "ipm", "-D", "light_paths=200000",
                    "-D", "spp=16", "--seed", str(seed), "-q", "--no-png", "-o", out, *more], check=True)
    found = subprocess.run([keyhole, "diff", out, folder / "1.exr", folder / "2.exr"], check=True, capture_output=True)
    return json.loads(found.stdout)["cross_trim"]


def check_gain(keyhole, folder, scene, file):
    """With the path the squared error is less than a fifth."""
    for seed in (1, 2):
        subprocess.run([keyhole, "render", scene, "--resolution", "64x48", "--method", "ipm", "-D", "light_paths=300000", "-D",
                        "spp=32", "--user-paths", scene.parents[2] / "userpaths" / "keyhole.yaml", "--seed", str(seed), "-q",
                        "--no-png", "-o", folder / f"{seed}.exr"], check=True)
    mean = lambda *more: sum(squared_error(keyhole, folder, scene, seed, *more) for seed in (7, 8, 9)) / 3
    # The renderer would find the hole by itself.
    without, with_it = mean("-D", "find_openings=false"), mean("--user-paths", file)
    print(f"squared error without the path {without:.3f}, with it {with_it:.3f}")
    assert with_it < without / 5, (without, with_it)


def checked(keyhole, scene, file):
    return subprocess.run([keyhole, "paths", "check", scene, file], check=True, capture_output=True, text=True).stdout


def check_user_paths(keyhole, folder, scene):
    given = scene.parents[2] / "userpaths" / "keyhole.yaml"
    page = open_page(inspect(keyhole, folder, scene, *QUICK, "--user-paths", given))
    try:  # what was read is written as it was
        file = folder / "read.yaml"
        file.write_text(page.value("document.getElementById('yaml').value"))
        assert checked(keyhole, scene, file) == checked(keyhole, scene, given)
    finally:
        page.close()
    page = open_page(inspect(keyhole, folder, scene, *QUICK))
    try:
        file = folder / "made.yaml"
        file.write_text(make_path(page))
        assert "15 bounces" in checked(keyhole, scene, file)
        before = file.read_text()
        # A point that is dragged stays on the surfaces.
        left, top, _, _ = page.box("#view")
        x, y = page.value("keyhole.picking.project(keyhole.paths.path.points[1].p)")
        page.drag(left + x, top + y, left + x + 30, top + y)
        dragged = page.value("document.getElementById('yaml').value")
        assert dragged != before
        (folder / "dragged.yaml").write_text(dragged)
        checked(keyhole, scene, folder / "dragged.yaml")
    finally:
        page.close()
    check_gain(keyhole, folder, scene, file)


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
        check_widths(box)
        for name in ("box", "rooms", "lantern", "failures/keyhole"):
            check_scene(inspect(keyhole, folder, scenes / f"{name}.yaml", *QUICK))
        check_user_paths(keyhole, folder, scenes / "failures" / "keyhole.yaml")
    return 0


if __name__ == "__main__":
    sys.exit(main())
