// Uses the pages of a running `capstan serve` as a person would, in headless Chromium.
// usage: node service_pages.mjs SCREENSHOT_FOLDER ADDRESS LOG.csv SIDECAR.json LABORATORY_LOG.csv TENSIONS.csv
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { accessible, check, finish, launch, startHoweverLong } from "./checks.mjs";
import { askQuestions, estimateTension, seeProblems } from "./service_answers.mjs";
import { markSamples } from "./brushing.mjs";
import { placeByHand } from "./service_by_hand.mjs";

const [folder, address, log, sidecar, laboratory, tensions] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const profile = mkdtempSync(join(tmpdir(), "capstan-browser-"));

const requests = [], complaints = [];
async function open(browser, path) {
  const page = await browser.newPage();
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.goto(new URL(path, address).href);
  return page;
}
const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
const text = (page, selector) => page.$eval(selector, (each) => each.textContent);

async function startAndWatch(page) {
  await page.selectOption("#config-name", "quick.toml");
  await page.waitForFunction(() => document.querySelector("#config-text").value.includes("repetitions"));
  await startHoweverLong(page, "start");
  await page.waitForSelector('#job-table tr[data-state="done"]');
  check((await text(page, "#study-table tbody")).includes("complete"), "the study is complete in the list");

  await page.fill("#config-text", "repetitions = -1");
  await page.click("#start-form button[type=submit]");
  await page.waitForFunction(() => document.querySelector("#start-problem").textContent.includes("repetitions"));
  check(await page.$eval("#config-name", (each) => each.value) === "", "a changed text is no longer the file's");
}

async function watchCellsFill(browser) {
  // A longer one, opened while it runs: its report grows without reloading.
  const front = await open(browser, "/");
  await front.waitForSelector("html[data-ready=yes]");
  await front.selectOption("#config-name", "noise-instants.toml");
  await front.waitForFunction(() => document.querySelector("#config-text").value.includes("noise"));
  await front.$eval("#config-text", (each) => { each.value = each.value.replace(/^repetitions.*$/m, "repetitions = 400"); });
  await front.dispatchEvent("#config-text", "input");
  await startHoweverLong(front, "start");
  await front.waitForFunction(() => document.querySelectorAll("#study-table tbody tr").length === 2);
  const page = await open(browser, "/studies/2");
  await page.waitForSelector("html[data-live=yes]");
  await page.evaluate(() => { window.never_reloaded = true; });
  await page.screenshot({ path: join(folder, "service_running.png") });
  await page.waitForSelector("html[data-study=complete]");
  await page.waitForSelector("main figure[data-figure] svg");
  check(await page.evaluate(() => window.never_reloaded === true), "the report grew without reloading");
  check((await page.$$(".cells i:not(.done)")).length === 0, "all cells are filled at the end");
  check((await page.$$('input[name="noise"]')).length > 1, "the noise levels can be chosen");
  await front.close();
  await page.close();
}

async function useTheReport(page) {
  await page.waitForSelector("html[data-live=yes]");
  await page.waitForSelector("html[data-drawn=yes]");
  const chart = "#figure-error_by_count-mass svg";
  const before = await page.$eval(chart, (svg) => svg.outerHTML);
  await page.click('#filters input[value="Mean"]');
  await page.waitForFunction(([where, old]) => document.querySelector("html").dataset.drawn === "yes" && document.querySelector(where).outerHTML !== old, [chart, before]);
  await page.fill('#filters input[data-filter="max"]', "2");
  await page.dispatchEvent('#filters input[data-filter="max"]', "change");
  await page.waitForFunction(() => document.querySelector("html").dataset.drawn === "yes");
  await page.click('#filters input[value="mass"]');
  check(await page.$eval("#figure-error_by_count-mass", (figure) => figure.hidden), "a regime that is not chosen is not shown");
  await page.click('#filters input[value="mass"]');
}

