"""Controls of the page of keyhole inspect: names, keys, fingers, widths and colours."""
from inspect_page import TABS, key, open_page

CONTROLS = {"button", "combobox", "textbox", "slider", "checkbox", "spinbutton", "tab", "application"}


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


def check_taps(page):
    """A finger chooses a pixel, and adds a point to a user path."""
    left, top, width, height = page.box("#film")
    page.tap(left + 0.255 * width, top + 0.755 * height)  # below the view, which stays at the top
    assert page.value("keyhole.picture.pixel.join()") == "20,45", page.value("keyhole.picture.pixel")
    page.value("selectTab('paths'), keyhole.paths.create(), keyhole.paths.begin(0), keyhole.paths.setMode('point'), scrollTo(0, 0)")
    left, top, width, height = page.box("#view")
    page.tap(left + width / 2, top + 0.7 * height)
    assert page.value("keyhole.paths.path.points.length") == 2, "a tap adds no point"


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
            if touch:
                check_taps(page)
            background = page.value("getComputedStyle(document.getElementById('stage')).backgroundColor")
            assert (int(background[4:].split(",")[0]) < 60) == dark, background
        finally:
            page.close()
