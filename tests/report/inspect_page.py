"""Pages of keyhole inspect, and what a person does on them."""
import json
import subprocess
import time

import browser

QUICK = ["--resolution", "80x60", "-D", "spp=1", "-D", "light_paths=40000", "-D", "cache_rays=50", "-D", "importons=5000"]
TABS = ("pixel", "photons", "paths", "figures")


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


def key(page, name, text=None, code=0):
    for phase in ("keyDown", "keyUp"):
        page.call("Input.dispatchKeyEvent", type=phase, key=name, code=name, windowsVirtualKeyCode=code,
                  **({"text": text} if text and phase == "keyDown" else {}))


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
