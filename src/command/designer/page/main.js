// The page of `skein designer`: shows what the server tells, and asks it for what the user wants.
import { set, setText } from "./element.js";
import { Canvas } from "./canvas.js";
import { Panel } from "./panel.js";
import { sharedTopics } from "./state.js";
import { showTables } from "./table.js";
import { clock, counted } from "./words.js";

/** Milliseconds. */
const oldAfter = 6000, firstRetry = 500, longestRetry = 5000, answerWithin = 15000;

const $ = (/** @type {string} */ id) => /** @type {HTMLElement} */ (document.getElementById(id));

/** @type {import("./state.js").View} */
const view = { values: true, shared: false, folded: new Set(), search: "" };
/** @type {import("./state.js").DomainState|null} */
let state = null;
let selected = "";
let asTable = false;
let drawn = false;
let heard = 0;

/** @type {WebSocket|null} */
let socket = null;
let retry = firstRetry;
let lastRequest = 0;
/** @type {Map<number, {resolve: (text: string) => void, reject: (error: Error) => void}>} */
const requests = new Map();

/** Asks the server for something; its answer in words. @param {string} what @param {Record<string, any>} members @returns {Promise<string>} */
function ask(what, members) {
  return new Promise((resolve, reject) => {
    if (socket?.readyState !== WebSocket.OPEN) return reject(new Error("there is no connection to skein designer"));
    const request = ++lastRequest;
    requests.set(request, { resolve, reject });
    socket.send(JSON.stringify({ request, do: what, ...members }));
    setTimeout(() => end(request, false, "skein designer does not answer"), answerWithin);
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
    state = message;
    heard = Date.now();
    drawSoon();
  };
  socket.onclose = () => {
    for (const request of [...requests.keys()]) end(request, false, "the connection to skein designer has ended");
    setTimeout(connect, retry);
    retry = Math.min(2 * retry, longestRetry);
    tellConnection();
  };
}

/** Says so if what is shown is old. */
function tellConnection() {
  const text = socket?.readyState === WebSocket.OPEN || socket?.readyState === WebSocket.CONNECTING && !state
    ? state && Date.now() - heard > oldAfter ? `No news since ${clock(heard * 1e6)}.` : ""
    : `There is no connection to skein designer${state ? `; this is of ${clock(state.time)}` : ""}. Trying again…`;
  const all = [text, ...(state?.troubles ?? [])].filter(Boolean).join(" · ");
  setText($("bar"), all);
  set($("bar"), "hidden", !all);
  document.body.classList.toggle("stale", Boolean(text));
}

function drawSoon() {
  if (!drawn) requestAnimationFrame(draw);
  drawn = true;
}

function draw() {
  drawn = false;
  tellConnection();
  if (!state) return;
  summarize(state);
  if (asTable) showTables($("tables"), state, view.search, select);
  else canvas.show(state, selected);
  panel.show(state, selected);
}

/** @param {import("./state.js").DomainState} state */
function summarize(state) {
  const wrong = state.entities.filter((entity) => entity.state !== "ready");
  const names = state.missions.map((mission) => mission.mission).join(", ");
  document.title = `${wrong.length ? `(${wrong.length}) ` : ""}${names || state.place} – Skein`;
  setText($("title"), names || "Skein");
  const degraded = state.missions.some((mission) => mission.degraded) ? "degraded, " : "";
  setText($("summary"), `${state.place}: ${degraded}${state.entities.length === 1 ? "1 entity" : `${state.entities.length} entities`}` +
    `${wrong.length ? `, ${wrong.length} not ready` : ""}${state.plan ? `, planned by ${state.plan}` : ""}`);
  const shared = sharedTopics(state);
  set($("shared"), "hidden", shared.size === 0);
  setText($("shared"), `+ ${counted(shared.size, "shared topic")}`);
}

/** @param {string} id */
function select(id) {
  selected = id;
  if (id && panel.tab === "Mission") panel.open("Details");
  drawSoon();
}

/** @param {string} id */
function fold(id) {
  if (view.folded.has(id)) view.folded.delete(id);
  else view.folded.add(id);
  drawSoon();
}

/** @param {string} id @param {() => boolean} flip */
function toggle(id, flip) {
  $(id).onclick = () => {
    set($(id), "aria-pressed", String(flip()));
    drawSoon();
  };
}

const panel = new Panel($("panel"), ask, select);
const canvas = new Canvas($("canvas"), view, {
  select, fold, move: (entity, x, y) => ask("move", { entity, x, y }).catch(() => undefined),
});
toggle("values", () => (view.values = !view.values));
toggle("shared", () => (view.shared = !view.shared));
toggle("as-table", () => {
  asTable = !asTable;
  set($("tables"), "hidden", !asTable);
  set($("graph"), "hidden", asTable);
  return asTable;
});
$("fit").onclick = () => canvas.fit();
$("arrange").onclick = () => ask("arrange", {}).then(() => { canvas.fitted = false; }, () => undefined);
const search = /** @type {HTMLInputElement} */ ($("search"));
search.oninput = () => {
  view.search = search.value;
  drawSoon();
};
search.onkeydown = (event) => {
  const found = canvas.layer.querySelector(".found .head");
  if (event.key === "Enter" && found) canvas.focus(/** @type {HTMLElement} */ (found.parentElement).dataset.id ?? "");
};
setInterval(tellConnection, 1000);
connect();
