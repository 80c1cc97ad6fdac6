"""What the examples for GitHub and GitLab, and the script of docs/ci.md for any other system, call: told and run without these.
  called.py shell FOLDER    writes each piece of shell into FOLDER, as shellcheck reads it, and GitLab's jobs with all that they extend
  called.py run FOLDER      runs all jobs: FOLDER has the sources as GitHub fetches an action (action) and as a repository (halfrow.git)
An expression, condition or step that is not known here is an error, never passed over."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree

from ruamel.yaml import YAML

HERE = pathlib.Path(__file__).resolve().parent
BROKEN = "mock,fault=stuck-data,bit=7"


def read(name):
    return YAML(typ="safe").load(HERE / name)


def filled(text, known):
    """`text` with GitHub's expressions looked up in `known`."""
    def look_up(expression):
        value = known
        for name in expression[1].split("."):
            value = value[name]
        return value
    return re.sub(r"\$\{\{ *([\w.-]+) *\}\}", look_up, str(text))


def holds(condition, known, passed):
    """Whether a step's `if` holds."""
    if condition is None:
        return passed
    if condition == "always()":
        return True
    name, how, literal = re.fullmatch(r"([\w.-]+) (==|!=) '(.*)'", condition).groups()
    return passed and (filled("${{ " + name + " }}", known) == literal) == (how == "==")


def outputs(file):
    return dict(line.split("=", 1) for line in file.read_text().splitlines())


def use(step, known, work, failed):
    """What actions of GitHub itself do, as far as it matters here, behind steps of which one may have failed."""
    match step["uses"].split("@")[0]:
        case "actions/cache/restore":
            return {"cache-hit": "", "cache-primary-key": filled(step["with"]["key"], known)}
        case "actions/cache/save":
            assert (work / filled(step["with"]["path"], known)).is_dir(), "there is no program to keep"
            return {}
        case "actions/upload-artifact":
            name = filled(step["with"]["name"], known)
            assert name and "/" not in name, f"GitHub takes no artefact of the name `{name}`"
            kept = list((work / filled(step["with"]["path"], known)).rglob("*"))
            assert kept or failed or step["with"]["if-no-files-found"] != "error", "there is nothing to keep"
            return {}
    raise ValueError(f"{step['uses']} is not known here")


def github(folder, inputs, earlier=None):
    """Runs the action, in a folder with the report of an `earlier` run if there is one: its exit code, and what it shows."""
    action = read("verify/action.yml")
    work, shown = folder / "work", folder / "shown"
    (folder / "temporary").mkdir(parents=True)
    work.mkdir()
    if earlier:
        shutil.copytree(earlier, work / inputs["report"])
    shown.touch()
    defaults = {name: each["default"] for name, each in action["inputs"].items()}
    known = {"inputs": defaults | inputs, "steps": {}, "runner": {"os": "Linux", "arch": "X64", "temp": str(folder / "temporary")}}
    failed = 0
    for number, step in enumerate(action["runs"]["steps"]):
        if not holds(step.get("if"), known, not failed):
            continue
        told = folder / f"outputs-{number}"
        told.touch()
        if "uses" in step:
            known["steps"][step.get("id", number)] = {"outputs": use(step, known, work, failed)}
            continue
        variables = {name: filled(value, known) for name, value in step.get("env", {}).items()}
        variables |= {"GITHUB_ACTION_PATH": str(folder.parent / "action/ci/verify"), "GITHUB_OUTPUT": str(told),
                      "GITHUB_STEP_SUMMARY": str(shown), "RUNNER_TEMP": str(folder / "temporary")}
        ended = subprocess.run(["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", step["run"]], cwd=work, env=os.environ | variables)
        failed = failed or ended.returncode
        known["steps"][step.get("id", number)] = {"outputs": outputs(told)}
    return filled(action["outputs"]["exit-code"]["value"], known), failed, shown.read_text()


def gitlab_jobs():
    """Each job with what it extends, and its shell."""
    file = read("gitlab.yml")
    for name, job in file.items():
        if "extends" not in job or name.startswith("."):
            continue
        whole = file[job["extends"]] | {key: value for key, value in job.items() if key != "extends"}
        variables = file["variables"] | file[job["extends"]]["variables"] | job["variables"]
        whole |= {"variables": variables}
        hidden = [path for path in whole["artifacts"]["paths"] if "$" in path]
        assert not hidden, f"GitLab does not show {hidden} of {name}, since a variable is in it"
        yield name, whole, variables, "\n".join(whole["before_script"] + whole["script"]) + "\n"


def gitlab(folder, job, variables, shell):
    """Runs a job: its exit code, and its checks by what became of them."""
    folder.mkdir(parents=True, exist_ok=True)
    variables = variables | {"HALFROW_SOURCE": f"file://{folder.parent}/halfrow.git"}
    ended = subprocess.run(["bash", "-eo", "pipefail", "-c", shell], cwd=folder, env=os.environ | variables)
    report = folder / job["artifacts"]["reports"]["junit"]
    assert all((folder / path).is_dir() for path in job["artifacts"]["paths"])
    cases = list(xml.etree.ElementTree.parse(report).iter("testcase"))
    return ended.returncode, [case.get("name") for case in cases if case.find("failure") is not None], len(cases)


