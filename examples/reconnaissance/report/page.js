// Draws the record of a mission.
const {track} = record;
const begin = track.time_s[0] ?? 0, end = Math.max(track.time_s.at(-1) ?? 0, record.phases.at(-1)?.from_s ?? 0, begin + 1);
const kEarth_m = 6371000 * 4 / 3;  // as radar sees it
const kLevels_m = [150, 600];
let now = begin, chosen = -1;

// ---- small tools
const two = number => String(number).padStart(2, "0");
const clock = seconds => `${two(Math.floor(seconds / 60))}:${two(Math.floor(seconds % 60))}`;
const span = seconds => seconds < 0.001 ? `${(seconds * 1e6).toFixed(0)} µs` : seconds < 1 ? `${(seconds * 1000).toPrecision(3)} ms` : `${seconds.toFixed(1)} s`;
const words = name => name.replace(/([a-z])([A-Z])/g, (_, a, b) => `${a} ${b.toLowerCase()}`).replaceAll("_", " ");
const last = (list, time) => { let found = -1; list.forEach((each, i) => { if (each.from_s <= time) found = i; }); return found; };

/// The first sample that is later, by halving.
function after(times, time) {
  let low = 0, high = times.length;
  while (low < high) { const middle = (low + high) >> 1; if (times[middle] > time) high = middle; else low = middle + 1; }
  return low;
}
function at(time) {
  const next = Math.min(Math.max(after(track.time_s, time), 1), track.time_s.length - 1), before = Math.max(next - 1, 0);
  const length = track.time_s[next] - track.time_s[before];
  const share = length > 0 ? Math.min(Math.max((time - track.time_s[before]) / length, 0), 1) : 0;
  const state = {};
  for (const [name, values] of Object.entries(track)) {
    let difference = values[next] - values[before];
    if (name === "heading_deg") difference -= 360 * Math.round(difference / 360);
    state[name] = values.length ? values[before] + share * difference : 0;
  }
  return state;
}

// ---- the map
const hasMap = rows > 1 && track.time_s.length > 0;
const view = hasMap ? viewOf() : null;

/// Where the mission is, and some land around it. The ground reaches further, to the sites.
function viewOf() {
  const norths = [...track.north_m], easts = [...track.east_m], margin_m = 3500;
  const show = ([north, east]) => { norths.push(north); easts.push(east); };
  record.targets.forEach(target => target.line.forEach(show));
  record.zones.forEach(zone => zone.outline.forEach(show));
  record.others.filter(other => other.name).forEach(other => other.points.forEach(([, north, east]) => show([north, east])));
  record.truths.forEach(thing => thing.points.forEach(([, north, east]) => show([north, east])));
  const box = {south: least(norths) - margin_m, north: most(norths) + margin_m, west: least(easts) - margin_m, east: most(easts) + margin_m};
  for (const {place: [north, east]} of record.threats)  // which are near enough to be on the map themselves
    if (north > box.south - 7000 && north < box.north + 7000 && east > box.west - 7000 && east < box.east + 7000) {
      box.south = Math.min(box.south, north - 1500); box.north = Math.max(box.north, north + 1500);
      box.west = Math.min(box.west, east - 1500); box.east = Math.max(box.east, east + 1500);
    }
  const more = (box.east - box.west) * 0.6 - (box.north - box.south);  // no narrow strip
  if (more > 0) { box.south -= more / 2; box.north += more / 2; }
  return box;
}

/// Up to where the site sees, in each direction, what flies so high above the ground.
function coverage(threat, above_m) {
  const [north, east] = threat.place, eye = groundHeight(north, east) + 10, step = ground.spacing_m / 2, points = [];
  for (let bearing = 0; bearing < 360; bearing += 2) {
    const n = Math.cos(bearing * Math.PI / 180), e = Math.sin(bearing * Math.PI / 180);
    let highest = -Infinity, away = step;
    for (; away < threat.detection_range_m; away += step) {
      const drop = away * away / (2 * kEarth_m), under = groundHeight(north + n * away, east + e * away) - drop - eye;
      if ((under + above_m) / away < highest) break;
      highest = Math.max(highest, under / away);
    }
    away = Math.min(away, threat.detection_range_m);
    points.push(map.xy([north + n * away, east + e * away]));
  }
  return line(points) + "Z";
}

