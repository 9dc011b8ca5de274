#!/usr/bin/env python3
"""run_page.py PAGE FOLDER [--prefix DIR] [--cache DIR] [--keep]: types a page of the guide, from top to
bottom, into a shell in the empty FOLDER, with the program of an installation.

    ```sh                        is run; every command must succeed
    ```LANGUAGE title="FILE"     is written to FILE in FOLDER
    ```yaml                      is a part of a pipeline file: it must pass `stillpoint check`
    ```text                      is what something looks like; not run
    ```console                   the same, with commands and what they print

A comment directly before a block says what is different:

    <!-- not run: WHY -->        the block is shown only; the reason is for authors
    <!-- exits with N -->        the last command of the sh block ends with this code
    <!-- output -->              the text block is what the sh block before printed: its lines occur in it
                                 in this order, … stands for anything, a number for any number
    <!-- before: COMMAND -->     is run before the block, and not shown
    <!-- needs: COMMAND -->      the block is left out where this command fails

Recordings made by `stillpoint simulate` are kept in --cache: the same command always gives the same
bytes, and every page begins with one.
"""
import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path

from markdown_page import blocks_of

# Sections of a pipeline file.
SECTIONS = {"version", "extends", "plugins", "camera", "source", "segmenter", "segmentation", "propagator",
            "moving_checker", "map_checker", "decision", "tracker", "local_mapper", "loop_closer",
            "map_backend", "outputs", "runtime"}
NUMBER = r"[-+]?\d+(?:[.,]\d+)*(?:e[-+]?\d+)?"

PROLOGUE = r"""
set -e -o pipefail
docs_simulate() {  # the same recording for all pages: simulating one takes longer than all the rest
  local out kept i words=(simulate)
  if [[ -z ${DOCS_CACHE:-} ]]; then stillpoint simulate "$@"; return; fi
  for ((i = 1; i <= $#; ++i)); do
    if [[ ${!i} == -o ]]; then ((++i)); out=${!i}; else words+=("${!i}"); fi
  done
  kept=$DOCS_CACHE/$(printf '%s ' "${words[@]}" | tr -c 'a-zA-Z0-9_.=-' _)
  (
    flock 9
    if [[ ! -d $kept ]]; then
      rm -rf "$kept.part"  # left by a test that was stopped
      stillpoint "${words[@]}" -o "$kept.part" && mv "$kept.part" "$kept"
    fi
  ) 9>"$kept.lock"
  if [[ -e $out ]]; then stillpoint simulate "$@"; return; fi  # says what is wrong
  mkdir -p "$(dirname "$out")"
  cp -r "$kept" "$out"
}
"""
EPILOGUE = r"""
export -p >"$DOCS_STATE"
"""


class Failure(Exception):
    pass


class Shell:
    """One terminal: folder and variables stay from block to block."""

    def __init__(self, folder: Path, environment: dict):
        self.folder = folder
        self.environment = dict(environment)
        self.state = folder.parent / (folder.name + ".state")
        self.environment["DOCS_STATE"] = str(self.state)

    def run(self, commands: str, code: int = 0):
        self.state.write_text("")
        commands = re.sub(r"^stillpoint simulate (?!.*\.yaml)", "docs_simulate ", commands,
                          flags=re.MULTILINE)
        script = PROLOGUE + commands
        if code:  # the epilogue would hide the code of the last command
            script = PROLOGUE + "set +e\n" + commands + "\ncode=$?\n" + EPILOGUE + "\nexit $code\n"
        else:
            script += EPILOGUE
        done = subprocess.run(["bash", "-c", script], cwd=self.folder, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace",
                              stdin=subprocess.DEVNULL)
        if done.returncode == code:
            self.keep_variables()
        return done.returncode, done.stdout

    def keep_variables(self):
        """The folder that the block has gone to, and what it has exported."""
        for line in self.state.read_text().splitlines():
            match = re.match(r"declare -x (\w+)=(.*)$", line)
            if not match:
                continue
            value = " ".join(shlex.split(match[2]))
            if match[1] == "PWD":
                self.folder = Path(value)
            elif match[1] not in ("OLDPWD", "SHLVL", "_"):
                self.environment[match[1]] = value


def expected_pattern(line: str):
    """A line that is shown, as a regular expression for one that is printed: numbers may differ."""
    pattern = ""
    for part in re.split(rf"(…|\s+|{NUMBER})", line.strip()):
        if part == "…":
            pattern += ".*"
        elif part.strip() == "":
            pattern += r"\s+" if part else ""
        elif re.fullmatch(NUMBER, part):
            pattern += NUMBER
        else:
            pattern += re.escape(part)
    return pattern


def missing_line(shown: str, printed: str):
    """The first line of `shown` that does not follow in `printed`."""
    rest = printed.splitlines()
    for line in shown.splitlines():
        if line.strip() in ("", "…"):
            continue
        pattern = re.compile(r"\s*" + expected_pattern(line) + r"\s*$")
        for i, candidate in enumerate(rest):
            if pattern.match(candidate):
                rest = rest[i + 1:]
                break
        else:
            return line
    return None


