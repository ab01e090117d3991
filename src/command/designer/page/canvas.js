// The drawing: boxes are elements, so that they can be focused and read; lines are SVG below them.
import { h, set, setText, svg, sync } from "./element.js";
import { boxesOf, isFound, linesOf } from "./state.js";
import { digits, latency, often, outcome, rate, short, stateText, time, tone } from "./words.js";

/** @typedef {import("./state.js").Box} Box */
/** @typedef {import("./state.js").Line} Line */
/** @typedef {import("./state.js").DomainState} DomainState */
/** @typedef {import("./state.js").View} View */
/** @typedef {import("./state.js").ServiceState} ServiceState */

const margin = 8;
const leastZoom = 0.05, mostZoom = 2.5;

export class Canvas {
  /**
   * @param {HTMLElement} root
   * @param {View} view
   * @param {{select: (id: string) => void, fold: (id: string) => void, move: (entity: string, x: number, y: number) => void}} act
   */
  constructor(root, view, act) {
    this.root = root;
    this.view = view;
    this.act = act;
    this.pan = { x: 0, y: 0, zoom: 1 };
    /** Whether the user has moved the view. */
    this.isPlaced = false;
    this.shown = "";
    this.selected = "";
    /** @type {Box[]} */
    this.boxes = [];
    /** @type {Line[]} */
    this.lines = [];
    /** Places of labels. @type {{x: number, y: number}[]} */
    this.labelled = [];
    /** Fingers, by pointer, and how far two of them are apart. @type {Map<number, {x: number, y: number}>} */
    this.fingers = new Map();
    this.spread = 0;
    /** Boxes that were moved, until the server has told their new place. @type {Map<string, {x: number, y: number, until: number}>} */
    this.moved = new Map();
    /** Milliseconds that a moved box waits for the server; for ever in a replay, which keeps no places. */
    this.patience = 4000;
    this.elements = /** @type {Map<string, HTMLElement>} */ (new Map());
    this.paths = /** @type {Map<string, {path: SVGElement, label: SVGElement}>} */ (new Map());
    this.frames = h("div", { class: "frames" });
    this.links = svg("svg", { class: "links", "aria-hidden": "true" });
    this.links.append(markers());
    this.lineGroup = svg("g");
    this.labelGroup = svg("g");
    this.links.append(this.lineGroup);
    this.labels = svg("svg", { class: "links above", "aria-hidden": "true" });
    this.labels.append(this.labelGroup);
    this.layer = h("div", { class: "layer" });
    this.world = h("div", { class: "world" }, this.frames, /** @type {any} */ (this.links), this.layer, /** @type {any} */ (this.labels));
    root.append(this.world);
    root.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    root.addEventListener("pointerdown", (event) => this.press(event));
    root.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.isPlaced || this.fit()).observe(root);
  }

  /** @param {DomainState} state @param {string} selected */
  show(state, selected) {
    this.state = state;
    this.selected = selected;
    this.boxes = boxesOf(state, this.view);
    for (const box of this.boxes) this.keepMoved(box);
    this.lines = linesOf(state, this.view, this.boxes, selected);
    sync(this.layer, this.boxes, (box) => box.id, (box) => this.make(box), (element, box) => this.update(element, box));
    sync(this.lineGroup, this.lines, (line) => line.id, (line) => this.makeLine(line));
    sync(this.labelGroup, this.lines, (line) => line.id, (line) => this.paths.get(line.id)?.label ?? svg("g"));
    keepOnly(this.elements, this.boxes);
    keepOnly(this.paths, this.lines);
    this.drawFrames();
    this.labelled = [];
    this.lines.forEach((line) => this.updateLine(line));
    if (!this.layer.querySelector('[tabindex="0"]')) this.roam(this.boxes[0]?.id);
    const shown = this.boxes.map((box) => `${box.id} ${box.x} ${box.y}`).join();
    if (!this.isPlaced && shown !== this.shown) this.fit();
    this.shown = shown;
  }

  /** @param {Box} box */
  keepMoved(box) {
    const place = this.moved.get(box.id);
    if (!place) return;
    if (place.until < performance.now()) this.moved.delete(box.id);
    else Object.assign(box, { x: place.x, y: place.y });
  }

  /** @param {Box} box */
  make(box) {
    const element = h("div", { class: "box" },
      h("button", {
        type: "button", class: "head", tabindex: "-1", onclick: () => this.act.select(box.id), onfocus: () => this.roam(box.id),
      }, h("span", { class: "name" }), h("span", { class: "state" })),
      h("ul", { class: "rows" }));
    element.dataset.id = box.id;
    this.elements.set(box.id, element);
    return element;
  }

  /** @param {HTMLElement} element @param {Box} box */
  update(element, box) {
    const entity = box.entity;
    set(element, "class", `box ${tone(box.state)} ${box.state}${box.id === this.selected ? " selected" : ""}` +
      `${this.state && isFound(box, this.state, this.view.search) ? " found" : ""}${entity ? "" : " system"}${entity?.mark ? ` marked-${entity.mark}` : ""}`);
    this.placeBox(element, box);
    const head = /** @type {HTMLElement} */ (element.firstElementChild);
    const name = entity ? short(entity.name) : `${box.id} (${box.members.length} entities)`;
    const busy = entity?.cpu.length ? ` · ${digits(entity.cpu[0])} % CPU` : "";
    setText(/** @type {Element} */ (head.children[0]), name);
    setText(/** @type {Element} */ (head.children[1]), box.state + (box.reason ? `: ${box.reason}` : busy));
    set(head, "title", stateText(box));
    set(head, "aria-expanded", String(!box.folded));
    set(head, "aria-current", box.id === this.selected && "true");
    const services = entity && !box.folded ? entity.services : [];
    const first = services.findIndex((each) => each.csp);
    /** @type {(ServiceState|null)[]} */
    const rows = first < 0 ? services : [...services.slice(0, first), null, ...services.slice(first)];
    sync(/** @type {Element} */ (element.children[1]), rows, (each) => (each ? `${each.name}\n${each.csp}` : "Head"),
      (each) => (each ? makeRow(each) : h("li", { class: "part" }, h("span", { class: "what" }), h("span", { class: "figures" }))),
      (row, each) => (each ? updateRow(row, each, entity ? this.lastChosen(entity.name, each) : "") : this.updateHead(row, entity?.name ?? "")));
  }

  /** The Head with its last decision. @param {HTMLElement} row @param {string} entity */
  updateHead(row, entity) {
    const last = this.state?.decisions.findLast((each) => each.entity === entity);
    setText(row.children[0], "Head");
    setText(row.children[1], last ? `${last.failure ? "failed" : "decided"} in ${time(last.took)}` : "");
    set(row, "title", last ? `${last.request}${last.failure ? `: ${last.failure}` : ""}` : "It chooses among the CSPs below");
  }

  /** How the entity's last decision on the service came out for this CSP. @param {string} entity @param {ServiceState} service */
  lastChosen(entity, service) {
    const decision = this.state?.decisions.findLast((each) => each.entity === entity && each.service === service.name);
    return decision?.attempts.find((each) => each.csp === service.csp)?.outcome ?? "";
  }

  /** @param {HTMLElement} element @param {Box} box */
  placeBox(element, box) {
    const transform = `translate(${box.x}px, ${box.y}px)`;
    if (element.style.transform !== transform) element.style.transform = transform;
    if (element.style.height !== `${box.height}px`) element.style.height = `${box.height}px`;
    element.style.width = `${box.width}px`;
  }

  drawFrames() {
    /** @type {Map<string, Box[]>} */
    const systems = new Map();
    for (const box of this.boxes) {
      if (!box.entity) continue;
      systems.set(box.entity.system, [...(systems.get(box.entity.system) ?? []), box]);
    }
    sync(this.frames, [...systems], ([system]) => system, ([system]) => h("div", { class: "frame" },
      h("button", { type: "button", title: "Fold the system to one box", onclick: () => this.act.fold(`${system}/`) }, system)),
    (element, [, boxes]) => {
      const area = framed(boxes);
      element.style.transform = `translate(${area.x}px, ${area.y}px)`;
      element.style.width = `${area.width}px`;
      element.style.height = `${area.height}px`;
    });
  }

  /** @param {Line} line */
  makeLine(line) {
    const path = svg("g", { class: "line" });
    const wide = svg("path", { class: "touch" });
    path.append(svg("path", { class: "stroke" }), wide);
    wide.addEventListener("click", () => this.act.select(line.id));
    const label = svg("text");
    this.paths.set(line.id, { path, label });
    return path;
  }

  /** @param {Line} line */
  updateLine(line) {
    const made = this.paths.get(line.id);
    if (!made) return;
    const near = line.id === this.selected || line.from.id === this.selected || line.to.id === this.selected;
    const kind = line.kind === "Calls" ? "calls" : "values";
    set(made.path, "class", `line ${kind} ${line.state}${near ? " near" : ""}`);
    const stroke = /** @type {SVGElement} */ (made.path.children[0]);
    stroke.style.strokeWidth = String((line.kind === "Calls" ? 1.6 : 1) + 0.9 * Math.log10(1 + line.rate));
    set(made.label, "class", `label ${kind}${near ? " near" : ""}`);
    const texts = labelOf(line);
    sync(made.label, texts, (text) => String(texts.indexOf(text)), () => svg("tspan"), (part, text) => setText(part, text));
    this.placeLine(line);
  }

  /** @param {Line} line */
  placeLine(line) {
    const made = this.paths.get(line.id);
    if (!made) return;
    const { path, points } = curve(line.from, line.to);
    set(made.path.children[0], "d", path);
    set(made.path.children[1], "d", path);
    const isFree = (/** @type {{x: number, y: number}} */ point) => this.boxes.every((box) => isFarFrom(box, point)) &&
      this.labelled.every((other) => Math.abs(other.x - point.x) > 120 || Math.abs(other.y - point.y) > 26);
    const middle = points.find(isFree) ?? points[0];
    if (line.kind === "Calls" || made.label.classList.contains("near")) this.labelled.push(middle);
    Array.from(made.label.children).forEach((part, i) => {
      set(part, "x", middle.x);
      set(part, "y", middle.y + 14 * i);
    });
  }

  fit() {
    if (!this.boxes.length || !this.root.clientWidth) return;
    const area = framed(this.boxes);
    const { clientWidth: width, clientHeight: height } = this.root;
    const zoom = Math.min(1, (width - 2 * margin) / area.width, (height - 2 * margin) / area.height);
    this.pan = { zoom, x: (width - area.width * zoom) / 2 - area.x * zoom, y: (height - area.height * zoom) / 2 - area.y * zoom };
    this.applyPan();
  }

  applyPan() {
    this.world.style.transform = `translate(${this.pan.x}px, ${this.pan.y}px) scale(${this.pan.zoom})`;
    this.root.classList.toggle("far", this.pan.zoom < 0.45);
  }

  /** @param {number} factor @param {{x: number, y: number}} at In the drawing's own corner. */
  zoom(factor, at) {
    const zoom = Math.min(mostZoom, Math.max(leastZoom, this.pan.zoom * factor));
    const grown = zoom / this.pan.zoom;
    this.isPlaced = true;
    this.pan = { zoom, x: at.x - (at.x - this.pan.x) * grown, y: at.y - (at.y - this.pan.y) * grown };
    this.applyPan();
  }

  /** A point of the screen in the drawing. @param {number} x @param {number} y */
  at(x, y) {
    const corner = this.root.getBoundingClientRect();
    return { x: Math.round((x - corner.x - this.pan.x) / this.pan.zoom), y: Math.round((y - corner.y - this.pan.y) / this.pan.zoom) };
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    event.preventDefault();
    const corner = this.root.getBoundingClientRect();
    this.zoom(Math.exp(-event.deltaY / 500), { x: event.clientX - corner.x, y: event.clientY - corner.y });
  }

  /** Two fingers zoom. Whether there are two. @param {PointerEvent} event */
  pinch(event) {
    if (this.fingers.has(event.pointerId)) this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (this.fingers.size !== 2) return false;
    const [one, other] = this.fingers.values(), corner = this.root.getBoundingClientRect();
    const spread = Math.hypot(one.x - other.x, one.y - other.y);
    if (this.spread && spread) this.zoom(spread / this.spread, { x: (one.x + other.x) / 2 - corner.x, y: (one.y + other.y) / 2 - corner.y });
    this.spread = spread;
    return true;
  }

  /** Drags a box, or the whole drawing. @param {PointerEvent} event */
  press(event) {
    const target = /** @type {Element} */ (event.target);
    if (event.button !== 0 || target.closest(".frame button")) return;
    this.fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (this.fingers.size > 1) return; // the first one's listeners see to both
    const id = /** @type {HTMLElement|null} */ (target.closest(".box"))?.dataset.id;
    const current = () => this.boxes.find((each) => each.id === id); // an update makes new ones
    const box = current();
    const begin = { x: event.clientX, y: event.clientY, pan: { ...this.pan }, box: box && { x: box.x, y: box.y } };
    let far = false;
    const drag = (/** @type {PointerEvent} */ now) => {
      if (this.pinch(now) || this.spread) return;
      const dx = now.clientX - begin.x, dy = now.clientY - begin.y;
      far ||= Math.hypot(dx, dy) > 4;
      if (!far) return;
      if (box && begin.box) {
        this.moveTo(current() ?? box, begin.box.x + dx / this.pan.zoom, begin.box.y + dy / this.pan.zoom);
      } else {
        this.root.classList.add("moving");
        this.isPlaced = true;
        this.pan = { ...begin.pan, x: begin.pan.x + dx, y: begin.pan.y + dy };
        this.applyPan();
      }
    };
    const drop = (/** @type {PointerEvent} */ now) => {
      this.fingers.delete(now.pointerId);
      if (this.fingers.size) return;
      this.spread = 0;
      this.root.classList.remove("moving");
      window.removeEventListener("pointermove", drag);
      window.removeEventListener("pointerup", drop);
      window.removeEventListener("pointercancel", drop);
      if (box && far) this.tellMoved(current() ?? box);
      if (far) ignoreNextClick();
      if (!box && !far && !target.closest(".line")) this.act.select("");
    };
    window.addEventListener("pointermove", drag);
    window.addEventListener("pointerup", drop);
    window.addEventListener("pointercancel", drop);
  }

  /** @param {Box} box @param {number} x @param {number} y */
  moveTo(box, x, y) {
    const shift = { x: Math.round(x) - box.x, y: Math.round(y) - box.y };
    box.x += shift.x;
    box.y += shift.y;
    if (!box.entity) for (const member of box.members) {
      member.x += shift.x;
      member.y += shift.y;
    }
    this.isPlaced = true;
    this.moved.set(box.id, { x: box.x, y: box.y, until: performance.now() + this.patience });
    const element = this.elements.get(box.id);
    if (element) this.placeBox(element, box);
    for (const line of this.lines) if (line.from === box || line.to === box) this.placeLine(line);
    this.drawFrames();
  }

  /** @param {Box} box */
  tellMoved(box) {
    for (const member of box.members) {
      const at = box.entity ? box : member;
      this.act.move(member.name, at.x, at.y);
    }
  }

  /** The box that Tab reaches. @param {string|undefined} id */
  roam(id) {
    for (const head of this.layer.querySelectorAll('.head[tabindex="0"]')) set(head, "tabindex", "-1");
    const head = id && this.elements.get(id)?.firstElementChild;
    if (head) set(head, "tabindex", "0");
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const id = /** @type {HTMLElement|null} */ (document.activeElement?.closest(".box"))?.dataset.id;
    const box = this.boxes.find((each) => each.id === id);
    const direction = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (event.ctrlKey || event.metaKey) return;
    if (direction && box && event.altKey) {
      this.moveTo(box, box.x + 20 * direction[0], box.y + 20 * direction[1]);
      this.tellMoved(box);
    } else if (direction && box) {
      this.go(box, direction);
    } else if (event.key === " " && box) {
      this.act.fold(box.id);
    } else if (event.key === "+" || event.key === "-") {
      this.zoom(event.key === "+" ? 1.2 : 1 / 1.2, { x: this.root.clientWidth / 2, y: this.root.clientHeight / 2 });
    } else if (event.key === "0") {
      this.isPlaced = false;
      this.fit();
    } else {
      return;
    }
    event.preventDefault();
  }

  /** Focuses the nearest box in a direction. @param {Box} box @param {number[]} direction */
  go(box, [dx, dy]) {
    let best, least = Infinity;
    for (const other of this.boxes) {
      const x = other.x + other.width / 2 - box.x - box.width / 2, y = other.y + other.height / 2 - box.y - box.height / 2;
      const along = x * dx + y * dy, aside = Math.abs(x * dy) + Math.abs(y * dx);
      if (other !== box && along > 0 && along + 2 * aside < least) {
        least = along + 2 * aside;
        best = other;
      }
    }
    if (best) this.focus(best.id);
  }

  /** @param {string} id */
  focus(id) {
    const head = /** @type {HTMLElement|null|undefined} */ (this.elements.get(id)?.firstElementChild);
    if (!head) return;
    head.focus({ preventScroll: true });
    this.root.scrollTo(0, 0);
    const seen = head.getBoundingClientRect(), corner = this.root.getBoundingClientRect();
    const past = (/** @type {number} */ low, /** @type {number} */ high, /** @type {number} */ from, /** @type {number} */ to) =>
      low < from ? from - low + 20 : high > to ? to - high - 20 : 0;
    this.pan.x += past(seen.left, seen.right, corner.left, corner.right);
    this.pan.y += past(seen.top, seen.bottom, corner.top, corner.bottom);
    this.applyPan();
  }
}

