#!/usr/bin/env python3
"""Runs the commands of the handbook and the README with the programs that the gate builds, and compares what they print.

Commands are fences of `sh`, and indented lines that begin with a program's name. Those of a page run one after the other in a scratch
folder of its own, with the repository's folders beside it, and must end with exit code 0. A fence's first line may say otherwise:
    ```sh exit=1            this exit code
    ```sh background        goes on until the page ends; the next one waits for its first line
    ```sh not-run="REASON"  is not run, since …
and so may a comment in front of a block, <!-- not run: REASON -->, or <!-- commands of this page are not run: REASON -->. A fence of `text`
behind commands is what they print: … stands for anything in a line, and a line of … alone for any lines. 3001 becomes a port that is free.
A fence of `python from=FILE` is a part of that file, line for line. What is run or not: every command, and every option behind it, in a block or in `code`, must be one of COMMANDS.md or STATION-COMMANDS.md."""

import os
import pathlib
import re
import select
import signal
import socket
import subprocess
import sys
import tempfile

from workspace import ROOT, SIM, TARGET

DOCS = ROOT / "docs"
PROGRAM = re.compile(r"(?:halfrow|halfrow-station|cargo|sudo|apt-get|createdb|systemctl|install|curl|python3|pip|git|scripts/\S+) ")
BESIDE = ["docs", "fpga", "host", "protocol", "python", "scripts", "README.md", "Cargo.toml"]
SECONDS = 120


def pages():
    """README.md, then the chapters in the order of SUMMARY.md."""
    yield ROOT / "README.md"
    for target in re.findall(r"\]\(([^)]+\.md)\)", (DOCS / "SUMMARY.md").read_text()):
        yield (DOCS / target).resolve()


class Block:
    """Commands of a page, and what the page says about them."""

    def __init__(self, page, line, says, reason):
        self.page, self.line, self.text, self.expected = page, line, [], None
        self.exit = int((re.search(r"exit=(\d+)", says) or [0, 0])[1])
        self.is_background = " background" in says
        self.reason = (re.search(r'not-run="([^"]+)"', says) or [0, reason])[1]

    def __str__(self):
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def pieces(page):
    """A page in pieces, each with its kind (the fence's first line, `indented`, `prose` or `comment`), its first line number and
    its lines."""
    piece = None
    for number, line in enumerate(page.read_text().split("\n"), 1):
        if piece and piece[0].startswith("```"):
            if line.startswith("```"):
                yield piece
                piece = None
            else:
                piece[2].append(line)
            continue
        kind = (line if line.startswith("```") else "comment" if line.startswith("<!--") else
                "indented" if line.startswith("    ") else "prose" if line.strip() else None)
        if piece and kind != piece[0]:
            yield piece
            piece = None
        if kind:
            piece = piece or (kind, number, [])
            piece[2].extend([] if kind.startswith("```") else [line])
    if piece:
        yield piece


def blocks(page):
    """The blocks of commands of a page, each with its expected output if that follows it."""
    found, last, reason, whole = [], None, None, None
    for kind, line, lines in pieces(page):
        if kind == "comment":
            for text in lines:
                reason = (re.match(r"<!-- not run: (.+) -->", text) or [0, reason])[1]
                whole = (re.match(r"<!-- commands of this page are not run: (.+) -->", text) or [0, whole])[1]
            continue
        if kind.startswith("```text") and last:
            last.expected = lines
        elif kind.startswith("```sh") or kind == "indented" and PROGRAM.match(lines[0].strip() + " "):
            last = Block(page, line, kind, reason or whole)
            last.text = [text.removeprefix("    ") if kind == "indented" else text for text in lines]
            found.append(last)
            reason = None
            continue
        last = reason = None
    return found


def pattern(lines):
    """A pattern that matches the expected lines."""
    whole = [r"(?:.*\n)*?" if line.strip() == "…" else re.escape(line.rstrip()).replace("…", ".*") + r"[ ]*\n" for line in lines]
    return re.compile("".join(whole))


