// Composing a mission: components, forms, findings, and the text itself.
import { Beginning } from "./beginning.js";
import { childrenOf, componentOf, entityAt, fits, given, isCsp, isIn, summaryOf } from "./design.js";
import { h, set, setText, sync } from "./element.js";
import { Form } from "./form.js";
import { Tabs } from "./tabs.js";
import { counted, short } from "./words.js";

/** @typedef {import("./design.js").DesignState} DesignState */
/** @typedef {import("./design.js").ComponentState} ComponentState */

/** Milliseconds after the last key, until the input is sent. */
const typingPause = 250;
const dragType = "text/x-skein-component";

/** @param {string} text @returns {string} */
const asField = (text) => text.replace(/\r\n?/g, "\n");
const $ = (/** @type {string} */ id) => /** @type {HTMLElement} */ (document.getElementById(id));

export class Composer {
  /**
   * @param {import("./panel.js").Ask} ask
   * @param {import("./canvas.js").Canvas} canvas
   * @param {import("./schema.js").Schema} schema
   * @param {(id: string) => void} select
   * @param {(watches: boolean) => void} watch Shows the mission as it flies, or its plan.
   */
  constructor(ask, canvas, schema, select, watch) {
    this.ask = ask;
    this.canvas = canvas;
    this.select = select;
    this.form = new Form(schema, (what, members, later) => this.edit(what, members, later));
    /** @type {DesignState|null} */
    this.design = null;
    this.selected = "";
    /** Which form is shown: another one for each selection, but not for another name of the same. */
    this.formNumber = 0;
    /** Edits are sent one after the other, each for the text that the one before has made. @type {Promise<boolean>} */
    this.queue = Promise.resolve(true);
    /** Input that is not sent yet. @type {{what: string, members: Record<string, any>, timer: ReturnType<typeof setTimeout>}|null} */
    this.typed = null;
    this.answer = h("p", { class: "answer", role: "status" });
    this.tabs = new Tabs($("composing"), "Composing", ["Add", "Edit", "Mission", "Problems", "Changes", "Text"], () => this.draw(), this.answer);
    this.search = /** @type {HTMLInputElement} */ (h("input", { type: "search", autocomplete: "off", "aria-label": "Find a component", placeholder: "Find a component", oninput: () => this.draw() }));
    this.home = /** @type {HTMLSelectElement} */ (h("select"));
    this.homeLabel = h("label", { class: "level" }, "Add to ", this.home);
    this.list = h("ul", { class: "list" });
    this.beginning = new Beginning((members) => this.run("new", members));
    this.tabs.page("Add").append(this.search, this.homeLabel, this.beginning.root, this.list, h("p", { class: "hint" },
      "Drag one to the drawing or to a box, or press its button. Another folder: --components FOLDER."));
    this.text = /** @type {HTMLTextAreaElement} */ (h("textarea", { "aria-label": "The mission's XML", spellcheck: "false", oninput: () => this.typeText() }));
    /** The version of the mission's text from which the one in the field has come; 0: nobody has typed there. */
    this.textVersion = 0;
    this.takeText = h("button", { type: "button", onclick: () => this.discardText() }, "Discard what is typed here");
    this.tabs.page("Text").append(this.text, h("p", { class: "acts" }, this.takeText));
    for (const [id, what] of [["undo", "undo"], ["redo", "redo"], ["save", "save"]]) $(id).onclick = () => this.run(what, {});
    $("launch").onclick = () => this.launch(watch);
    $("script").onclick = () => this.run("script", {});
    $("load").onclick = () => this.run("load", {});
    $("over").onclick = () => this.run("save", { over: true });
    document.addEventListener("keydown", (event) => this.key(event));
    window.addEventListener("focus", () => this.run("look", {}, true));
    canvas.root.addEventListener("dragover", (event) => this.dragOver(event));
    canvas.root.addEventListener("drop", (event) => this.drop(event));
  }

