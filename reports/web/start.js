"use strict";
// Starting a study, or another question about a configuration: problems are told while it is written, and what takes
// more than a minute is asked for.
(() => {
  const { at, ask, get, post, element, problemList, seconds } = capstanPage;
  const asks_above_s = 60, check_after_ms = 400;

  // What is found decides how long a diagnosis takes.
  const duration = ({ min_seconds, seconds: longest }) => min_seconds == null || seconds(min_seconds) === seconds(longest) ? seconds(longest) : `${seconds(min_seconds)} to ${seconds(longest)}`;

  // Whether to start, once the cost is known: at once if it is short, else as the user decides.
  let decide = null, clicks = 0;
  // What the service refuses to start is thrown. With a doubt it is asked for whatever it costs.
  capstanPage.accepted = async (form, what, cost_of, doubt = "") => {
    const mine = ++clicks;  // a later click takes the place of this one
    at(form + "-cost").hidden = true;
    at(form + "-cost-words").textContent = "Estimating the cost …";
    decide?.(false);
    let cost = { known: false };
    try { cost = await cost_of(); } catch { /* the start says what is wrong */ }
    if (mine !== clicks) return false;
    at(form + "-cost-words").textContent = "";
    if (cost.problems) throw new Error(cost.problems);
    const unknown = cost.may_be_long ? "How long it takes could not be estimated: this machine is busy, or the work is long." : "";
    const told = cost.known ? `${cost.studies === 1 ? what + " takes" : cost.studies + " studies take"} ${cost.is_at_least ? "at least" : "about"} ${duration(cost)} on this machine.` : unknown;
    at(form + "-cost-words").textContent = [doubt, told].filter(Boolean).join(" ");
    const is_short = cost.known ? cost.seconds <= asks_above_s && !cost.is_at_least : !cost.may_be_long;
    if (!doubt && is_short) return true;
    at(form + "-cost").hidden = false;
    at(form + "-anyway").focus();
    const is_wanted = await new Promise((decided) => { decide = decided; });
    at(form + "-cost").hidden = true;
    if (!is_wanted) at(form + "-cost-words").textContent = "";
    return is_wanted;
  };
  for (const form of ["start", "again", "upload", "import"]) {
    at(form + "-anyway").addEventListener("click", () => decide?.(true));
    at(form + "-not").addEventListener("click", () => decide?.(false));
  }

  capstanPage.listConfigs = async () => {
    for (const name of await get("/api/configs")) at("config-name").append(element("option", { value: name, textContent: name }));
  };
  const question = () => at("question").value;
  const wish = () => ({ ...(at("config-name").value ? { config: at("config-name").value } : { config_toml: at("config-text").value }), ...(question() === "study" ? {} : { command: question() }) });
  const path = () => question() === "study" ? "/api/studies" : "/api/answers";
  const showProblems = (message) => at("start-problem").replaceChildren(...problemList(message));

  at("config-name").addEventListener("change", async () => {
    const name = at("config-name").value;
    if (name) at("config-text").value = await (await ask("/api/configs/" + encodeURIComponent(name))).text();
    check();
  });

  // ---- problems while the configuration is written
  let timer = 0, checked = 0;
  async function check() {
    clearTimeout(timer);
    const mine = ++checked;
    if (!at("config-name").value && !at("config-text").value.trim()) return showProblems("");
    try {
      const { problems } = await (await post("/api/configs/check", wish())).json();
      if (mine === checked) showProblems(problems.join("\n"));
    } catch { /* the start says it again */ }
  }
  at("config-text").addEventListener("input", () => {
    at("config-name").value = "";
    clearTimeout(timer);
    timer = setTimeout(check, check_after_ms);
  });

  at("start-form").addEventListener("submit", async (event) => {
    event.preventDefault();
    clearTimeout(timer);
    ++checked;
    showProblems("");
    if (!at("config-name").value && !at("config-text").value.trim()) return showProblems("Choose a configuration, or write one.");
    try {
      const asked = wish(), where = path();
      if (!await capstanPage.accepted("start", question() === "study" ? "The study" : "The answer", async () => (await post(where + "/cost", asked)).json())) return;
      await post(where, asked);
      await capstanPage.refresh();
      at(where === "/api/studies" ? "studies" : "jobs-title").scrollIntoView();
    } catch (error) {
      showProblems(error.message);
    }
  });
})();
