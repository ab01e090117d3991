// Composing on the page of `skein designer` in Chromium: the reconnaissance mission from an empty canvas, by mouse and by keyboard.
import assert from "node:assert/strict";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import WebSocket from "ws";
import { complaints, demandAccessible, endAll, folder, openBrowser, openPage, run, runDesigner, sources, until } from "./page_tools.mjs";

const profiles = `${sources}/mission_profiles`;
const model = `${profiles}/reconnaissance/reconnaissance.xml`;

let browser, page, mission;

before(async () => {
  browser = await openBrowser();
  page = await openPage(browser);
  mission = await missionOf(model);
});

after(async () => {
  await browser?.close();
  await endAll();
});

/** What a page is told. */
const told = () => page.evaluate(async () => (await fetch("design.json")).json());
const errors = async () => (await told()).findings.filter((each) => each.severity === "error").map((each) => each.problem);
const box = (name) => page.locator(`.box[data-id="uav-1/${name}"]`);

/** The entities of a profile as they are written there, variables in place. */
async function missionOf(file) {
  const designer = await runDesigner(file);
  await page.goto(designer.url);
  const { elements, parts } = await told();
  designer.kill("SIGTERM");
  const attributes = (element) => Object.fromEntries(element.attributes.map(({ name, value }) => [name, value]));
  const variables = Object.fromEntries(elements.filter((each) => each.name === "variable").map((each) => Object.values(attributes(each))));
  variables.speed_limit = "8"; // slow enough to be seen
  for (const [, name, value] of readFileSync(`${profiles}/reconnaissance/flight/point_mass.xml`, "utf8").matchAll(/name="(\w+)" default="([^"]*)"/g)) variables[name] = value;
  const expanded = (element) => Object.fromEntries(Object.entries(attributes(element)).map(([name, value]) => [name, value.replaceAll(/\$\{(\w+)\}/g, (_, each) => variables[each])]));
  const within = (parent, name) => elements.flatMap((each, i) => (each.parent === parent && each.name === name ? [i] : []));
  const componentOf = (number) => parts.find((each) => each.element === number).description;
  const entities = elements.flatMap((element, number) => (element.name !== "peer" ? [] : [{
    ...expanded(element), component: componentOf(number), parameters: within(number, "parameter").map((each) => expanded(elements[each])),
    csps: within(number, "csp").map((each) => ({ ...expanded(elements[each]), component: componentOf(each) })),
  }]));
  entities[0].csps.push({ component: `${profiles}/reconnaissance/components/point_mass.xml`, process: "in", thread: "caller" }); // from a part
  return [...entities.slice(1), entities[0]]; // others depend on the simulator
}

/** What a person does, with a mouse. */
const mouse = {
  press: (target) => target.click(),
  enter: (target, value) => target.fill(value),
  choose: (target, value) => target.selectOption(value),
  openTab: (name) => page.locator("#composing").getByRole("tab", { name }).click(),
};

/** The same without one: Tab goes to what is wanted. */
const keyboard = {
  async go(target) {
    const element = await target.elementHandle();
    const isBefore = await element.evaluate((each) => Boolean(each.compareDocumentPosition(document.activeElement) & Node.DOCUMENT_POSITION_FOLLOWING));
    for (let i = 0; i < 400; ++i) {
      if (await element.evaluate((each) => each === document.activeElement)) return;
      await page.keyboard.press(isBefore ? "Shift+Tab" : "Tab");
    }
    assert.fail(`Tab does not reach ${target}`);
  },
  async press(target) {
    await this.go(target);
    await page.keyboard.press("Enter");
  },
  async enter(target, value) {
    await this.go(target);
    await page.keyboard.press("Control+A");
    await page.keyboard.insertText(value);
  },
  async choose(target, value) {
    await this.go(target);
    await page.keyboard.press("Home");
    for (let i = 0; i < 100 && (await target.inputValue()) !== value; ++i) await page.keyboard.press("ArrowDown");
    assert.equal(await target.inputValue(), value);
  },
  async openTab(name) {
    await this.go(page.locator('#composing [role="tab"][aria-selected="true"]'));
    const wanted = page.locator("#composing").getByRole("tab", { name });
    for (let i = 0; i < 5 && (await wanted.getAttribute("aria-selected")) !== "true"; ++i) await page.keyboard.press("ArrowRight");
  },
};

