// What makes and updates the elements of the page. Text goes in as text, never as markup.

/**
 * @param {string} tag
 * @param {Record<string, any>} [attributes] `onclick` and the like are listeners; undefined, null and false leave an attribute out.
 * @param {...(Node|string|null|undefined)} children
 * @returns {HTMLElement}
 */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) set(element, name, value);
  for (const child of children) if (child !== null && child !== undefined) element.append(child);
  return element;
}

/** @param {string} tag @param {Record<string, any>} [attributes] @returns {SVGElement} */
export function svg(tag, attributes = {}) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) set(element, name, value);
  return element;
}

/**
 * Sets an attribute or a listener, if it is not so already.
 * @param {Element} element
 * @param {string} name
 * @param {any} value
 */
export function set(element, name, value) {
  if (name.startsWith("on")) {
    element.addEventListener(name.slice(2), value);
  } else if (value === undefined || value === null || value === false) {
    if (element.hasAttribute(name)) element.removeAttribute(name);
  } else {
    const text = value === true ? "" : String(value);
    if (element.getAttribute(name) !== text) element.setAttribute(name, text);
  }
}

/** @param {Element} element @param {string} text */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * Makes the children of a parent those of the items, in their order. A child lives as long as its item's key, so that what a user
 * has focused, opened or scrolled stays.
 * @template T
 * @param {Element} parent
 * @param {T[]} items
 * @param {(item: T) => string} key
 * @param {(item: T) => Element} create
 * @param {(element: any, item: T) => void} [update]
 */
export function sync(parent, items, key, create, update) {
  const before = childrenOf.get(parent) ?? new Map();
  const now = new Map();
  const wanted = new Set(items.map(key));
  // First of all, so that those that stay need not be moved, which would take the focus from them.
  for (const [name, element] of before) if (!wanted.has(name)) element.remove();
  let place = parent.firstElementChild;
  for (const item of items) {
    const name = key(item);
    if (now.has(name)) continue;
    const element = before.get(name) ?? create(item);
    now.set(name, element);
    if (update) update(element, item);
    if (element === place) place = element.nextElementSibling;
    else parent.insertBefore(element, place);
  }
  childrenOf.set(parent, now);
}

/** @type {WeakMap<Element, Map<string, Element>>} */
const childrenOf = new WeakMap();
