# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the insertions of pages, '<!-- insert: NAME ARGUMENT... -->'."""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path
from typing import Iterator, Mapping, Optional

import verification
from pages import code, prose, table
from reference import Reference
from results import selected, tables_of, values_of

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from billet_tools.text import wrapped  # noqa: E402

INSERTION = re.compile(r"^<!-- insert: (.+?) -->$", re.MULTILINE)
HELP_ENTRY = re.compile(r"^(?:Usage:)? +((?:billet |--).*?)(?: {2,}(.+))?$")
TITLE = re.compile(r"^# (.+)$", re.MULTILINE)
MAX_LINES_OF_NEWS = 12  # a title, an empty line and five sentences


def help_tables(text: str) -> str:
    """Returns what --help prints, as tables of commands and options with their meanings."""
    shown = ""
    for block in text.strip().split("\n\n"):
        rows: list[tuple[str, str]] = []
        for line in block.splitlines():
            entry = HELP_ENTRY.match(line)
            if entry:
                rows.append((entry[1], entry[2] or ""))
            elif rows:
                rows[-1] = (rows[-1][0], f"{rows[-1][1]} {line.strip()}".strip())
        if rows:
            title = "command" if rows[0][0].startswith("billet") else "option of runs, checks and previews"
            shown += table([title, "meaning"], [(code(name), prose(meaning)) for name, meaning in rows])
    return shown


def news_of(file: Path) -> str:
    """Returns an entry of doc/news as a section of the changelog, with links as from doc/."""
    text = file.read_text(encoding="utf-8").strip()
    if not text.startswith("# ") or text.count("\n#") or text.count("\n") >= MAX_LINES_OF_NEWS:
        raise SystemExit(f"doc/news/{file.name}: not a title and five sentences, see doc/news/README.md")
    return f"##{text}".replace("](../", "](")


