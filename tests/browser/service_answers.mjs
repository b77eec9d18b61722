// Questions beside studies: place, sensitivity and estimate, started on the front page and answered on pages of their own.
import { join } from "node:path";
import { accessible, check, settled, startHoweverLong } from "./checks.mjs";

const text = (page, selector) => page.$eval(selector, (each) => each.textContent);

async function openAnswer(page, folder, open, name) {
  await page.waitForSelector('#job-table tr[data-state="done"] a[href^="/jobs/"]');
  const answer = await open(await page.$eval('#job-table a[href^="/jobs/"]', (link) => link.href));
  await answer.waitForSelector("html[data-drawn=yes]");
  if (name !== "estimate") check((await answer.$$("main figure[data-figure] svg")).length > 0, `${name}: the answer has figures`);
  for (const [width, dark] of [[1280, false], [1280, true], [390, true], [390, false]]) {
    await answer.setViewportSize({ width, height: 900 });
    await answer.emulateMedia({ colorScheme: dark ? "dark" : "light" });
    await answer.waitForTimeout(400);
    await answer.waitForFunction(() => document.documentElement.dataset.drawn === "yes");
    const cut = await answer.$$eval("main figure .chart", (all) => all.filter((each) => each.scrollWidth > each.clientWidth).map((each) => each.closest("figure").id));
    check(cut.length === 0, `${name}, ${width} px: no chart is cut off: ${cut}`);
    check(await answer.evaluate(() => document.documentElement.scrollWidth <= document.documentElement.clientWidth), `${name}, ${width} px: no horizontal scroll`);
    await accessible(answer, `${name} ${width} px ${dark ? "dark" : "light"}`);
    await answer.screenshot({ path: join(folder, `service_${name}_${width}${dark ? "_dark" : ""}.png`), fullPage: true });
  }
  await answer.setViewportSize({ width: 1280, height: 900 });
  return answer;
}

const jobs = (page) => page.$$eval("#job-table tbody tr", (all) => all.length);

export async function askQuestions(page, folder, open) {
  for (const command of ["place", "sensitivity", "estimate"]) {
    const before = await jobs(page);
    await page.selectOption("#question", command);
    await page.selectOption("#config-name", "quick.toml");
    await page.waitForFunction(() => document.querySelector("#config-text").value.includes("repetitions"));
    await startHoweverLong(page, "start");
    await page.waitForFunction((count) => document.querySelectorAll("#job-table tbody tr").length > count, before);
    await page.waitForFunction(() => document.querySelector("#job-table tbody tr").dataset.state === "done");
    check((await text(page, "#job-table tbody tr")).includes(command + " quick"), `${command} is in the queue`);
    await (await openAnswer(page, folder, open, command)).close();
  }
  await page.selectOption("#question", "study");
}

// What is wrong is told while it is written, once for each problem, beside the button.
export async function seeProblems(page, folder) {
  await page.fill("#config-text", 'repetitions = -1\nnoize = 3\n');
  await page.waitForFunction(() => document.querySelectorAll("#start-problem li").length >= 2);
  const problems = await text(page, "#start-problem");
  check(/repetitions/.test(problems) && /noize/.test(problems), "problems are told before the start: " + problems);
  const gap = await page.evaluate(() => document.querySelector("#start-problem").getBoundingClientRect().top - document.querySelector("#start-form button[type=submit]").getBoundingClientRect().bottom);
  check(Math.abs(gap) < 60, `they stand beside the button (${gap} px)`);
  await page.locator("#start").screenshot({ path: join(folder, "service_problems.png") });
  await page.selectOption("#config-name", "quick.toml");
  await page.waitForFunction(() => document.querySelectorAll("#start-problem li").length === 0);
}

export async function estimateTension(page, folder, open, log) {
  await page.setInputFiles("#log", log);
  await page.setInputFiles("#sidecar", log.replace(/csv$/, "json"));
  const before = await jobs(page);
  await startHoweverLong(page, "upload", "#upload-form button[value=estimate]");
  await page.waitForFunction((count) => document.querySelectorAll("#job-table tbody tr").length > count, before);
  await page.waitForFunction(() => document.querySelector("#job-table tbody tr").dataset.state === "done");
  const answer = await openAnswer(page, folder, open, "tension");
  const figure = "#figure-along-1-A";
  check((await answer.$$(`${figure} .chart svg .mark-rect path`)).length > 1000, "the tension is drawn along the cable");
  // By mouse: a part of the time is marked in the loop.
  const marked = () => answer.$$eval(`${figure} .chart svg .mark-symbol path`, (all) => {
    const colour = getComputedStyle(document.documentElement).getPropertyValue("--sensor").trim();
    return all.filter((each) => each.getAttribute("fill") === colour).length;
  });
  check(await marked() === 0, "nothing is marked at first");
  const svg = await (await answer.$(`${figure} .chart svg`)).boundingBox();
  await answer.mouse.move(svg.x + 200, svg.y + 14);
  await answer.mouse.down();
  await answer.mouse.move(svg.x + 400, svg.y + 122, { steps: 8 });
  await answer.mouse.up();
  await settled(answer);
  const of_both = await marked();
  check(of_both > 20 && of_both % 2 === 0, `a brush over the time marks the same moments in the loop (${of_both})`);
  await answer.locator(figure).screenshot({ path: join(folder, "service_tension_brushed.png") });
  // By keyboard: the cable is played, and a moment chosen.
  await answer.focus(`${figure} .player input`);
  await answer.keyboard.press("End");
  check(/^5\.\d\d s: .* N at the load/.test(await text(answer, `${figure} .player output`)), "a key chooses a moment: " + await text(answer, `${figure} .player output`));
  const first = await answer.$eval(`${figure} .player .curve`, (curve) => curve.getAttribute("points"));
  await answer.click(`${figure} .player button`);
  await answer.waitForFunction(([where, old]) => document.querySelector(where).getAttribute("points") !== old && document.querySelector(where).getAttribute("points") !== "", [`${figure} .player .curve`, first]);
  await answer.waitForTimeout(1500);
  await answer.click(`${figure} .player button`);
  check(!/^0\.00 s/.test(await text(answer, `${figure} .player output`)), "the cable is played");
  await answer.locator(figure).screenshot({ path: join(folder, "service_tension_played.png") });
  return answer;
}
