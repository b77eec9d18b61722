"use strict";
// The front page of `capstan serve`: studies, the queue, diagnoses. Starting is in start.js.
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
  const cell = (...children) => element("td", {}, ...children);
  const link = (href, text) => element("a", { href, textContent: text });

  // A command's messages, one a line: equal ones are told once, with the places that they hold for.
  function problemList(message) {
    const groups = new Map();
    for (const line of message.split("\n").map((each) => each.trim()).filter(Boolean)) {
      const [, place, words] = /^(?:capstan: )?(?:\S*[/\\])?([^\s:]+:\d+|[^\s:]+\.\w+):\s+(.*)$/.exec(line) ?? [null, "", line.replace(/^capstan: /, "")];
      groups.set(words, [...(groups.get(words) ?? []), place]);
    }
    return [...groups].map(([words, places]) => {
      const named = [...new Set(places.filter(Boolean))];
      const where = named.length > 4 ? `${named.slice(0, 3).join(", ")} and ${named.length - 3} more` : named.join(", ");
      return element("li", { textContent: words + (where ? ` (${where})` : "") + (places.length > Math.max(1, named.length) ? ` – ${places.length} times` : "") });
    });
  }

  // ---- studies and queue
  const seconds = (s) => s < 90 ? Math.max(1, Math.round(s)) + " s" : s < 5400 ? Math.round(s / 60) + " min" : (s / 3600).toFixed(1) + " h";

  globalThis.capstanPage = { at, ask, get, post, element, problemList, seconds };  // for the other scripts of the page

  function bar(fraction, words) {
    return [element("progress", { max: 1, value: fraction, ariaLabel: "done" }), " " + words];
  }

  function plainButton(textContent, ariaLabel, action) {
    const button = element("button", { type: "button", className: "plain", textContent, ariaLabel });
    button.addEventListener("click", action);
    return button;
  }

  // ---- the table of studies: two can be chosen and compared
  const chosen = new Set();
  function showComparison() {
    const pair = [...chosen].sort((a, b) => a - b);
    at("compare").disabled = pair.length !== 2;
    at("compare").textContent = pair.length === 2 ? `Compare ${pair[0]} and ${pair[1]}` : "Compare two";
  }
  at("compare").addEventListener("click", () => {
    const [first, second] = [...chosen].sort((a, b) => a - b);
    location.href = `/studies/${first}/compare/${second}`;
  });
  const words = (study) => [study.name, study.note, study.tags].join(" ").toLowerCase();
  const isWanted = (study) => at("study-filter").value.toLowerCase().split(/\s+/).every((word) => words(study).includes(word));

  // What begins anew tells its cost as at its first start.
  const again = async (what, path, costPath, body) => {
    if (await capstanPage.accepted("again", what, async () => (await post(costPath, body)).json())) await post(path, body);
  };
  const rerun = async (id) => again("Study " + id, "/api/studies", "/api/studies/cost", { config_toml: await (await ask(`/api/studies/${id}/config`)).text() });
  // A study goes on with what is stored; anything else has stored nothing.
  const resume = (job) => job.study_id ? post(`/api/jobs/${job.job}/resume`) : again(`The ${job.kind} of ${job.title}`, `/api/jobs/${job.job}/resume`, `/api/jobs/${job.job}/cost`);
  async function remove(id) {
    await post(`/api/studies/${id}/delete`);
    chosen.delete(id);
    const undo = plainButton("Undo", "Undo: bring study " + id + " back", () => {
      at("undo").replaceChildren();
      act(post(`/api/studies/${id}/restore`));
    });
    at("undo").replaceChildren(`Study ${id} is in the trash. `, undo);
  }

  function studyRow(study, jobs) {
    const id = study.study_id;
    const job = jobs.findLast((each) => each.study_id === id);
    const busy = job && ["queued", "running"].includes(job.state);
    const idle = study.status === "running" && !busy;
    const box = element("input", { type: "checkbox", checked: chosen.has(id), ariaLabel: "Choose study " + id });
    box.addEventListener("change", () => { box.checked ? chosen.add(id) : chosen.delete(id); showComparison(); });
    const notes = [study.note, ...study.tags.split(" ").filter(Boolean).map((tag) => "#" + tag)].filter(Boolean).join(" ");
    const begun = study.begun_utc ? new Date(study.begun_utc).toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" }) : "";
    const actions = [
      ...(idle ? [plainButton("Resume", "Resume study " + id, () => act(post(`/api/studies/${id}/resume`)))] : []),
      plainButton("Run again", "Run again: study " + id, () => act(rerun(id))),
      ...(busy ? [] : [plainButton("Delete", "Delete study " + id, () => act(remove(id)))]),
    ];
    return element("tr", {},
      element("th", { scope: "row" }, box, " ", link("/studies/" + id, "Study " + id)),
      cell(study.name, ...(notes ? [element("div", { className: "quiet", textContent: notes })] : [])), cell(begun),
      cell(idle ? "stopped" : study.status, ...(job ? [" (job " + job.job + ")"] : [])),
      cell(...(study.units ? bar(study.units_done / study.units, study.units_done + " of " + study.units + " units") : [])),
      element("td", { className: "buttons" }, ...actions));
  }
  function showStudies(studies, jobs) {
    at("study-none").hidden = studies.length > 0;
    at("study-table").tBodies[0].replaceChildren(...studies.toReversed().filter(isWanted).map((study) => studyRow(study, jobs)));
  }

  function showTrash(studies) {
    at("trash").hidden = studies.length === 0;
    at("trash").querySelector("summary").textContent = `Trash (${studies.length})`;
    at("trash").querySelector("ul").replaceChildren(...studies.map((study) => element("li", {}, `Study ${study.study_id}, ${study.name} `,
      plainButton("Restore", "Restore study " + study.study_id, () => act(post(`/api/studies/${study.study_id}/restore`))))));
  }

  // What runs and waits comes first, then what ended last.
  const ofInterest = (jobs) => {
    const under_way = jobs.filter((job) => ["running", "queued"].includes(job.state));
    const ended = jobs.filter((job) => !under_way.includes(job)).toReversed();
    return { shown: [...under_way.slice(0, 30), ...ended.slice(0, 20)], under_way: under_way.length };
  };
  const has_page = new Set(["place", "sensitivity", "estimate"]);
  function timeLeft({ seconds_left: shortest, max_seconds_left: longest }) {
    if (longest == null) return shortest > 0 ? "about " + seconds(shortest) + " left" : "";
    return (shortest > 0 ? "about " + seconds(shortest) + " to " : "at most ") + seconds(longest) + " left";
  }
  function showJobs(jobs) {
    at("job-none").hidden = jobs.length > 0;
    const { shown, under_way } = ofInterest(jobs);
    at("stop-all").hidden = under_way < 2;
    at("stop-all").textContent = `Stop all ${under_way} jobs`;
    at("job-table").tBodies[0].replaceChildren(...shown.map((job) => {
      const activity = [job.activity, timeLeft(job)].filter(Boolean).join(", ");
      const does = ["queued", "running"].includes(job.state) ? "Stop" : ["stopped", "failed"].includes(job.state) ? (job.study_id ? "Resume" : "Run again") : "";
      const button = plainButton(does, does + ": job " + job.job, () => act(does === "Stop" ? post(`/api/jobs/${job.job}/stop`) : resume(job)));
      const result = job.study_id ? link("/studies/" + job.study_id, "study " + job.study_id) : job.diagnosis_id ? link("/diagnoses/" + job.diagnosis_id, "diagnosis " + job.diagnosis_id) : job.state === "done" && has_page.has(job.kind) ? link("/jobs/" + job.job, "answer " + job.job) : "";
      const row = element("tr", {}, element("th", { scope: "row", textContent: "Job " + job.job }), cell(job.kind + " " + job.title), cell(job.state),
        cell(...(job.state === "running" ? bar(job.fraction, activity) : job.message ? [element("ul", { className: "problem-list" }, ...problemList(job.message))] : [])), cell(result), cell(...(does ? [button] : [])));
      row.dataset.state = job.state;
      return row;
    }));
  }
  at("stop-all").addEventListener("click", () => act(post("/api/jobs/stop")));
  at("study-filter").addEventListener("input", () => refresh());

  let shownState = "", shownDiagnoses = "";
  async function refresh() {
    try {
      const [studies, jobs, diagnoses, deleted] = await Promise.all([get("/api/studies"), get("/api/jobs"), get("/api/diagnoses"), get("/api/studies/deleted")]);
      const state = JSON.stringify([studies, jobs, deleted, at("study-filter").value]);
      if (state !== shownState) {  // what has not changed keeps its focus
        showStudies(studies, jobs);
        showJobs(jobs);
        showTrash(deleted);
        shownState = state;
      }
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

  // ---- diagnoses
  const percent = (fraction) => fraction == null ? "" : Math.round(100 * fraction) + "%";
  const digits = (value) => value == null ? "" : Number(value).toPrecision(3);

  const verdict_words = (verdict) => ({ none: "no gap", unknown: "unknown cause" })[verdict] ?? verdict.replaceAll("_", " ");
  function diagnosisCard(row) {
    const channel = element("p", { className: "quiet" }, row.channel ? `${row.channel}: RMS of the gap ${digits(row.rms_before_in_unit)} ${row.unit} before, ${digits(row.rms_after_in_unit)} after, ${digits(row.rms_held_out_in_unit)} held out` +
      (row.closed_fraction == null ? "" : `; ${percent(row.closed_fraction)} (${percent(row.closed_low_fraction)} to ${percent(row.closed_high_fraction)}) of it closed`) + "." : "");
    const more = element("details", { className: "data" }, element("summary", { textContent: "Every cause and its probability" }), element("div"));
    more.addEventListener("toggle", async () => {
      if (!more.open || more.lastChild.childElementCount) return;
      const rows = await (await post("/api/query", { sql: `SELECT place, effect, probability_fraction FROM diagnosis_effect WHERE diagnosis_id = ${row.diagnosis_id} ORDER BY place` })).json();
      more.lastChild.append(capstanPage.tableOf(rows));
    });
    const card = element("article", { className: "card verdict-card", id: "diagnosis-" + row.diagnosis_id },
      element("h3", { textContent: `${row.recording}: ${verdict_words(row.verdict)}` }),
      element("p", { textContent: row.sentence + (row.component && row.component !== "none" ? ` Where: ${row.component}${row.cable_end ? ", at the " + row.cable_end + " end" : ""}${row.position_m == null ? "" : ", about " + digits(row.position_m) + " m from the motor"}.` : "") }),
      channel, more, element("p", { className: "buttons" }, link("/diagnoses/" + row.diagnosis_id, "The complete diagnosis: numbers, curves, model"), " ",
        element("a", { href: `/api/diagnoses/${row.diagnosis_id}/model`, download: "", textContent: "Corrected model" })));
    card.dataset.verdict = row.verdict;
    return card;
  }
  function showDiagnoses(rows) {
    at("diagnosis-list").replaceChildren(...rows.map(diagnosisCard));
  }
  // ---- recordings: diagnosed, or the tension estimated from them
  function uploaded(leave_out) {
    const form = new FormData();
    form.append("log", at("log").files[0]);
    form.append("sidecar", at("sidecar").files[0]);
    if (leave_out) form.append("leave_out", "each");
    return { method: "POST", body: form };
  }
  const showUploadProblem = (message) => at("upload-problem").replaceChildren(...problemList(message));
  at("upload-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    showUploadProblem("");
    const wants_estimate = event.submitter?.value === "estimate", leave_out = at("leave-out").checked;
    try {
      const path = wants_estimate ? "/api/estimates" : "/api/diagnoses", upload = () => uploaded(wants_estimate && leave_out);
      const cost = async () => (await ask(path + "/cost", upload())).json();
      if (!await capstanPage.accepted("upload", wants_estimate ? "The estimate" : "The diagnosis", cost)) return;
      await ask(path, upload());
      await refresh();
      at("jobs-title").scrollIntoView();
    } catch (error) {
      showUploadProblem(error.message);
    }
  });

  async function begin() {
    await Promise.all([capstanPage.listConfigs(), refresh()]);
    document.documentElement.dataset.ready = "yes";
    for (;;) {
      await new Promise((wake) => setTimeout(wake, document.hidden ? 5000 : 1000));
      await refresh();
    }
  }
  capstanPage.refresh = refresh;
  addEventListener("DOMContentLoaded", begin);
})();
