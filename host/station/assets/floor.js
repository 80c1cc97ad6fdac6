// The lanes. The station draws each; a verdict is taken only with its run and the hash of its record.

const VERDICTS = ["PASS", "FAIL", "ERROR"];
const place = (lane) => document.getElementById(`lane-${lane}`);

export function isWhole(event) {
  if (!VERDICTS.includes(event.state)) return true;
  return event.verdict === event.state && Boolean(event.run) && /^[0-9a-f]{64}$/.test(event.record_sha256 ?? "");
}

// Draws the lane; returns whether it was drawn.
export function draw(event) {
  const old = place(event.lane);
  if (!old || !isWhole(event)) return false;
  const focused = old.contains(document.activeElement) ? document.activeElement.id : "";
  const isArmed = old.classList.contains("armed");
  const made = new DOMParser().parseFromString(event.html, "text/html").body.firstElementChild;
  made.classList.toggle("armed", isArmed);
  old.replaceWith(made);
  // Whoever pressed a button that is gone stays in its lane.
  if (focused) (document.getElementById(focused) ?? made.querySelector(".name"))?.focus({ preventScroll: true });
  return true;
}

// Shows what the lane's run is doing.
export function progress({ lane, what, lang, rows }) {
  const doing = place(lane)?.querySelector(".doing"), bar = place(lane)?.querySelector("progress");
  if (!doing || !bar) return;
  doing.textContent = what;
  doing.lang = lang ?? "";
  if (rows) [bar.value, bar.max] = rows;
  else bar.removeAttribute("value");
}

// Marks the lane that the next scan is for.
export function arm(lane) {
  for (const one of document.querySelectorAll(".lane")) {
    const isArmed = one.dataset.lane === lane;
    one.classList.toggle("armed", isArmed);
    one.querySelector(".name").setAttribute("aria-pressed", isArmed);
  }
}

export const count = () => document.querySelectorAll(".lane").length;
