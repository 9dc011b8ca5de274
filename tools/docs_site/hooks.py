"""Hooks of mkdocs: pages link to files of the repository that are outside of docs/ (READMEs of plugins,
headers, examples). On the site each of these is a page of its own below repository/, also what those
link to in turn."""
import posixpath
import re
from pathlib import Path

from mkdocs.structure.files import File

LINK = re.compile(r"(\]\(\s*)([^)\s#]+)((?:#[^)\s]*)?(?:\s+\"[^\"]*\")?\s*\))")
BLOCK = re.compile(r"(^ *```.*?^ *```[^\S\n]*$|`[^`\n]*`)", re.MULTILINE | re.DOTALL)
LANGUAGES = {".hpp": "cpp", ".cpp": "cpp", ".py": "python", ".yaml": "yaml", ".yml": "yaml",
             ".cmake": "cmake", ".json": "json", ".sh": "sh"}
PICTURES = {".png", ".jpg", ".svg"}


class Site:
    """What is known while the site is built."""

    def __init__(self, config):
        self.root = Path(config["config_file_path"]).parent
        self.docs = Path(config["docs_dir"])
        self.made = self.root / "build" / "docs" / "linked"  # sources of the pages below repository/
        self.uris = {}     # of files and folders outside of docs/
        self.sources = {}  # the other way round

    def resolve(self, page: Path, link: str):
        """The file or folder of the repository that a link of a page, or of a folder's list, leads to."""
        if re.match(r"[a-z][a-z0-9+.-]*:|/", link):
            return None
        folder = page if page.is_dir() else page.parent
        target = Path(posixpath.normpath(posixpath.join(folder.as_posix(), link)))
        if (target / "README.md").exists():  # says what is in the folder
            target = target / "README.md"
        return target if target.exists() and self.root in target.parents else None

    def outside(self, target: Path):
        return self.docs != target and self.docs not in target.parents

    def add(self, target: Path):
        if target in self.uris:
            return
        name = target.relative_to(self.root).as_posix()
        if target.is_dir():
            uri = f"repository/{name}/index.md"
        elif target.suffix == ".md" or target.suffix in PICTURES:
            uri = f"repository/{name}"
        else:
            uri = f"repository/{name}.md"
        self.uris[target] = uri
        self.sources[uri] = target
        if target.is_dir():
            for file in self.files_of(target):
                self.add(file)
        elif target.suffix == ".md":
            self.add_links(target, target.read_text(encoding="utf-8"))

    @staticmethod
    def files_of(folder: Path):
        """Those directly in it, and the READMEs of its folders; of a folder of folders, these."""
        entries = [entry for entry in sorted(folder.iterdir()) if not entry.name.startswith(".")]
        files = [entry for entry in entries if entry.is_file()]
        return files + sorted(folder.glob("*/README.md")) or entries

    def add_links(self, page: Path, markdown: str):
        for part in BLOCK.split(markdown)[::2]:
            for match in LINK.finditer(part):
                target = self.resolve(page, match[2])
                if target and self.outside(target):
                    self.add(target)

    def text_of(self, target: Path):
        name = target.relative_to(self.root).as_posix()
        if target.is_dir():
            lines = [f"* [{file.relative_to(target).as_posix()}]({file.relative_to(target).as_posix()})"
                     for file in self.files_of(target)]
            return f"# {name}\n\n" + "\n".join(lines) + "\n"
        text = target.read_text(encoding="utf-8", errors="replace")
        if target.suffix == ".md":
            return text
        language = "cmake" if target.name == "CMakeLists.txt" else LANGUAGES.get(target.suffix, "text")
        if text.startswith("#!") and "bash" in text.partition("\n")[0]:
            language = "sh"
        fence = "`" * max([3] + [len(run) + 1 for run in re.findall(r"`{3,}", text)])
        return f"# {target.name}\n\n`{name}`\n\n{fence}{language}\n{text.rstrip()}\n{fence}\n"

    def relinked(self, markdown: str, source: Path, uri: str):
        """With links that lead to where files are on the site."""
        def link(match):
            target = self.resolve(source, match[2])
            if target is None:
                return match[0]
            if not self.outside(target):
                there = target.relative_to(self.docs).as_posix()
            elif target in self.uris:
                there = self.uris[target]
            else:
                return match[0]
            return match[1] + posixpath.relpath(there, posixpath.dirname(uri) or ".") + match[3]

        parts = BLOCK.split(markdown)
        return "".join(part if i % 2 else LINK.sub(link, part) for i, part in enumerate(parts))


site = None


def on_files(files, config):
    global site
    site = Site(config)
    for file in list(files):
        if file.src_uri.endswith(".md"):
            path = site.docs / file.src_uri
            site.add_links(path, path.read_text(encoding="utf-8"))
    for target, uri in site.uris.items():
        made = site.made / uri
        made.parent.mkdir(parents=True, exist_ok=True)
        if uri.endswith(".md"):
            made.write_text(site.text_of(target), encoding="utf-8")
        else:
            made.write_bytes(target.read_bytes())
        files.append(File(uri, str(site.made), config["site_dir"], config["use_directory_urls"]))
    return files


def on_page_markdown(markdown, page, config, files):
    uri = page.file.src_uri
    return site.relinked(markdown, site.sources.get(uri, site.docs / uri), uri)


def on_post_page(output, page, config):
    """Before the theme's own script, which looks for what this one makes."""
    root = posixpath.relpath(".", posixpath.dirname(page.file.dest_uri) or ".")
    return re.sub(r'(<script src="[^"]*assets/javascripts/bundle)',
                  rf'<script src="{root}/assets/search_from_files.js"></script>\1', output, count=1)


def on_post_build(config):
    search = Path(config["site_dir"]) / "search"
    index = (search / "search_index.json").read_text(encoding="utf-8")
    (search / "search_index.js").write_text(
        f"window.__search = {{index: Promise.resolve({index})}};\n", encoding="utf-8")
