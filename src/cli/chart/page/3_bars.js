// Horizontal bars: rows [{name, colour, parts: [{value, label, colour}]}]. Parts stand one after the other, or below each other.
function bars(container, { rows, format, stacked, legend }) {
  const W = 480, L = 70, R = 62;
  const thick = stacked ? 20 : 9, each = stacked ? 30 : Math.max(...rows.map((r) => r.parts.length)) * 11 + 10;
  const top = legend.length ? 6 + 18 * Math.ceil(legend.length / 2) + 6 : 4;
  const H = top + rows.length * each + 4;
  const total = (r) => r.parts.reduce((sum, p) => sum + p.value, 0);
  const most = Math.max(...rows.map((r) => (stacked ? total(r) : Math.max(...r.parts.map((p) => p.value)))));
  const scale = (v) => ((W - L - R) * v) / most;
  const root = svg("svg", { viewBox: `0 0 ${W} ${H}`, role: "img" });
  legend.forEach((item, i) => {
    const x = (i % 2) * (W / 2), y = 6 + 18 * Math.floor(i / 2);
    root.append(svg("rect", { x, y, width: 11, height: 11, rx: 2, fill: item.colour }), svg("text", { x: x + 17, y: y + 10, text: item.label }));
  });
  rows.forEach((row, i) => {
    const y = top + i * each;
    root.append(svg("text", { x: L - 8, y: y + each / 2 + 1, "text-anchor": "end", "font-weight": 600, style: `fill:${row.colour}`, text: row.name }));
    let x = L;
    row.parts.forEach((p, k) => {
      const at = stacked ? y + 4 : y + 3 + k * 11;
      const bar = svg("rect", { x: stacked ? x : L, y: at, width: Math.max(0.5, scale(p.value)), height: thick, rx: 2, fill: p.colour });
      bar.addEventListener("pointermove", (event) => tip.show(event, `${row.name}\n${p.label}: ${format(p.value)}`));
      bar.addEventListener("pointerleave", tip.hide);
      root.append(bar);
      if (!stacked) root.append(svg("text", { class: "faint", x: L + scale(p.value) + 6, y: at + 8.5, style: "font-size:10.5px", text: format(p.value) }));
      x += scale(p.value);
    });
    if (stacked) root.append(svg("text", { class: "faint", x: x + 6, y: y + 18, text: format(total(row)) }));
  });
  container.replaceChildren(root);
}
