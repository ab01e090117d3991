// What the scripts of pages draw with: a record in JSON, text, SVG, and a map of the ground. The page's own script follows, and calls start().
// All text of the record becomes text nodes: nothing of it is markup.
const record = JSON.parse(document.getElementById("record").textContent);
const $ = id => document.getElementById(id);
const {ground} = record;
const rows = ground.columns ? Math.floor(ground.heights_m.length / ground.columns) : 0;
const map = {};

function put(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) if (value !== undefined) node.setAttribute(name, value);
  node.append(...children.filter(child => child !== undefined));
  return node;
}
const html = (name, attributes, ...children) => put(document.createElement(name), attributes, children);
const svg = (name, attributes, ...children) => put(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
const fixed = (value, digits, unit) => value === null || value === undefined ? "–" : `${value.toFixed(digits)} ${unit}`.trim();
const dark = () => document.documentElement.dataset.theme === "dark";
const line = points => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
const least = values => values.reduce((a, b) => Math.min(a, b)), most = values => values.reduce((a, b) => Math.max(a, b));

/// What the page is about, and its first line, which a narrow page breaks between its points.
function drawHead(title, points) {
  document.title = `${title}: ${points.join(" · ")}`;
  $("head").firstChild.textContent = title;
  points.forEach((point, i) => $("head").lastChild.append(...(i ? [html("span", {class: "point"}, " · "), html("span", {}, point)] : [html("span", {class: "verdict"}, point)])));
}

function groundHeight(north, east, h = ground.heights_m) {
  const u = (east - ground.west_m) / ground.spacing_m, v = (north - ground.south_m) / ground.spacing_m;
  const column = Math.min(Math.max(Math.floor(u), 0), ground.columns - 2), row = Math.min(Math.max(Math.floor(v), 0), rows - 2);
  const x = Math.min(Math.max(u - column, 0), 1), y = Math.min(Math.max(v - row, 0), 1), i = row * ground.columns + column;
  return (1 - y) * ((1 - x) * h[i] + x * h[i + 1]) + y * ((1 - x) * h[i + ground.columns] + x * h[i + ground.columns + 1]);
}

/// Tinted by height, lit from the north-west, with contour lines; red is what is seen, if the record tells it.
function relief(view) {
  const width = 720, height_m = view.north - view.south, width_m = view.east - view.west, height = Math.max(Math.round(width * height_m / width_m), 1);
  const canvas = html("canvas", {width, height}), context = canvas.getContext("2d"), image = context.createImageData(width, height);
  const low = least(ground.heights_m), high = Math.max(most(ground.heights_m), low + 1), step = [10, 20, 25, 50, 100, 200, 500, 1000].find(each => (high - low) / each <= 12) ?? 2000;
  const tints = dark() ? [[30, 38, 37], [44, 50, 43], [66, 64, 52], [92, 85, 72]] : [[229, 234, 221], [223, 224, 199], [214, 203, 170], [200, 182, 150]];
  const cell = width_m / width, heights = new Float32Array(width * height);
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x)
    heights[y * width + x] = groundHeight(view.north - (y + 0.5) * height_m / height, view.west + (x + 0.5) * cell);
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) {
    const h = heights[y * width + x], right = heights[y * width + Math.min(x + 1, width - 1)], below = heights[Math.min(y + 1, height - 1) * width + x];
    const tone = (h - low) / (high - low) * (tints.length - 1), k = Math.min(Math.floor(tone), tints.length - 2), share = tone - k;
    let light = 1 + Math.min(Math.max(((right - h) + (below - h)) / cell * 1.6, -0.34), 0.22);
    if (Math.floor(h / step) !== Math.floor(right / step) || Math.floor(h / step) !== Math.floor(below / step)) light *= dark() ? 1.22 : 0.9;
    const seen = ground.seen ? 0.006 * groundHeight(view.north - (y + 0.5) * height_m / height, view.west + (x + 0.5) * cell, ground.seen) : 0;
    for (let c = 0; c < 3; ++c) image.data[4 * (y * width + x) + c] = (1 - seen) * light * (tints[k][c] + share * (tints[k + 1][c] - tints[k][c])) + seen * [199, 13, 56][c];
    image.data[4 * (y * width + x) + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return canvas.toDataURL();
}

/// The ground of `view` in #map, which is empty else; names are placed when all is drawn.
function beginMap(view, contents) {
  const root = $("map"), width = Math.max(root.clientWidth, 280), width_m = view.east - view.west, height_m = view.north - view.south, scale = width / width_m, height = height_m * scale, names = [];
  map.xy = ([north, east]) => [(east - view.west) * scale, (view.north - north) * scale];
  map.paint = () => $("relief").setAttribute("href", relief(view));
  root.setAttribute("viewBox", `0 0 ${width} ${height.toFixed(1)}`);
  root.setAttribute("aria-label", `Map, ${(width_m / 1000).toFixed(0)} by ${(height_m / 1000).toFixed(0)} km, with ${contents}`);
  root.replaceChildren(
    svg("defs", {}, svg("pattern", {id: "hatch", width: 8, height: 8, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)"}, svg("path", {d: "M0 0v8", class: "hatch"}))),
    svg("image", {id: "relief", width, height, preserveAspectRatio: "none"}));
  map.paint();
  return {scale, width, height,
    name(x, y, text) { names.push({x, y, node: svg("text", {class: "halo"}, text)}); return names.at(-1).node; },
    show(...all) {
      root.append(...all, ...scaleBar(scale, width, height));
      placeNames(names.reverse(), width, height);
    }};
}
const siteMark = (x, y) => svg("path", {class: "site", d: `M${x} ${y - 7}l6.5 11h-13z`});

/// Beside what they name, inside the map, and not over each other where there is room; those first that come first.
function placeNames(names, width, height) {
  const taken = names.map(({x, y}) => ({x: x - 7, y: y - 7, width: 14, height: 14}));
  taken.push({x: width - 40, y: 0, width: 40, height: 56});  // where north is
  const apart = (one, other) => one.x + one.width <= other.x || other.x + other.width <= one.x || one.y + one.height <= other.y || other.y + other.height <= one.y;
  for (const {x, y, node} of names) {
    const at = {x: Math.min(Math.max(x, 0), width), y: Math.min(Math.max(y, 0), height)};
    const places = [[10, 4, "start"], [-10, 4, "end"], [0, -11, "middle"], [0, 21, "middle"], [10, 21, "start"], [-10, 21, "end"], [10, 39, "start"], [-10, 39, "end"], [-10, -14, "end"], [10, -14, "start"], [-10, 74, "end"]];
    const put = ([right, down, anchor]) => {
      for (const [key, value] of Object.entries({x: at.x + right, y: at.y + down, "text-anchor": anchor})) node.setAttribute(key, value);
      return node.getBBox();
    };
    const inside = places.filter(place => { const box = put(place); return box.x > 2 && box.y > 2 && box.x + box.width < width - 2 && box.y + box.height < height - 2; });
    taken.push(put(inside.find(place => taken.every(each => apart(put(place), each))) ?? inside[0] ?? places[0]));
  }
}
function scaleBar(scale, width, height) {
  const metres = [1, 2, 5, 10, 20, 50, 100].map(km => km * 1000).filter(m => m * scale < width / 4).at(-1) ?? 500;
  const y = height - 16;
  return [svg("path", {d: `M16 ${y - 5}v5h${metres * scale}v-5`, fill: "none", stroke: "var(--ink)", "stroke-width": 1.6}),
    svg("text", {class: "halo", x: 16 + metres * scale / 2, y: y - 8, "text-anchor": "middle"}, `${metres / 1000} km`),
    svg("path", {d: `M${width - 22} 14l6 18l-6 -4l-6 4z`, fill: "var(--ink)", stroke: "var(--halo)"}),
    svg("text", {class: "halo", x: width - 22, y: 46, "text-anchor": "middle"}, "N")];
}

/// Each entry: what it shows (a path's data, or nothing for a dot), its style, its text, and the class that hides it.
function drawLegend(...entries) {
  for (const [path, style, text, hides] of entries) {
    const sign = path ? svg("path", {d: path, class: style}) : svg("circle", {cx: 10, cy: 6, r: 4, fill: "var(--card)", stroke: "var(--ink)", "stroke-width": 1.6});
    const box = hides ? html("input", {type: "checkbox", checked: ""}) : undefined;
    box?.addEventListener("change", () => $("map").classList.toggle(hides, !box.checked));
    $("legend").append(html(box ? "label" : "span", {}, box, svg("svg", {viewBox: "0 0 20 12"}, sign), html("span", {}, text)));
  }
}

/// Marks of round numbers on an axis, `count` at most.
function marks(from, until, count) {
  const power = 10 ** Math.floor(Math.log10((until - from) / count)), step = power * [1, 2, 5, 10].find(each => each * power * count >= until - from);
  return Array.from({length: Math.floor(until / step) - Math.ceil(from / step) + 1}, (_, i) => (Math.ceil(from / step) + i) * step);
}

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  map.paint?.();
}
/// Draws all, as light as people prefer it, and anew for each width of the window.
function start(drawAll) {
  const wantsDark = matchMedia("(prefers-color-scheme: dark)");
  let width = innerWidth;
  setTheme(wantsDark.matches ? "dark" : "light");
  drawAll();
  wantsDark.addEventListener("change", () => setTheme(wantsDark.matches ? "dark" : "light"));
  addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; drawAll(); } });
}
