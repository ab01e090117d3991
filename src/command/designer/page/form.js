// Forms for the elements of a mission, made from the schema, the dictionary and the components' descriptions.
import { childrenOf, componentOf, fits, given, inherited, isIn } from "./design.js";
import { h, set, setText, sync } from "./element.js";
import { short } from "./words.js";

/** @typedef {import("./design.js").DesignState} DesignState */
/** @typedef {import("./schema.js").Field} Field */
/** An edit; `later`: the user still types. @typedef {(what: string, members: Record<string, any>, later?: boolean) => void} Edit */

/** Those that the form of an entity or CSP shows in a way of their own, and those that are boxes. */
const apart = new Set(["parameter", "csp", "peer"]);
/** Of the many attributes of a mission, a group, an entity or a CSP. */
const usual = new Set(["component", "name", "domain", "dictionary", "role", "process", "program", "system", "vendor", "host", "plugin", "restart"]);

export class Form {
  /** @param {import("./schema.js").Schema} schema @param {Edit} edit */
  constructor(schema, edit) {
    this.schema = schema;
    this.edit = edit;
    /** @type {WeakMap<Element, Set<string>>} */
    this.first = new WeakMap();
  }

  /** Draws the form of an element. @param {Element} place @param {DesignState} design @param {number} element */
  show(place, design, element) {
    const kind = this.schema.kind(design.elements[element].name);
    const part = design.parts.find((each) => each.element === element);
    const isPart = ["peer", "csp"].includes(design.elements[element].name);
    sync(place, ["first", ...(isPart ? ["parameters"] : []), "csps", "others", "more"], (each) => each, (each) => h("div", { class: each }),
      (area, name) => {
        if (!kind) return;
        const first = this.firstFields(place, design, element, kind);
        if (name === "first") this.fields(area, design, element, kind.fields.filter((field) => first.has(field.name)));
        if (name === "more") this.groups(area, design, element, kind.fields.filter((field) => !first.has(field.name)));
        if (name === "parameters") this.parameters(area, design, element, componentOf(design, part));
        if (name === "csps") this.csps(area, design, element, componentOf(design, part));
        if (name === "others") this.others(area, design, element, kind);
      });
  }

  /** Fields that are not folded: those that most missions need, and those that had a value when the form was opened, so that none
   * moves while it is filled in. @param {Element} place @param {DesignState} design @param {number} element @param {import("./schema.js").Kind} kind */
  firstFields(place, design, element, kind) {
    const isLong = kind.fields.some((field) => field.group);
    const known = this.first.get(place) ?? new Set(kind.fields.filter((field) => field.required || !isLong || usual.has(field.name) ||
      given(design, element, field.name) !== undefined).map((field) => field.name));
    this.first.set(place, known);
    return known;
  }

  /** @param {Element} place @param {DesignState} design @param {number} element @param {Field[]} fields */
  fields(place, design, element, fields) {
    sync(place, fields, (field) => field.name, (field) => this.field(field), (row, field) => {
      row.dataset.element = String(element);
      const value = given(design, element, field.name);
      const from = inherited(design, element, field.name);
      const missing = field.required ? "" : from !== undefined ? `${from} (inherited)` : field.fallback;
      if (field.choices.length) fillChoice(row.querySelector("select"), [...field.choices, ...variablesOf(design, field.choices)], value, missing);
      else fillInput(row.querySelector("input"), value, missing);
    });
  }

  /** @param {Field} field */
  field(field) {
    const ask = (/** @type {Event} */ event, /** @type {boolean} */ later) => {
      const input = /** @type {HTMLInputElement} */ (event.target);
      const element = Number(/** @type {HTMLElement} */ (input.closest("[data-element]")).dataset.element);
      this.edit("set", { element, attribute: field.name, value: input.value === "" ? null : input.value }, later);
    };
    const input = field.choices.length ? h("select", { onchange: (/** @type {Event} */ event) => ask(event, false) })
      : h("input", { autocomplete: "off", spellcheck: "false", oninput: (/** @type {Event} */ event) => ask(event, true) });
    return row(field.name, input, [field.documentation, field.hint].filter(Boolean).join(" "), field.required);
  }

