// Opens a report of very many cells and tells how long that takes. What is judged is the work: only the figures in view
// are drawn before the page can be read, and the rest follow.
// usage: node large_report.mjs SCREENSHOT_FOLDER CELLS PAGE.html
import { mkdirSync, mkdtempSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { check, finish, launch } from "./checks.mjs";

const [folder, cells, file] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const profile = mkdtempSync(join(tmpdir(), "capstan-browser-"));

// Notes, at the moment when the page says that it can be read, which figures are drawn and which are in view.
function watch() {
  window.facts = { order: [] };
  const drawn = (figure) => figure.querySelector(".chart svg") !== null;
  new MutationObserver(() => {
    const figures = [...document.querySelectorAll("figure[data-figure]")].filter((figure) => !figure.closest("[hidden]"));
    for (const figure of figures) if (drawn(figure) && !window.facts.order.includes(figure.id)) window.facts.order.push(figure.id);
    if (window.facts.drawn || document.documentElement.dataset.shown !== "yes") return;
    const in_view = (figure) => { const { top, bottom } = figure.getBoundingClientRect(); return bottom > 0 && top < innerHeight; };
    Object.assign(window.facts, {
      drawn: figures.filter(drawn).map((figure) => figure.id), in_view: figures.filter(in_view).map((figure) => figure.id),
      figures: figures.length, elements: document.querySelectorAll("*").length,
    });
    if (window.jump) figures.at(-1).scrollIntoView({ behavior: "instant" });
    window.facts.after_jump = figures.filter(in_view).map((figure) => figure.id);
  }).observe(document, { subtree: true, childList: true, attributes: true, attributeFilter: ["data-shown"] });
}

async function open(browser, { jump }) {
  const page = await browser.newPage();
  const complaints = [];
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.addInitScript((wish) => { window.jump = wish; }, jump);
  await page.addInitScript(watch);
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForSelector("html[data-drawn=yes]");
  const facts = await page.evaluate(() => ({
    ...window.facts, marks: Object.fromEntries(performance.getEntriesByType("mark").map((mark) => [mark.name, mark.startTime])),
  }));
  check(complaints.length === 0, "the console is silent: " + complaints.slice(0, 3).join(" | "));
  return { page, facts };
}

let browser;
try {
  browser = await launch(profile);
  check(Number(cells) >= 100000, `the study has 100,000 cells: ${cells}`);
  const times_ms = [];
  for (let turn = 0; turn < 3; ++turn) {
    const { page, facts } = await open(browser, { jump: false });
    times_ms.push([facts.marks["figures in view are drawn"], facts.marks["all figures are drawn"]]);
    check(facts.drawn.join() === facts.in_view.join() && facts.drawn.length > 0, `what is drawn first is what is in view: ${facts.drawn} of ${facts.in_view}`);
    check(facts.drawn.length < facts.figures / 3, `the rest waits: ${facts.drawn.length} of ${facts.figures} are drawn first`);
    check(facts.order.length === facts.figures, `all figures are drawn in the end: ${facts.order.length} of ${facts.figures}`);
    check(facts.elements < 25000, `the page is made of few elements when it opens: ${facts.elements}`);
    if (turn === 0) await page.screenshot({ path: join(folder, "large_report.png") });
    await page.close();
  }
  const { page, facts } = await open(browser, { jump: true });
  const next = facts.order[facts.drawn.length];
  check(facts.after_jump.includes(next), `a reader who goes to the end gets the figures there next: ${next} of ${facts.after_jump}`);
  await page.close();

  const best = (which) => Math.round(Math.min(...times_ms.map((pair) => pair[which])));
  const median = (which) => Math.round(times_ms.map((pair) => pair[which]).sort((a, b) => a - b)[1]);
  console.log(`${cells} cells, ${(statSync(file).size / 1e6).toFixed(2)} MB: from navigation to the figures in view ${median(0)} ms ` +
    `(median of three, best ${best(0)} ms), to all ${facts.figures} figures ${median(1)} ms`);
} finally {
  await browser?.close();
  rmSync(profile, { recursive: true, force: true });
}
finish();
