"""Where the sources are and what is built from them, for scripts."""
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Where everything is built and kept.
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
# Everything is built with the simulated board, so that it is built once: `sim` of scripts/steps.
SIM = ["--workspace", "--features", "halfrow-tests/sim"]


def built(*how):
    """Builds the programs from the present sources, with these options of cargo, and returns their folder."""
    build = ["cargo", "build", *how, "--quiet", "--locked", "--package", "halfrow-cli", "--package", "halfrow-station"]
    subprocess.run(build, cwd=ROOT, check=True)
    return TARGET / ("release" if "--release" in how else "debug")


def program(package):
    """Builds the optimised program of a package, and returns its path."""
    build = ["cargo", "build", "--release", "--locked", "--package", package, "--message-format=json-render-diagnostics"]
    messages = subprocess.run(build, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    if messages.returncode:
        sys.exit(f"{sys.argv[0]}: {package} could not be built, as said above")
    paths = [json.loads(line).get("executable") for line in messages.stdout.splitlines()]
    return [path for path in paths if path][-1]