/** The field of that name in a form. */
const field = (form, name) => form.locator(`> div > .field`, { has: page.locator("label span").getByText(new RegExp(`^${name}( \\*)?$`)) }).locator("input, select");

async function fill(person, form, name, value) {
  const input = field(form, name);
  const isChoice = (await input.evaluate((each) => each.localName)) === "select";
  await (isChoice ? person.choose(input, value) : person.enter(input, value));
}

async function addEntity(person, entity) {
  await person.openTab("Add");
  await person.enter(page.getByRole("searchbox", { name: "Find a component" }), entity.component.slice(profiles.length + 1));
  await person.press(page.locator("#composing-Add li").getByRole("button", { name: /as an entity/ }));
  await until(async () => (await told()).entities.length > 0 && (await page.locator(".box.selected").count()) === 1);
}

async function fillEntity(person, entity) {
  await person.openTab("Edit");
  await page.locator("#composing-Edit h2").waitFor();
  const form = page.locator("#composing-Edit > div > div").nth(1);
  for (const name of ["name", "role", "restart", "on_loss"]) {
    if (name === "on_loss" && entity[name]) await person.press(form.locator("> .more summary", { hasText: "Process" }));
    if (name === "on_loss" && entity[name]) await person.choose(form.locator("> .more .field", { hasText: "on_loss" }).locator("select"), entity[name]);
    else if (entity[name]) await fill(person, form, name, entity[name]);
  }
  for (const { name, value } of entity.parameters) await person.enter(form.locator("> .parameters .field", { has: page.getByText(new RegExp(`^${name}( \\*)?$`)) }).locator("input"), value);
  for (const [i, csp] of entity.csps.entries()) {
    const chooser = form.locator("> .csps > .acts");
    const option = await chooser.locator("option", { hasText: csp.component.slice(profiles.length) }).getAttribute("value");
    await person.choose(chooser.locator("select"), option);
    await person.press(chooser.locator("button"));
    const nested = form.locator("> .csps > div > details").nth(i);
    await person.press(nested.locator("> summary"));
    if (csp.process === "own") await person.choose(nested.locator(".field", { hasText: /^process/ }).locator("select"), "own");
    if (csp.restart) await person.choose(nested.locator(".field", { hasText: /^restart/ }).locator("select").first(), csp.restart);
  }
}

/** From nothing to what flies. */
async function compose(person, file) {
  const designer = await runDesigner(file, "--components", profiles, "--faults");
  await page.goto(designer.url);
  await page.getByText("Nothing is here yet").waitFor();
  await person.openTab("Mission");
  const form = page.locator("#composing-Mission > div").nth(1);
  for (const [name, value] of [["name", "built"], ["domain", "37"], ["system", "uav-1"], ["plugin", "reconnaissance_components"]]) await fill(person, form, name, value);
  for (const [i, entity] of mission.entries()) {
    if (i === mission.length - 1) {
      await person.openTab("Edit");
      await until(async () => (await errors()).every((each) => each.includes("depends on recon/IFlightSimulator")) && (await errors()).length > 0);
      await box("ground_station").locator(".needed", { hasText: "needs IFlightSimulator" }).waitFor();
      assert.match(await page.locator("#summary").textContent(), /12 entities, \d errors?$/);
    }
    await addEntity(person, entity);
    await fillEntity(person, entity);
  }
  await until(async () => (await errors()).length === 0);
  assert.equal(await page.locator(".needed, .slot, .box.incomplete").count(), 0);
  await page.locator("#summary", { hasText: "13 entities, complete: nothing is missing" }).waitFor();
  await page.keyboard.press("Control+S");
  await page.locator("#composing .answer", { hasText: "saved as" }).waitFor();
  assert.equal(await page.locator("#save").isDisabled(), true);
  return designer;
}

