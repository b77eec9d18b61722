"use strict";
// A cable with a place for a sensor at each node. Sensors are set and removed by click, dragged by mouse or finger, and
// moved by keyboard. capstanPins(segments, width_px, changed) gives { svg, placed, put(nodes), nodes_m }.
window.capstanPins = (segments, width_px, changed) => {
  const placed = new Set();
  const nodes_m = [segments[0].start_m, ...segments.map((each) => each.start_m + each.length_m)];
  const is_narrow = width_px < 560;  // letters keep their size, the cable becomes shorter
  const width = is_narrow ? 400 : 760, end = is_narrow ? 24 : 34, left = is_narrow ? 58 : 66, right = width - left;
  const cable_y = 66, pin_y = 22, reach_of_a_finger_px = 22, slip_px = 4;
  const x_of = (arc_m) => left + (right - left) * (arc_m - nodes_m[0]) / (nodes_m.at(-1) - nodes_m[0]);
  const gap = (right - left) / (nodes_m.length - 1);
  const pin_radius = Math.max(4, Math.min(12, gap / 2 - 1));

  const svgNs = "http://www.w3.org/2000/svg";
  function drawn(name, attributes, ...children) {
    const made = document.createElementNS(svgNs, name);
    for (const [key, each] of Object.entries(attributes)) made.setAttribute(key, each);
    made.append(...children);
    return made;
  }

  const svg = drawn("svg", { class: "cable pins", viewBox: `0 0 ${width} 130`, role: "group", "aria-label": "Cable from motor to load; nodes are check boxes" });
  function drawCable() {
    svg.append(drawn("line", { class: "conduit", x1: left, y1: cable_y, x2: right, y2: cable_y }));
    const sharpest = Math.max(...segments.map((each) => each.bend_radius_m ? 1 / each.bend_radius_m : 0));
    for (const each of segments) {
      if (!each.bend_radius_m) continue;
      svg.append(drawn("rect", { class: "bend", x: x_of(each.start_m), y: cable_y - 9, width: x_of(each.start_m + each.length_m) - x_of(each.start_m), height: 18, "fill-opacity": 0.12 + 0.3 / each.bend_radius_m / sharpest },
        drawn("title", {}, `bend radius ${each.bend_radius_m.toPrecision(3)} m, wrap angle ${each.wrap_angle_rad.toPrecision(3)} rad`)));
    }
    svg.append(drawn("line", { class: "core", x1: left, y1: cable_y, x2: right, y2: cable_y }));
    for (const [x, name] of [[left - end, "motor"], [right + end, "load"]])
      svg.append(drawn("rect", { class: "end", x: x - 24, y: cable_y + 14, width: 48, height: 22, rx: 6 }), drawn("text", { class: "end-name", x, y: cable_y + 29 }, name));
    nodes_m.forEach((arc_m, k) => svg.append(pin(k + 1, x_of(arc_m))));
    const ticks = is_narrow ? 3 : 5;
    for (let tick = 0; tick <= ticks; ++tick) {
      const arc_m = nodes_m[0] + (nodes_m.at(-1) - nodes_m[0]) * tick / ticks;
      svg.append(drawn("text", { class: "tick", x: x_of(arc_m), y: 122 }, Number(arc_m.toPrecision(3)) + (tick === ticks ? " m" : "")));
    }
  }

  function pin(node, x) {
    const group = drawn("g", { class: "place", role: "checkbox", tabindex: 0, "aria-checked": "false", "aria-label": `sensor at node ${node}, ${Number(nodes_m[node - 1].toPrecision(3))} m`, "data-node": node },
      drawn("rect", { class: "hit", x: x - gap / 2, y: 4, width: gap, height: 72 }), drawn("line", { x1: x, y1: pin_y, x2: x, y2: cable_y }),
      drawn("circle", { class: "node", cx: x, cy: cable_y, r: 3 }), drawn("circle", { class: "pin", cx: x, cy: pin_y, r: pin_radius }));
    if (pin_radius > 11) group.append(drawn("text", { x, y: pin_y + 4.5 }, String(node)));
    group.addEventListener("click", () => { if (!was_dragged) toggle(node); });
    group.addEventListener("keydown", (event) => keyed(event, node));
    return group;
  }
  const pinOf = (node) => svg.querySelector(`[data-node="${node}"]`);

  function toggle(node) {
    placed.has(node) ? placed.delete(node) : placed.add(node);
    show();
    changed();
  }
  function move(from, to) {
    placed.delete(from);
    placed.add(to);
    show();
    changed();
  }
  function show() {
    for (const each of svg.querySelectorAll(".place")) each.setAttribute("aria-checked", placed.has(Number(each.dataset.node)));
  }

  // With Shift a sensor passes those beside it, to the next free node.
  function keyed(event, node) {
    if (event.key === " " || event.key === "Enter") { event.preventDefault(); toggle(node); }
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    let to = node + step;
    if (event.shiftKey && placed.has(node)) {
      while (placed.has(to)) to += step;
      if (to >= 1 && to <= nodes_m.length) move(node, to);
    }
    pinOf(to)?.focus();
  }

  // ---- dragging
  let drag = null, was_dragged = false;
  const nodeAt = (event, fits) => {
    const box = svg.getBoundingClientRect(), x = (event.clientX - box.left) * width / box.width;
    const distance = (node) => Math.abs(x_of(nodes_m[node - 1]) - x);
    const best = nodes_m.map((_, k) => k + 1).filter(fits).sort((a, b) => distance(a) - distance(b))[0];
    return { node: best, distance_px: best ? distance(best) * box.width / width : Infinity };
  };
  svg.addEventListener("pointerdown", (event) => {
    was_dragged = false;
    const { node, distance_px } = nodeAt(event, (each) => placed.has(each));
    const reach_px = Math.max(gap / 2 * svg.clientWidth / width, event.pointerType === "touch" ? reach_of_a_finger_px : 0);
    if (event.button === 0 && distance_px <= reach_px) drag = { pointer: event.pointerId, begin: node, node, x: event.clientX };
  });
  svg.addEventListener("pointermove", (event) => {
    if (event.pointerId !== drag?.pointer) return;
    if (!was_dragged && Math.abs(event.clientX - drag.x) < slip_px) return;
    if (!was_dragged) svg.setPointerCapture(event.pointerId);  // only now, so that a press without a move stays a click
    was_dragged = true;
    svg.classList.add("dragging");
    const { node } = nodeAt(event, (each) => each === drag.node || !placed.has(each));
    if (node === drag.node) return;
    move(drag.node, node);
    drag.node = node;
  });
  function drop() {
    svg.classList.remove("dragging");
    if (drag && was_dragged) pinOf(drag.node).focus({ preventScroll: true });
    drag = null;
  }
  svg.addEventListener("pointerup", drop);
  svg.addEventListener("pointercancel", () => {  // the finger scrolls the page
    if (drag && drag.node !== drag.begin) move(drag.node, drag.begin);
    drop();
  });

  drawCable();
  return {
    svg, placed, nodes_m,
    put(nodes) { placed.clear(); for (const node of nodes) placed.add(node); show(); changed(); },
  };
};
