// What tests of the page of `skein designer` share: NAME_test.mjs SKEIN SOURCES.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

export const [skein, sources] = process.argv.slice(-2);
export const token = "0123456789abcdef0123";
const patience = 60_000; // that only a broken program exhausts
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core"), "utf8");

/** Where tests leave what they write. */
export const folder = mkdtempSync(join(tmpdir(), "skein-page-"));
/** Processes that end with the test. @type {Set<import("node:child_process").ChildProcess>} */
const running = new Set();
/** What went wrong in pages. @type {string[]} */
export const complaints = [];

export function run(...words) {
  const env = { ...process.env, SKEIN_DESIGNER_TOKEN: token, XDG_STATE_HOME: join(folder, "state") };
  const child = spawn(skein, words, { env, stdio: ["ignore", "pipe", "inherit"], cwd: folder });
  running.add(child);
  child.ended = new Promise((resolve) => child.on("exit", (code, signal) => {
    running.delete(child);
    resolve(code ?? signal);
  }));
  child.stdout.on("data", (text) => { child.said = (child.said ?? "") + text; });
  return child;
}

/** A designer with the `url` of its page. */
export async function runDesigner(...words) {
  const child = run("designer", ...words, "--no-browser", ...(words.includes("--port") ? [] : ["--port", "0"]));
  await until(() => child.said?.includes("http://"));
  child.url = child.said.match(/http:\S+/)[0];
  return child;
}

export async function until(holds) {
  const end = Date.now() + patience;
  while (!(await holds())) {
    assert(Date.now() < end, `not in time: ${holds}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

export const openBrowser = () => chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });

export async function openPage(browser, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 }, ...options });
  page.on("pageerror", (error) => complaints.push(error.stack ?? error.message));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  return page;
}

/** That those who cannot see, or not well, find all. */
export async function demandAccessible(page) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] }));
  assert.deepEqual(found.violations.map((each) => `${each.id}: ${each.nodes[0].html}: ${each.nodes[0].failureSummary}`), []);
}

export async function endAll() {
  const left = [...running];
  for (const child of left) child.kill("SIGTERM");
  await Promise.all(left.map((child) => child.ended));
  rmSync(folder, { recursive: true, force: true });
}
