// What is drawn of user paths: segments, openings and cones; and how corners of openings move.

const openingsOf = (path) => [...path.points.flatMap((p) => (p.through ? [p.through] : [])), ...(path.opening ? [path.opening] : [])];
const openingCorners = (o) => [o.corner, add(o.corner, o.u), add(o.corner, o.v), add(add(o.corner, o.u), o.v)];

// Where a ray meets the plane of an opening; null: nowhere before it.
function inPlane(opening, from, w) {
  const n = cross(opening.u, opening.v), t = dot(sub(opening.corner, from), n) / dot(w, n);
  return t > 0 && Number.isFinite(t) ? add(from, scaled(w, t)) : null;
}

// Moves the corner, or the one at the end of an edge that leaves it (1: u, 2: v). The other two of these three stay.
function moveCorner(opening, k, p) {
  if (!p) return;
  const ends = openingCorners(opening).slice(0, 3), round = (v) => v.map((c) => Number(c.toPrecision(5)));
  ends[k] = p;
  const [corner, u, v] = [ends[0], sub(ends[1], ends[0]), sub(ends[2], ends[0])].map(round);
  if (length(cross(u, v)) > 0) Object.assign(opening, { corner, u, v });
}

// The rim of the cone of half-angle `beta` [degrees] about the way from a to b, and lines to it.
function coneSegments(a, b, beta, colour) {
  const far = length(sub(b, a)), w = unit(sub(b, a)), side = unit(cross(w, Math.abs(w[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0])), up = cross(side, w);
  const angle = (beta * Math.PI) / 180, count = 32;
  const rim = Array.from({ length: count + 1 }, (_, i) => {
    const phi = (2 * Math.PI * i) / count, off = add(scaled(side, Math.cos(phi)), scaled(up, Math.sin(phi)));
    return add(a, scaled(add(scaled(w, Math.cos(angle)), scaled(off, Math.sin(angle))), far));
  });
  const segments = [];
  for (let i = 0; i < count; ++i) segments.push({ a: rim[i], b: rim[i + 1], colour, width: 1 });
  for (let i = 0; i < count; i += count / 4) segments.push({ a, b: rim[i], colour, width: 1 });
  return segments;
}

// `clicks`: corners of an opening that isn't done.
function userPathDrawing(paths, current, clicks) {
  const segments = [], places = [], colours = [];
  const opening = (o, width) => {
    const [c, u, v, far] = openingCorners(o);
    [[c, u], [u, far], [far, v], [v, c]].forEach(([a, b]) => segments.push({ a, b, colour: GREEN, width }));
    if (width > 2) for (const p of [c, u, v]) { places.push(...p); colours.push(...GREEN); }
    return mix(c, far, 0.5);
  };
  paths.forEach((path, k) => {
    const colour = colourOf(COLOURS[k % COLOURS.length]), width = k === current ? 4 : 2;
    let last = null;
    path.points.forEach((point, i) => {
      const middle = point.through ? opening(point.through, width) : null;
      // Where light is scattered before the opening nobody says: only from there on the way is known.
      if (last && middle) segments.push({ a: last, b: middle, colour, width: i === 1 && path.bounces ? width / 3 : width }, { a: middle, b: point.p, colour, width });
      else if (last) segments.push({ a: last, b: point.p, colour, width });
      if (last && !middle && k === current) segments.push(...coneSegments(last, point.p, path.beta[i - 1] ?? 5, colour));
      last = point.p;
      places.push(...point.p);
      colours.push(...(i === 0 ? YELLOW : colour));
    });
    if (path.opening) opening(path.opening, width);
  });
  clicks.forEach((p, i) => { if (i > 0) segments.push({ a: clicks[0], b: p, colour: GREEN, width: 4 }); });
  for (const p of clicks) { places.push(...p); colours.push(...GREEN); }
  return { segments, places, colours };
}
