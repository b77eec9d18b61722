// Samples marked on the page of a diagnosis: by mouse, by finger and by keyboard, in curves, loops and the map of the gap.
import { join } from "node:path";
import { check, settled } from "./checks.mjs";

const words = (page) => page.$eval("#figure-gap_map .brush-keys output", (each) => each.textContent);
// What each figure draws of the marked samples.
const dots = (page, figure) => page.$eval(figure, (each) => each.view.data("marked").filter((row) => row.series === "measured").length);
const marked_s = (page, figure) => page.$eval(figure, (each) => each.view.data("marked").reduce((sum, span) => sum + span.to_s - span.from_s, 0));
const fractions = (page) => page.$eval("#figure-gap_map", (each) => Object.fromEntries(each.view.data("marked").map((row) => [row.part, row.fraction_of_marked])));
// The first panel of a figure in the middle of the window: a chart may be higher than that, and its panel may stand below the page's
// fixed heading.
const panel = async (page, figure) => {
  const rows = `${figure} .chart svg .role-scope.cell > g > .background`, whole = `${figure} .chart svg .role-frame.root > g > .background`;
  const first = await page.$(rows) ?? await page.$(whole);
  await first.evaluate((each) => each.scrollIntoView({ block: "center", behavior: "instant" }));
  await settled(page);
  // On a busy machine the charts above may still be drawn, and the panel moves.
  for (let before = null, box = await first.boundingBox(); ; before = box, box = await first.boundingBox()) {
    if (before && before.x === box.x && before.y === box.y) return box;
    await settled(page);
  }
};

async function dragged(page, figure, [left, top], [right, bottom]) {
  const box = await panel(page, figure);
  await page.mouse.move(box.x + left * box.width, box.y + top * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + right * box.width, box.y + bottom * box.height, { steps: 6 });
  await page.mouse.up();
  await settled(page);
}

async function byMouse(page, name, run) {
  const curves = `#figure-channels-${run}`, loop = `#figure-loop-${run}`;
  await dragged(page, curves, [0.3, 0.3], [0.5, 0.6]);
  const range_s = await marked_s(page, curves), of_time = await dots(page, loop);
  check(range_s > 0 && of_time > 10, `${name}: a range of time (${range_s} s) marks ${of_time} samples of the loop`);
  check(await marked_s(page, `#figure-residual-${run}`) === range_s, `${name}: and the same range of the residual`);
  const parts = await fractions(page);
  check(parts["run: " + run] === 1, `${name}: all of them are of run ${run}: ${JSON.stringify(parts)}`);
  const regimes = Object.entries(parts).filter(([part]) => part.startsWith("regime: ")).reduce((sum, [, fraction]) => sum + fraction, 0);
  check(Math.abs(regimes - 1) < 1e-9, `${name}: each marked sample is in one regime (${regimes})`);
  check(new RegExp(`^Marked: run ${run}, [0-9.]+ s to [0-9.]+ s$`).test(await words(page)), `${name}: the range is told: ${await words(page)}`);

  await dragged(page, loop, [0, 0], [1, 1]);
  const all = await dots(page, loop);
  await dragged(page, loop, [0, 0], [0.5, 1]);
  const half = await dots(page, loop);
  check(all > half && half > 0, `${name}: a half of the loop holds ${half} of ${all} samples`);
  check(await marked_s(page, curves) > 0, `${name}: and marks the times at which it was recorded`);
  const box = await panel(page, loop);
  await page.mouse.click(box.x + 5, box.y + 5);
  await settled(page);
  check(await dots(page, loop) === 0 && await words(page) === "", `${name}: a click marks nothing again`);
}

