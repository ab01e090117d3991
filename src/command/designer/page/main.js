// The page of `skein designer`: shows the server's state, and sends it the user's requests.
import { set, setText } from "./element.js";
import { Canvas } from "./canvas.js";
import { Composer } from "./compose.js";
import { pictureOf } from "./design.js";
import { Panel } from "./panel.js";
import { replay } from "./replay.js";
import { Schema } from "./schema.js";
import { isFound, sharedTopics } from "./state.js";
import { showTables } from "./table.js";
import { clock, counted } from "./words.js";

/** Milliseconds. */
const oldAfter = 6000, firstRetry = 500, longestRetry = 5000, answerWithin = 15000, checkWithin = 90000;

const $ = (/** @type {string} */ id) => /** @type {HTMLElement} */ (document.getElementById(id));

/** @type {import("./state.js").View} */
const view = { values: true, shared: false, folded: new Set(), search: "" };
/** @type {import("./state.js").DomainState|null} */
let state = null;
let selected = "";
let asTable = false;
/** What is drawn: the state, or the plan. @type {import("./state.js").DomainState|null} */
let shown = null;
let drawn = false;
let heard = 0;

/** @type {WebSocket|null} */
let socket = null;
let retry = firstRetry;
let lastRequest = 0;
/** @type {Map<number, {resolve: (text: string) => void, reject: (error: Error) => void}>} */
const requests = new Map();

/** Sends a request; resolves to the answer in words. @param {string} what @param {Record<string, any>} members @returns {Promise<string>} */
function ask(what, members) {
  return new Promise((resolve, reject) => {
    if (socket?.readyState !== WebSocket.OPEN) return reject(new Error("there is no connection to skein designer"));
    const request = ++lastRequest;
    requests.set(request, { resolve, reject });
    socket.send(JSON.stringify({ request, do: what, ...members }));
    setTimeout(() => end(request, false, "skein designer does not answer"), ["launch", "script", "new"].includes(what) ? checkWithin : answerWithin);
  });
}

/** @param {number} request @param {boolean} done @param {string} text */
function end(request, done, text) {
  const waiting = requests.get(request);
  requests.delete(request);
  if (done) waiting?.resolve(text);
  else waiting?.reject(new Error(text));
}

function connect() {
  socket = new WebSocket(new URL("socket", location.href.replace(/^http/, "ws")));
  socket.onmessage = (event) => {
    const message = JSON.parse(event.data);
    retry = firstRetry;
    if ("request" in message) return end(message.request, message.done, message.text);
    if ("elements" in message) return void showDesign(message);
    heard = Date.now();
    showState(message);
  };
  socket.onclose = () => {
    for (const request of [...requests.keys()]) end(request, false, "the connection to skein designer has ended");
    void lookWhy();
    setTimeout(connect, retry);
    retry = Math.min(2 * retry, longestRetry);
    tellConnection();
  };
}

/** Whether skein designer is there, and does not know this page's URL. */
let isStranger = false;

async function lookWhy() {
  const answer = await fetch("times.json").catch(() => null);
  isStranger = answer?.status === 401;
  tellConnection();
}

/** The damage of a recording, in words. */
let damage = "";
let isReplay = false;

/** Warns if the state is old. */
function tellConnection() {
  const text = isReplay ? damage : socket?.readyState === WebSocket.OPEN || socket?.readyState === WebSocket.CONNECTING && !state
    ? state && (!design || watches) && Date.now() - heard > oldAfter ? `No news since ${clock(heard * 1e6)}.` : ""
    : isStranger ? "skein designer was started anew, with another URL: open that one."
    : `There is no connection to skein designer${state ? `; this is of ${clock(state.time)}` : ""}. Trying again…`;
  const all = [text, ...((watches ? state : design ?? state)?.troubles ?? [])].filter(Boolean).join(" · ");
  setText($("bar"), all);
  set($("bar"), "hidden", !all);
  document.body.classList.toggle("stale", Boolean(text));
}

/** @param {import("./state.js").DomainState} told */
function showState(told) {
  state = told;
  drawSoon();
}

/** The mission that is composed; null: none is. @type {import("./design.js").DesignState|null} */
let design = null;
/** @type {Composer|null} */
let composer = null;
/** @type {Promise<string>|null} */
let schema = null;
/** Whether the mission is shown as it flies, though one is composed. */
let watches = false;

/** @param {import("./design.js").DesignState} told */
async function showDesign(told) {
  design = told;
  document.body.classList.add("designing");
  schema ??= fetch("mission.xsd").then((answer) => answer.text());
  const text = await schema;
  composer ??= new Composer(ask, canvas, new Schema(text), select, watch);
  if (composer.design !== design) composer.show(design, selected);
  drawSoon();
}

/** @param {boolean} wanted */
function watch(wanted) {
  watches = wanted;
  set($("watch"), "aria-pressed", String(watches));
  canvas.isPlaced = false;
  drawSoon();
}

