// The page of `skein designer` in Chromium, while the reconnaissance mission flies, and over what was recorded of it.
import assert from "node:assert/strict";
import http from "node:http";
import net from "node:net";
import { join } from "node:path";
import { after, before, test } from "node:test";
import WebSocket from "ws";
import { complaints, demandAccessible, endAll, folder, openBrowser, openPage, run, runDesigner, sources, token, until } from "./page_tools.mjs";

const mission = `${sources}/mission_profiles/reconnaissance/reconnaissance.xml`;
const choice = ["--variable", "domain=31", "--variable", "speed_limit=8"];
const navigator = "uav-1/navigator";

let browser, page, designer, port, launched, recorder;

const launch = () => run("launch", mission, "--no-log", ...choice);

async function startDesigner(at) {
  designer = await runDesigner("--watch", "--profile", mission, ...choice.slice(0, 2), "--faults", "--port", String(at));
  port = Number(designer.url.match(/127\.0\.0\.1:(\d+)/)[1]);
}

const stateTime = () => page.evaluate(async () => (await (await fetch("state.json")).json()).time);
/** Until the server has looked again. */
async function newerState() {
  const now = await stateTime();
  await until(async () => (await stateTime()) > now);
}
/** Until the page has drawn. */
const frame = () => page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));

const box = (name) => page.locator(`.box[data-id="${name}"]`);
const readyBoxes = () => page.locator(".box.ready").count();
const pids = () => page.evaluate(async () => (await (await fetch("state.json")).json()).entities.flatMap((entity) => entity.services))
  .then((services) => Object.fromEntries(services.map((each) => [each.csp, each.pid])));

before(async () => {
  browser = await openBrowser();
  page = await openPage(browser);
  await startDesigner(0);
});

after(async () => {
  await browser?.close();
  await endAll();
});

test("before anybody is there, the plan is shown as missing", async () => {
  await page.goto(`http://127.0.0.1:${port}/${token}/`);
  await until(async () => (await page.locator(".box.missing").count()) === 13);
  await until(async () => (await page.locator(".line.missing").count()) > 0);
  await page.getByRole("tab", { name: "Mission" }).click();
  await page.getByText("No launcher of this user flies a mission").waitFor();
});

test("the mission starts, and all thirteen are ready in one view", async () => {
  launched = launch();
  recorder = run("record", "--domain", "31", "--output", join(folder, "flight.mcap"));
  await until(async () => (await readyBoxes()) === 13);
  await page.locator("#fit").click();
  const canvas = await page.locator("#canvas").boundingBox();
  for (const each of await page.locator(".box").all()) {
    const seen = await each.boundingBox();
    assert(seen.x >= canvas.x && seen.y >= canvas.y && seen.x + seen.width <= canvas.x + canvas.width &&
      seen.y + seen.height <= canvas.y + canvas.height, `${await each.textContent()} is not in view`);
    assert(seen.width > 110, "a box is too small to be read");
  }
});

test("lines tell what is called, how often and how long, and topics", async () => {
  await until(async () => (await page.locator(".label.calls").allTextContents()).some((text) => /^INavigator .*(\/s|so far).* ms, p99 /.test(text)));
  assert(await page.locator(".line.values").count() > 10);
  const shared = await page.locator(".line").count();
  await page.locator("#shared").click();
  await until(async () => (await page.locator(".line").count()) > shared);
  await page.locator("#shared").click();
  await page.locator("#values").click();
  await until(async () => (await page.locator(".line.values").count()) === 0);
  await page.locator("#values").click();
});

test("everything is reached by keyboard", async () => {
  const focused = () => page.evaluate(() => document.activeElement?.closest(".box")?.dataset.id);
  await page.locator("#as-table").focus();
  for (let i = 0; i < 3 && !(await focused()); ++i) await page.keyboard.press("Tab");
  const seen = new Set();
  for (const key of ["ArrowDown", "ArrowRight", "ArrowUp", "ArrowLeft"]) {
    for (let i = 0; i < 6; ++i) {
      seen.add(await focused());
      await page.keyboard.press(key);
    }
  }
  assert(seen.size >= 8, `arrow keys reach ${[...seen]}`);
  const name = await focused();
  await page.keyboard.press("Enter");
  await page.getByRole("heading", { name }).waitFor();
  const before = await box(name).boundingBox();
  await page.keyboard.press("Alt+ArrowDown");
  assert((await box(name).boundingBox()).y > before.y);
  const rows = await box(name).locator("li").count();
  await page.keyboard.press(" ");
  await until(async () => (await box(name).locator("li").count()) === 0);
  await page.keyboard.press(" ");
  await until(async () => (await box(name).locator("li").count()) === rows);
  await page.keyboard.press("Escape");
});

