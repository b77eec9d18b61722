"use strict";
// Sensors placed by hand on a study's page: their expected error beside that of the recommendation, over a regime or the
// duty cycle, and a link that shares them. The address of the page holds the places and the method.
window.capstanHand = async ({ hand, api, ask, post, element }) => {
  const byId = (id) => document.getElementById(id);
  const plural = (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`;
  const place = element("div", { className: "hand card" });
  const expected = element("p", { className: "expected", role: "status", id: "hand-expected" });
  const detail = element("p", { className: "quiet" });
  const linked = new URLSearchParams(location.search);
  const numbers = (name) => (linked.get(name) ?? "").split(",").filter(Boolean).map(Number).filter(Number.isInteger);

  // ---- the link
  const address = element("input", { type: "text", readOnly: true, id: "hand-link", size: 30 });
  const copied = element("span", { role: "status", className: "quiet" });
  const copy = element("button", { type: "button", className: "plain", textContent: "Copy" });
  copy.addEventListener("click", async () => {
    address.select();
    try { await navigator.clipboard.writeText(address.value); } catch { document.execCommand("copy"); }  // no clipboard without HTTPS
    copied.textContent = "Copied.";
  });
  const link = element("p", { className: "choices" }, element("label", { htmlFor: "hand-link", textContent: "Link to this layout" }), address, copy, copied);
  function share(values) {
    const url = new URL(location.href);
    url.search = new URLSearchParams(values).toString().replaceAll("%2C", ",");
    url.hash = "hand";
    address.value = url.href;
    copied.textContent = "";
    history.replaceState(null, "", url.pathname + url.search + location.hash);
  }

  // One question at a time, and after it the newest: a drag asks many.
  let is_asking = false, is_old = false;
  async function score(question) {
    is_old = true;
    if (is_asking) return;
    is_asking = true;
    place.ariaBusy = "true";
    while (is_old) {
      is_old = false;
      try {
        if (await question(() => is_old)) expected.dataset.answered = (Number(expected.dataset.answered) || 0) + 1;
      } catch (error) {
        expected.textContent = error.message;
        detail.textContent = "";
      }
    }
    is_asking = false;
    place.ariaBusy = "false";
  }

  // Of a study over worlds: any selection of what can be bought, judged in the worlds of the study.
  async function beginSensors() {
    const offered = await ask(api + "/sensors");
    hand.append(element("p", { className: "intro", textContent: "Select sensors to buy. Their expected error comes from the same worlds as that of the recommended set." }), place);
    const set = element("fieldset", {}, element("legend", { textContent: "Sensors" }));
    const first = linked.has("sensors") ? numbers("sensors") : offered.recommended;
    for (const each of offered.sensors) {
      const box = element("input", { type: "checkbox", value: each.sensor, checked: first.includes(each.sensor) });
      box.addEventListener("change", () => score(judge));
      set.append(element("label", {}, box, ` ${each.words}${each.cable ? " of cable " + each.cable : ""} (price ${each.price})`));
    }
    place.replaceChildren(element("form", { className: "filters" }, set), expected, detail, link);
    const N = (number) => number.toFixed(3) + " N", between = ([low, high]) => `${low.toFixed(3)} to ${N(high)}`;
    async function judge(has_changed) {
      const sensors = [...set.querySelectorAll("input:checked")].map((box) => Number(box.value));
      share({ sensors: sensors.join(",") });
      detail.textContent = "";
      if (sensors.length === 0) { expected.textContent = "No sensor is placed."; return false; }
      expected.textContent = "Running the worlds of the study …";
      const answer = await post(api + "/sensors", { sensors });
      if (has_changed()) return false;
      expected.textContent = `Expected error ${N(answer.expected_error_N)}, in 95% of the worlds below ${N(answer.error_95_N)}`;
      detail.textContent = `${answer.set}; price ${answer.price}${answer.allowed ? "" : ", not allowed by the constraints of the study"}. Monte-Carlo interval ${between(answer.monte_carlo_interval_N)}, ${answer.worlds} worlds. ` +
        `Gain over no sensor: ${N(answer.gain_over_no_sensor_N)} (${between(answer.gain_interval_N)}). Compared with the recommended set (${answer.recommended}): ` +
        (answer.distinguishable ? `${N(Math.abs(answer.worse_than_recommended_N))} ${answer.worse_than_recommended_N > 0 ? "worse" : "better"} (${between(answer.worse_interval_N)}).`
          : `not distinguishable (difference ${between(answer.worse_interval_N)}).`);
      return true;
    }
    await score(judge);
  }

  // ---- the nodes of a study at instants
  async function beginPins(cable, study) {
    hand.append(element("p", { className: "intro", textContent: "Drag a sensor along the cable; click a node to add or remove one. With the keyboard, Space adds or removes a sensor, and Shift with an arrow key moves it. The expected error uses the instants and noise draws of the study." }), place);
    const tables = window.capstanPage.tables(), titles = window.capstanPage.titles();
    const advice = tables.recommendation ?? [];
    const asked = () => score(judge);
    function select(name, label, options) {
      const made = element("select", { id: "hand-" + name }, ...options.map(([value, text]) => element("option", { value, textContent: text })));
      made.addEventListener("change", asked);
      return element("span", { className: "choice" }, element("label", { htmlFor: made.id, textContent: label }), made);
    }
    const value = (name) => byId("hand-" + name).value;
    function choose(name, wanted) {
      if (wanted != null && [...byId("hand-" + name).options].some((each) => each.value === String(wanted))) byId("hand-" + name).value = wanted;
    }
    const noiseOf = (row) => study.noise_levels.find((level) => level.label === row.noise)?.noise;
    const scopeOf = (row) => row.scope === "regime" ? titles[row.regime] : row.scope.replace("_", " ");
    const adviceHere = () => advice.find((row) => noiseOf(row) === Number(value("noise")) && (row.scope === "regime" ? row.regime : row.scope) === value("regime"));

    const use = element("select", { id: "hand-use" }, element("option", { value: "", textContent: "a recommendation …" }),
      ...advice.map((row, k) => element("option", { value: k, textContent: `${scopeOf(row)}, ${row.noise}: ${plural(row.sensor_count, "sensor")}` })));
    function take(row) {
      choose("method", row.method);
      choose("regime", row.scope === "regime" ? row.regime : "duty_cycle");
      choose("noise", noiseOf(row));
      pins.put(JSON.parse(row.nodes));
    }
    use.addEventListener("change", () => { if (use.value !== "") take(advice[Number(use.value)]); });
    const regimes = [...new Set(study.scenarios.map((each) => each.regime))].map((each) => [each, titles[each] ?? each]);
    const methods = (tables.fusion_method ?? []).map((row) => [row.method, row.title]);
    const chart = element("div", { className: "chart", id: "hand-chart" });
    chart.style.minHeight = "250px";
    const figure = element("div", { className: "hand-figure" }, chart);
    let pins = window.capstanPins(cable, place.clientWidth, asked);
    const pins_place = element("div", {}, pins.svg);
    place.replaceChildren(element("div", { className: "choices" },
      select("regime", "Instants", [...regimes, ...(regimes.length > 1 ? [["duty_cycle", "the duty cycle"]] : [])]),
      select("noise", "Noise", study.noise_levels.map((level) => [level.noise, level.label])), select("method", "Method", methods),
      ...(advice.length ? [element("span", { className: "choice" }, element("label", { htmlFor: "hand-use", textContent: "Use" }), use)] : [])),
    pins_place, expected, detail, figure, link);

    let shown = null;
    const wordsOf = (nodes) => `${plural(nodes.length, "sensor")} at node${nodes.length === 1 ? "" : "s"} ${nodes.join(", ")} (${nodes.map((node) => Number(pins.nodes_m[node - 1]?.toPrecision(3))).join(", ")} m)`;
    async function judge(has_changed) {
      const nodes = [...pins.placed].sort((a, b) => a - b);
      share({ nodes: nodes.join(","), method: value("method"), regime: value("regime"), noise: value("noise") });
      if (nodes.length === 0) {
        expected.textContent = "No sensor is placed.";
        detail.textContent = "";
        shown = null;
        chart.replaceChildren();
        return false;
      }
      const row = adviceHere();
      const reference = row && { nodes: JSON.parse(row.nodes), method: row.method };
      const answer = await post(api + "/layout", { nodes, method: value("method"), regime: value("regime"), noise: Number(value("noise")), ...(reference && { reference }) });
      if (has_changed()) return false;
      const between = (low, high) => low == null || high == null ? "" : ` (95% interval ${low.toPrecision(4)} to ${high.toPrecision(4)} N)`;
      expected.textContent = `Expected error ${answer.mean_abs_error_N.toPrecision(4)} N`;
      detail.textContent = `${wordsOf(nodes)}: mean over the cable, ${plural(answer.instants, "instant")}, ${answer.repetitions} repetitions${between(answer.interval_low_N, answer.interval_high_N)}.`;
      if (reference) {
        const same = String(reference.nodes) === String(nodes) && reference.method === value("method");
        const [low, high] = answer.worse_interval_N, difference = answer.worse_than_reference_N;
        detail.textContent += ` The recommendation here is ` + (same ? "this layout." : `${wordsOf(reference.nodes)} with ${row.method_title}: ${answer.reference.mean_abs_error_N.toPrecision(4)} N on the same draws. ` +
          (low == null || (low <= 0 && high >= 0) ? "The two cannot be distinguished" : `This layout is ${Math.abs(difference).toPrecision(3)} N ${difference > 0 ? "worse" : "better"}`) +
          (low == null ? "." : ` (difference ${low.toPrecision(3)} to ${high.toPrecision(3)} N).`));
      }
      shown = { answer, nodes, is_recommended: !reference || detail.textContent.endsWith("this layout.") };
      await drawErrors();
      return true;
    }

    const rowsOf = ({ answer, nodes, is_recommended }) => [["by hand", answer], ...(is_recommended ? [] : [["recommended", answer.reference]])].flatMap(([layout, score]) =>
      score.nodes.map((each) => ({ layout, ...each, arc_length_m: pins.nodes_m[each.node - 1], sensor: layout === "by hand" && nodes.includes(each.node) ? "yes" : "no" })));
    function specOf(width_px) {
      const { theme } = window.capstanPage.looks([]);
      const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
      const width = Math.max(180, width_px - 60);
      const x = { field: "arc_length_m", type: "quantitative", title: "distance from the motor [m]", scale: { nice: false, padding: 10 }, axis: { grid: false, tickCount: Math.min(8, Math.floor(width / 50)) } };
      const y = { field: "mean_abs_error_N", type: "quantitative", title: "error [N]", scale: { zero: true } };
      const color = { field: "layout", type: "nominal", title: null, scale: { domain: shown.is_recommended ? ["by hand"] : ["by hand", "recommended"], range: [css("--accent"), css("--quiet")] }, legend: { orient: "top" } };
      const tooltip = [{ field: "layout" }, { field: "node" }, { field: "mean_abs_error_N", title: "error [N]", format: ".4f" }, { field: "bias_N", title: "bias [N]", format: ".4f" },
        { field: "low_N", title: "5% of the draws below [N]", format: ".4f" }, { field: "high_N", title: "95% of the draws below [N]", format: ".4f" }];
      const by_hand = { filter: "datum.layout === 'by hand'" };
      return {
        $schema: "https://vega.github.io/schema/vega-lite/v6.json", data: { values: rowsOf(shown) }, width, height: 170, background: css("--paper"), config: theme,
        description: "Expected error at each node, with the band of 90% of the draws; " + expected.textContent,
        layer: [{ transform: [by_hand], mark: { type: "area", color: css("--accent"), opacity: 0.18 }, encoding: { x, y: { ...y, field: "low_N" }, y2: { field: "high_N" } } },
          { mark: { type: "line", strokeWidth: 2 }, encoding: { x, y, color, strokeDash: { condition: { test: "datum.layout === 'recommended'", value: [5, 4] }, value: [1, 0] } } },
          { transform: [by_hand], mark: { type: "point", filled: true, opacity: 1 }, encoding: { x, y, tooltip, size: { condition: { test: "datum.sensor === 'yes'", value: 110 }, value: 40 }, color: { condition: { test: "datum.sensor === 'yes'", value: css("--sensor") }, value: css("--accent") } } }],
      };
    }
    async function drawErrors() {
      if (!figure.querySelector(".save")) figure.prepend(window.capstanPage.saveButtons("expected-error", "Expected error at each node", () => specOf(chart.clientWidth), () => rowsOf(shown)));
      await vegaEmbed(chart, specOf(chart.clientWidth), { renderer: "svg", actions: false });
    }
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { if (shown) drawErrors(); });
    let last_px = place.clientWidth;
    addEventListener("resize", () => {
      if (place.clientWidth === last_px) return;
      last_px = place.clientWidth;
      const nodes = [...pins.placed];
      pins = window.capstanPins(cable, last_px, asked);
      pins_place.replaceChildren(pins.svg);
      pins.put(nodes);
    });

    choose("method", methods.find(([name]) => name === "posterior_mean")?.[0] ?? methods.at(-1)?.[0]);
    if (linked.has("nodes")) {
      for (const name of ["method", "regime", "noise"]) choose(name, linked.get(name));
      pins.put(numbers("nodes"));
    } else if (advice.length) {
      use.value = 0;
      take(advice[0]);
    } else {
      pins.put([1, pins.nodes_m.length]);
    }
  }

  const [cable, study] = await Promise.all([ask(api + "/cable"), ask(api)]);
  for (const each of [...hand.children].slice(1)) each.remove();
  if (study.candidates === undefined) await beginPins(cable, study);
  else if (study.status === "complete") await beginSensors();
  else hand.append(element("p", { textContent: "Sensors can be placed when the study is complete." }));
  if (location.hash === "#hand") hand.scrollIntoView();
};
