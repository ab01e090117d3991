// The details of one entity, link or process, with its actions.
import { h, set, setText, sync } from "./element.js";
import { Tabs } from "./tabs.js";
import { clock, counted, digits, latency, often, outcome, rate, short, size, stateText, time, tone } from "./words.js";

/** @typedef {import("./state.js").DomainState} DomainState */
/** @typedef {import("./state.js").EntityState} EntityState */
/** @typedef {import("./state.js").Link} Link */
/** @typedef {import("./state.js").ServiceState} ServiceState */
/** @typedef {import("./state.js").MissionStatus} MissionStatus */
/** @typedef {import("./state.js").DecisionNote} DecisionNote */
/** @typedef {(what: string, members: Record<string, any>) => Promise<string>} Ask */

const mostDecisions = 100;
const levels = ["debug", "info", "warning", "error"];

export class Panel {
  /** @param {HTMLElement} root @param {Ask} ask @param {(id: string) => void} select */
  constructor(root, ask, select) {
    this.ask = ask;
    this.select = select;
    /** @type {DomainState|null} */
    this.state = null;
    this.selected = "";
    /** Decisions that the server has told. It keeps few of each Head. @type {Map<string, DecisionNote>} */
    this.history = new Map();
    /** @type {ReturnType<typeof setTimeout>|undefined} */
    this.forget = undefined;
    this.level = "info";
    this.answer = h("p", { class: "answer", role: "status" });
    this.tabs = new Tabs(root, "Details", ["Details", "Mission", "Decisions", "Log"], () => this.draw(), this.answer);
  }

  /** @param {DomainState} state @param {string} selected A box or a line. */
  show(state, selected) {
    const isNew = selected !== this.selected && selected;
    this.state = state;
    this.selected = selected;
    if (isNew && this.tabs.open === "Mission") this.tabs.show("Details");
    else this.draw();
  }

  draw() {
    if (!this.state) return;
    const open = this.tabs.open, page = this.tabs.page(open);
    if (open === "Details") this.details(page);
    if (open === "Mission") this.missions(page);
    for (const note of this.state.decisions) this.history.set(keyOf(note), note);
    for (const key of [...this.history.keys()].slice(0, -mostDecisions)) this.history.delete(key);
    if (open === "Decisions") this.decisions(page);
    if (open === "Log") this.log(page);
  }

  /** Whether something of an entity is shown: all is, while none is selected. @param {string} entity */
  isOf(entity) {
    const chosen = this.chosen();
    return !chosen || entity === chosen || entity.startsWith(`${chosen}.`) || (chosen.endsWith("/") && entity.startsWith(chosen));
  }

  /** The entity or system that is selected; a line is neither. @returns {string} */
  chosen() {
    return this.selected.includes("\n") ? "" : this.selected;
  }

  /** Of whom the list is, and a way to all. @param {Element} place */
  filter(place) {
    const chosen = this.chosen();
    sync(place, chosen ? [chosen] : [], (each) => each, (each) => h("span", {}, `Of ${each} only. `,
      h("button", { type: "button", class: "plain", onclick: () => this.select("") }, "Show all")));
  }

  /** While one is open, no others come and push it away. @param {HTMLElement} page */
  decisions(page) {
    if (!page.firstChild) page.append(h("p", { class: "hint" }), h("div"), h("p", { class: "hint" }));
    this.filter(page.children[0]);
    const notes = [...this.history.values()].filter((each) => this.isOf(each.entity)).sort((a, b) => b.time - a.time);
    const isRead = page.querySelector("details[open]") && this.filtered === this.chosen();
    if (!isRead) sync(page.children[1], notes, keyOf, makeDecision);
    this.filtered = this.chosen();
    const waiting = isRead ? notes.length - page.children[1].childElementCount : 0;
    setText(page.children[2], waiting > 0 ? `${waiting} newer; close what is open to see them.`
      : notes.length ? "" : `No Head ${this.chosen() ? "of it " : ""}has decided since this page was opened.`);
  }

