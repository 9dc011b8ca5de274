#!/usr/bin/env python3
"""check_links.py ROOT: every relative link of every Markdown file leads to a file and to a heading
that exist; every page of docs/ is in the navigation of mkdocs.yml, where there is one, but for stored
studies. Links to other sites are not followed."""
import re
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

from markdown_page import anchors_of, prose_of

LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\[\]]*\])*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
REFERENCE = re.compile(r"^\[[^\]]+\]:\s+(\S+)")
HTML = re.compile(r"<(?:a|img)\s[^>]*?(?:href|src)=\"([^\"]+)\"")
CODE = re.compile(r"(`+)[^`].*?\1")


def pages_of(root: Path):
    """Those of git, and new ones that it does not ignore; without git, all outside of build folders."""
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-co", "--exclude-standard", "*.md"],
                            capture_output=True, text=True)
    if listed.returncode == 0 and listed.stdout:
        return [root / name for name in listed.stdout.splitlines() if (root / name).exists()]
    return [page for page in root.rglob("*.md")
            if not re.match(r"build|out|\.", page.relative_to(root).parts[0])]


def links_of(page: Path):
    for number, line in prose_of(page):
        line = CODE.sub("", line)
        for pattern in (LINK, REFERENCE, HTML):
            for target in pattern.findall(line):
                yield number, target


def fault_of(page: Path, target: str, root: Path, cache: dict):
    if re.match(r"[a-z][a-z0-9+.-]*:", target):
        return None
    path, _, anchor = target.partition("#")
    file = (page.parent / unquote(path)).resolve() if path else page
    if not file.exists():
        return f"there is no {path}"
    if root not in file.parents and file != root:
        return f"{path} is outside of the repository"
    if anchor and file.suffix == ".md":
        if file not in cache:
            cache[file] = anchors_of(file)
        if unquote(anchor) not in cache[file]:
            return f"{file.relative_to(root)} has no heading #{anchor}"
    return None


def missing_in_navigation(root: Path):
    navigation = (root / "mkdocs.yml").read_text(encoding="utf-8")
    for page in sorted((root / "docs").rglob("*.md")):
        name = page.relative_to(root / "docs").as_posix()
        if name.startswith("measured/"):
            continue
        if not re.search(rf"(^|\s){re.escape(name)}\s*$", navigation, re.MULTILINE):
            yield f"docs/{name} is not in the navigation of mkdocs.yml"


def main():
    root = Path(sys.argv[1]).resolve()
    faults, count, cache = [], 0, {}
    templates = root / "sdk" / "templates"  # their texts become others when a project is made
    for page in pages_of(root):
        if templates in page.parents:
            continue
        for number, target in links_of(page):
            count += 1
            fault = fault_of(page, target, root, cache)
            if fault:
                faults.append(f"{page.relative_to(root)}:{number}: {target}: {fault}")
    if (root / "mkdocs.yml").exists():
        faults += missing_in_navigation(root)
    print("\n".join(faults))
    print(f"{count} links, {len(faults)} faults")
    return 1 if faults or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
