"""What the page of keyhole inspect shows is what the map and the picture hold."""
import struct

from inspect_page import click_at, key

# What a warning is about, and the layer of the picture that its way leads to.
LAYERS = {"samples": "error", "direct": "error:direct", "caustics": "error:caustic", "lookups": "reach"}


def photons_of(file):
    """The main photons of both maps as --save-map wrote them: (place, power) each."""
    data = file.read_bytes()
    counts = struct.unpack_from("<4Q", data, 40)
    maps, at = [], 96
    for part, count in enumerate(counts):
        found = []
        for i in range(count):
            x, y, z, *words = struct.unpack_from("<3f3H", data, at + 24 * i)
            exponent = (words[0] >> 12 | (words[1] >> 12 & 7) << 4) - 80 - 12  # src/photonmap/photon.h
            found.append(((x, y, z), tuple((w & 4095) * 2.0 ** exponent for w in words)))
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


def check_points(page):
    """Each kind of points can be shown, by a key, and is as many as the panel says where all of them are on the page."""
    page.click("#tab-photons")
    for kind in ("refused", "importons", "ends", "records"):
        page.value(f"document.getElementById('show-{kind}').focus()")
        key(page, " ", " ", 32)
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
