// The picture, its errors, and where the light of a pixel comes from.

const LAYERS = ["direct", "indirect", "caustic"];

class PicturePanel {
  constructor(view) {
    const { width, height } = page.film;
    Object.assign(this, { view, width, height, canvas: byId("film"), pixel: null });
    Object.assign(this.canvas, { width, height });
    this.image = new Image();
    this.image.src = page.film.picture;
    const options = [["picture", "the picture"], ["error", "its error"], ...LAYERS.map((l) => ["error:" + l, "error of " + { direct: "direct light", indirect: "indirect light", caustic: "caustics" }[l]]),
      ["reach", "reach of the photons' estimates"]];
    byId("layer").append(...options.map(([value, text]) => element("option", { value, text })));
    byId("layer").addEventListener("change", () => this.draw());
    this.errors = new Map(["error", ...LAYERS.map((l) => "error:" + l)].map((name) => [name, this.error(name)]));
    this.canvas.addEventListener("pointerdown", (e) => this.point(e));
    this.canvas.addEventListener("pointermove", (e) => { if (e.buttons) this.point(e); });
    this.canvas.addEventListener("keydown", (e) => this.key(e));
    this.ready = this.image.decode().then(() => this.draw());
  }
  values(layer, end, i) { return layer === "error" ? LAYERS.reduce((s, l) => s + arrays[l + end][i], 0) : arrays[layer.slice(6) + end][i]; }
  // Standard error of the mean of both renders, relative to the picture around: {map, rms}.
  error(name) {
    const n = this.width * this.height, all = (i) => (this.values("error", "A", i) + this.values("error", "B", i)) / 2;
    let mean = 0, sum = 0;
    for (let i = 0; i < n; ++i) mean += all(i) / n;
    const map = new Float32Array(n);
    for (let i = 0; i < n; ++i) {
      map[i] = (this.values(name, "A", i) - this.values(name, "B", i)) / 2 / (all(i) + 0.1 * mean || 1);
      sum += map[i] ** 2 / n;
    }
    return { map, rms: Math.sqrt(sum) };
  }
  // Root of the mean square of a pixel and its neighbours: of two values alone an error is a guess.
  smoothed(map, x, y) {
    let sum = 0, n = 0;
    for (let v = Math.max(0, y - 2); v <= Math.min(this.height - 1, y + 2); ++v)
      for (let u = Math.max(0, x - 2); u <= Math.min(this.width - 1, x + 2); ++u, ++n) sum += map[v * this.width + u] ** 2;
    return Math.sqrt(sum / n);
  }
  draw() {
    const context = this.canvas.getContext("2d"), name = byId("layer").value, scale = byId("scale");
    scale.hidden = name === "picture";
    if (name === "picture") return context.drawImage(this.image, 0, 0);
    const image = context.createImageData(this.width, this.height), error = this.errors.get(name);
    const reach = [...arrays.pixelReach].filter((r) => r > 0).sort((a, b) => a - b), widest = reach[Math.floor(0.99 * reach.length)] ?? 1;
    for (let y = 0; y < this.height; ++y)
      for (let x = 0; x < this.width; ++x) {
        const i = y * this.width + x;
        const t = error ? Math.sqrt(Math.min(1, this.smoothed(error.map, x, y))) : arrays.pixelReach[i] / widest;
        image.data.set([...ramp(t).map((c) => 255 * c), 255], 4 * i);
      }
    context.putImageData(image, 0, 0);
    scale.replaceChildren("0", element("span", { class: "ramp", style: rampStyle() }), error ? "100 %" : metres(widest),
      error ? ` (root mean square ${digits(100 * error.rms, 2)} %)` : "");
  }
  point(e) {
    const box = this.canvas.getBoundingClientRect();
    this.choose(Math.floor((e.clientX - box.left) / box.width * this.width), Math.floor((e.clientY - box.top) / box.height * this.height));
  }
  key(e) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
    if (!step) return;
    e.preventDefault();
    const from = this.pixel ?? [Math.floor(this.width / 2), Math.floor(this.height / 2)], k = e.shiftKey ? 10 : 1;
    this.choose(from[0] + k * step[0], from[1] + k * step[1]);
  }
  choose(px, py) {
    const x = Math.min(this.width - 1, Math.max(0, px)), y = Math.min(this.height - 1, Math.max(0, py));
    this.pixel = [x, y];
    const mark = byId("mark");
    mark.hidden = false;
    mark.style.left = (100 * (x + 0.5)) / this.width + "%";
    mark.style.top = (100 * (y + 0.5)) / this.height + "%";
    this.light = pixelLight(x, y);
    this.sources = photonsBehind(this.light);
    const means = LAYERS.map((l) => arrays[l + "A"][y * this.width + x] + arrays[l + "B"][y * this.width + x]);
    this.view.setLines("pixel", pixelSegments(this.light, this.sources, means[2] / (means[0] + means[1] + means[2] || 1)));
    this.tell(x, y);
    selectTab("pixel");
  }
  tell(x, y) {
    const i = y * this.width + x, light = LAYERS.map((l) => (arrays[l + "A"][i] + arrays[l + "B"][i]) / 2), all = light.reduce((a, b) => a + b, 0);
    byId("pixel-hint").hidden = true;
    const box = byId("answer");
    if (!(all > 0)) return box.replaceChildren(element("p", { class: "big", text: `No light was found at pixel ${x}, ${y}` }));
    const names = { direct: "straight from a lamp", indirect: "scattered by other surfaces", caustic: "by photons of the caustic map" };
    const colours = [BLUE, ORANGE, GREEN].map(css);
    const shares = LAYERS.map((l, k) => ({ name: names[l], share: light[k] / all, colour: colours[k] }));
    const main = [...shares].sort((a, b) => b.share - a.share)[0];
    box.replaceChildren(
      element("p", { class: "big", text: `Mostly ${main.name}` }),
      element("div", { class: "bar", role: "img", "aria-label": shares.map((s) => `${percent(s.share)} ${s.name}`).join(", ") },
        ...shares.map((s) => element("span", { style: `width: ${100 * s.share}%; background: ${s.colour}` }))),
      element("ul", { class: "legend" }, ...shares.map((s) => element("li", {}, element("span", { class: "dot", style: `background: ${s.colour}` }), s.name, element("span", { class: "note", text: percent(s.share) })))),
      ...this.sourcesText(),
      ...(shares[2].share > 0.02 ? [element("p", { class: "note", text: "The caustic map holds light that came through glass or mirrors, and what gather rays would hardly find. Green lines are paths of its photons." })] : []),
      element("p", { class: "note", text: `Pixel ${x}, ${y}: luminance ${digits(all)} W/(m² sr), standard error ${percent(this.smoothed(this.errors.get("error").map, x, y))}` +
        (this.light.reach > 0 ? `; photons within ${metres(this.light.reach)} make an estimate here.` : ".") }));
    say(`Pixel ${x}, ${y}: mostly ${main.name}`);
  }
  sourcesText() {
    const { lamps, once, more } = this.sources, total = once + more;
    if (!(total > 0)) return this.light.direct.length > 0 ? [element("p", { text: "Blue lines lead to the lamps in sight." })] : [];
    const by = [...lamps].sort((a, b) => b[1] - a[1]).filter(([, w]) => w > 0.02 * total), share = once / total;
    const names = by.slice(0, 2).map(([e, w]) => (w > 0.98 * total ? "" : percent(w / total) + " ") + "from " + (e < 0 ? "where nothing is known" : emitterName(e)));
    const way = share < 0.02 ? "by way of several surfaces" : share > 0.98 ? "by way of one surface" : `${percent(share)} by way of one surface, the rest of several`;
    return [element("p", { text: `What other surfaces scatter here came ${names.join(", ")}; ${way}.` }),
      element("p", { class: "note", text: "Orange lines show from where the light reaches this place, yellow ones how it came there from a lamp, blue ones lead to lamps in sight." })];
  }
}

