// Photons and what else is drawn as points, their colours and legends.

const BOUNCES = ["#56b4e9", "#009e73", "#e69f00", "#d55e00", "#cc79a7", "#8a5cd1"];
const UNKNOWN = colourOf("#8f8f8f"), MISSED = BLUE;
// Points are small: the darkest colours would be lost among surfaces.
const POINT_RAMP_FROM = 0.3;
const pointRamp = (t) => ramp(POINT_RAMP_FROM + (1 - POINT_RAMP_FROM) * Math.min(1, Math.max(0, t)));
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
    this.others = new OtherPoints(view);
    this.shown = { photons: true, refused: false, importons: false, ends: false, records: false };
    const c = page.counts;
    this.checks = [
      ["photons", "Photons", whole(c.global.mainPhotons + c.caustic.mainPhotons)], ["refused", "Thrown away", whole(c.refused)],
      ["importons", "Importons", whole(c.importons)],
      ["ends", "Ends of gather rays", whole(this.others.ends.length)], ["records", "Records of the cache", whole(c.records)]];
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
      case "gathered": return arrays.photonKinds[i] & 4 ? MISSED : ORANGE;
      case "sampler": return arrays.photonKinds[i] & 2 ? GREEN : ORANGE;
      default: return pointRamp(Math.log(Math.max(this.powers[i], this.least) / this.least) / Math.log(this.most / this.least));
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
    this.others.update(this.shown);
    this.legend();
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
    } else if (by === "gathered") {
      const missed = this.indices.filter((i) => arrays.photonKinds[i] & 4).length;
      item(ORANGE, page.counts.gatheredEverywhere ? "gather rays count everywhere" : "where gather rays come", this.indices.length - missed);
      if (missed > 0) item(MISSED, "where they don't: in the caustic map alone", missed);
    } else if (this.indices.length > 0)
      items.push(element("li", {}, watts(this.least), element("span", { class: "ramp", style: rampStyle(POINT_RAMP_FROM) }), watts(this.most)));
    items.push(...this.others.legend(this.shown));
    byId("legend").replaceChildren(...items);
  }
  // Draws the path of the photon that is drawn nearest to a place of the page. False: there is none.
  clicked(picking, x, y, reach = 8) {
    if (this.shown.records && this.others.clicked(picking, x, y, reach)) return true;
    if (!this.shown.photons) return false;
    const at = picking.nearest(this.places, x, y, reach, (k) => arrays.photonTrails[this.indices[k]] >= 0);
    if (at < 0) return false;
    this.select(this.indices[at]);
    return true;
  }
  // The strongest of those with a path.
  selectStrongest() {
    let best = -1;
    for (const i of this.indices) if (arrays.photonTrails[i] >= 0 && (best < 0 || this.powers[i] > this.powers[best])) best = i;
    if (best >= 0) this.select(best);
    return best;
  }
  // By name: a kind of points to be shown, or what photons are coloured by.
  show(name) {
    if (name in this.shown) byId("show-" + name).checked = this.shown[name] = true;
    else byId("colour").value = name;
    this.update();
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