  /** @param {DesignState} design @param {string} selected */
  show(design, selected) {
    const before = this.design;
    this.design = design;
    if (selected !== this.selected) {
      this.formNumber += 1;
      if (selected && this.tabs.open !== "Add") this.tabs.show("Edit");
    }
    this.selected = selected;
    if (before && selected && !design.entities.some((each) => each.name === selected)) this.follow(before, design);
    this.draw();
  }

  /** Selects the same entity under its new name. @param {DesignState} before @param {DesignState} now */
  follow(before, now) {
    const was = before.parts.findIndex((part) => part.entity === this.selected && !part.csp);
    const part = now.parts.length === before.parts.length ? now.parts[was] : undefined;
    this.selected = part && part.element === before.parts[was].element ? part.entity : "";
    this.select(this.selected);
  }

  draw() {
    const design = this.design;
    if (!design) return;
    const errors = design.findings.filter((each) => each.severity === "error").length;
    this.tabs.label("Problems", design.findings.length ? `Problems (${design.findings.length})` : "Problems");
    const name = design.file.slice(design.file.lastIndexOf("/") + 1);
    const mission = given(design, 0, "name") ?? name;
    document.title = `${design.changed ? "• " : ""}${mission} – Skein`;
    setText($("title"), mission);
    setText($("summary"), `${name}${design.changed ? ", not saved" : ""}: ${design.entities.length === 1 ? "1 entity" : `${design.entities.length} entities`}, ` +
      (errors ? counted(errors, "error") : design.checked ? "complete: nothing is missing" : "this machine is being checked") + (design.flight ? `; the mission ${design.flight}` : ""));
    set($("summary"), "title", design.file);
    for (const [id, label] of [["undo", design.undo], ["redo", design.redo]]) {
      set($(id), "disabled", !label);
      set($(id), "title", label);
    }
    set($("save"), "disabled", !design.changed && !design.disk);
    set($("launch"), "disabled", design.flight === "flies" || errors > 0);
    set($("launch"), "title", errors ? "The mission is not complete: see Problems" : design.changed ? "Save the mission, check it on this machine, and fly it" : "Check the mission on this machine, and fly it");
    setText($("launch"), design.changed ? "Save and launch" : "Launch");
    setText($("disk-text"), design.disk === "gone" ? "The file is gone from the disk. " : "Somebody else has changed the file. ");
    set($("disk"), "hidden", !design.disk);
    set($("load"), "hidden", design.disk !== "changed");
    setText($("over"), design.disk === "gone" ? "Save again" : "Save over it");
    const open = this.tabs.open;
    if (open === "Add") this.components(design);
    if (open === "Edit") this.selection(design);
    if (open === "Mission") this.mission(design);
    if (open === "Problems") this.problems(design);
    if (open === "Changes") this.changes(design);
    if (open === "Text") this.showText(design);
  }

  /** Input stays until the mission has it. @param {DesignState} design */
  showText(design) {
    const now = asField(design.text);
    set(this.takeText, "hidden", !this.textVersion);
    if (!this.textVersion && this.text.value !== now) this.text.value = now;
  }

  /** Refused, if somebody else has changed the mission since the first key. */
  typeText() {
    this.textVersion ||= this.design?.version ?? 0;
    this.type("text", { text: this.text.value });
  }

  discardText() {
    if (this.typed?.what === "text") clearTimeout(this.typed.timer), this.typed = null;
    this.textVersion = 0;
    this.draw();
  }

  /** Later input is meant for the version that this text has made, if no other one came first. @param {string} sent */
  textIsTaken(sent) {
    if (this.text.value === sent) this.textVersion = 0;
    else if (this.design && asField(this.design.text) === sent) this.textVersion = this.design.version;
    this.draw();
  }

