// Figures of the preview, and its warnings.

function table(head, rows) {
  return element("table", {}, element("thead", {}, element("tr", {}, ...head.map((h) => element("th", { scope: "col", text: h })))),
    element("tbody", {}, ...rows.map((r) => element("tr", {}, ...r.map((c) => element("td", { text: c }))))));
}

function photonFigures() {
  const { global, caustic, refused } = page.counts, s = page.stats, found = s.values["photons before storing"];
  const kept = global.mainPhotons + global.pilots + caustic.mainPhotons + caustic.pilots;
  const parts = [element("h2", { text: "Photons" }), table(["map", "photons", "pilots", "power"], [["global", global], ["caustic", caustic]].map(([name, m]) => [name, whole(m.mainPhotons), whole(m.pilots), watts(m.power)]))];
  const says = [`${bytes(s.photon_bytes)} used of ${bytes(s.photonMemory)}.`];
  if (found > 0) says.push(`Of ${whole(found)} that could have been stored ${percent(kept / found)} were kept.`);
  if (s.lookups) says.push(`An estimate finds ${digits(s.lookups.found, 2)} photons, as good as ${digits(s.lookups.effective, 2)} equal ones; ${percent(s.lookups.share)} of those it looks for.`);
  if (s.ofBrightest !== undefined) says.push(`The brightest 0.1 % carry ${percent(s.ofBrightest)} of the power.`);
  return [...parts, element("p", { text: says.join(" ") })];
}

function showFigures(picture, warnings) {
  const s = page.stats, error = (name) => digits(100 * picture.errors.get(name).rms, 2) + " %";
  byId("figures").replaceChildren(
    ...warnings.elements(),
    element("h2", { text: "Error" }),
    table(["layer", "standard error"], [["picture", error("error")], ["direct light", error("error:direct")], ["indirect light", error("error:indirect")], ["caustics", error("error:caustic")]]),
    ...photonFigures(),
    element("h2", { text: "Time" }),
    table(["stage", "CPU s", "rays"], s.stages.map((stage) => [stage.name, digits(stage.cpu_seconds, 2), whole(stage.rays)])),
    ...(s.remarks.length > 0 ? [element("h2", { text: "Choices" }), ...s.remarks.map((r) => element("p", { text: r }))] : []),
    element("details", {}, element("summary", { text: "Settings" }), element("p", { class: "note", text: s.settings })));
}
