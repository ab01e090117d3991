// The same as the drawing, in tables.
import { h, set, setText, sync } from "./element.js";
import { digits, latency, rate, size, stateText, tone } from "./words.js";

/** @typedef {import("./state.js").DomainState} DomainState */

/** @type {Record<string, string[]>} */
const columns = {
  Entities: ["Entity", "State", "CPU %", "Memory", "Process"],
  "Services and CSPs": ["Service", "Of", "State", "Calls", "Fail", "Takes"],
  "Calls and topics": ["From", "To", "What", "Rate", "Takes", "By"],
};

/** @param {HTMLElement} root @param {DomainState} state @param {string} search @param {(id: string) => void} select */
export function showTables(root, state, search, select) {
  const wanted = search.trim().toLowerCase();
  /** @type {Record<string, {key: string, tone: string, cells: string[], id: string}[]>} */
  const rows = {
    Entities: state.entities.map((each) => ({ key: each.name, tone: tone(each.state), id: each.name, cells: [each.name, stateText(each),
      each.cpu.length ? digits(each.cpu[0]) : "–", each.memory ? size(each.memory) : "–", each.pid ? String(each.pid) : "–"] })),
    "Services and CSPs": state.entities.flatMap((entity) => entity.services.map((each) => ({
      key: `${entity.name} ${each.name} ${each.csp}`, tone: tone(each.state), id: entity.name,
      cells: [each.csp ? `${each.csp} (CSP of ${each.name})` : each.name, entity.name, stateText(each), rate(each.calls), rate(each.failed), latency(each) || "–"] }))),
    "Calls and topics": state.links.map((each) => ({
      key: `${each.source} ${each.target} ${each.kind} ${each.name} ${each.transport}`, tone: tone(each.state), id: `${each.source}\n${each.target}\n${each.kind}`,
      cells: [each.source, each.target, `${each.name}${each.state === "ready" ? "" : ` (${each.state})`}`, rate(each.rate),
        each.kind === "Calls" ? latency(each) || "–" : "–", each.kind === "Calls" ? each.transport || "–" : "topic"] })),
  };
  sync(root, Object.keys(columns), (name) => name, makeTable, (table, name) => {
    const shown = rows[name].filter((row) => !wanted || row.cells.some((cell) => cell.toLowerCase().includes(wanted)));
    sync(table.children[2], shown, (row) => row.key, (row) => makeRow(row.cells, () => select(row.id)), (element, row) => {
      set(element, "class", row.tone);
      row.cells.forEach((cell, i) => setText(i ? element.children[i] : element.children[0].firstElementChild, cell));
    });
  });
}

/** @param {string} name */
function makeTable(name) {
  return h("table", {}, h("caption", {}, name),
    h("thead", {}, h("tr", {}, ...columns[name].map((column) => h("th", { scope: "col" }, column)))), h("tbody"));
}

/** @param {string[]} cells @param {() => void} select */
function makeRow(cells, select) {
  return h("tr", {}, h("th", { scope: "row" }, h("button", { type: "button", class: "plain", onclick: select })),
    ...cells.slice(1).map(() => h("td")));
}