test("a box that was moved stays where it is, also for who comes later", async () => {
  const head = box(navigator).locator(".head");
  const from = await head.boundingBox();
  await page.mouse.move(from.x + 20, from.y + 10);
  await page.mouse.down();
  await page.mouse.move(from.x - 60, from.y + 60, { steps: 5 });
  await page.mouse.up();
  const place = () => box(navigator).evaluate((element) => element.style.transform);
  const moved = await place();
  await newerState();
  await newerState();
  assert.equal(await place(), moved);
  await page.reload();
  await until(async () => (await readyBoxes()) === 13);
  assert.equal(await place(), moved);
});

test("systems fold to one box, which has the focus then", async () => {
  await page.locator(".frame button").first().click();
  await until(async () => (await page.locator(".box").count()) === 1);
  await page.keyboard.press(" ");
  await until(async () => (await readyBoxes()) === 13);
});

test("a decision opens with its reasons", async () => {
  await page.getByRole("tab", { name: "Decisions" }).click();
  await page.locator("details").first().waitFor();
  const first = page.locator("details", { hasText: "uav-1/nhp" }).first();
  await first.locator("summary").click();
  assert.match(await first.locator("pre").textContent(), /strategy/);
  await page.getByText(/^\d+ newer; close what is open/).waitFor();
  assert(await page.locator("details[open] pre").isVisible(), "what is read stays");
  await page.locator("details[open] summary").click();
});

test("who cannot see finds nothing missing", async () => {
  for (const [scheme, table] of [["light", false], ["dark", false], ["dark", true], ["light", true]]) {
    await page.emulateMedia({ colorScheme: scheme });
    if ((await page.locator("#tables").isVisible()) !== table) await page.locator("#as-table").click();
    // Decisions, of which there are many, take long: one look at them will do.
    for (const name of table ? ["Mission"] : scheme === "dark" ? ["Details"] : ["Decisions", "Details", "Mission", "Log"]) {
      await page.getByRole("tab", { name }).click();
      await demandAccessible(page);
    }
  }
  await page.locator("table").first().waitFor();
  assert.equal(await page.locator("table").nth(0).locator("tbody tr").count(), 13);
  await page.locator("#as-table").click();
});

test("on a telephone there is no sideways scrolling", async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  assert(await page.evaluate(() => document.documentElement.scrollWidth <= 390));
  assert((await page.locator("#canvas").boundingBox()).height > 300);
  await page.setViewportSize({ width: 1366, height: 768 });
  await page.locator("#fit").click();
});

test("a CSP is killed by keyboard, and its replacement is seen", async () => {
  const pid = (await pids()).AStar;
  await page.getByRole("tab", { name: "Details" }).click();
  await box(navigator).locator(".head").focus();
  await page.keyboard.press("Enter");
  const row = page.locator("#panel li", { hasText: "AStar" }).first();
  await row.getByRole("button", { name: "Kill" }).focus();
  await page.keyboard.press("Enter");
  await row.getByText("Kill AStar?").waitFor();
  await page.keyboard.press("Shift+Tab");
  await page.keyboard.press("Enter");
  await page.getByText("navigator/AStar is killed").waitFor();
  await row.getByText("was restarted once, last ended by signal 9 (Killed)").waitFor();
  await until(async () => ![0, pid].includes((await pids()).AStar));
  await page.getByRole("tab", { name: "Log" }).click();
  await page.locator(".log li", { hasText: "ended by signal 9 (Killed)" }).first().waitFor();
  await page.getByRole("tab", { name: "Details" }).click();
});

test("the server goes and comes back, and the page says so and recovers", async () => {
  designer.kill("SIGKILL");
  await page.locator("#bar", { hasText: "There is no connection to skein designer; this is of" }).waitFor();
  complaints.length = 0;
  await startDesigner(port);
  await page.locator("#bar").waitFor({ state: "hidden" });
  complaints.length = 0; // the attempts between
  await until(async () => (await readyBoxes()) === 13);
});

