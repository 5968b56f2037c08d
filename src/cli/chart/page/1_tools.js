"use strict";
// What all parts of the page share: elements, numbers for people, the tooltip.

function element(space, name, attributes, children) {
  const e = space ? document.createElementNS(space, name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes ?? {})) {
    if (key === "text") e.textContent = value;
    else if (key.startsWith("on")) e.addEventListener(key.slice(2), value);
    else e.setAttribute(key, value);
  }
  e.append(...(children ?? []));
  return e;
}
const html = (name, attributes, ...children) => element(null, name, attributes, children);
const svg = (name, attributes, ...children) => element("http://www.w3.org/2000/svg", name, attributes, children);

// Three digits: 0.0123 is 1.23 %.
const digits = (x, n = 3) => (x === 0 ? "0" : String(Number(x.toPrecision(n))));
const percent = (x) => (x === null ? "–" : digits(100 * x, 2) + " %");
const seconds = (x) => (x === null ? "–" : digits(x, 2) + " s");
function bytes(n) {
  const units = ["B", "KiB", "MiB", "GiB"];
  let k = 0;
  for (; n >= 1024 && k + 1 < units.length; ++k) n /= 1024;
  return digits(n) + " " + units[k];
}

// Okabe and Ito's colours, which people who see few tell apart, then some more.
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#d99a00", "#56b4e9", "#8a5cd1", "#9c7b3f", "#7d828a", "#a8a800"];

const tip = {
  show(event, text) {
    const e = document.getElementById("tip");
    e.textContent = text;
    e.classList.add("shown");
    const left = Math.min(event.clientX + 14, innerWidth - e.offsetWidth - 8);
    e.style.left = left + "px";
    e.style.top = Math.max(8, event.clientY - e.offsetHeight - 12) + "px";
  },
  hide() {
    document.getElementById("tip").classList.remove("shown");
  },
};

// CPU time at which a curve of {x, y} falls below `level` for good, by straight lines in logarithms; null if it doesn't.
function crossing(points, level) {
  let found = null, above = null;
  for (const p of points) {
    if (p.y > level) {
      found = null;
      above = p;
    } else if (found === null) {
      const t = above && p.y > 0 ? Math.log(above.y / level) / Math.log(above.y / p.y) : 1;
      found = above && p.y > 0 ? above.x * Math.pow(p.x / above.x, t) : p.x;
    }
  }
  return found;
}
