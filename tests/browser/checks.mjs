// What all browser tests share: a Chromium that asks nothing of the network, waits of ten minutes (enough for a busy
// machine, and the error then names what never came), and facts that are counted.
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

// Tells how many facts held, and ends the program with it.
export function finish() {
  console.log(`${checks - failures} passed, ${failures} failed`);
  process.exit(failures === 0 ? 0 : 1);
}
