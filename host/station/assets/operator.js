// The operator's page: scans out, one after another; the station's news in.

import { arm, count, draw, progress } from "./floor.js";
import { live } from "./live.js";
import { scanner } from "./scanner.js";
import { isOn, play, turn } from "./sound.js";

const station = document.getElementById("station").dataset;
const by = (id) => document.getElementById(id);
const put = (id, text) => { if (by(id)) by(id).textContent = text; };
let armed = "", sent = 0, answered = 0, isTyping = false, queue = Promise.resolve(), todayIsStale = false;

// Acts go out one after another, so that a scan is for the lane whose barcode was scanned just before.
function post(path, fields, show) {
  queue = queue.then(async () => {
    const body = new URLSearchParams({ csrf: station.csrf, ...fields() });
    try {
      const answer = await fetch(path, { method: "POST", body, headers: { accept: "application/json" } });
      // Whoever the page is for is not logged in any more.
      if (answer.status === 401 && "known" in station) return location.reload();
      show(await answer.json());
    } catch {
      show({ is_taken: false, said: station.unsent });
    }
  });
}

function answer({ is_taken, scanned, said }) {
  const box = by("answer");
  if (!box) return;
  box.textContent = (scanned ? `${scanned} → ` : "") + said;
  box.className = `answer ${is_taken ? "taken" : "refused"}`;
  if (!is_taken) play("ERROR");
}

function arms(lane) {
  armed = lane ?? "";
  arm(armed);
  put("armed", armed && count() > 1 ? `${by("armed").dataset.for} ${armed}` : "");
}

function scan(text, typed) {
  const counter = ++sent;
  const counts = () => put("counter", `${answered} / ${sent}`);
  counts();
  post("/scan", () => ({ counter, text, typed, lane: armed }), (became) => {
    answered += 1;
    counts();
    if (became.counter !== undefined && became.counter !== counter) became = { is_taken: false, said: station.unsent };
    if ("armed" in became) arms(became.armed);
    if (became.is_other) return location.reload();
    answer(became);
  });
}

function lane(event, isNews) {
  if (!draw(event)) return answer({ is_taken: false, said: station.undrawn });
  arm(armed);
  if (!isNews) return;
  put("said", event.said);
  play(event.state);
  todayIsStale ||= Boolean(event.verdict);
}

async function today() {
  if (!todayIsStale) return;
  todayIsStale = false;
  const counted = await fetch("/today").catch(() => undefined);
  if (counted?.ok) by("today").innerHTML = await counted.text();
}

const HEAR = {
  snapshot: (lanes) => { lanes.forEach((one) => lane(one, false)); todayIsStale = true; today(); },
  lane: (one) => lane(one, true),
  doing: progress,
  scan: () => {},
  hook: ({ said }) => answer({ is_taken: false, said }),
  beat: ({ clock }) => put("clock", clock),
};

live({
  hear: (name, data) => HEAR[name](data),
  show: (isLive) => {
    document.body.classList.toggle("dead", !isLive);
    const said = isLive ? station.live : station.notLive;
    if (by("lamp").textContent !== said) put("lamp", said);
  },
});

function typing(on) {
  isTyping = on;
  by("hand").classList.toggle("shown", on);
  by("type").setAttribute("aria-pressed", on);
  if (on) by("hand-text").focus();
}

document.documentElement.classList.add("scripted");
addEventListener("click", ({ target }) => {
  const name = target.closest("[data-arm]")?.dataset.arm;
  if (name && by("hand")) arms(name === armed ? "" : name);
});
addEventListener("submit", (event) => {
  const form = event.target;
  if (!form.closest("#station")) return;
  event.preventDefault();
  if (form.id !== "hand") return post(form.getAttribute("action"), () => ({}), answer);
  const fields = new FormData(form);
  if (fields.get("lane")) arms(fields.get("lane"));
  scan(fields.get("text"), "true");
  form.reset();
});
if (by("hand")) {
  scanner({ isTyping: () => isTyping, show: (text) => put("typed", text), scanned: (text) => scan(text, "false") });
  for (const id of ["type", "sound"]) by(id).hidden = false;
  by("type").addEventListener("click", () => typing(!isTyping));
  by("hand").addEventListener("keydown", (event) => { if (event.key === "Escape") typing(false); });
  by("sound").setAttribute("aria-pressed", isOn());
  by("sound").addEventListener("click", () => { turn(!isOn()); by("sound").setAttribute("aria-pressed", isOn()); play("PASS"); });
}
// What is at the plant changes without news.
setInterval(() => { todayIsStale ||= "changes" in by("today").dataset; today(); }, 5000);