// Where the light came from that gather rays found: straight from a lamp, or, for the rest, as the photons nearest to
// their ends did, by power. {lamps: light by emitter, once, more: light by way of one surface, of more; trails}.
function photonsBehind(light) {
  const found = { lamps: new Map(), once: 0, more: 0, trails: [], caustic: [] };
  const count = (emitter, value) => found.lamps.set(emitter, (found.lamps.get(emitter) ?? 0) + value);
  for (const end of light.gather) {
    const once = Math.min(end.value, end.fromLamp), more = end.value - once;
    if (once > 0) count(end.emitter, once);
    found.once += once;
    found.more += more;
    if (!(more > 0)) continue;
    const near = nearestPhotons(end.p, light.trail[light.trail.length - 1], 12), power = near.reduce((s, i) => s + photonPower(i), 0);
    if (near.length === 0) count(-1, more);
    for (const i of near) count(arrays.photonEmitters[i] === 65535 ? -1 : arrays.photonEmitters[i], (more * photonPower(i)) / power);
    const drawn = near.find((i) => arrays.photonTrails[i] >= 0);
    if (drawn !== undefined) found.trails.push({ photon: drawn, value: more });
  }
  found.trails.sort((a, b) => b.value - a.value);
  const here = light.trail[light.trail.length - 1];
  if (light.seen && light.reach > 0) // farther off photons have no say
    found.caustic = nearestPhotons(here, light.trail[light.trail.length - 2], 20, true).filter((i) => arrays.photonTrails[i] >= 0 && distance2(photonPlace(i), here) < (4 * light.reach) ** 2).slice(0, 3);
  return found;
}

