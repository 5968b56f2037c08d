// Puts the parts together.

function selectTab(name) {
  for (const tab of document.querySelectorAll("[role=tab]")) {
    const on = tab.id === "tab-" + name;
    tab.setAttribute("aria-selected", String(on));
    tab.tabIndex = on ? 0 : -1;
    byId(tab.getAttribute("aria-controls")).hidden = !on;
  }
  document.dispatchEvent(new CustomEvent("panel", { detail: name }));
}

function prepareTabs() {
  const tabs = [...document.querySelectorAll("[role=tab]")];
  tabs.forEach((tab, i) => {
    tab.addEventListener("click", () => selectTab(tab.id.slice(4)));
    tab.addEventListener("keydown", (e) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
      if (!step) return;
      const next = tabs[(i + step + tabs.length) % tabs.length];
      selectTab(next.id.slice(4));
      next.focus();
    });
  });
}

function prepareTools(view, controls) {
  byId("camera").addEventListener("click", () => { view.camera.reset(); view.redraw(); });
  for (const name of ["orbit", "fly"])
    byId(name).addEventListener("click", () => {
      controls.flying = name === "fly";
      byId("orbit").setAttribute("aria-pressed", String(!controls.flying));
      byId("fly").setAttribute("aria-pressed", String(controls.flying));
    });
  byId("surfaces").addEventListener("change", (e) => { view.opacity = Number(e.target.value); view.redraw(); });
  byId("cut").addEventListener("input", (e) => { view.cut = Number(e.target.value) ** 1.5 * 1.5 * view.camera.size; view.redraw(); });
}

async function start() {
  await loadArrays();
  const view = new SceneView(byId("view"));
  view.camera = new ViewCamera();
  const picking = new Picking(view), photons = new PhotonPanel(view), picture = new PicturePanel(view), paths = new UserPathPanel(view, picking);
  const controls = new ViewControls(view.canvas, view.camera, {
    redraw: () => view.redraw(),
    grabbed: (x, y, reach) => paths.grabbed(x, y, reach),
    released: () => paths.update(),
    cancelled: () => paths.setMode(null),
    focused: (x, y) => {
      const hit = picking.surfaceAt(x, y);
      if (hit) view.camera.lookAt(hit.p);
      view.redraw();
    },
    clicked: (x, y, reach) => {
      if (paths.clicked(x, y, reach)) return;
      if (photons.clicked(picking, x, y, reach)) selectTab("photons");
    },
  });
  // What is drawn of a pixel would drown among photons.
  document.addEventListener("panel", (e) => {
    view.hidden = new Set({ pixel: ["photon"], photons: ["pixel", "rings"], paths: ["pixel", "rings", "photon", "records"], figures: [] }[e.detail] ?? []);
    view.faded = (e.detail === "pixel" && picture.pixel !== null) || e.detail === "paths";
    view.redraw();
  });
  prepareTabs();
  prepareTools(view, controls);
  document.addEventListener("keydown", (e) => {
    if (e.target.matches("input, textarea, select") || e.ctrlKey || e.metaKey || byId("panel-paths").hidden || !paths.path) return;
    const mode = { o: "opening", p: "point" }[e.key];
    if (mode && paths.path.points.length > 0) paths.setMode(mode);
  });
  const middle = picking.surfaceAt(view.canvas.clientWidth / 2, view.canvas.clientHeight / 2);
  if (middle) view.camera.pivotDistance = middle.t;
  const { global, caustic } = page.counts;
  byId("title").textContent = "Where the light goes in " + page.scene;
  document.title = `${page.scene}: where the light goes`;
  byId("summary").textContent = `${whole(global.mainPhotons + caustic.mainPhotons)} photons by ${page.stats.method}, ${whole(page.counts.triangles)} triangles, ${page.program}`;
  const warnings = new Warnings(view, picture, photons, paths), count = warnings.list().length;
  showFigures(picture, warnings);
  if (count > 0) byId("tab-figures").append(element("span", { class: "count", text: count, "aria-label": count === 1 ? "1 warning" : count + " warnings" }));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => view.redraw());
  new ResizeObserver(() => view.redraw()).observe(view.canvas);
  await picture.ready;
  view.draw();
  window.keyhole = { page, arrays, view, picking, photons, picture, paths, warnings, controls, firstFrame: performance.now() };
}

start().catch((e) => {
  say("This page can't be shown: " + e.message);
  throw e;
});
