// Vectors, matrices (column by column, as WebGL has them), numbers for people, elements, colours.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(...a);
const unit = (a) => scaled(a, 1 / (length(a) || 1));
const mix = (a, b, t) => add(scaled(a, 1 - t), scaled(b, t));
const distance2 = (a, b) => (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2;

// `a` turned about the unit vector `axis`.
function turned(a, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scaled(a, c), scaled(cross(axis, a), s)), scaled(axis, dot(axis, a) * (1 - c)));
}

// A circle that lies on a surface: segments as SceneView draws them.
function ring(p, n, radius, colour, width = 1.2, corners = 14) {
  const side = unit(cross(n, Math.abs(n[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0])), up = cross(n, side);
  const at = (i) => add(p, add(scaled(side, radius * Math.cos((2 * Math.PI * i) / corners)), scaled(up, radius * Math.sin((2 * Math.PI * i) / corners))));
  return Array.from({ length: corners }, (_, i) => ({ a: at(i), b: at(i + 1), colour, width }));
}

function product(a, b) {
  const m = new Float32Array(16);
  for (let i = 0; i < 4; ++i)
    for (let j = 0; j < 4; ++j)
      for (let k = 0; k < 4; ++k) m[4 * i + j] += a[4 * k + j] * b[4 * i + k];
  return m;
}

const digits = (x, n = 3) => (x === 0 ? "0" : String(Number(x.toPrecision(n))));
const whole = (n) => Math.round(n).toLocaleString("en");
const percent = (x) => (x > 0 && x < 0.005 ? "< 1\u00a0%" : Math.round(100 * x) + "\u00a0%");
function metres(x) {
  return x >= 1 ? digits(x) + "\u00a0m" : x >= 0.01 ? digits(100 * x) + "\u00a0cm" : digits(1000 * x) + "\u00a0mm";
}
function watts(x) {
  const [unitOf, name] = x >= 1 ? [1, "W"] : x >= 1e-3 ? [1e-3, "mW"] : x >= 1e-6 ? [1e-6, "µW"] : [1e-9, "nW"];
  return digits(x / unitOf) + "\u00a0" + name;
}
function bytes(n) {
  const units = ["B", "KiB", "MiB", "GiB"];
  let k = 0;
  for (; n >= 1024 && k + 1 < units.length; ++k) n /= 1024;
  return digits(n) + " " + units[k];
}
const coordinates = (p) => p.map((x) => digits(x, 3)).join(", ");

function element(name, attributes, ...children) {
  const e = document.createElement(name);
  for (const [key, value] of Object.entries(attributes ?? {})) {
    if (key === "text") e.textContent = value;
    else if (key.startsWith("on")) e.addEventListener(key.slice(2), value);
    else if (value !== undefined && value !== null && value !== false) e.setAttribute(key, value);
  }
  e.append(...children);
  return e;
}
const byId = (id) => document.getElementById(id);
const say = (text) => { byId("status").textContent = text; };

// Okabe and Ito's colours, which people who see few tell apart.
const COLOURS = ["#0072b2", "#e69f00", "#009e73", "#d55e00", "#cc79a7", "#56b4e9", "#8a5cd1", "#8f8f8f"];
const colourOf = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
const ORANGE = colourOf("#f08a24"), YELLOW = colourOf("#ffd24a"), BLUE = colourOf("#4aa8ff"), WHITE = [1, 1, 1], GREEN = colourOf("#2fbf8f"), SKY = colourOf("#b9dcff");

// From dark violet to yellow: viridis, by its values at the ninths.
const RAMP = ["#440154", "#482878", "#3e4a89", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"].map(colourOf);
function ramp(t) {
  const x = Math.min(1, Math.max(0, t)) * (RAMP.length - 1), i = Math.min(RAMP.length - 2, Math.floor(x));
  return mix(RAMP[i], RAMP[i + 1], x - i);
}
const css = (c) => `rgb(${c.map((x) => Math.round(255 * x)).join(" ")})`;
const rampStyle = (from = 0) => `background: linear-gradient(90deg, ${RAMP.map((_, i) => css(ramp(from + ((1 - from) * i) / (RAMP.length - 1)))).join(", ")})`;