async function query(page) {
  await page.fill("#sql", "SELECT family, sensor_count, mean_abs_error_N FROM v_best_method LIMIT 4");
  await page.click("#query-form button[type=submit]");
  await page.waitForSelector("#query-rows tbody tr");
  check((await page.$$("#query-rows tbody tr")).length === 4, "a query shows its rows");
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#query-csv")]);
  check(saved.suggestedFilename() === "capstan-query.csv", "the rows can be saved");
  check((await text(page, "#schema")).includes("CREATE TABLE study"), "the schema stands beside");
}

async function refusedQuery(page) {
  const silent = complaints.length;
  await page.fill("#sql", "DELETE FROM study");
  await page.click("#query-form button[type=submit]");
  await page.waitForFunction(() => document.querySelector("#query-problem").textContent.includes("only read"));
  complaints.splice(silent);  // the browser tells of the 400
}

// What a recording costs is of this machine, so that a long one is told to the page instead.
async function askedBeforeALongDiagnosis(page, button, form, path) {
  const started = [], count = (request) => { if (request.method() === "POST" && /\/api\/(diagnoses|import\/diagnosis)$/.test(request.url())) started.push(request.url()); };
  page.on("request", count);
  await page.route(path, (route) => route.fulfill({ json: { known: true, studies: 1, min_seconds: 20, seconds: 240 } }));
  await page.click(button);
  await page.waitForSelector(`#${form}-cost:not([hidden])`);
  check((await text(page, `#${form}-cost-words`)).endsWith("The diagnosis takes about 20 s to 4 min on this machine."), "the cost of a diagnosis is told: " + await text(page, `#${form}-cost-words`));
  await page.click(`#${form}-not`);
  await page.waitForSelector(`#${form}-cost`, { state: "hidden" });
  check(await text(page, `#${form}-cost-words`) === "", "the mouse cancels it");
  await page.focus(button);
  await page.keyboard.press("Enter");
  await page.waitForSelector(`#${form}-cost:not([hidden])`);
  check(await page.evaluate(() => document.activeElement.id) === form + "-anyway", "the question has the focus");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await page.waitForSelector(`#${form}-cost`, { state: "hidden" });
  check(started.length === 0, "a key cancels it, and nothing was started: " + started);
  await page.unroute(path);
  page.off("request", count);
}

// What cannot be diagnosed is told beside the button, and nothing is queued.
async function refusedRecording(page) {
  const silent = complaints.length, jobs = await page.$$eval("#job-table tbody tr", (all) => all.length);
  await page.setInputFiles("#log", laboratory);
  await page.setInputFiles("#sidecar", sidecar);
  await page.click("#upload-form button[value=diagnose]");
  await page.waitForSelector("#upload-problem li");
  const problems = await text(page, "#upload-problem");
  check(/no column 'motor_torque'/.test(problems) && !/capstan-cost/.test(problems), "what is wrong with a recording is told: " + problems);
  check(await page.$$eval("#job-table tbody tr", (all) => all.length) === jobs, "nothing is queued");
  complaints.splice(silent);
}

async function diagnose(page) {
  await page.setInputFiles("#log", log);
  await page.setInputFiles("#sidecar", sidecar);
  await askedBeforeALongDiagnosis(page, "#upload-form button[value=diagnose]", "upload", "**/api/diagnoses/cost");
  await startHoweverLong(page, "upload");
  await page.waitForSelector(".verdict-card");
  const verdict = await text(page, ".verdict-card");
  check(/\d+%/.test(verdict) && verdict.length > 60, "the verdict is told: " + verdict.slice(0, 120));
  await page.click(".verdict-card summary");
  await page.waitForSelector(".verdict-card tbody tr");
  check((await page.$$(".verdict-card tbody tr")).length > 3, "every cause has its probability");
}

