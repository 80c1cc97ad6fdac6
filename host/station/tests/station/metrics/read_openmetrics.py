"""Reads figures with the reference parsers, and compares both formats: read_openmetrics.py OPENMETRICS TEXT"""
import sys

from prometheus_client import parser
from prometheus_client.openmetrics import parser as open_parser

# Changes between the two requests.
CHANGES = {"halfrow_outbox_oldest_seconds"}


def samples(families):
    return {
        (sample.name, tuple(sorted(sample.labels.items()))): sample.value
        for family in families
        for sample in family.samples
        if family.name not in CHANGES
    }


def text(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


families = list(open_parser.text_string_to_metric_families(text(sys.argv[1])))
for family in families:
    assert family.documentation, f"{family.name} has no help"
    assert family.name.endswith("_seconds") == (family.unit == "seconds"), family
found, expected = samples(families), samples(parser.text_string_to_metric_families(text(sys.argv[2])))
assert found == expected, set(found.items()) ^ set(expected.items())
assert any(name == "halfrow_runs_total" for name, _ in found), sorted(found)
print(f"{len(families)} metrics, {len(found)} samples")
