// What is known of one thing, and what can be done to it.
import { h, set, setText, sync } from "./element.js";
import { clock, counted, digits, latency, outcome, rate, short, size, stateText, time, tone } from "./words.js";

/** @typedef {import("./state.js").DomainState} DomainState */
/** @typedef {import("./state.js").EntityState} EntityState */
/** @typedef {import("./state.js").Link} Link */
/** @typedef {import("./state.js").ServiceState} ServiceState */
/** @typedef {import("./state.js").MissionStatus} MissionStatus */
/** @typedef {import("./state.js").DecisionNote} DecisionNote */
/** @typedef {(what: string, members: Record<string, any>) => Promise<string>} Ask */

const tabs = ["Details", "Mission", "Decisions", "Log"];
const levels = ["debug", "info", "warning", "error"];

export class Panel {
  /** @param {HTMLElement} root @param {Ask} ask @param {(id: string) => void} select */
  constructor(root, ask, select) {
    this.ask = ask;
    this.select = select;
    this.tab = "Details";
    this.level = "info";
    this.buttons = tabs.map((name) => h("button", {
      type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `page-${name}`, onclick: () => this.open(name),
      onkeydown: (/** @type {KeyboardEvent} */ event) => this.key(event),
    }, name));
    this.pages = tabs.map((name) => h("div", { role: "tabpanel", id: `page-${name}`, "aria-labelledby": `tab-${name}`, tabindex: "0" }));
    this.answer = h("p", { class: "answer", role: "status" });
    root.append(h("div", { role: "tablist", "aria-label": "Details" }, ...this.buttons), this.answer, ...this.pages);
    this.open(this.tab);
  }

  /** @param {string} name */
  open(name) {
    this.tab = name;
    tabs.forEach((each, i) => {
      set(this.buttons[i], "aria-selected", String(each === name));
      set(this.buttons[i], "tabindex", each === name ? "0" : "-1");
      set(this.pages[i], "hidden", each !== name);
    });
    this.draw();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = (tabs.indexOf(this.tab) + step + tabs.length) % tabs.length;
    this.open(tabs[next]);
    this.buttons[next].focus();
  }

  /** @param {DomainState} state @param {string} selected A box or a line. */
  show(state, selected) {
    if (selected !== this.selected && selected && this.tab === "Mission") this.open("Details");
    this.state = state;
    this.selected = selected;
    this.draw();
  }

  draw() {
    if (!this.state) return;
    const page = this.pages[tabs.indexOf(this.tab)];
    if (this.tab === "Details") this.details(page);
    if (this.tab === "Mission") this.missions(page);
    if (this.tab === "Decisions") decisions(page, this.state.decisions.filter((each) => this.isOf(each.entity)));
    if (this.tab === "Log") this.log(page);
  }

  /** Whether something of an entity is shown: all is, while none is selected. @param {string} entity */
  isOf(entity) {
    return !this.selected || this.selected.includes("\n") || entity === this.selected || entity.startsWith(this.selected);
  }

  /** @param {HTMLElement} page */
  details(page) {
    const state = /** @type {DomainState} */ (this.state);
    const selected = this.selected ?? "";
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
    for (const button of element.children[2].querySelectorAll("button"))
      set(button, "disabled", !entity.process || !entity.launcher);
    factsOf(facts, entity);
    sync(services, entity.services, (each) => `${each.name} ${each.csp}`, () => h("li", {}, h("b"), h("span"), h("small")),
      (row, each) => this.service(row, each, entity));
    sync(links, state.links.filter((each) => each.source === entity.name || each.target === entity.name),
      (each) => `${each.source} ${each.target} ${each.kind} ${each.name} ${each.transport}`, () => h("li", {}, h("b"), h("span"), h("small")),
      (row, each) => linkRow(row, each, entity.name));
  }

  /** @param {Element} place @param {EntityState} entity */
  actsOn(place, entity) {
    const name = entity.name;
    const now = () => this.state?.entities.find((each) => each.name === name);
    const act = (/** @type {string} */ what) => () => this.run(what, { launcher: now()?.launcher, process: now()?.process });
    place.append(sure("Restart", `Restart ${short(name)}?`, act("restart")));
    if (!this.state?.faults) return;
    place.append(sure("Kill", `Kill ${short(name)}?`, act("kill")), sure("Hang", `Make ${short(name)} hang?`, act("hang")));
  }

