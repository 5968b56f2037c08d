// Puts the page together from the data, a scene at a time.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const at = (id) => document.getElementById(id);
  const colour = Object.fromEntries(data.methods.map((m, i) => [m, COLOURS[i % COLOURS.length]]));
  const last = (m) => m.time.at(-1);
  const title = (m) => (last(m).chosen !== m.name ? `${m.name} (${last(m).chosen})` : m.name);
  const root = (squared) => (squared === null ? null : Math.sqrt(Math.max(0, squared)));
  const sort = { column: 1, down: false };
  let level = 0.1;

  const point = (p, x) => ({ x, y: p.error, low: p.low, high: p.high,
    text: `${digits(p.cpu, 3)} s of CPU time\nerror ${percent(p.error)} (${percent(p.low)} to ${percent(p.high)})` +
      (p.photons ? `\n${p.photons.toLocaleString("en")} photons, ${bytes(p.photonBytes)}, ${p.passes} ${p.passes === 1 ? "pass" : "passes"}` : "") });

  const columns = () => [
    { title: "method", value: (m) => m.name, show: (m) => [html("span", { class: "dot", style: `background:${colour[m.name]}` }), title(m)] },
    { title: "error", value: (m) => last(m).error, show: (m) => percent(last(m).error), low: true },
    { title: "range", value: (m) => last(m).high, show: (m) => `${percent(last(m).low)} – ${percent(last(m).high)}` },
    { title: `time to ${percent(level)}`, value: (m) => crossing(m.curve, level), show: (m) => seconds(crossing(m.curve, level)), low: true },
    { title: "slope", value: (m) => m.slope, show: (m) => (m.slope === null ? "–" : m.slope.toFixed(2)) },
    { title: "bias", value: (m) => root(last(m).bias), show: (m) => percent(root(last(m).bias)) },
    { title: "deviation", value: (m) => root(last(m).variance), show: (m) => percent(root(last(m).variance)) },
    { title: "photons", value: (m) => last(m).photonBytes, show: (m) => (last(m).photonBytes ? bytes(last(m).photonBytes) : "–") },
    { title: "process", value: (m) => last(m).peakBytes, show: (m) => bytes(last(m).peakBytes) },
  ];

  function show(scene) {
    for (const button of at("scenes").children) button.setAttribute("aria-selected", button.textContent === scene.name);
    const methods = scene.methods.filter((m) => m.time.length > 0);
    for (const m of methods) m.curve = m.time.map((p) => point(p, p.cpu));
    const fill = () => table(at("methods"), columns(), methods, sort);
    plot(at("time"), { series: methods.map((m) => ({ name: m.name, colour: colour[m.name], points: m.curve })), xLabel: "CPU time [s]",
      xTicks: scene.methods[0].time.map((p) => p.seconds), formatX: (x) => digits(x), formatY: percent, level, onLevel: (l) => { level = l; fill(); } });
    fill();
    const withMemory = methods.filter((m) => m.memory.length > 0);
    at("memory-section").hidden = withMemory.length === 0;
    if (withMemory.length > 0)
      plot(at("memory"), { series: withMemory.map((m) => ({ name: m.name, colour: colour[m.name],
        points: m.memory.map((p) => point(p, p.photonBytes)) })), xLabel: "bytes",
        xTicks: Array.from({ length: 24 }, (_, i) => 2 ** (i + 16)), formatX: bytes, formatY: percent });
    const repeated = methods.filter((m) => last(m).variance !== null);
    const parts = [["bias", "#d55e00"], ["deviation", "#0072b2"]];
    at("parts").parentElement.hidden = repeated.length === 0;
    if (repeated.length > 0)
      bars(at("parts"), { stacked: false, format: percent, legend: parts.map(([label, c]) => ({ label, colour: c })), rows: repeated.map((m) => ({
        name: m.name, colour: colour[m.name], parts: [
          { label: "bias", value: root(last(m).bias), colour: parts[0][1] }, { label: "deviation", value: root(last(m).variance), colour: parts[1][1] }] })) });
    const stages = [...new Set(methods.flatMap((m) => last(m).stages.map(([name]) => name)))];
    const stageColour = (name) => COLOURS[stages.indexOf(name) % COLOURS.length];
    bars(at("stages"), { stacked: true, format: seconds, legend: stages.map((label) => ({ label, colour: stageColour(label) })), rows: methods.map((m) => ({
      name: m.name, colour: colour[m.name], parts: last(m).stages.map(([label, value]) => ({ label, value, colour: stageColour(label) })) })) });
    const reference = { name: "reference", picture: scene.reference.picture };
    viewer(at("pictures"), [reference, ...methods.filter((m) => m.picture)], scene.shownWidth, scene.shownHeight, scene.shrink);
    const r = scene.reference;
    at("summary").textContent = `${scene.name}, ${scene.width} × ${scene.height} pixels. ` +
      (r.method ? `Reference by ${r.method}, ${digits(r.cpu, 2)} s of CPU time, standard error ${percent(r.standardError)} of a pixel; ` +
        `two independent halves keep its noise out of the errors.` : "Reference as given.");
    at("failures-section").hidden = scene.failures.length === 0;
    at("failures").replaceChildren(...scene.failures.map((text) => html("li", { text })));
  }

  at("scenes").append(...data.scenes.map((scene) => html("button", { role: "tab", text: scene.name, onclick: () => { show(scene); history.replaceState(null, "", "#" + scene.name); } })));
  at("scenes").hidden = data.scenes.length < 2;
  at("footer").textContent = `${data.program}. Each run had one thread; ${data.repeats} ${data.repeats === 1 ? "run" : "runs of different seeds"} a point. ` +
    `The error is the root of the mean squared relative error of luminance, without the worst 0.1 % of the pixels.`;
  show(data.scenes.find((s) => "#" + s.name === location.hash) ?? data.scenes[0]);
})();
