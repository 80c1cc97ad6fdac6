// The operator's page: scans out, one after another; the station's news in.

import { arm, count, draw, progress } from "./floor.js";
import { live } from "./live.js";
import { scanner } from "./scanner.js";
import { isOn, play, turn } from "./sound.js";

const station = document.getElementById("station").dataset;
const by = (id) => document.getElementById(id);
const put = (id, text) => { if (by(id)) by(id).textContent = text; };
const UNSENT = { is_taken: false, said: station.unsent };
const UNPRESSED = { is_taken: false, said: station.unpressed };
const LEFT = "left";
// In milliseconds: longer than the station accepts anything after the beat that it names.
const PATIENT = 10000;
// How many of the lanes' news can be read again.
const KEPT = 20;
// What each lane showed last.
const shown = new Map();
// The lane that the next scan is for, until when, and what ends it.
let armed = "", until = 0, ending;
let sent = 0, answered = 0, queue = Promise.resolve(), todayIsStale = false;
// The hook of each lane that failed last.
const notices = new Map();

// Acts are sent one after another, so that a scan is for the lane whose barcode was scanned just before. Each names the last beat
// heard when it was made: the station refuses what arrives late, because another board may be there by then.
function post(path, fields, show, unsent) {
  const made = beat();
  if (!made) return refuse(show, unsent);
  queue = queue.then(async () => {
    if (!beat()) return refuse(show, unsent);
    const body = new URLSearchParams({ csrf: station.csrf, beat: made, ...fields() });
    const signal = AbortSignal.timeout(PATIENT);
    try {
      const answer = await fetch(path, { method: "POST", body, signal, headers: { accept: "application/json" } });
      // The user of the page is not logged in any more.
      if (answer.status === 401 && "known" in station) return leave(unsent);
      const became = await answer.json();
      // Somebody else is logged in.
      if (became.is_stale) return leave(unsent);
      sessionStorage.removeItem(LEFT);
      show(became);
    } catch {
      keep(unsent);
      show(unsent);
    }
  });
}

// If the page comes anew now, it says then that this was not taken.
const keep = (unsent) => sessionStorage.setItem(LEFT, JSON.stringify([Date.now(), unsent.said]));

function leave(unsent) {
  keep(unsent);
  location.reload();
}

// A page that is not live takes nothing. The reason may be that the session is over; then the page is loaded anew to log in.
function refuse(show, unsent) {
  keep(unsent);
  show(unsent);
  if (!("known" in station)) return;
  fetch("/", { method: "HEAD", redirect: "manual" }).then(({ ok }) => ok || location.reload(), () => {});
}

function answer({ is_taken, scanned, said }) {
  const box = by("answer");
  if (!box) return;
  box.textContent = (scanned ? `${scanned} → ` : "") + said;
  box.className = `answer ${is_taken ? "taken" : "refused"}`;
  if (!is_taken) play("ERROR");
}

const isOver = () => performance.now() >= until;

function marks() {
  const lane = isOver() ? "" : armed;
  arm(lane);
  put("armed", lane && count() > 1 ? `${by("armed").dataset.for} ${lane}` : "");
}

// A choice is over after a while: then somebody else may scan, for the board in another lane.
function arms(lane) {
  clearTimeout(ending);
  armed = lane ?? "";
  until = performance.now() + Number(station.chosen);
  marks();
  if (armed) ending = setTimeout(ends, Number(station.chosen) + 1);
}

// The lane itself is kept: the station refuses the next scan, which was perhaps meant for it.
function ends() {
  marks();
  if (count() < 2) return;
  put("answer", station.over.replace("{lane}", armed));
  by("answer").className = "answer";
}

function scan(text, typed) {
  const counter = ++sent;
  const counts = () => put("counter", `${answered} / ${sent}`);
  counts();
  post("/scan", () => ({ counter, text, typed, lane: armed, is_over: isOver() }), (became) => {
    answered += 1;
    counts();
    if (became.counter !== undefined && became.counter !== counter) became = UNSENT;
    // A label that was refused does not make the choice last longer. What did not arrive, or was not looked at, may have been a
    // lane's barcode: then the next scan is for no lane.
    if (became.is_taken || (became.armed ?? "") !== armed) arms(became.armed);
    if (became.is_other) return location.reload();
    answer(became);
  }, UNSENT);
}