// Dates, undo, run again, compare two; what costs much is asked for.
async function manageStudies(browser) {
  const page = await open(browser, "/");
  await page.waitForSelector("html[data-ready=yes]");
  const rows = () => page.$$eval("#study-table tbody tr", (all) => all.length);
  const comesTo = (count) => page.waitForFunction((wanted) => document.querySelectorAll("#study-table tbody tr").length === wanted, count);
  await comesTo(2);
  check(/\d{4}/.test(await text(page, "#study-table tbody tr td:nth-of-type(2)")), "a study says when it was begun");
  await page.fill("#study-filter", "instants");
  await comesTo(1);
  await page.fill("#study-filter", "");
  await comesTo(2);
  await page.click('[aria-label="Delete study 2"]');
  await comesTo(1);
  await page.click('[aria-label="Undo: bring study 2 back"]');
  await comesTo(2);
  await page.click('[aria-label="Delete study 2"]');
  await comesTo(1);
  await page.waitForSelector("#trash:not([hidden])");
  check(/Trash \(1\)/.test(await text(page, "#trash summary")), "the trash tells how much is in it");
  await page.click("#trash summary");
  await page.click('[aria-label="Restore study 2"]');
  await comesTo(2);
  await page.route("**/api/studies/cost", (route) => route.fulfill({ json: { known: false, may_be_long: true } }));
  await page.click('[aria-label="Run again: study 1"]');
  await page.waitForSelector("#again-cost:not([hidden])");
  check((await text(page, "#again-cost-words")).includes("could not be estimated"), "a cost that is not told is asked for: " + await text(page, "#again-cost-words"));
  await page.click("#again-not");
  await page.unroute("**/api/studies/cost");
  await page.route("**/api/studies/cost", (route) => route.fulfill({ json: { known: true, studies: 1, seconds: 7200 } }));
  await page.click('[aria-label="Run again: study 1"]');
  await page.waitForSelector("#again-cost:not([hidden])");
  check((await text(page, "#again-cost-words")) === "Study 1 takes about 2.0 h on this machine.", "what begins again tells its cost: " + await text(page, "#again-cost-words"));
  await accessible(page, "the front page that asks");
  await page.click("#again-not");
  await page.waitForSelector("#again-cost", { state: "hidden" });
  check(await rows() === 2, "a study that was cancelled does not begin again");
  await page.focus('[aria-label="Run again: study 1"]');
  await page.keyboard.press("Enter");
  await page.waitForSelector("#again-cost:not([hidden])");
  await page.keyboard.press("Enter");
  await comesTo(3);
  await page.unroute("**/api/studies/cost");
  await page.waitForFunction(() => [...document.querySelectorAll("#study-table tbody tr")].every((row) => row.textContent.includes("complete")));
  await page.check('[aria-label="Choose study 1"]');
  check(await page.$eval("#compare", (each) => each.disabled), "one study cannot be compared");
  await page.check('[aria-label="Choose study 3"]');
  await page.click("#compare");
  await page.waitForSelector("main section");
  await accessible(page, "the comparison");
  check(/\/studies\/1\/compare\/3$/.test(page.url()), "two studies are compared: " + page.url());
  await page.goto(new URL("/", address).href);
  await page.waitForSelector("html[data-ready=yes]");

  await page.selectOption("#config-name", "atlas.toml");
  await page.click("#start-form button[type=submit]");
  await page.waitForSelector("#start-cost:not([hidden])");
  check(/\d+ studies take about .* on this machine|could not be estimated: this machine is busy/.test(await text(page, "#start-cost-words")), "the cost is told: " + await text(page, "#start-cost-words"));
  await page.locator("#start").screenshot({ path: join(folder, "service_cost.png") });
  await page.click("#start-not");
  check(!(await page.$("#job-table tr[data-state=running]")), "nothing was started");
  await page.click("#start-form button[type=submit]");
  await page.waitForSelector("#start-cost:not([hidden])");
  await page.click("#start-anyway");
  await page.waitForSelector("#stop-all:not([hidden])");
  await page.click("#stop-all");
  await page.waitForFunction(() => document.querySelector("#stop-all").hidden);
  check(await page.$$eval("#job-table tr[data-state=stopped]", (all) => all.length) > 10, "all jobs are stopped");
  const benches = await page.$$eval("#config-name option", (all) => all.filter((each) => each.value.startsWith("bench-")).length);
  check(benches === 0, "a bench is not offered as a study");
  check(await rows() >= 3, "the studies stay");
  await page.setViewportSize({ width: 390, height: 844 });
  check(await overflow(page) <= 0, "the front page fits a telephone");
  await page.screenshot({ path: join(folder, "service_front_390.png"), fullPage: true });
  await page.close();
}

