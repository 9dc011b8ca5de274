#!/usr/bin/env python3
"""check_examples.py ROOT: code that stands in a page and elsewhere is the same."""
import re
import sys
from pathlib import Path

from markdown_page import blocks_of


def without_top_comment(file: Path):
    mark = "//" if file.suffix == ".cpp" else "#"
    return re.sub(rf"\A({mark}[^\n]*\n)+", "", file.read_text(encoding="utf-8"))


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
    print("\n".join(faults) or "ok")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
