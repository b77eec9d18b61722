"use strict";
// The query box of the front page: SQL, a schema to click, answers to sort, and a link to each query.
(() => {
  const { at, ask, get, post, element } = capstanPage;
  const max_shown = 1000;

  function sorted(rows, name, falling) {
    const order = (a, b) => a == null ? (b == null ? 0 : 1) : b == null ? -1 : a < b ? -1 : a > b ? 1 : 0;
    return rows.toSorted((a, b) => falling ? order(b[name], a[name]) : order(a[name], b[name]));
  }

  // A click on the head of a column sorts by it, a second one the other way.
  function tableOf(rows) {
    const columns = rows.length ? Object.keys(rows[0]) : [];
    const table = element("table");
    const is_number = (name) => typeof rows[0][name] === "number";
    const body = table.createTBody();
    const fill = (ordered) => body.replaceChildren(...ordered.slice(0, max_shown).map((row) => element("tr", {}, ...columns.map((name) => {
      const value = row[name];
      const number = typeof value === "number";
      return element("td", { className: number ? "number" : "", textContent: number && !Number.isInteger(value) ? value.toPrecision(6) : value ?? "" });
    }))));
    const heads = columns.map((name) => {
      const button = element("button", { type: "button", className: "sort", textContent: name });
      const head = element("th", { scope: "col", className: is_number(name) ? "number" : "" }, button);
      button.addEventListener("click", () => {
        const falling = head.ariaSort === "ascending";
        for (const other of heads) other.ariaSort = null;
        head.ariaSort = falling ? "descending" : "ascending";
        fill(sorted(rows, name, falling));
      });
      return head;
    });
    table.createTHead().append(element("tr", {}, ...heads));
    fill(rows);
    return table;
  }
  capstanPage.tableOf = tableOf;

  async function run() {
    at("query-problem").textContent = "";
    at("query-count").textContent = "The query runs …";
    at("query-rows").hidden = true;
    const begin = performance.now();
    try {
      const answer = await post("/api/query", { sql: at("sql").value });
      const rows = await answer.json();
      const parts = [rows.length + (rows.length === 1 ? " row" : " rows"), ((performance.now() - begin) / 1000).toFixed(2) + " s"];
      if (answer.headers.get("X-Truncated")) parts.push("cut off: the answer has more");
      if (rows.length > max_shown) parts.push("the first " + max_shown + " are shown");
      at("query-count").textContent = parts.join(", ");
      at("query-rows").replaceChildren(tableOf(rows));
      at("query-rows").hidden = rows.length === 0;
    } catch (error) {
      at("query-count").textContent = "";
      at("query-problem").textContent = error.message;
    }
  }
  at("query-form").addEventListener("submit", (event) => {
    event.preventDefault();
    history.replaceState(null, "", "#sql=" + encodeURIComponent(at("sql").value));
    run();
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

  // ---- the schema: a click puts the name where the cursor is
  function insert(name) {
    const box = at("sql");
    const { selectionStart: from, selectionEnd: to, value } = box;
    const blank = from > 0 && !/[\s(,.]$/.test(value.slice(0, from)) ? " " : "";
    box.setRangeText(blank + name, from, to, "end");
    box.focus();
  }
  const name_button = (name, className) => {
    const button = element("button", { type: "button", className, textContent: name });
    button.addEventListener("click", () => insert(name));
    return button;
  };
  async function showSchema() {
    const sql = "SELECT m.type, m.name AS owner, p.name FROM sqlite_schema m, pragma_table_info(m.name) p WHERE m.type IN ('table', 'view') " +
      "AND m.name NOT LIKE 'sqlite%' ORDER BY m.type DESC, m.name, p.cid";
    const owners = Map.groupBy(await (await post("/api/query", { sql })).json(), (row) => row.owner);
    at("schema-names").replaceChildren(...[...owners].map(([owner, columns]) => {
      const all = element("button", { type: "button", className: "plain", textContent: "Show", ariaLabel: "Show rows of " + owner });
      all.addEventListener("click", () => { at("sql").value = `SELECT * FROM ${owner} LIMIT 100`; at("query-form").requestSubmit(); });
      return element("details", {}, element("summary", { textContent: owner }), element("p", { className: "names" }, all, " ", name_button(owner, "name"),
        ...columns.flatMap((row) => [" ", name_button(row.name, "name")])));
    }));
    at("schema").textContent = await (await ask("/api/schema")).text();
  }

  async function begin() {
    const asked = /^#sql=(.*)$/.exec(location.hash);
    if (asked) {
      at("sql").value = decodeURIComponent(asked[1]);
      at("query").scrollIntoView();
      run();
    }
    await showSchema().catch((error) => { at("query-problem").textContent = error.message; });
    document.documentElement.dataset.schema = "yes";
  }
  begin();
})();
