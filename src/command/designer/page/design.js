// The design of a mission, as the server sends it (design_state.idl), with questions to it.
import { short } from "./words.js";

/** @typedef {{name: string, value: string}} GivenValue */
/** @typedef {{name: string, parent: number, line: number, attributes: GivenValue[]}} ElementState */
/** @typedef {{severity: "error"|"warning"|"note", place: string, element: number, problem: string, remedy: string}} FindingState */
/** @typedef {{file: string, reference: string, name: string, interfaces: string[], dependencies: string[], subcomponents: string[],
 *   parameters: {name: string, required: boolean}[], attributes: GivenValue[], failure: string}} ComponentState */
/** @typedef {{name: string, type: string, unit: string, minimum: number[], maximum: number[], documentation: string}} MeaningState */
/** @typedef {{element: number, entity: string, csp: string, description: string}} PartState */
/** @typedef {{kind: "new"|"gone"|"changed", entity: string, whole: boolean, text: string}} DifferenceState */
/** @typedef {{file: string, text: string, version: number, changed: boolean, checked: boolean, disk: ""|"changed"|"gone", undo: string, redo: string,
 *   flight: string, compared: string, differences: DifferenceState[], troubles: string[], elements: ElementState[], parts: PartState[], findings: FindingState[], components: ComponentState[],
 *   dictionary: MeaningState[], entities: import("./state.js").EntityState[], links: import("./state.js").Link[]}} DesignState */

/** As a domain on which nothing has been seen; what it is compared with has marked boxes. @param {DesignState} design @returns {import("./state.js").DomainState} */
export function pictureOf(design) {
  const entities = design.entities.map((entity) => {
    const own = design.differences.filter((each) => each.entity === entity.name);
    return { ...entity, mark: own.some((each) => each.whole && each.kind === "new") ? "new" : own.length ? "changed" : "" };
  });
  const below = Math.max(0, ...entities.map((each) => each.y + each.height)) + 70;
  const gone = design.differences.filter((each) => each.whole && each.kind === "gone" && each.entity);
  gone.forEach(({ entity }, i) => entities.push({ name: entity, system: entity.slice(0, entity.indexOf("/")), state: "removed", reason: `${design.compared} has it`,
    process: "", launcher: 0, pid: 0, host: "", program: "", vendor: "", version: "", cpu: [], memory: 0, threads: 0, services: [],
    x: 240 * i, y: below, width: 208, height: 50, mark: "" }));
  return { domain: 0, place: "", plan: design.file, faults: false, time: 0, troubles: design.troubles, missions: [],
    entities, links: design.links, decisions: [], log: [] };
}

/** @param {DesignState} design @param {number} element @param {string} name */
export function given(design, element, name) {
  return design.elements[element]?.attributes.find((each) => each.name === name)?.value;
}

/** The elements in one, by their numbers. @param {DesignState} design @param {number} parent @param {string} [name] @returns {number[]} */
export function childrenOf(design, parent, name) {
  return design.elements.flatMap((each, i) => (each.parent === parent && (!name || each.name === name) ? [i] : []));
}

/** @param {DesignState} design @param {number} element @param {number} around */
export function isIn(design, element, around) {
  for (; element >= 0; element = design.elements[element].parent) if (element === around) return true;
  return false;
}

/** The value that an element has from those around it. @param {DesignState} design @param {number} element @param {string} name */
export function inherited(design, element, name) {
  if (name === "name") return undefined;
  for (let at = design.elements[element]?.parent ?? -1; at >= 0; at = design.elements[at].parent) {
    const value = given(design, at, name);
    if (value !== undefined) return value;
  }
  return undefined;
}

/** @param {DesignState} design @param {PartState|undefined} part @returns {ComponentState|undefined} */
export function componentOf(design, part) {
  return part?.description ? design.components.find((each) => each.file === part.description) : undefined;
}

/** The entity of an element with a finding; empty: none. @param {DesignState} design @param {number} element */
export function entityAt(design, element) {
  for (let at = element; at >= 0; at = design.elements[at].parent) {
    const part = design.parts.find((each) => each.element === at);
    if (part) return part.entity;
  }
  return "";
}

/** Which slots of an entity a component fits. @param {ComponentState|undefined} owner @param {ComponentState} component */
export function fits(owner, component) {
  return !component.failure && Boolean(owner?.subcomponents.some((slot) => component.interfaces.includes(slot)));
}

/** Whether a component is of use only as a CSP of others. @param {DesignState} design @param {ComponentState} component */
export function isCsp(design, component) {
  return component.interfaces.length > 0 && component.interfaces.every((each) => design.components.some((owner) => owner.subcomponents.includes(each)));
}

/** A component in a line. @param {ComponentState} component */
export function summaryOf(component) {
  const list = (/** @type {string} */ what, /** @type {string[]} */ names) => (names.length ? `${what} ${names.map(short).join(", ")}` : "");
  return component.failure || [list("implements", component.interfaces), list("needs", component.dependencies), list("CSPs for", component.subcomponents),
    component.attributes.map((each) => `${each.name} ${each.value}`).join(", ")].filter(Boolean).join(" · ") || "implements and needs nothing";
}
