"""Public headers as data: what they declare, and the comments (///) that say what it means.

The headers are written in one style (.clang-format), which is all that this reader understands."""
import re
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Item:
    kind: str           # "class", "struct", "enum", "function", "field", "alias", "constant", …
    name: str
    declaration: str    # one line, without comments and bodies
    doc: str = ""       # paragraphs, separated by empty lines
    children: list = field(default_factory=list)
    joined: bool = False          # directly below the one before: no comment, no empty line between
    comment_before: bool = False  # its comment stands above it, and may be meant for those joined to it
    field_of_type: str = ""       # declared with the type, as in enum class Use {…} use = Use::kNone;


@dataclass
class Header:
    path: str           # as included: "stillpoint/contracts/frame.hpp"
    doc: str            # the comment at its top
    items: list


def plain(text: str):
    """Without comments, and with single spaces."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)
    text = re.sub(r"//[^\n]*", " ", text)
    return re.sub(r"\s+", " ", text).strip()


def strip_marker(line: str, marker: str):
    text = line.strip()[len(marker):]
    return text[1:] if text.startswith(" ") else text


def end_of_block(text: str, start: int):
    """Of the closing brace that belongs to the opening one at `start`."""
    depth, i = 0, start
    while i < len(text):
        if text.startswith("//", i):
            i = text.find("\n", i)
            continue
        if text.startswith("/*", i):
            i = text.find("*/", i) + 2
            continue
        if text[i] in "\"'":
            quote, i = text[i], i + 1
            while text[i] != quote:
                i += 2 if text[i] == "\\" else 1
        elif text[i] == "{":
            depth += 1
        elif text[i] == "}":
            depth -= 1
            if depth == 0:
                return i
        i += 1
    raise ValueError("a block has no end")


def without_parentheses(text: str):
    while re.search(r"\([^()]*\)", text):
        text = re.sub(r"\([^()]*\)", "", text)
    return text


def is_function(head: str):
    """Whether a block after this is the body of a function."""
    return "(" in head and "=" not in re.sub(r"operator\S+", "", without_parentheses(head))


def classify(declaration: str):
    text = re.sub(r"^template <[^>]*(?:<[^>]*>[^>]*)*> ", "", declaration)
    text = re.sub(r"^requires .*? (?=\w)", "", text) if text.startswith("requires ") else text
    text = text.replace("STILLPOINT_EXPORT ", "")
    if text.startswith("using "):
        return "alias", text.split()[1]
    if text.startswith("concept "):
        return "concept", text.split()[1]
    pointer = re.match(r"[^()]*\(\*(\w+)\)\(", text)
    if pointer:
        return "field", pointer[1]
    before_value = re.split(r"\s=\s", text)[0] if not is_function(text) else text
    if "(" in before_value and not before_value.startswith("std::function"):
        name = re.search(r"(operator\(\)|operator[^\w\s(]+|~?\w+)\(", before_value)
        return "function", name[1] if name else ""
    name = re.search(r"(\w+)(?:\{.*\})?;?$", before_value)
    kind = "constant" if "constexpr" in text else "field"
    return kind, name[1] if name else ""


class Reader:
    def __init__(self, text: str):
        self.text, self.i = text, 0

    def scope(self, public: bool = True):
        """Items up to the end of the scope."""
        items, doc, text, apart = [], [], self.text, True
        while self.i < len(text):
            if text[self.i].isspace():
                apart = apart or text.startswith("\n\n", self.i)
                self.i += 1
            elif text.startswith("//", self.i):
                end = text.find("\n", self.i)
                line = text[self.i:end]
                self.i = end
                if line.startswith("///<"):
                    if items:
                        items[-1].doc = (items[-1].doc + " " + strip_marker(line, "///<")).strip()
                elif line.startswith("///"):
                    doc.append(strip_marker(line, "///"))
                    apart = True
            elif text[self.i] == "#":
                self.directive(items, doc)
                doc = []
            elif text[self.i] == "}":
                self.i += 1
                return items
            elif text[self.i] == ";":
                self.i += 1
            elif match := re.compile(r"(public|protected|private):").match(text, self.i):
                public = match[1] != "private"
                self.i = match.end()
            elif match := re.compile(r"namespace ([\w:]+ )?\{").match(text, self.i):
                self.i = match.end()
                inner = self.scope()
                if match[1] and match[1].strip() != "detail":
                    items += inner
                doc = []
            else:
                item = self.declaration("\n".join(doc))
                if item and public:
                    item.joined, item.comment_before = not apart, bool(doc)
                    items.append(item)
                elif item:
                    self.trailing_comment()
                doc, apart = [], item is None
        return items

    def trailing_comment(self):
        match = re.compile(r"[ \t]*///<[^\n]*").match(self.text, self.i)
        if match:
            self.i = match.end()

    def directive(self, items, doc):
        end = self.i
        while True:
            end = self.text.find("\n", end)
            if self.text[end - 1] != "\\":
                break
            end += 1
        line = self.text[self.i:end]
        self.i = end
        match = re.match(r"#define (\w+)(\([^)]*\))?", line)
        if match and doc and match[2]:
            items.append(Item("macro", match[1], match[1] + match[2], "\n".join(doc)))

    def declaration(self, doc: str):
        text, start, depth = self.text, self.i, 0
        while True:
            if text.startswith("//", self.i):
                self.i = text.find("\n", self.i)
                continue
            if text.startswith("/*", self.i):
                self.i = text.find("*/", self.i) + 2
                continue
            c = text[self.i]
            if c in "([":
                depth += 1
            elif c in ")]":
                depth -= 1
            elif c == ";" and depth == 0:
                self.i += 1
                return self.make(text[start:self.i - 1], doc)
            elif c == "{" and depth == 0:
                head = plain(text[start:self.i])
                if re.match(r"(template <.*> )?(class|struct|enum( class)?) ", head) and "(" not in head:
                    return self.type(head, doc)
                end = end_of_block(text, self.i)
                before = text[start:self.i]
                self.i = end + 1
                if not is_function(plain(before)):  # an initialiser, which goes on to the semicolon
                    continue
                return self.make(before, doc)
            elif c == "{":
                self.i = end_of_block(text, self.i)
            self.i += 1

    def type(self, head: str, doc: str):
        match = re.match(
            r"(?:template <.*> )?(class|struct|enum)(?: class)? (?:STILLPOINT_EXPORT )?(\w+)", head)
        if match[1] == "enum":
            end = end_of_block(self.text, self.i)
            values = self.values(self.text[self.i + 1:end])
            self.i = end + 1
            item = Item("enum", match[2], head, doc, values)
        else:
            self.i += 1
            children = self.scope(match[1] == "struct")
            item = Item(match[1], match[2], head.replace("STILLPOINT_EXPORT ", ""), doc, children)
        # What follows may be a field of that type: enum class Use {…} use = Use::kUnmatched;
        end = self.text.find(";", self.i)
        rest = plain(self.text[self.i:end])
        self.i = end + 1
        if rest:
            item.field_of_type = rest
        return item

    @staticmethod
    def values(body: str):
        values = []
        value = r"(\w+)(?:\s*=\s*([^,/\s]+))?\s*(?:/\*(.*?)\*/)?\s*,?\s*(?:///<([^\n]*))?"
        for part in re.finditer(value, body):
            comment = (part[3] or part[4] or "").strip()
            values.append(Item("value", part[1], part[1] + (f" = {part[2]}" if part[2] else ""), comment))
        return values

    @staticmethod
    def make(source: str, doc: str):
        text = plain(source)
        if re.match(r"friend\b|static_assert\b", text) or re.search(r"= (delete|default)$", text) or not text:
            return None
        if re.match(r"(class|struct) \w+$", text):  # announced only
            return None
        kind, name = classify(text)
        if kind == "function":
            if name.startswith("~"):
                return None
            text = re.sub(r"\) (noexcept )?: \w+[({].*$", r")", text)  # initialisers of a constructor
        return Item(kind, name, text.replace("STILLPOINT_EXPORT ", "") + ";", doc)


def read_header(path: Path, name: str):
    text = path.read_text(encoding="utf-8")
    top = []
    for line in text.split("\n"):
        if not line.startswith("//"):
            break
        top.append(strip_marker(line, "//"))
    body = text[text.index("#pragma once"):]
    items = Reader(body).scope()
    return Header(name, "\n".join(top), items)
