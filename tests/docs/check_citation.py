#!/usr/bin/env python3
"""check_citation.py ROOT: CITATION.cff is valid YAML with what version 1.2.0 of the format requires, and says the same
as CMakeLists.txt (version) and README.md (its two entries for BibTeX). Ends with 77, skipped, without PyYAML."""
import re
import sys
from pathlib import Path

try:
    import yaml
except ImportError:
    print("PyYAML is not installed: Debian's package is python3-yaml")
    sys.exit(77)

REQUIRED = {"cff-version", "message", "title", "authors"}
REQUIRED_OF_REFERENCE = {"type", "title", "authors"}


def entry_of(readme: str, kind: str):
    """The fields of an entry, without the braces that keep capital letters."""
    body = re.search(rf"^@{kind}\{{(.*?)^\}}", readme, re.DOTALL | re.MULTILINE)[1]
    fields = re.findall(r"^\s+(\w+) = \{(.*)\},?$", body, re.MULTILINE)
    return {name: re.sub(r"[{}]", "", value) for name, value in fields}


def names_of(authors: list):
    return " and ".join(author.get("name") or f"{author['family-names']}, {author['given-names']}"
                        for author in authors)


def differences(what: str, cited: dict, entry: dict):
    for field, value in cited.items():
        if str(value) != entry.get(field):
            yield f"{what}: {field} is '{value}', in README.md '{entry.get(field)}'"


def main():
    root = Path(sys.argv[1])
    citation = yaml.safe_load((root / "CITATION.cff").read_text(encoding="utf-8"))
    readme = (root / "README.md").read_text(encoding="utf-8")
    faults = [f"'{key}' is missing" for key in sorted(REQUIRED - citation.keys())]
    for reference in citation["references"]:
        faults += [f"a reference: '{key}' is missing" for key in sorted(REQUIRED_OF_REFERENCE - reference.keys())]

    project = re.search(r"^project\(Stillpoint VERSION (\S+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"),
                        re.MULTILINE)[1]
    if str(citation["version"]) != project:
        faults.append(f"version is {citation['version']}, in CMakeLists.txt {project}")
    faults += differences("the software", {"title": citation["title"], "version": citation["version"],
                                           "author": names_of(citation["authors"])},
                          entry_of(readme, "software"))
    paper = citation["references"][0]
    faults += differences("the paper", {"title": paper["title"], "year": paper["year"],
                                        "author": names_of(paper["authors"]),
                                        "booktitle": paper["collection-title"],
                                        "pages": f"{paper['start']}--{paper['end']}"},
                          entry_of(readme, "inproceedings"))
    print("\n".join(faults) or "ok")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
