"""What the tests of the documentation share: the parts of a Markdown page that they look at."""
import re
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^(?P<indent> *)(?P<fence>```+)(?P<info>[^`]*)$")
COMMENT = re.compile(r"<!--(.*?)-->", re.DOTALL)
HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*#*$")


@dataclass
class Block:
    """A fenced block of code."""
    line: int            # of its first fence, from 1
    language: str        # "sh", "cpp", …; empty when not given
    title: str           # the file that the block is; empty without a title
    text: str
    notes: list          # comments that stand directly before it, as text


def lines_of(page: Path):
    return page.read_text(encoding="utf-8").split("\n")


def blocks_of(page: Path):
    """All fenced blocks, in order."""
    blocks, notes = [], []
    lines = lines_of(page)
    i = 0
    while i < len(lines):
        fence = FENCE.match(lines[i])
        if fence:
            start, body = i, []
            i += 1
            while i < len(lines) and lines[i].strip() != fence["fence"]:
                body.append(lines[i][len(fence["indent"]):])
                i += 1
            if i == len(lines):
                raise ValueError(f"{page}:{start + 1}: the block has no end")
            info = fence["info"].strip()
            title = re.search(r'title="([^"]*)"', info)
            language = re.match(r"[\w+-]*", info)[0]
            blocks.append(Block(start + 1, language, title[1] if title else "",
                                "".join(line + "\n" for line in body), notes))
            notes = []
        elif lines[i].lstrip().startswith("<!--"):
            text = lines[i]
            while "-->" not in text and i + 1 < len(lines):
                i += 1
                text += "\n" + lines[i]
            notes = notes + [part.strip() for part in COMMENT.findall(text)]
        elif lines[i].strip():
            notes = []
        i += 1
    return blocks


def prose_of(page: Path):
    """(number, text) of the lines outside of blocks, without code in backticks and comments."""
    result, fence = [], None
    for number, line in enumerate(lines_of(page), 1):
        match = FENCE.match(line)
        if fence:
            if line.strip() == fence:
                fence = None
            continue
        if match:
            fence = match["fence"]
            continue
        result.append((number, COMMENT.sub("", line)))
    return result


def anchors_of(page: Path):
    """Of the headings, as GitHub and MkDocs make them, and of <a id="…">."""
    anchors, seen = set(), {}
    for _, line in prose_of(page):
        anchors.update(re.findall(r'<a (?:id|name)="([^"]+)"', line))
        heading = HEADING.match(line)
        if not heading:
            continue
        text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading[2])
        explicit = re.search(r"\{#([\w-]+)\}\s*$", text)
        if explicit:
            anchors.add(explicit[1])
            continue
        text = re.sub(r"[`*]", "", text).strip().lower()
        slug = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        count = seen.get(slug, 0)
        seen[slug] = count + 1
        anchors.add(slug if count == 0 else f"{slug}-{count}")
    return anchors
