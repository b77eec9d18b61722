// Sensors placed by hand on a study's page: by click, dragged by mouse and finger, by keyboard, and from a shared link.
import { join } from "node:path";
import { check } from "./checks.mjs";

const placed = (page) => page.$$eval("#hand .place[aria-checked=true]", (all) => all.map((each) => Number(each.dataset.node)));
const text = (page, selector) => page.$eval(selector, (each) => each.textContent);
const answered = (page) => page.$eval("#hand-expected", (each) => Number(each.dataset.answered ?? 0));
// A new answer, and no newer one to come.
const answeredAfter = (page, count) => page.waitForFunction((old) => Number(document.querySelector("#hand-expected").dataset.answered ?? 0) > old && document.querySelector("#hand .hand").ariaBusy === "false", count);

async function middle(page, node) {
  await page.locator("#hand svg.pins").scrollIntoViewIfNeeded();
  const box = await (await page.$(`#hand .place[data-node="${node}"] .pin`)).boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}
// A node that is free, and beyond a sensor where there is one between.
const freeNode = async (page, chosen) => (await page.$$eval("#hand .place[aria-checked=false]", (all) => all.map((each) => Number(each.dataset.node))))
  .find((node) => Math.abs(node - chosen) > 1);

async function byClick(page, folder) {
  const recommended = await text(page, "#hand-expected");
  check(/Expected error \d/.test(recommended), "the recommendation's sensors have an expected error: " + recommended);
  check(/The recommendation here is this layout\.$/.test(await text(page, "#hand .expected + .quiet")), "a recommendation is told as such");
  const count = await answered(page), [chosen] = await placed(page);
  await page.click(`#hand .place[data-node="${chosen}"]`);
  await page.click(`#hand .place[data-node="${await freeNode(page, chosen)}"]`);
  await answeredAfter(page, count);
  check(await text(page, "#hand-expected") !== recommended, "another layout has another error: " + recommended);
  check(/The recommendation here is \d sensors? at .* on the same draws/.test(await text(page, "#hand .expected + .quiet")), "the recommendation stands beside: " + await text(page, "#hand .expected + .quiet"));
  const lines = await page.$$eval("#hand-chart .mark-line path", (all) => all.length);
  check(lines === 2 && await page.$("#hand-chart .mark-area path"), `both are drawn, with the band: ${lines} lines`);
  await page.locator("#hand").screenshot({ path: join(folder, "service_hand.png") });
}

async function byMouse(page) {
  const [from] = await placed(page), to = await freeNode(page, from), count = await answered(page);
  const begin = await middle(page, from), end = await middle(page, to);
  await page.mouse.move(begin.x, begin.y);
  await page.mouse.down();
  await page.mouse.move((begin.x + end.x) / 2, begin.y + 30, { steps: 5 });
  await page.mouse.move(end.x, end.y, { steps: 5 });
  await page.mouse.up();
  await answeredAfter(page, count);
  const now = await placed(page);
  check(now.includes(to) && !now.includes(from), `a sensor is dragged from ${from} to ${to}: ${now}`);
  check(await page.evaluate(() => String(getSelection())) === "", "a drag selects no text");
  await page.mouse.move(end.x, end.y);
  await page.mouse.down();
  await page.mouse.up();
  await page.waitForFunction((node) => document.querySelector(`#hand .place[data-node="${node}"]`).getAttribute("aria-checked") === "false", to);
  await page.click(`#hand .place[data-node="${to}"]`);
}

async function byFinger(page) {
  const devtools = await page.context().newCDPSession(page);
  await devtools.send("Emulation.setTouchEmulationEnabled", { enabled: true });
  const [from] = await placed(page), to = await freeNode(page, from), count = await answered(page);
  const begin = await middle(page, from), end = await middle(page, to);
  const touch = (type, points) => devtools.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await touch("touchStart", [{ x: begin.x + 2, y: begin.y + 4 }]);
  for (let step = 1; step <= 8; ++step) await touch("touchMove", [{ x: begin.x + (end.x - begin.x) * step / 8, y: begin.y + 4 }]);
  await touch("touchEnd", []);
  await answeredAfter(page, count);
  const now = await placed(page);
  check(now.includes(to) && !now.includes(from), `a finger drags a sensor from ${from} to ${to}: ${now}`);
  await devtools.send("Emulation.setTouchEmulationEnabled", { enabled: false });
}

// The sensor in focus goes on to the next free node, past another sensor.
async function byKeyboard(page) {
  const count = await answered(page), last = Math.max(...await placed(page));
  await page.focus(`#hand .place[data-node="${last}"]`);
  await page.keyboard.press("Shift+ArrowLeft");
  await answeredAfter(page, count);
  check(!(await placed(page)).includes(last), "the keyboard moves a sensor");
  const focused = await page.evaluate(() => Number(document.activeElement.dataset.node));
  check((await placed(page)).includes(focused) && focused < last, `the focus goes with it to ${focused}`);
}

async function shared(page, open) {
  const count = await answered(page);
  if (await page.$("#hand-regime option[value=duty_cycle]")) await page.selectOption("#hand-regime", "duty_cycle");
  await page.selectOption("#hand-method", "mean_r");
  await answeredAfter(page, count);
  const link = await page.$eval("#hand-link", (each) => each.value);
  const other = await open(link);
  await other.waitForFunction(() => document.querySelector("#hand-expected")?.dataset.answered > 0);
  check(String(await placed(other)) === String(await placed(page)) && await other.$eval("#hand-method", (each) => each.value) === "mean_r", "a link restores places and method: " + link);
  await page.waitForFunction((words) => document.querySelector("#hand-expected").textContent === words, await text(other, "#hand-expected"));
  const [saved] = await Promise.all([other.waitForEvent("download"), other.click("#hand .save button >> text=CSV")]);
  check(saved.suggestedFilename() === "expected-error.csv", "the errors can be saved");
  await other.close();
}

export async function placeByHand(page, folder, open) {
  await page.waitForFunction(() => document.querySelector("#hand-expected")?.dataset.answered > 0);
  await byClick(page, folder);
  await byMouse(page);
  await byKeyboard(page);
  await byFinger(page);
  await shared(page, open);
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForFunction(() => document.querySelector("#hand svg.pins").viewBox.baseVal.width === 400);
  await page.waitForTimeout(800);
  await byFinger(page);
  const wide = await page.$eval("#hand-chart", (chart) => chart.scrollWidth - chart.clientWidth);
  check(wide <= 0, `the errors by hand fit a telephone (${wide} px too wide)`);
  await page.locator("#hand").screenshot({ path: join(folder, "service_hand_390.png") });
  await page.emulateMedia({ colorScheme: "dark" });
  await page.waitForTimeout(800);
  await page.locator("#hand").screenshot({ path: join(folder, "service_hand_390_dark.png") });
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize({ width: 1280, height: 900 });
}