  /** @param {DesignState} design */
  components(design) {
    this.beginning.show(design);
    const groups = childrenOf(design, 0, "group");
    set(this.homeLabel, "hidden", !groups.length);
    sync(this.home, [0, ...groups], (each) => `${each}`, (each) => h("option", { value: each }), (option, each) =>
      setText(option, each ? `group ${given(design, each, "name") ?? ""}` : "the mission"));
    const wanted = this.search.value.trim().toLowerCase().split(/\s+/);
    const found = design.components.filter((each) => wanted.every((word) => `${each.name} ${summaryOf(each)} ${each.reference}`.toLowerCase().includes(word)));
    const owner = componentOf(design, design.parts.find((part) => part.entity === this.selected && !part.csp));
    const isFar = (/** @type {ComponentState} */ each) => Number(each.reference.startsWith("/") || each.reference.startsWith("../"));
    found.sort((a, b) => isFar(a) - isFar(b)); // one's own first
    sync(this.list, found, (each) => each.file, (each) => this.component(each), (item, each) => {
      const [title, , , acts] = item.children, [asEntity, asCsp] = acts.children;
      set(item, "class", each.failure ? "bad" : isCsp(design, each) ? "off" : "");
      set(item, "draggable", each.failure ? null : "true");
      setText(title, each.name);
      setText(item.children[1], summaryOf(each));
      setText(item.children[2], each.reference);
      set(acts, "hidden", Boolean(each.failure));
      set(asEntity, "hidden", isCsp(design, each));
      set(asCsp, "hidden", !fits(owner, each));
      setText(asCsp, `Add to ${short(this.selected)}`);
    });
  }

  /** @param {ComponentState} component */
  component(component) {
    const { file } = component;
    return h("li", { ondragstart: (/** @type {DragEvent} */ event) => this.dragStart(event, file), ondragend: () => this.markFitting(undefined) },
      h("b"), h("small"), h("small"), h("span", { class: "acts add" },
        h("button", { type: "button", "aria-label": `Add ${component.name} as an entity`, onclick: () => this.addEntity(file) }, "Add"),
        h("button", { type: "button", onclick: () => this.addCsp(file, this.selected) })));
  }

  /** @param {DesignState} design */
  selection(design) {
    const page = this.tabs.page("Edit");
    const part = design.parts.find((each) => each.entity === this.selected && !each.csp);
    const what = part ? (part.element < 0 ? "elsewhere" : "form") : this.selected.includes("\n") ? "line" : "nothing";
    sync(page, [what], (each) => `${each} ${this.formNumber}`, () => h("div"), (place) => {
      if (what === "form" && part) return this.entity(place, design, part.element);
      sync(place, [what], (each) => each, () => h("p", { class: "hint" }));
      setText(place.children[0], what === "elsewhere" ? "It stands in a part of the profile, another file, or the text is no well-formed XML for the moment."
        : what === "line" ? this.selected.split("\n").slice(0, 2).map(short).join(" needs what these provide: ")
          : "Select a box to change it, or add one under Add.");
    });
  }

  /** @param {HTMLElement} place @param {DesignState} design @param {number} element */
  entity(place, design, element) {
    if (!place.firstChild)
      place.append(h("h2"), h("p", { class: "hint" }), makeFindings(), h("div"), h("p", { class: "acts" }, h("button", { type: "button", onclick: () => this.remove() }, "Remove this entity")));
    setText(place.children[0], this.selected);
    const component = componentOf(design, design.parts.find((each) => each.element === element));
    setText(place.children[1], component ? `${component.name}: ${summaryOf(component)}` : "");
    showFindings(place.children[2], design.findings.filter((each) => isIn(design, each.element, element)));
    this.form.show(place.children[3], design, element);
  }

  /** @param {DesignState} design */
  mission(design) {
    const page = this.tabs.page("Mission");
    if (!page.firstChild) page.append(makeFindings(), h("div"));
    showFindings(page.children[0], design.findings.filter((each) => each.element >= 0 && !entityAt(design, each.element)));
    if (design.elements.length) this.form.show(page.children[1], design, 0);
  }

