// The elements and attributes of a mission with their meaning, read from the XML schema for editors.

/** @typedef {{name: string, required: boolean, group: string, documentation: string, fallback: string, choices: string[], hint: string}} Field */
/** @typedef {{name: string, documentation: string, fields: Field[], children: string[]}} Kind */

/** The titles of groups of attributes. */
const groups = /** @type {Record<string, string>} */ ({
  DefaultsOfPeers: "System, host and network", ProcessAttributes: "Process", ThreadAttributes: "Threads", HeadAttributes: "Choice among CSPs",
});

/** @param {Element|undefined} element @param {string} name @returns {Element[]} */
const all = (element, name) => [...(element?.children ?? [])].filter((each) => each.localName === name);

/** @param {Element|undefined} element */
function documentation(element) {
  const text = all(all(element, "annotation")[0], "documentation")[0]?.textContent ?? "";
  return text.replace(/[`*]/g, "").replace(/\s+/g, " ").trim();
}

export class Schema {
  /** @param {string} text */
  constructor(text) {
    this.root = new DOMParser().parseFromString(text, "application/xml").documentElement;
    /** @type {Map<string, Kind>} */
    this.kinds = new Map();
  }

  /** @param {string} kind @param {string|null} name @returns {Element|undefined} */
  named(kind, name) {
    return all(this.root, kind).find((each) => each.getAttribute("name") === name);
  }

  /** The rules for an element; null: it is unknown. @param {string} name @returns {Kind|null} */
  kind(name) {
    const known = this.kinds.get(name);
    if (known) return known;
    const element = this.named("element", name) ?? [...this.root.getElementsByTagNameNS(this.root.namespaceURI, "element")]
      .find((each) => each.getAttribute("name") === name);
    const type = all(element, "complexType")[0] ?? this.named("complexType", element?.getAttribute("type") ?? "");
    if (!type) return null;
    const kind = {
      name, documentation: documentation(element) || documentation(type), fields: this.fields(type, ""),
      children: all(all(type, "choice")[0], "element").map((each) => each.getAttribute("name") ?? ""),
    };
    this.kinds.set(name, kind);
    return kind;
  }

  /** @param {Element} around @param {string} group @returns {Field[]} */
  fields(around, group) {
    return [...around.children].flatMap((each) => {
      if (each.localName === "attribute") return [this.field(each, group)];
      if (each.localName !== "attributeGroup") return [];
      const name = each.getAttribute("ref") ?? "";
      const inner = this.named("attributeGroup", name);
      return inner ? this.fields(inner, groups[name] ?? group) : [];
    });
  }

  /** @param {Element} attribute @param {string} group @returns {Field} */
  field(attribute, group) {
    const text = documentation(attribute);
    const type = this.named("simpleType", attribute.getAttribute("type"));
    const union = all(type, "union")[0];
    const members = all(union, "simpleType");
    const values = members.map((each) => all(all(each, "restriction")[0], "enumeration").map((value) => value.getAttribute("value") ?? ""));
    const isChoice = union?.getAttribute("memberTypes") === "WithVariable" && values.length > 0 && values.every((each) => each.length);
    return {
      name: attribute.getAttribute("name") ?? "", required: attribute.getAttribute("use") === "required", group,
      documentation: text, fallback: /Default: (.*)\.$/.exec(text)?.[1] ?? "", choices: isChoice ? values.flat() : [], hint: documentation(type),
    };
  }
}
