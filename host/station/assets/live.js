// The station's news. Without a beat for almost three seconds nothing here is live; then they are opened anew every two.

const QUIET = 2800, AGAIN = 2000, LOOK = 100;
const NAMES = ["snapshot", "lane", "doing", "scan", "hook", "beat"];

export function live({ hear, show }) {
  let source, id, opened, heard = -Infinity;
  const now = () => performance.now();
  const open = () => {
    source?.close();
    opened = now();
    source = new EventSource("/live");
    const mine = source;
    for (const name of NAMES) source.addEventListener(name, (event) => mine === source && take(event));
  };
  const take = (event) => {
    const at = Number(event.lastEventId);
    // Something was missed: what is shown may be wrong.
    if (event.type !== "snapshot" && at !== id + 1) return open();
    id = at;
    if (event.type === "snapshot" || event.type === "beat") heard = now();
    hear(event.type, JSON.parse(event.data));
    look();
  };
  const look = () => {
    const isLive = now() - heard < QUIET;
    show(isLive);
    if (!isLive && now() - opened >= AGAIN) open();
  };
  open();
  setInterval(look, LOOK);
}
