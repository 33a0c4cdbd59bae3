# SPDX-License-Identifier: LGPL-2.1-or-later
"""Configuration of the site for Sphinx.

scripts/documentation builds it; doc/site/assemble.py writes its generated pages.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any, Iterator
from unittest.mock import MagicMock

from docutils import nodes
from pygments.lexer import RegexLexer, bygroups
from pygments.token import Comment, Keyword, Name, Operator, Punctuation, String, Text
from sphinx.application import Sphinx
from sphinx.domains.math import MathDomain
from sphinx.util import logging

logger = logging.getLogger(__name__)
HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path.insert(0, str(ROOT / "tools"))  # for the options of billet-trade and billet-fit
for _module in ("util", "util.numpy_support", "vtkIOXML", "vtkCommonCore", "vtkCommonDataModel"):
    sys.modules.setdefault("vtkmodules", MagicMock())
    sys.modules.setdefault(f"vtkmodules.{_module}", MagicMock())

project = "billet"
author = "the authors of billet"
copyright = "the authors of billet; LGPL 2.1 or later"
_version = re.search(r"project\(billet VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))
version = release = _version[1] if _version else ""

extensions = ["breathe", "myst_parser", "sphinx.ext.mathjax", "sphinxarg.ext"]
breathe_projects = {"billet": str(HERE.parents[1] / "xml")}  # scripts/documentation makes it by Doxygen
breathe_default_project = "billet"
# Only a few classes have a place to link to.
nitpick_ignore_regex = [("cpp:.*", ".*")]
if (HERE / "references.bib").exists():
    extensions.append("sphinxcontrib.bibtex")
    bibtex_bibfiles = ["references.bib"]
    bibtex_default_style = "plain"
if (HERE / "equation_links.py").exists():
    sys.path.insert(0, str(HERE))
    extensions.append("equation_links")

source_suffix = {".md": "markdown"}
root_doc = "index"
exclude_patterns = ["site", "news", "_static"]
nitpicky = True
highlight_language = "none"

myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath", "html_image"]
myst_heading_anchors = 6
myst_dmath_double_inline = True
suppress_warnings = ["myst.header"]  # pages of results begin at any level

html_use_index = False  # of C++ alone; pages have the search
html_theme = "furo"
html_title = "billet"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
smartquotes_action = "qe"  # quotes, but two dashes begin an option
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#7a3b10", "color-brand-content": "#8a4413"},
    "dark_css_variables": {"color-brand-primary": "#f0a875", "color-brand-content": "#f0a875"},
}

# KaTeX, which stands beside the pages, sets formulas: they need neither a server nor the internet.
mathjax_path = "katex/katex.min.js"
mathjax_options = {"defer": "defer"}
math_eqref_format = "({number})"

SHOWN_ENVIRONMENTS = re.findall(
    r"\\\\begin\{(.+?)\}", (HERE / "_static/formulas.js").read_text(encoding="utf-8")
)

man_pages = [
    ("reference/billet-trade", "billet-trade", "accuracy against cost of a scene", "", 1),
    ("reference/billet-fit", "billet-fit", "constants of laws of rubber", "", 1),
]
man_show_urls = False


class SceneLexer(RegexLexer):
    """Colours scene files."""

    name = "billet scene"
    aliases = ["prm"]
    filenames = ["*.prm"]
    tokens = {
        "root": [
            (r"\s*#.*", Comment.Single),
            (r"(\s*)(subsection)(\s+)(.*)", bygroups(Text, Keyword, Text, Name.Namespace)),
            (r"(\s*)(end)\b", bygroups(Text, Keyword)),
            (r"(\s*)(include)(\s+)(.*)", bygroups(Text, Keyword, Text, String)),
            (
                r"(\s*)(set)(\s+)([^=\n]*?)(\s*)(=)([^#\n]*)",
                bygroups(Text, Keyword, Text, Name.Attribute, Text, Operator, String),
            ),
            (r"\S+", Punctuation),
            (r"\s+", Text),
        ]
    }


class TaggedMathDomain(MathDomain):
    """Numbers equations as their labels do: eq-T1 is (T1)."""

    def note_equation(self, docname: str, labelid: str, location: Any = None) -> None:
        super().note_equation(docname, labelid, location)
        tag = re.fullmatch(r"eq-([A-Z]\d+[a-z]?)", labelid)
        if tag:
            self.equations[labelid] = (docname, tag[1])


def remove_shown_tags(app: Sphinx, tree: nodes.document) -> None:
    """Removes the \\tag of a numbered equation, which the page shows beside it already."""
    blocks: Iterator[nodes.math_block] = tree.findall(nodes.math_block)
    for block in list(blocks):
        number = block.get("number")
        environment = re.match(r"\s*\\begin\{([a-z]+\*?)\}", block.astext())
        if block.get("nowrap") and environment and environment[1] not in SHOWN_ENVIRONMENTS:
            logger.warning("formulas.js does not show '%s'", environment[1], location=block)
        if number is None:
            continue
        text = block.astext().replace(rf"\tag{{{number}}}", "").strip()
        inside = re.fullmatch(r"\\begin\{equation\}(.*)\\end\{equation\}", text, re.DOTALL)
        if inside:
            text = inside[1].strip()
            block["nowrap"] = False
        block.children = []
        block += nodes.Text(text)


def add_formulas(app: Sphinx, page: str, template: str, context: dict[str, Any], tree: Any) -> None:
    """Loads what sets formulas on the pages that have some."""
    if tree is not None and any(True for kind in (nodes.math, nodes.math_block) for _ in tree.findall(kind)):
        app.add_css_file("katex/katex.min.css")
        app.add_js_file("katex/auto-render.js", defer="defer")
        app.add_js_file("formulas.js", defer="defer")


def keep_percentages(app: Sphinx, tree: nodes.document) -> None:
    """Keeps numbers and their % in one line."""
    for text in list(tree.findall(nodes.Text)):
        kept = re.sub(r"(?<=\d) %", "\u00a0%", text.astext())
        if kept != text.astext() and not isinstance(text.parent, (nodes.literal, nodes.FixedTextElement)):
            text.parent.replace(text, nodes.Text(kept))


def finish_body(app: Sphinx, page: str, template: str, context: dict[str, Any], tree: Any) -> None:
    """Chooses where code breaks, and links pictures to their files."""

    def with_breaks(word: re.Match[str]) -> str:
        return word[1] + re.sub(r"([/_=|])(?=\w)", r"\1<wbr>", word[2]) + word[3]

    def with_link(picture: re.Match[str]) -> str:
        if picture[1]:
            return picture[0]
        return f'<a class="image-reference" href="{picture[3]}">{picture[2]}</a>'

    def with_whole_options(block: re.Match[str]) -> str:
        shown = re.sub(r"(?<![\w-])(--[a-z][\w-]*)", r'<span class="unbroken">\1</span>', block[2])
        return block[1] + shown

    body = re.sub(r'(<span class="pre">)([^<]{17,})(</span>)', with_breaks, context.get("body") or "")
    body = re.sub(
        r'(<div class="highlight-(?:none|sh) .*?<pre>)(.*?</pre>)', with_whole_options, body, flags=re.DOTALL
    )
    context["body"] = re.sub(r'(<a [^>]*>\s*)?(<img [^>]*src="([^"]*)"[^>]*>)', with_link, body)


def divide_manual_page(app: Sphinx, tree: nodes.document, page: str) -> None:
    """Gives a manual page the sections that readers expect: SYNOPSIS and DESCRIPTION before the options."""
    if app.builder.name != "man":
        return
    whole = next(iter(tree.findall(nodes.section)))
    usage = next(part for part in whole if isinstance(part, nodes.literal_block))
    texts = [part for part in whole if isinstance(part, nodes.paragraph)]
    whole.children = [part for part in whole if part is not usage and part not in texts]
    usage = nodes.literal_block(text=re.sub(r"^ {7}|^usage: ", "", usage.astext(), flags=re.MULTILINE))
    for name, parts in (("Description", texts), ("Synopsis", [usage])):
        section = nodes.section("", nodes.title(text=name), *parts, ids=[name.lower()])
        whole.insert(1, section)  # behind the title


def setup(app: Sphinx) -> None:
    """Adds what the site needs beyond its extensions."""
    app.add_lexer("prm", SceneLexer)
    app.add_domain(TaggedMathDomain, override=True)
    app.connect("doctree-read", remove_shown_tags)
    app.connect("doctree-read", keep_percentages)
    app.connect("doctree-resolved", divide_manual_page)
    app.connect("html-page-context", add_formulas)
    app.connect("html-page-context", finish_body)
