"use strict";
// The page of a study in `capstan serve`: progress, filters. Reads the data of the report page (capstanPage) and requests
// the rest from the service.
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
    words.textContent = units.length > 0 ? `${state}: ${done} of ${units.length} units${left}.` : `${state}${left}.`;  // worlds are no units
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
    filters.hidden = !tables.regime?.length;  // a study over worlds has none
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

  // ---- sensors placed by hand
  const hand = section("hand", "Place sensors by hand");
  live.append(hand);
  const beginHand = () => window.capstanHand({ hand, api, ask, post, element });

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