  /** @param {HTMLElement} page */
  details(page) {
    const state = /** @type {DomainState} */ (this.state);
    const selected = this.selected;
    const [from, to, kind] = selected.split("\n");
    const entity = state.entities.find((each) => each.name === selected);
    const parts = kind ? [{ key: "line", from, to, kind }] : entity ? [{ key: "entity" }] : [{ key: selected || "nothing" }];
    sync(page, parts, (part) => `${selected} ${part.key}`, () => h("div"), (element) => {
      if (kind) lineDetails(element, state, from, to, kind);
      else if (entity) this.entityDetails(element, entity);
      else if (selected) this.systemDetails(element, state, selected);
      else sync(element, ["hint"], (each) => each, () => h("p", { class: "hint" },
        "Select a box or a line to see what is known of it. Drag moves, the wheel zooms."));
    });
  }

  /** @param {HTMLElement} element @param {EntityState} entity */
  entityDetails(element, entity) {
    const state = /** @type {DomainState} */ (this.state);
    if (!element.firstChild) {
      element.append(h("h2", {}, entity.name), h("p", { class: "words" }), h("p", { class: "acts" }), h("dl"),
        h("h3", {}, "Services and CSPs"), h("ul", { class: "list" }), h("h3", {}, "Calls and topics"), h("ul", { class: "list" }));
      this.actsOn(element.children[2], entity);
    }
    const [, words, , facts, , services, , links] = element.children;
    set(words, "class", `words ${tone(entity.state)}`);
    setText(words, stateText(entity));
    set(element.children[2], "hidden", !entity.process || !entity.launcher);
    this.allowFaults(element);
    factsOf(facts, entity);
    sync(services, entity.services, (each) => `${each.name} ${each.csp}`, () => h("li", {}, h("b"), h("span"), h("small")),
      (row, each) => this.service(row, each, entity));
    sync(links, linksOf(state, entity.name),
      (each) => `${each.source} ${each.target} ${each.kind} ${each.name} ${each.transport}`,
      (each) => h("li", {}, h("button", { type: "button", class: "plain", title: "Show the line", onclick: () => this.select(`${each.source}\n${each.target}\n${each.kind}`) }),
        h("span"), h("small")), (row, each) => linkRow(row, each, entity.name));
  }

  /** @param {Element} place @param {EntityState} entity */
  actsOn(place, entity) {
    const name = entity.name;
    const now = () => this.state?.entities.find((each) => each.name === name);
    const act = (/** @type {string} */ what) => () => this.run(what, { launcher: now()?.launcher, process: now()?.process });
    place.append(sure("Restart", `Restart ${short(name)}?`, act("restart")), sure("Kill", `Kill ${short(name)}?`, act("kill"), "fault"),
      sure("Hang", `Make ${short(name)} hang?`, act("hang"), "fault"));
  }

  /** @param {Element} element */
  allowFaults(element) {
    for (const each of element.querySelectorAll(".fault")) set(each, "hidden", !this.state?.faults);
  }

  /** @param {HTMLElement} row @param {ServiceState} service @param {EntityState} entity */
  service(row, service, entity) {
    const [what, figures, more] = row.children;
    setText(what, service.csp || short(service.name));
    setText(figures, `${often(service)} ${latency(service)}`);
    const failed = service.failed.length && service.failed[0] > 0 ? `${rate(service.failed)} fail` : "";
    const queue = service.waiting + service.running > 0 ? `${service.waiting} wait, ${service.running} run` : "";
    setText(more, [service.csp ? `CSP${service.name ? ` of ${service.name}` : ""}` : service.name, service.pid ? `process ${service.pid}` : "",
      service.cpu.length ? `${digits(service.cpu[0])} % CPU` : "",
      service.state === "ready" && !service.reason ? "" : stateText(service), failed, queue].filter(Boolean).join(" · "));
    set(row, "class", tone(service.state));
    if (service.process && row.children.length < 4) {
      const { name } = entity, { process } = service;
      const now = () => this.state?.entities.find((each) => each.name === name);
      const act = (/** @type {string} */ what) => () => this.run(what, { launcher: now()?.launcher, process });
      row.append(h("span", { class: "acts" }, sure("Restart", `Restart ${service.csp}?`, act("restart")),
        sure("Kill", `Kill ${service.csp}?`, act("kill"), "fault"), sure("Hang", `Make ${service.csp} hang?`, act("hang"), "fault")));
    }
    if (row.children[3]) set(row.children[3], "hidden", !service.process);
    this.allowFaults(row);
  }

