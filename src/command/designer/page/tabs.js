// Pages of which one is seen, chosen by tabs above them, by mouse or arrow keys.
import { h, set, setText } from "./element.js";

export class Tabs {
  /** @param {HTMLElement} root @param {string} label @param {string[]} names @param {() => void} opened @param {...HTMLElement} above Elements above all pages. */
  constructor(root, label, names, opened, ...above) {
    this.names = names;
    this.opened = opened;
    this.open = names[0];
    this.buttons = names.map((name) => h("button", {
      type: "button", role: "tab", id: `${root.id}-tab-${name}`, "aria-controls": `${root.id}-${name}`, onclick: () => this.show(name),
      onkeydown: (/** @type {KeyboardEvent} */ event) => this.key(event),
    }, name));
    this.pages = names.map((name) => h("div", { role: "tabpanel", id: `${root.id}-${name}`, "aria-labelledby": `${root.id}-tab-${name}`, tabindex: "0" }));
    root.append(h("div", { role: "tablist", "aria-label": label }, ...this.buttons), ...above, ...this.pages);
    this.mark();
  }

  /** @param {string} name @returns {HTMLElement} */
  page(name) {
    return this.pages[this.names.indexOf(name)];
  }

  /** @param {string} name */
  show(name) {
    this.open = name;
    this.mark();
    this.opened();
  }

  /** @param {string} name @param {string} text */
  label(name, text) {
    setText(this.buttons[this.names.indexOf(name)], text);
  }

  mark() {
    this.names.forEach((each, i) => {
      set(this.buttons[i], "aria-selected", String(each === this.open));
      set(this.buttons[i], "tabindex", each === this.open ? "0" : "-1");
      set(this.pages[i], "hidden", each !== this.open);
    });
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = (this.names.indexOf(this.open) + step + this.names.length) % this.names.length;
    this.show(this.names[next]);
    this.buttons[next].focus();
  }
}