  /** @param {HTMLElement} row @param {ServiceState} service @param {EntityState} entity */
  service(row, service, entity) {
    const [what, figures, more] = row.children;
    setText(what, service.csp || short(service.name));
    setText(figures, `${rate(service.calls)} ${latency(service)}`);
    const failed = service.failed.length && service.failed[0] > 0 ? `${rate(service.failed)} fail` : "";
    const queue = service.waiting + service.running > 0 ? `${service.waiting} wait, ${service.running} run` : "";
    setText(more, [service.csp ? `CSP of ${service.name}` : service.name, service.pid ? `process ${service.pid}` : "",
      service.state === "ready" && !service.reason ? "" : stateText(service), failed, queue].filter(Boolean).join(" · "));
    set(row, "class", tone(service.state));
    if (!service.process || row.children.length > 3) return;
    const act = (/** @type {string} */ what) => () => this.run(what, { launcher: entity.launcher, process: service.process });
    row.append(h("span", { class: "acts" }, sure("Restart", `Restart ${service.csp}?`, act("restart")),
      this.state?.faults ? sure("Kill", `Kill ${service.csp}?`, act("kill")) : null,
      this.state?.faults ? sure("Hang", `Make ${service.csp} hang?`, act("hang")) : null));
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
    const missions = state.missions.map((mission) => ({ key: String(mission.launcher), mission }));
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
      page.append(h("label", { class: "level" }, "At least ", choice), h("ul", { class: "log" }), h("p", { class: "hint" }));
    }
    const lines = state.log.filter((each) => this.isOf(each.entity) && levels.indexOf(each.level) >= levels.indexOf(this.level)).reverse();
    sync(page.children[1], lines, (each) => `${each.time} ${each.pid} ${each.text}`, (each) => h("li", { class: each.level },
      h("small", {}, `${clock(each.time)} ${each.entity} ${each.level} ${each.place}`), h("span", {}, each.text)));
    setText(page.children[2], lines.length ? "" : "No such line since this page was opened, nor among the latest before.");
  }

  /** @param {string} what @param {Record<string, any>} members */
  async run(what, members) {
    setText(this.answer, "…");
    set(this.answer, "class", "answer");
    try {
      setText(this.answer, await this.ask(what, members));
    } catch (error) {
      set(this.answer, "class", "answer bad");
      setText(this.answer, /** @type {Error} */ (error).message);
    }
  }
}

/** A button that asks back in its place. @param {string} label @param {string} question @param {() => void} run */
function sure(label, question, run) {
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
  return h("span", {}, first, second);
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
  setText(row.children[1], `${rate(link.rate)} ${link.kind === "Calls" ? latency(link) : ""}`);
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
  const state = mission.ending ? `ends: ${mission.ending}` : mission.degraded ? "degraded" : "flies";
  const lost = mission.processes.filter((each) => each.state === "lost").map((each) => each.name);
  setText(words, `${state}${mission.degraded && lost.length ? `, because ${lost.join(", ")} is lost` : ""}, for ${time(mission.uptime * 1e9)}, by launcher ${mission.launcher}`);
  set(words, "class", `words ${mission.ending || mission.degraded ? "bad" : "good"}`);
  sync(list, mission.processes, (each) => each.name, () => h("li", {}, h("b"), h("span"), h("small")), (row, each) => {
    setText(row.children[0], each.name);
    setText(row.children[1], each.state);
    setText(row.children[2], [each.pid ? `process ${each.pid} for ${time(each.uptime * 1e9)}` : "", each.restarts ? `restarted ${counted(each.restarts, "time")}` : "",
      each.last_exit && `last ended ${each.last_exit}`, each.reason].filter(Boolean).join(" · "));
    set(row, "class", tone(each.state));
  });
}

/** @param {HTMLElement} page @param {DecisionNote[]} notes */
function decisions(page, notes) {
  sync(page, notes.length ? [...notes].reverse() : [null], (each) => (each ? `${each.entity} ${each.service} ${each.number}` : "none"), (each) => {
    if (!each) return h("p", { class: "hint" }, "No Head has decided since this page was opened.");
    const tried = each.attempts.map((attempt) => `${attempt.csp} ${outcome(attempt.outcome)}`).join(", ") || "nobody";
    return h("details", { class: each.failure ? "bad" : "good" },
      h("summary", {}, h("small", {}, `${clock(each.time)} ${each.entity}`), h("span", {}, `${each.request}: ${tried}, ${time(each.took)}`)),
      h("pre", { tabindex: "0" }, each.explanation));
  });
}
