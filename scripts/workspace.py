"""Where the sources are, and what is built of them, for scripts."""
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Where everything is built and kept.
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")


def built(*how):
    """The folder of the programs as the sources have them now, built with these options of cargo's."""
    build = ["cargo", "build", *how, "--quiet", "--locked", "--package", "halfrow-cli", "--package", "halfrow-station"]
    subprocess.run(build, cwd=ROOT, check=True)
    return TARGET / ("release" if "--release" in how else "debug")