async function openWholePages(browser) {
  const page = await open(browser, "/diagnoses/1");
  await page.waitForSelector("main figure[data-figure] svg");
  await page.waitForSelector("html[data-drawn=yes]");
  check((await page.$$("main figure[data-figure] svg")).length > 2, "the diagnosis has its curves");
  await accessible(page, "the diagnosis, light");
  await page.screenshot({ path: join(folder, "service_diagnosis.png") });
  await markSamples(page, "diagnosis", folder);
  for (const [width, dark] of [[390, false], [390, true]]) {
    await page.setViewportSize({ width, height: 844 });
    await page.emulateMedia({ colorScheme: dark ? "dark" : "light" });
    await page.waitForTimeout(400);
    await page.waitForFunction(() => document.documentElement.dataset.drawn === "yes");
    check(await overflow(page) <= 0, "the diagnosis fits a telephone");
    const cut = await page.$$eval("main figure .chart", (all) => all.filter((each) => each.scrollWidth > each.clientWidth).map((each) => each.closest("figure").id));
    check(cut.length === 0, "no chart of the diagnosis is cut off on a telephone: " + cut);
    await markSamples(page, `diagnosis 390${dark ? " dark" : ""}`, folder);
  }
  await page.screenshot({ path: join(folder, "service_diagnosis_390_dark.png") });
  await accessible(page, "the diagnosis, narrow, dark");
  const model = await (await fetch(new URL("/api/diagnoses/1/model", address))).text();
  check(model.includes("[") && model.includes("="), "the corrected model can be downloaded: " + model.slice(0, 60));
  await page.goto(new URL("/glossary", address).href);
  check((await text(page, "main")).includes("regret"), "the glossary explains regret");
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    await accessible(page, "the glossary, " + colorScheme);
  }
  await page.close();
}

async function shareAQuery(browser) {
  const page = await open(browser, "/");
  await page.waitForSelector("html[data-schema=yes]");
  await page.fill("#sql", "SELECT sensor_count, mean_abs_error_N FROM ");
  await page.click("#schema-names summary:has-text('v_best_method')");
  await page.click("#schema-names details[open] .name >> nth=0");
  check((await page.$eval("#sql", (each) => each.value)).endsWith("FROM v_best_method"), "a click puts a name into the query");
  await page.click("#query-form button[type=submit]");
  await page.waitForSelector("#query-rows tbody tr");
  const other = await open(browser, new URL(page.url()).hash ? "/" + new URL(page.url()).hash : "/");
  await other.waitForSelector("#query-rows tbody tr");
  const column = () => other.$$eval("#query-rows tbody td:nth-child(2)", (all) => all.map((each) => Number(each.textContent)));
  await other.click("#query-rows th:nth-child(2) button");
  const rising = await column();
  check(rising.every((value, k) => k === 0 || rising[k - 1] <= value), "a click sorts the rows");
  await other.click("#query-rows th:nth-child(2) button");
  check((await column())[0] === Math.max(...rising), "a second one sorts them the other way");
  await other.close();
  await page.close();
}

