"use strict";
// The front page of `capstan serve`: studies, the queue, diagnoses, the query box.
(() => {
  const at = (id) => document.getElementById(id);

  // ---- requests
  async function ask(path, options = {}) {
    const answer = await fetch(path, options);
    if (answer.ok) return answer;
    const problem = await answer.json().catch(() => ({}));
    throw new Error(problem.error ?? answer.status + " " + answer.statusText);
  }
  const get = async (path) => (await ask(path)).json();
  const post = (path, body) => ask(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body ?? {}) });

  function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }
  globalThis.capstanPage = { at, ask, element };  // for import.js
  const cell = (...children) => element("td", {}, ...children);
  const link = (href, text) => element("a", { href, textContent: text });

  // ---- studies and queue
  const seconds = (s) => s < 90 ? Math.max(1, Math.round(s)) + " s" : s < 5400 ? Math.round(s / 60) + " min" : (s / 3600).toFixed(1) + " h";

  function bar(fraction, words) {
    return [element("progress", { max: 1, value: fraction, ariaLabel: "done" }), " " + words];
  }

  function showStudies(studies, jobs) {
    at("study-table").tBodies[0].replaceChildren(...studies.toReversed().map((study) => {
      const job = jobs.findLast((each) => each.study_id === study.study_id);
      const idle = study.status === "running" && !(job && ["queued", "running"].includes(job.state));
      const resume = element("button", { type: "button", className: "plain", textContent: "Resume", ariaLabel: "Resume study " + study.study_id });
      resume.addEventListener("click", () => act(post("/api/studies/" + study.study_id + "/resume")));
      return element("tr", {},
        element("th", { scope: "row" }, link("/studies/" + study.study_id, "Study " + study.study_id)), cell(study.name),
        cell(idle ? "stopped" : study.status), cell(...bar(study.units ? study.units_done / study.units : 0, study.units_done + " of " + study.units + " units")),
        cell(...(idle ? [resume] : job ? ["job " + job.job] : [])));
    }));
  }

  function showJobs(jobs) {
    at("job-table").tBodies[0].replaceChildren(...jobs.toReversed().slice(0, 20).map((job) => {
      const activity = [job.activity, job.seconds_left > 0 ? "about " + seconds(job.seconds_left) + " left" : ""].filter(Boolean).join(", ");
      const does = ["queued", "running"].includes(job.state) ? "stop" : ["stopped", "failed"].includes(job.state) ? "resume" : "";
      const button = element("button", { type: "button", className: "plain", textContent: does === "stop" ? "Stop" : "Resume", ariaLabel: does + " job " + job.job });
      button.addEventListener("click", () => act(post("/api/jobs/" + job.job + "/" + does)));
      const result = job.study_id ? link("/studies/" + job.study_id, "study " + job.study_id) : job.diagnosis_id ? link("#diagnosis-" + job.diagnosis_id, "diagnosis " + job.diagnosis_id) : "";
      const row = element("tr", {}, element("th", { scope: "row", textContent: "Job " + job.job }), cell(job.kind + " " + job.title), cell(job.state),
        cell(...(job.state === "running" ? bar(job.fraction, activity) : [job.message])), cell(result), cell(...(does ? [button] : [])));
      row.dataset.state = job.state;
      return row;
    }));
  }

  let shownDiagnoses = "";
  async function refresh() {
    try {
      const [studies, jobs, diagnoses] = await Promise.all([get("/api/studies"), get("/api/jobs"), get("/api/diagnoses")]);
      showStudies(studies, jobs);
      showJobs(jobs);
      if (JSON.stringify(diagnoses) !== shownDiagnoses) showDiagnoses(diagnoses);
      shownDiagnoses = JSON.stringify(diagnoses);
      at("notice").textContent = "";
    } catch (error) {
      at("notice").textContent = "The service does not answer: " + error.message;
    }
  }
  async function act(promise) {
    try { await promise; } catch (error) { at("notice").textContent = error.message; return; }
    refresh();
  }

  // ---- starting a study
  async function listConfigs() {
    for (const name of await get("/api/configs")) at("config-name").append(element("option", { value: name, textContent: name }));
  }
  at("config-name").addEventListener("change", async () => {
    const name = at("config-name").value;
    if (name) at("config-text").value = await (await ask("/api/configs/" + encodeURIComponent(name))).text();
  });
  at("config-text").addEventListener("input", () => { at("config-name").value = ""; });
  at("start-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    at("start-problem").textContent = "";
    const name = at("config-name").value;
    try {
      await post("/api/studies", name ? { config: name } : { config_toml: at("config-text").value });
      await refresh();
      at("studies").scrollIntoView();
    } catch (error) {
      at("start-problem").textContent = error.message;
    }
  });

  // ---- diagnoses
  const percent = (fraction) => fraction == null ? "" : Math.round(100 * fraction) + "%";
  const digits = (value) => value == null ? "" : Number(value).toPrecision(3);

  function diagnosisCard(row) {
    const channel = element("p", { className: "quiet" }, row.channel ? `${row.channel}: RMS of the gap ${digits(row.rms_before_in_unit)} ${row.unit} before, ${digits(row.rms_after_in_unit)} after, ${digits(row.rms_held_out_in_unit)} held out` +
      (row.closed_fraction == null ? "" : `; ${percent(row.closed_fraction)} (${percent(row.closed_low_fraction)} to ${percent(row.closed_high_fraction)}) of it closed`) + "." : "");
    const more = element("details", { className: "data" }, element("summary", { textContent: "Every cause and its probability" }), element("div"));
    more.addEventListener("toggle", async () => {
      if (!more.open || more.lastChild.childElementCount) return;
      const rows = await (await post("/api/query", { sql: `SELECT place, effect, probability_fraction FROM diagnosis_effect WHERE diagnosis_id = ${row.diagnosis_id} ORDER BY place` })).json();
      more.lastChild.append(tableOf(rows));
    });
    const card = element("article", { className: "card verdict-card", id: "diagnosis-" + row.diagnosis_id },
      element("h3", { textContent: `${row.recording}: ${row.verdict} (${percent(row.confidence_fraction)})` }),
      element("p", { textContent: row.sentence + (row.component && row.component !== "none" ? ` In ${row.component}${row.cable_end ? ", at the " + row.cable_end + " end" : ""}${row.position_m == null ? "" : ", about " + digits(row.position_m) + " m from the motor"}.` : "") }),
      channel, more);
    card.dataset.verdict = row.verdict;
    return card;
  }
  function showDiagnoses(rows) {
    at("diagnosis-list").replaceChildren(...rows.map(diagnosisCard));
  }
  at("upload-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    at("upload-problem").textContent = "";
    const form = new FormData();
    form.append("log", at("log").files[0]);
    form.append("sidecar", at("sidecar").files[0]);
    try {
      await ask("/api/diagnoses", { method: "POST", body: form });
      await refresh();
    } catch (error) {
      at("upload-problem").textContent = error.message;
    }
  });

  // ---- query box
  function tableOf(rows) {
    const columns = rows.length ? Object.keys(rows[0]) : [];
    const table = element("table");
    const className = (name) => typeof rows[0][name] === "number" ? "number" : "";
    table.createTHead().append(element("tr", {}, ...columns.map((name) => element("th", { scope: "col", className: className(name), textContent: name }))));
    table.createTBody().append(...rows.slice(0, 1000).map((row) => element("tr", {}, ...columns.map((name) => {
      const value = row[name];
      const number = typeof value === "number";
      return element("td", { className: number ? "number" : "", textContent: number && !Number.isInteger(value) ? value.toPrecision(6) : value ?? "" });
    }))));
    return table;
  }
  at("query-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    at("query-problem").textContent = "";
    at("query-count").textContent = "…";
    try {
      const rows = await (await post("/api/query", { sql: at("sql").value })).json();
      at("query-count").textContent = rows.length + (rows.length === 1 ? " row" : " rows") + (rows.length > 1000 ? ", the first 1000 shown" : "");
      at("query-rows").replaceChildren(tableOf(rows));
      at("query-rows").hidden = rows.length === 0;
    } catch (error) {
      at("query-count").textContent = "";
      at("query-rows").hidden = true;
      at("query-problem").textContent = error.message;
    }
  });
  at("query-csv").addEventListener("click", async () => {
    at("query-problem").textContent = "";
    try {
      const answer = await post("/api/query", { sql: at("sql").value, format: "csv" });
      const address = URL.createObjectURL(await answer.blob());
      element("a", { href: address, download: "capstan-query.csv" }).click();
      setTimeout(() => URL.revokeObjectURL(address), 60000);
    } catch (error) {
      at("query-problem").textContent = error.message;
    }
  });

  async function begin() {
    await Promise.all([listConfigs(), ask("/api/schema").then((answer) => answer.text()).then((text) => { at("schema").textContent = text; }), refresh()]);
    document.documentElement.dataset.ready = "yes";
    for (;;) {
      await new Promise((wake) => setTimeout(wake, document.hidden ? 5000 : 1000));
      await refresh();
    }
  }
  begin();
})();
