"""Brings into the site what the pages link to beside them in the repository, and sets equations without a script."""

import re
from pathlib import Path, PurePosixPath
from posixpath import normpath, relpath
from textwrap import indent

from latex2mathml.converter import convert
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[1]
#: The tables of the fields of replies, which `./check site` has printed.
TABLES = ROOT / "site" / ".cache" / "reference.md"
#: The folder of the site that stands for the repository.
REPOSITORY = "repository"
#: Pages outside docs/, with their places in the site.
PAGES = {name: f"{REPOSITORY}/{name}" for name in ["ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"]} | {"README.md": "index.md"}
LINK = re.compile(r"(\]\(|\]: |(?:src|href)=\")(?!\w+:|#|<)([^)\s\"#]+)")
#: A block of Python or of a shell, with what it prints.
BLOCK = r"^```{}\n.*?^```\n(?:\n```output\n.*?^```\n)?"
#: Python, and then the same from a shell.
PAIR = re.compile(f"({BLOCK.format('python')})\n({BLOCK.format('sh')})", re.MULTILINE | re.DOTALL)
EQUATION = re.compile(r"<(span|div) class=\"arithmatex\">\\[\[(](.*?)\\[\])]</\1>", re.DOTALL)


def place(path: str) -> str | None:
    """Where the site has a file of the repository; nothing where it is not a file."""
    if not (ROOT / path).is_file():
        return None
    return path.removeprefix("docs/") if path.startswith("docs/") else PAGES.get(path, f"{REPOSITORY}/{path}")


def links(path: str) -> set[str]:
    """The files of the repository that a page of it links to."""
    found = {normpath(PurePosixPath(path).parent / target) for _, target in LINK.findall((ROOT / path).read_text())}
    return {target for target in found if (ROOT / target).is_file()}


def on_files(files: Files, config: object) -> Files:
    """Adds the pages outside docs/, and what any page links to, those that are added too."""
    pending = [f"docs/{file.src_uri}" for file in files if file.src_uri.endswith(".md")] + list(PAGES)
    wanted = set(PAGES)
    while pending:
        found = links(pending.pop()) - wanted
        wanted |= found
        pending += [path for path in found if path.endswith(".md") and not path.startswith("docs/")]
    for path in sorted(path for path in wanted if not path.startswith("docs/")):
        files.append(File.generated(config, place(path), abs_src_path=str(ROOT / path)))
    return files


def tabs(match: re.Match[str]) -> str:
    """Python and shell side by side."""
    titled = zip(("Python", "curl"), match.groups())
    return "\n".join(f'=== "{title}"\n\n{indent(block, "    ")}' for title, block in titled)


def on_page_markdown(markdown: str, page: object, **_: object) -> str:
    """Leads links of the repository to the same file in the site, and sets Python and shell in tabs."""
    own = page.file.src_uri
    inside = own.removeprefix(f"{REPOSITORY}/")
    source = next((path for path, at in PAGES.items() if at == own), inside if inside != own else f"docs/{own}")

    def led(match: re.Match[str]) -> str:
        target = place(normpath(PurePosixPath(source).parent / match[2]))
        return match[1] + (relpath(target, PurePosixPath(own).parent) if target else match[2])

    if own == "reference.md" and TABLES.exists():
        markdown += "\n" + TABLES.read_text()
    return PAIR.sub(tabs, LINK.sub(led, markdown))


def on_page_content(html: str, **_: object) -> str:
    """Writes equations as MathML, which browsers set by themselves."""

    def math(match: re.Match[str]) -> str:
        tex = match[2].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
        return convert(tex, display="block" if match[1] == "div" else "inline")

    return EQUATION.sub(math, html)