class Insertions:
    """Makes insertions by name."""

    def __init__(self, root: Path, pages: Mapping[str, str], reference: Optional[Reference]) -> None:
        self._root = root
        self._pages = pages
        self._reference = reference
        self._costs: dict[str, dict[str, str]] = {}
        costs = root / "doc/scenes/costs.csv"
        if costs.exists():
            with costs.open(encoding="utf-8", newline="") as file:
                self._costs = {row["scene"]: row for row in csv.DictReader(file)}

    def replace(self, page: str, text: str) -> str:
        """Returns the text of a page with its insertions."""

        def made(match: re.Match[str]) -> str:
            return self._make(page, match[1])

        return INSERTION.sub(made, text)

    def _make(self, page: str, words: str) -> str:
        """Returns an insertion of a page."""
        name, *arguments = words.split()
        method = f"_insert_{name.replace('-', '_')}"
        if not hasattr(self, method):
            raise SystemExit(f"{page}: no insertion '{name}'")
        text: str = getattr(self, method)(page, *arguments)
        return text.rstrip("\n")

    def _insert_help(self, page: str) -> str:
        """Shows what --help prints."""
        if not self._reference:
            return "This site was built without the program: `billet --help` prints its options."
        return help_tables(self._reference.help())

    def _insert_scene(self, page: str, path: str) -> str:
        """Shows a scene file."""
        return f"```prm\n{(self._root / path).read_text(encoding='utf-8')}```\n"

    def _insert_closed_forms(self, page: str) -> str:
        return verification.make_table(self._root, page, verification.CLOSED_FORMS)

    def _insert_benchmarks(self, page: str, name: str = "") -> str:
        """Shows the table of benchmarks, or the part of it that one page of results has."""
        cases = [case for case in verification.BENCHMARKS if case.page.endswith(name)]
        return verification.make_table(self._root, page, cases)

    def _insert_table(self, page: str, *words: str) -> str:
        """Shows a table of a page, or a part of it, with a link to that page: see results.selected()."""
        found = selected(self._root, " ".join(words))
        up = "../" * page.count("/")
        return table(found.head, found.rows) + f"From [{Path(words[0]).name}]({up}{words[0]}.md)."

    def _insert_cost(self, page: str, *scenes: str) -> str:
        """Shows what scenes cost."""
        rows = [self._costs[scene] for scene in scenes if scene in self._costs]
        if not rows:
            return "`scripts/gallery` has not measured the cost of this scene yet."
        head = [name for name in rows[0] if name != "program" and any(row[name] for row in rows)]
        return table(head, [[row[name] for name in head] for row in rows])

    def _insert_printed(self, page: str, name: str) -> str:
        """Shows messages of a run, which doc/site/tutorials.py keeps; the page wraps their lines."""
        text = (self._root / f"doc/tutorials/{name}.txt").read_text(encoding="utf-8").strip()
        return "```\n" + re.sub(r"\n(?!(?:note|warning|error)\[)", " ", text) + "\n```\n"

    def _insert_values(self, page: str, tutorial: str) -> str:
        """Shows the figures of a tutorial's run."""
        with (self._root / "doc/tutorials/values.csv").open(encoding="utf-8", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["tutorial"] == tutorial]
        if not rows:
            raise SystemExit(f"{page}: no values of '{tutorial}'")
        return table(("quantity", "value"), [(row["quantity"], row["value"]) for row in rows])

    def _insert_scene_values(self, page: str, scene: str) -> str:
        """Shows the figures of a shipped scene beside their references."""
        head = ("quantity", "run", "reference", "difference")
        return table(head, [[row[name] for name in head] for row in values_of(self._root, scene)])

    def _insert_gallery(self, page: str) -> str:
        """Shows a table of all scenes that have a page."""
        rows = []
        gallery = "".join(text for name, text in self._pages.items() if name.startswith("scenes/"))
        for scene in sorted((self._root / "prm").glob("*.prm")):
            if f"prm/{scene.name}]" not in gallery:
                raise SystemExit(f"{page}: no page names prm/{scene.name}")
        for name, text in sorted(self._pages.items()):
            if not name.startswith("scenes/") or name == "scenes/index.md":
                continue
            stem = Path(name).stem
            picture = re.search(r"!\[[^\]]*\]\(\.\./(images/\S+?)\)", text)
            title = TITLE.search(text)
            cost = self._costs.get(stem, {})
            rows.append(
                (
                    f"[![{stem}](../{picture[1]})]({stem}.md)" if picture else "",
                    f"[{title[1] if title else stem}]({stem}.md)",
                    cost.get("method", ""),
                    cost.get("elements", ""),
                    cost.get("processor time, s", ""),
                )
            )
        return table(("", "scene", "method", "elements", "processor time, s"), rows)

    def _insert_trades(self, page: str) -> str:
        """Shows what the pages of results/trade say of their scenes as they are written."""
        rows = []
        for name, title, text in self._trades():
            as_it_is = re.search(r"has an error of (.+?); it takes (.+?) core-seconds", text)
            known = re.search(r"(\S+ %) for the weighted mean", text)
            outputs = re.search(r"--outputs (\S+)", text)
            if not (as_it_is and known and outputs):
                raise SystemExit(f"{page}: no error, uncertainty and outputs in {name}")
            words = (outputs[1].replace(",", ", "), known[1], as_it_is[1], as_it_is[2])
            rows.append((self._link(page, title, name), *words))
        head = ("scene", "output", "reference known to", "error as it is written", "core-seconds")
        return table(head, rows)

    def _insert_choices(self, page: str) -> str:
        """Shows what the pages of results/trade say of the parameters that reduce error and cost most."""
        rows = []
        for name, title, text in self._trades():
            found = []
            for what in (r"Most accuracy is bought by", r"Most speed is bought[^`]* by"):
                match = re.search(rf" - {what} (.+?)(?:\. |\.$)", text)
                found.append(match[1] if match else "no parameter alone")
            rows.append((self._link(page, title, name), *found))
        return table(("scene", "reduces the error most", "reduces the cost most"), rows)

    def _trades(self) -> Iterator[tuple[str, str, str]]:
        """Returns the pages of results/trade: path, name of the scene and text without line ends."""
        for name, text in sorted(self._pages.items()):
            title = TITLE.search(text)
            if name.startswith("results/trade/") and title:
                text = " ".join(text.split())
                given = ", mesh as given" * ("--reference-mesh given" in text)
                yield name, title[1].split(": ", 1)[-1] + given, text

    @staticmethod
    def _link(page: str, text: str, name: str) -> str:
        """Returns a link from one page to another."""
        return f"[{text}]({'../' * page.count('/')}{name})"

    def _insert_safe_ranges(self, page: str) -> str:
        """Shows the safe ranges of parameters of scripts/extremes."""
        for found in tables_of(self._root / "doc/results/extremes.md"):
            if found.heading == "By parameter":
                columns = [found.head.index(name) for name in found.head[:2] + found.head[-3:]]
                rows = [[row[i] for i in columns] for row in found.rows]
                return table([found.head[i] for i in columns], rows)
        raise SystemExit("no table of safe ranges in results/extremes.md")

    def _insert_changes(self, page: str) -> str:
        """Shows CHANGELOG.md, with the news at the top: in the version that is in development, if any."""
        head, *versions = re.split(r"^(?=## )", self._from_root("CHANGELOG.md"), flags=re.MULTILINE)
        news = [news_of(file) for file in sorted((self._root / "doc/news").glob("20*.md"), reverse=True)]
        title = "## Unreleased"
        if versions and "in development" in versions[0].split("\n", 1)[0]:
            title, versions[0] = versions[0].split("\n", 1)
        elif not news:
            title = ""
        text = "\n\n".join(part.strip() for part in [head, title, *news, "".join(versions)] if part.strip())
        return wrapped(re.sub(r"`doc/(?!news/)([\w/-]+\.md)`", self._titled_link, text))

    def _titled_link(self, match: re.Match[str]) -> str:
        """Returns a link for the path of a page in CHANGELOG.md, which is read in installations, too."""
        title = TITLE.search(self._pages.get(match[1], ""))
        return f"[{title[1]}]({match[1]})" if title else match[0]

    def _insert_contributing(self, page: str) -> str:
        """Shows CONTRIBUTING.md, and CODE_OF_CONDUCT.md as its last chapter."""
        conduct = re.sub(r"^##", "###", self._from_root("CODE_OF_CONDUCT.md"), flags=re.MULTILINE)
        text = self._from_root("CONTRIBUTING.md").replace("](CODE_OF_CONDUCT.md)", "](#code-of-conduct)")
        return f"{text}\n## Code of conduct\n{conduct}"

    def _from_root(self, name: str) -> str:
        """Returns a page that stands beside doc/, without its title, with links as from doc/."""
        text = (self._root / name).read_text(encoding="utf-8").split("\n", 1)[1]
        text = re.sub(r"\[[^\]]*\]\((doc/news/README\.md)\)", r"`\1`", text)  # no page of the site
        return text.replace("](doc/", "](").replace("](LICENSE)", "](../LICENSE)")