test("the mission is composed by keyboard, saved, and complete", async () => {
  const file = join(folder, "keyboard.xml");
  const designer = await compose(keyboard, file);
  assert.equal(await run("check", file).ended, 0);
  designer.kill("SIGTERM");
  assert.equal(await designer.ended, 0);
});

let designer, recorder;

test("the same by mouse", async () => {
  designer = await compose(mouse, join(folder, "mouse.xml"));
  const sorted = (tag) => tag.split(/\s+(?=\w+=")/).sort().join(" ");
  const tags = (name) => readFileSync(join(folder, `${name}.xml`), "utf8").match(/<[^>]*[^/>]/g).map(sorted);
  assert.deepEqual(tags("keyboard"), tags("mouse"));
});

test("what has changed is told in words and marked, and undone", async () => {
  const saved = readFileSync(join(folder, "mouse.xml"), "utf8");
  await mouse.openTab("Changes");
  await page.getByRole("button", { name: "Compare with the saved file" }).click();
  await page.getByText("No difference from").waitFor();
  await box("nhp").locator(".head").click();
  await field(page.locator("#composing-Edit > div > div").nth(1), "vendor").selectOption("cyclonedds");
  await page.locator(".box.marked-changed").waitFor();
  await box("eoi_manager").locator(".head").focus();
  await page.keyboard.press("Delete");
  await page.locator(".box.removed", { hasText: "eoi_manager" }).waitFor();
  await mouse.openTab("Changes");
  await page.getByText('nhp: vendor is "cyclonedds", was not given').waitFor();
  await page.getByText("peer eoi_manager is gone").waitFor();
  assert.equal((await told()).text === saved, false);
  await page.locator("#undo").click();
  await page.locator("#undo").click();
  await page.getByText("No difference from").waitFor();
  await page.getByRole("button", { name: "End the comparison" }).click();
  assert.equal((await told()).text, saved);
  assert.equal(await page.locator("#save").isDisabled(), true);
});

test("what others write meanwhile is a bar, and is taken when it is wanted", async () => {
  const file = join(folder, "mouse.xml"), saved = readFileSync(file, "utf8");
  writeFileSync(file, saved.replace('name="built"', 'name="theirs"'));
  await page.getByText("Somebody else has changed the file.").waitFor();
  await page.getByRole("button", { name: "Load what is on the disk" }).click();
  await page.locator("#title", { hasText: "theirs" }).waitFor();
  await page.locator("#undo").click();
  await page.locator("#title", { hasText: "built" }).waitFor();
  await page.locator("#save").click();
  await until(() => readFileSync(file, "utf8") === saved);
});

test("text that is typed changes the drawing, and what is wrong in it is told with its place", async () => {
  await mouse.openTab("Text");
  const area = page.locator("#composing-Text textarea"), text = await area.inputValue();
  await area.fill(text.replace("</mission>", ""));
  await mouse.openTab("Problems");
  await page.locator("#composing .finding", { hasText: "<mission> is not closed" }).waitFor();
  assert.equal(await page.locator(".box").count(), 13);
  await page.locator("#undo").click();
  await until(async () => (await page.locator("#composing-Problems .finding").count()) === 0);
  await page.locator("#summary", { hasText: "complete: nothing is missing" }).waitFor();
});

test("text that is typed over another's edit is refused, and stays until it is discarded", async () => {
  await mouse.openTab("Text");
  const area = page.locator("#composing-Text textarea"), text = await area.inputValue();
  await page.evaluate(() => Object.assign(window, { wait: window.setTimeout, setTimeout: () => 0 })); // so that nothing is sent yet
  await area.fill(`${text}<!-- mine`);
  const { version } = await told();
  const other = new WebSocket(`${designer.url.replace("http", "ws")}socket`);
  other.on("open", () => other.send(JSON.stringify({ request: 1, do: "set", element: 0, attribute: "domain", value: "38", version })));
  await until(async () => (await told()).version > version);
  await page.evaluate(() => Object.assign(window, { setTimeout: window.wait }));
  await area.fill(`${text}<!-- mine -->`);
  await page.locator("#composing .answer.bad", { hasText: "the mission was changed meanwhile" }).waitFor();
  assert.equal(await area.inputValue(), `${text}<!-- mine -->`);
  await page.getByRole("button", { name: "Discard what is typed here" }).click();
  await until(async () => (await area.inputValue()) === text.replace('domain="37"', 'domain="38"'));
  await page.locator("#undo").click();
  await until(async () => (await area.inputValue()) === text);
  other.close();
});

test("an edit that waits for another one finds its element", async () => {
  const before = await told(), gone = [2, 5].map((i) => before.entities[i].name);
  await page.evaluate((names) => {
    for (const name of names) {
      const head = document.querySelector(`.box[data-id="${name}"] .head`);
      head.focus();
      head.dispatchEvent(new KeyboardEvent("keydown", { key: "Delete", bubbles: true }));
    }
  }, gone);
  await until(async () => (await told()).entities.length === before.entities.length - 2);
  const names = (await told()).entities.map((each) => each.name);
  assert.deepEqual(names, before.entities.map((each) => each.name).filter((each) => !gone.includes(each)));
  await page.locator("#undo").click();
  await page.locator("#undo").click();
  await until(async () => (await told()).text === before.text);
});

test("a component that is dropped on a box becomes its CSP, if it fits, and an entity elsewhere, at that place", async () => {
  await mouse.openTab("Add");
  const search = page.getByRole("searchbox", { name: "Find a component" });
  const item = page.locator("#composing-Add li").first();
  await search.fill("reconnaissance/components/table_match.xml");
  await item.dragTo(box("navigator").locator(".head"));
  await page.locator("#composing .answer.bad", { hasText: "TableMatch does not fit peer navigator" }).waitFor();
  await search.fill("reconnaissance/components/straight_ahead.xml");
  const csps = await box("navigator").locator("li.csp").count();
  await item.dragTo(box("navigator").locator(".head"));
  await until(async () => (await box("navigator").locator("li.csp").count()) === csps + 1);
  await search.fill("reconnaissance/components/nhp.xml");
  await item.dragTo(page.locator("#canvas"), { targetPosition: { x: 12, y: 12 } });
  await box("nhp_2").waitFor();
  const made = await box("nhp_2").boundingBox(), canvas = await page.locator("#canvas").boundingBox();
  assert(Math.abs(made.x - canvas.x - 12) < 30 && Math.abs(made.y - canvas.y - 12) < 30, `${made.x}, ${made.y}`);
  await page.keyboard.press("Escape");
  await page.locator("#undo").click();
  await page.locator("#undo").click();
  await until(async () => (await told()).changed === false);
});

test("who cannot see finds nothing missing while composing", async () => {
  for (const scheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme: scheme });
    await box("navigator").locator(".head").click();
    for (const name of ["Add", "Edit", "Mission", "Problems", "Changes", "Text"]) {
      await mouse.openTab(name);
      await demandAccessible(page);
    }
  }
  await page.emulateMedia({ colorScheme: "light" });
});