test("a process that hangs is said to, with what it had, and goes on when it is restarted", async () => {
  await box("uav-1/nhp").locator(".head").click();
  await page.locator("#panel .acts").first().getByRole("button", { name: "Hang" }).click();
  await page.locator("#panel").getByRole("button", { name: "Yes" }).click();
  await page.locator(".words", { hasText: "hangs: its process is stopped" }).waitFor();
  assert.equal(await box("uav-1/nhp").locator("li.csp").count(), 2);
  await page.locator("#panel .acts").first().getByRole("button", { name: "Restart" }).click();
  await page.locator("#panel").getByRole("button", { name: "Yes" }).click();
  await until(async () => (await readyBoxes()) === 13);
});

test("the launcher dies, and the page says what is gone; a new one is found", async () => {
  launched.kill("SIGKILL");
  await until(async () => (await readyBoxes()) === 0);
  await page.getByRole("tab", { name: "Mission" }).click();
  await page.getByText("has ended: its launcher is gone").waitFor();
  launched = launch();
  await until(async () => (await readyBoxes()) === 13);
  await page.getByRole("button", { name: "Stop the mission" }).waitFor();
});

test("a foreign page, another name, another token and a mass of data get nothing", async () => {
  const ask = (options, body) => new Promise((resolve) => {
    const request = http.request({ host: "127.0.0.1", port, path: `/${token}/state.json`, ...options }, (response) => resolve(response.statusCode));
    request.on("error", () => resolve(0));
    request.end(body);
  });
  assert.equal(await ask({}), 200);
  assert.equal(await ask({ path: "/state.json" }), 401);
  assert.equal(await ask({ path: `/${token}x/state.json` }), 401);
  assert.equal(await ask({ path: `/${token}/../../../etc/passwd` }), 404);
  assert.equal(await ask({ headers: { Host: `rebound.example:${port}` } }), 403);
  assert.equal(await ask({ headers: { Origin: "http://rebound.example" } }), 403);
  assert.notEqual(await ask({ method: "POST" }, Buffer.alloc(100 << 20)), 200);
  const socket = (headers) => new Promise((resolve) => {
    const made = new WebSocket(`ws://127.0.0.1:${port}/${token}/socket`, { headers });
    made.on("open", () => resolve(made)).on("error", () => resolve(null));
  });
  assert.equal(await socket({ Origin: "http://rebound.example" }), null);
  const much = await socket({});
  much.on("error", () => undefined);
  much.send("x".repeat(100 << 20));
  await new Promise((resolve) => much.on("close", resolve));
});

test("fifty clients, one that never reads and one that says half a word change nothing for the page", async () => {
  const sockets = Array.from({ length: 50 }, () => new WebSocket(`ws://127.0.0.1:${port}/${token}/socket`));
  await Promise.all(sockets.map((each) => new Promise((resolve) => each.on("message", resolve))));
  const deaf = new WebSocket(`ws://127.0.0.1:${port}/${token}/socket`);
  deaf.on("open", () => deaf.pause());
  const half = net.connect(port, "127.0.0.1", () => half.write(`GET /${token}/ HT`));
  await newerState();
  assert.equal(await readyBoxes(), 13);
  for (const each of [...sockets, deaf]) each.terminate();
  half.destroy();
});

test("the mission is stopped from the page", async () => {
  await page.getByRole("button", { name: "Stop the mission" }).click();
  await page.getByRole("button", { name: "Yes" }).click();
  await page.getByText("the mission is being ended").waitFor();
  assert.equal(await launched.ended, 143);
  await until(async () => (await readyBoxes()) === 0);
});

test("two fingers zoom, and one moves the drawing", async () => {
  const hand = await browser.newContext({ hasTouch: true, viewport: { width: 390, height: 700 } });
  const telephone = await hand.newPage();
  await telephone.goto(`http://127.0.0.1:${port}/${token}/`);
  await telephone.locator(".box").first().waitFor();
  const drawing = () => telephone.locator(".world").evaluate((element) => new DOMMatrix(getComputedStyle(element).transform).toJSON());
  const touch = await hand.newCDPSession(telephone);
  const fingers = (type, ...points) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const before = await drawing();
  await fingers("touchStart", [190, 300], [200, 300]);
  await fingers("touchMove", [150, 300], [240, 300]);
  await fingers("touchMove", [130, 300], [260, 300]);
  await fingers("touchEnd");
  const after = await drawing();
  assert(after.a > 1.5 * before.a, `from ${before.a} to ${after.a}`);
  await fingers("touchStart", [190, 330]);
  await fingers("touchMove", [190, 380]);
  await fingers("touchEnd");
  assert.equal(Math.round((await drawing()).f - after.f), 50);
  await hand.close();
});

