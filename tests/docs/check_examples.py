#!/usr/bin/env python3
"""check_examples.py ROOT: code that stands in a page and elsewhere is the same, and messages that pages of plugins show
are those of the program."""
import re
import sys
from pathlib import Path

from markdown_page import blocks_of


def without_top_comment(file: Path):
    mark = "//" if file.suffix == ".cpp" else "#"
    return re.sub(rf"\A({mark}[^\n]*\n)+", "", file.read_text(encoding="utf-8"))


def texts_of_program(root: Path):
    """All literals, joined where the source breaks them."""
    source = "".join(file.read_text(encoding="utf-8") for file in sorted((root / "core").rglob("*.[ch]pp")))
    return re.sub(r'"\s*\n\s*"', "", source)


# In messages: numbers, types, states, and what several messages are about.
INSERTED = re.compile(r"\d+(?:\.\d+)?(?: x \d+)?|CV_\w+|kNoId|LOST|MapEdit: |; |is wrong: |key frame (?=\d)|landmark (?=\d)|"
                      r"\bthe (?:weights|labels|evidence|depth image|key frame)(?= (?:have|are|is|has|sees) )")


def unknown_messages(page: Path, program: str):
    """Messages in blocks of text that the program does not have."""
    for block in blocks_of(page):
        if block.language != "text":
            continue
        for message in re.findall(r"^[a-z ]+ \(\w+\) failed on frame \d+: (.+)$", block.text, re.MULTILINE):
            if not all(part.strip() in program for part in INSERTED.split(message)):
                yield f"{page.name}:{block.line}: the program does not say: {message}"


def main():
    root = Path(sys.argv[1])
    blocks = {block.title: block.text for block in blocks_of(root / "docs/plugins/moving_checker.md")}
    faults = []
    for name in ("depth_change.cpp", "CMakeLists.txt"):  # built by tests/install, too
        file = root / "tests/install/external_plugin" / name
        if without_top_comment(file) != blocks.get(name):
            faults.append(f"{file.relative_to(root)} differs from docs/plugins/moving_checker.md")
    headers = {path.name for path in (root / "core/include/stillpoint/contracts").glob("*.hpp")}
    for page in sorted((root / "docs/plugins").glob("*.md")):
        if page.stem != "debugging" and page.stem + ".hpp" not in headers:
            faults.append(f"docs/plugins/{page.name}: there is no contract of this name")
    for kind in sorted(path.name for path in (root / "sdk/templates").iterdir() if path.name != "common"):
        if not (root / f"docs/plugins/{kind}.md").exists():
            faults.append(f"docs/plugins/{kind}.md is missing: every kind has a page")
    program = texts_of_program(root)
    for page in [*sorted((root / "docs/plugins").glob("*.md")), root / "docs/writing_a_plugin.md"]:
        faults += unknown_messages(page, program)
    print("\n".join(faults) or "ok")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