test("it is launched from the page and watched; a CSP is killed, and its replacement is seen", async () => {
  recorder = run("record", "--domain", "37", "--output", join(folder, "built.mcap"));
  await page.getByRole("button", { name: "Launch" }).click();
  await until(async () => (await page.locator(".box.ready").count()) === 13);
  await box("navigator").locator(".head").click();
  const row = page.locator("#panel li", { hasText: "AStar" }).first();
  await row.getByRole("button", { name: "Kill" }).click();
  await row.getByRole("button", { name: "Yes" }).click();
  await row.getByText("was restarted once, last ended by signal 9 (Killed)").waitFor();
  await until(async () => /process \d+/.test(await row.locator("small").textContent()));
});

test("keys do nothing to the plan while the mission is watched", async () => {
  const { text } = await told();
  await box("nhp").locator(".head").focus();
  await page.keyboard.press("Delete");
  await page.keyboard.press("Control+Z");
  await page.locator("#arrange").click();
  await page.locator("#watch").click();
  await page.locator("#composing").waitFor();
  assert.equal((await told()).text, text);
  await page.locator("#watch").click();
  await until(async () => (await page.locator(".box.ready").count()) === 13);
});

test("it is stopped, and the plan tells how it has ended", async () => {
  await page.locator("#panel").getByRole("tab", { name: "Mission" }).click();
  await page.getByRole("button", { name: "Stop the mission" }).click();
  await page.getByRole("button", { name: "Yes" }).click();
  await page.locator("#watch").click();
  await page.locator("#summary", { hasText: "the mission ended with exit code 143: it was asked to stop" }).waitFor();
  assert.equal(await page.locator(".box").count(), 13);
});

