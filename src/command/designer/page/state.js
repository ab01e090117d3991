// The state of a domain, as the server sends it (designer_state.idl), and its boxes and lines.

/** @typedef {{name: string, csp: string, state: string, reason: string, process: string, pid: number, cpu: number[], total: number,
 *   calls: number[], failed: number[], waiting: number, running: number, p50: number, p99: number}} ServiceState */
/** @typedef {{name: string, system: string, state: string, reason: string, process: string, launcher: number, pid: number,
 *   host: string, program: string, vendor: string, version: string, cpu: number[], memory: number, threads: number,
 *   services: ServiceState[], x: number, y: number, width: number, height: number, mark?: string}} EntityState */
/** @typedef {{source: string, target: string, kind: "Calls"|"Values", name: string, state: string, transport: string,
 *   reason: string, total: number, rate: number[], p50: number, p99: number}} Link */
/** @typedef {{entity: string, number: number, time: number, request: string, service: string, took: number, failure: string,
 *   attempts: {csp: string, outcome: string}[], explanation: string}} DecisionNote */
/** @typedef {{time: number, entity: string, pid: number, level: string, place: string, text: string}} LogNote */
/** @typedef {{name: string, state: string, layer: number, pid: number, restarts: number, uptime: number, last_exit: string,
 *   reason: string}} ProcessStatus */
/** @typedef {{mission: string, domain: number, launcher: number, uptime: number, degraded: boolean, ending: string,
 *   processes: ProcessStatus[], elsewhere: string[]}} MissionStatus */
/** @typedef {{domain: number, place: string, plan: string, faults: boolean, time: number, troubles: string[],
 *   missions: MissionStatus[], entities: EntityState[], links: Link[], decisions: DecisionNote[], log: LogNote[]}} DomainState */

/** The user's choices. Names of folded systems end with a slash.
 * @typedef {{values: boolean, shared: boolean, folded: Set<string>, search: string}} View */

/** A box: an entity, or a system that is folded.
 * @typedef {{id: string, entity?: EntityState, members: EntityState[], folded: boolean, x: number, y: number, width: number,
 *   height: number, state: string, reason: string}} Box */

/** All links of one kind from one box to another.
 * @typedef {{id: string, from: Box, to: Box, kind: "Calls"|"Values", links: Link[], state: string, rate: number, total: number}} Line */

const headHeight = 50;
/** A topic that more links carry is drawn on demand: everybody has one to everybody. */
const fewLinks = 5;

/** @param {EntityState[]} members @returns {{state: string, reason: string}} */
function worst(members) {
  const order = ["ready", "planned", "ended", "unplanned", "idle", "starting", "waiting"];
  const rank = (/** @type {EntityState} */ entity) => (order.indexOf(entity.state) + order.length + 1) % (order.length + 1);
  const most = members.reduce((one, other) => (rank(other) > rank(one) ? other : one));
  return ["ready", "planned"].includes(most.state) ? most : { state: most.state, reason: `${most.name}: ${most.reason}` };
}

/** @param {DomainState} state @param {View} view @returns {Box[]} */
export function boxesOf(state, view) {
  const boxes = [];
  const systems = Map.groupBy ? Map.groupBy(state.entities, (entity) => entity.system) : grouped(state.entities);
  for (const [system, members] of systems) {
    if (view.folded.has(`${system}/`)) {
      boxes.push({
        id: `${system}/`, members, folded: true, ...worst(members), width: members[0].width, height: headHeight,
        x: Math.min(...members.map((each) => each.x)), y: Math.min(...members.map((each) => each.y)),
      });
      continue;
    }
    for (const entity of members) {
      const folded = view.folded.has(entity.name);
      boxes.push({
        id: entity.name, entity, members: [entity], folded, state: entity.state, reason: entity.reason, x: entity.x, y: entity.y,
        width: entity.width, height: folded ? headHeight : entity.height,
      });
    }
  }
  return boxes;
}

/** @param {EntityState[]} entities @returns {Map<string, EntityState[]>} */
function grouped(entities) {
  const systems = new Map();
  for (const entity of entities) systems.set(entity.system, [...(systems.get(entity.system) ?? []), entity]);
  return systems;
}

/** Topics that are not drawn, since they have too many links. @param {DomainState} state @returns {Set<string>} */
export function sharedTopics(state) {
  const counts = new Map();
  for (const link of state.links) if (link.kind === "Values") counts.set(link.name, (counts.get(link.name) ?? 0) + 1);
  return new Set([...counts].filter(([, count]) => count > fewLinks).map(([name]) => name));
}

/**
 * @param {DomainState} state
 * @param {View} view
 * @param {Box[]} boxes
 * @param {string} selected All links of this box are drawn; may be empty.
 * @returns {Line[]}
 */
export function linesOf(state, view, boxes, selected) {
  /** @type {Map<string, Box>} */
  const homes = new Map();
  for (const box of boxes) for (const member of box.members) homes.set(member.name, box);
  const shared = view.shared ? new Set() : sharedTopics(state);
  /** @type {Map<string, Line>} */
  const lines = new Map();
  for (const link of state.links) {
    const from = homes.get(link.source), to = homes.get(link.target);
    if (!from || !to || from === to) continue;
    const wanted = from.id === selected || to.id === selected;
    if (link.kind === "Values" && !wanted && (!view.values || shared.has(link.name))) continue;
    const id = `${from.id}\n${to.id}\n${link.kind}`;
    const line = lines.get(id) ?? { id, from, to, kind: link.kind, links: [], state: "ready", rate: 0, total: 0 };
    line.links.push(link);
    line.rate += link.rate[0] ?? 0;
    line.total += link.total;
    if (link.state !== "ready") line.state = link.state;
    lines.set(id, line);
  }
  return [...lines.values()];
}

/** How well a box matches a search: 2 by its name, 1 by its parts, 0 not. @param {Box} box @param {DomainState} state @param {string} search @returns {number} */
export function isFound(box, state, search) {
  const wanted = search.trim().toLowerCase();
  if (!wanted) return 0;
  const has = (/** @type {string} */ text) => text.toLowerCase().includes(wanted);
  if (box.members.some((entity) => has(entity.name))) return 2;
  return Number(box.members.some((entity) => entity.services.some((each) => has(each.name) || has(each.csp)) ||
    state.links.some((link) => (link.source === entity.name || link.target === entity.name) && has(link.name))));
}