def top_keys(yaml: str):
    return re.findall(r"^([A-Za-z_]\w*):", yaml, re.MULTILINE)


class Page:
    def __init__(self, page: Path, shell: Shell):
        self.page, self.shell = page, shell
        self.printed = ""
        self.counts = {"run": 0, "written": 0, "checked": 0, "compared": 0, "not run": 0, "left out": 0}

    def fail(self, block, what: str, output: str = ""):
        text = "\n".join("  | " + line for line in output.splitlines()[-40:])
        raise Failure(f"{self.page}:{block.line}: {what}\n{text}")

    def type(self):
        for block in blocks_of(self.page):
            self.block(block)

    def block(self, block):
        code, not_run, output, missing = 0, False, False, False
        for note in block.notes:
            if note.startswith("not run:") and len(note) > len("not run: "):
                not_run = True
            elif re.fullmatch(r"exits with \d+", note):
                code = int(note.split()[-1])
            elif note == "output":
                output = True
            elif note.startswith("before:"):
                self.run(block, note[len("before:"):].strip())
            elif note.startswith("needs:"):
                missing = missing or self.shell.run(note[len("needs:"):])[0] != 0
        if missing:
            print(f"{self.page.name}:{block.line}: left out, {', '.join(block.notes)}", flush=True)
            self.printed = None
            self.counts["left out"] += 1
        elif not_run:
            self.counts["not run"] += 1
        elif block.title:
            file = self.shell.folder / block.title
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(block.text, encoding="utf-8")
            self.counts["written"] += 1
        elif block.language == "sh":
            self.run(block, block.text, code)
            self.counts["run"] += 1
        elif block.language == "yaml":
            self.check_yaml(block)
            self.counts["checked"] += 1
        elif block.language in ("text", "console", "bibtex"):
            if output and self.printed is not None:
                self.compare(block)
                self.counts["compared"] += 1
        else:
            self.fail(block, f"a block of '{block.language}' needs title=\"FILE\", or before it: "
                             "<!-- not run: WHY -->")

    def run(self, block, commands: str, code: int = 0):
        begin = time.monotonic()
        ended, self.printed = self.shell.run(commands, code)
        print(f"{self.page.name}:{block.line}: {time.monotonic() - begin:5.1f} s  "
              f"{commands.strip().splitlines()[0][:80]}", flush=True)
        if ended != code:
            self.fail(block, f"exit code {ended} instead of {code} of:\n{commands}", self.printed)

    def check_yaml(self, block):
        keys = top_keys(block.text)
        if not keys or not set(keys) <= SECTIONS:
            other = sorted(set(keys) - SECTIONS)
            self.fail(block, f"no part of a pipeline file ({', '.join(other) or 'no keys'}): give it a title")
        text = block.text if "version" in keys else "version: 1\nextends: stillpoint\n" + block.text
        (self.shell.folder / "fragment.yaml").write_text(text, encoding="utf-8")
        ended, printed = self.shell.run("stillpoint check fragment.yaml")
        if ended != 0:
            self.fail(block, "stillpoint check refuses it", printed)

    def compare(self, block):
        line = missing_line(block.text, self.printed)
        if line is not None:
            self.fail(block, f"this line was not printed, or not in this order:\n{line}\nbut:", self.printed)


def environment_of(arguments):
    environment = {key: value for key, value in os.environ.items()
                   if not key.startswith(("STILLPOINT_", "CMAKE_PREFIX")) and key != "PYTHONPATH"}
    if arguments.prefix:
        environment["PATH"] = f"{arguments.prefix}/bin:" + environment.get("PATH", "")
    environment.setdefault("CCACHE_DIR", os.path.expanduser("~/.cache/ccache"))
    environment["HOME"] = str(arguments.folder / ".home")
    environment["LC_ALL"] = "C.UTF-8"
    environment.pop("CTEST_OUTPUT_ON_FAILURE", None)
    if arguments.cache:
        arguments.cache.mkdir(parents=True, exist_ok=True)
        environment["DOCS_CACHE"] = str(arguments.cache)
    return environment


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("page", type=Path)
    parser.add_argument("folder", type=lambda text: Path(text).resolve())
    parser.add_argument("--prefix", help="folder of the installation; its program comes first")
    parser.add_argument("--cache", type=lambda text: Path(text).resolve(), help="folder for recordings")
    parser.add_argument("--keep", action="store_true", help="leave FOLDER when all went well")
    arguments = parser.parse_args()
    shutil.rmtree(arguments.folder, ignore_errors=True)
    (arguments.folder / ".home").mkdir(parents=True)
    page = Page(arguments.page, Shell(arguments.folder, environment_of(arguments)))
    try:
        page.type()
    except (Failure, ValueError) as failure:
        print(f"{failure}\n(in {arguments.folder})")
        return 1
    print(", ".join(f"{count} {what}" for what, count in page.counts.items() if count) or "no blocks")
    if not arguments.keep:
        shutil.rmtree(arguments.folder, ignore_errors=True)
        page.shell.state.unlink(missing_ok=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
