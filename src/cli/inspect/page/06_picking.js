// From places on the screen to places in the scene, and back.

class Picking {
  constructor(view) {
    this.view = view;
  }
  // Pixels of the page; null behind the eye.
  project(p) {
    const m = this.view.camera.toClip(this.view.canvas.clientWidth / this.view.canvas.clientHeight);
    const clip = [0, 1, 3].map((i) => m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i]);
    if (clip[2] <= 1e-6) return null;
    return [(clip[0] / clip[2] + 1) / 2 * this.view.canvas.clientWidth, (1 - clip[1] / clip[2]) / 2 * this.view.canvas.clientHeight];
  }
  ray(x, y) {
    const c = this.view.camera, w = this.view.canvas.clientWidth, h = this.view.canvas.clientHeight;
    c.toClip(w / h);
    const s = c.vertical, u = cross(c.right, c.forward);
    return unit(add(c.forward, add(scaled(c.right, (2 * x / w - 1) * s * w / h), scaled(u, (1 - 2 * y / h) * s))));
  }
  // The first surface along a ray that is shown: {p, t, triangle}. Moeller and Trumbore 1997.
  trace(from, w, least = 0, hidden = () => false) {
    const position = this.view.positions, index = arrays.triangles;
    let best = null, most = Infinity;
    for (let i = 0; i < index.length; i += 3) {
      const a = 3 * index[i], b = 3 * index[i + 1], c = 3 * index[i + 2];
      const ax = position[a], ay = position[a + 1], az = position[a + 2];
      const e1x = position[b] - ax, e1y = position[b + 1] - ay, e1z = position[b + 2] - az;
      const e2x = position[c] - ax, e2y = position[c + 1] - ay, e2z = position[c + 2] - az;
      const px = w[1] * e2z - w[2] * e2y, py = w[2] * e2x - w[0] * e2z, pz = w[0] * e2y - w[1] * e2x;
      const det = e1x * px + e1y * py + e1z * pz;
      if (det === 0) continue;
      const sx = from[0] - ax, sy = from[1] - ay, sz = from[2] - az, u = (sx * px + sy * py + sz * pz) / det;
      if (u < -1e-6 || u > 1 + 1e-6) continue;
      const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
      const v = (w[0] * qx + w[1] * qy + w[2] * qz) / det;
      if (v < -1e-6 || u + v > 1 + 1e-6) continue;
      const t = (e2x * qx + e2y * qy + e2z * qz) / det;
      if (t <= least || t >= most) continue;
      const p = add(from, scaled(w, t));
      if (hidden(p)) continue;
      most = t;
      best = { p, t, triangle: i / 3 };
    }
    return best;
  }
  // Outer walls that are left out, as in the shader.
  isHidden(p) {
    const eye = this.view.camera.eye, { lower, upper } = page.surface;
    return [0, 1, 2].some((k) => {
      const rim = 0.012 * (upper[k] - lower[k]) + 1e-6;
      return (eye[k] < lower[k] && p[k] < lower[k] + rim) || (eye[k] > upper[k] && p[k] > upper[k] - rim);
    });
  }
  surfaceAt(x, y) {
    const { camera, cut } = this.view;
    return this.trace(camera.eye, this.ray(x, y), cut, (p) => this.isHidden(p));
  }
  // The corner of a mesh nearest to a place of the page, within `reach` pixels, that isn't behind what is there.
  cornerAt(x, y, reach = 12) {
    const positions = this.view.positions, eye = this.view.camera.eye, w = this.ray(x, y);
    let best = null, least = reach;
    for (let i = 0; i < positions.length; i += 3) {
      const p = [positions[i], positions[i + 1], positions[i + 2]], to = sub(p, eye), far = length(to);
      if (dot(to, w) < 0.9 * far || far < this.view.cut || this.isHidden(p)) continue;
      const at = this.project(p), off = at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
      if (off >= least) continue;
      const before = this.trace(eye, unit(to), this.view.cut, (q) => this.isHidden(q));
      if (before && before.t < far * (1 - 2e-3)) continue;
      least = off;
      best = p;
    }
    return best;
  }
  // Of places in a flat array, the one drawn nearest; -1: none within `reach` pixels.
  nearest(places, x, y, reach, isWanted = () => true) {
    const w = this.ray(x, y), eye = this.view.camera.eye;
    const tangent = reach * 2 * this.view.camera.vertical / this.view.canvas.clientHeight;
    let best = -1, least = Infinity;
    const surface = this.view.opacity === 1 ? this.surfaceAt(x, y) : null;
    const most = surface ? surface.t * 1.02 : Infinity;
    for (let i = 0; i < places.length / 3; ++i) {
      const to = [places[3 * i] - eye[0], places[3 * i + 1] - eye[1], places[3 * i + 2] - eye[2]], along = dot(to, w);
      if (along <= 0 || along > most) continue;
      const off = Math.sqrt(Math.max(0, dot(to, to) - along * along)) / along;
      if (off < tangent && off < least && isWanted(i)) {
        least = off;
        best = i;
      }
    }
    return best;
  }
}
