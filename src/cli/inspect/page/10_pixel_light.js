// The light of a pixel: the photons that speak for it, and what is drawn of it.

// Where the light came from that gather rays found: straight from a lamp, or, for the rest, as the photons nearest to
// their ends did, by power. {lamps: light by emitter, once, more: light by way of one surface, of more; trails}.
function photonsBehind(light) {
  const found = { lamps: new Map(), once: 0, more: 0, trails: [], caustic: [], used: new Set() };
  const count = (emitter, value) => found.lamps.set(emitter, (found.lamps.get(emitter) ?? 0) + value);
  for (const end of light.gather) {
    const once = Math.min(end.value, end.fromLamp), more = end.value - once;
    if (once > 0) count(end.emitter, once);
    found.once += once;
    found.more += more;
    if (!(more > 0)) continue;
    const near = nearestPhotons(end.p, light.trail[light.trail.length - 1], 12), power = near.reduce((s, i) => s + photonPower(i), 0);
    if (near.length === 0) count(-1, more);
    near.forEach((i) => found.used.add(i));
    for (const i of near) count(arrays.photonEmitters[i] === 65535 ? -1 : arrays.photonEmitters[i], (more * photonPower(i)) / power);
    const drawn = near.find((i) => arrays.photonTrails[i] >= 0);
    if (drawn !== undefined) found.trails.push({ photon: drawn, value: more });
  }
  found.trails.sort((a, b) => b.value - a.value);
  const here = light.trail[light.trail.length - 1];
  if (light.seen && light.reach > 0) // farther off photons have no say
    found.caustic = nearestPhotons(here, light.trail[light.trail.length - 2], 20, true).filter((i) => distance2(photonPlace(i), here) < (4 * light.reach) ** 2);
  found.caustic.forEach((i) => found.used.add(i));
  found.caustic = found.caustic.filter((i) => arrays.photonTrails[i] >= 0).slice(0, 3);
  return found;
}

// The photons of a map nearest to a place, the nearest first, that lie on the side where `from` is.
function nearestPhotons(p, from, most, caustic = false) {
  const w = sub(from, p), normals = arrays.photonNormals;
  const near = [];
  for (let i = 0; i < photonCount(); ++i) {
    if (((arrays.photonKinds[i] & 1) !== 0) !== caustic) continue;
    const d = (arrays.photons[3 * i] - p[0]) ** 2 + (arrays.photons[3 * i + 1] - p[1]) ** 2 + (arrays.photons[3 * i + 2] - p[2]) ** 2;
    if (near.length === most && d >= near[most - 1][0]) continue;
    if (!(w[0] * normals[3 * i] + w[1] * normals[3 * i + 1] + w[2] * normals[3 * i + 2] > 0)) continue;
    let k = near.length;
    while (k > 0 && near[k - 1][0] > d) --k;
    near.splice(k, 0, [d, i]);
    near.length = Math.min(near.length, most);
  }
  return near.map(([, i]) => i);
}

// `share`: of the pixel's light, by the caustic map.
function pixelSegments(light, sources, share) {
  const segments = [], at = light.trail[light.trail.length - 1];
  for (let k = 0; k + 1 < light.trail.length; ++k) segments.push({ a: light.trail[k], b: light.trail[k + 1], colour: WHITE, width: 3 });
  // The lobe of what was learned of the sky.
  for (const lamp of light.lamps)
    for (const w of lamp.towards) segments.push({ a: at, b: add(at, scaled(w, 0.12 * lamp.chance * length(sub(page.surface.upper, page.surface.lower)))), colour: SKY, width: 2 });
  const most = Math.max(...light.gather.map((g) => g.value), ...light.direct.map((g) => g.value), 1e-30);
  for (const g of light.direct) segments.push({ a: at, b: g.p, colour: BLUE, width: 1 + 2 * Math.sqrt(g.value / most) });
  for (const g of light.gather) segments.push({ a: at, b: g.p, colour: ORANGE, width: 0.8 + 2.4 * Math.sqrt(g.value / most) });
  for (const g of light.gather) if (g.fromLamp > 0.05 * most) segments.push({ a: g.lamp, b: g.p, colour: YELLOW, width: 2 });
  for (const s of sources.trails.filter((t) => t.value > 0.05 * most).slice(0, 3)) {
    const path = trail(arrays.photonTrails[s.photon]);
    segments.push(...trailSegments({ points: path.points.slice(0, path.photon + 1), photon: path.photon }, 2));
  }
  for (const i of share > 0.02 ? sources.caustic : []) {
    const path = trail(arrays.photonTrails[i]);
    for (let k = 0; k < path.photon; ++k) segments.push({ a: path.points[k], b: path.points[k + 1], colour: GREEN, width: 2 });
  }
  return segments;
}
