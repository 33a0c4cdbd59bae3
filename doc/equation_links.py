"""Sphinx extension: makes links of references such as (T5) to the equations of the theory, on every page.

The equations of doc/theory have labels such as eq-T5 and show their number by \\tag{T5}. Text in code, in
formulas, in titles and in links stays as it is, and so does a number in parentheses that is no equation.
"""
import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

REFERENCE = re.compile(r"\(([A-Z]\d{1,2})\)")
KEPT = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.reference, nodes.title)


class EquationLinks(SphinxPostTransform):
    """Replaces (T5) in texts by a link to the equation."""

    default_priority = 5

    def run(self, **_: Any) -> None:
        """Replaces the references of a page."""
        if self.app.builder.format != "html":
            return
        for text in list(self.document.findall(nodes.Text)):
            parent = text.parent
            while parent is not None and not isinstance(parent, KEPT):
                parent = parent.parent
            if parent is None and REFERENCE.search(text):
                text.parent.replace(text, self.with_links(str(text)))

    def with_links(self, text: str) -> list[nodes.Node]:
        """Returns a text in pieces, those that name an equation as links."""
        equations = self.env.get_domain("math").data["objects"]
        pieces: list[nodes.Node] = []
        end = 0
        for match in REFERENCE.finditer(text):
            label = "eq-" + match[1]
            if label not in equations:
                continue
            uri = self.app.builder.get_relative_uri(self.env.docname, equations[label][0])
            uri += "#" + nodes.make_id("equation-" + label)
            pieces.append(nodes.Text(text[end : match.start()]))
            pieces.append(nodes.reference("", match[0], internal=True, refuri=uri, classes=["equation"]))
            end = match.end()
        return pieces + [nodes.Text(text[end:])]


def setup(app: Sphinx) -> dict[str, Any]:
    """Registers the extension."""
    app.add_post_transform(EquationLinks)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
