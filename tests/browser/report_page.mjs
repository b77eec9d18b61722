// Opens report pages in headless Chromium and looks at what a reader would see.
// usage: [FEW_VIEWS=1] node report_page.mjs SCREENSHOT_FOLDER PAGE.html...
import { mkdirSync, mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { accessible, check, finish, launch } from "./checks.mjs";

const [folder, ...pages] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const profile = mkdtempSync(join(tmpdir(), "capstan-browser-"));
const largest_page_bytes = 3e6;
const all_views = [{ width: 1280, dark: false }, { width: 1280, dark: true }, { width: 700, dark: false }, { width: 390, dark: true }];
const few_views = [{ width: 1280, dark: false }, { width: 390, dark: true }];
// Pages of one kind follow the same rules of style, so that the first is looked at in all views.
const viewsOf = (file) => process.env.FEW_VIEWS || file !== pages[0] ? few_views : all_views;

async function open(browser, file, { width, dark }) {
  const page = await browser.newPage();
  const requests = [], complaints = [];
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => {
    console.error(`${basename(file)}: ${error}`);  // now, for what waits for a page that threw waits until the test's limit
    complaints.push(String(error));
  });
  await page.emulateMedia({ colorScheme: dark ? "dark" : "light" });
  await page.setViewportSize({ width, height: 900 });
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForSelector("html[data-drawn=yes]");
  return { page, requests, complaints };
}

const drawnFigures = (page) => page.$$eval("figure[data-figure]", (figures) => figures
  .filter((figure) => !figure.closest("[hidden]"))
  .map((figure) => ({
    id: figure.id,
    drawn: [...figure.querySelectorAll(".chart svg .mark-line path")].reduce((sum, path) => sum + path.getAttribute("d").length, 0),
    marks: figure.querySelectorAll(".chart svg .mark-symbol path, .chart svg .mark-rect path, .chart svg .mark-line path").length,
    axes: figure.querySelectorAll(".chart svg .role-axis-title").length,
    caption: figure.querySelector("figcaption").textContent.length,
    label: figure.querySelector(".chart [role=graphics-document]")?.getAttribute("aria-label") ?? "",
    overflow: figure.querySelector(".chart").scrollWidth - figure.querySelector(".chart").clientWidth,
    grown: figure.querySelector(".chart").clientHeight - parseInt(figure.querySelector(".chart").style.minHeight),
    broken: /NaN|undefined|\[object/.test(figure.querySelector(".chart svg").outerHTML),
  })));

async function look(browser, file, view) {
  const name = `${basename(file, ".html")} ${view.width} px ${view.dark ? "dark" : "light"}`;
  const { page, requests, complaints } = await open(browser, file, view);
  check(complaints.length === 0, `${name}: the console is silent: ${complaints.slice(0, 3).join(" | ")}`);
  check(requests.length === 1, `${name}: nothing but the file is asked for: ${requests.join(" ")}`);
  check((await page.title()).length > 10 && (await page.$eval("h1", (h) => h.textContent.length)) > 3, `${name}: has a title`);

  const figures = await drawnFigures(page);
  check(figures.length >= (basename(file) === "comparison.html" ? 1 : 2), `${name}: has figures`);
  for (const figure of figures) {
    check(figure.marks > 3 || figure.drawn > 500, `${name}: ${figure.id} has marks`);
    check(figure.axes > 0, `${name}: ${figure.id} names its axes`);
    check(figure.caption > 40 && figure.label.length > 40, `${name}: ${figure.id} is described in words`);
    check(!figure.broken, `${name}: ${figure.id} draws only numbers`);
    check(figure.overflow <= 0, `${name}: ${figure.id} fits (${figure.overflow} px too wide)`);
    if (view.width >= 700) check(figure.grown <= 0, `${name}: ${figure.id} stays in the room kept for it (${figure.grown} px more)`);
  }
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  check(overflow <= 0, `${name}: no horizontal scroll (${overflow} px)`);

  const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).map(Number));
  const bright = ground.reduce((a, b) => a + b) / 3 > 128;
  check(bright !== view.dark, `${name}: the ground suits the theme`);
  const letters = await page.$eval(".chart svg .role-axis-title text", (text) => text.getAttribute("fill"));
  check(await page.evaluate(([colour, dark]) => {
    const box = document.createElement("i");
    box.style.color = colour;
    document.body.append(box);
    const parts = getComputedStyle(box).color.match(/\d+/g).slice(0, 3).map(Number);
    box.remove();
    return (parts.reduce((a, b) => a + b) / 3 > 128) === dark;
  }, [letters, view.dark]), `${name}: the letters in figures suit the theme`);

  await accessible(page, name);
  await page.screenshot({ path: join(folder, name.replaceAll(" ", "_") + ".png"), fullPage: true });
  return { page, complaints };
}

