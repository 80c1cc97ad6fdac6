// The station's news. Without a beat for almost three seconds nothing here is live; then the page reconnects every two seconds.

const QUIET = 2800, AGAIN = 2000, LOOK = 100, RELOADS = 10000;
const NAMES = ["snapshot", "lane", "doing", "scan", "hook", "beat"];

// `mark` is the mark with which the page was made. Returns a function that gives the last beat heard, or "" while the page is not
// live.
export function live({ mark, hear, show }) {
  let source, id, opened, beat = "", heard = -Infinity;
  const now = () => performance.now();
  const isLive = () => now() - heard < QUIET;
  const open = () => {
    source?.close();
    opened = now();
    source = new EventSource("/live");
    const mine = source;
    for (const name of NAMES) source.addEventListener(name, (event) => mine === source && take(event));
  };
  // The lanes, the plans, the program or the person are not those of this page any more.
  const leave = () => {
    source.close();
    [source, opened] = [undefined, now() + RELOADS];
    location.reload();
  };
  const take = (event) => {
    const at = Number(event.lastEventId), said = JSON.parse(event.data);
    if (event.type === "snapshot" && said.mark !== mark) return leave();
    // Some news were missed, so what is shown may be wrong.
    if (event.type !== "snapshot" && at !== id + 1) return open();
    id = at;
    if (said.beat) [beat, heard] = [said.beat, now()];
    hear(event.type, said);
    look();
  };
  const look = () => {
    show(isLive());
    if (!isLive() && now() - opened >= AGAIN) open();
  };
  open();
  setInterval(look, LOOK);
  return () => (isLive() ? beat : "");
}
