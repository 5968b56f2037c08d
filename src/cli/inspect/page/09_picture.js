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
  // Chooses a layer, and the pixel that is the worst in it.
  showWorst(layer) {
    byId("layer").value = layer;
    this.draw();
    const error = this.errors.get(layer);
    let worst = [0, 0], most = -1;
    for (let y = 0; y < this.height; ++y)
      for (let x = 0; x < this.width; ++x) {
        const value = error ? this.smoothed(error.map, x, y) : arrays.pixelReach[y * this.width + x];
        if (value > most) [most, worst] = [value, [x, y]];
      }
    this.choose(...worst);
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
    this.markPhotons();
    this.view.setLines("pixel", pixelSegments(this.light, this.sources, means[2] / (means[0] + means[1] + means[2] || 1)));
    this.tell(x, y);
    selectTab("pixel");
  }
  // Rings around the photons that what is said of the pixel comes from.
  markPhotons() {
    const size = this.view.camera.size, normal = (i) => unit([...arrays.photonNormals.subarray(3 * i, 3 * i + 3)]);
    this.view.setLines("rings", [...this.sources.used].flatMap((i) =>
      ring(add(photonPlace(i), scaled(normal(i), 0.001 * size)), normal(i), 0.005 * size, arrays.photonKinds[i] & 1 ? GREEN : YELLOW, 1.5)));
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
      ...this.lampsText(),
      ...(shares[2].share > 0.02 ? [element("p", { class: "note", text: "The caustic map holds light that came through glass or mirrors, and what gather rays would hardly find. Green lines are paths of its photons." })] : []),
      element("p", { class: "note", text: `Pixel ${x}, ${y}: luminance ${digits(all)} W/(m² sr), standard error ${percent(this.smoothed(this.errors.get("error").map, x, y))}` +
        (this.light.reach > 0 ? `; photons within ${metres(this.light.reach)} make an estimate here.` : ".") }));
    say(`Pixel ${x}, ${y}: mostly ${main.name}`);
  }
  // What is known here of lamps before a shadow ray is sent.
  lampsText() {
    const { lamps } = this.light;
    if (lamps.length === 0) return [];
    return [element("p", { text: `Shadow rays from here go to${page.counts.learnedDirectLight ? ", as was learned" : " (by size and distance; nothing was learned)"}:` }),
      element("ul", { class: "legend", id: "lamps" }, ...lamps.map((l) => element("li", {}, element("span", { class: "dot", style: `background: ${css(emitterColour(l.emitter))}` }),
        emitterName(l.emitter), element("span", { class: "note", text: percent(l.chance) })))),
      ...(lamps.some((l) => l.towards.length > 0) ? [element("p", { class: "note", text: "Pale short lines are directions to the sky, as they were learned." })] : [])];
  }
  sourcesText() {
    const { lamps, once, more } = this.sources, total = once + more;
    if (!(total > 0)) return this.light.direct.length > 0 ? [element("p", { text: "Blue lines lead to the lamps in sight." })] : [];
    const by = [...lamps].sort((a, b) => b[1] - a[1]).filter(([, w]) => w > 0.02 * total), share = once / total;
    const names = by.slice(0, 2).map(([e, w]) => (w > 0.98 * total ? "" : percent(w / total) + " ") + "from " + (e < 0 ? "where nothing is known" : emitterName(e)));
    const way = share < 0.02 ? "by way of several surfaces" : share > 0.98 ? "by way of one surface" : `${percent(share)} by way of one surface, the rest of several`;
    return [element("p", { text: `What other surfaces scatter here came ${names.join(", ")}; ${way}.` }),
      element("p", { class: "note", text: "Orange lines show from where the light reaches this place, yellow ones how it came there from a lamp, blue ones lead to lamps in sight." +
        (this.sources.used.size > 0 ? ` Rings are ${whole(this.sources.used.size)} photons that say so.` : "") })];
  }
}
