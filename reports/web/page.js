"use strict";
// Draws the page's figures from its tables and redraws them when the noise level, theme or width changes. Their files and
// rows are in figure_data.js.
(() => {
  let study, tables;  // set by load()
  const dark = matchMedia("(prefers-color-scheme: dark)");

  // ---- colours and shapes: one place for all figures of the page, so that a method always looks the same.
  // Okabe-Ito, distinguishable with any colour vision; lighter on a dark background.
  const METHODS = {  // [on white, on dark, shape]
    known_direction_bound: ["#7b818b", "#98a0ad", "stroke"],
    mean_known: ["#7b818b", "#98a0ad", "circle"],
    mean: ["#56b4e9", "#7cc8f2", "circle"],
    mean_r: ["#009e73", "#2fbf95", "square"],
    w_mean: ["#e69f00", "#f0b429", "triangle-up"],
    w_mean_r: ["#cc79a7", "#dd93bb", "diamond"],
    maximum_likelihood: ["#d55e00", "#f07c2b", "cross"],
    posterior_mean: ["#0072b2", "#3f8fe0", "triangle-down"],
  };
  const OTHER_METHODS = [["#6a4c93", "#a98bd6", "wedge"], ["#7a5c3e", "#c09a74", "arrow"], ["#3b6e22", "#8bc26b", "stroke"]];
  const FAMILIES = { even: ["#0072b2", "#6db6ee", "circle", "Even"], distal: ["#d55e00", "#f07c2b", "square", "Distal"], both: ["#009e73", "#2fbf95", "diamond", "Both ends"] };
  const OTHER_FAMILY = ["#8a6d00", "#d8b83f", "triangle-up"];
  const SERIES = [["#56b4e9", "#7cc8f2"], ["#0072b2", "#3f8fe0"], ["#009e73", "#2fbf95"], ["#e69f00", "#f0b429"], ["#d55e00", "#f07c2b"]];
  const BOUND = { method: "known_direction_bound", title: "Bound, direction known" };
  const capital = (word) => word.charAt(0).toUpperCase() + word.slice(1);
  const onPaper = () => "paper" in document.documentElement.dataset;
  const isDark = () => dark.matches && !onPaper();
  const shade = (pair) => pair[isDark() ? 1 : 0];

  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // ---- the study's rows. A column is unpacked when a figure first asks for it, a row when it is drawn: a page may
  // hold ten thousand rows, of which few are visible.
  function unpacked({ words, index, runs }) {
    if (!runs) return index.map((k) => words[k]);
    const values = [];
    runs.forEach((length, k) => { for (let left = length; left > 0; --left) values.push(words[index[k]]); });
    return values;
  }
  function column(table, name) {
    const at = table.columns.indexOf(name);
    if (at >= 0 && !Array.isArray(table.values[at])) table.values[at] = unpacked(table.values[at]);
    return table.values[at];
  }
  function rowsAt(table, numbers) {
    const values = table.columns.map((name) => column(table, name));
    return numbers.map((number) => {
      const row = {};
      table.columns.forEach((name, k) => { row[name] = values[k][number]; });
      if ("family" in row) row.family_title = FAMILIES[row.family]?.[3] ?? capital(row.family);
      if ("regime" in row) row.regime_title = study.regime_titles[row.regime] ?? row.regime;
      return row;
    });
  }
  const allOf = (table) => [...Array(table.rows).keys()];

  function load() {
    study = { tables: {}, figures: {}, ...JSON.parse(document.getElementById("study-data").textContent) };  // a page may have none
    tables = {};
    for (const [name, table] of Object.entries(study.tables)) {
      let rows;
      Object.defineProperty(tables, name, { enumerable: true, get: () => rows ??= rowsAt(table, allOf(table)) });
    }
  }
  let passes = () => true;  // the filter of the page, if it has one
  let marks = { rowsOf: () => [], channel: () => "" };  // the samples that brush.js marks
  const chosenNoise = () => {
    const box = document.querySelector('input[name="noise"]:checked');
    return box ? Number(box.value) : tables.noise_level?.[0]?.noise_level_id;
  };

  function rowsOf(figure, name) {
    const { regime, recommendation, run, cable } = figure.dataset;
    const { knowledge } = about(figure);
    const table = study.tables[name];
    let numbers = allOf(table);
    const keep = (where, fits) => {
      const values = column(table, where);
      if (values) numbers = numbers.filter((number) => fits(values[number]));
    };
    if (regime) keep("regime", (value) => value === regime);
    if (recommendation) keep("recommendation_id", (value) => value === Number(recommendation));
    else { const noise = chosenNoise(); keep("noise_level_id", (value) => value === noise); }
    if (cable) keep("cable", (value) => value === cable);
    if (run) keep("run", (value) => value === Number(run));
    if (knowledge) keep("knowledge", (value) => knowledge.includes(value));
    return rowsAt(table, numbers).filter(passes);
  }
  const about = (figure) => study.figures[figure.dataset.figure].usermeta.capstan;
  const distinct = (rows, column) => [...new Set(rows.map((row) => row[column]))];

  const place = (family) => Object.keys(FAMILIES).indexOf(family) >>> 0;  // unknown families come last
  const familyOrder = (rows) => distinct(rows, "family").filter(Boolean).sort((a, b) => place(a) - place(b));

  // ---- named scales and @words of the specs
  function scales(rows) {
    const has = new Set(rows.map((row) => row.method));
    const methods = [...(tables.fusion_method ?? []), BOUND].filter((m) => has.has(m.method));
    let others = 0;
    const looks = methods.map((m) => METHODS[m.method] ?? OTHER_METHODS[others++ % OTHER_METHODS.length]);
    const families = familyOrder(rows);
    const family_titles = families.map((f) => FAMILIES[f]?.[3] ?? capital(f));
    const known = css("--known"), unknown = css("--unknown");
    return {
      method: { domain: methods.map((m) => m.title), range: looks.map(shade) },
      method_shape: { domain: methods.map((m) => m.title), range: looks.map((look) => look[2]) },
      family: { domain: family_titles, range: families.map((f) => shade(FAMILIES[f] ?? OTHER_FAMILY)) },
      family_shape: { domain: family_titles, range: families.map((f) => (FAMILIES[f] ?? OTHER_FAMILY)[2]) },
      estimate: { domain: ["true tension", "estimate, direction known", "estimate, direction unknown"], range: [css("--ink"), known, unknown] },
      direction: { domain: ["known", "unknown"], range: [known, unknown] },
      direction_shape: { domain: ["known", "unknown"], range: ["circle", "square"] },
      doubt_shape: { domain: ["unverified", "ambiguous", "unused"], range: ["circle", "square", "triangle-up"] },
      doubt: { domain: ["unverified", "ambiguous", "unused"], range: [unknown, known, css("--quiet")] },
      source: { domain: ["paper", "paper, upper bound", "this study"], range: [css("--quiet"), css("--quiet"), css("--accent")] },
      series: { range: SERIES.map(shade) },
      ends: { domain: ["motor", "load", "load, ideal transmission"].filter((name) => rows.some((row) => row.series === name)), range: [css("--unknown"), css("--known"), css("--quiet")] },
      bench_and_models: bench_and_models(rows),
      heat: { zero: true, interpolate: "lab", range: isDark() ? ["#16212c", "#1f5f86", "#63b5d8", "#f3f1d2"] : ["#f6f8f4", "#a9d3e0", "#3d8bb4", "#123a5e"] },
    };
  }

  // The bench is black, the model under test blue, the model it is compared with orange.
  function bench_and_models(rows) {
    const names = distinct(rows, "series").filter(Boolean);
    const look = (name) => /^(bench|measured)/.test(name) ? css("--quiet") : /without/.test(name) ? css("--unknown") : css("--known");
    return { domain: names, range: names.map(look) };
  }

  function fill(part, named, words) {
    if (Array.isArray(part)) return part.map((item) => fill(item, named, words));
    if (typeof part === "string") return part in words ? words[part] : part;
    if (part === null || typeof part !== "object") return part;
    const filled = {};
    for (const [key, value] of Object.entries(part)) {
      if (key === "scale" && typeof value === "string") filled[key] = named[value];
      else if (value === "panel") filled[key] = words["@" + key];
      else filled[key] = fill(value, named, words);
    }
    return filled;
  }

  // On a narrow screen the columns of a facet become rows; with rows already, each panel names both.
  const narrowest_panel_px = 150;
  function oneBelowTheOther(template) {
    const { row, column } = template.facet;
    const header = { labelFontWeight: 600, ...row?.header, ...column.header, orient: "top", labelAnchor: "start" };
    if (!row) {
      template.facet = { row: { ...column, header } };
      return;
    }
    template.transform = [...(template.transform ?? []), { calculate: `datum['${row.field}'] + ', ' + datum['${column.field}']`, as: "row_and_column" }];
    template.facet = { row: { field: "row_and_column", title: null, sort: null, header } };
  }

  function specOf(figure, trim, width_px) {
    const info = about(figure);
    const datasets = {};
    for (const table of info.tables) datasets[table] = rowsOf(figure, table);
    if (info.brush) datasets.marked = marks.rowsOf(figure);
    const rows = datasets[info.tables[0]];
    const room = (width_px ?? figure.querySelector(".chart").clientWidth) - trim;
    let columns = info.columns_by ? distinct(rows, info.columns_by).length : info.columns ?? 1;
    const template = { ...study.figures[figure.dataset.figure] };
    let frame = info.frame_width_px;
    if (template.hconcat && room < 760) {  // side by side would be cramped
      template.vconcat = template.hconcat;
      delete template.hconcat;
      figure.querySelector(".chart").style.minHeight = columns * (info.panel_height_px + info.frame_height_px) + "px";
      frame = frame / columns;
      columns = 1;
    }
    const beside = (room - frame - (info.gap_px ?? 0) * (columns - 1)) / columns;
    if (template.facet?.column && columns > 1 && beside < narrowest_panel_px) {
      oneBelowTheOther(template);
      const panels = columns * (info.rows_by ? distinct(rows, info.rows_by).length : 1);
      figure.querySelector(".chart").style.minHeight = panels * (info.panel_height_px + 48) + info.frame_height_px + "px";
      columns = 1;
    }
    const labels = template.data?.name === "paper_comparison" ? Math.min(frame - 30, room * 0.45) : frame;
    if (labels < frame) frame = labels + 30;
    const width = Math.max(110, Math.floor((room - frame - (info.gap_px ?? 0) * (columns - 1)) / columns));
    const named = scales(rows);
    const words = {
      "@width": width, "@height": info.panel_height_px,
      "@legend_columns": Math.max(1, Math.floor(room / 190)), "@gradient": Math.min(width, 200), "@label_limit": labels,
      "@objective": rows[0]?.scope === "minimax_regret" ? "largest regret [N]" : "mean tension error [N]",
      "@family_order": named.family.domain, "@marked_channel": marks.channel(),
    };
    for (const name of ["ink", "quiet", "accent", "sensor", "soft", "paper", "known", "unknown"]) words["@" + name] = css("--" + name);
    const spec = fill(template, named, words);
    delete spec.usermeta;
    const title = figure.querySelector("h3").firstChild.textContent;
    const caption = figure.querySelector("figcaption").textContent;
    return { ...spec, datasets, description: title + ". " + caption, config: theme(room, labelWidth(rows)), background: css("--paper"), autosize: { type: "pad", contains: "padding" }, padding: 4 };
  }

  const narrow_px = 520, narrowest_label_px = 110;
  const labelWidth = (rows) => Math.max(narrowest_label_px, ...distinct(rows, "series").map((name) => 34 + 6.5 * String(name ?? "").length));
  function theme(room = Infinity, label_px = narrowest_label_px) {
    const ink = css("--ink"), quiet = css("--quiet"), line = css("--line"), font = css("--font");
    return {
      font, view: { stroke: line },
      axis: { labelColor: quiet, titleColor: ink, gridColor: line, domainColor: line, tickColor: line, labelFontSize: 11, titleFontSize: 12, titleFontWeight: 500, titlePadding: 8 },
      legend: { labelColor: ink, titleColor: ink, labelFontSize: 12, titleFontWeight: 500, labelLimit: 240, offset: 10, columnPadding: 18, ...(room < narrow_px && { columns: Math.max(1, Math.floor((room - 80) / label_px)) }) },
      header: { labelColor: ink, titleColor: ink, labelFontSize: 12, labelFontWeight: 600, labelLimit: Math.min(400, room - 100) },
      title: { color: ink, fontSize: 12, fontWeight: 600 },
      mark: { aria: false },
    };
  }

  // ---- drawing: visible figures first, the rest while the browser is idle, so that a long page opens at once and
  // is complete when it is printed.
  let drawing = 0;
  const idle = () => new Promise((go) => (window.requestIdleCallback ?? setTimeout)(go, { timeout: 300 }));
  function distanceFromView(figure) {
    const { top, bottom } = figure.getBoundingClientRect();
    return Math.max(0, top - innerHeight, -bottom);
  }
  function nearest(figures) {
    let best = { figure: undefined, distance: Infinity };
    for (const figure of figures) {
      const distance = distanceFromView(figure);
      if (distance < best.distance) best = { figure, distance };
    }
    return best;
  }

  // For the program that has this page printed or its figures saved, which reads the console.
  let told = 0;
  function tell(all) {
    if (/^#(paper|figures=)/.test(location.hash)) console.info("capstan: " + ++told + " of " + all + " drawn");
  }
  const figures_to_print = () => 2 * document.querySelectorAll("figure[data-figure]").length;  // on the screen, then on paper

  async function draw(figure) {
    tell(figures_to_print());
    const spec = specOf(figure, 0);
    const empty = spec.datasets[about(figure).tables[0]].length === 0;
    figure.classList.toggle("empty", empty);
    if (empty) return;
    const chart = figure.querySelector(".chart");
    const options = {
      renderer: "svg", tooltip: { theme: dark.matches ? "dark" : "light" }, actions: false,
    };
    figure.view?.finalize();
    const place = chart.firstElementChild ?? chart.appendChild(document.createElement("div"));
    let done = await vegaEmbed(place, spec, options);
    // If long tick labels or legends exceed the width of the figure, it is drawn again, narrower by the excess. Narrower
    // panels may have longer labels.
    for (let trim = 0, redrawn = 0; redrawn < 3; ++redrawn) {
      const excess = Math.ceil(chart.querySelector("svg").getBoundingClientRect().width) - chart.clientWidth;
      if (excess <= 0) break;
      trim += excess + 1;
      done.finalize();
      done = await vegaEmbed(place, specOf(figure, trim), options);
    }
    // What Vega marks as a symbol without a name is part of the chart, which has one; a chart that scrolls can be reached.
    for (const part of chart.querySelectorAll("svg g[role]:not([aria-label])")) part.removeAttribute("role");
    if (chart.scrollWidth > chart.clientWidth) chart.tabIndex = 0;
    else chart.removeAttribute("tabindex");
    figure.view = done.view;
    const data = figure.querySelector("details.data");
    if (data.open) window.capstanPage.showRows(figure);
  }

  // For printing: synchronous, in black, as wide as the paper.
  function drawForPaper() {
    ++drawing;
    document.documentElement.dataset.paper = "";
    for (const figure of document.querySelectorAll("figure[data-figure]")) {
      tell(figures_to_print());
      if (figure.closest("[hidden]")) continue;
      const spec = specOf(figure, 0);
      if (spec.datasets[about(figure).tables[0]].length === 0) continue;
      const chart = figure.querySelector(".chart");
      const place = chart.firstElementChild ?? chart.appendChild(document.createElement("div"));
      const drawn = (wish) => {
        figure.view?.finalize();
        figure.view = new vega.View(vega.parse(vegaLite.compile(wish).spec), { renderer: "svg", container: place }).run();
        return Math.ceil(chart.querySelector("svg").getBoundingClientRect().width) - chart.clientWidth;
      };
      const excess = drawn(spec);
      if (excess > 0) drawn(specOf(figure, excess + 1));
    }
  }
  addEventListener("beforeprint", drawForPaper);
  addEventListener("afterprint", () => { delete document.documentElement.dataset.paper; drawAll(); });

  async function drawAll() {
    const mine = ++drawing;
    const state = document.documentElement.dataset;
    state.shown = state.drawn = "no";
    for (const card of document.querySelectorAll("[data-noise]")) card.hidden = Number(card.dataset.noise) !== chosenNoise();
    const waiting = new Set([...document.querySelectorAll("figure[data-figure]")].filter((figure) => !figure.closest("[hidden]")));
    while (waiting.size > 0) {
      const { figure, distance } = nearest(waiting);
      if (distance > 0) {
        if (state.shown === "no") performance.mark("figures in view are drawn");
        state.shown = "yes";
        await idle();
      }
      if (mine !== drawing) return;  // a newer request replaced this one
      const next = nearest(waiting).figure;  // the reader may have scrolled on
      waiting.delete(next);
      await draw(next);
      if (mine !== drawing) return;
    }
    state.shown = state.drawn = "yes";
    performance.mark("all figures are drawn");
  }

  // ---- events that redraw
  dark.addEventListener("change", drawAll);
  let lastWidth = document.documentElement.clientWidth, timer = 0;
  addEventListener("resize", () => {
    if (document.documentElement.clientWidth === lastWidth) return;
    lastWidth = document.documentElement.clientWidth;
    clearTimeout(timer);
    timer = setTimeout(drawAll, 150);
  });
  // For the other scripts of the page: figure_data.js, which begins, and those of the service.
  window.capstanPage = {
    tell,
    tables: () => tables,
    titles: () => study.regime_titles,
    tableOf: (name) => study.tables[name],
    tableNames: () => Object.keys(study.tables),
    rowsOf, about, specOf, onPaper, load, drawAll,
    looks: (rows) => ({ ...scales(rows), theme: theme() }),
    setMarks(made) { marks = made; },
    setFilter(filter) { passes = filter; return drawAll(); },
  };
})();