function decisionMark(index, x, y, radius) {
  const decision = record.decisions[index];
  const mark = svg("g", {class: `decision${decision.late ? " late" : ""}${decision.chosen ? "" : " none"}`, "data-decision": index, transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`},
    svg("title", {}, `${clock(decision.time_s)} ${words(decision.entity)}: ${decision.chosen || "no result"}`),
    svg("circle", {class: "spot", r: 11}), svg("circle", {class: "dot", r: radius}));
  mark.addEventListener("click", event => { event.stopPropagation(); choose(index); });
  return mark;
}

function drawMap() {
  const {scale, width, height, name, show} = beginMap(view, "the flight, threats and targets"), all = [];
  for (const zone of record.zones) all.push(svg("path", {class: "zone", d: line(zone.outline.map(map.xy)) + "Z"}, svg("title", {}, zone.name)));
  map.threats = record.threats.map(threat => {
    const [x, y] = map.xy(threat.place), parts = [];
    if (threat.detection_range_m > 0) kLevels_m.forEach((above, i) => parts.push(svg("path", {class: i ? "coverage high" : "coverage", d: coverage(threat, above)}, svg("title", {}, `${threat.kind} sees what flies ${above} m above the ground`))));
    if (threat.lethal_range_m > 0) parts.push(svg("circle", {class: "reach", cx: x, cy: y, r: threat.lethal_range_m * scale}));
    if (threat.deviation_m * scale > 5) parts.push(svg("circle", {class: "uncertain", cx: x, cy: y, r: threat.deviation_m * scale}));
    parts.push(siteMark(x, y), name(x, y, x > 0 && x < width && y > 0 && y < height ? threat.kind : `${threat.kind} beyond`));
    return svg("g", {}, ...parts);
  });
  all.push(...map.threats);
  map.images = record.footprints.map(each => svg("path", {class: "image", d: line(each.corners.map(map.xy)) + "Z"}, svg("title", {}, `${each.target}: ${fixed(each.sample_m, 2, "m a pixel")}`)));
  all.push(...map.images);
  map.routes = record.routes.map(route => svg("path", {class: "route", d: line(route.points.map(map.xy))}));
  all.push(...map.routes);
  map.points = track.time_s.map((_, i) => map.xy([track.north_m[i], track.east_m[i]]));
  map.flown = svg("path", {class: "flown"});
  all.push(svg("path", {class: "casing", d: line(map.points)}), svg("path", {class: "whole", d: line(map.points)}), map.flown);
  map.targets = record.targets.map(target => {
    const points = target.line.map(map.xy), [x, y] = points[Math.floor(points.length / 2)] ?? [0, 0];
    return svg("g", {}, points.length > 1 ? svg("path", {class: "target", d: line(points)}) : svg("circle", {class: "target place", cx: x, cy: y, r: 5.5}),
      name(x, y, target.name));
  });
  all.push(...map.targets);
  // What truly was there, under what was known of it.
  map.truths = record.truths.map(thing => svg("g", {class: "truth"}, svg("title", {}, thing.name), svg("path", {}), svg("path", {class: "cross", d: "M-5 -5L5 5M-5 5L5 -5"})));
  map.paths = record.targets.map(() => svg("path", {class: "followed"}));
  all.push(...map.truths, ...map.paths);
  record.decisions.forEach((decision, i) => { const state = at(decision.time_s); all.push(decisionMark(i, ...map.xy([state.north_m, state.east_m]), 3.6)); });
  map.others = record.others.map(other => svg("g", {}, svg("path", {class: other.name ? "intruder companion" : "intruder"}), svg("title", {}, other.name || `aircraft ${other.number}`), svg("path", {class: "intruder_now", d: "M0 -8L5 7L0 4L-5 7Z"})));
  map.aircraft = svg("path", {class: "aircraft", d: "M0 -12L2.2 -4L12 2V4.5L2.2 2L1.6 8L5 10.5V12L0 11L-5 12V10.5L-1.6 8L-2.2 2L-12 4.5V2L-2.2 -4Z"});
  show(...all, ...map.others, map.aircraft);
}
// ---- plots over time
function timeAxis(root, left, height) {
  const width = Math.max(root.clientWidth, 280), right = 20;
  root.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const x = time => left + (time - begin) / (end - begin) * (width - left - right);
  const step = [30, 60, 120, 300, 600, 1200, 3600].find(each => (end - begin) / each * 52 < width - left) ?? 7200;
  const ticks = [];
  for (let time = Math.ceil(begin / step) * step; time <= end; time += step)
    ticks.push(svg("text", {class: "tick", x: x(time), y: height - 4, "text-anchor": "middle"}, clock(time)));
  const take = event => setTime(begin + (event.clientX - root.getBoundingClientRect().left - left * root.clientWidth / width) / ((width - left - right) * root.clientWidth / width) * (end - begin));
  root.onpointerdown = event => { if (!event.target.closest(".decision")) take(event); };
  root.onpointermove = event => { if (event.buttons === 1) take(event); };
  return {x, width, ticks, cursor: svg("path", {class: "cursor"})};
}

const profile = {}, lanes = {};
function drawProfile() {
  const root = $("profile"), height = root.clientWidth < 600 ? 170 : 220, left = 44, bottom = height - 22;
  const {x, width, ticks, cursor} = timeAxis(root, left, height);
  const under = track.height_m.map((each, i) => each - track.above_ground_m[i]);
  const least = Math.floor(Math.min(...under, ...track.height_m) / 50) * 50, most = Math.max(...track.height_m, least + 100) * 1.02 + 20;
  const y = metres => bottom - (metres - least) / (most - least) * (bottom - 14);
  const all = [];
  for (const metres of marks(least, most, 5))
    all.push(svg("path", {class: "grid", d: `M${left} ${y(metres).toFixed(1)}H${width - 20}`}), svg("text", {class: "tick", x: left - 8, y: y(metres) + 4, "text-anchor": "end"}, metres));
  all.push(svg("text", {class: "tick", x: 2, y: 10}, "metres above the geoid"));
  all.push(svg("path", {class: "ground", d: line([[x(begin), bottom], ...under.map((metres, i) => [x(track.time_s[i]), y(metres)]), [x(end), bottom]]) + "Z"}));
  all.push(svg("path", {class: "height", d: line(track.height_m.map((metres, i) => [x(track.time_s[i]), y(metres)]))}));
  Object.assign(profile, {x, y, cursor, bottom, dot: svg("circle", {class: "cursor_dot", r: 4.5})});
  root.replaceChildren(...all, ...ticks, cursor, profile.dot);
}

function stageBands(stages, x, top) {
  return stages.flatMap((stage, i) => {
    const from = x(Math.max(stage.from_s, begin)), until = x(stages[i + 1]?.from_s ?? end), name = words(stage.name);
    const band = svg("rect", {class: i % 2 ? "band odd" : "band", x: from, y: top, width: Math.max(until - from, 1), height: 18}, svg("title", {}, `${name}: ${stage.reason}`));
    return name.length * 6.6 + 10 < until - from ? [band, svg("text", {x: from + 5, y: top + 13, "pointer-events": "none"}, name)] : [band];
  });
}
function drawLanes() {
  const root = $("lanes"), beside = root.clientWidth >= 700, left = beside ? 148 : 8;
  const entities = [...new Set(record.decisions.map(decision => decision.entity))];
  const wanted = [["Phases", (x, top) => stageBands(record.phases, x, top)]];
  if (record.modes.length) wanted.push(["Mode", (x, top) => stageBands(record.modes, x, top)]);
  for (const entity of entities) wanted.push([words(entity), (x, top) => record.decisions.flatMap((decision, i) => decision.entity === entity ? [decisionMark(i, x(decision.time_s), top + 9, 4.2)] : [])]);
  const lasting = (style, from, until, text) => (x, top) => svg("rect", {class: `band ${style}`, x: x(from), y: top, width: Math.max(x(until) - x(from), 3), height: 18}, svg("title", {}, text));
  if (record.threats.length) wanted.push(["Threats", (x, top) => record.threats.map(threat => svg("path", {class: "site", d: `M${x(Math.max(threat.from_s, begin)).toFixed(1)} ${top + 3}l6.5 11h-13z`}, svg("title", {}, `${clock(threat.from_s)} ${threat.kind}`)))]);
  if (record.others.length) wanted.push(["Other aircraft", (x, top) => record.others.filter(each => each.points.length).map(each => lasting("other", each.points[0][0], each.points.at(-1)[0], each.name || `aircraft ${each.number}`)(x, top))]);
  if (record.footprints.length) wanted.push(["Images", (x, top) => record.footprints.map(each => svg("rect", {class: "band image_time", x: x(each.time_s), y: top + 3, width: 2, height: 12}, svg("title", {}, each.target)))]);
  if (record.faults.length) wanted.push(["Faults", (x, top) => record.faults.map(fault => lasting("fault", fault.from_s, fault.until_s ?? end, `${fault.what}. ${fault.answer}`)(x, top))]);
  const tall = beside ? 26 : 40, height = wanted.length * tall + 26, {x, width, ticks, cursor} = timeAxis(root, left, height), all = [];
  wanted.forEach(([name, draw], i) => {
    const top = i * tall + (beside ? 2 : 17);
    all.push(svg("text", {class: "tick", x: beside ? 0 : left, y: beside ? top + 13 : top - 4}, name), svg("path", {class: "grid", d: `M${left} ${top + 9}H${width - 20}`}), ...draw(x, top));
  });
  Object.assign(lanes, {x, cursor, bottom: height - 20});
  root.replaceChildren(...all, ...ticks, cursor);
  root.querySelectorAll(".decision").forEach(mark => mark.classList.toggle("chosen", Number(mark.dataset.decision) === chosen));
}

// ---- words
const cell = (text, number) => html("td", number ? {class: "number"} : {}, text);
const head = (...names) => html("thead", {}, html("tr", {}, ...names.map(([name, number]) => html("th", number ? {class: "number"} : {}, name))));
function explained(decision) {
  const parts = [html("p", {}, decision.reason || "No reason was given.")];
  if (decision.answers.length) parts.push(html("ul", {class: "answers"}, ...decision.answers.map(each => html("li", {}, html("strong", {}, each.name),
    ` ${each.outcome} after ${span(each.took_s)}`, html("div", {class: "note"}, each.reason)))));
  return parts;
}
// A target is followed for some time, an emitter placed, of anything else images are taken.
const takesImages = target => !target.wanted_s && !target.wanted_deviation_m;
const wantedOf = target => target.wanted_s ? `followed ${fixed(target.wanted_s, 0, "s")}` : target.wanted_deviation_m ? `within ${fixed(target.wanted_deviation_m, 0, "m")}` : fixed(target.wanted_sample_m, 2, "m");
const achievedOf = target => target.wanted_s ? (target.path.length ? fixed(target.followed_s, 0, "s") : "not found")
  : target.wanted_deviation_m ? (target.deviation_m ? fixed(target.deviation_m, 0, "m") : "not found") : target.achieved_sample_m ? fixed(target.achieved_sample_m, 2, "m") : "not seen";
function drawLists() {
  $("flags").append(...record.flags.map(flag => {
    const button = html("button", {type: "button"}, html("time", {}, clock(flag.time_s)), html("span", flag.severe ? {class: "severe"} : {}, flag.text));
    button.addEventListener("click", () => setTime(flag.time_s));
    return html("li", {}, button);
  }));
  if (!record.flags.length) $("flags").append(html("li", {}, "–", html("span", {}, "Nothing.")));
  $("checks").append(...record.checks.map(check => html("li", {}, html("span", {class: `mark ${check.passed ? "kept" : "broken"}`}, check.passed ? "✓" : "✗"),
    html("span", {}, html("strong", {}, check.name), ` ${check.text}`))));
  $("targets_note").hidden = !record.targets.some(takesImages);
  $("targets").append(head(["target"], ["wanted", 1], ["achieved", 1], ["place", 1], ["at", 1]), html("tbody", {}, ...record.targets.map(target => html("tr", {},
    cell(target.name), cell(wantedOf(target), 1), cell(achievedOf(target), 1),
    cell(target.deviation_m ? `± ${fixed(target.deviation_m, 0, "m")}` : "–", 1), cell(target.collected_s === null ? "–" : clock(target.collected_s), 1)))));
  $("faults").append(...record.faults.map(fault => html("li", {}, html("time", {}, clock(fault.from_s)), html("span", {}, html("strong", {}, `${fault.what}. `),
    `Noticed by ${words(fault.noticed_by)} ${fault.noticed_s > fault.from_s ? `after ${span(fault.noticed_s - fault.from_s)}` : "at once"}. ${fault.answer} `,
    fault.until_s === null ? html("strong", {}, "Not healed.") : `Healed after ${span(fault.until_s - fault.from_s)}.`))));
  $("faults").parentElement.hidden = !record.faults.length;
  $("decisions").append(...record.decisions.map((decision, i) => {
    const summary = html("summary", {}, html("time", {}, clock(decision.time_s)), html("span", {}, words(decision.entity)),
      html("span", {}, html("strong", {}, decision.chosen || "no result"), `  ${decision.question}`));
    const details = html("details", {"data-decision": i}, summary, html("div", {}, ...explained(decision)));
    summary.addEventListener("click", () => { if (!details.open) choose(i); });
    return details;
  }));
  $("command").textContent = record.command;
  $("origin").textContent = `Places in this page and in its JSON twin are metres about ${record.origin.latitude_deg.toFixed(5)}° north, ${record.origin.longitude_deg.toFixed(5)}° east (WGS-84, azimuthal equidistant); heights are above the geoid.`;
}
function drawLatencies() {
  const shown = record.latencies.filter(each => each.seconds.length);
  if (!shown.length) { $("latency_part").hidden = true; return; }
  const sorted = shown.map(each => ({name: each.name, count: each.count, seconds: each.seconds}));
  const low = Math.floor(Math.log10(Math.max(Math.min(...sorted.map(each => each.seconds[0])), 1e-6)));
  const high = Math.max(Math.ceil(Math.log10(Math.max(...sorted.map(each => each.seconds.at(-1)), 1e-5))), low + 1), bins = (high - low) * 8;
  for (const {name, count: total, seconds} of sorted) {
    const counts = new Array(bins).fill(0), share = part => seconds[Math.min(Math.floor(part * seconds.length), seconds.length - 1)];
    for (const each of seconds) ++counts[Math.min(Math.max(Math.floor((Math.log10(Math.max(each, 1e-6)) - low) * 8), 0), bins - 1)];
    const most = Math.max(...counts), width = 240, x = i => i / bins * width, all = [svg("path", {class: "grid", d: `M0 60.5H${width}`})];
    counts.forEach((count, i) => { if (count) all.push(svg("rect", {class: "bar", x: x(i) + 0.5, y: 60 - count / most * 54, width: width / bins - 1, height: count / most * 54})); });
    for (let decade = low; decade <= high; ++decade)
      all.push(svg("text", {class: "tick", x: x((decade - low) * 8), y: 74, "text-anchor": decade === low ? "start" : decade === high ? "end" : "middle"}, span(10 ** decade).replace(".00", "").replace(".0 ", " ")));
    $("latencies").append(html("div", {}, html("h3", {}, name), html("p", {}, `${total} · half within ${span(share(0.5))} · 95 % within ${span(share(0.95))} · at most ${span(seconds.at(-1))}`),
      svg("svg", {viewBox: `0 0 ${width} 78`, role: "img", "aria-label": `Latencies of ${name}`}, ...all)));
  }
}

// ---- time
const figures = [["Height", s => fixed(s.height_m, 0, "m")], ["Above ground", s => fixed(s.above_ground_m, 0, "m")], ["Airspeed", s => fixed(s.airspeed_m_s, 1, "m/s")],
  ["Over ground", s => fixed(s.ground_speed_m_s, 1, "m/s")], ["Heading", s => `${two(Math.round((s.heading_deg % 360 + 360) % 360)).padStart(3, "0")}°`], ["Bank", s => `${s.bank_deg.toFixed(0)}°`],
  ["Climb", s => `${s.climb_deg.toFixed(1)}°`], ["Fuel", s => fixed(s.fuel_kg, 1, "kg")]];
const readout = {values: figures.map(() => html("dd")), when: html("p", {class: "when"}), stage: html("p", {class: "stage_name"})};
function drawReadout() {
  readout.tilt = svg("g", {}, svg("rect", {class: "sky", x: -120, y: -200, width: 240, height: 200}), svg("rect", {class: "earth", x: -120, y: 0, width: 240, height: 200}), svg("path", {class: "line", d: "M-120 0H120"}));
  const horizon = svg("svg", {class: "horizon", viewBox: "-50 -50 100 100", role: "img", "aria-label": "Attitude"}, svg("clipPath", {id: "disc"}, svg("circle", {r: 47})),
    svg("g", {"clip-path": "url(#disc)"}, readout.tilt), svg("circle", {class: "rim", r: 47}), svg("path", {class: "aircraft", d: "M-30 -1.5H-8L0 5L8 -1.5H30V1.5H9L0 9L-9 1.5H-30Z"}));
  $("now").append(html("div", {class: "readout"}, html("div", {}, readout.when, readout.stage), horizon),
    html("dl", {}, ...figures.map(([name], i) => html("div", {}, html("dt", {}, name), readout.values[i]))));
}
function setTime(time) {
  now = Math.min(Math.max(time, begin), end);
  const state = at(now), stage = record.phases[last(record.phases, now)];
  $("slider").value = now;
  $("slider").setAttribute("aria-valuetext", clock(now));
  $("clock").textContent = clock(now);
  $("phase").textContent = stage ? words(stage.name) : "";
  readout.when.textContent = clock(now);
  readout.stage.textContent = stage ? words(stage.name) : "";
  figures.forEach(([, text], i) => { readout.values[i].textContent = text(state); });
  readout.tilt.setAttribute("transform", `rotate(${(-state.bank_deg).toFixed(1)}) translate(0 ${(state.climb_deg * 1.6).toFixed(1)})`);
  for (const plot of [profile, lanes]) plot.cursor?.setAttribute("d", `M${plot.x(now).toFixed(1)} 4V${plot.bottom}`);
  profile.dot?.setAttribute("transform", `translate(${profile.x(now).toFixed(1)} ${profile.y(state.height_m).toFixed(1)})`);
  if (hasMap) moveMap(state);
}
function moveMap(state) {
  const [x, y] = map.xy([state.north_m, state.east_m]);
  map.aircraft.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${state.heading_deg.toFixed(1)})`);
  map.flown.setAttribute("d", line([...map.points.slice(0, after(track.time_s, now)), [x, y]]));
  const route = last(record.routes, now);
  map.routes.forEach((path, i) => { path.style.display = i > route ? "none" : ""; path.classList.toggle("replaced", i < route); });
  map.threats.forEach((group, i) => { group.style.opacity = record.threats[i].from_s <= now ? 1 : 0.25; });
  map.images.forEach((path, i) => { path.style.display = record.footprints[i].time_s <= now ? "" : "none"; });
  map.targets.forEach((group, i) => group.firstChild.classList.toggle("seen", record.targets[i].collected_s !== null && record.targets[i].collected_s <= now));
  record.truths.forEach(({points}, i) => {
    const there = points.slice(0, Math.max(points.findLastIndex(point => point[0] <= now) + 1, 1)).map(point => map.xy([point[1], point[2]])), [tx, ty] = there.at(-1);
    map.truths[i].children[1].setAttribute("d", line(there));
    map.truths[i].lastChild.setAttribute("transform", `translate(${tx.toFixed(1)} ${ty.toFixed(1)})`);
  });
  record.targets.forEach(({path}, i) => map.paths[i].setAttribute("d", line(path.filter(point => point[0] <= now).map(point => map.xy([point[1], point[2]])))));
  map.others.forEach((group, i) => {
    const points = record.others[i].points, count = points.findLastIndex(point => point[0] <= now) + 1;
    const there = count > 0 && now <= points.at(-1)[0] + 2;
    group.style.display = count ? "" : "none";
    if (!count) return;
    const trail = points.slice(0, count).map(point => map.xy([point[1], point[2]])), [ox, oy] = trail.at(-1), [bx, by] = trail.at(-2) ?? [ox, oy + 1];
    group.firstChild.setAttribute("d", line(trail));
    group.lastChild.style.display = there ? "" : "none";
    group.lastChild.setAttribute("transform", `translate(${ox.toFixed(1)} ${oy.toFixed(1)}) rotate(${(Math.atan2(ox - bx, by - oy) * 180 / Math.PI).toFixed(1)})`);
  });
}

function choose(index) {
  chosen = index;
  const decision = record.decisions[index];
  document.querySelectorAll("[data-decision]").forEach(mark => mark.classList.toggle("chosen", Number(mark.dataset.decision) === index));
  $("told").hidden = false;
  $("told").replaceChildren(html("h2", {}, decision.chosen || "no result"), html("p", {class: "note"}, `${clock(decision.time_s)}, ${words(decision.entity)}: ${decision.question}; took ${span(decision.took_s)}`), ...explained(decision));
  setTime(decision.time_s);
}

// ---- the page
function drawAll() {
  if (hasMap) drawMap();
  if (track.time_s.length) drawProfile();
  drawLanes();
  document.querySelectorAll("#map .decision").forEach(mark => mark.classList.toggle("chosen", Number(mark.dataset.decision) === chosen));
  setTime(now);
}
let playing = 0;
function play(stamp) {
  if (!playing) return;
  setTime(now + (stamp - playing) / 1000 * (end - begin) / 60);  // the whole flight in a minute
  playing = now >= end ? 0 : stamp;
  showPlaying();
  if (playing) requestAnimationFrame(play);
}
function showPlaying() {
  $("play").textContent = playing ? "❚❚" : "▶";
  $("play").setAttribute("aria-label", playing ? "Pause" : "Play");
}
$("head").className = record.verdict;
drawHead(record.mission, record.headline.split(" · "));
drawReadout();
drawLegend(["M0 6H20", "flown", "flown"], ["M0 6H20", "route", "planned", "hide-routes"], ["M0 6H20", "coverage", `seen by radar ${kLevels_m.join(" and ")} m above the ground`, "hide-coverage"],
  ["M2 1H18V11H2Z", "image", "images", "hide-images"], ["", "", "decisions", "hide-decisions"]);
drawLists();
drawLatencies();
$("slider").min = begin;
$("slider").max = end;
if (!hasMap) document.querySelector(".map").hidden = true;
$("profile").parentElement.hidden = !track.time_s.length;
now = end;
start(drawAll);
$("slider").addEventListener("input", () => setTime(Number($("slider").value)));
$("play").addEventListener("click", () => {
  playing = playing ? 0 : performance.now();
  if (playing && now >= end) now = begin;
  showPlaying();
  if (playing) requestAnimationFrame(play);
});
$("theme").addEventListener("click", () => setTheme(dark() ? "light" : "dark"));
let before = null;
addEventListener("beforeprint", () => {
  before = {theme: document.documentElement.dataset.theme, now, closed: [...document.querySelectorAll("details:not([open])")]};
  before.closed.forEach(each => { each.open = true; });
  setTheme("light");
  setTime(end);
});
addEventListener("afterprint", () => {
  before.closed.forEach(each => { each.open = false; });
  setTheme(before.theme);
  setTime(before.now);
});
