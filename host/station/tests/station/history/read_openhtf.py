"""Builds OpenHTF's own test record from one of our files, lets OpenHTF write it, and compares: read_openhtf.py FILE...

OpenHTF 1.6.3 can write this JSON, but not read it. So a record of its own classes is built from our file, and what OpenHTF writes
of it must be that file. Its converter for the manufacturing inspector must accept the record, too.
"""
import json
import sys

from openhtf.core import measurements, test_record
from openhtf.output.callbacks import json_factory
from openhtf.output.proto import mfg_event_converter
from openhtf.util import validators


def limits(texts):
    """The validators of `LOW <= x <= HIGH`, where either side may be missing."""
    for text in texts:
        sides = text.split(" <= ")
        where = sides.index("x")
        low = float(sides[0]) if where else None
        high = float(sides[-1]) if where < len(sides) - 1 else None
        yield validators.InRange(low, high)


def measured(ours):
    one = measurements.Measurement(ours["name"], docstring=ours["docstring"])
    one.validators.extend(limits(ours.get("validators", [])))
    if "measured_value" in ours:
        one.measured_value.set(ours["measured_value"])
        one.validate()
    assert one.outcome.name == ours["outcome"], (one, ours)
    return one


def code(ours):
    return test_record.CodeInfo(ours["name"], ours["docstring"], ours["sourcecode"])


def phase(ours):
    made = test_record.PhaseRecord(ours["descriptor_id"], ours["name"], code(ours["codeinfo"]))
    made.measurements = {name: measured(one) for name, one in ours["measurements"].items()}
    made.start_time_millis, made.end_time_millis = ours["start_time_millis"], ours["end_time_millis"]
    made.outcome, made.marginal = test_record.PhaseOutcome[ours["outcome"]], ours["marginal"]
    return made


for path in sys.argv[1:]:
    ours = json.load(open(path, encoding="utf-8"))
    made = test_record.TestRecord(ours["dut_id"], ours["station_id"], code_info=code(ours["code_info"]), metadata=ours["metadata"])
    made.start_time_millis, made.end_time_millis = ours["start_time_millis"], ours["end_time_millis"]
    made.outcome, made.marginal = test_record.Outcome[ours["outcome"]], ours["marginal"]
    for detail in ours["outcome_details"]:
        made.add_outcome_details(detail["code"], detail["description"])
    for one in ours["phases"]:
        made.add_phase_record(phase(one))
    theirs = json.loads("".join(json_factory.stream_json(json_factory.convert_test_record_to_json(made))))
    for key in sorted(set(ours) | set(theirs)):
        assert ours.get(key) == theirs.get(key), f"{path}, {key}:\n{ours.get(key)}\n{theirs.get(key)}"
    event = mfg_event_converter.mfg_event_from_test_record(made)
    assert event.dut_serial == ours["dut_id"], event.dut_serial
print(f"{len(sys.argv) - 1} files")
