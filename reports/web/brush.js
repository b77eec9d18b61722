"use strict";
// Samples of a recording, marked in all figures at once: a part of the time or of a loop by dragging, a part of the gap's
// map by a click; below each figure the same by keyboard. A figure draws the table `marked`, which is made here.
(() => {
  const { tables, tableOf, rowsOf, about, setMarks } = window.capstanPage;
  const figures = [...document.querySelectorAll("figure[data-figure]")].filter((figure) => about(figure).brush);
  if (figures.length === 0 || !tables().condition) return;
  const kind = (figure) => about(figure).brush, runOf = (figure) => Number(figure.dataset.run);
  const made = (name, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
  };
  const seconds = (time_s) => time_s.toFixed(2) + " s";

  // ---- the drawn samples of each run, in time: { time_s, parts: names in the gap's map }. One without a part lies
  // before the first that is compared with the model.
  const samples_of_run = new Map();
  const conditions = tableOf("condition").columns.filter((each) => !["run", "time_s"].includes(each));
  for (const row of tables().condition) {
    const named = conditions.map((each) => row[each]).filter(Boolean);
    if (!samples_of_run.has(row.run)) samples_of_run.set(row.run, []);
    samples_of_run.get(row.run).push({ time_s: row.time_s, parts: named.length ? ["run: " + row.run, ...named] : [] });
  }
  const channel_of_part = new Map((tables().part_channel ?? []).map(({ part, channel }) => [part, channel]));

  // ---- what is marked: which samples of which run, in words, and the part of the map that was chosen
  const nothing = { in_run: new Map(), part: "", channel: "", words: "" };
  let marked = nothing;
  const mark = (in_run, words, part = "") => {
    const some = [...in_run.values()].some((flags) => flags.some(Boolean));
    marked = some ? { in_run, words, part, channel: channel_of_part.get(part) ?? "" } : nothing;
    show();
  };
  const flagsOf = (run, is_in) => samples_of_run.get(run).map(is_in);
  function markTime(run, from_s, to_s) {
    mark(new Map([[run, flagsOf(run, ({ time_s }) => time_s >= from_s && time_s <= to_s)]]), `run ${run}, ${seconds(from_s)} to ${seconds(to_s)}`);
  }
  function markBox(figure, [left, right], [low, high]) {
    const inside = new Set(rowsOf(figure, "loop").filter((row) => row.series === "measured" && row.motor_torque_Nm >= left && row.motor_torque_Nm <= right && row.load_torque_Nm >= low && row.load_torque_Nm <= high).map((row) => row.time_s));
    mark(new Map([[runOf(figure), flagsOf(runOf(figure), ({ time_s }) => inside.has(time_s))]]), `run ${runOf(figure)}, a part of its loop`);
  }
  function markPart(part) {
    if (!part) return mark(new Map(), "");
    const is_all = channel_of_part.has(part);  // a channel is compared at every sample
    mark(new Map([...samples_of_run.keys()].map((run) => [run, flagsOf(run, ({ parts }) => parts.length > 0 && (is_all || parts.includes(part)))])), part, part);
  }

  // ---- what the figures draw of it. A scale needs a row, so that nothing is a row that does not show.
  function spansOf(run) {
    const samples = samples_of_run.get(run) ?? [], flags = marked.in_run.get(run) ?? [];
    const spans = [];
    samples.forEach(({ time_s }, k) => {
      if (!flags[k]) return;
      const until_s = samples[k + 1]?.time_s ?? time_s;
      if (flags[k - 1]) spans.at(-1).to_s = until_s;
      else spans.push({ from_s: time_s, to_s: until_s });
    });
    return spans.length || !samples.length ? spans : [{ from_s: samples[0].time_s, to_s: samples[0].time_s }];
  }
  function momentsOf(figure) {
    const flags = marked.in_run.get(runOf(figure)) ?? [];
    const times = new Set(samples_of_run.get(runOf(figure)).filter((sample, k) => flags[k]).map(({ time_s }) => time_s)), rows = rowsOf(figure, "loop");
    return times.size === 0 ? [{ ...rows[0], series: "" }] : rows.filter((row) => times.has(row.time_s));
  }
  function fractionsOf(figure) {
    const count = new Map();
    let all = 0;
    for (const [run, flags] of marked.in_run) samples_of_run.get(run).forEach(({ parts }, k) => {
      if (!flags[k] || parts.length === 0) return;
      ++all;
      for (const part of parts) count.set(part, (count.get(part) ?? 0) + 1);
    });
    if (all === 0) return [];
    return rowsOf(figure, "gap_map").filter(({ part }) => count.has(part) || part === marked.part)
      .map(({ part }) => ({ part, is_chosen: part === marked.part, fraction_of_marked: (count.get(part) ?? all) / all }));
  }
  const marksOf = (figure) => kind(figure) === "time" ? spansOf(runOf(figure)) : kind(figure) === "loop" ? momentsOf(figure) : fractionsOf(figure);
  setMarks({ rowsOf: marksOf, channel: () => marked.channel });

  const shown = new WeakMap();  // what a figure draws now, so that only what changes is drawn again
  let waits = false;
  function show() {
    if (waits) return;
    waits = true;
    requestAnimationFrame(() => {
      waits = false;
      for (const each of controls) each();
      for (const figure of figures) {
        const rows = marksOf(figure), state = JSON.stringify([marked.channel, rows]);
        if (!figure.view || shown.get(figure) === state) continue;
        shown.set(figure, state);
        if (kind(figure) === "time") figure.view.signal("marked_channel", marked.channel);
        figure.view.change("marked", window.vega.changeset().remove(() => true).insert(rows)).runAsync();
      }
    });
  }

  // ---- by mouse and finger
  // The panel under the pointer, or the nearest one: labels and margins belong to it.
  function panelAt(chart, x, y) {
    const cells = chart.querySelectorAll("svg .role-scope.cell > g > .background");
    const boxes = [...(cells.length ? cells : chart.querySelectorAll("svg .role-frame.root > g > .background"))].map((each) => each.getBoundingClientRect());
    const distance = (box) => Math.max(0, box.top - y, y - box.bottom) + Math.max(0, box.left - x, x - box.right);
    return boxes.reduce((best, box) => !best || distance(box) < distance(best) ? box : best, null);
  }
  const clamp = (value) => Math.min(1, Math.max(0, value));
  const along = (fraction, [low, high]) => low + (high - low) * fraction;
  const across = (box, from, to) => [from, to].map((x) => clamp((x - box.left) / box.width)).sort((a, b) => a - b);
  const upwards = (box, from, to) => [from, to].map((y) => clamp((box.bottom - y) / box.height)).sort((a, b) => a - b);

  function markDragged(figure, box, begin, end) {
    const x = across(box, begin.x, end.x).map((part) => along(part, figure.view.scale("x").domain()));
    if (kind(figure) === "time") return markTime(runOf(figure), ...x);
    markBox(figure, x, upwards(box, begin.y, end.y).map((part) => along(part, figure.view.scale("y").domain())));
  }
  const drag_begins_px = 5;
  function listenForDrags(figure) {
    const chart = figure.querySelector(".chart");
    const frame = made("div", { className: "brush-frame", hidden: true });
    let begin = null, box = null, is_drag = false;
    const stop = () => { begin = null; frame.hidden = true; };
    chart.classList.add("brushed");
    chart.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !event.isPrimary || !figure.view) return;
      begin = { x: event.clientX, y: event.clientY };
      box = panelAt(chart, begin.x, begin.y);
      is_drag = false;
      chart.append(frame);  // the chart may have been drawn anew
    });
    chart.addEventListener("pointermove", (event) => {
      if (!begin) return;
      const end = { x: event.clientX, y: event.clientY };
      const [right_px, down_px] = [Math.abs(end.x - begin.x), Math.abs(end.y - begin.y)];
      if (!is_drag && Math.hypot(right_px, down_px) < drag_begins_px) return;
      if (!is_drag && event.pointerType === "touch" && down_px > right_px) return stop();  // this scrolls the page
      if (!is_drag) chart.setPointerCapture(event.pointerId);
      is_drag = true;
      const [left, right] = across(box, begin.x, end.x), [low, high] = kind(figure) === "time" ? [0, 1] : upwards(box, begin.y, end.y);
      const corner = chart.getBoundingClientRect();
      Object.assign(frame.style, { left: box.left - corner.left + chart.scrollLeft + left * box.width + "px", width: (right - left) * box.width + "px", top: box.top - corner.top + (1 - high) * box.height + "px", height: (high - low) * box.height + "px" });
      frame.hidden = false;
      markDragged(figure, box, begin, end);
    });
    chart.addEventListener("pointerup", () => {
      if (begin && !is_drag) mark(new Map(), "");
      stop();
    });
    chart.addEventListener("pointercancel", stop);
  }
  function listenForClicks(figure) {
    const chart = figure.querySelector(".chart");
    chart.classList.add("chosen-by-click");
    chart.addEventListener("click", (event) => {
      const box = panelAt(chart, event.clientX, event.clientY);
      if (!box || event.clientY < box.top || event.clientY > box.bottom) return;
      const parts = figure.view.scale("y").domain();
      const part = parts[Math.min(parts.length - 1, Math.floor(clamp((event.clientY - box.top) / box.height) * parts.length))];
      markPart(part === marked.part ? "" : part);
    });
  }

  // ---- by keyboard
  const controls = [];  // each shows what is marked
  function addKeys(figure, ...inputs) {
    const words = made("output"), clear = made("button", { type: "button", textContent: "Mark nothing" });
    clear.addEventListener("click", () => mark(new Map(), ""));
    figure.querySelector(".chart").after(made("div", { className: "player-keys brush-keys" }, ...inputs, clear, words));
    controls.push(() => {
      clear.disabled = marked === nothing;
      words.textContent = marked.words ? "Marked: " + marked.words : "";
    });
  }
  function addSliders(figure) {
    const samples = samples_of_run.get(runOf(figure)), run = runOf(figure), last = samples.length - 1;
    const slider = (name, value) => {
      const input = made("input", { type: "range", min: 0, max: last, value });
      input.setAttribute("aria-label", `Run ${run}: mark ${name}`);
      return input;
    };
    const from = slider("from", 0), to = slider("to", last);
    const ends = () => [Number(from.value), Number(to.value)].sort((a, b) => a - b);
    const input = () => markTime(run, ...ends().map((k) => samples[k].time_s));
    for (const each of [from, to]) each.addEventListener("input", input);
    addKeys(figure, made("label", {}, "Mark from ", from), made("label", {}, "to ", to));
    controls.push(() => {
      const flags = marked.in_run.get(run) ?? [], first = flags.indexOf(true);
      if (![from, to].includes(document.activeElement)) [from.value, to.value] = first < 0 ? [0, last] : [first, flags.lastIndexOf(true)];
      for (const each of [from, to]) each.setAttribute("aria-valuetext", seconds(samples[Number(each.value)].time_s));
    });
  }
  function addChoice(figure) {
    const choice = made("select", {}, made("option", { value: "", textContent: "nothing" }), ...rowsOf(figure, "gap_map").map(({ part }) => made("option", { value: part, textContent: part })));
    choice.addEventListener("change", () => markPart(choice.value));
    addKeys(figure, made("label", {}, "Mark the samples of ", choice));
    controls.push(() => { choice.value = marked.part; });
  }

  for (const figure of figures) {
    if (kind(figure) === "parts") {
      addChoice(figure);
      listenForClicks(figure);
    } else {
      addSliders(figure);
      listenForDrags(figure);
    }
  }
  for (const each of controls) each();
})();
