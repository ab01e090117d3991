// Figures and states as people read them.

/** @param {number} nanoseconds @returns {string} */
export function time(nanoseconds) {
  if (nanoseconds < 1e3) return `${nanoseconds} ns`;
  if (nanoseconds < 1e6) return `${digits(nanoseconds / 1e3)} µs`;
  if (nanoseconds < 1e9) return `${digits(nanoseconds / 1e6)} ms`;
  if (nanoseconds < 120e9) return `${digits(nanoseconds / 1e9)} s`;
  if (nanoseconds < 7200e9) return `${Math.round(nanoseconds / 60e9)} min`;
  return `${Math.round(nanoseconds / 3600e9)} h`;
}

/** @param {number} value @returns {string} */
export function digits(value) {
  return value > 0 && value < 9.95 ? value.toFixed(1) : Math.round(value).toString();
}

/** @param {number[]} rate Nothing, or one. @returns {string} */
export function rate(rate) {
  return rate.length ? `${digits(rate[0])}/s` : "–";
}

/** The rate; if it is too low to be seen in a second, the total. @param {{rate?: number[], calls?: number[], total: number}} of */
export function often(of) {
  const now = of.rate ?? of.calls ?? [];
  return now.length && now[0] > 0 ? rate(now) : of.total ? `${of.total} so far` : "none yet";
}

/** @param {{p50: number, p99: number}} of @returns {string} */
export function latency(of) {
  return of.p50 ? `${time(of.p50)}, p99 ${time(of.p99)}` : "";
}

/** @param {number} bytes @returns {string} */
export function size(bytes) {
  if (bytes < 1 << 20) return `${Math.round(bytes / 1024)} KiB`;
  return bytes < 1 << 30 ? `${Math.round(bytes / (1 << 20))} MiB` : `${(bytes / (1 << 30)).toFixed(1)} GiB`;
}

/** @param {number} nanoseconds Since 1970. @returns {string} */
export function clock(nanoseconds) {
  return new Date(nanoseconds / 1e6).toLocaleTimeString("en-GB");
}

/** `AE_navigator/IPlanner` as `IPlanner`. @param {string} name @returns {string} */
export function short(name) {
  return name.slice(name.lastIndexOf("/") + 1);
}

/** Which of the page's four colours a state has. @param {string} state @returns {"good"|"busy"|"bad"|"off"} */
export function tone(state) {
  if (state === "ready" || state === "planned") return "good";
  if (["starting", "waiting", "idle", "interrupted", "terminated", "unplanned"].includes(state)) return "busy";
  return ["ended", "unused", "removed"].includes(state) ? "off" : "bad";
}

/** @param {{state: string, reason: string}} of @returns {string} */
export function stateText(of) {
  return of.reason ? `${of.state}: ${of.reason}` : of.state;
}

/** @param {string} outcome `TimedOut` @returns {string} `timed out` */
export function outcome(outcome) {
  return outcome.replace(/(?<!^)([A-Z])/g, " $1").toLowerCase();
}

/** @param {number} count @param {string} what @returns {string} */
export function counted(count, what) {
  return `${count} ${what}${count === 1 ? "" : "s"}`;
}
