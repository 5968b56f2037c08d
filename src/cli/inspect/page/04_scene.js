// The scene in WebGL: surfaces that stay, and sets of points and lines that come and go.

class SceneView {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = (this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false }));
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.surface = new Program(gl, SURFACE, ["position", "colour"]);
    this.points = new Program(gl, POINTS, ["position", "colour", "radius", "side"]);
    this.lines = new Program(gl, LINES, ["corner", "from", "to", "tint", "width"]);
    this.pointSets = new Map();
    this.lineSets = new Map();
    this.hidden = new Set(); // sets of lines and points that aren't of the panel at hand
    this.opacity = 1;
    this.cut = 0;
    this.size = 2.5;
    this.faded = false; // photons, beside what is drawn of a pixel
    this.positions = arrays.surface instanceof Float32Array ? arrays.surface : decodedPlaces(page.surface, arrays.surface, 3);
    this.mesh = vertexArray(gl, [[0, this.positions, 3], [1, arrays.surfaceColours, 3]], arrays.triangles);
    this.draws = 0;
  }

  // `radii`: of rings [m]; without them points have the size that is set. `sides`: directions off the surface.
  setPoints(name, places, colours, radii, sides) {
    if (!places || places.length === 0) this.pointSets.delete(name);
    else
      this.pointSets.set(name, { count: places.length / 3, vao: vertexArray(this.gl, [[0, places, 3], [1, colours, 3], [2, radii ?? new Float32Array(places.length / 3), 1], [3, sides ?? new Int8Array(places.length), 3]]) });
    this.redraw();
  }

  // Segments {a, b, colour, width in pixels}. `through`: how much is seen of them behind surfaces.
  setLines(name, segments, through = 0.22) {
    if (segments.length === 0) this.lineSets.delete(name);
    else {
      const column = (get, n) => new Float32Array(segments.flatMap((s) => get(s)));
      this.lineSets.set(name, {
        count: segments.length,
        through,
        vao: vertexArray(this.gl, [
          [0, new Float32Array([0, -1, 0, 1, 1, -1, 1, 1]), 2], [1, column((s) => s.a), 3, true], [2, column((s) => s.b), 3, true],
          [3, column((s) => s.colour), 3, true], [4, column((s) => [s.width]), 1, true]]) });
    }
    this.redraw();
  }

  redraw() {
    if (this.waiting || !this.camera) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0;
      this.draw();
    });
  }

  draw() {
    const { gl, canvas, camera } = this, ratio = Math.min(2, devicePixelRatio || 1);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const toClip = camera.toClip(width / height), eye = camera.eye, screen = [width, height];
    const sky = getComputedStyle(document.getElementById("stage")).backgroundColor.match(/[\d.]+/g).map((x) => x / 255);
    gl.viewport(0, 0, width, height);
    gl.clearColor(sky[0], sky[1], sky[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.drawSurfaces({ toClip, eye, cut: this.cut, lower: page.surface.lower, upper: page.surface.upper });
    this.points.use({ toClip, eye, size: this.size * ratio, pixelsPerRadian: height / (2 * camera.vertical), lift: 0.002 * camera.size, opacity: this.faded ? 0.3 : 0.92 });
    for (const [name, set] of this.pointSets) {
      if (this.hidden.has(name)) continue;
      gl.bindVertexArray(set.vao);
      gl.drawArrays(gl.POINTS, 0, set.count);
    }
    // What surfaces hide of lines is drawn faintly.
    gl.depthMask(false);
    for (const behind of [true, false]) {
      gl.depthFunc(behind ? gl.GREATER : gl.LEQUAL);
      for (const [name, set] of this.lineSets) {
        if (this.hidden.has(name) || (behind && set.through === 0)) continue;
        this.lines.use({ toClip, eye, screen: [width / ratio, height / ratio], opacity: behind ? set.through : 1 });
        gl.bindVertexArray(set.vao);
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, set.count);
      }
    }
    gl.depthMask(true);
    gl.depthFunc(gl.LEQUAL);
    ++this.draws;
  }

  drawSurfaces(uniforms) {
    const gl = this.gl, { firstEmitter, firstClear } = page.counts, all = arrays.triangles.length / 3;
    if (this.opacity === 0) return;
    const part = (first, end, opacity, glows) => {
      if (end === first) return;
      gl.depthMask(opacity === 1);
      this.surface.use({ ...uniforms, opacity, glows });
      gl.drawElements(gl.TRIANGLES, 3 * (end - first), gl.UNSIGNED_INT, 12 * first);
    };
    gl.bindVertexArray(this.mesh);
    part(0, firstEmitter, this.opacity, false);
    part(firstEmitter, firstClear, Math.max(this.opacity, 0.6), true);
    part(firstClear, all, 0.25 * this.opacity, false);
    gl.depthMask(true);
  }
}
