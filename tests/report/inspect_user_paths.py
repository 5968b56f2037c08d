"""User paths made by clicking on the page of keyhole inspect, and what they bring."""
import json
import subprocess

from inspect_page import QUICK, change, click_at, inspect, open_page

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