// The file is that of a laboratory: other names, degrees, milliseconds, and two columns whose names say nothing.
async function importALog(page) {
  const silent = complaints.length;
  await page.setInputFiles("#import-files", laboratory);
  await page.selectOption("#import-kind", "pull_pull");
  await page.click("#import-form button[type=submit]");
  await page.waitForSelector("#import-columns .column svg.spark polyline");
  const columns = await page.$$eval("#import-columns .column b", (all) => all.map((each) => each.textContent));
  check(columns.length === 5, "all columns are drawn: " + columns.join(", "));
  const idle = () => page.waitForFunction(() => document.querySelector("#import-try").disabled === false);
  const columnOf = (role) => page.$eval(`[data-role="${role}"] .role-column`, (each) => each.selectedOptions[0].textContent);
  const toml = () => page.$eval("#import-text", (each) => each.value);
  check((await page.$$("#import-roles .guesses li")).length >= 2, "every guess has its reason");

  // With the mouse, then with the keyboard alone.
  await page.dragAndDrop(`#import-columns .column:nth-child(${columns.indexOf("ch3") + 1})`, '[data-role="motor_angle"]');
  await page.waitForFunction(() => /motor_angle = .*"ch3"/.test(document.querySelector("#import-text").value));
  await idle();
  check(await columnOf("motor_angle") === "ch3", "a column is dragged to a channel");
  await page.focus('[data-role="load_angle"] .role-column');
  await page.keyboard.type("ch5");
  await page.keyboard.press("Tab");
  await page.waitForFunction(() => /load_angle = .*"ch5"/.test(document.querySelector("#import-text").value));
  await idle();
  check(await columnOf("load_angle") === "ch5", "the keyboard assigns a column");
  for (const role of ["motor_angle", "load_angle"]) {
    await page.fill(`[data-role="${role}"] .role-unit`, "deg");
    await page.keyboard.press("Tab");
    await page.waitForFunction((name) => new RegExp(name + ' = .*"deg"').test(document.querySelector("#import-text").value), role);
    await idle();
  }
  await page.selectOption('[data-role="load_torque"] .role-sign', "-1");
  await page.waitForFunction(() => /load_torque = .*sign = -1/.test(document.querySelector("#import-text").value));
  await idle();

  // The text is the truth: what is changed there shows in the channels, and a mistake is told with its line.
  const before = await toml();
  await page.route("**/api/import/diagnosis/cost", (route) => route.fulfill({ json: { known: true, studies: 1, seconds: 5 } }));
  await page.click("#import-diagnose");
  await page.waitForSelector("#import-cost:not([hidden])");
  check(/^The numbers of the bench are still placeholders/.test(await text(page, "#import-cost-words")), "a diagnosis of placeholders is asked for, however short");
  await page.click("#import-not");
  await page.unroute("**/api/import/diagnosis/cost");
  await page.fill("#import-text", before.replace(", sign = -1", "").replace(/T0 = .*/g, "T0 = 20.0").replace(/^nominal = .*$/m, `nominal = ${nominalToml()}`));
  await page.waitForFunction(() => document.querySelector('[data-role="load_torque"] .role-sign').value === "1");
  const good = await toml();
  await page.fill("#import-text", good.replace("\n[recording]", "\n[recordings]"));
  await page.waitForFunction(() => /recordings/.test(document.querySelector("#import-mapping-problems").textContent));
  await page.fill("#import-text", good);
  await page.waitForFunction(() => document.querySelector("#import-mapping-problems").textContent === "");
  await page.locator("#import").screenshot({ path: join(folder, "service_import.png") });

  await page.click("#import-try");
  await page.waitForSelector("#import-result .channel-chart polyline");
  check(/1 run, 801 samples at 100 Hz/.test(await text(page, "#import-result h3")), "a trial says what was read: " + await text(page, "#import-result h3"));
  check((await page.$$("#import-result .channel-chart")).length === 4, "the channels of the recording are drawn");
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click("#import-save")]);
  check(saved.suggestedFilename() === "import.toml" && readFileSync(await saved.path(), "utf8") === good, "the mapping is saved as it stands");

  const cards = (await page.$$(".verdict-card")).length;
  await askedBeforeALongDiagnosis(page, "#import-diagnose", "import", "**/api/import/diagnosis/cost");
  await startHoweverLong(page, "import", "#import-diagnose");
  await page.waitForFunction(() => /Job \d+ is queued/.test(document.querySelector("#import-run-status").textContent));
  await page.locator("#import").screenshot({ path: join(folder, "service_import_tried.png") });
  await page.emulateMedia({ colorScheme: "dark" });
  await page.setViewportSize({ width: 400, height: 850 });
  check(await overflow(page) <= 0, "the import has no horizontal scroll on a narrow screen");
  await page.locator("#import").screenshot({ path: join(folder, "service_import_narrow_dark.png") });
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.locator("#import").screenshot({ path: join(folder, "service_import_dark.png") });
  await page.emulateMedia({ colorScheme: "light" });
  await page.waitForFunction((count) => document.querySelectorAll(".verdict-card").length > count, cards);
  check(/laboratory: .*%/.test(await text(page, ".verdict-card")), "the imported log has its verdict: " + (await text(page, ".verdict-card")).slice(0, 80));
  complaints.splice(silent, complaints.length, ...complaints.slice(silent).filter((words) => !/400/.test(words)));
}
function nominalToml() {
  const nominal = JSON.parse(readFileSync(laboratory.replace(/laboratory\.csv$/, "bench.json"), "utf8")).nominal;
  const value = (each) => Array.isArray(each) ? "[" + each.map(value).join(", ") + "]" : typeof each === "object" ? "{ " + Object.entries(each).map(([key, inner]) => `${key} = ${value(inner)}`).join(", ") + " }" : JSON.stringify(each);
  return value(nominal);
}