// The photons of a map nearest to a place, the nearest first, that lie on the side where `from` is.
function nearestPhotons(p, from, most, caustic = false) {
  const w = sub(from, p), normals = arrays.photonNormals;
  const near = [];
  for (let i = 0; i < photonCount(); ++i) {
    if (((arrays.photonKinds[i] & 1) !== 0) !== caustic) continue;
    const d = (arrays.photons[3 * i] - p[0]) ** 2 + (arrays.photons[3 * i + 1] - p[1]) ** 2 + (arrays.photons[3 * i + 2] - p[2]) ** 2;
    if (near.length === most && d >= near[most - 1][0]) continue;
    if (!(w[0] * normals[3 * i] + w[1] * normals[3 * i + 1] + w[2] * normals[3 * i + 2] > 0)) continue;
    let k = near.length;
    while (k > 0 && near[k - 1][0] > d) --k;
    near.splice(k, 0, [d, i]);
    near.length = Math.min(near.length, most);
  }
  return near.map(([, i]) => i);
}

// `share`: of the pixel's light, by the caustic map.
function pixelSegments(light, sources, share) {
  const segments = [], at = light.trail[light.trail.length - 1];
  for (let k = 0; k + 1 < light.trail.length; ++k) segments.push({ a: light.trail[k], b: light.trail[k + 1], colour: WHITE, width: 3 });
  const most = Math.max(...light.gather.map((g) => g.value), ...light.direct.map((g) => g.value), 1e-30);
  for (const g of light.direct) segments.push({ a: at, b: g.p, colour: BLUE, width: 1 + 2 * Math.sqrt(g.value / most) });
  for (const g of light.gather) segments.push({ a: at, b: g.p, colour: ORANGE, width: 0.8 + 2.4 * Math.sqrt(g.value / most) });
  for (const g of light.gather) if (g.fromLamp > 0.05 * most) segments.push({ a: g.lamp, b: g.p, colour: YELLOW, width: 2 });
  for (const s of sources.trails.filter((t) => t.value > 0.05 * most).slice(0, 3)) {
    const path = trail(arrays.photonTrails[s.photon]);
    segments.push(...trailSegments({ points: path.points.slice(0, path.photon + 1), photon: path.photon }, 2));
  }
  for (const i of share > 0.02 ? sources.caustic : []) {
    const path = trail(arrays.photonTrails[i]);
    for (let k = 0; k < path.photon; ++k) segments.push({ a: path.points[k], b: path.points[k + 1], colour: GREEN, width: 2 });
  }
  return segments;
}