  /** @param {HTMLElement} element @param {DomainState} state @param {string} folded `system/` */
  systemDetails(element, state, folded) {
    if (!element.firstChild) element.append(h("h2", {}, folded.slice(0, -1)), h("ul", { class: "list" }));
    sync(element.children[1], state.entities.filter((each) => `${each.system}/` === folded), (each) => each.name,
      (each) => h("li", {}, h("button", { type: "button", class: "plain", onclick: () => this.select(each.name) }, short(each.name)), h("span")),
      (row, each) => {
        set(row, "class", tone(each.state));
        setText(row.children[1], stateText(each));
      });
  }

  /** @param {HTMLElement} page */
  missions(page) {
    const state = /** @type {DomainState} */ (this.state);
    /** @type {{key: string, mission: MissionStatus|null}[]} */
    const missions = state.missions.map((mission) => ({ key: `${mission.mission} ${mission.launcher}`, mission }));
    sync(page, missions.length ? missions : [{ key: "none", mission: null }], (each) => each.key,
      ({ mission }) => (mission ? this.makeMission(mission) : h("p", { class: "hint" },
        "No launcher of this user flies a mission on this domain and host, so nothing can be restarted or stopped here.")),
      (element, { mission }) => mission && updateMission(element, mission));
  }

  /** @param {MissionStatus} mission */
  makeMission(mission) {
    return h("section", {}, h("h2", {}, mission.mission), h("p", { class: "words" }),
      h("p", { class: "acts" }, sure("Stop the mission", `Stop ${mission.mission}?`, () => this.run("stop", { launcher: mission.launcher }))),
      h("ul", { class: "list" }));
  }

  /** @param {HTMLElement} page */
  log(page) {
    const state = /** @type {DomainState} */ (this.state);
    if (!page.firstChild) {
      const choice = h("select", { onchange: () => {
        this.level = /** @type {HTMLSelectElement} */ (choice).value;
        this.draw();
      } }, ...levels.map((level) => h("option", { value: level, selected: level === this.level }, level)));
      page.append(h("label", { class: "level" }, "At least ", choice), h("ul", { class: "log" }), h("p", { class: "hint" }), h("p", { class: "hint" }));
    }
    this.filter(page.children[3]);
    const lines = state.log.filter((each) => this.isOf(each.entity) && levels.indexOf(each.level) >= levels.indexOf(this.level)).reverse();
    sync(page.children[1], lines, (each) => `${each.time} ${each.pid} ${each.text}`, (each) => h("li", { class: each.level },
      h("small", {}, `${clock(each.time)} ${each.entity} ${each.level} ${each.place}`), h("span", {}, each.text)));
    setText(page.children[2], lines.length ? "" : "Nothing was logged, as far as this page goes back. What programs print is in the launcher's log.");
  }

  /** @param {string} what @param {Record<string, any>} members */
  async run(what, members) {
    clearTimeout(this.forget);
    setText(this.answer, "…");
    set(this.answer, "class", "answer");
    try {
      setText(this.answer, await this.ask(what, members));
      this.forget = setTimeout(() => setText(this.answer, ""), 10000);
    } catch (error) {
      set(this.answer, "class", "answer bad");
      setText(this.answer, /** @type {Error} */ (error).message);
    }
  }
}

/** A button that asks back in its place. @param {string} label @param {string} question @param {() => void} run @param {string} [kind] */
function sure(label, question, run, kind) {
  const first = h("button", { type: "button", onclick: () => ask(true) }, label);
  const yes = h("button", { type: "button", class: "danger", onclick: () => (ask(false), run()) }, "Yes");
  const no = h("button", { type: "button", onclick: () => ask(false) }, "No");
  const second = h("span", { class: "sure", hidden: true, onkeydown: (/** @type {KeyboardEvent} */ event) => {
    if (event.key === "Escape") ask(false);
  } },
    question, " ", yes, " ", no);
  const ask = (/** @type {boolean} */ asks) => {
    set(first, "hidden", asks);
    set(second, "hidden", !asks);
    (asks ? no : first).focus();
  };
  return h("span", { class: kind }, first, second);
}

