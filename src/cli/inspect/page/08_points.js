// What is drawn as points beside photons: where they were thrown away, importons, ends of gather rays, and records of
// the irradiance cache.

const REFUSED = colourOf("#e05a5a"), NOISIEST = 0.5;

// Indices of gather rays that end in the scene. Those that were never sent end where they would have begun.
function gatherEnds() {
  const codes = arrays.pixelGather, { lower, upper } = page.surface, list = [];
  const pixels = page.film.width * page.film.height, each = codes.length / 9 / pixels;
  for (let i = 0; i < codes.length / 9; ++i) {
    const begin = 3 * (arrays.pixelStarts[Math.floor(i / each) + 1] - 1), p = place(page.air, codes, i, 9);
    const sent = [0, 1, 2].some((k) => codes[9 * i + k] !== arrays.pixelTrails[begin + k]);
    if (sent && p.every((x, k) => x >= lower[k] - 1e-3 * (1 + upper[k] - lower[k]) && x <= upper[k] + 1e-3 * (1 + upper[k] - lower[k]))) list.push(i);
  }
  return list;
}

class OtherPoints {
  constructor(view) {
    this.view = view;
    this.ends = gatherEnds();
    this.lit = this.ends.filter((i) => arrays.pixelGather[9 * i + 3] > 0).length;
    this.records = decodedPlaces(page.surface, arrays.records, 6);
  }
  record(i) {
    const [radius, noise, irradiance] = arrays.recordFigures.subarray(3 * i, 3 * i + 3);
    const p = [...this.records.subarray(3 * i, 3 * i + 3)];
    return { p, n: unit(sub(place(page.surface, arrays.records, 2 * i + 1), p)), radius, noise, irradiance };
  }
  update(shown) {
    const flat = (n, colour) => Float32Array.from({ length: 3 * n }, (_, i) => colour[i % 3]);
    const show = (key, array, stride, colour) => {
      const places = shown[key] ? decodedPlaces(page.surface, array, stride) : null;
      this.view.setPoints(key, places, places && flat(places.length / 3, colour));
    };
    show("refused", arrays.refused, 3, REFUSED);
    show("importons", arrays.importons, 4, BLUE);
    this.view.setPoints("ends", shown.ends ? new Float32Array(this.ends.flatMap((i) => place(page.air, arrays.pixelGather, i, 9))) : null,
      shown.ends && new Float32Array(this.ends.flatMap((i) => (arrays.pixelGather[9 * i + 3] > 0 ? GREEN : UNKNOWN))));
    const n = this.records.length / 3, list = Array.from({ length: n }, (_, i) => this.record(i));
    const colour = (r) => ramp(r.noise / NOISIEST);
    this.view.setPoints("records", shown.records ? this.records : null, new Float32Array(list.flatMap(colour)));
    this.view.setLines("records", shown.records ? list.flatMap((r) => ring(r.p, r.n, r.radius, colour(r), 1.2, n > 5000 ? 8 : 14)) : [], 0);
  }
  legend(shown) {
    const item = (colour, name, note = "") => element("li", {}, element("span", { class: "dot", style: `background: ${css(colour)}` }), name, element("span", { class: "note", text: note }));
    return [...(shown.refused ? [item(REFUSED, "light arrived and was thrown away")] : []),
      ...(shown.importons ? [item(BLUE, "importons: where light would matter")] : []),
      ...(shown.ends ? [item(GREEN, "gather rays that found light", percent(this.lit / this.ends.length)), item(UNKNOWN, "that found none", percent(1 - this.lit / this.ends.length))] : []),
      ...(shown.records ? [element("li", {}, "records: noise 0", element("span", { class: "ramp", style: rampStyle() }), percent(NOISIEST))] : [])];
  }
  get noisiestRecord() {
    const noise = (i) => arrays.recordFigures[3 * i + 1];
    return Array.from({ length: this.records.length / 3 }, (_, i) => i).reduce((a, b) => (a < 0 || noise(b) > noise(a) ? b : a), -1);
  }
  // Tells of the record that is drawn nearest to a place of the page. False: there is none.
  clicked(picking, x, y, reach) {
    const at = picking.nearest(this.records, x, y, reach);
    if (at >= 0) this.tell(at);
    return at >= 0;
  }
  tell(i) {
    const r = this.record(i), text = `Light within ${metres(r.radius)} is taken from it; it is known to ${percent(r.noise)} (standard error).`;
    byId("photon").replaceChildren(element("p", { class: "big", text: `Record of ${digits(r.irradiance)} W/m²` }), element("p", { text: `${text} At (${coordinates(r.p)}).` }));
    say("Record: " + text);
  }
}