test("the flight that was recorded is replayed", async () => {
  recorder.kill("SIGINT");
  assert.equal(await recorder.ended, 0);
  const player = await runDesigner("--replay", join(folder, "built.mcap"));
  const replay = await openPage(browser);
  await replay.goto(player.url);
  await replay.locator("#time").focus();
  await replay.keyboard.press("End");
  await until(async () => (await replay.locator(".box").count()) === 13);
  await replay.close();
});

test("a start script is written beside the mission, and nothing else is overwritten", async () => {
  await page.locator("#script").click();
  await page.locator("#composing .answer", { hasText: "written to" }).waitFor();
  const script = join(folder, "mouse.sh");
  assert.match(readFileSync(script, "utf8"), /Written by `skein script`/);
  writeFileSync(script, "mine");
  await page.locator("#script").click();
  await page.locator("#composing .answer.bad", { hasText: "move it away" }).waitFor();
  assert.equal(readFileSync(script, "utf8"), "mine");
});

test("a component of one's own is begun from the page, and is among the others then", async () => {
  await mouse.openTab("Add");
  await page.getByText("Begin a component of your own").click();
  const form = page.locator("#composing-Add details"), write = page.getByRole("button", { name: "Write its files" });
  const control = (label) => form.locator(".field", { has: page.locator("label span").getByText(new RegExp(`^${label}( \\*)?$`)) }).locator("input, select, textarea");
  await control("Name").fill("Range finder");
  await write.click();
  await page.locator("#composing .answer.bad", { hasText: "as in 'RangeFinder'" }).waitFor();
  await control("Name").fill("RangeFinder");
  await control("Operations").fill("double range_m(in Bearing to);");
  await write.click();
  await page.locator("#composing .answer.bad", { hasText: "there is no 'Bearing' here" }).waitFor();
  assert.ok(!existsSync(join(folder, "range_finder")));
  await control("Operations").fill("double range_m(in double bearing_deg);");
  await write.click();
  await page.locator("#composing .answer", { hasText: "cmake" }).waitFor();
  assert.match(readFileSync(join(folder, "range_finder/range_finder.cpp"), "utf8"), /double range_m\(double/);
  await page.getByRole("searchbox", { name: "Find a component" }).fill("range_finder");
  await page.getByRole("button", { name: "Add RangeFinder as an entity" }).click();
  await box("range_finder").waitFor();
  assert.match((await told()).text, /component="range_finder\/range_finder.xml" plugin="range_finder"/);
  await page.locator("#undo").click();
  await box("range_finder").waitFor({ state: "detached" });
  await control("Kind").selectOption("activity");
  await control("Name").fill("Plotter");
  await control("Calls").selectOption(["range_finder/IRangeFinder"]);
  await write.click();
  await page.locator("#composing .answer", { hasText: "plotter" }).waitFor();
  assert.match(readFileSync(join(folder, "plotter/plotter.cpp"), "utf8"), /connect<range_finder::IRangeFinder>/);
  await demandAccessible(page);
});

test("what this machine lacks keeps a mission from being launched, with the reason", async () => {
  await mouse.openTab("Mission");
  await fill(mouse, page.locator("#composing-Mission > div").nth(1), "plugin", "no_such_plugin");
  await page.getByRole("button", { name: "Save and launch" }).click();
  await page.locator("#composing .answer.bad", { hasText: /not launched:[^]*no_such_plugin/ }).waitFor();
  designer.kill("SIGTERM");
  assert.equal(await designer.ended, 0);
});

test("nothing in the page has gone wrong meanwhile", () => assert.deepEqual(complaints.filter((each) => !each.includes("ERR_CONNECTION_REFUSED")), []));