/** A box that was dragged is not selected by that. */
function ignoreNextClick() {
  const ignore = (/** @type {Event} */ event) => event.stopPropagation();
  window.addEventListener("click", ignore, { capture: true, once: true });
  setTimeout(() => window.removeEventListener("click", ignore, { capture: true }));
}

/** @param {Map<string, any>} made @param {{id: string}[]} wanted */
function keepOnly(made, wanted) {
  const ids = new Set(wanted.map((each) => each.id));
  for (const id of made.keys()) if (!ids.has(id)) made.delete(id);
}

/** @param {ServiceState} service */
function makeRow(service) {
  return h("li", {}, h("span", { class: "mark", "aria-hidden": "true" }), h("span", { class: "what" }),
    h("span", { class: "figures" }), h("span", { class: "unseen" }, service.csp ? "" : " service"));
}

/** @param {HTMLElement} row @param {ServiceState} service @param {string} chosen */
function updateRow(row, service, chosen) {
  set(row, "class", `${service.csp ? "csp" : "service"} ${tone(service.state)} ${service.state}${chosen ? " chosen" : ""}`);
  const isGood = chosen === "Accepted" || chosen === "Preselected";
  setText(row.children[0], chosen ? (isGood ? "✓" : "✗") : "");
  const absent = service.state === "slot" ? "no CSP for " : service.state === "needed" ? "needs " : "";
  setText(row.children[1], absent + (service.csp || short(service.name)));
  const busy = service.calls.length && service.calls[0] > 0 ? rate(service.calls) : "";
  setText(row.children[2], service.state === "ready" ? busy : service.state === "planned" || absent ? "" : service.state);
  set(row.children[0], "class", `mark${chosen && !isGood ? " failed" : ""}`);
  set(row, "title", [service.csp ? `CSP ${service.csp} of ${service.name}` : `service ${service.name}`, stateText(service),
    latency(service), chosen && `in the last decision: ${outcome(chosen)}`].filter(Boolean).join("\n"));
}

