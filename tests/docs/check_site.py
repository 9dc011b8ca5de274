#!/usr/bin/env python3
"""check_site.py ROOT FOLDER: builds the site into FOLDER, and follows every link within it. Ends with
77, skipped, where mkdocs or its theme is not installed."""
import re
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote

SKIPPED = 77


def links_of(html: str):
    return re.findall(r"<(?:a|img|link|script)\s[^>]*?(?:href|src)=\"([^\"]*)\"", html)


def main():
    root, site = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    if not shutil.which("mkdocs"):
        print("mkdocs is not installed: 'tools/setup --docs' does it")
        return SKIPPED
    done = subprocess.run(["mkdocs", "build", "--strict", "--quiet",
                           "--config-file", str(root / "mkdocs.yml"), "--site-dir", str(site)],
                          capture_output=True, text=True)
    if "Unrecognised theme" in done.stderr:
        print("mkdocs-material is not installed: 'tools/setup --docs' does it")
        return SKIPPED
    if done.returncode != 0:
        print(done.stdout + done.stderr)
        return 1
    pages = {page: page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    ids = {page: set(re.findall(r"\sid=\"([^\"]+)\"", html)) for page, html in pages.items()}
    faults, count = [], 0
    for page, html in pages.items():
        if page.name == "404.html":  # its links begin at the root of a server
            continue
        for link in links_of(html):
            where = f"{page.relative_to(site)}: {link}"
            if re.match(r"(https?:)?//", link):
                if not re.search(rf"<a\s[^>]*href=\"{re.escape(link)}\"", html):
                    faults.append(f"{where}: is loaded from the internet")
                continue
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = link.partition("#")
            file = (page.parent / unquote(path)).resolve() if path else page
            count += 1
            if file.is_dir():
                file = file / "index.html"
            if not file.exists():
                faults.append(f"{where}: leads nowhere")
            elif anchor and file in ids and unquote(anchor) not in ids[file]:
                faults.append(f"{where}: there is no such heading")
    print("\n".join(sorted(set(faults))))
    print(f"{len(pages)} pages, {count} links, {len(set(faults))} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
