// User paths as the program reads them (docs/user-paths.md), and what is wrong with one that isn't done.

const number = (x) => String(x);
const list = (p) => `[${p.map(number).join(", ")}]`;
const quoted = (word) => `'${word.replaceAll("'", "''")}'`;

function openingText(opening) {
  return `{corner: ${list(opening.corner)}, u: ${list(opening.u)}, v: ${list(opening.v)}}`;
}

function pathText(path) {
  const lines = [`  - name: ${quoted(path.name)}`];
  if (path.weight !== 1) lines.push(`    weight: ${number(path.weight)}`);
  const first = path.beta[0];
  if (path.beta.length > 0 && path.beta.some((b) => b !== first)) lines.push(`    beta: ${list(path.beta)}`);
  else if (path.beta.length > 0 && first !== 5) lines.push(`    beta: ${number(first)}`);
  if (path.patch !== null) lines.push(`    patch: ${number(path.patch)}`);
  if (path.tolerance !== null) lines.push(`    tolerance: ${number(path.tolerance)}`);
  lines.push("    points:");
  path.points.forEach((point, i) => {
    if (point.through) lines.push(`      - through: ${openingText(point.through)}`);
    lines.push(`      - ${list(point.p)}`);
    if (i === 0 && path.bounces) lines.push(`      - bounces: ${path.bounces[0] === path.bounces[1] ? number(path.bounces[0]) : list(path.bounces)}`);
  });
  if (path.opening) lines.push(`      - through: ${openingText(path.opening)}`);
  return lines.join("\n");
}

function userPathsText(paths) {
  return `# User paths for ${page.scene}\npaths:\n${paths.map(pathText).join("\n")}\n`;
}

// What has still to be done; empty: nothing that this page can tell.
function unfinished(path, picking) {
  if (path.points.length === 0) return "Begin at a lamp.";
  if (path.opening) return "Now click a place behind the opening.";
  if (path.points.length < 2) return "Now add what light passes: an opening, or a point on a surface.";
  if (path.bounces && !path.points[1].through) return "Bounces need an opening behind them.";
  for (let i = 1; i < path.points.length; ++i) {
    if (i === 1 && path.bounces) continue;
    const a = path.points[i - 1].p, b = path.points[i].p, far = length(sub(b, a));
    const hit = picking.trace(a, unit(sub(b, a)), 1e-4 * far, (p) => distance2(p, a) < 1e-6 * far * far);
    if (hit && hit.t < 0.97 * far && hit.triangle < page.counts.firstClear) return `The way from point ${i} to point ${i + 1} is blocked after ${metres(hit.t)}.`;
  }
  return "";
}