function drawSoon() {
  if (!drawn) document.hidden ? setTimeout(draw) : requestAnimationFrame(draw); // of a hidden page the title is seen
  drawn = true;
}

function draw() {
  drawn = false;
  tellConnection();
  const isPlan = design !== null && !watches;
  document.body.classList.toggle("compose", isPlan);
  set($("composing"), "hidden", !isPlan);
  set($("panel"), "hidden", isPlan);
  shown = isPlan && design ? pictureOf(design) : state;
  if (!shown) return;
  if (!isPlan) summarize(shown);
  setText($("empty"), isPlan ? "Nothing is here yet. Add a component from the list." : "Nobody is on this domain yet. When a mission starts, it appears here.");
  set($("empty"), "hidden", shown.entities.length > 0);
  if (asTable) showTables($("tables"), shown, view.search, select);
  else canvas.show(shown, selected);
  if (isPlan && design) return composer?.show(design, selected);
  panel ??= new Panel($("panel"), ask, select);
  panel.show(shown, selected);
}

/** @param {import("./state.js").DomainState} state */
function summarize(state) {
  const wrong = state.entities.filter((entity) => entity.state !== "ready");
  const names = state.missions.map((mission) => `${mission.mission}${mission.launcher ? "" : " (ended)"}`).join(", ");
  document.title = `${wrong.length ? `(${wrong.length}) ` : ""}${names || state.place} – Skein`;
  setText($("title"), names || "Skein");
  const degraded = state.missions.some((mission) => mission.degraded) ? "degraded, " : "";
  setText($("summary"), `${state.place}: ${degraded}${state.entities.length === 1 ? "1 entity" : `${state.entities.length} entities`}` +
    `${wrong.length ? `, ${wrong.length} not ready` : ""}${state.plan ? `, planned by ${state.plan.slice(state.plan.lastIndexOf("/") + 1)}` : ""}${foundText()}`);
  set($("summary"), "title", state.plan);
  const shared = sharedTopics(state);
  set($("shared"), "hidden", shared.size === 0);
  setText($("shared"), `+ ${counted(shared.size, "shared topic")}`);
}

/** The result of the search, in words. */
function foundText() {
  if (!view.search.trim() || asTable) return "";
  return `; ${canvas.boxes.filter((box) => shown && isFound(box, shown, view.search)).length} with '${view.search.trim()}'`;
}

/** @param {string} id */
function select(id) {
  selected = id;
  drawSoon();
}

/** @param {string} id */
function fold(id) {
  if (view.folded.has(id)) view.folded.delete(id);
  else view.folded.add(id);
  draw();
  const isSystem = id.endsWith("/");
  canvas.focus(isSystem && !view.folded.has(id) ? shown?.entities.find((each) => `${each.system}/` === id)?.name ?? "" : id);
}

/** @param {string} id @param {() => boolean} flip */
function toggle(id, flip) {
  $(id).onclick = () => {
    set($(id), "aria-pressed", String(flip()));
    drawSoon();
  };
}

/** @type {Panel|null} */
let panel = null;
const canvas = new Canvas($("canvas"), view, {
  select, fold, move: (entity, x, y) => ask("move", { entity, x, y }).catch(() => undefined), // a recording keeps nothing
});
toggle("values", () => (view.values = !view.values));
toggle("shared", () => (view.shared = !view.shared));
$("watch").onclick = async () => {
  if (watches) watch(false);
  else if (await composer?.run("watch", {})) watch(true);
};
toggle("as-table", () => {
  asTable = !asTable;
  set($("tables"), "hidden", !asTable);
  set($("graph"), "hidden", asTable);
  return asTable;
});
$("fit").onclick = () => {
  canvas.isPlaced = false;
  canvas.fit();
};
$("arrange").onclick = () => ask("arrange", design && watches ? { live: true } : {}).then(() => {
  canvas.moved.clear();
  canvas.isPlaced = false;
}, () => undefined);
const search = /** @type {HTMLInputElement} */ ($("search"));
search.oninput = () => {
  view.search = search.value;
  drawSoon();
};
search.onkeydown = (/** @type {KeyboardEvent} */ event) => {
  if (event.key !== "Enter" || !shown) return;
  const rank = (/** @type {import("./state.js").Box} */ box) => (shown ? isFound(box, shown, view.search) : 0);
  const best = [...canvas.boxes].sort((a, b) => rank(b) - rank(a))[0];
  if (best && rank(best)) canvas.focus(best.id);
};
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") select("");
});
setInterval(tellConnection, 1000);

const recording = await (await fetch("times.json")).json();
isReplay = recording !== null;
document.body.classList.toggle("replay", isReplay);
if (isReplay) {
  canvas.patience = Infinity;
  replay(recording.times, showState, (text) => {
    damage = text;
    tellConnection();
  });
} else {
  connect();
}