/** In two lines. @param {Line} line @returns {string[]} */
function labelOf(line) {
  const first = line.links[0];
  if (line.state === "planned") return [line.links.map((each) => short(each.name)).join(", ")];
  if (line.state !== "ready") return [`${short(first.name)}: ${line.state}`];
  const name = line.kind === "Calls" ? short(first.name) : first.name;
  const more = line.links.length > 1 ? ` +${line.links.length - 1}` : "";
  return [`${name}${more} ${often({ rate: [line.rate], total: line.total })}`, ...(line.kind === "Calls" && first.p50 ? [latency(first)] : [])];
}

/** The area of boxes with the frame around them. @param {{x: number, y: number, width: number, height: number}[]} boxes */
function framed(boxes) {
  const x = Math.min(...boxes.map((box) => box.x)) - 22, y = Math.min(...boxes.map((box) => box.y)) - 40;
  return {
    x, y, width: Math.max(...boxes.map((box) => box.x + box.width)) + 22 - x,
    height: Math.max(...boxes.map((box) => box.y + box.height)) + 22 - y,
  };
}

/** From side to side of two boxes; there and back run side by side. @param {Box} from @param {Box} to */
function curve(from, to) {
  const a = { x: from.x + from.width / 2, y: from.y + from.height / 2 }, b = { x: to.x + to.width / 2, y: to.y + to.height / 2 };
  const flat = Math.abs(b.x - a.x) > (from.width + to.width) / 2 || Math.abs(b.x - a.x) > Math.abs(b.y - a.y);
  const sign = flat ? Math.sign(b.x - a.x) || 1 : Math.sign(b.y - a.y) || 1;
  const aside = 7 * sign;
  if (flat) {
    a.x += sign * from.width / 2, b.x -= sign * (to.width / 2 + 5), a.y += aside, b.y += aside;
  } else {
    a.y += sign * from.height / 2, b.y -= sign * (to.height / 2 + 5), a.x -= aside, b.x -= aside;
  }
  const reach = Math.max(24, (flat ? Math.abs(b.x - a.x) : Math.abs(b.y - a.y)) / 2) * sign;
  const [c, d] = flat ? [{ x: a.x + reach, y: a.y }, { x: b.x - reach, y: b.y }] : [{ x: a.x, y: a.y + reach }, { x: b.x, y: b.y - reach }];
  const at = (/** @type {number} */ t) => ({
    x: (1 - t) ** 3 * a.x + 3 * (1 - t) ** 2 * t * c.x + 3 * (1 - t) * t ** 2 * d.x + t ** 3 * b.x,
    y: (1 - t) ** 3 * a.y + 3 * (1 - t) ** 2 * t * c.y + 3 * (1 - t) * t ** 2 * d.y + t ** 3 * b.y,
  });
  return { path: `M${a.x},${a.y}C${c.x},${c.y} ${d.x},${d.y} ${b.x},${b.y}`, points: [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9].map(at) };
}

/** Whether a label at the point covers nothing of the box. @param {Box} box @param {{x: number, y: number}} point */
function isFarFrom(box, point) {
  return point.x < box.x - 65 || point.x > box.x + box.width + 65 || point.y < box.y - 24 || point.y > box.y + box.height + 12;
}

function markers() {
  const made = svg("defs");
  for (const kind of ["calls", "values", "missing"]) {
    const marker = svg("marker", {
      id: `arrow-${kind}`, class: `arrow ${kind}`, viewBox: "0 0 8 8", refX: 4, refY: 4, markerWidth: 8, markerHeight: 8,
      orient: "auto", markerUnits: "userSpaceOnUse",
    });
    marker.append(svg("path", { d: "M0,0L8,4L0,8z" }));
    made.append(marker);
  }
  return made;
}
