// A chart of curves with bands on logarithmic axes, labels at their ends, and a level that can be dragged.

// Positions of ticks: 1, 2 and 5 of each decade, or 1 alone where that is enough.
function logTicks(low, high) {
  const ticks = [];
  const steps = high / low > 2000 ? [1] : high / low > 60 ? [1, 3] : [1, 2, 5];
  for (let d = Math.floor(Math.log10(low)); d <= Math.ceil(Math.log10(high)); ++d)
    for (const s of steps) {
      const t = s * Math.pow(10, d);
      if (t >= low * 0.999 && t <= high * 1.001) ticks.push(t);
    }
  return ticks;
}

// Heights for labels that keep off each other.
function spread(heights, gap, most) {
  const order = heights.map((y, i) => ({ y, i })).sort((a, b) => a.y - b.y);
  for (let k = 1; k < order.length; ++k) order[k].y = Math.max(order[k].y, order[k - 1].y + gap);
  let limit = most;
  for (let k = order.length - 1; k >= 0; --k) {
    order[k].y = Math.min(order[k].y, limit);
    limit = order[k].y - gap;
  }
  const out = [];
  for (const { y, i } of order) out[i] = y;
  return out;
}

// options: series [{name, colour, points: [{x, y, low, high, text}]}], xLabel, xTicks, formatX, formatY; level, onLevel: optional.
function plot(container, options) {
  const W = 1000, H = 430, L = 58, R = 92, T = 10, B = 42;
  const least = 1e-5;
  const shown = options.series.filter((s) => s.points.length > 0);
  const xs = shown.flatMap((s) => s.points.map((p) => p.x));
  const ys = shown.flatMap((s) => s.points.flatMap((p) => [p.low, p.high, p.y])).map((y) => Math.max(y, least));
  const [x0, x1] = [Math.min(...xs) / 1.12, Math.max(...xs) * 1.08];
  const [y0, y1] = [Math.min(...ys) / 1.15, Math.max(...ys) * 1.15];
  const X = (x) => L + ((W - L - R) * Math.log(x / x0)) / Math.log(x1 / x0);
  const Y = (y) => T + ((H - T - B) * Math.log(y1 / Math.max(y, least))) / Math.log(y1 / y0);
  const inverseY = (h) => y1 * Math.pow(y0 / y1, (h - T) / (H - T - B));

  const root = svg("svg", { viewBox: `0 0 ${W} ${H}`, role: "img" });
  for (const t of options.xTicks.filter((t) => t >= x0 && t <= x1))
    root.append(svg("line", { class: "grid", x1: X(t), x2: X(t), y1: T, y2: H - B }),
      svg("text", { class: "faint", x: X(t), y: H - B + 17, "text-anchor": "middle", text: options.formatX(t) }));
  for (const t of logTicks(y0, y1))
    root.append(svg("line", { class: "grid", x1: L, x2: W - R, y1: Y(t), y2: Y(t) }),
      svg("text", { class: "faint", x: L - 8, y: Y(t) + 4, "text-anchor": "end", text: options.formatY(t) }));
  root.append(svg("text", { class: "faint", x: (L + W - R) / 2, y: H - 4, "text-anchor": "middle", text: options.xLabel }));

  const ends = spread(shown.map((s) => Y(s.points.at(-1).y)), 16, H - B);
  const groups = shown.map((s, i) => {
    const line = s.points.map((p, k) => `${k ? "L" : "M"}${X(p.x)} ${Y(p.y)}`).join("");
    const upper = s.points.map((p, k) => `${k ? "L" : "M"}${X(p.x)} ${Y(p.high)}`).join("");
    const lower = s.points.slice().reverse().map((p) => `L${X(p.x)} ${Y(p.low)}`).join("");
    const end = s.points.at(-1);
    const group = svg("g", { class: "series", "data-name": s.name },
      svg("path", { class: "band", d: upper + lower + "Z", fill: s.colour }),
      svg("path", { class: "curve", d: line, stroke: s.colour }),
      ...s.points.map((p) => svg("circle", { cx: X(p.x), cy: Y(p.y), r: 3.5, fill: s.colour })),
      svg("path", { d: `M${X(end.x) + 6} ${Y(end.y)}L${W - R + 14} ${ends[i]}`, stroke: s.colour, "stroke-width": 1, opacity: 0.5 }),
      svg("text", { class: "label", x: W - R + 18, y: ends[i] + 4, style: `fill:${s.colour}`, text: s.name,
        onclick: (event) => { event.stopPropagation(); group.classList.toggle("off"); drawLevel(); } }));
    root.append(group);
    return group;
  });

  let level = options.level ? Math.min(Math.max(options.level, y0), y1) : null;
  const marker = svg("g", { class: "threshold" });
  root.append(marker);
  function drawLevel() {
    marker.replaceChildren();
    if (level === null) return;
    const h = Y(level);
    marker.append(svg("line", { x1: L, x2: W - R, y1: h, y2: h }),
      svg("line", { class: "grip", x1: L, x2: W - R, y1: h, y2: h }),
      svg("text", { x: L + 6, y: h - 6, text: options.formatY(level) }));
    shown.forEach((s, i) => {
      const at = groups[i].classList.contains("off") ? null : crossing(s.points, level);
      if (at !== null && at > x0) marker.append(svg("circle", { cx: X(at), cy: h, r: 4.5, stroke: s.colour }));
    });
  }
  drawLevel();

  const place = (event) => {
    const box = root.getBoundingClientRect();
    return { x: ((event.clientX - box.left) * W) / box.width, y: ((event.clientY - box.top) * H) / box.height };
  };
  const setLevel = (event) => {
    const { x, y } = place(event);
    if (level === null || x < L || x > W - R) return;
    level = Math.min(Math.max(inverseY(y), y0), y1);
    drawLevel();
    options.onLevel(level);
  };
  let dragging = false;
  root.addEventListener("pointerdown", (event) => {
    if (level === null || event.target.classList.contains("label")) return;
    dragging = true;
    root.setPointerCapture(event.pointerId);
    setLevel(event);
  });
  root.addEventListener("pointerup", () => { dragging = false; });
  root.addEventListener("pointermove", (event) => {
    if (dragging) return setLevel(event);
    const { x, y } = place(event);
    let near = null, distance = 30;
    shown.forEach((s, i) => {
      if (groups[i].classList.contains("off")) return;
      for (const p of s.points) {
        const d = Math.hypot(X(p.x) - x, Y(p.y) - y);
        if (d < distance) [near, distance] = [{ i, text: `${s.name}\n${p.text}` }, d];
      }
    });
    groups.forEach((g, i) => g.classList.toggle("dim", near !== null && near.i !== i));
    if (near) tip.show(event, near.text);
    else tip.hide();
  });
  root.addEventListener("pointerleave", () => {
    groups.forEach((g) => g.classList.remove("dim"));
    tip.hide();
  });
  container.replaceChildren(root);
}
