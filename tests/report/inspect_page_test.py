#!/usr/bin/env python3
"""The page of keyhole inspect in headless Chromium: what it shows is what the map holds, and user paths made by clicking
are user paths.

usage: inspect_page_test.py KEYHOLE SCENES [FOLDER [SCENE ...]]
FOLDER is where pages and screenshots stay; further scenes are opened as those of SCENES are. Where they lie beside the
source, as for tests/unit/pbrt_scene_test.cpp, dining-room and coffee are.
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
OUTSIDE = ["-D", "spp=1", "-D", "light_paths=40000", "-D", "cache_rays=50", "-D", "importons=5000"]
# What a warning is about, and the layer of the picture that its way leads to.
LAYERS = {"samples": "error", "direct": "error:direct", "caustics": "error:caustic", "lookups": "reach"}
TABS = ("pixel", "photons", "paths", "figures")
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
    for tab in TABS:
        page.click("#tab-" + tab)
        if tab == "paths":
            page.value("keyhole.paths.create(), keyhole.page.emitters[0].p && keyhole.paths.begin(0)")
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


def key(page, name, text=None, code=0):
    for phase in ("keyDown", "keyUp"):
        page.call("Input.dispatchKeyEvent", type=phase, key=name, code=name, windowsVirtualKeyCode=code,
                  **({"text": text} if text and phase == "keyDown" else {}))


def check_keyboard(page):
    """Every control is reached with the tab key alone, and panels with the arrow keys."""
    page.click("#tab-photons")
    page.value("document.activeElement.blur(), document.getElementById('view').focus()")
    reached = {"view"}
    for _ in range(40):
        key(page, "Tab", code=9)
        reached.add(page.value("document.activeElement.id"))
    wanted = page.value("""[...document.querySelectorAll("button, select, input, canvas, textarea")]
        .filter((e) => e.id && e.checkVisibility() && !e.disabled && e.tabIndex >= 0).map((e) => e.id)""")
    assert len(wanted) > 12 and set(wanted) <= reached, set(wanted) - reached
    page.value("document.getElementById('tab-photons').focus()")
    key(page, "ArrowRight", code=39)
    assert page.value("document.activeElement.id") == "tab-paths" and not page.value("document.getElementById('panel-paths').hidden")
    page.value("document.getElementById('film').focus(), keyhole.picture.choose(3, 3)")
    key(page, "ArrowRight", code=39)
    assert page.value("keyhole.picture.pixel.join()") == "4,3"
    # A point of a user path is put where the cross is.
    page.value("selectTab('paths'), keyhole.paths.create(), keyhole.page.emitters[0].p && keyhole.paths.begin(0), keyhole.view.camera.reset()")
    if page.value("keyhole.paths.path.points.length"):
        page.value("document.getElementById('view').focus()")
        key(page, "p", "p", 80)
        key(page, "Enter", "\r", 13)
        assert page.value("keyhole.paths.path.points.length") == 2, page.value("document.getElementById('status').textContent")
    page.value("keyhole.paths.remove()")


def check_points(page):
    """Each kind of points can be shown, by a key, and is as many as the panel says where all of them are on the page."""
    page.click("#tab-photons")
    for kind in ("refused", "importons", "ends", "records"):
        page.value(f"document.getElementById('show-{kind}').focus()")
        for phase in ("keyDown", "keyUp"):
            page.call("Input.dispatchKeyEvent", type=phase, key=" ", code="Space", text=" ", windowsVirtualKeyCode=32)
        shown = page.value(f"keyhole.view.pointSets.get('{kind}')?.count ?? 0")
        said = page.value(f"Number(document.getElementById('show-{kind}').parentElement.lastChild.textContent.replaceAll(',', ''))")
        assert shown == said if kind == "ends" else 0 < shown <= said or said == 0, (kind, shown, said)
        page.value(f"document.getElementById('show-{kind}').click()")
    page.value("keyhole.photons.show('gathered')")
    legend = page.value("document.getElementById('legend').textContent")
    missed = page.value("[...keyhole.arrays.photonKinds].filter((k) => k & 4).length")
    assert ("caustic map alone" in legend) == (missed > 0), (legend, missed)
    page.value("keyhole.photons.show('power')")


def check_record(page):
    """A click on a record of the cache tells its radius and its error."""
    page.value("keyhole.photons.show('records'), keyhole.view.camera.lookAt(keyhole.photons.others.record(0).p), keyhole.view.draw()")
    click_at(page, page.value("keyhole.photons.others.record(0).p"))
    said = page.value("document.getElementById('photon').textContent")
    assert said.startswith("Record of"), said
    page.value("document.getElementById('show-records').click(), keyhole.view.camera.reset()")


def check_warnings(page):
    """Each warning of the statistics is there, and leads to where it comes from."""
    page.click("#tab-figures")
    said = page.value("[...document.querySelectorAll('#figures .warning')].map((e) => e.firstChild.data)")
    for warning in page.value("keyhole.page.stats.warnings"):
        assert warning["text"] in said, (warning, said)
    for i in range(page.value("document.querySelectorAll('#figures .warning button').length")):
        page.value(f"selectTab('figures'), document.querySelectorAll('#figures .warning button')[{i}].click()")
        gone = page.value("document.getElementById('panel-figures').hidden")
        about = page.value(f"keyhole.warnings.list().filter((w) => PLACES[w.about] || w.path !== undefined)[{i}].about")
        layer, records = page.value("[document.getElementById('layer').value, document.getElementById('show-records').checked]")
        assert gone and (layer == LAYERS[about] if about in LAYERS else about != "records" or records), (about, layer, records)
        if about in LAYERS:  # at the worst pixel
            x, y = page.value("keyhole.picture.pixel")
            worst = page.value("""(() => { const p = keyhole.picture, e = p.errors.get(byId("layer").value), all = [];
                for (let y = 0; y < p.height; ++y) for (let x = 0; x < p.width; ++x)
                    all.push(e ? p.smoothed(e.map, x, y) : keyhole.arrays.pixelReach[y * p.width + x]);
                return [all[p.pixel[1] * p.width + p.pixel[0]], all.reduce((a, b) => Math.max(a, b))]; })()""")
            assert worst[0] == worst[1], (about, x, y, worst)
    assert not page.errors, page.errors


def check_lamps(page):
    """What is known of lamps at a pixel: chances, of which there are at most one in all."""
    lamps = page.value("""(() => { const seen = keyhole.arrays.pixelSeen.indexOf(1), w = keyhole.page.film.width;
        keyhole.picture.choose(seen % w, Math.floor(seen / w)); return keyhole.picture.light.lamps; })()""")
    told = page.value("document.querySelectorAll('#lamps li').length")
    assert told == len(lamps) and sum(lamp["chance"] for lamp in lamps) < 1 + 1e-4, lamps
    many = page.value("keyhole.page.emitters.length") > 1
    assert (len(lamps) > 0) == many, (lamps, many)


def check_pixel(page):
    """A click in the picture says where its light comes from, and the lines begin at the eye."""
    left, top, width, height = page.box("#film")
    wide, high = page.value("[keyhole.page.film.width, keyhole.page.film.height]")
    x, y = wide // 2, 4 * high // 5
    page.mouse("mousePressed", left + (x + 0.5) / wide * width, top + (y + 0.5) / high * height)
    page.mouse("mouseReleased", left + (x + 0.5) / wide * width, top + (y + 0.5) / high * height)
    assert page.value("keyhole.picture.pixel.join()") == f"{x},{y}", page.value("keyhole.picture.pixel")
    lit = page.value(f"LAYERS.some((l) => keyhole.arrays[l + 'A'][{y * wide + x}] + keyhole.arrays[l + 'B'][{y * wide + x}] > 0)")
    said = page.value("document.getElementById('answer').textContent")
    assert said.startswith("Mostly" if lit else "No light was found"), said
    rings = page.value("[(keyhole.view.lineSets.get('rings')?.count ?? 0) / 14, keyhole.picture.sources.used.size]")
    assert rings[0] == rings[1], rings
    off = page.value("Math.sqrt(distance2(keyhole.picture.light.trail[0], keyhole.page.camera.origin))")
    assert off < 1e-3 * page.value("keyhole.view.camera.size"), off


# What is too small for a finger, cut off, out of the window, or covered by another control.
FAULTS = """((least) => [...document.querySelectorAll("button, select, input, textarea, summary, [role=tab]")].flatMap((e) => {
    const of = e.matches(".checks input") ? e.parentElement : e, b = of.getBoundingClientRect();
    if (!e.checkVisibility() || b.width === 0) return [];
    const name = `${e.tagName} ${e.id || e.getAttribute("aria-label") || e.textContent}`, faults = [];
    if (b.width < least - 0.5 || b.height < least - 0.5) faults.push(`${name}: ${b.width} x ${b.height}`);
    if (b.right > e.closest("aside, main").getBoundingClientRect().right - 12) faults.push(`${name}: beyond the panel`);
    if (b.left < 0 || b.right > innerWidth + 0.5) faults.push(`${name}: from ${b.left} to ${b.right}`);
    if (e.matches("button") && e.scrollWidth > e.clientWidth + 1) faults.push(`${name}: text is cut off`);
    e.scrollIntoView({ block: "center" });
    const c = of.getBoundingClientRect(), on = document.elementFromPoint(c.left + c.width / 2, c.top + c.height / 2);
    if (!of.contains(on) && !on?.contains(of)) faults.push(`${name}: behind ${on?.outerHTML.slice(0, 80)}`);
    return faults;
}))(%d)"""

# Contrast of text with what it stands on, by WCAG 2's formula: those below 4.5.
FAINT = """(() => {
    const numbers = (c) => c.match(/[\\d.]+/g).map(Number);
    const light = (c) => numbers(c).slice(0, 3).map((x) => x / 255).map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4))
        .reduce((s, x, k) => s + x * [0.2126, 0.7152, 0.0722][k], 0);
    const ground = (e) => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor; if ((numbers(c)[3] ?? 1) > 0) return c; } return "rgb(255, 255, 255)"; };
    return [...document.querySelectorAll("body *")].filter((e) => e.checkVisibility() && !e.disabled && [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim())).flatMap((e) => {
        const [a, b] = [light(getComputedStyle(e).color), light(ground(e))].sort((x, y) => y - x), ratio = (a + 0.05) / (b + 0.05);
        return ratio < 4.5 ? [`${e.tagName} "${e.textContent.slice(0, 30)}": ${ratio.toFixed(2)}`] : [];
    });
})()"""


def check_widths(path):
    for width, dark, touch in ((360, False, True), (360, True, True), (768, True, True), (768, False, False), (1440, True, False),
                               (1440, False, True), (2560, False, False), (2560, True, True)):
        page = open_page(path, width=width, height=800, dark=dark, touch=touch)
        try:
            page.value("keyhole.picture.choose(40, 48)")
            for tab in TABS:
                page.value(f"selectTab('{tab}')")
                if tab == "paths":
                    page.value("keyhole.paths.create(), keyhole.paths.begin(0), keyhole.paths.addPoint([0, 0, 0]), keyhole.paths.update()")
                over = page.value("document.documentElement.scrollWidth - innerWidth")
                assert over <= 0, f"{over} pixels too wide at {width}, {tab}"
                faults = page.value(FAULTS % (44 if touch else 16)) + page.value(FAINT)
                assert not faults, (width, dark, touch, tab, faults)
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
        check_keyboard(page)
        check_points(page)
        check_record(page)
        check_lamps(page)
        check_warnings(page)
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


CORNERS, BEHIND = ([-0.022, 0.958, -0.5], [0.022, 0.958, -0.5], [-0.022, 1.042, -0.5]), [0.3, 0, 0.5]


def begin_path(page):
    """A path from the lamp with bounces, and a click is a corner of its opening."""
    page.click("#tab-paths")
    page.click("#new-path")
    change(page, "#field-begins-at", "0")
    change(page, "#editor input[aria-label^=largest]", "15")
    page.click("#editor [data-mode=opening]")


def make_path(page):
    """Lamp, bounces, an opening by clicking three of its corners, a place behind it."""
    begin_path(page)
    for corner in CORNERS:
        click_at(page, corner)
    click_at(page, BEHIND)
    assert not page.errors, page.errors
    return page.value("document.getElementById('yaml').value")


def squared_error(keyhole, folder, scene, seed, *more):
    out = folder / "small.exr"
    subprocess.run([keyhole, "render", scene, "--resolution", "64x48", "--method", "ipm", "-D", "light_paths=200000",
                    "-D", "spp=16", "--seed", str(seed), "-q", "--no-png", "-o", out, *more], check=True)
    found = subprocess.run([keyhole, "diff", out, folder / "1.exr", folder / "2.exr"], check=True, capture_output=True)
    return json.loads(found.stdout)["cross_trim"]


def check_opening(page):
    """A corner that is dragged stays in the opening's plane, and the other two stay where they are."""
    corners = "openingCorners(keyhole.paths.path.points[1].through)"
    before = page.value(corners)
    page.value(f"keyhole.view.camera.lookAt({corners}[0]), keyhole.view.camera.zoom(0.2), keyhole.view.draw()")
    left, top, _, _ = page.box("#view")
    x, y = page.value(f"keyhole.picking.project({corners}[1])")
    page.drag(left + x, top + y, left + x + 60, top + y + 40)
    after = page.value(corners)
    off = [max(abs(a - b) for a, b in zip(after[k], before[k])) for k in range(3)]
    assert off[1] > 0.005 and off[0] < 1e-5 and off[2] < 1e-5, (before, after)
    assert abs(after[1][2] - before[1][2]) < 1e-4, after


def check_cones(page):
    """All of a cone's rim is seen under its angle from where light leaves."""
    far = page.value("""(() => { const a = [0.1, 0.2, 0.3], b = [0.5, 1, 0.2], w = unit(sub(b, a));
        const rim = userPathDrawing([{ points: [{ p: a }, { p: b }], beta: [7], bounces: null, opening: null }], 0, []).segments.slice(1, 33);
        return Math.max(...rim.map((s) => Math.abs(Math.acos(dot(w, unit(sub(s.a, a)))) * 180 / Math.PI - 7))); })()""")
    assert far < 1e-3, far


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
        check_opening(page)
        check_cones(page)
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