// Chromium silently drops what a page saves after its tenth file within a second, which no person reaches and a test does.
const saves_at_once = 9, pause_ms = 1100, saves_ms = [];
async function saved(page, action) {
  const wait_ms = (saves_ms.at(-saves_at_once) ?? -pause_ms) + pause_ms - performance.now();
  if (wait_ms > 0) await page.waitForTimeout(wait_ms);
  saves_ms.push(performance.now());
  const [download] = await Promise.all([page.waitForEvent("download"), action()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

// Every figure can be taken along: as SVG, its rows as CSV, and as PNG, which is made of the SVG and tried once a page.
async function saveEveryFigure(page, name) {
  for (const [index, { id }] of (await drawnFigures(page)).entries()) {
    const button = (words) => page.locator(`#${id} .save button`, { hasText: words });
    const svg = await saved(page, () => button("SVG").click());
    check(svg.name === id + ".svg" && /^<svg[^>]* xmlns=/.test(svg.bytes) && /<path/.test(svg.bytes), `${name}: ${id} can be saved as SVG`);
    if (index === 0) {
      const png = await saved(page, () => button("PNG").click());
      check(png.name === id + ".png" && png.bytes.readUInt32BE(0) === 0x89504e47 && png.bytes.readUInt32BE(16) > 400, `${name}: ${id} can be saved as PNG`);
    }
    const tables = await button("CSV").count();
    check(tables > 0, `${name}: ${id} has data to save`);
    for (let k = 0; k < tables; ++k) {
      const csv = await saved(page, () => button("CSV").nth(k).click());
      const lines = csv.bytes.toString().trimEnd().split("\r\n");
      const width = lines[0].split(",").length;
      check(csv.name.startsWith(id + "-") && csv.name.endsWith(".csv") && lines.length > 1 && width > 1 && !/undefined|\[object/.test(csv.bytes),
        `${name}: the data of ${id} can be saved (${lines.length - 1} rows)`);
    }
  }
}

// What a screen reader goes by.
async function readAloud(page, name) {
  const facts = await page.evaluate(() => {
    const seen = (each) => !each.closest("[hidden], details:not([open]) > :not(summary)");
    const named = (each) => (each.getAttribute("aria-label") ?? "") + (each.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => document.getElementById(id)?.textContent ?? "").join("") + each.textContent;
    const levels = [...document.querySelectorAll("h1, h2, h3, h4")].map((each) => Number(each.tagName[1]));
    return {
      language: document.documentElement.lang,
      titles: document.querySelectorAll("h1").length,
      skipped: levels.filter((level, k) => k > 0 && level > levels[k - 1] + 1).length,
      unnamed: [...document.querySelectorAll("section, nav, button, a, input, summary, [role=group], [role=region], [role=img]")].filter((each) => seen(each) && (each.labels?.[0] ? named(each.labels[0]) : named(each)).trim() === "").map((each) => each.outerHTML.slice(0, 80)),
      headless: [...document.querySelectorAll("table")].filter((table) => table.querySelector("th:not([scope])") || !table.querySelector("th[scope=col]")).length,
      pictures: [...document.querySelectorAll("svg")].filter((svg) => !svg.closest("[role], [aria-hidden=true]") && !svg.querySelector("[role]")).length,
      doubles: (() => { const ids = [...document.querySelectorAll("[id]")].map((each) => each.id); return ids.length - new Set(ids).size; })(),
      landmarks: ["header", "nav", "main", "footer"].filter((each) => !document.querySelector(each)),
    };
  });
  check(facts.language === "en" && facts.titles === 1 && facts.skipped === 0, `${name}: headings make an outline: ${JSON.stringify(facts)}`);
  check(facts.unnamed.length === 0, `${name}: whatever can be reached has a name: ${facts.unnamed.join(" ")}`);
  check(facts.headless === 0, `${name}: tables have heads`);
  check(facts.pictures === 0, `${name}: every picture says what it is`);
  check(facts.doubles === 0, `${name}: no id is used twice`);
  check(facts.landmarks.length === 0, `${name}: has landmarks`);
}

// By keyboard alone: past the navigation, on to a figure, and its file saved.
async function useTheKeyboard(page, name) {
  await page.evaluate(() => { document.activeElement?.blur(); scrollTo(0, 0); });
  await page.keyboard.press("Tab");
  check(await page.evaluate(() => document.activeElement.className) === "skip", `${name}: the first key leads past the navigation`);
  await page.keyboard.press("Enter");
  check(await page.evaluate(() => document.activeElement.id) === "content", `${name}: and on to the content`);
  let reached = "";
  for (let presses = 0; presses < 60 && reached !== "SVG"; ++presses) {
    await page.keyboard.press("Tab");
    reached = await page.evaluate(() => document.activeElement.matches(".save button") ? document.activeElement.textContent : "");
  }
  check(reached === "SVG", `${name}: the keyboard reaches a figure`);
  check(await page.evaluate(() => getComputedStyle(document.activeElement).outlineStyle) !== "none", `${name}: and shows where it is`);
  const svg = await saved(page, () => page.keyboard.press("Enter"));
  check(svg.name.endsWith(".svg"), `${name}: and saves it`);
}

// On paper, whatever the screen's theme is: dark on white, in the width of a sheet, no figure missing, no buttons.
async function print(page, name, screens) {
  const bright = (colour) => colour.match(/[\d.]+/g).slice(0, 3).reduce((sum, part) => sum + Number(part) / 3, 0);
  for (const colorScheme of screens) {
    await page.emulateMedia({ colorScheme });
    await page.evaluate(() => {  // after the page's own preparations
      addEventListener("beforeprint", () => {
        const figures = [...document.querySelectorAll("figure[data-figure]:not(.empty)")].filter((each) => !each.closest("[hidden]"));
        const colour = (selector, property) => getComputedStyle(document.querySelector(selector))[property];
        window.printed = {
          ground: colour("body", "backgroundColor"), letters: colour("h1", "color"), axes: colour(".chart svg .role-axis-title text", "fill"),
          grounds: figures.map((each) => getComputedStyle(each.querySelector(".chart svg")).backgroundColor),
          missing: figures.filter((each) => !each.querySelector(".chart svg")).map((each) => each.id),
          wide: figures.filter((each) => each.querySelector(".chart svg").getBoundingClientRect().width > 690).map((each) => each.id),
        };
      }, { once: true });
    });
    await page.pdf({ path: join(folder, `${name}_print_${colorScheme}.pdf`), format: "A4", margin: { top: "12mm", bottom: "12mm", left: "12mm", right: "12mm" } });
    const facts = await page.evaluate(() => window.printed);
    check(bright(facts.ground) > 250 && bright(facts.letters) < 40 && bright(facts.axes) < 40 &&
      facts.grounds.every((each) => /, 0\)$/.test(each) || bright(each) > 250), `${name}: prints dark on white from a ${colorScheme} screen: ${JSON.stringify(facts)}`);
    check(facts.missing.length === 0 && facts.wide.length === 0, `${name}: prints every figure in the width of a sheet: ${facts.missing} ${facts.wide}`);
    await page.emulateMedia({ media: "print" });
    check(await page.evaluate(() => [...document.querySelectorAll("button, nav, details.data")].every((each) => each.getClientRects().length === 0)), `${name}: prints no buttons`);
    await page.emulateMedia({ media: null });
    await page.waitForSelector("html[data-drawn=yes]:not([data-paper])");
  }
  await page.emulateMedia({ colorScheme: "light" });
  await page.waitForSelector("html[data-drawn=yes]");
}

const kinds = new Set();  // of pages; what pages of one kind share is tried once
async function useThePage(page, name) {
  const kind = await page.textContent(".kind");
  const first_of_its_kind = !kinds.has(kind);
  kinds.add(kind);
  await readAloud(page, name);
  if (first_of_its_kind) {
    await useTheKeyboard(page, name);
    await saveEveryFigure(page, name);
  }
  const figure = "#" + await page.$eval("main > section:not(#recommendation) figure", (first) => first.id);
  await page.click(figure + " details.data summary");
  await page.waitForSelector(figure + " .data-rows tbody tr");
  const rows = await saved(page, () => page.click(figure + " .data-rows a"));
  check(rows.name.endsWith(".csv"), `${name}: the data of a figure can be saved`);

  const radios = await page.$$('input[name="noise"]');
  if (radios.length > 1) {
    const before = await page.$eval("#figure-error_by_count-mass svg", (svg) => svg.outerHTML);
    await page.focus('input[name="noise"]:checked');
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction((old) => document.documentElement.dataset.drawn === "yes" && document.querySelector("#figure-error_by_count-mass svg").outerHTML !== old, before);
    check((await page.$$(".advice:not([hidden])")).length > 0, `${name}: another noise level has its own recommendations`);
  }
  // A dark screen is the harder case; that a light one prints the same is seen once.
  if (first_of_its_kind) await print(page, name, kinds.size === 1 ? ["light", "dark"] : ["dark"]);
}

let browser;
try {
  browser = await launch(profile);
  for (const file of pages) {
    check(statSync(file).size < largest_page_bytes, `${file}: is below 3 MB`);
    for (const view of viewsOf(file)) {
      const { page, complaints } = await look(browser, file, view);
      const before = complaints.length;
      if (view.width === 1280 && !view.dark) await useThePage(page, basename(file, ".html"));
      check(complaints.length === before, `${file}: the console stays silent in use: ${complaints.slice(before, before + 3).join(" | ")}`);
      await page.close();
    }
  }
} finally {
  await browser?.close();
  rmSync(profile, { recursive: true, force: true });
}
finish();
