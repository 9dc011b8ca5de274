#!/usr/bin/env python3
"""generate.py ROOT PROGRAM [--check]: writes docs/reference from the public headers of ROOT and from
what PROGRAM (stillpoint, of a build with all plugins) says about itself. --check: writes nothing, and
fails with the difference where a page is stale."""
import difflib
import sys
from pathlib import Path

from pages import all_pages


def main():
    root, program, check = Path(sys.argv[1]).resolve(), sys.argv[2], "--check" in sys.argv[3:]
    folder = root / "docs" / "reference"
    pages = all_pages(root, program)
    stale = []
    for name, text in pages.items():
        file = folder / name
        before = file.read_text(encoding="utf-8") if file.exists() else ""
        if before == text:
            continue
        stale.append(name)
        if check:
            lines = difflib.unified_diff(before.splitlines(), text.splitlines(),
                                         f"docs/reference/{name}", "as generated now", lineterm="", n=1)
            print("\n".join(list(lines)[:40]))
        else:
            folder.mkdir(exist_ok=True)
            file.write_text(text, encoding="utf-8")
            print(f"docs/reference/{name}")
    for file in folder.glob("*.md"):
        if file.name not in pages:
            stale.append(file.name)
            print(f"docs/reference/{file.name} is not generated any more: remove it")
    if check and stale:
        print(f"stale: {', '.join(stale)}; run tools/docs --reference and commit what it changes")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
