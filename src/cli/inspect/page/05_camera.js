// The camera of the view, and how mouse, fingers and keys move it.

class ViewCamera {
  constructor() {
    this.size = length(sub(page.surface.upper, page.surface.lower)) || 1;
    this.reset();
  }
  // To where the scene's own camera is.
  reset() {
    const c = page.camera;
    this.eye = [...c.origin];
    this.forward = unit(c.forward);
    this.up = unit(c.up);
    this.tangent = Math.max(Math.abs(c.topLeft[1] - c.bottomRight[1]) / 2, 0.05);
    this.wide = Math.max(Math.abs(c.topLeft[0] - c.bottomRight[0]) / 2, 0.05);
    this.level = Math.abs(this.up[1]) > 0.2 ? [0, Math.sign(this.up[1]), 0] : [...this.up];
    this.pivotDistance = 0.4 * this.size;
    this.cut = 0;
  }
  get right() { return unit(cross(this.forward, this.up)); }
  get pivot() { return add(this.eye, scaled(this.forward, this.pivotDistance)); }

  toClip(aspect) {
    // All that the scene's camera sees has to fit.
    this.vertical = Math.max(this.tangent, this.wide / aspect);
    const f = 1 / this.vertical, near = 0.0008 * this.size, far = 12 * this.size;
    const projection = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
    const r = this.right, u = cross(r, this.forward), b = scaled(this.forward, -1);
    const view = [r[0], u[0], b[0], 0, r[1], u[1], b[1], 0, r[2], u[2], b[2], 0, -dot(r, this.eye), -dot(u, this.eye), -dot(b, this.eye), 1];
    return (this.matrix = product(projection, view));
  }

  turn(x, y, around) {
    const pivot = this.pivot, apply = (axis, angle) => {
      this.forward = unit(turned(this.forward, axis, angle));
      this.up = unit(turned(this.up, axis, angle));
    };
    apply(this.level, -x);
    const steep = dot(this.forward, this.level);
    if (Math.abs(steep) < 0.985 || Math.sign(steep) !== Math.sign(-y)) apply(this.right, -y);
    if (around) this.eye = sub(pivot, scaled(this.forward, this.pivotDistance));
  }
  pan(x, y) {
    const s = this.pivotDistance * this.vertical * 2, u = cross(this.right, this.forward);
    this.eye = add(this.eye, add(scaled(this.right, -x * s), scaled(u, y * s)));
  }
  move(right, up, forward) {
    const u = cross(this.right, this.forward);
    this.eye = add(this.eye, add(add(scaled(this.right, right), scaled(u, up)), scaled(this.forward, forward)));
  }
  // Nearer to the pivot by this factor.
  zoom(factor) {
    const pivot = this.pivot;
    this.pivotDistance = Math.min(6 * this.size, Math.max(0.002 * this.size, this.pivotDistance * factor));
    this.eye = sub(pivot, scaled(this.forward, this.pivotDistance));
  }
  // Looks at a place from so far away, along the direction that it has.
  lookAt(p) {
    const w = sub(p, this.eye), far = length(w);
    if (far < 1e-6 * this.size) return;
    this.forward = unit(w);
    this.up = unit(sub(this.level, scaled(this.forward, dot(this.level, this.forward))));
    this.pivotDistance = far;
  }
}

// `view` is told of clicks: view.clicked(x, y, reach), view.grabbed(x, y, reach) -> dragged(x, y) or null, in pixels of
// the page; within `reach` of them lies what is meant: fingers are wide.
class ViewControls {
  constructor(canvas, camera, view) {
    Object.assign(this, { canvas, camera, view, flying: false, pointers: new Map() });
    canvas.addEventListener("pointerdown", (e) => this.down(e));
    canvas.addEventListener("pointermove", (e) => this.moved(e));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (e) => this.up(e));
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    canvas.addEventListener("dblclick", (e) => view.focused(e.offsetX, e.offsetY));
    canvas.addEventListener("keydown", (e) => this.key(e));
  }
  down(e) {
    this.canvas.setPointerCapture(e.pointerId);
    this.canvas.focus({ preventScroll: true });
    this.pointers.set(e.pointerId, { x: e.offsetX, y: e.offsetY });
    this.reach = e.pointerType === "touch" ? 22 : 10;
    this.travelled = this.pointers.size > 1 ? 100 : 0;
    this.dragging = this.pointers.size === 1 && e.button === 0 ? this.view.grabbed(e.offsetX, e.offsetY, this.reach) : null;
    this.panning = e.button !== 0 || e.shiftKey;
  }
  moved(e) {
    const p = this.pointers.get(e.pointerId);
    if (!p) return;
    const x = e.offsetX - p.x, y = e.offsetY - p.y, height = this.canvas.clientHeight;
    const others = [...this.pointers.entries()].filter(([id]) => id !== e.pointerId).map(([, o]) => o);
    this.travelled += Math.hypot(x, y);
    if (others.length === 1) {
      const before = Math.hypot(p.x - others[0].x, p.y - others[0].y), after = Math.hypot(e.offsetX - others[0].x, e.offsetY - others[0].y);
      if (after > 0 && before > 0) this.camera.zoom(before / after);
      this.camera.pan(x / 2 / height, y / 2 / height);
    } else if (this.dragging) this.dragging(e.offsetX, e.offsetY);
    else if (this.panning) this.camera.pan(x / height, y / height);
    else this.camera.turn((x / height) * (this.flying ? -1.6 : 3.2), (y / height) * (this.flying ? -1.6 : 3.2), !this.flying);
    Object.assign(p, { x: e.offsetX, y: e.offsetY });
    this.view.redraw();
  }
  up(e) {
    if (this.pointers.delete(e.pointerId) && this.travelled < this.reach / 2 && e.type === "pointerup" && e.button === 0 && !this.dragging)
      this.view.clicked(e.offsetX, e.offsetY, this.reach);
    if (this.dragging) this.view.released();
    if (this.pointers.size === 0) this.dragging = null;
  }
  wheel(e) {
    e.preventDefault();
    const steps = e.deltaY / (e.deltaMode === 1 ? 3 : 100);
    if (this.flying) this.camera.move(0, 0, -0.05 * this.camera.size * steps);
    else this.camera.zoom(1.18 ** steps);
    this.view.redraw();
  }
  key(e) {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const c = this.camera, step = 0.025 * c.size, angle = 0.09, around = !this.flying;
    const actions = {
      ArrowLeft: () => c.turn(-angle, 0, around), ArrowRight: () => c.turn(angle, 0, around),
      ArrowUp: () => c.turn(0, -angle, around), ArrowDown: () => c.turn(0, angle, around),
      "+": () => c.zoom(0.85), "=": () => c.zoom(0.85), "-": () => c.zoom(1 / 0.85),
      w: () => c.move(0, 0, step), s: () => c.move(0, 0, -step), a: () => c.move(-step, 0, 0), d: () => c.move(step, 0, 0),
      e: () => c.move(0, step, 0), q: () => c.move(0, -step, 0), c: () => c.reset(), Home: () => c.reset(),
      Enter: () => this.view.clicked(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2, 10), Escape: () => this.view.cancelled() };
    const action = actions[e.key] ?? actions[e.key.toLowerCase()];
    if (!action) return;
    e.preventDefault();
    action();
    this.view.redraw();
  }
}