def other_shell():
    """The script of the page for anything with a shell, of which there is one."""
    found = re.findall(r"^```sh\n(.*?)^```$", (HERE.parent / "docs/ci.md").read_text(), re.M | re.S)
    assert len(found) == 1, f"docs/ci.md has {len(found)} scripts"
    return found[0]


def other(folder, programs, board, shell):
    """Runs it as Jenkins does, without its pauses: its exit code, how often it paused, and whether its report has a check that failed."""
    (folder / "bin").mkdir(parents=True, exist_ok=True)
    (folder / "bin/sleep").write_text("#!/bin/sh\necho >>paused\n")
    (folder / "bin/sleep").chmod(0o755)
    paused = folder / "paused"
    paused.write_text("")
    found = f"{folder / 'bin'}:{programs}:{os.environ['PATH']}"
    ended = subprocess.run(["sh", "-e", "-c", shell], cwd=folder, env=os.environ | {"PATH": found, "BOARD": board})
    cases = xml.etree.ElementTree.parse(folder / "report/report.xml").iter("testcase")
    return ended.returncode, len(paused.read_text()), any(list(case.iterfind(kind)) for case in cases for kind in ("failure", "error"))


def run_other(folder, programs):
    """The script with a mock in the board's place, which it must refuse; without that, as with a board; and with no board at all."""
    shell = other_shell()
    asks = shell.replace(" --require-hardware", "")
    assert asks != shell
    for told, board, script, expected in [("a PASS", "mock", asks, (0, 0, False)), ("a mock behind it", "mock", shell, (5, 0, True)),
                                          ("a broken board", BROKEN, asks, (1, 0, True)),
                                          ("no board, asked for twice", "serial:/dev/halfrow-none", shell, (3, 2, True))]:
        result = other(folder, programs, board, script)
        assert result == expected, (told, result)
        print(f"any other system, {told}: {result[0]}")


def run(folder):
    job = read("github.yml")["jobs"]["verify"]
    for row in job["strategy"]["matrix"]["include"]:
        given = {name: filled(value, {"matrix": row}) for name, value in job["steps"][1]["with"].items()}
        told, failed, shown = github(folder / f"github-{row['name']}", given)
        assert (told, failed) == ("0", 0) and "| passed |" in shown and "FAIL" not in shown, (told, failed, shown)
        print(f"GitHub, {row['name']}: PASS, {shown.count('| passed |')} checks shown")
    passed = folder / "github-mock/work/report-mock"
    told, failed, shown = github(folder / "github-refused", {"report": "kept/report", "arguments": "--width 3"}, passed)
    assert (told, failed) == ("2", 2) and "No report could be read" in shown, (told, failed, shown)
    print("GitHub, a wrong call behind a PASS: refused, and nothing of the PASS is shown")
    told, failed, shown = github(folder / "github-broken", {"board": BROKEN})
    assert (told, failed) == ("1", 1) and "| FAIL |" in shown, (told, failed, shown)
    print("GitHub, a broken board: FAIL, shown and kept")
    for name, job, variables, shell in gitlab_jobs():
        code, failures, cases = gitlab(folder / f"gitlab-{name}", job, variables, shell)
        assert code == 0 and not failures and cases, (code, failures, cases)
        print(f"GitLab, {name}: PASS, {cases} checks in JUnit")
        if name == "mock":
            code, failures, _ = gitlab(folder / f"gitlab-{name}", job, variables | {"BOARD": BROKEN}, shell)
            assert code == 1 and failures, (code, failures)
            print("GitLab, a broken board: FAIL, by JUnit too")
    run_other(folder / "other", folder / "gitlab-mock/.halfrow/bin")


def write_shell(folder):
    folder.mkdir(parents=True)
    steps = [step for step in read("verify/action.yml")["runs"]["steps"] if "run" in step]
    for number, step in enumerate(steps):
        known = "".join(f"{name}=${{{name}:?}}\n" for name in step.get("env", {}))
        (folder / f"github-{number}").write_text(f"#!/bin/bash -e\n{known}{step['run']}")
    jobs = list(gitlab_jobs())
    YAML(typ="safe").dump({"stages": read("gitlab.yml")["stages"]} | {name: job for name, job, _, _ in jobs}, folder.parent / "gitlab.yml")
    for name, _, variables, shell in jobs:
        known = "".join(f"{variable}=${{{variable}:?}}\n" for variable in variables)
        # $ARGUMENTS is parted at its spaces there, as the example says.
        (folder / f"gitlab-{name}").write_text(f"#!/bin/bash -e\n# shellcheck disable=SC2086\n{known}{shell}")


    (folder / "other").write_text(f"#!/bin/sh -e\nBOARD=${{BOARD:?}}\n{other_shell()}")


def main():
    what, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    {"shell": write_shell, "run": run}[what](folder)


main()
