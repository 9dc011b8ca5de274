#!/usr/bin/env python3
"""lint_units.py BUILD COUNT: writes BUILD/units/unit_N.cpp, COUNT files that together include all sources of
the unity build in the folder BUILD, and how to compile them; prints their names, each ended by NUL. What
the build compiles alone is a unit of its own.

clang-tidy spends most of its time on the headers of libraries, anew for every unit: few units are fast.
Left out are descriptors of plugins, a macro each."""
import json
import re
import shlex
import sys
from pathlib import Path

OPTIONS = re.compile(r"-(?!Wshadow)[IDWfms]|-isystem$|-std=")  # files of a unit may use a name twice


def sources_of(entry):
    file = Path(entry["file"])
    if "Unity" not in file.parts:
        return [file]
    return [Path(name) for name in re.findall(r'^#include "(.*)"', file.read_text(), re.MULTILINE)]


def options_of(entry):
    words = shlex.split(entry["command"])
    for i, word in enumerate(words):
        if OPTIONS.match(word):
            yield word + words[i + 1] if word == "-isystem" else word


class Unit:
    def __init__(self):
        self.size, self.sources, self.options = 0, [], {}

    def add(self, sources, options):
        self.size += sum(file.stat().st_size for file in sources)
        self.sources += sources
        self.options.update(dict.fromkeys(options))


def units_of(build: Path, count: int):
    shared, alone = [Unit() for _ in range(count)], []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        sources = [file for file in sources_of(entry)
                   if file.name != "plugin.cpp" and build not in file.parents]
        if not sources:
            continue
        if sources == [Path(entry["file"])]:
            alone.append(Unit())
            alone[-1].add(sources, options_of(entry))
        else:
            min(shared, key=lambda unit: unit.size).add(sources, options_of(entry))
    return shared + alone


def main():
    build = Path(sys.argv[1]).resolve()
    folder = build / "units"
    folder.mkdir(exist_ok=True)
    commands = []
    for number, unit in enumerate(units_of(build, int(sys.argv[2]))):
        file = folder / f"unit_{number}.cpp"
        file.write_text("".join(f'#include "{source}"\n' for source in unit.sources))
        commands.append({"directory": str(build), "file": str(file),
                         "arguments": ["clang++", *unit.options, "-c", str(file)]})
        print(file, end="\0")
    (folder / "compile_commands.json").write_text(json.dumps(commands, indent=2))


if __name__ == "__main__":
    main()
