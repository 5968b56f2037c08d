// Photons and what else is drawn as points, their colours and legends.

const BOUNCES = ["#56b4e9", "#009e73", "#e69f00", "#d55e00", "#cc79a7", "#8a5cd1"];
const UNKNOWN = colourOf("#8f8f8f");
const emitterName = (index) => {
  const at = page.emitters.findIndex((e) => e.index === index);
  return at < 0 ? "another lamp" : `${page.emitters[at].p ? "lamp" : "light from afar"} ${at + 1} (${page.emitters[at].kind}, ${watts(page.emitters[at].power)})`;
};
const emitterColour = (index) => {
  const at = page.emitters.findIndex((e) => e.index === index);
  return colourOf(COLOURS[at < 0 ? COLOURS.length - 1 : at % COLOURS.length]);
};
const bouncesBefore = (i) => arrays.photonScatterings[i];
const bounceColour = (n) => (n === 255 ? UNKNOWN : colourOf(BOUNCES[Math.min(n, BOUNCES.length) - 1] ?? BOUNCES[0]));
const samplerOf = (i) => (arrays.photonKinds[i] & 2 ? "along a user path" : page.stats.method);

class PhotonPanel {
  constructor(view) {
    this.view = view;
    this.shown = { photons: true, refused: false, importons: false, records: false };
    const c = page.counts;
    this.checks = [
      ["photons", "Photons", whole(c.global.mainPhotons + c.caustic.mainPhotons)], ["refused", "Thrown away", whole(c.refused)],
      ["importons", "Importons", whole(c.importons)], ["records", "Records of the cache", whole(c.records)]];
    for (const [key, name, count] of this.checks)
      byId("layers").append(element("label", {}, element("input", { type: "checkbox", id: "show-" + key, checked: this.shown[key] ? "" : null,
        onchange: (e) => { this.shown[key] = e.target.checked; this.update(); } }), name, element("span", { class: "note", text: count })));
    for (const id of ["colour", "map"]) byId(id).addEventListener("change", () => this.update());
    byId("size").addEventListener("input", (e) => { view.size = Number(e.target.value); view.redraw(); });
    if (c.caustic.mainPhotons === 0) byId("map").disabled = true;
    this.powers = Float32Array.from({ length: photonCount() }, (_, i) => photonPower(i));
    const sorted = [...this.powers].filter((p) => p > 0).sort((a, b) => a - b);
    this.least = sorted[Math.floor(0.02 * sorted.length)] ?? 1;
    this.most = Math.max(sorted[Math.floor(0.995 * sorted.length)] ?? 1, 1.0001 * this.least);
    this.update();
  }
  ofMap(i) {
    const map = byId("map").value;
    return map === "both" || (map === "caustic") === ((arrays.photonKinds[i] & 1) !== 0);
  }
  colour(i) {
    switch (byId("colour").value) {
      case "bounces": return bounceColour(bouncesBefore(i));
      case "emitter": return arrays.photonEmitters[i] === 65535 ? UNKNOWN : emitterColour(arrays.photonEmitters[i]);
      case "sampler": return arrays.photonKinds[i] & 2 ? GREEN : ORANGE;
      default: return ramp(Math.log(Math.max(this.powers[i], this.least) / this.least) / Math.log(this.most / this.least));
    }
  }
  update() {
    const places = [], colours = [], sides = [];
    this.indices = [];
    if (this.shown.photons)
      for (let i = 0; i < photonCount(); ++i)
        if (this.ofMap(i)) {
          this.indices.push(i);
          places.push(...arrays.photons.subarray(3 * i, 3 * i + 3));
          colours.push(...this.colour(i));
          sides.push(...arrays.photonNormals.subarray(3 * i, 3 * i + 3));
        }
    this.places = new Float32Array(places);
    this.view.setPoints("photons", this.places, new Float32Array(colours), null, new Int8Array(sides));
    this.others();
    this.legend();
  }
  others() {
    const flat = (n, colour) => Float32Array.from({ length: 3 * n }, (_, i) => colour[i % 3]);
    const show = (key, array, stride, colour) => {
      const places = this.shown[key] ? decodedPlaces(page.surface, array, stride) : null;
      this.view.setPoints(key, places, places && flat(places.length / 3, colour));
    };
    show("refused", arrays.refused, 3, colourOf("#a33c3c"));
    show("importons", arrays.importons, 4, BLUE);
    const n = arrays.recordFigures.length / 3, figure = (i, k) => arrays.recordFigures[3 * i + k];
    const places = this.shown.records ? decodedPlaces(page.surface, arrays.records, 6) : null;
    this.view.setPoints("records", places, places && new Float32Array(Array.from({ length: n }, (_, i) => ramp(figure(i, 1) / 0.5)).flat()),
      Float32Array.from({ length: n }, (_, i) => figure(i, 0)));
  }
  legend() {
    const counts = new Map(), count = (key) => counts.set(key, (counts.get(key) ?? 0) + 1);
    const by = byId("colour").value, items = [], each = (this.indices.length || 1);
    const item = (colour, name, n) => items.push(element("li", {}, element("span", { class: "dot", style: `background: ${css(colour)}` }), name,
      element("span", { class: "note", text: n === undefined ? "" : percent(n / each) })));
    if (by === "bounces") {
      this.indices.forEach((i) => count(bouncesBefore(i) === 255 ? 255 : Math.min(bouncesBefore(i), BOUNCES.length)));
      for (const [n, number] of [...counts].sort((a, b) => a[0] - b[0]))
        item(bounceColour(n), n === 255 ? "not told by this sampler" : n === BOUNCES.length ? `${n} or more` : String(n), number);
    } else if (by === "emitter") {
      this.indices.forEach((i) => count(arrays.photonEmitters[i]));
      for (const [e, number] of [...counts].sort((a, b) => b[1] - a[1]).slice(0, 8))
        item(e === 65535 ? UNKNOWN : emitterColour(e), e === 65535 ? "not told by this sampler" : emitterName(e), number);
    } else if (by === "sampler") {
      this.indices.forEach((i) => count(samplerOf(i)));
      for (const [name, number] of counts) item(name === "along a user path" ? GREEN : ORANGE, name, number);
    } else if (this.indices.length > 0)
      items.push(element("li", {}, watts(this.least), element("span", { class: "ramp", style: rampStyle() }), watts(this.most)));
    if (this.shown.records)
      items.push(element("li", {}, "records: noise 0", element("span", { class: "ramp", style: rampStyle() }), "50 %"));
    byId("legend").replaceChildren(...items);
  }
  // Draws the path of the photon that is drawn nearest to a place of the page. False: there is none.
  clicked(picking, x, y) {
    if (!this.shown.photons) return false;
    const at = picking.nearest(this.places, x, y, 8, (k) => arrays.photonTrails[this.indices[k]] >= 0);
    if (at < 0) return false;
    this.select(this.indices[at]);
    return true;
  }
  select(i) {
    const path = trail(arrays.photonTrails[i]), n = bouncesBefore(i);
    this.view.setLines("photon", trailSegments(path, 3));
    byId("photon").replaceChildren(element("p", { class: "big", text: `Photon of ${watts(this.powers[i])}` }),
      element("p", { text: `From ${emitterName(arrays.photonEmitters[i])}; scattered ${n === 1 ? "once" : n + " times"} before it arrived at (${coordinates(photonPlace(i))}). ` +
        `${arrays.photonKinds[i] & 1 ? "Caustic" : "Global"} map, ${samplerOf(i)}.` }));
    say(`Photon of ${watts(this.powers[i])}: scattered ${n === 1 ? "once" : n + " times"} before`);
    this.selected = i;
  }
}

// A photon's path: yellow as far as the photon, white from there to the eye.
function trailSegments(path, width) {
  const segments = [];
  for (let k = 0; k + 1 < path.points.length; ++k)
    segments.push({ a: path.points[k], b: path.points[k + 1], colour: k < path.photon ? YELLOW : WHITE, width });
  return segments;
}
