// The editor of user paths.

class UserPathPanel {
  constructor(view, picking) {
    Object.assign(this, { view, picking, mode: null, clicks: [] });
    this.paths = page.userPaths.map((p) => ({ ...p, opening: null }));
    this.current = 0;
    byId("path").addEventListener("change", (e) => this.choose(Number(e.target.value)));
    byId("new-path").addEventListener("click", () => this.create());
    byId("delete-path").addEventListener("click", () => this.remove());
    byId("copy").addEventListener("click", () => this.copy());
    byId("save").addEventListener("click", () => this.save());
    this.update();
  }
  get path() { return this.paths[this.current]; }
  choose(index) {
    this.current = index;
    this.setMode(null);
    this.update();
  }
  create() {
    const taken = new Set(this.paths.map((p) => p.name));
    let n = this.paths.length + 1;
    while (taken.has("path " + n)) ++n;
    this.paths.push({ name: "path " + n, weight: 1, beta: [], patch: null, tolerance: null, bounces: null, points: [], opening: null, paths: [] });
    this.choose(this.paths.length - 1);
  }
  remove() {
    this.paths.splice(this.current, 1);
    this.choose(Math.max(0, this.current - 1));
  }
  begin(emitter) {
    const at = { p: page.emitters[emitter].p };
    if (this.path.points.length > 0) this.path.points[0] = at;
    else this.addPoint(at.p);
    this.update();
  }
  addPoint(p) {
    const path = this.path;
    path.points.push(path.opening ? { p, through: path.opening } : { p });
    path.opening = null;
    if (path.points.length > 1) path.beta.push(path.beta[path.beta.length - 1] ?? 5);
  }
  removePoint(i) {
    const path = this.path;
    path.points.splice(i, 1);
    path.beta.splice(Math.max(0, i - 1), 1);
    if (path.points.length > 0 && path.points[0].through) delete path.points[0].through;
    this.update();
  }
  // "point", "opening", or null: clicks add nothing.
  setMode(mode) {
    this.mode = mode;
    this.clicks = [];
    this.view.canvas.classList.toggle("picking", mode !== null);
    say(mode === "point" ? "Click a surface to add a point" : mode === "opening" ? "Click one corner of the opening" : "");
    for (const b of document.querySelectorAll("#editor [data-mode]")) b.setAttribute("aria-pressed", String(b.dataset.mode === mode));
    this.draw();
  }
  // Returns whether the click was for the editor.
  clicked(x, y, reach = 12) {
    if (!this.mode || !this.path) return false;
    const corner = this.mode === "opening" ? this.picking.cornerAt(x, y, reach + 2) : null, hit = corner ? { p: corner } : this.picking.surfaceAt(x, y);
    if (!hit) {
      say("There is no surface here");
      return true;
    }
    if (this.mode === "point") {
      this.addPoint(hit.p.map((c) => Number(c.toPrecision(6))));
      this.setMode(null);
    } else this.addCorner(hit.p);
    this.update();
    return true;
  }
  addCorner(p) {
    this.clicks.push(p);
    if (this.clicks.length < 3) return say(this.clicks.length === 1 ? "Click the corner next to it" : "Click the corner next to the first, on its other side");
    const round = (v) => v.map((c) => Number(c.toPrecision(5))), [corner, b, d] = this.clicks;
    this.path.opening = { corner: round(corner), u: round(sub(b, corner)), v: round(sub(d, corner)) };
    this.setMode("point");
    say("Click a surface behind the opening");
  }
  // Points drawn at a place of the page can be dragged along the surfaces, corners of openings in their plane.
  grabbed(x, y, reach = 12) {
    if (byId("panel-paths").hidden || !this.path || this.mode) return null;
    const handles = [
      ...this.path.points.map((point) => ({ p: point.p, move: (u, v) => {
        const hit = this.picking.surfaceAt(u, v);
        if (hit) point.p = hit.p.map((c) => Number(c.toPrecision(6)));
      } })),
      ...openingsOf(this.path).flatMap((o) => openingCorners(o).slice(0, 3).map((p, k) => ({ p, move: (u, v) =>
        moveCorner(o, k, this.picking.cornerAt(u, v, reach) ?? inPlane(o, this.view.camera.eye, this.picking.ray(u, v))) })))];
    const off = ({ p }) => {
      const at = this.picking.project(p);
      return at ? Math.hypot(at[0] - x, at[1] - y) : Infinity;
    };
    const nearest = handles.reduce((a, b) => (a && off(a) <= off(b) ? a : b), null);
    if (!nearest || off(nearest) >= reach) return null;
    return (u, v) => {
      nearest.move(u, v);
      this.draw();
    };
  }
  draw() {
    const { segments, places, colours } = userPathDrawing(this.paths, this.current, this.clicks);
    this.view.setLines("userPaths", segments);
    const radius = 0.005 * this.view.camera.size;
    this.view.setPoints("userPaths", new Float32Array(places), new Float32Array(colours), new Float32Array(places.length / 3).fill(radius));
    byId("yaml").value = this.paths.some((p) => p.points.length > 0) ? userPathsText(this.paths) : "";
  }
  update() {
    byId("path").replaceChildren(...this.paths.map((p, i) => element("option", { value: i, text: p.name, selected: i === this.current ? "" : null })));
    byId("path").disabled = byId("delete-path").disabled = this.paths.length === 0;
    for (const id of ["copy", "save"]) byId(id).disabled = this.paths.length === 0;
    byId("editor").replaceChildren(...(this.path ? editorOf(this) : [element("p", { text: "A user path says which way light goes that is hard to find by chance: from a lamp, through an opening, to a surface behind it." })]));
    this.draw();
  }
  async copy() {
    byId("yaml").select();
    try {
      await navigator.clipboard.writeText(byId("yaml").value);
    } catch {
      document.execCommand("copy");
    }
    say("Copied");
  }
  save() {
    const link = element("a", { href: URL.createObjectURL(new Blob([byId("yaml").value], { type: "text/yaml" })), download: page.scene + "-paths.yaml" });
    link.click();
    URL.revokeObjectURL(link.href);
    say("Saved");
  }
}
