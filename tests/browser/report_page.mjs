// Opens report pages in headless Chromium and looks at what a reader would see.
// usage: [FEW_VIEWS=1] node report_page.mjs SCREENSHOT_FOLDER PAGE.html...
import { mkdirSync, mkdtempSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [folder, ...pages] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const profile = mkdtempSync(join(tmpdir(), "capstan-browser-"));
const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];
const largest_page_bytes = 3e6;
const all_views = [{ width: 1280, dark: false }, { width: 1280, dark: true }, { width: 700, dark: false }];
const few_views = [{ width: 1280, dark: false }, { width: 700, dark: true }];
const views = process.env.FEW_VIEWS ? few_views : all_views;

let checks = 0, failures = 0;
function check(holds, fact) {
  ++checks;
  if (holds) return;
  ++failures;
  console.error("FAILED: " + fact);
}

async function open(browser, file, { width, dark }) {
  const page = await browser.newPage();
  const requests = [], complaints = [];
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.emulateMedia({ colorScheme: dark ? "dark" : "light" });
  await page.setViewportSize({ width, height: 900 });
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForSelector("html[data-drawn=yes]", { timeout: 60000 });
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
    if (view.width >= 1280) check(figure.overflow <= 0, `${name}: ${figure.id} fits (${figure.overflow} px too wide)`);
    check(figure.grown <= 0, `${name}: ${figure.id} stays in the room kept for it (${figure.grown} px more)`);
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

  await page.screenshot({ path: join(folder, name.replaceAll(" ", "_") + ".png"), fullPage: true });
  return page;
}

async function useThePage(page, name) {
  const figure = "#" + await page.$eval("main > section:not(#recommendation) figure", (first) => first.id);
  await page.click(figure + " details.data summary");
  await page.waitForSelector(figure + " .data-rows tbody tr");
  const [saved] = await Promise.all([page.waitForEvent("download"), page.click(figure + " .data-rows a")]);
  check(saved.suggestedFilename().endsWith(".csv"), `${name}: the data of a figure can be saved`);

  const radios = await page.$$('input[name="noise"]');
  if (radios.length > 1) {
    const before = await page.$eval("#figure-error_by_count-mass svg", (svg) => svg.outerHTML);
    await page.focus('input[name="noise"]:checked');
    await page.keyboard.press("ArrowRight");
    await page.waitForSelector("html[data-drawn=yes]");
    await page.waitForFunction((old) => document.querySelector("#figure-error_by_count-mass svg").outerHTML !== old, before);
    check((await page.$$(".advice:not([hidden])")).length > 0, `${name}: another noise level has its own recommendations`);
  }
}

let browser;
try {
  browser = await chromium.launchPersistentContext(profile, { executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: flags });
  for (const file of pages) {
    check(statSync(file).size < largest_page_bytes, `${file}: is below 3 MB`);
    for (const view of views) {
      const page = await look(browser, file, view);
      if (view.width === 1280 && !view.dark) await useThePage(page, basename(file));
      await page.close();
    }
  }
} finally {
  await browser?.close();
  rmSync(profile, { recursive: true, force: true });
}
console.log(`${checks - failures} passed, ${failures} failed`);
process.exit(failures === 0 ? 0 : 1);