let browser;
try {
  browser = await launch(profile);
  const front = await open(browser, "/");
  await front.waitForSelector("html[data-ready=yes]");
  const silent = complaints.length;
  await startAndWatch(front);
  complaints.splice(silent, complaints.length, ...complaints.slice(silent).filter((words) => !/400/.test(words)));

  const study = await open(browser, "/studies/1");
  await useTheReport(study);
  await placeByHand(study, folder, (path) => open(browser, path));
  check(await overflow(study) <= 0, "the study's page has no horizontal scroll");
  await study.screenshot({ path: join(folder, "service_study.png"), fullPage: true });
  await study.emulateMedia({ colorScheme: "dark" });
  await study.waitForFunction(() => document.documentElement.dataset.drawn === "yes");
  await study.screenshot({ path: join(folder, "service_study_dark.png") });
  await accessible(study, "a study, dark");
  await study.emulateMedia({ colorScheme: "light" });
  await accessible(study, "a study, light");
  await study.close();

  const seen = (path) => open(browser, path);
  await seeProblems(front, folder);
  await askQuestions(front, folder, seen);
  await (await estimateTension(front, folder, seen, tensions)).close();
  await query(front);
  await refusedQuery(front);
  await query(front);
  await refusedRecording(front);
  await diagnose(front);
  await importALog(front);
  check(await overflow(front) <= 0, "the front page has no horizontal scroll");
  await front.screenshot({ path: join(folder, "service_front.png"), fullPage: true });
  await front.emulateMedia({ colorScheme: "dark" });
  await front.setViewportSize({ width: 700, height: 900 });
  check(await overflow(front) <= 0, "nor on a narrow screen");
  await accessible(front, "the front page, narrow, dark");
  await front.emulateMedia({ colorScheme: "light" });
  await accessible(front, "the front page, light");
  await front.emulateMedia({ colorScheme: "dark" });
  await front.screenshot({ path: join(folder, "service_front_narrow_dark.png"), fullPage: true });
  await watchCellsFill(browser);
  await manageStudies(browser);
  await openWholePages(browser);
  await shareAQuery(browser);

  check(complaints.length === 0, "the console is silent: " + complaints.slice(0, 3).join(" | "));
  const strangers = requests.filter((url) => !url.startsWith(address));
  check(strangers.length === 0, "no request leaves the machine: " + strangers.join(" "));
} finally {
  await browser?.close();
  rmSync(profile, { recursive: true, force: true });
}
finish();