/** @param {Element} list @param {EntityState} entity */
function factsOf(list, entity) {
  const facts = entity.pid ? [
    ["Process", `${entity.pid}, ${entity.program}, on ${entity.host}`],
    ["Uses", `${entity.cpu.length ? digits(entity.cpu[0]) : "–"} % CPU, ${size(entity.memory)}, ${counted(entity.threads, "thread")}`],
    ["Speaks by", `${entity.vendor}, Skein ${entity.version}`]] : [];
  sync(list, facts, ([name]) => name, ([name]) => h("div", {}, h("dt", {}, name), h("dd")), (row, [, text]) => setText(row.children[1], text));
}

/** @param {HTMLElement} row @param {Link} link @param {string} entity */
function linkRow(row, link, entity) {
  const out = link.source === entity;
  const verb = link.kind === "Calls" ? (out ? "calls" : "is called by") : out ? "sends to" : "hears";
  setText(row.children[0], link.kind === "Calls" ? short(link.name) : link.name);
  setText(row.children[1], `${often(link)} ${link.kind === "Calls" ? latency(link) : ""}`);
  setText(row.children[2], [`${verb} ${short(out ? link.target : link.source)}`, link.transport && `by ${link.transport}`,
    link.state === "ready" ? "" : link.state, link.reason].filter(Boolean).join(" · "));
  set(row, "class", tone(link.state));
}

/** @param {HTMLElement} element @param {DomainState} state @param {string} from @param {string} to @param {string} kind */
function lineDetails(element, state, from, to, kind) {
  if (!element.firstChild) element.append(h("h2", {}, `${from} → ${to}`), h("ul", { class: "list" }));
  const ends = (/** @type {string} */ name, /** @type {string} */ box) => name === box || (box.endsWith("/") && name.startsWith(box));
  sync(element.children[1], state.links.filter((each) => each.kind === kind && ends(each.source, from) && ends(each.target, to)),
    (each) => `${each.source} ${each.target} ${each.name} ${each.transport}`, () => h("li", {}, h("b"), h("span"), h("small")),
    (row, each) => linkRow(row, each, each.source));
}

/** @param {HTMLElement} element @param {MissionStatus} mission */
function updateMission(element, mission) {
  const [, words, , list] = element.children;
  const isOver = mission.launcher === 0;
  set(element.children[2], "hidden", isOver);
  const state = mission.ending ? `${isOver ? "has ended" : "ends"}: ${mission.ending}` : mission.degraded ? "degraded" : "flies";
  const lost = mission.processes.filter((each) => each.state === "lost").map((each) => each.name);
  setText(words, `${state}${mission.degraded && lost.length ? `, because ${lost.join(", ")} is lost` : ""}, ${isOver ? "after" : "for"} ${time(mission.uptime * 1e9)}${isOver ? "" : `, by launcher ${mission.launcher}`}`);
  set(words, "class", `words ${mission.ending || mission.degraded ? "bad" : "good"}`);
  sync(list, mission.processes, (each) => each.name, () => h("li", {}, h("b"), h("span"), h("small")), (row, each) => {
    setText(row.children[0], each.name);
    setText(row.children[1], each.state);
    setText(row.children[2], [each.pid ? `process ${each.pid} for ${time(each.uptime * 1e9)}` : "", each.restarts ? `restarted ${counted(each.restarts, "time")}` : "",
      each.last_exit && `last ended ${each.last_exit}`, each.reason].filter(Boolean).join(" · "));
    set(row, "class", tone(each.state));
  });
}

/** @param {DecisionNote} note */
function keyOf(note) {
  return `${note.entity} ${note.service} ${note.number} ${note.time}`;
}

/** @param {DecisionNote} note */
function makeDecision(note) {
  const tried = note.attempts.map((attempt) => `${attempt.csp} ${outcome(attempt.outcome)}`).join(", ") || "nobody";
  return h("details", { class: note.failure ? "bad" : "good" },
    h("summary", {}, h("small", {}, `${clock(note.time)} ${note.entity}`), h("span", {}, `${note.request}: ${tried}, ${time(note.took)}`)),
    h("pre", { tabindex: "0" }, note.explanation));
}

/** Calls first, then what it hears, then what it sends. @param {DomainState} state @param {string} entity */
function linksOf(state, entity) {
  const rank = (/** @type {Link} */ link) => (link.kind === "Calls" ? 0 : link.target === entity ? 1 : 2);
  return state.links.filter((each) => each.source === entity || each.target === entity).sort((a, b) => rank(a) - rank(b));
}