  /** Fields that few missions need, folded. @param {Element} place @param {DesignState} design @param {number} element @param {Field[]} fields */
  groups(place, design, element, fields) {
    const names = [...new Set(fields.map((field) => field.group))];
    sync(place, names, (name) => name, (name) => h("details", {}, h("summary", {}, name || "More"), h("div")),
      (details, name) => this.fields(details.children[1], design, element, fields.filter((field) => field.group === name)));
  }

  /** Those that the component has, those that are given, and a way to others of the dictionary.
   * @param {Element} place @param {DesignState} design @param {number} element @param {import("./design.js").ComponentState|undefined} component */
  parameters(place, design, element, component) {
    const values = new Map(childrenOf(design, element, "parameter").map((each) => [given(design, each, "name") ?? "", given(design, each, "value") ?? ""]));
    const known = component?.parameters ?? [];
    const others = [...values.keys()].filter((name) => !known.some((each) => each.name === name)).map((name) => ({ name, required: false }));
    const all = [...known, ...others];
    if (!place.firstChild) place.append(h("h3", {}, "Parameters"), h("div"), h("p", { class: "acts" }));
    set(place.children[0], "hidden", !all.length);
    sync(place.children[1], all, (each) => each.name, (each) => this.parameter(each.name, each.required, design), (line, each) => {
      line.dataset.element = String(element);
      const meaning = design.dictionary.find((entry) => entry.name === each.name);
      fillInput(line.querySelector("input"), values.get(each.name), each.required ? "" : meaning?.unit ? `in ${meaning.unit}` : "");
    });
    const isFree = component && !component.interfaces.length && !known.length;
    const left = isFree ? design.dictionary.filter((entry) => !values.has(entry.name)).map((entry) => entry.name) : [];
    chooser(place.children[2], "Add a parameter", left, (name) => name, (name) => this.edit("parameter", { element, name, value: "" }));
  }

  /** @param {string} name @param {boolean} required @param {DesignState} design */
  parameter(name, required, design) {
    const meaning = design.dictionary.find((entry) => entry.name === name);
    const id = `values-${(lastHelp += 1)}`;
    const choices = [...(meaning?.type === "boolean" ? ["true", "false"] : []), ...variablesOf(design)];
    const input = h("input", { autocomplete: "off", spellcheck: "false", list: choices.length ? id : null, oninput: (/** @type {Event} */ event) => {
      const { value } = /** @type {HTMLInputElement} */ (event.target);
      const element = Number(/** @type {HTMLElement} */ (input.closest("[data-element]")).dataset.element);
      this.edit("parameter", { element, name, value: value === "" ? null : value }, true);
    } });
    const range = meaning ? [meaning.minimum.map((least) => `at least ${least}`), meaning.maximum.map((most) => `at most ${most}`)].flat().join(", ") : "";
    const facts = meaning ? [meaning.type, meaning.unit && `in ${meaning.unit}`, range].filter(Boolean).join(", ") : "the dictionary does not have it";
    const made = row(name, input, `${facts}. ${meaning?.documentation ?? ""}`, required);
    if (choices.length) made.append(h("datalist", { id }, ...choices.map((value) => h("option", { value }))));
    return made;
  }

  /** @param {Element} place @param {DesignState} design @param {number} element @param {import("./design.js").ComponentState|undefined} owner */
  csps(place, design, element, owner) {
    if (!place.firstChild) place.append(h("h3", {}, "CSPs"), h("div"), h("p", { class: "acts" }));
    const children = childrenOf(design, element, "csp");
    const free = owner ? design.components.filter((component) => fits(owner, component)) : [];
    set(place.children[0], "hidden", !children.length && !owner?.subcomponents.length);
    this.nested(place.children[1], design, children);
    const named = new Map(free.map((component) => [`${component.name} (${component.interfaces.map(short).join(", ")}), ${component.reference}`, component.file]));
    chooser(place.children[2], "Add a CSP", [...named.keys()], (name) => name, (name) => this.edit("add_csp", { element, component: named.get(name) }));
  }

  /** All that may stand in the element and is no field, parameter, CSP or box.
   * @param {Element} place @param {DesignState} design @param {number} element @param {import("./schema.js").Kind} kind */
  others(place, design, element, kind) {
    const names = kind.children.filter((name) => !apart.has(name));
    if (!place.firstChild) place.append(h("div"), h("p", { class: "acts" }));
    this.nested(place.children[0], design, childrenOf(design, element).filter((child) => names.includes(design.elements[child].name)));
    chooser(place.children[1], `Add to this ${kind.name}`, names, (name) => name, (child) => {
      const required = this.schema.kind(child)?.fields.filter((field) => field.required) ?? [];
      const taken = new Set(design.elements.map((_, i) => given(design, i, "name")));
      let number = 1;
      while (taken.has(`${child}_${number}`)) number += 1;
      this.edit("add", { element, child, attributes: Object.fromEntries(required.map((field) => [field.name, field.name === "name" ? `${child}_${number}` : ""])) });
    });
  }