async function byPart(page, name, run) {
  const names = await page.$$eval("#figure-gap_map select option", (all) => all.map((each) => each.value));
  const box = await panel(page, "#figure-gap_map"), regime = names.findIndex((each) => each === "regime: mass") - 1;
  await page.mouse.click(box.x + 20, box.y + box.height * (regime + 0.5) / (names.length - 1));
  await settled(page);
  check(await words(page) === "Marked: regime: mass", `${name}: a click on a bar marks its samples: ${await words(page)}`);
  check(await marked_s(page, `#figure-channels-${run}`) > 0 && await dots(page, `#figure-loop-${run}`) > 0, `${name}: in the curves and in the loop`);
  check(Math.abs((await fractions(page))["regime: mass"] - 1) < 1e-9, `${name}: all of them are of this part`);
  await page.focus("#figure-gap_map select");
  await page.keyboard.type("channel");
  await settled(page);
  check(/^Marked: channel: /.test(await words(page)), `${name}: a key chooses a part: ${await words(page)}`);
  const faded = await page.$$eval(`#figure-channels-${run} .chart svg .mark-line path`, (all) => all.filter((each) => Number(each.getAttribute("opacity") ?? 1) < 1).length);
  check(faded > 0, `${name}: the curves of the other channels fade (${faded})`);
  await page.focus("#figure-gap_map .brush-keys button");
  await page.keyboard.press("Enter");
  await settled(page);
  check(await words(page) === "", `${name}: a key marks nothing again`);
}

async function byKeyboard(page, name, run) {
  const [from, to] = [`#figure-loop-${run} .brush-keys input >> nth=0`, `#figure-loop-${run} .brush-keys input >> nth=1`];
  await page.locator(to).focus();
  for (let k = 0; k < 3; ++k) await page.keyboard.press("PageDown");
  await settled(page);
  const most = await dots(page, `#figure-loop-${run}`);
  await page.locator(from).focus();
  await page.keyboard.press("PageUp");
  await settled(page);
  const fewer = await dots(page, `#figure-loop-${run}`);
  check(most > fewer && fewer > 0, `${name}: keys mark a range of the loop: ${most}, then ${fewer} samples`);
  check(/^[0-9.]+ s$/.test(await page.locator(from).getAttribute("aria-valuetext")), `${name}: a slider tells its time`);
}

async function byFinger(page, name, run) {
  const figure = `#figure-channels-${run}`, devtools = await page.context().newCDPSession(page);
  await devtools.send("Emulation.setTouchEmulationEnabled", { enabled: true });
  const box = await panel(page, figure);
  const touchAt = (right, down) => devtools.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: [{ x: box.x + right * box.width, y: box.y + down * box.height }] });
  const touch = (type, part) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints: part === null ? [] : [{ x: box.x + part * box.width, y: box.y + box.height / 2 }] });
  await touch("touchStart", 0.2);
  for (let step = 1; step <= 8; ++step) await touch("touchMove", 0.2 + 0.05 * step);
  await touch("touchEnd", null);
  await settled(page);
  const samples = await dots(page, `#figure-loop-${run}`);
  check(samples > 10, `${name}: a finger marks a range of time, and ${samples} samples of the loop`);
  const told = await words(page);
  await touch("touchStart", 0.2);
  for (let step = 1; step <= 4; ++step) await touchAt(0.2, 0.5 - 0.1 * step);
  await touch("touchEnd", null);
  await settled(page);
  check(await words(page) === told, `${name}: a finger that moves up scrolls and marks nothing`);
  check(await page.$eval(figure + " .chart", (each) => getComputedStyle(each).touchAction) === "pan-y", `${name}: a finger scrolls the page there`);
  await devtools.send("Emulation.setTouchEmulationEnabled", { enabled: false });
}

// On the page of a diagnosis that is open. The width and the theme are those of the page.
export async function markSamples(page, name, folder) {
  const run = await page.$eval("[id^=figure-loop-]", (each) => each.dataset.run);
  await byMouse(page, name, run);
  await byPart(page, name, run);
  await byKeyboard(page, name, run);
  await byFinger(page, name, run);
  for (const figure of ["gap_map", `channels-${run}`, `loop-${run}`])
    await page.locator("#figure-" + figure).screenshot({ path: join(folder, `${name.replaceAll(" ", "_")}_marked_${figure}.png`) });
  await page.locator(`#figure-loop-${run} .brush-keys button`).click();
}
