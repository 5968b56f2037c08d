// Warnings, each with a way to what it is about.

// Of what warnings are about: a layer of the picture, or what is shown of photons.
const PLACES = { samples: { layer: "error" }, direct: { layer: "error:direct" }, caustics: { layer: "error:caustic" }, lookups: { layer: "reach" },
  photons: { show: "power" }, records: { show: "records" } };

class Warnings {
  constructor(view, picture, photons, paths) {
    Object.assign(this, { view, picture, photons, paths });
  }
  list() {
    const s = page.stats, few = s.lookups && (s.lookups.share < 0.7 || s.lookups.effective < 15);
    return [...page.userPaths.flatMap((p, path) => (p.error ? [{ text: p.error, path }] : [])), ...s.warnings,
      ...(few && !s.warnings.some((w) => w.about === "lookups") ? [{ text: "photons are few where they are asked for: more memory, more light paths, or user paths would help", about: "lookups" }] : [])];
  }
  elements() {
    return this.list().map((w) => element("p", { class: "warning", text: w.text },
      ...(w.path !== undefined || PLACES[w.about] ? [" ", element("button", { "aria-label": "Show where: " + w.text, text: "Show where", onclick: () => this.go(w) })] : [])));
  }
  go(warning) {
    if (warning.path !== undefined) {
      selectTab("paths");
      return this.paths.choose(warning.path);
    }
    const { layer, show } = PLACES[warning.about];
    if (layer) return this.picture.showWorst(layer);
    selectTab("photons");
    this.photons.show(show);
    const others = this.photons.others, i = show === "records" ? others.noisiestRecord : this.photons.selectStrongest();
    if (i < 0) return;
    this.view.camera.lookAt(show === "records" ? others.record(i).p : photonPlace(i));
    if (show === "records") others.tell(i);
    this.view.redraw();
  }
}