  /** Elements in this one, each with its own form. A new one, without a name, is open. @param {Element} place @param {DesignState} design @param {number[]} elements */
  nested(place, design, elements) {
    const known = place.childElementCount > 0;
    const counts = /** @type {Record<string, number>} */ ({});
    const keyed = elements.map((element) => { // a CSP is the same as long as its component is
      const kind = `${design.elements[element].name} ${design.parts.find((part) => part.element === element)?.description ?? ""}`;
      return { element, key: `${kind} ${counts[kind] = (counts[kind] ?? 0) + 1}` };
    });
    sync(place, keyed, ({ key }) => key, ({ element }) => {
      const made = h("details", { open: known && design.elements[element].name !== "csp" }, h("summary"), h("div"),
        h("p", { class: "acts" }, h("button", { type: "button", onclick: () => this.edit("remove", { element: Number(made.dataset.element) }) }, "Remove")));
      return made;
    }, (details, { element }) => {
      details.dataset.element = String(element);
      const title = design.parts.find((part) => part.element === element)?.csp || given(design, element, "name") || given(design, element, "file") || given(design, element, "value") || "";
      setText(details.children[0], `${design.elements[element].name} ${title}`);
      set(details, "class", design.findings.some((finding) => finding.severity === "error" && isIn(design, finding.element, element)) ? "bad" : "");
      this.show(details.children[1], design, element);
    });
  }
}

let lastHelp = 0;

/** @param {string} name @param {HTMLElement} input @param {string} help @param {boolean} required */
export function row(name, input, help, required = false) {
  const id = `help-${(lastHelp += 1)}`;
  if (help) set(input, "aria-describedby", id);
  if (required) set(input, "aria-required", "true");
  return h("div", { class: "field", title: help }, h("label", {}, h("span", { class: required ? "required" : "" }, name, required ? h("span", { "aria-hidden": "true" }, " *") : null), input),
    help ? h("small", { id }, help) : null);
}

/** Not while somebody types there. @param {HTMLInputElement} input @param {string|undefined} value @param {string} missing */
function fillInput(input, value, missing) {
  set(input, "placeholder", missing);
  if (input !== document.activeElement && input.value !== (value ?? "")) input.value = value ?? "";
}

/** The same for a choice, which arrow keys go through. @param {HTMLSelectElement} select @param {string[]} choices @param {string|undefined} value @param {string} missing */
function fillChoice(select, choices, value, missing) {
  const all = value === undefined || choices.includes(value) ? choices : [...choices, value];
  sync(select, ["", ...all], (each) => each, (each) => h("option", { value: each }), (option, each) => setText(option, each || (missing ? `default: ${missing}` : "–")));
  if (select !== document.activeElement && select.value !== (value ?? "")) select.value = value ?? "";
}

/** A choice with a button that does something with it. @param {Element} place @param {string} label @param {string[]} names @param {(name: string) => string} key @param {(name: string) => void} chosen */
function chooser(place, label, names, key, chosen) {
  if (!place.firstChild) {
    const select = /** @type {HTMLSelectElement} */ (h("select"));
    place.append(h("label", {}, h("span", {}, label), select), h("button", { type: "button" }, "Add"));
  }
  const [, button] = place.children;
  const select = /** @type {HTMLSelectElement} */ (place.querySelector("select"));
  /** @type {HTMLElement} */ (button).onclick = () => select.value && chosen(select.value);
  set(button, "aria-label", label);
  set(place, "hidden", !names.length);
  sync(select, names, key, (name) => h("option", { value: name }, name));
}

/** `${NAME}` of each variable, or of those with one of the values. @param {DesignState} design @param {string[]} [values] @returns {string[]} */
function variablesOf(design, values) {
  return design.elements.flatMap((each, i) => (each.name === "variable" && given(design, i, "name") &&
    (!values || values.includes(given(design, i, "default") ?? "")) ? [`\${${given(design, i, "name")}}`] : []));
}
