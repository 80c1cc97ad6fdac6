"""Runs a station for scripts: boards in, verdicts out."""
import contextlib
import json
import subprocess

from workspace import ROOT

# A plan whose runs are short.
PLAN = (ROOT / "host/station/tests/station/quick.toml").read_text()


class Station:
    """A station's settings in a folder, with a lane for each board, and its program."""

    def __init__(self, program, folder, data, boards, plan=PLAN):
        self.program, self.data = program, data
        (folder / "plan.toml").write_text(plan)
        text = f'schema = 1\n[station]\nname = "12"\ndata = "{data}"\n'
        for number, board in enumerate(boards, 1):
            text += f'[[lane]]\nname = "{number}"\nboard = "{board}"\nplans = ["plan.toml"]\n'
        self.settings = folder / "station.toml"
        self.settings.write_text(text)

    def start(self, **streams):
        return subprocess.Popen([self.program, "lanes", "--settings", self.settings], text=True, **streams)

    @contextlib.contextmanager
    def at_work(self, **streams):
        """The running program, which is killed at the end, so that it does not outlive its caller or keep a disk busy."""
        process = self.start(**streams)
        try:
            yield process
        finally:
            process.kill()
            process.wait()

    def judge(self, runs, seen=lambda: None, at_end=lambda process: None):
        """Judges this many boards, in all lanes at once. Returns each verdict that was shown, with what `seen` returned then."""
        shown, given, busy = {}, 0, set()
        with self.at_work(stdin=subprocess.PIPE, stdout=subprocess.PIPE) as station:
            for line in station.stdout:
                news = json.loads(line)
                if news["news"] != "lane":
                    continue
                lane, verdict = news["lane"], news["shown"]
                if verdict and verdict["run"] not in shown:
                    shown[verdict["run"]] = (verdict, seen())
                    busy.discard(lane)
                if given < runs and lane not in busy and (verdict or news["state"] == "READY"):
                    given += 1
                    busy.add(lane)
                    station.stdin.write(f"HR:LANE:{lane}\nCAT{given:05}\n")
                    station.stdin.flush()
                if len(shown) == runs and not station.stdin.closed:
                    at_end(station)
                    station.stdin.close()
            assert station.wait() == 0 and len(shown) == runs, f"{len(shown)} of {runs} boards were judged"
        return list(shown.values())

    def restarts(self):
        """Starts the station on what is there, then checks that. Returns an empty text, or what they said is wrong."""
        started = self.start(stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        _, complaints = started.communicate()
        call = [self.program, "check", "--json", "--data", self.data]
        checked = subprocess.run(call, capture_output=True, text=True)
        if started.returncode == 0 and checked.returncode == 0 and json.loads(checked.stdout)["open"] == 0:
            return ""
        return complaints + checked.stdout + checked.stderr