class Scratch:
    """A scratch folder for a page, and the processes that run in it."""

    def __init__(self, programs):
        self.folder = tempfile.TemporaryDirectory(prefix="handbook-")
        for name in BESIDE:
            os.symlink(ROOT / name, pathlib.Path(self.folder.name) / name)
        kept = {name: value for name, value in os.environ.items() if not name.startswith(("HALFROW_", "XDG_"))}
        self.environment = kept | {"HOME": self.folder.name, "PATH": f"{programs}:{os.environ['PATH']}", "NO_COLOR": "1"}
        self.background = []
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = str(free.getsockname()[1])

    def shell(self, text, **streams):
        command = ["bash", "-euo", "pipefail", "-c", text.replace("3001", self.port)]
        return subprocess.Popen(command, cwd=self.folder.name, env=self.environment, text=True, start_new_session=True, **streams)

    def run(self, block):
        """Runs a block, and returns what is wrong with it, if anything."""
        text = "\n".join(block.text)
        if block.is_background:
            started = self.shell(text, stdout=subprocess.PIPE)
            # Whatever becomes of it, `close` ends it.
            self.background.append(started)
            if not select.select([started.stdout], [], [], SECONDS)[0]:
                return f"{block}: it said nothing for {SECONDS} s"
            return None if started.stdout.readline() else f"{block}: it ended at once"
        started = self.shell(text, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            said, told = started.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(started.pid, signal.SIGKILL)
            return f"{block}: it takes longer than {SECONDS} s"
        if started.returncode != block.exit:
            return f"{block}: ended with {started.returncode}, not {block.exit}:\n{said}{told}"
        if block.expected is not None and not pattern(block.expected).fullmatch(said.replace(self.port, "3001")):
            return f"{block}: prints something else than the page says:\n{said}"
        return None

    def close(self):
        for started in self.background:
            os.killpg(started.pid, signal.SIGKILL)
            started.wait()
        self.folder.cleanup()


def options():
    """The options of every command, by its name. Options that all commands share are in each."""
    known = {}
    for page, program in ("COMMANDS.md", "halfrow"), ("STATION-COMMANDS.md", "halfrow-station"):
        name = program
        for line in (DOCS / page).read_text().split("\n"):
            if line.startswith("## "):
                name = {"## Every command": program}.get(line, line[3:])
                known[name] = {"--help", "--version"} | known.get(program, set())
            if row := re.match(r"\| (`[^`]*`(?:, `[^`]*`)*) \|", line):
                known[name].update(re.findall(r"--[a-z0-9-]+", row[1]))
    return known


def lines_of_commands(page):
    """The numbers of the lines that are commands."""
    shell = [(kind, line, lines) for kind, line, lines in pieces(page) if kind == "indented" or kind.startswith("```sh")]
    return {line + at for kind, line, lines in shell for at, _ in enumerate(lines, kind != "indented")}


def unknown(page, known):
    """Commands and options that a page uses and that do not exist."""
    text, commands = page.read_text(), lines_of_commands(page)
    # Among commands, a program may stand behind anything, such as what starts a container, but a name in front of one is a user's.
    for call in re.finditer(r"(`|^ *|sudo -u halfrow |(?<= ))(halfrow(?:-station)?)(?! +halfrow)((?: [^`\n|#;]*)?)", text, re.M):
        line = text.count("\n", 0, call.start(2)) + 1
        if not call[1] and call.start() and text[call.start() - 1] == " " and line not in commands:
            continue
        program, words = call[2], call[3].split(" -- ")[0].split()
        name, following, given = program, words, [word.split("=")[0] for word in words if re.match(r"--[a-z]", word)]
        where = f"{page.relative_to(ROOT)}:{line}"
        for place, word in enumerate(words):
            if f"{name} {word}" in known:
                name, following = f"{name} {word}", words[place + 1:]
        is_prose = not call[1] and line not in commands and text.count("```", 0, call.start()) % 2 == 0
        has_commands = any(other.startswith(f"{name} ") for other in known)
        if has_commands and not is_prose and following and re.fullmatch("(?!help$)[a-z][a-z-]*", following[0]):
            yield f"{where}: {name} has no command {following[0]}"
        for option in given:
            if option not in known[name]:
                yield f"{where}: {name} has no {option}"


def changed(page):
    """Fences that claim to be from a file and are not in it."""
    for kind, line, lines in pieces(page):
        if (source := re.match(r"```\w+ from=(\S+)", kind)) and "\n".join(lines) not in (page.parent / source[1]).read_text():
            yield f"{page.relative_to(ROOT)}:{line}: these lines do not stand in {source[1]}"


def check(page, programs):
    scratch, counts = Scratch(programs), [0, 0]
    try:
        for block in blocks(page):
            counts[block.reason is not None] += 1
            if block.reason is None and (wrong := scratch.run(block)):
                return counts, [wrong]
    finally:
        scratch.close()
    return counts, []


def main():
    build = ["cargo", "build", "--quiet", *SIM, "--locked", "--bin", "halfrow", "--bin", "halfrow-station", "--test", "command_line"]
    if subprocess.run(build, cwd=ROOT, check=False).returncode:
        sys.exit("scripts/handbook: the programs could not be built")
    known, wrong, ran, left = options(), [], 0, 0
    for page in dict.fromkeys(pages()):
        counts, found = check(page, (TARGET / "debug").resolve())
        ran, left = ran + counts[0], left + counts[1]
        wrong += [*found, *unknown(page, known), *changed(page)]
    print(f"{ran} blocks of commands run, {left} named as not to be run here")
    if wrong:
        sys.exit("\n".join(["scripts/handbook: commands that are not right", *wrong]))


if __name__ == "__main__":
    main()
