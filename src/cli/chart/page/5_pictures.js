// Two pictures, one over the other, with a handle between them; zoom, and errors in false colour.

// Signed relative error in [-1, 1] of a byte: 128 is none, and the scale is quadratic.
const errorOf = (byte) => { const t = (byte - 128) / 127; return Math.sign(t) * t * t; };

// Too dark is blue, too bright is red, right is black.
function falseColour(byte) {
  const t = Math.min(1, Math.abs(byte - 128) / 127);
  const ramp = (from, to) => Math.round(255 * Math.min(1, Math.max(0, (t - from) / (to - from))));
  const [a, b, c] = [ramp(0, 0.5), ramp(0.3, 0.85), ramp(0.75, 1)];
  return byte >= 128 ? [a, b, c] : [c, b, a];
}
const scaleGradient = () => {
  const stops = [];
  for (let i = 0; i <= 16; ++i) stops.push(`rgb(${falseColour(1 + Math.round((i * 254) / 16)).join(",")})`);
  return `linear-gradient(to right, ${stops.join(",")})`;
};

async function pixels(uri) {
  const image = new Image();
  image.src = uri;
  await image.decode();
  const canvas = html("canvas", { width: image.width, height: image.height });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, image.width, image.height);
}

// items: [{name, picture, errors}] as data URIs; the first, the reference, has no errors.
function viewer(container, items, width, height, size) {
  const sides = [{ item: items[1] ?? items[0] }, { item: items[0] }];
  let split = 0.5, zoom = 1, panX = 0, panY = 0, mode = "picture";
  const view = html("div", { class: "viewer", style: `aspect-ratio:${width}/${height}` });
  const handle = html("div", { class: "handle", role: "slider", tabindex: 0, "aria-label": "border between the pictures", "aria-valuenow": 50 });
  const readout = html("p", { class: "note readout" });
  for (const side of sides) {
    side.canvas = html("canvas", { width, height });
    side.label = html("span", { class: "side" });
    view.append(side.canvas);
  }
  view.append(handle, sides[0].label, sides[1].label);
  sides[0].label.style.left = "8px";
  sides[1].label.style.right = "8px";

  function layout() {
    const box = view.getBoundingClientRect(), scale = (box.width / width) * zoom;
    panX = Math.min(0, Math.max(box.width * (1 - zoom), panX));
    panY = Math.min(0, Math.max(box.height * (1 - zoom), panY));
    const border = (box.width * split - panX) / scale;
    for (const side of sides) side.canvas.style.transform = `translate(${panX}px,${panY}px) scale(${scale})`;
    sides[0].canvas.style.clipPath = `inset(0 ${Math.max(0, width - border)}px 0 0)`;
    sides[1].canvas.style.clipPath = `inset(0 0 0 ${Math.max(0, border)}px)`;
    handle.style.left = 100 * split + "%";
    handle.setAttribute("aria-valuenow", Math.round(100 * split));
  }
  async function load(side) {
    const item = side.item;
    side.label.textContent = item.name + (mode === "error" && item.errors ? ", error" : "");
    side.errors = item.errors ? await pixels(item.errors) : null;
    const data = mode === "error" && side.errors ? new ImageData(new Uint8ClampedArray(side.errors.data), width, height) : await pixels(item.picture);
    if (mode === "error" && side.errors)
      for (let i = 0; i < data.data.length; i += 4) data.data.set(falseColour(data.data[i]), i);
    if (side.item === item) side.canvas.getContext("2d").putImageData(data, 0, 0);
  }
  const reload = () => Promise.all(sides.map(load));

  const choice = (side, label) => html("label", {}, label, html("select", { "aria-label": label, onchange: (e) => {
    side.item = items[e.target.value];
    load(side);
  } }, ...items.map((item, i) => { const o = html("option", { value: i, text: item.name }); o.selected = item === side.item; return o; })));
  const toggle = (values, start, act) => {
    const buttons = values.map(([value, text]) => html("button", { "data-value": value, "aria-pressed": value === start, text, onclick: () => {
      buttons.forEach((b, i) => b.setAttribute("aria-pressed", values[i][0] === value));
      act(value);
    } }));
    return buttons;
  };
  function zoomTo(factor) {
    const box = view.getBoundingClientRect();
    panX = box.width / 2 - ((box.width / 2 - panX) * factor) / zoom;
    panY = box.height / 2 - ((box.height / 2 - panY) * factor) / zoom;
    zoom = factor;
    layout();
  }
  const scale = html("span", { class: "note", style: "visibility:hidden" }, "−100 %", html("span", { class: "scale", style: `background:${scaleGradient()}` }), "+100 %");
  const tools = html("div", { class: "tools" }, choice(sides[0], "left"), choice(sides[1], "right"), html("span", { class: "gap" }), scale,
    html("span", {}, ...toggle([["picture", "picture"], ["error", "error"]], "picture", (m) => { mode = m; scale.style.visibility = m === "error" ? "" : "hidden"; reload(); })),
    html("span", {}, ...toggle([[1, "1×"], [2, "2×"], [4, "4×"], [8, "8×"]], 1, zoomTo)));

  let drag = null;
  handle.addEventListener("pointerdown", (event) => { drag = "split"; event.stopPropagation(); handle.setPointerCapture(event.pointerId); });
  handle.addEventListener("pointermove", (event) => {
    if (drag !== "split") return;
    const box = view.getBoundingClientRect();
    split = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    layout();
  });
  handle.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
    if (!step) return;
    event.preventDefault();
    split = Math.min(1, Math.max(0, split + step));
    layout();
  });
  view.addEventListener("pointerdown", (event) => { drag = "pan"; view.setPointerCapture(event.pointerId); });
  view.addEventListener("pointermove", (event) => {
    if (drag === "pan") {
      panX += event.movementX;
      panY += event.movementY;
      layout();
    }
    const box = view.getBoundingClientRect(), k = (box.width / width) * zoom;
    const x = Math.floor((event.clientX - box.left - panX) / k), y = Math.floor((event.clientY - box.top - panY) / k);
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const text = sides.filter((s) => s.errors).map((s) => {
      const e = errorOf(s.errors.data[4 * (y * width + x)]);
      return `${s.item.name} ${Math.abs(e) > 0.999 ? "100 % or more" : percent(Math.abs(e))}${e > 0.0005 ? " too bright" : e < -0.0005 ? " too dark" : ""}`;
    });
    readout.textContent = `pixel ${x * size}, ${y * size}: ${text.join("; ")}`;
  });
  for (const target of [view, handle]) target.addEventListener("pointerup", () => { drag = null; });
  container.replaceChildren(tools, view, readout);
  new ResizeObserver(layout).observe(view);
  layout();
  reload();
}
