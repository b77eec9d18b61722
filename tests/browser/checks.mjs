// What all browser tests share: a Chromium that asks nothing of the network, waits of ten minutes (enough for a busy
// machine, and the error then names what never came), and facts that are counted.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const flags = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync"];

export async function launch(profile) {
  const browser = await chromium.launchPersistentContext(profile,
    { executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args: flags, timeout: 0 });
  browser.setDefaultTimeout(600_000);
  return browser;
}

let checks = 0, failures = 0;
export function check(holds, fact) {
  ++checks;
  if (holds) return;
  ++failures;
  console.error("FAILED: " + fact);
}

// Presses a button that starts work. Where the page asks because of what the work costs, which on a busy machine it does
// of short work too, the answer is to start.
export async function startHoweverLong(page, form, button = `#${form}-form button[type=submit]`) {
  await page.click(button);
  await page.waitForFunction((id) => /takes? (about|at least) .* on this machine\.$|could not be estimated/.test(document.querySelector(id).textContent), `#${form}-cost-words`);
  if (await page.$(`#${form}-cost:not([hidden])`)) await page.click(`#${form}-anyway`);
}

// What a person did to a figure has been drawn, also on a busy machine: pages draw in the next frame.
export async function settled(page) {
  await page.waitForTimeout(300);
  await page.evaluate(async () => {
    for (let frame = 0; frame < 2; ++frame) await new Promise((drawn) => requestAnimationFrame(drawn));
    for (const figure of document.querySelectorAll("figure")) await figure.view?.runAsync();
  });
}

// No serious or critical finding of axe-core, with all folded parts opened. The devtools run it, so that the page's own
// policy stays in force.
const axe_source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
export async function accessible(page, name) {
  await page.evaluate(axe_source);
  const found = await page.evaluate(async () => {
    const { violations } = await globalThis.axe.run(document, { resultTypes: ["violations"] });
    return violations.filter((each) => ["serious", "critical"].includes(each.impact))
      .flatMap((each) => each.nodes.slice(0, 3).map((node) => `${each.id}: ${node.target.join(" ")} ${node.any[0]?.message ?? each.help}`));
  });
  check(found.length === 0, `${name}: axe-core finds nothing serious:\n    ${found.join("\n    ")}`);
}

// Tells how many facts held, and ends the program with it.
export function finish() {
  console.log(`${checks - failures} passed, ${failures} failed`);
  process.exit(failures === 0 ? 0 : 1);
}
