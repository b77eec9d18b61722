"use strict";
// The section "Import a log" of the front page: columns are assigned to channels, the mapping is tried and used.
// The text of the mapping is the truth: every change is made by the service in the text, and the channels are
// what the service reads from it.
(() => {
  const { at, ask, element } = globalThis.capstanPage;
  const max_upload_bytes = 64 * 1024 * 1024;
  const colours = ["--accent", "--sensor", "--known", "--quiet", "--unknown"];

  let files = [], columns = [], roles = [], guesses = [], mapping = { mapping: "", channels: [], problems: [] };
  let placeholder = "";  // the line of a proposal that describes the bench
  const changed_by_hand = new Set();  // roles whose guesses are out of date
  const extra_roles = new Set();
  const cards = new Map();  // of roles, by name

  // ---- requests
  function form(withMapping) {
    const data = new FormData();
    for (const file of files) data.append("log", file, file.name);
    if (withMapping) data.append("mapping", at("import-text").value);
    else data.append("kind", at("import-kind").value);
    return data;
  }
  const postForm = (path, withMapping) => ask(path, { method: "POST", body: form(withMapping) });
  const postJson = async (body) => (await ask("/api/import/mapping", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) })).json();

  function showProblems(where, problems) {
    const lines = problems.flatMap((problem) => String(problem).split("\n")).filter(Boolean);
    at(where).replaceChildren(...lines.map((line) => element("li", { textContent: line })));
  }
  let busy = 0;
  async function during(words, work, problems) {
    const buttons = document.querySelectorAll("#import button");
    const status = at(problems === "import-run-problems" ? "import-run-status" : "import-status");
    showProblems(problems, []);
    status.textContent = words;
    ++busy;
    buttons.forEach((button) => { button.disabled = true; });
    try {
      await work();
    } catch (error) {
      showProblems(problems, [error.message]);
    } finally {
      --busy;
      buttons.forEach((button) => { button.disabled = busy > 0; });
      if (status.textContent === words) status.textContent = "";
    }
  }

  // ---- drawing
  const svg = (name, attributes, ...children) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  };
  const digits = (value) => Number(value.toPrecision(4)).toString();

  // `lines`: [{x: [], y: []}], all in one frame.
  function lineChart(lines, className, label) {
    const all = (axis) => lines.flatMap((line) => line[axis]);
    const span = (values) => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
    const [left, right] = span(all("x")), [low, high] = span(all("y"));
    const x = (value) => right > left ? 200 * (value - left) / (right - left) : 100;
    const y = (value) => high > low ? 38 - 36 * (value - low) / (high - low) : 20;
    return svg("svg", { viewBox: "0 0 200 40", preserveAspectRatio: "none", class: className, role: "img", "aria-label": label },
      ...lines.map((line, k) => svg("polyline", { points: line.x.map((value, n) => x(value).toFixed(2) + "," + y(line.y[n]).toFixed(2)).join(" "),
        style: `stroke: var(${colours[k % colours.length]})` })));
  }

  // ---- columns
  const matches = (pattern, name) => new RegExp("^" + pattern.split("*").map((part) => part.replace(/[.+?^${}()|[\]\\]/g, "\\$&")).join(".*") + "$").test(name);
  const columnOf = (channel) => columns.findIndex((column) => column.column === channel.column && (!channel.table || channel.table === column.table) && (!channel.file || matches(channel.file, column.file)));
  const severalFiles = () => new Set(columns.map((column) => column.file)).size > 1;
  const columnName = (column) => [severalFiles() ? column.file : "", column.table, column.column].filter(Boolean).join(" · ");

  function columnCard(column, index) {
    const unit = column.unit ? " " + column.unit : "";
    const card = element("li", { className: "column", draggable: true, title: "Drag this column to a channel" },
      element("p", { className: "column-name" }, element("b", { textContent: columnName(column) }), element("span", { className: "role-chip", hidden: true })),
      lineChart([{ x: column.drawn_row, y: column.drawn_value }], "spark", columnName(column) + " over the rows of the log"),
      element("p", { className: "quiet range", textContent: `${digits(column.smallest)} to ${digits(column.largest)}${unit} · ${column.rows} rows${column.missing ? ", " + column.missing + " without a number" : ""}` }));
    card.dataset.column = index;
    card.addEventListener("dragstart", (event) => {
      event.dataTransfer.setData("text/plain", String(index));
      event.dataTransfer.effectAllowed = "copy";
      document.documentElement.dataset.dragging = "yes";
    });
    card.addEventListener("dragend", () => { delete document.documentElement.dataset.dragging; });
    return card;
  }
  function markUsedColumns() {
    const used = new Map();
    for (const channel of mapping.channels) used.set(columnOf(channel), [...(used.get(columnOf(channel)) ?? []), channel.name]);
    const clock = columns.findIndex((column) => column.column === mapping.time?.column);
    if (mapping.time?.column) used.set(clock, ["time"]);
    for (const card of at("import-columns").children) {
      const names = used.get(Number(card.dataset.column)) ?? [];
      const chip = card.querySelector(".role-chip");
      chip.hidden = names.length === 0;
      chip.textContent = names.join(", ");
    }
  }

  // ---- channels
  let last_edit = Promise.resolve();  // each is made in the text that the one before left
  function edit(change) {
    changed_by_hand.add(change.channel);
    last_edit = last_edit.then(() => during("", async () => {
      take(await postJson({ mapping: at("import-text").value, edit: change }));
    }, "import-mapping-problems"));
  }
  function assign(role, index) {
    if (index < 0) return edit({ channel: role, remove: true });
    const column = columns[index];
    const change = { channel: role, column: column.column, table: role === "time" ? "" : column.table, file: role !== "time" && severalFiles() ? column.file : "" };
    if (column.unit) change.unit = column.unit;
    else if (role !== "time" && !mapping.channels.some((channel) => channel.name === role)) change.unit = roles.find((each) => each.name === role)?.unit ?? "N";
    return edit(change);
  }

  function field(label, input, role) {
    input.setAttribute("aria-label", label + " of " + role);
    return element("label", {}, label + " ", input);
  }
  function roleCard(role) {
    const pick = element("select", { className: "role-column" });
    const unit = element("input", { className: "role-unit", size: 7, spellcheck: false });
    unit.setAttribute("list", "import-units");
    const sign = element("select", { className: "role-sign" }, element("option", { value: "1", textContent: "+" }), element("option", { value: "-1", textContent: "−" }));
    const number = (className) => element("input", { type: "number", step: "any", className });
    const zero = number("role-zero"), counts = number("role-counts"), scale = number("role-scale"), torque = number("role-torque");
    const about = roles.find((each) => each.name === role);
    const card = element("li", { className: "role" },
      element("p", { className: "role-name" }, element("b", { textContent: role }), " ", element("span", { className: "quiet", textContent: about ? about.meaning : role.startsWith("tension_") ? "a tension sensor; its place is in tension_sensors below [recording]" : "" })),
      element("div", { className: "role-fields" }, field("Column", pick, role), field("Unit", unit, role),
        ...(role === "time" ? [] : [field("Sign", sign, role), field("Zero", zero, role), field("Counts per turn", counts, role), field("SI units per count", scale, role), field("N m per A", torque, role)])),
      element("ul", { className: "guesses" }));
    card.dataset.role = role;
    pick.addEventListener("change", () => assign(role, Number(pick.value)));
    unit.addEventListener("change", () => edit({ channel: role, unit: unit.value.trim() }));
    sign.addEventListener("change", () => edit({ channel: role, sign: Number(sign.value) }));
    for (const [input, key] of [[zero, "zero"], [counts, "counts_per_turn"], [scale, "scale"], [torque, "torque_constant"]])
      input.addEventListener("change", () => { if (input.value !== "") edit({ channel: role, [key]: Number(input.value) }); });
    card.addEventListener("dragover", (event) => { event.preventDefault(); event.dataTransfer.dropEffect = "copy"; card.classList.add("over"); });
    card.addEventListener("dragleave", (event) => { if (!card.contains(event.relatedTarget)) card.classList.remove("over"); });
    card.addEventListener("drop", (event) => {
      event.preventDefault();
      card.classList.remove("over");
      const text = event.dataTransfer.getData("text/plain");
      if (/^\d+$/.test(text) && Number(text) < columns.length) assign(role, Number(text));
    });
    return card;
  }
  function updateRole(card, role) {
    const channel = role === "time" ? { ...mapping.time, sign: 1, zero: 0 } : mapping.channels.find((each) => each.name === role);
    const chosen = channel?.column ? columnOf(channel) : -1;
    const lost = channel?.column && chosen < 0;
    const pick = card.querySelector(".role-column");
    pick.replaceChildren(element("option", { value: -1, textContent: lost ? channel.column + " (not in these files)" : role === "time" ? "found by its name" : "none" }),
      ...columns.map((column, k) => element("option", { value: k, textContent: columnName(column) })));
    pick.value = chosen;
    const assigned = Boolean(channel && (channel.column || role !== "time"));
    card.classList.toggle("assigned", assigned);
    const put = (name, value, shown = assigned) => {
      const input = card.querySelector(".role-" + name);
      if (!input) return;
      input.value = value ?? "";
      input.closest("label").hidden = !shown;
    };
    put("unit", channel?.unit);
    put("sign", String(channel?.sign ?? 1));
    put("zero", channel?.zero ?? 0);
    put("counts", channel?.counts_per_turn, assigned && channel.unit === "counts" && /angle|displacement/.test(role));
    put("scale", channel?.scale, assigned && (channel.scale != null || (channel.unit === "counts" && !/angle/.test(role))));
    put("torque", channel?.torque_constant, assigned && ["A", "mA"].includes(channel.unit));
    const own = changed_by_hand.has(role) ? [{ doubt: "set", reason: "set by hand" }] : guesses.filter((guess) => guess.about === role);
    card.querySelector(".guesses").replaceChildren(...(assigned || role === "time" ? own : []).map(guessItem));
  }
  function guessItem(guess) {
    const item = element("li", {}, element("span", { className: "doubt", textContent: guess.doubt }), " " + guess.reason);
    item.dataset.doubt = guess.kind ?? guess.doubt;
    return item;
  }

  function shownRoles() {
    const names = ["time", ...roles.filter((role) => role.common && /^(motor|load)_(torque|angle)$/.test(role.name)).map((role) => role.name), ...mapping.channels.map((channel) => channel.name), ...extra_roles];
    return [...new Set(names)];
  }
  function showRoles() {
    const names = shownRoles();
    for (const name of names) {
      if (!cards.has(name)) {
        cards.set(name, roleCard(name));
        at("import-roles").append(cards.get(name));
      }
      updateRole(cards.get(name), name);
    }
    for (const [name, card] of cards) {
      if (names.includes(name)) continue;
      card.remove();
      cards.delete(name);
    }
    markUsedColumns();
    const is_outdated = (guess) => changed_by_hand.size > 0 && (guess.about === "channels" || guess.reason.startsWith("a trial import fails"));
    const others = guesses.filter((guess) => !names.includes(guess.about) && !is_outdated(guess));
    at("import-guesses").replaceChildren(...others.map(guessItem));
  }

  // The mapping as the service has read it. With problems the channels stay as they were shown last.
  function take(read) {
    at("import-text").value = read.mapping;
    mapping = read.channels ? read : { ...mapping, mapping: read.mapping };
    showProblems("import-mapping-problems", read.problems);
    showRoles();
  }

  // ---- steps
  at("import-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    const picked = [...at("import-files").files];
    const saved = picked.find((file) => file.name.endsWith(".toml"));
    files = picked.filter((file) => file !== saved);
    if (files.reduce((sum, file) => sum + file.size, 0) > max_upload_bytes) {
      showProblems("import-problems", ["The files have more than 64 MiB together. Import them at the shell: capstan import --suggest LOG... -o import.toml"]);
      return;
    }
    await during("Reading the files and looking for a mapping …", async () => {
      const answer = await (await postForm("/api/import/suggestion", false)).json();
      ({ columns, roles, guesses } = answer);
      changed_by_hand.clear();
      extra_roles.clear();
      cards.clear();
      at("import-roles").replaceChildren();
      at("import-columns").replaceChildren(...columns.map(columnCard));
      at("import-units").replaceChildren(...answer.units.map((unit) => element("option", { value: unit })));
      const alike = answer.files.filter((file) => file.same_columns_as);
      at("import-about").textContent = answer.files.map((file) => file.file + " (" + file.format + ")").join(", ") + ". " +
        (alike.length ? `${alike.length === 1 ? "One file has" : alike.length + " files have"} the same columns as ${alike[0].same_columns_as}: each file is a run. ` : "") +
        answer.files.flatMap((file) => file.remarks).join(" ");
      at("import-result").hidden = true;
      at("import-work").hidden = false;
      mapping = { mapping: "", channels: [], problems: [] };
      placeholder = saved ? "" : /^nominal = .*$/m.exec(answer.mapping)?.[0] ?? "";
      if (saved) { guesses = []; take(await postJson({ mapping: await saved.text() })); } else take(answer);
    }, "import-problems");
  });

  let typing = 0;
  at("import-text").addEventListener("input", () => {
    clearTimeout(typing);
    typing = setTimeout(async () => {
      const text = at("import-text").value;
      try {
        const read = await postJson({ mapping: text });
        if (at("import-text").value === text) take(read);
      } catch (error) {
        showProblems("import-mapping-problems", [error.message]);
      }
    }, 400);
  });

  at("import-add").addEventListener("click", () => {
    const name = at("import-role").value.trim();
    if (!/^[A-Za-z_]\w*$/.test(name)) return at("import-role").focus();
    extra_roles.add(name);
    at("import-role").value = "";
    showRoles();
    cards.get(name).querySelector("select").focus();
  });

  function resultTable(rows, heads) {
    const table = element("table");
    table.createTHead().append(element("tr", {}, ...heads.map(([, title]) => element("th", { scope: "col", textContent: title }))));
    table.createTBody().append(...rows.map((row) => element("tr", {}, ...heads.map(([key]) => element("td", { textContent: row[key] ?? "" })))));
    return element("div", { className: "scroll", tabIndex: 0 }, table);
  }
  function channelFigure(name, curves) {
    const [low, high] = curves.flatMap((curve) => curve.value).reduce(([a, b], value) => [Math.min(a, value), Math.max(b, value)], [Infinity, -Infinity]);
    const end = Math.max(...curves.map((curve) => curve.time_s.at(-1) ?? 0));
    return element("figure", { className: "channel" }, element("h4", { textContent: `${name} [${curves[0].unit}]` }),
      lineChart(curves.map((curve) => ({ x: curve.time_s.map((time) => time - curve.time_s[0]), y: curve.value })), "channel-chart", name + " over time"),
      element("p", { className: "quiet range", textContent: `${digits(low)} to ${digits(high)} ${curves[0].unit} in ${digits(end)} s` +
        (curves.length > 1 ? ` · ${curves.length} runs, one line each` : "") }));
  }
  at("import-try").addEventListener("click", () => during("Importing …", async () => {
    const answer = await (await postForm("/api/import/trial", true)).json();
    const samples = answer.runs.reduce((sum, run) => sum + run.samples, 0);
    const count = (number, word) => number + " " + word + (number === 1 ? "" : "s");
    const repaired = answer.findings.filter((finding) => finding.repaired).length;
    const names = [...new Set(answer.curves.map((curve) => curve.channel))];
    at("import-result").replaceChildren(
      element("h3", { tabIndex: -1, textContent: `${count(answer.runs.length, "run")}, ${count(samples, "sample")} at ${digits(answer.sample_rate_hz)} Hz: ${count(repaired, "repair")}, ${count(answer.findings.length - repaired, "remark")}` }),
      answer.findings.length ? element("ul", { className: "guesses findings" }, ...answer.findings.map((finding) => guessItem({
        doubt: finding.what + (finding.repaired ? ", repaired" : ""), kind: finding.repaired ? "likely" : finding.what === "assumed" ? "note" : "doubtful", reason: finding.words })))
        : element("p", { textContent: "Nothing had to be repaired, and nothing looks wrong." }),
      resultTable(answer.runs, [["run", "Run"], ["source", "From"], ["samples", "Samples"], ["duration_s", "Time [s]"]]),
      element("div", { className: "channel-figures" }, ...names.map((name) => channelFigure(name, answer.curves.filter((curve) => curve.channel === name)))));
    at("import-result").hidden = false;
    at("import-result").querySelector("h3").focus({ preventScroll: true });
    at("import-result").scrollIntoView({ block: "nearest" });
  }, "import-run-problems"));

  at("import-save").addEventListener("click", () => {
    const address = URL.createObjectURL(new Blob([at("import-text").value], { type: "application/toml" }));
    element("a", { href: address, download: "import.toml" }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60000);
  });
  at("import-diagnose").addEventListener("click", async () => {
    const cost = async () => (await postForm("/api/import/diagnosis/cost", true)).json();
    const doubt = placeholder && at("import-text").value.includes(placeholder) ? "The numbers of the bench are still placeholders, which a diagnosis takes as true." : "";
    showProblems("import-run-problems", []);
    try {
      if (await globalThis.capstanPage.accepted("import", "The diagnosis", cost, doubt)) startDiagnosis();
    } catch (error) {
      showProblems("import-run-problems", [error.message]);
    }
  });
  const startDiagnosis = () => during("Importing …", async () => {
    const job = await (await postForm("/api/import/diagnosis", true)).json();
    at("import-run-status").textContent = `Job ${job.job} is queued. Its progress is in the queue; its verdict will stand under Recordings.`;
  }, "import-run-problems");
})();
