// A recording in place of what is now: a slider for the time, and a clock that moves it.
import { set, setText } from "./element.js";
import { clock, time } from "./words.js";

const $ = (/** @type {string} */ id) => /** @type {HTMLInputElement} */ (document.getElementById(id));

/**
 * @param {string[]} times When there are states: nanoseconds since 1970, in order.
 * @param {(state: import("./state.js").DomainState) => void} show
 * @param {(text: string) => void} fail
 */
export function replay(times, show, fail) {
  const seconds = times.map((each) => Number(BigInt(each) - BigInt(times[0])) / 1e9);
  let at = 0, shown = -1, isLoading = false;
  let elapsed = 0;
  /** @type {ReturnType<typeof setInterval>|undefined} */
  let playing;

  /** Shows the state that is wanted by then; those between are passed over. */
  async function load() {
    if (isLoading || shown === at) return;
    isLoading = true;
    const wanted = at;
    try {
      const answer = await fetch(`state.json?at=${times[wanted]}`);
      if (!answer.ok) throw new Error(await answer.text());
      show(await answer.json());
      fail("");
    } catch (error) {
      fail(`The state of ${clock(Number(times[wanted]))} cannot be shown: ${/** @type {Error} */ (error).message}`);
    }
    shown = wanted;
    isLoading = false;
    void load();
  }

  /** @param {number} index */
  function go(index) {
    at = Math.max(0, Math.min(times.length - 1, index));
    $("time").value = String(at);
    const text = `${clock(Number(times[at]))}, ${time(Math.round(seconds[at] * 1e9))} after the start`;
    set($("time"), "aria-valuetext", text);
    setText($("now"), text);
    void load();
  }

  /** @param {boolean} plays */
  function play(plays) {
    clearInterval(playing);
    playing = undefined;
    setText($("play"), plays ? "Pause" : "Play");
    if (!plays) return;
    if (at === times.length - 1) go(0);
    elapsed = seconds[at];
    let before = performance.now();
    playing = setInterval(() => {
      const now = performance.now();
      elapsed += (now - before) / 1000 * Number($("speed").value);
      before = now;
      let next = at;
      while (next < times.length - 1 && seconds[next + 1] <= elapsed) ++next;
      if (next !== at) go(next);
      if (at === times.length - 1) play(false);
    }, 100);
  }

  set($("timeline"), "hidden", false);
  set($("time"), "max", times.length - 1);
  $("time").oninput = () => {
    elapsed = seconds[Number($("time").value)];
    go(Number($("time").value));
  };
  $("play").onclick = () => play(!playing);
  go(0);
}
