// Draws routes over a terrain, past threats and no-fly zones.
const {routes} = record;
const view = {south: 0, west: 0, north: (rows - 1) * ground.spacing_m, east: (ground.columns - 1) * ground.spacing_m};
const kDash = 13;
const way = i => ({class: "way", style: `stroke: hsl(${[223, 24, 162, 287, 345, 48, 190, 320][i % 8]} 80% var(--way))`});

/// A zone's margin is a stroke with round corners: a wide one in the border's colour, then what is inside.
function zoneMark(zone, scale) {
  const d = line(zone.outline.map(map.xy)) + "Z", margin = 2 * zone.margin_m * scale;
  return svg("g", {class: "margin"}, svg("title", {}, zone.name), ...[["var(--threat)", margin + 2], ["var(--card)", Math.max(margin - 1, 0)], ["url(#hatch)", Math.max(margin - 1, 0)]]
    .map(([paint, width]) => svg("path", {d, fill: paint, stroke: paint, "stroke-width": width})));
}

function drawMap() {
  const {scale, name, show} = beginMap(view, "the routes, threats and no-fly zones"), all = record.zones.map(zone => zoneMark(zone, scale));
  const sites = [], add = style => ({name: title, place, range_m}) => {
    const [x, y] = map.xy(place);
    all.push(svg("circle", {class: style, cx: x, cy: y, r: range_m * scale}));
    sites.push(siteMark(x, y), name(x, y, title));
  };
  record.radars.forEach(add("route"));
  record.missiles.forEach(add("reach"));
  const paths = routes.map(route => line((route.points ?? []).map(map.xy))), draw = (i, attributes) => svg("path", {d: paths[i], ...way(i), ...attributes});
  all.push(...paths.map(d => svg("path", {d, class: "casing"})), ...paths.map((_, i) => draw(i, {})).reverse());
  // Where they run together, dashes of each take turns.
  all.push(...paths.map((_, i) => draw(i, {"stroke-dasharray": `${kDash} ${kDash * (routes.length - 1)}`, "stroke-dashoffset": -kDash * i})));
  for (const [title, place] of [["Start", record.start], ["Goal", record.goal]]) {
    const [x, y] = map.xy(place);
    all.push(svg("circle", {class: "target place", cx: x, cy: y, r: 6}), name(x, y, title));
  }
  for (const zone of record.zones) {
    const [x, y] = map.xy([0, 1].map(k => zone.outline.reduce((sum, corner) => sum + corner[k], 0) / zone.outline.length));
    all.push(name(x, y, zone.name));
  }
  show(...all, ...sites);
}

function drawProfiles() {
  const drawn = routes.filter(route => route.points), samples = drawn.flatMap(route => route.profile);
  if (!samples.length) return;
  const longest_m = most(samples.map(each => each[0])), low = least(samples.map(each => each[1])), high = most(samples.map(each => each[2])) + 20;
  const width = Math.max($("profiles").clientWidth, 280), height = 130, left = 44, bottom = height - 30;
  const x = metres => left + metres / longest_m * (width - left - 20), y = metres => bottom - (metres - low) / (high - low) * (bottom - 22);
  $("profiles").replaceChildren(...drawn.map(({label, profile}) => svg("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `Height along ${label}`},
    svg("text", {x: left, y: 14}, label),
    ...marks(0, longest_m / 1000, width / 90).flatMap(km => [svg("path", {class: "grid", d: `M${x(1000 * km).toFixed(1)} 22V${bottom}`}), svg("text", {class: "tick", x: x(1000 * km), y: height - 6, "text-anchor": "middle"}, `${km} km`)]),
    ...marks(low, high, 4).flatMap(metres => [svg("path", {class: "grid", d: `M${left} ${y(metres).toFixed(1)}H${width - 20}`}), svg("text", {class: "tick", x: left - 8, y: y(metres) + 4, "text-anchor": "end"}, metres)]),
    svg("path", {class: "ground", d: line([[x(0), bottom], ...profile.map(each => [x(each[0]), y(each[1])]), [x(profile.at(-1)[0]), bottom]]) + "Z"}),
    ...profile.slice(1).flatMap(([metres, , , seen], i) => seen ? [svg("rect", {class: "seen", x: x(profile[i][0]), y: bottom + 3, width: x(metres) - x(profile[i][0]), height: 6, opacity: 0.25 + 0.0075 * seen})] : []),
    svg("path", {...way(routes.findIndex(each => each.profile === profile)), d: line(profile.map(each => [x(each[0]), y(each[2])]))}))));
}

drawHead(record.title, record.facts);
$("routes").append(...routes.map((route, i) => html("li", {}, svg("svg", {class: "sign", viewBox: "0 0 20 12"}, svg("path", {...way(i), d: "M0 6H20"})),
  html("span", {}, html("strong", {}, route.label), html("br"), `${fixed(route.length_m / 1000, 1, "km")}, exposure ${fixed(route.exposure_m / 1000, 1, "km")}`, html("br"),
    route.points ? `at least ${fixed(route.lowest_m, 0, "m")} above ground` : "not drawn: not a route"))));
drawLegend(["M0 6H20", "route", "range of a radar"], ["M2 1H18V11H2Z", "reach", "range of missiles"], ["M2 1H18V11H2Z", "zone", "no-fly zone"],
  ["M2 1H18V11H2Z", "seen", `seen by radar ${record.above_m} m above ground`]);
start(() => { drawMap(); drawProfiles(); });