function lane(event, isNews) {
  if (!draw(event)) return answer({ is_taken: false, said: station.undrawn });
  marks();
  const shows = `${event.state} ${event.run}`, isAsBefore = shown.get(event.lane) === shows;
  shown.set(event.lane, shows);
  // A board that comes or goes changes what can be done, but there is nothing new to say.
  if (isAsBefore) return;
  if (notices.delete(event.lane)) notice();
  if (!isNews) return;
  say(event.said);
  play(event.state);
  todayIsStale ||= Boolean(event.verdict);
}

// What one lane has to say does not take the place of what another one said.
function say(text) {
  const log = by("said"), line = document.createElement("p");
  line.textContent = text;
  log.append(line);
  if (log.childElementCount > KEPT) log.firstElementChild.remove();
}

const notice = () => put("notice", [...notices.values()].join("\n"));

// A failed hook is no answer to a scan.
function hook({ lane, serial, said }) {
  // By now another board may be in the lane.
  const unit = serial ? `, ${serial}` : "";
  notices.set(lane, `${by("notice").dataset.lane} ${lane}${unit}: ${said}`);
}

async function today() {
  if (!todayIsStale) return;
  todayIsStale = false;
  const counted = await fetch("/today").then((answer) => answer.ok ? answer.text() : undefined).catch(() => undefined);
  if (counted === undefined) {
    todayIsStale = true;
    return;
  }
  const footer = by("today"), isFocused = footer.contains(document.activeElement);
  footer.innerHTML = counted;
  todayIsStale ||= Boolean(footer.querySelector("[data-again]"));
  if (isFocused) footer.querySelector("a")?.focus({ preventScroll: true });
}

const HEAR = {
  snapshot: ({ lanes, hooks }) => {
    // After a gap this is where the page hears of a verdict; a page that has just come shows nothing new.
    lanes.forEach((one) => lane(one, shown.has(one.lane)));
    notices.clear();
    hooks.forEach(hook);
    notice();
    todayIsStale = true;
    today();
  },
  lane: (one) => lane(one, true),
  doing: progress,
  scan: () => {},
  hook: (one) => { hook(one); notice(); play("ERROR"); },
  beat: ({ clock }) => {
    // After midnight another day is counted.
    todayIsStale ||= clock < by("clock")?.textContent;
    put("clock", clock);
  },
};

const beat = live({
  mark: station.mark,
  hear: (name, data) => HEAR[name](data),
  show: (isLive) => {
    document.body.classList.toggle("dead", !isLive);
    const said = isLive ? station.live : station.notLive;
    if (by("lamp").textContent !== said) put("lamp", said);
  },
});

const isTyping = () => document.activeElement === by("hand-text");
const isOpen = () => by("hand").classList.contains("shown");

function typing(on) {
  by("hand").classList.toggle("shown", on);
  by("type").setAttribute("aria-pressed", on);
  if (on) by("hand-text").focus();
}

document.documentElement.classList.add("scripted");
const [leftAt, left] = JSON.parse(sessionStorage.getItem(LEFT) ?? "[]");
sessionStorage.removeItem(LEFT);
if (left && Date.now() - leftAt < PATIENT) answer({ is_taken: false, said: left });
addEventListener("click", ({ target }) => {
  const name = target.closest("[data-arm]")?.dataset.arm;
  if (name && by("hand")) arms(name === armed && !isOver() ? "" : name);
});
addEventListener("submit", (event) => {
  const form = event.target;
  if (!form.closest("#station")) return;
  event.preventDefault();
  const fields = new FormData(form);
  // What the lane showed when the button was pressed.
  if (form.id !== "hand") return post(form.getAttribute("action"), () => Object.fromEntries(fields), answer, UNPRESSED);
  if (fields.get("lane")) arms(fields.get("lane"));
  scan(fields.get("text"), "true");
  form.reset();
});
if (by("hand")) {
  scanner({ isTyping, show: (text) => put("typed", text), scanned: (text) => scan(text, "false") });
  for (const id of ["type", "sound"]) by(id).hidden = false;
  by("type").addEventListener("click", () => typing(!isOpen()));
  by("hand").addEventListener("keydown", (event) => {
    if (event.key === "Escape") return typing(false);
    // A scanner whose scans end in Tab.
    const isWhole = event.key === "Tab" && !event.shiftKey && isTyping() && by("hand-text").value;
    if (isWhole) { event.preventDefault(); by("hand").requestSubmit(); }
  });
  by("sound").setAttribute("aria-pressed", isOn());
  by("sound").addEventListener("click", () => { turn(!isOn()); by("sound").setAttribute("aria-pressed", isOn()); play("PASS"); });
}
// What the plant has changes without news.
setInterval(() => { todayIsStale ||= "changes" in by("today").dataset; today(); }, 5000);
