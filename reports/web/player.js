"use strict";
// A cable played along its recording: below a figure of the tension along a cable, the cable itself, coloured by its
// tension, at a moment that a slider chooses. The figure marks the same moment.
(() => {
  const svgNs = "http://www.w3.org/2000/svg";
  const top = 14, bottom = 92, cable_y = 122, play_interval_ms = 50, play_time_s = 12, end_swing = 22;
  const drawn = (name, attributes, text) => {
    const made = document.createElementNS(svgNs, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  const made = (name, properties) => Object.assign(document.createElement(name), properties);

  function addPlayer(figure) {
    const width = figure.clientWidth < 560 ? 400 : 760, left = 64, right = width - 58;  // letters keep their size
    const rows = window.capstanPage.rowsOf(figure, "along");
    const moments = [];  // { time_s, motor_end_m, tension_N }
    for (const row of rows) {
      if (moments.at(-1)?.time_s !== row.time_s) moments.push({ time_s: row.time_s, motor_end_m: row.motor_end_m, tension_N: [] });
      moments.at(-1).tension_N.push(row.tension_N);
    }
    const places_m = rows.filter((row) => row.time_s === moments[0].time_s).map((row) => row.place_m);
    const range = (values) => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]);
    const [low_N, high_N] = range(rows.map((row) => row.tension_N)), [first_m, last_m] = range(moments.map((each) => each.motor_end_m));
    const x = (place_m) => left + (right - left) * place_m / places_m.at(-1);
    const part = (tension_N) => high_N > low_N ? (tension_N - low_N) / (high_N - low_N) : 0.5;
    const y = (tension_N) => bottom - (bottom - top) * part(tension_N);
    const colour = window.vega.scheme("viridis");

    const svg = drawn("svg", { class: "cable player-cable", viewBox: `0 0 ${width} 156`, role: "img", "aria-label": "The cable from motor to load at the chosen moment, its tension above it" });
    for (const tension_N of [low_N, high_N])
      svg.append(drawn("line", { class: "level", x1: left, x2: right, y1: y(tension_N), y2: y(tension_N) }), drawn("text", { class: "tick level-name", x: left - 6, y: y(tension_N) + 4 }, tension_N.toPrecision(3) + " N"));
    const curve = drawn("polyline", { class: "curve" });
    const pieces = places_m.slice(1).map((place_m, k) => drawn("line", { x1: x(places_m[k]), x2: x(place_m) + 0.5, y1: cable_y, y2: cable_y, "stroke-width": 9 }));
    const motor = drawn("rect", { class: "end", x: left - 46, y: cable_y - 12, width: 40, height: 24, rx: 5 });
    svg.append(curve, ...pieces, motor, drawn("text", { class: "end-name", x: left - 26, y: cable_y + 28 }, "motor"),
      drawn("rect", { class: "end", x: right + 6, y: cable_y - 12, width: 40, height: 24, rx: 5 }), drawn("text", { class: "end-name", x: right + 26, y: cable_y + 28 }, "load"));

    const slider = made("input", { type: "range", min: 0, max: moments.length - 1, value: 0 });
    slider.setAttribute("aria-label", "Moment of the recording");
    const words = made("output", {});
    const button = made("button", { type: "button", textContent: "Play" });
    function show() {
      const { time_s, motor_end_m, tension_N } = moments[Number(slider.value)];
      curve.setAttribute("points", places_m.map((place_m, k) => x(place_m) + "," + y(tension_N[k])).join(" "));
      pieces.forEach((piece, k) => piece.setAttribute("stroke", colour(part((tension_N[k] + tension_N[k + 1]) / 2))));
      const swing = last_m > first_m ? (motor_end_m - first_m) / (last_m - first_m) - 0.5 : 0;
      motor.setAttribute("transform", `translate(${(swing * end_swing).toFixed(1)} 0)`);
      words.textContent = `${time_s.toFixed(2)} s: ${tension_N[0].toFixed(2)} N at the motor, ${tension_N.at(-1).toFixed(2)} N at the load`;
      slider.setAttribute("aria-valuetext", words.textContent);
      figure.view?.signal("now", time_s).runAsync();
    }
    let playing = 0;
    function stop() {
      clearInterval(playing);
      playing = 0;
      button.textContent = "Play";
    }
    button.addEventListener("click", () => {
      if (playing) return stop();
      button.textContent = "Pause";
      if (Number(slider.value) >= moments.length - 1) slider.value = 0;
      const step = Math.max(1, Math.round(moments.length * play_interval_ms / 1000 / play_time_s));
      playing = setInterval(() => {
        slider.value = Math.min(Number(slider.value) + step, moments.length - 1);
        show();
        if (Number(slider.value) >= moments.length - 1) stop();
      }, play_interval_ms);
    });
    slider.addEventListener("input", () => { stop(); show(); });
    const keys = made("div", { className: "player-keys" });
    keys.append(button, slider, words);
    const player = made("div", { className: "player" });
    player.append(svg, keys);
    figure.querySelector(".chart").after(player);
    show();
  }
  for (const figure of document.querySelectorAll("figure[data-figure]")) if (window.capstanPage.about(figure).player) addPlayer(figure);
})();
