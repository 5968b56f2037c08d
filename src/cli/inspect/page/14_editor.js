// The fields of a user path.

function field(label, input) {
  const id = "field-" + label.toLowerCase().replaceAll(/[^a-z]+/g, "-");
  input.id = id;
  return element("div", { class: "row" }, element("label", { for: id, text: label }), input);
}

function lampChoice(panel) {
  const lamps = page.emitters.map((e, i) => [e, i]).filter(([e]) => e.p);
  const select = element("select", { onchange: (e) => { if (e.target.value !== "") panel.begin(Number(e.target.value)); } },
    element("option", { value: "", text: lamps.length > 0 ? "choose a lamp" : "no lamp has a place here" }),
    ...lamps.map(([e, i]) => element("option", { value: i, text: `${i + 1}: ${e.kind}, ${watts(e.power)}`, selected: panel.path.points[0] && distance2(panel.path.points[0].p, e.p) < 1e-8 ? "" : null })));
  return field("Begins at", select);
}

function bounceFields(panel) {
  const path = panel.path, input = (k, name) => element("input", { type: "number", min: 0, max: 24, value: path.bounces ? path.bounces[k] : 0, "aria-label": name,
    onchange: (e) => {
      const n = Math.max(0, Math.min(24, Math.round(Number(e.target.value)) || 0)), now = path.bounces ?? [0, 0], next = [...now];
      next[k] = n;
      if (k === 0) next[1] = Math.max(next[1], n);
      else next[0] = Math.min(Math.max(next[0], n > 0 ? 1 : 0), n);
      path.bounces = next[1] > 0 ? [Math.max(1, next[0]), next[1]] : null;
      panel.update();
    } });
  const row = element("div", { class: "row", role: "group", "aria-label": "Bounces before the opening" }, element("label", { text: "Bounces" }), input(0, "least number of bounces"), "to", input(1, "largest number of bounces"));
  row.firstChild.setAttribute("for", "bounces-least");
  row.querySelector("input").id = "bounces-least";
  return row;
}

function pointRows(panel) {
  const rows = [], path = panel.path;
  const opening = (o, drop) => rows.push(element("li", {}, element("span", { class: "dot", style: `background: ${css(GREEN)}` }),
    element("span", { class: "place", text: `opening, ${metres(length(o.u))} × ${metres(length(o.v))}` }), element("button", { "aria-label": "Delete the opening", text: "×", onclick: drop })));
  path.points.forEach((point, i) => {
    if (point.through) opening(point.through, () => { delete point.through; panel.update(); });
    rows.push(element("li", {}, element("span", { class: "dot", style: `background: ${i === 0 ? css(YELLOW) : COLOURS[panel.current % COLOURS.length]}` }),
      element("span", { text: i === 0 ? "lamp" : "point " + (i + 1) }),
      element("input", { type: "text", class: "place", value: point.p.map(number).join(", "), "aria-label": `Place of point ${i + 1}`, onchange: (e) => {
        const p = e.target.value.split(",").map(Number);
        if (p.length === 3 && p.every(Number.isFinite)) point.p = p;
        panel.update();
      } }),
      element("button", { "aria-label": `Delete point ${i + 1}`, text: "×", onclick: () => panel.removePoint(i) })));
  });
  if (path.opening) opening(path.opening, () => { path.opening = null; panel.update(); });
  return element("ol", { class: "points" }, ...rows);
}

// What the statistics say of candidates along the paths that an entry stands for.
function ledgerOf(path) {
  const rows = page.stats.proposals.filter((p) => (path.paths ?? []).some((name) => p.name.endsWith(name)));
  const sum = (key) => rows.reduce((s, p) => s + p[key], 0);
  if (sum("proposed") === 0) return [];
  return [element("p", { class: "note", text: `In the preview: ${whole(sum("proposed"))} candidates, ${percent(sum("accepted") / sum("proposed"))} accepted, ${percent(sum("deposited"))} of all deposits.` })];
}

function editorOf(panel) {
  const path = panel.path, todo = unfinished(path, panel.picking);
  const text = (get, set) => element("input", { type: "text", value: get, onchange: (e) => { set(e.target.value); panel.update(); } });
  const positive = (value, otherwise) => (Number(value) > 0 ? Number(value) : otherwise);
  const mode = (name, label, key) => element("button", { "data-mode": name, "aria-pressed": String(panel.mode === name), text: label, title: `${label} (${key})`,
    disabled: path.points.length === 0 ? "" : null, onclick: () => panel.setMode(panel.mode === name ? null : name) });
  return [
    field("Name", text(path.name, (v) => { path.name = v.trim() || path.name; })),
    lampChoice(panel),
    bounceFields(panel),
    pointRows(panel),
    element("div", { class: "buttons" }, mode("opening", "Add opening", "O"), mode("point", "Add point", "P")),
    ...(todo || path.error ? [element("p", { class: "warning", text: todo || path.error })] : []),
    element("details", {}, element("summary", { text: "Weight and cones" }),
      field("Weight", text(String(path.weight), (v) => { path.weight = positive(v, path.weight); })),
      field("Cones [°]", text(path.beta.join(", "), (v) => {
        const given = v.split(",").map(Number), n = Math.max(0, path.points.length - 1);
        if (given.every((b) => b >= 0 && b <= 90)) path.beta = Array.from({ length: n }, (_, i) => given[Math.min(i, given.length - 1)]);
      }))),
    ...ledgerOf(path)];
}