test("the recording is replayed on the same page", async () => {
  recorder.kill("SIGINT");
  assert.equal(await recorder.ended, 0);
  const player = await runDesigner("--replay", join(folder, "flight.mcap"));
  await page.goto(player.url);
  await page.locator(".box").first().waitFor();
  const places = () => page.evaluate(() => Object.fromEntries(
    [...document.querySelectorAll(".box")].map((each) => [each.dataset.id, each.style.transform])));
  const state = async () => (await page.locator("#panel li", { hasText: "AStar" }).locator("small").allTextContents())[0] ?? "";
  await page.locator("#time").focus();
  await page.keyboard.press("End");
  await until(async () => (await page.locator(".box").count()) === 13);
  const last = await places();
  let wasReady = false, wasKilled = false;
  await box(navigator).locator(".head").click();
  const count = Number(await page.locator("#time").getAttribute("max"));
  for (let i = 0; i < count; ++i) {
    if (i === 0) await page.locator("#time").focus();
    await Promise.all([page.waitForResponse(/state\.json\?at=/), page.keyboard.press("ArrowLeft")]);
    await frame();
    if (!(await box(navigator).count())) continue;
    wasKilled ||= /restarted once/.test(await state());
    wasReady ||= wasKilled && /process \d+$/.test(await state());
  }
  assert(wasKilled && wasReady, "what was killed and replaced is seen again");
  for (const [name, place] of Object.entries(await places())) assert.equal(place, last[name], `${name} stands elsewhere`);
  assert.equal(await page.getByRole("button", { name: "Restart" }).count(), 0);
  await page.locator("#speed").selectOption("100");
  await page.locator("#play").click();
  await page.locator("#play", { hasText: "Pause" }).waitFor();
  await page.locator("#play", { hasText: "Play" }).waitFor();
  assert.match(await page.locator("#now").textContent(), /after the start/);
  await demandAccessible(page);
  player.kill("SIGINT");
  assert.equal(await player.ended, 0);
});

test("three hundred boxes move", async (context) => {
  const systems = 23, entities = [];
  for (let i = 0; i < 300; ++i) {
    entities.push({ name: `uav-${i % systems}/entity_${i}`, system: `uav-${i % systems}`, state: "ready", reason: "", process: "", launcher: 0,
      pid: i + 1, host: "h", program: "p", vendor: "v", version: "1", cpu: [1], memory: 1e7, threads: 9, x: (i % 20) * 290, y: Math.floor(i / 20) * 150,
      width: 208, height: 110, services: ["A", "B", "C"].map((csp) => ({ name: "m/I", csp, state: "ready", reason: "", process: "", pid: 0, calls: [5],
        failed: [0], waiting: 0, running: 0, p50: 1000, p99: 2000 })) });
  }
  const links = Array.from({ length: 900 }, (_, i) => ({ source: entities[i % 300].name, target: entities[(i * 7 + 1) % 300].name,
    kind: i % 3 ? "Values" : "Calls", name: `n${i}`, state: "ready", transport: "DDS", reason: "", rate: [i], p50: 1000, p99: 2000 }));
  const crowd = await browser.newPage({ viewport: { width: 1366, height: 768 } });
  await crowd.routeWebSocket("**/socket", (route) => route.send(JSON.stringify({ domain: 1, place: "here", plan: "", faults: false,
    time: Date.now() * 1e6, troubles: [], missions: [], entities, links, decisions: [], log: [] })));
  await crowd.goto(`http://127.0.0.1:${port}/${token}/`);
  await until(async () => (await crowd.locator(".box").count()) === 300);
  const frames = async (what, x, y) => {
    await crowd.mouse.move(x, y);
    await crowd.mouse.down();
    const counting = crowd.evaluate(() => new Promise((resolve) => {
      let count = 0;
      const begin = performance.now();
      const next = () => (++count, performance.now() - begin < 2000 ? requestAnimationFrame(next) : resolve(count / 2));
      requestAnimationFrame(next);
    }));
    let isOver = false;
    void counting.finally(() => { isOver = true; });
    for (let i = 0; !isOver; ++i) await crowd.mouse.move(x + (2 * i) % 200, y + i % 100);
    await crowd.mouse.up();
    context.diagnostic(`${what}: ${await counting} frames a second`);
  };
  await frames("all boxes, by dragging the drawing", 520, 760);
  const one = await crowd.locator(".box .head").nth(150).boundingBox();
  await frames("one box with its lines", one.x + 5, one.y + 5);
  await crowd.close();
});

test("nothing in the page has gone wrong meanwhile", () => assert.deepEqual(complaints, []));
