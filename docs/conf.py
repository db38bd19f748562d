# SPDX-License-Identifier: BSD-3-Clause
"""The documentation site (Sphinx, MyST): the pages as they are in the repository, in the order of docs/README.md."""

import os
import pathlib
import re

from sphinx.builders.html import StandaloneHTMLBuilder

ROOT = pathlib.Path(__file__).resolve().parent.parent

project = "photonav"
copyright = "photonav contributors"
version = re.search(r"VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text().split("project(")[1])[1]
root_doc = "README"
include_patterns = ["README.md", "BENCHMARK.md", "docs/**.md"]
extensions = ["myst_parser"]
myst_heading_anchors = 4
highlight_language = "none"
html_theme = "sphinx_rtd_theme"
html_title = f"photonav {version}"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_theme_options = {"navigation_depth": 2}
html_show_sourcelink = False
html_copy_source = False
StandaloneHTMLBuilder.supported_image_types.append("image/webp")

LINK = re.compile(r"(?<!!)\[([^\[\]]+)\]\(([^()\s]+)\)")
IN_SITE = re.compile(r"`((?:samples|api)/[\w/.-]+\.html)`")  # what is in the site only


def pagesIn(text, folder):
    """The pages that a text links to, each once, as Sphinx names them."""
    links = (link for _, link in LINK.findall(text) if link.endswith(".md"))
    paths = (os.path.normpath(folder / link).removesuffix(".md") for link in links)
    return list(dict.fromkeys(path for path in paths if (ROOT / f"{path}.md").exists()))


def contents(pages, caption=""):
    lines = [":hidden:", *([f":caption: {caption}"] if caption else []), *(f"/{page}" for page in pages)]
    return "\n\n```{toctree}\n" + "\n".join(lines) + "\n```\n"


def contentsOfSite():
    """One list for each part of docs/README.md; a page is in the first one that has it."""
    parts = re.split(r"^## ", (ROOT / "docs/README.md").read_text(), flags=re.MULTILINE)
    seen, text = {"docs/README", "README"}, contents(["docs/README"])
    for i, part in enumerate(parts):
        pages = [page for page in pagesIn(part, pathlib.Path("docs")) if page not in seen]
        seen.update(pages)
        text += contents(pages, part.splitlines()[0] if i else "Start") if pages else ""
    return text


def prepare(app, name, source):
    """Adds the contents, leads to what is in the site only, and drops links to folders."""
    folder = pathlib.Path(name).parent
    up = "../" * len(folder.parts)
    text = IN_SITE.sub(lambda m: f'<a href="{up}{m[1]}"><code>{m[1]}</code></a>', source[0])
    text = LINK.sub(lambda m: m[1] if (ROOT / folder / m[2]).is_dir() else m[0], text)
    if name == "README":
        text += contentsOfSite()
    if name == "docs/tutorials/README":
        text += contents([page for page in pagesIn(text, folder) if page.startswith("docs/tutorials/")])
    source[0] = text


def setup(app):
    app.connect("source-read", prepare)
