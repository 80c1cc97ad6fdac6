"""Checks bills of materials by CycloneDX's own schema, which PyPI's cyclonedx-python-lib ships: check_sbom.py FILE..."""

import json
import sys

from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

# What every program is made of.
CERTAIN = {"halfrow", "halfrow-protocol", "clap", "libusb1-sys", "libusb"}


def main():
    validator = JsonStrictValidator(SchemaVersion.V1_5)
    for path in sys.argv[1:]:
        text = open(path, encoding="utf-8").read()
        if (fault := validator.validate_str(text)) is not None:
            sys.exit(f"{path} is no bill of materials: {fault}")
        bill = json.loads(text)
        components = bill["components"]
        if (absent := CERTAIN - {component["name"] for component in components}):
            sys.exit(f"{path} does not tell of {', '.join(sorted(absent))}")
        if (unlicensed := [component["name"] for component in components if not component.get("licenses")]):
            sys.exit(f"{path} has no licence of {', '.join(unlicensed)}")
        # The control: the schema does not take everything.
        del components[0]["name"]
        if validator.validate_str(json.dumps(bill)) is None:
            sys.exit("the schema takes a component without a name")
        print(f"{path}: {len(components)} components")


main()
