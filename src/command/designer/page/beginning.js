// Beginning a component of one's own, as `skein new` does.
import { row } from "./form.js";
import { h, set, setText, sync } from "./element.js";
import { short } from "./words.js";

const kinds = new Map([["entity", "entity: offers a service"], ["csp", "CSP: an algorithm of an entity"], ["activity", "activity: calls others"]]);

export class Beginning {
  /** @param {(members: Record<string, any>) => Promise<boolean>} begin */
  constructor(begin) {
    this.kind = select({ onchange: () => this.draw() }, [...kinds]);
    this.name = input({ placeholder: "Lookout", autocomplete: "off", spellcheck: "false" });
    this.implements = select({ onchange: () => this.draw() }, []);
    this.operations = /** @type {HTMLTextAreaElement} */ (h("textarea", { class: "few", rows: 3, spellcheck: "false" }, "double value();"));
    this.needs = select({ multiple: true, size: 4 }, []);
    this.csps = select({ multiple: true, size: 4 }, []);
    const name = row("Name", this.name, "Of the component and its C++ class.", true);
    this.rows = {
      implements: row("Implements", this.implements, "An interface that a component here implements or calls. Its IDL file is looked for in the folders of --components."),
      operations: row("Operations", this.operations, "Of the new interface, in IDL, such as: double depth(in double length);", true),
      needs: row("Calls", this.needs, "Interfaces of other entities that its code calls. Ctrl chooses several."),
      csps: row("CSPs for", this.csps, "Interfaces among whose algorithms its Head chooses. Ctrl chooses several."),
    };
    this.root = h("details", {}, h("summary", {}, "Begin a component of your own"),
      row("Kind", this.kind, "", true), name, ...Object.values(this.rows),
      h("p", { class: "acts" }, h("button", { type: "button", onclick: () => begin(this.members()) }, "Write its files")));
    this.draw();
  }

  members() {
    const kind = this.kind.value;
    const chosen = (/** @type {HTMLSelectElement} */ of) => Array.from(of.selectedOptions, (option) => option.value);
    return {
      kind, name: this.name.value.trim(),
      implements: kind === "activity" ? "" : this.implements.value,
      operations: kind === "activity" || this.implements.value ? "" : this.operations.value,
      needs: kind === "csp" ? [] : chosen(this.needs), csps: kind === "entity" ? chosen(this.csps) : [],
    };
  }

  draw() {
    const kind = this.kind.value;
    set(this.rows.implements, "hidden", kind === "activity");
    set(this.rows.operations, "hidden", kind === "activity" || Boolean(this.implements.value));
    set(this.rows.needs, "hidden", kind === "csp");
    set(this.rows.csps, "hidden", kind !== "entity");
  }

  /** @param {import("./design.js").DesignState} design */
  show(design) {
    const known = [...new Set(design.components.flatMap((each) => [...each.interfaces, ...each.dependencies, ...each.subcomponents]))].sort((a, b) => short(a).localeCompare(short(b)));
    fill(this.implements, ["", ...known]);
    fill(this.needs, known);
    fill(this.csps, known);
  }
}

/** @param {Record<string, any>} attributes @param {string[][]} options @returns {HTMLSelectElement} */
function select(attributes, options) {
  return /** @type {HTMLSelectElement} */ (h("select", attributes, ...options.map(([value, text]) => h("option", { value }, text))));
}

/** @param {Record<string, any>} attributes @returns {HTMLInputElement} */
function input(attributes) {
  return /** @type {HTMLInputElement} */ (h("input", attributes));
}

/** @param {HTMLSelectElement} place @param {string[]} names */
function fill(place, names) {
  sync(place, names, (name) => `=${name}`, (name) => h("option", { value: name }), (option, name) => setText(option, name ? name.replaceAll("/", "::") : "a new interface"));
}
