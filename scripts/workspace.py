"""Where the sources are and what is built from them, for scripts."""
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Where everything is built and kept.
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")


def built(*how):
    """Builds the programs from the present sources, with these options of cargo, and returns their folder."""
    build = ["cargo", "build", *how, "--quiet", "--locked", "--package", "halfrow-cli", "--package", "halfrow-station"]
    subprocess.run(build, cwd=ROOT, check=True)
    return TARGET / ("release" if "--release" in how else "debug")