  /** @param {DesignState} design */
  problems(design) {
    const page = this.tabs.page("Problems");
    if (!page.firstChild) page.append(h("p", { class: "hint" }), h("ul", { class: "list" }));
    setText(page.children[0], design.findings.length ? "" : design.checked ? "Nothing is missing or wrong, in the mission and on this machine." : "This machine is being checked.");
    sync(page.children[1], design.findings, (each) => `${each.place} ${each.problem}`, (each) => {
      const item = h("li", { class: each.severity === "error" ? "bad" : "busy" }, h("div"), h("button", { type: "button", class: "plain" }, each.place));
      showFindings(item.children[0], [each]);
      return item;
    }, (item, each) => {
      item.children[1].onclick = () => {
        const entity = entityAt(design, each.element);
        if (entity) this.select(entity);
        this.tabs.show(entity ? "Edit" : each.element >= 0 ? "Mission" : "Text");
      };
    });
  }

  /** @param {DesignState} design */
  changes(design) {
    const page = this.tabs.page("Changes");
    if (!page.firstChild) {
      const other = /** @type {HTMLInputElement} */ (h("input", { autocomplete: "off", "aria-label": "Another mission's file", placeholder: "another mission's file" }));
      page.append(h("p", { class: "acts" }, h("button", { type: "button", onclick: () => this.run("compare", { with: this.design?.file }) }, "Compare with the saved file")),
        h("p", { class: "acts" }, other, h("button", { type: "button", onclick: () => other.value && this.run("compare", { with: other.value }) }, "Compare")),
        h("p", { class: "acts" }, h("button", { type: "button", onclick: () => this.run("compare", { with: null }) }, "End the comparison")),
        h("p", { class: "hint" }), h("ul", { class: "list" }));
    }
    set(page.children[2], "hidden", !design.compared);
    const others = design.differences.length;
    setText(page.children[3], !design.compared ? "What differs is told here, and marked on the drawing." : `${others ? counted(others, "difference") : "No difference"} from ${design.compared}.`);
    sync(page.children[4], design.differences, (each) => `${each.kind} ${each.text}`, (each) => h("li", { class: each.kind === "new" ? "" : each.kind === "gone" ? "bad" : "busy" },
      each.entity ? h("button", { type: "button", class: "plain", onclick: () => this.select(each.entity) }, each.text) : h("span", {}, each.text)));
  }

  /** @param {(watches: boolean) => void} watch */
  async launch(watch) {
    if (!(await this.flush())) return;
    if (this.design?.changed && !(await this.run("save", {}))) return;
    if (await this.run("launch", {})) watch(true);
  }

  /** @param {string} file @param {{x: number, y: number}} [at] */
  async addEntity(file, at) {
    const component = this.design?.components.find((each) => each.file === file);
    if (this.design && component && isCsp(this.design, component))
      return this.tell(`${component.name} is a CSP: add it to an entity that has CSPs for ${component.interfaces.map(short).join(", ")}`, "answer bad");
    const before = new Set(this.design?.entities.map((each) => each.name));
    const parent = Number(this.home.value);
    await this.edit("add_entity", { component: file, ...(parent ? { element: parent } : {}), ...(at ?? {}) });
    const made = this.design?.entities.find((each) => !before.has(each.name));
    if (made) this.select(made.name);
  }

  /** @param {string} file @param {string} entity */
  addCsp(file, entity) {
    const part = this.design?.parts.find((each) => each.entity === entity && !each.csp);
    if (part) void this.edit("add_csp", { component: file, element: part.element });
  }

  remove() {
    const part = this.design?.parts.find((each) => each.entity === this.selected && !each.csp);
    if (part) void this.edit("remove", { element: part.element });
  }

  /** Whether it was done. @param {string} what @param {Record<string, any>} members @param {boolean} [later] @returns {Promise<boolean>} */
  edit(what, members, later) {
    members = { ...members, version: this.design?.version ?? 0 }; // in which the element has its number
    if (later) return this.type(what, members), Promise.resolve(true);
    this.flush();
    return this.run(what, members);
  }

  /** @param {string} what @param {Record<string, any>} members */
  type(what, members) {
    const isSame = this.typed && this.typed.what === what && this.typed.members.element === members.element &&
      this.typed.members.attribute === members.attribute && this.typed.members.name === members.name;
    if (isSame && this.typed) clearTimeout(this.typed.timer);
    else this.flush();
    this.typed = { what, members, timer: setTimeout(() => this.flush(), typingPause) };
  }

