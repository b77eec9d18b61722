"use strict";
// A figure as a file (SVG, PNG), the rows behind it (a table, CSV), and the start of the page.
(() => {
  const { tables, tableOf, tableNames, rowsOf, about, specOf, onPaper, load, drawAll } = window.capstanPage;

  // ---- the rows behind a figure
  const shown = (value) => typeof value === "number" && !Number.isInteger(value) ? value.toPrecision(4) : value ?? "";
  const field = (value) => /[",\r\n]/.test(value) ? '"' + String(value).replaceAll('"', '""') + '"' : value ?? "";
  const csv = (columns, rows) => [columns, ...rows.map((row) => columns.map((column) => row[column]))].map((line) => line.map(field).join(",")).join("\r\n") + "\r\n";

  const counted = (rows) => rows + (rows === 1 ? " row" : " rows");

  function download(name, columns, rows) {
    const link = document.createElement("a");
    link.textContent = name + ".csv";
    link.download = name + ".csv";
    link.href = "#";
    link.addEventListener("click", () => {  // made on demand, so that the page holds no copies
      const address = URL.createObjectURL(new Blob([csv(columns, rows())], { type: "text/csv" }));
      link.href = address;
      setTimeout(() => URL.revokeObjectURL(address), 60000);
    });
    return link;
  }

  // ---- a figure and its data as files
  const scale_of_pixels = 2;  // sharp in print
  // In the colours of print, whatever the theme of the screen is. The page itself is not painted in between.
  function asOnPaper(make) {
    const state = document.documentElement.dataset;
    if (onPaper()) return make();
    state.paper = "";
    try {
      return make();
    } finally {
      delete state.paper;
    }
  }
  const viewOnPaper = (make) => new vega.View(vega.parse(vegaLite.compile(asOnPaper(make)).spec), { renderer: "none" }).runAsync();
  const ways = {
    SVG: async (make) => new Blob([await (await viewOnPaper(make)).toSVG()], { type: "image/svg+xml" }),
    PNG: async (make) => {
      const canvas = await (await viewOnPaper(make)).toCanvas(scale_of_pixels);
      return new Promise((made) => canvas.toBlob(made, "image/png"));
    },
  };
  // `capstan report --figures` opens the page with #figures=WIDTH and reads what this leaves in it.
  async function leaveFigureFiles(width_px) {
    const files = [];
    const figures = document.querySelectorAll("figure[data-figure]");
    for (const figure of figures) {
      window.capstanPage.tell(figures.length);
      if (rowsOf(figure, about(figure).tables[0]).length === 0) continue;
      const view = await viewOnPaper(() => specOf(figure, 0, width_px));
      files.push({ name: figure.id, svg: await view.toSVG(), png: (await view.toCanvas(4)).toDataURL("image/png") });
    }
    const place = document.body.appendChild(document.createElement("pre"));
    place.id = "figure-files";
    place.textContent = btoa(unescape(encodeURIComponent(JSON.stringify(files))));
  }
  function hand_over(name, blob) {
    const link = document.createElement("a");
    link.download = name;
    link.href = URL.createObjectURL(blob);
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  }
  // `tables`: [words of the button, name of the file, columns, rows when asked]
  function buttonsOf(name, title, make, tables) {
    const group = document.createElement("div");
    group.className = "save";
    group.setAttribute("role", "group");
    group.setAttribute("aria-label", "Save: " + title);
    const add = (words, save) => {
      const button = group.appendChild(document.createElement("button"));
      button.type = "button";
      button.textContent = words;
      button.setAttribute("aria-label", words + " of " + title);
      button.addEventListener("click", save);
    };
    for (const [way, made] of Object.entries(ways)) add(way, async () => hand_over(name + "." + way.toLowerCase(), await made(make)));
    for (const [words, file, columns, rows] of tables) add(words, () => hand_over(file + ".csv", new Blob([csv(columns(), rows())], { type: "text/csv" })));
    return group;
  }
  function saveButtons(figure) {
    const { tables: names } = about(figure);
    return buttonsOf(figure.id, figure.querySelector("h3").firstChild.textContent.trim(), () => specOf(figure, 0),
      names.map((name) => [names.length === 1 ? "CSV" : "CSV: " + name.replaceAll("_", " "), figure.id + "-" + name, () => tableOf(name).columns, () => rowsOf(figure, name)]));
  }

  function showRows(figure) {
    const place = figure.querySelector(".data-rows");
    place.replaceChildren();
    for (const name of about(figure).tables) {
      const { columns, meaning } = tableOf(name);
      const rows = rowsOf(figure, name);
      const words = document.createElement("p");
      words.append(meaning + " – ", counted(rows.length) + ": ", download(figure.id + "-" + name, columns, () => rows));
      const scroll = document.createElement("div");
      scroll.className = "scroll tall";
      scroll.tabIndex = 0;
      scroll.setAttribute("role", "region");
      scroll.setAttribute("aria-label", meaning);
      const table = scroll.appendChild(document.createElement("table"));
      const head = table.createTHead().insertRow();
      for (const column of columns) {
        const cell = head.appendChild(document.createElement("th"));
        cell.scope = "col";
        cell.textContent = column;
      }
      const body = table.createTBody();
      for (const row of rows) {
        const line = body.insertRow();
        for (const column of columns) {
          const cell = line.insertCell();
          cell.textContent = shown(row[column]);
          if (typeof row[column] === "number") cell.className = "number";
        }
      }
      place.append(words, scroll);
    }
  }

  // ---- controls in the text of the page
  function attach() {
    for (const figure of document.querySelectorAll("figure[data-figure]")) {
      figure.querySelector("details.data").before(saveButtons(figure));
      figure.querySelector("details.data").addEventListener("toggle", (event) => {
        if (event.target.open) showRows(figure);
      });
    }
    const downloads = document.getElementById("downloads");
    for (const name of tableNames()) {
      const table = tableOf(name);
      if (!downloads || table.rows === 0) continue;
      const item = downloads.appendChild(document.createElement("li"));
      item.append(download(name, table.columns, () => tables()[name]), " " + table.meaning + " (" + counted(table.rows) + ")");
    }
    for (const box of document.querySelectorAll('input[name="noise"]')) box.addEventListener("change", drawAll);
  }

  Object.assign(window.capstanPage, {
    showRows,
    saveButtons: (name, title, make, rows) => buttonsOf(name, title, make, [["CSV", name, () => Object.keys(rows()[0]), rows]]),
    reload() { load(); attach(); return drawAll(); },
  });
  const asked = /^#figures=(\d+)$/.exec(location.hash);
  if (asked) {
    load();
    leaveFigureFiles(Number(asked[1]));
  } else {
    window.capstanPage.reload();
  }
})();
