"""Reads a table of runs with Python's csv, and compares each cell with the records: read_table.py TABLE FOLDER."""
import csv
import json
import pathlib
import sys


def number(text):
    return float(text) if text else None


class Row(dict):
    """A row that records which cells were read."""

    looked = set()

    def __getitem__(self, name):
        self.looked.add(name)
        return super().__getitem__(name)


table, folder = sys.argv[1:]
records = [json.loads(path.read_text()) for path in pathlib.Path(folder).glob("*.json")]
records = {record["run"]["id"]: record for record in records}
with open(table, newline="", encoding="utf-8") as file:
    rows = [Row(row) for row in csv.DictReader(file, strict=True)]
lines = 0
for record in records.values():
    steps = [(step["seq"], step["attempt"], step["measurements"] or [None], step) for step in record["steps"]]
    whole = [(0, 1, record["measurements"], None)] if record["measurements"] else []
    found = iter([row for row in rows if row["run"] == record["run"]["id"]])
    for seq, attempt, measurements, step in steps + whole:
        for one in measurements:
            row = next(found)
            lines += 1
            run, plan, ended, board = record["run"], record["plan"], record["conclusion"], record["board"] or {}
            for name in ["product", "serial", "variant", "station", "lane", "operator", "target"]:
                assert row[name] == run[name], (name, row)
            assert (row["plan"], row["version"], row["plan_sha256"]) == (plan["name"], plan["version"], plan["sha256"])
            told = [board.get(name) or "" for name in ["kind", "device", "build"]]
            assert [row["board_kind"], row["device"], row["build"]] == told, row
            assert [int(row["started_ms"]), int(row["ended_ms"])] == [run["started_ms"], record["ended_ms"]]
            assert number(row["seconds"]) == record["seconds"]
            for name in ["verdict", "cause", "headline"]:
                assert row[name] == ended[name], (name, row)
            assert int(row["exit_code"]) == ended["exit_code"]
            assert row["program"] == record["program"], row
            assert row["code"] == (ended.get("finding") or {}).get("code", ""), row
            assert [row["production"], row["marginal"]] == [str(record[n]).lower() for n in ["production", "marginal"]]
            assert [int(row["seq"]), int(row["attempt"])] == [seq, attempt], row
            if step:
                assert [row["step"], row["step_outcome"], row["detail"]] == [step[n] for n in ["name", "outcome", "detail"]]
                assert [int(row["step_" + n]) for n in ["started_ms", "ended_ms"]] == [step[n] for n in ["started_ms", "ended_ms"]]
            if one:
                assert [row["measurement"], row["unit"]] == [one["name"], one["unit"]], row
                assert [number(row[n]) for n in ["value", "low", "high"]] == [one[n] for n in ["value", "low", "high"]], row
                assert [row["blames"], row["outcome"]] == [one["blames"], one["outcome"]], row
            else:
                assert row["measurement"] == row["value"] == row["outcome"] == "", row
    assert next(found, None) is None
assert lines == len(rows)
assert Row.looked == set(rows[0]), f"columns that are not compared: {sorted(set(rows[0]) - Row.looked)}"
print(f"{len(records)} runs, {lines} lines")
