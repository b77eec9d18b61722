"use strict";
// The page of a study in `capstan serve`: progress, filters, layouts drawn by hand. Reads the data of the report page
// (capstanPage) and requests the rest from the service.
(() => {
  const id = Number(location.pathname.split("/").pop());
  const api = "/api/studies/" + id;

  async function ask(path, options) {
    const answer = await fetch(path, options);
    if (answer.ok) return answer.json();
    const problem = await answer.json().catch(() => ({}));
    throw new Error(problem.error ?? answer.status + " " + answer.statusText);
  }
  const post = (path, body) => ask(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body ?? {}) });

  function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }
  function section(name, title) {
    const made = element("section", { id: name }, element("h2", { id: name + "-title", textContent: title }));
    made.setAttribute("aria-labelledby", name + "-title");
    return made;
  }

  const live = element("div", { id: "live" });
  document.getElementById("content").before(live);

  // ---- progress
  const watch = section("watch", "Progress");
  const words = element("p", { role: "status" });
  const cells = element("div", { className: "cells", role: "img" });
  const button = element("button", { type: "button", className: "plain", hidden: true });
  const problem = element("p", { className: "problem", role: "alert" });
  watch.append(words, cells, element("p", {}, button), problem);
  live.append(watch);

  const ourJob = (jobs) => jobs.findLast((job) => job.study_id === id);
  button.addEventListener("click", async () => {
    problem.textContent = "";
    try { await post(button.dataset.path); } catch (error) { problem.textContent = error.message; }
  });

  function showProgress(study, units, job) {
    const done = units.filter((unit) => unit.done).length;
    const under_way = job && ["queued", "running"].includes(job.state);
    const state = study.status === "complete" ? "Complete" : under_way ? (job.state === "queued" ? "Waiting for its turn" : "Running") : "Stopped";
    const left = under_way && job.seconds_left > 0 ? `, about ${Math.max(1, Math.round(job.seconds_left))} s left` : "";
    words.textContent = `${state}: ${done} of ${units.length} units${left}.`;
    cells.setAttribute("aria-label", words.textContent);
    cells.replaceChildren(...units.map((unit) => element("i", { className: unit.done ? "done" : "", title: `${unit.stage}, ${unit.regime}, sample ${unit.sample}, ${unit.noise}` })));
    button.hidden = study.status === "complete";
    button.textContent = under_way ? "Stop" : "Resume";
    button.dataset.path = under_way ? `/api/jobs/${job.job}/stop` : api + "/resume";
    document.documentElement.dataset.study = study.status;
    return done + " " + study.status;
  }

  // Replaces the report by its current version and keeps the reader's settings.
  async function refreshReport() {
    const text = await (await fetch(location.pathname)).text();
    const fresh = new DOMParser().parseFromString(text, "text/html");
    const noise = document.querySelector('input[name="noise"]:checked')?.value;
    const open = [...document.querySelectorAll("main details[open]")].map((each) => each.closest("figure")?.id).filter(Boolean);
    for (const part of ["main", "nav", ".verdict", "#study-data"]) document.querySelector(part).replaceWith(fresh.querySelector(part));
    const chosen = noise && document.querySelector(`input[name="noise"][value="${noise}"]`);
    if (chosen) chosen.checked = true;
    await window.capstanPage.reload();
    for (const figure of open) document.querySelector(`#${figure} details.data`)?.setAttribute("open", "");
    showFilters();
  }

  // ---- filters
  const filters = section("filters", "Filters");
  const boxes = element("form", { className: "filters card" });
  boxes.addEventListener("submit", (event) => event.preventDefault());
  filters.append(boxes);
  live.append(filters);
  const hidden = { regime: new Set(), method_title: new Set() };
  const counts = { min: 1, max: Infinity };

  function choice(title, column, values) {
    const set = element("fieldset", {}, element("legend", { textContent: title }));
    for (const [value, name] of values) {
      const box = element("input", { type: "checkbox", checked: !hidden[column].has(value), value });
      box.dataset.filter = column;
      box.addEventListener("change", () => { hidden[column][box.checked ? "delete" : "add"](value); applyFilters(); });
      set.append(element("label", {}, box, " " + name));
    }
    return set;
  }
  function countInput(which, name, value) {
    const input = element("input", { type: "number", min: 1, max: 999, value: Number.isFinite(value) ? value : "" });
    input.dataset.filter = which;
    input.addEventListener("change", () => { counts[which] = input.value === "" ? (which === "min" ? 1 : Infinity) : Number(input.value); applyFilters(); });
    return element("label", {}, name + " ", input);
  }
  function showFilters() {
    const tables = window.capstanPage.tables(), titles = window.capstanPage.titles();
    const key = JSON.stringify([titles, tables.fusion_method]);
    if (boxes.dataset.key !== key) {
      boxes.dataset.key = key;
      boxes.replaceChildren(choice("Regimes", "regime", (tables.regime ?? []).map((row) => [row.regime, titles[row.regime] ?? row.regime])),
        choice("Methods", "method_title", (tables.fusion_method ?? []).map((row) => [row.title, row.title])),
        element("fieldset", {}, element("legend", { textContent: "Number of sensors" }), countInput("min", "from", counts.min), countInput("max", "to", counts.max)));
    }
    applyFilters();
  }
  function applyFilters() {
    for (const part of document.querySelectorAll("main figure[data-regime]")) part.hidden = hidden.regime.has(part.dataset.regime);
    return window.capstanPage.setFilter((row) =>
      !("regime" in row && hidden.regime.has(row.regime)) && !("method_title" in row && hidden.method_title.has(row.method_title)) &&
      !("sensor_count" in row && (row.sensor_count < counts.min || row.sensor_count > counts.max)));
  }

  // ---- layouts drawn by hand
  const hand = section("hand", "Place sensors by hand");
  hand.append(element("p", { className: "intro", textContent: "Select a node to add or remove a sensor. When a node has the focus, Shift and an arrow key move its sensor. The expected error uses the instants and noise draws of the study." }));
  const place = element("div", { className: "hand card" });
  hand.append(place);
  live.append(hand);
  const placed = new Set();
  let nodes_m = [];

  function select(name, label, options) {
    const made = element("select", { id: "hand-" + name }, ...options.map(([value, text]) => element("option", { value, textContent: text })));
    made.addEventListener("change", score);
    return element("span", { className: "choice" }, element("label", { htmlFor: made.id, textContent: label }), made);
  }
  const value = (name) => document.getElementById("hand-" + name).value;

  const svgNs = "http://www.w3.org/2000/svg";
  function drawn(name, attributes, ...children) {
    const made = document.createElementNS(svgNs, name);
    for (const [key, each] of Object.entries(attributes)) made.setAttribute(key, each);
    made.append(...children);
    return made;
  }
  const left = 66, right = 694, cable_y = 66, pin_y = 22;
  const x_of = (arc_m) => left + (right - left) * (arc_m - nodes_m[0]) / (nodes_m.at(-1) - nodes_m[0]);

  function drawCable(segments) {
    nodes_m = [segments[0].start_m, ...segments.map((each) => each.start_m + each.length_m)];
    const svg = drawn("svg", { class: "cable", viewBox: "0 0 760 130", role: "group", "aria-label": "Cable from motor to load; nodes are check boxes" });
    svg.append(drawn("line", { class: "conduit", x1: left, y1: cable_y, x2: right, y2: cable_y }));
    const sharpest = Math.max(...segments.map((each) => each.bend_radius_m ? 1 / each.bend_radius_m : 0));
    for (const each of segments) {
      if (!each.bend_radius_m) continue;
      svg.append(drawn("rect", { class: "bend", x: x_of(each.start_m), y: cable_y - 9, width: x_of(each.start_m + each.length_m) - x_of(each.start_m), height: 18, "fill-opacity": 0.12 + 0.3 / each.bend_radius_m / sharpest },
        drawn("title", {}, `bend radius ${each.bend_radius_m.toPrecision(3)} m, wrap angle ${each.wrap_angle_rad.toPrecision(3)} rad`)));
    }
    svg.append(drawn("line", { class: "core", x1: left, y1: cable_y, x2: right, y2: cable_y }));
    for (const [x, name] of [[left - 34, "motor"], [right + 34, "load"]])
      svg.append(drawn("rect", { class: "end", x: x - 22, y: cable_y - 15, width: 44, height: 30, rx: 6 }), drawn("text", { class: "end-name", x, y: cable_y + 4 }, name));
    const roomy = (right - left) / (nodes_m.length - 1) > 26;
    nodes_m.forEach((arc_m, k) => svg.append(pin(k + 1, x_of(arc_m), roomy)));
    for (let tick = 0; tick <= 5; ++tick) {
      const arc_m = nodes_m[0] + (nodes_m.at(-1) - nodes_m[0]) * tick / 5;
      svg.append(drawn("text", { class: "tick", x: x_of(arc_m), y: 118 }, Number(arc_m.toPrecision(3)) + (tick === 5 ? " m" : "")));
    }
    return svg;
  }
  function pin(node, x, roomy) {
    const group = drawn("g", { class: "place", role: "checkbox", tabindex: 0, "aria-checked": "false", "aria-label": "sensor at node " + node, "data-node": node },
      drawn("rect", { class: "hit", x: x - (roomy ? 13 : 5), y: 4, width: roomy ? 26 : 10, height: 76 }), drawn("line", { x1: x, y1: pin_y, x2: x, y2: cable_y }),
      drawn("circle", { class: "node", cx: x, cy: cable_y, r: 3 }), drawn("circle", { class: "pin", cx: x, cy: pin_y, r: roomy ? 12 : 5 }));
    if (roomy) group.append(drawn("text", { x, y: pin_y + 4.5 }, String(node)));
    group.addEventListener("click", () => toggle(node));
    group.addEventListener("keydown", (event) => {
      if (event.key === " " || event.key === "Enter") { event.preventDefault(); toggle(node); }
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const to = node + step;
      if (to < 1 || to > nodes_m.length) return;
      if (event.shiftKey && placed.has(node) && !placed.has(to)) { placed.delete(node); placed.add(to); showPlaced(); }
      place.querySelector(`[data-node="${to}"]`).focus();
    });
    return group;
  }
  function toggle(node) {
    placed.has(node) ? placed.delete(node) : placed.add(node);
    showPlaced();
  }
  function put(nodes) {
    placed.clear();
    for (const node of nodes) placed.add(node);
    showPlaced();
  }
  function showPlaced() {
    for (const each of place.querySelectorAll(".place")) each.setAttribute("aria-checked", placed.has(Number(each.dataset.node)));
    score();
  }

  const expected = element("p", { className: "expected", role: "status", id: "hand-expected" });
  const detail = element("p", { className: "quiet" });
  const chart = element("div", { className: "chart", id: "hand-chart" });
  chart.style.minHeight = "230px";
  let asked = 0, shown = null;
  async function score() {
    const mine = ++asked;
    if (placed.size === 0) {
      expected.textContent = "No sensor is placed.";
      detail.textContent = "";
      shown = null;
      chart.replaceChildren();
      return;
    }
    try {
      const nodes = [...placed].sort((a, b) => a - b);
      const answer = await post(api + "/layout", { nodes, method: value("method"), regime: value("regime"), noise: Number(value("noise")) });
      if (mine !== asked) return;  // a newer question replaced this one
      expected.textContent = `Expected error ${answer.mean_abs_error_N.toPrecision(4)} N`;
      detail.textContent = `95% interval ${answer.interval_low_N.toPrecision(4)} to ${answer.interval_high_N.toPrecision(4)} N, mean over the cable, ${answer.instants} instant${answer.instants === 1 ? "" : "s"}, ${answer.repetitions} repetitions; ${nodes.length} sensor${nodes.length === 1 ? "" : "s"} at node${nodes.length === 1 ? "" : "s"} ${nodes.join(", ")}.`;
      await drawErrors(answer);
      shown = answer;
      expected.dataset.answered = (Number(expected.dataset.answered) || 0) + 1;
    } catch (error) {
      if (mine === asked) expected.textContent = error.message;
    }
  }
  async function drawErrors(answer) {
    const { theme } = window.capstanPage.looks([]);
    const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const rows = answer.nodes.map((each) => ({ ...each, arc_length_m: nodes_m[each.node - 1], sensor: placed.has(each.node) }));
    const x = { field: "arc_length_m", type: "quantitative", title: "distance from the motor [m]", scale: { nice: false, padding: 10 }, axis: { grid: false, tickCount: 8 } };
    const y = { field: "mean_abs_error_N", type: "quantitative", title: "expected error [N]", scale: { zero: true } };
    const tooltip = [{ field: "node" }, { field: "mean_abs_error_N", title: "error [N]", format: ".4f" }, { field: "bias_N", title: "bias [N]", format: ".4f" }];
    await vegaEmbed(chart, {
      $schema: "https://vega.github.io/schema/vega-lite/v6.json", data: { values: rows }, width: Math.max(200, chart.clientWidth - 70), height: 170, background: null, config: theme,
      description: "Expected error at each node; " + expected.textContent,
      layer: [{ mark: { type: "line", color: css("--accent"), strokeWidth: 2 }, encoding: { x, y } },
        { mark: { type: "point", filled: true, size: 70 }, encoding: { x, y, tooltip, color: { condition: { test: "datum.sensor", value: css("--sensor") }, value: css("--accent") } } }],
    }, { renderer: "svg", actions: { export: { svg: true, png: true }, source: false, compiled: false, editor: false }, downloadFileName: "expected-error" });
  }

  const drawAgain = () => { if (shown) drawErrors(shown); };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawAgain);
  addEventListener("resize", drawAgain);

  // Of a study over worlds: any selection of what can be bought, judged in the worlds of the study.
  async function beginSensors() {
    const offered = await ask(api + "/sensors");
    hand.querySelector(".intro").textContent = "Select sensors to buy. Their expected error comes from the same worlds as that of the recommended set.";
    const set = element("fieldset", {}, element("legend", { textContent: "Sensors" }));
    for (const each of offered.sensors) {
      const box = element("input", { type: "checkbox", value: each.sensor, checked: offered.recommended.includes(each.sensor) });
      box.addEventListener("change", judge);
      set.append(element("label", {}, box, ` ${each.words}${each.cable ? " of cable " + each.cable : ""} (price ${each.price})`));
    }
    place.replaceChildren(element("form", { className: "filters" }, set), expected, detail);
    const N = (number) => number.toFixed(3) + " N", between = ([low, high]) => `${low.toFixed(3)} to ${N(high)}`;
    async function judge() {
      const mine = ++asked;
      const sensors = [...set.querySelectorAll("input:checked")].map((box) => Number(box.value));
      detail.textContent = "";
      if (sensors.length === 0) { expected.textContent = "No sensor is placed."; return; }
      expected.textContent = "Running the worlds of the study …";
      try {
        const answer = await post(api + "/sensors", { sensors });
        if (mine !== asked) return;  // a newer question replaced this one
        expected.textContent = `Expected error ${N(answer.expected_error_N)}, in 95% of the worlds below ${N(answer.error_95_N)}`;
        detail.textContent = `${answer.set}; price ${answer.price}${answer.allowed ? "" : ", not allowed by the constraints of the study"}. Monte-Carlo interval ${between(answer.monte_carlo_interval_N)}, ${answer.worlds} worlds. ` +
          `Gain over no sensor: ${N(answer.gain_over_no_sensor_N)} (${between(answer.gain_interval_N)}). Compared with the recommended set (${answer.recommended}): ` +
          (answer.distinguishable ? `${N(Math.abs(answer.worse_than_recommended_N))} ${answer.worse_than_recommended_N > 0 ? "worse" : "better"} (${between(answer.worse_interval_N)}).`
            : `not distinguishable (difference ${between(answer.worse_interval_N)}).`);
        expected.dataset.answered = (Number(expected.dataset.answered) || 0) + 1;
      } catch (error) {
        if (mine === asked) expected.textContent = error.message;
      }
    }
    await judge();
  }

  async function beginHand() {
    const [cable, study] = await Promise.all([ask(api + "/cable"), ask(api)]);
    if (study.candidates !== undefined) {
      if (study.status === "complete") return beginSensors();
      place.replaceChildren("Sensors can be placed when the study is complete.");
      return;
    }
    const tables = window.capstanPage.tables(), titles = window.capstanPage.titles();
    const advice = tables.recommendation ?? [];
    const use = element("select", { id: "hand-use" }, element("option", { value: "", textContent: "a recommendation …" }),
      ...advice.map((row, k) => element("option", { value: k, textContent: `${row.scope === "regime" ? titles[row.regime] : row.scope.replace("_", " ")}, ${row.noise}: ${row.sensor_count} sensors` })));
    use.addEventListener("change", () => {
      const row = advice[Number(use.value)];
      if (use.value === "" || !row) return;
      document.getElementById("hand-method").value = row.method;
      if (row.regime) document.getElementById("hand-regime").value = row.regime;
      const noise = study.noise_levels.findIndex((level) => level.label === row.noise);
      if (noise >= 0) document.getElementById("hand-noise").value = noise + 1;
      put(JSON.parse(row.nodes));
    });
    const regimes = [...new Set(study.scenarios.map((each) => each.regime))];
    const methods = (tables.fusion_method ?? []).map((row) => [row.method, row.title]);
    place.replaceChildren(element("div", { className: "choices" }, select("regime", "Regime", regimes.map((each) => [each, titles[each] ?? each])),
      select("noise", "Noise", study.noise_levels.map((level) => [level.noise, level.label])), select("method", "Method", methods),
      ...(advice.length ? [element("span", { className: "choice" }, element("label", { htmlFor: "hand-use", textContent: "Use" }), use)] : [])), drawCable(cable), expected, detail, chart);
    const best = methods.find(([name]) => name === "posterior_mean") ?? methods.at(-1);
    if (best) document.getElementById("hand-method").value = best[0];
    const first = advice[0];
    if (first) {
      use.value = 0;
      use.dispatchEvent(new Event("change"));
    } else {
      put([1, nodes_m.length]);
    }
  }

  // ---- polling
  async function begin() {
    document.querySelector("nav ul").prepend(element("li", {}, element("a", { href: "/", textContent: "All studies" })));
    let seen = "";
    for (;;) {
      try {
        const [studies, units, jobs] = await Promise.all([ask("/api/studies"), ask(api + "/units"), ask("/api/jobs")]);
        const study = studies.find((each) => each.study_id === id);
        const now = showProgress(study, units, ourJob(jobs));
        if (seen !== "" && now !== seen) await refreshReport();
        if (seen === "") showFilters();
        if (seen === "" || (now !== seen && study.status === "complete")) await beginHand();
        seen = now;
        document.documentElement.dataset.live = "yes";
        problem.textContent = "";
        if (study.status === "complete") return;
      } catch (error) {
        problem.textContent = error.message;
      }
      await new Promise((wake) => setTimeout(wake, document.hidden ? 5000 : 1000));
    }
  }
  begin();
})();
