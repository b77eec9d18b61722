// Opens pages of the book in headless Chromium at two widths, light and dark, and looks at what a reader would see.
// usage: node book_pages.mjs BOOK_FOLDER SCREENSHOT_FOLDER
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { accessible, check, finish, launch } from "./checks.mjs";

const [book, folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const profile = mkdtempSync(join(tmpdir(), "capstan-browser-"));
const pages = ["index", "first-hour/place-sensors", "first-hour/log-disagrees", "how-to/studies-in-depth", "gallery/effects",
  "gallery/pulley_friction", "gallery/layout-even", "notebooks/5-study-with-sql-and-pandas", "theory/over-time", "theory/equations",
  "reference/python", "reference/database"];

const all_views = [{ width: 1280, dark: false }, { width: 1280, dark: true }, { width: 390, dark: false }, { width: 390, dark: true }];
const few_views = [all_views[0], all_views[3]];  // the pages share their style

const brightness = (colour) => colour.match(/[\d.]+/g).slice(0, 3).reduce((sum, part) => sum + Number(part), 0) / 3;

async function look(browser, name, { width, dark }) {
  const page = await browser.newPage();
  const asked = [], complaints = [];
  page.on("request", (request) => { if (!/^(data|blob|file):/.test(request.url())) asked.push(request.url()); });
  page.on("console", (message) => { if (message.type() === "error") complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.emulateMedia({ colorScheme: dark ? "dark" : "light" });
  await page.setViewportSize({ width, height: 900 });
  await page.goto(pathToFileURL(resolve(book, `${name}.html`)).href);
  const words = `${name} ${width} px ${dark ? "dark" : "light"}`;
  check(asked.length === 0, `${words}: asks for nothing but files: ${asked.slice(0, 2).join(" ")}`);
  check(complaints.length === 0, `${words}: the console is silent: ${complaints.slice(0, 2).join(" | ")}`);
  const wider = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  check(wider <= 0, `${words}: the page is ${wider} px wider than the window`);
  const colours = await page.evaluate(() => ({
    page: getComputedStyle(document.body).backgroundColor,
    text: getComputedStyle(document.querySelector("h1")).color,
    printed: [...document.querySelectorAll("pre")].slice(0, 5).map((pre) => {
      let behind = pre;  // a transparent element shows what is behind it
      while (behind.parentElement && getComputedStyle(behind).backgroundColor === "rgba(0, 0, 0, 0)") behind = behind.parentElement;
      return { back: getComputedStyle(behind).backgroundColor, ink: getComputedStyle(pre).color };
    }),
  }));
  check(brightness(colours.page) > 127 === !dark && brightness(colours.text) > 127 === dark, `${words}: ${JSON.stringify(colours)}`);
  for (const { back, ink } of colours.printed)
    check(Math.abs(brightness(back) - brightness(ink)) > 60, `${words}: blocks are read: ${ink} on ${back}`);
  const flat = await page.$$eval("figure.drawn svg", (figures) => figures.filter((figure) => figure.getBoundingClientRect().width < 200).length);
  check(flat === 0, `${words}: figures have a size`);
  await page.screenshot({ path: join(folder, `${name.replace("/", "-")}-${width}-${dark ? "dark" : "light"}.png`) });
  await accessible(page, words);
  await page.close();
}

async function search(browser) {
  const page = await browser.newPage();
  await page.goto(pathToFileURL(resolve(book, "search.html")).href + "?q=backlash");
  await page.waitForSelector("#search-results ul.search li a");
  check((await page.$$("#search-results ul.search li a")).length >= 2, "the search finds pages about backlash");
  await page.close();
}

async function toggle(browser) {
  const page = await browser.newPage();
  await page.goto(pathToFileURL(resolve(book, "index.html")).href);
  const themes = new Set();
  for (let click = 0; click < 3; ++click) {
    themes.add(await page.evaluate(() => document.body.dataset.theme));
    await page.click(".content-icon-container .theme-toggle, .theme-toggle-content .theme-toggle");
  }
  check(themes.size === 3, `the button goes through auto, light and dark: ${[...themes].join(" ")}`);
  await page.close();
}

const browser = await launch(profile);
try {
  for (const name of pages)
    for (const view of name === pages[0] ? all_views : few_views) await look(browser, name, view);
  await search(browser);
  await toggle(browser);
} finally {
  await browser.close();
  rmSync(profile, { recursive: true, force: true });
}
finish();