  /** Sends the input. False if it is refused. @returns {Promise<boolean>} */
  flush() {
    const typed = this.typed;
    if (!typed) return Promise.resolve(true);
    clearTimeout(typed.timer);
    this.typed = null;
    return this.run(typed.what, typed.members);
  }

  /** @param {string} what @param {Record<string, any>} members @param {boolean} [silent] @returns {Promise<boolean>} */
  run(what, members, silent) {
    const isTaken = this.flush();
    this.queue = this.queue.then(async () => {
      try {
        if (what === "save" && !(await isTaken)) return false; // the answer tells why
        const text = await this.ask(what, what === "text" ? { ...members, version: this.textVersion } : members);
        if (what === "text") this.textIsTaken(members.text);
        if (!silent) this.tell(text, "answer");
        return true;
      } catch (error) {
        this.tell(/** @type {Error} */ (error).message, "answer bad");
        return false;
      }
    });
    return this.queue;
  }

  /** @param {string} text @param {string} kind */
  tell(text, kind) {
    set(this.answer, "class", kind);
    setText(this.answer, text);
    set(this.answer, "tabindex", this.answer.scrollHeight > this.answer.clientHeight ? 0 : null); // so that keys scroll it
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (!document.body.classList.contains("compose")) return; // the domain is shown
    const isField = event.target instanceof HTMLElement && event.target.matches("input, textarea, select");
    const key = event.ctrlKey || event.metaKey ? event.key.toLowerCase() : "";
    const what = key === "s" ? "save" : isField ? "" : key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : "";
    const box = /** @type {HTMLElement|null} */ (document.activeElement?.closest(".box"))?.dataset.id;
    if (what) {
      void this.run(what, {});
    } else if (event.key === "Delete" && box) {
      this.select(box);
      const part = this.design?.parts.find((each) => each.entity === box && !each.csp);
      if (part) void this.edit("remove", { element: part.element });
    } else {
      return;
    }
    event.preventDefault();
  }

  /** @param {DragEvent} event @param {string} file */
  dragStart(event, file) {
    event.dataTransfer?.setData(dragType, file);
    this.markFitting(this.design?.components.find((each) => each.file === file));
  }

  /** Marks the boxes to which a component can be dropped. @param {ComponentState|undefined} component */
  markFitting(component) {
    for (const [id, element] of this.canvas.elements) {
      const owner = this.design ? componentOf(this.design, this.design.parts.find((part) => part.entity === id && !part.csp)) : undefined;
      element.classList.toggle("fits", component !== undefined && fits(owner, component));
    }
  }

  /** @param {DragEvent} event */
  dragOver(event) {
    if (event.dataTransfer?.types.includes(dragType)) event.preventDefault();
  }

  /** On a box as its CSP, elsewhere as an entity. @param {DragEvent} event */
  drop(event) {
    const file = event.dataTransfer?.getData(dragType);
    if (!file) return;
    event.preventDefault();
    const box = /** @type {HTMLElement|null} */ (/** @type {Element} */ (event.target).closest(".box"))?.dataset.id;
    this.canvas.isPlaced = true; // it stays below the pointer
    if (box) this.addCsp(file, box);
    else void this.addEntity(file, this.canvas.at(event.clientX, event.clientY));
  }
}

/** Of one height, so that nothing moves below a pointer while findings come and go. */
function makeFindings() {
  return h("div", { class: "findings", role: "group", "aria-label": "What is wrong", tabindex: "0" });
}

/** @param {Element} place @param {import("./design.js").FindingState[]} findings */
function showFindings(place, findings) {
  sync(place, findings, (each) => `${each.place} ${each.problem}`, (each) => h("p", { class: `finding ${each.severity}` },
    h("b", {}, each.severity), ` ${each.problem}`, each.remedy ? h("small", {}, each.remedy) : null));
}
