# SPDX-License-Identifier: LGPL-2.1-or-later
"""The reference: pages of parameters, types and messages, from what the program prints of itself."""

from __future__ import annotations

import json
import re
import subprocess
from collections import defaultdict
from pathlib import Path
from typing import Any, NamedTuple, Sequence

import ranges
from pages import code, escaped, prose, table, target

NAME = "NAME"
UNIT = re.compile(r"\s*\[([^\[\]]+)\]$")


class Parameter(NamedTuple):
    """One parameter of scenes."""

    path: tuple[str, ...]  # subsections, with NAME for what a scene names
    name: str
    schema: dict[str, Any]

    @property
    def target(self) -> str:
        return target("parameter", *(part for part in self.path if part != NAME), self.name)


class Example(NamedTuple):
    """A line of a scene that sets a parameter."""

    value: str
    scene: str  # path in the repository


class Reference:
    """Lists of the program, and places where the repository uses their entries."""

    def __init__(self, program: Path, root: Path, pages: dict[str, str]) -> None:
        self._program = program
        self._root = root
        self._pages = pages  # all other pages of the site by path, to link to
        self._schema = json.loads(self._ask("--print-parameters", "--json"))
        self.parameters = list(self._collect(self._schema, ()))
        known = {ranges.key_of(parameter.path, parameter.name) for parameter in self.parameters}
        if set(ranges.RANGES) - known:
            raise SystemExit(f"ranges.py: no parameter has {sorted(set(ranges.RANGES) - known)}")
        self.messages: list[dict[str, str]] = json.loads(self._ask("--print-diagnostics", "--json"))
        self.lists: list[dict[str, str]] = json.loads(self._ask("--list", "--json"))
        self._examples = self._find_examples()

    def help(self) -> str:
        return self._ask("--help")

    def write(self) -> dict[str, str]:
        """Returns the pages by path. Every parameter must have a range, an example and a link."""
        lacking = [
            f"{'/'.join((*parameter.path, parameter.name))}: no {what}"
            for parameter in self.parameters
            for what, text in (
                ("range", self._range(parameter)),
                ("example", self._example(parameter)),
                ("link", self._links(parameter)),
            )
            if not text
        ]
        if lacking:
            raise SystemExit("reference.py: " + "\n              ".join(lacking))
        pages = {"messages.md": self._message_page()}
        sections: dict[str, list[Parameter]] = defaultdict(list)
        for parameter in self.parameters:
            sections[parameter.path[0] if parameter.path else "General"].append(parameter)
        for section, parameters in sections.items():
            pages[f"reference/parameters/{target(section)}.md"] = self._section_page(section, parameters)
        pages["reference/parameters/index.md"] = self._parameter_index(sections)
        pages["reference/types/index.md"] = self._list_index()
        for entry in self.lists:
            pages[f"reference/types/{entry['name']}.md"] = self._list_page(entry)
        return pages

    def _ask(self, *arguments: str) -> str:
        answer = subprocess.run(
            [str(self._program), *arguments], capture_output=True, text=True, encoding="utf-8", check=False
        )
        if answer.returncode:
            raise SystemExit(f"{self._program} {' '.join(arguments)}: {answer.stderr}")
        return answer.stdout

    def _collect(self, schema: dict[str, Any], path: tuple[str, ...]) -> Any:
        for name, entry in schema.get("properties", {}).items():
            if entry.get("type") == "object":
                yield from self._collect(entry, (*path, name))
            else:
                yield Parameter(path, name, entry)
        others = schema.get("additionalProperties")
        if isinstance(others, dict) and others.get("type") == "object":
            yield from self._collect(others, (*path, NAME))

    # --- where it is used ----------------------------------------------------------------------------------

    def _find_examples(self) -> dict[tuple[tuple[str, ...], str], Example]:
        found: dict[tuple[tuple[str, ...], str], Example] = {}
        known = {(parameter.path, parameter.name): parameter for parameter in self.parameters}
        shipped = sorted((self._root / "prm").glob("*.prm"))
        parts = sorted((self._root / "prm").glob("*/*.prm"))
        examples = sorted((self._root / "examples").rglob("*.prm"))
        for file in [*shipped, *parts, *examples]:
            path: list[str] = []
            for line in file.read_text(encoding="utf-8", errors="replace").splitlines():
                words = line.split("#")[0].strip()
                if words.startswith("subsection "):
                    path.append(words.split(None, 1)[1])
                elif words == "end" and path:
                    path.pop()
                elif words.startswith("set ") and "=" in words and not words.endswith("\\"):
                    name, value = (part.strip() for part in words[4:].split("=", 1))
                    key = (self._generic(path), " ".join(name.split()))
                    if key not in known or key in found or len(value) > 70 or not value or "@" in value:
                        continue
                    if value != str(known[key].schema.get("default", "")):
                        found[key] = Example(value, file.relative_to(self._root).as_posix())
        return found

    def _generic(self, path: Sequence[str]) -> tuple[str, ...]:
        """Returns a path of subsections with NAME for what the scene names."""
        schema = self._schema
        result = []
        for part in path:
            if schema.get("properties", {}).get(part, {}).get("type") == "object":
                schema = schema["properties"][part]
                result.append(part)
            elif isinstance(schema.get("additionalProperties"), dict):
                schema = schema["additionalProperties"]
                result.append(NAME)
            else:
                return ("",)
        return tuple(result)

    def _mentions(self, pattern: str, levels: int, maximum: int = 4) -> list[str]:
        """Returns links to pages of the guide, the tutorials and the theory that match a pattern."""
        found = []
        for folder in ("guide/", "tutorials/", "theory/"):
            for page, text in sorted(self._pages.items()):
                if page.startswith(folder) and not page.endswith("index.md") and re.search(pattern, text):
                    title = re.search(r"^# (.+)$", text, re.MULTILINE)
                    found.append(f"[{title[1] if title else page}]({'../' * levels}{page})")
        return found[:maximum]

    def _link(self, name: str, shown: str | None = None) -> str:
        """Returns a link to the parameter of this name if there is one only."""
        hits = [parameter for parameter in self.parameters if parameter.name == name]
        return f"[{code(shown or name)}]({hits[0].target})" if len(hits) == 1 else code(shown or name)

    def _linked(self, text: str) -> str:
        """Returns text of the program with links to the parameters that it quotes."""

        def link(match: re.Match[str]) -> str:
            quoted = match[1].replace("\\|", "|")
            name = quoted.split(" = ")[0].split("/")[-1].strip()
            return self._link(name, quoted)

        return re.sub(r"(?<!`)`([^`\n]+)`(?!`)", link, prose(text))

    # --- pages ---------------------------------------------------------------------------------------------

    def _section_page(self, section: str, parameters: list[Parameter]) -> str:
        title = f"Parameters: {section}"
        page = f"({target('parameters', section)})=\n# {title}\n\n"
        if section == "General":
            page += "These parameters stand outside of all subsections.\n\n"
        last: tuple[str, ...] | None = None
        for parameter in parameters:
            if parameter.path != last:
                last = parameter.path
                if last:
                    page += f"## {' / '.join(last)}\n\n"
                    if NAME in last:
                        page += f"`{NAME}` stands for a name that the scene chooses.\n\n"
            page += self._entry(parameter)
        return page

    def _entry(self, parameter: Parameter) -> str:
        schema = parameter.schema
        text = schema["description"]
        unit = UNIT.search(text)
        text = ranges.beginning_of(UNIT.sub("", text))[1]
        default = schema.get("default", "")
        default = str(default).lower() if isinstance(default, bool) else str(default)
        page = f"({parameter.target})=\n### {escaped(parameter.name)}\n\n{self._meaning(text, schema)}\n\n"
        page += f"- Default: {code(default)}\n- Range: {self._range(parameter)}\n"
        page += f"- Unit: {escaped(unit[1]) if unit else 'none'}\n"
        page += f"- For `--set`: {code('/'.join((*parameter.path, parameter.name)))}\n"
        page += f"- Example: {self._example(parameter)}\n"
        name = re.escape(parameter.name)
        messages = [
            f"[{message['key']}](message-{message['key']})"
            for message in self.messages
            if re.search(rf"'{name}(?: = [^']*)?'", message["remedy"] + message["meaning"])
        ]
        if messages:
            page += f"- Messages: {', '.join(messages)}\n"
        return page + f"- See also: {self._links(parameter)}\n\n"

    def _range(self, parameter: Parameter) -> str:
        """Returns what a parameter allows: by the schema, the table, or the start of the description."""
        schema = parameter.schema
        if "enum" in schema:
            return ", ".join(code(str(value)) for value in schema["enum"])
        if schema["type"] == "boolean":
            return "`true`, `false`"
        key = ranges.key_of(parameter.path, parameter.name)
        if key:
            return ranges.RANGES[key].replace("<", "\\<").replace(">", "\\>")
        begins = ranges.beginning_of(schema["description"])[0]
        return escaped(begins) if begins else ranges.range_of_number(schema)

    def _links(self, parameter: Parameter) -> str:
        """Returns links to the pages that name a parameter."""
        name = re.escape(parameter.name).replace(r"\ ", r"\s+")
        return ", ".join(self._mentions(rf"(?:`|set |/){name}(?:`|\s*=)", 2))

    def _example(self, parameter: Parameter) -> str:
        """Returns a line of a scene, else of the guide; or of a parameter of the same name and meaning."""
        alike = [
            self._examples.get((other.path, other.name))
            for other in (parameter, *self.parameters)
            if other.name == parameter.name and other.schema == parameter.schema
        ]
        example = next((example for example in alike if example), None)
        if example:
            return f"{code(f'set {parameter.name} = {example.value}')}, in {self._scene(example)}"
        pattern = re.compile(rf"^ *set +{re.escape(parameter.name)} *= *([^#\n]+?) *(?:#.*)?$", re.MULTILINE)
        for page, text in sorted(self._pages.items()):
            found = pattern.search(text) if page.startswith("guide/") else None
            if found:
                title = re.search(r"^# (.+)$", text, re.MULTILINE)
                link = f"[{title[1] if title else page}](../../{page})"
                return f"{code(f'set {parameter.name} = {found[1]}')}, in {link}"
        return ""

    def _meaning(self, text: str, schema: dict[str, Any]) -> str:
        """Returns a meaning, with a list of the values that have one of their own."""
        text, values = ranges.values_in(text, [str(value) for value in schema.get("enum", [])])
        lines = [self._linked(text)] if text else []
        for value, condition, meaning in values:
            shown = value if value == "Empty" else code(value)
            lines.append(f"* {shown}{escaped(condition)}: {self._linked(meaning)}")  # not the bullet below
        return "\n".join(lines if not text else [lines[0] + ("\n" if values else ""), *lines[1:]])

    def _scene(self, example: Example) -> str:
        """Returns a link to a scene, or to its page where it has one."""
        path = Path(example.scene)
        if path.parent.as_posix() == "prm" and f"scenes/{path.stem}.md" in self._pages:
            return f"[{path.name}](../../scenes/{path.stem}.md)"
        return f"[{path.name}](../../../{example.scene})"

    def _parameter_index(self, sections: dict[str, list[Parameter]]) -> str:
        page = (
            "# Parameter reference\n\n"
            f"`billet --print-parameters` prints these {len(self.parameters)} parameters. Units are those of"
            " the scene, which must be consistent.\n\n```{toctree}\n:maxdepth: 1\n\n"
        )
        page += "".join(f"{target(section)}\n" for section in sections) + "```\n\n## All parameters\n\n"
        rows = [
            (f"[{escaped(parameter.name)}]({parameter.target})", code("/".join(parameter.path) or "–"))
            for parameter in sorted(self.parameters, key=lambda entry: (entry.name.lower(), entry.path))
        ]
        return page + table(("parameter", "subsection"), rows)

    def _message_page(self) -> str:
        page = (
            "# Messages\n\n"
            f"Each message of a run has a key. These are the {len(self.messages)} keys;"
            " `billet --print-diagnostics` prints them. The file `diagnostics.jsonl` in the output folder has"
            " the messages of a run.\n\n"
        )
        rows = [(f"[{entry['key']}](message-{entry['key']})", entry["severity"]) for entry in self.messages]
        page += table(("key", "severity"), rows)
        for entry in self.messages:
            page += f"(message-{entry['key']})=\n## {entry['key']}\n\n*{entry['severity'].capitalize()}.* "
            page += self._linked(entry["meaning"]) + "\n\n"
            if entry["remedy"]:
                page += f"*Remedy.* {self._linked(entry['remedy'])}.\n\n"
            pages = self._mentions(rf"\b{re.escape(entry['key'])}\b(?!\.)", 0)
            if pages:
                page += f"See also: {', '.join(pages)}\n\n"
        return page

    def _list_index(self) -> str:
        page = "# Lists of types\n\n`billet --list` prints what scenes can name.\n\n"
        rows = [(f"[{entry['name']}]({entry['name']}.md)", prose(entry["meaning"])) for entry in self.lists]
        page += table(("list", "meaning"), rows) + "```{toctree}\n:hidden:\n\n"
        return page + "".join(f"{entry['name']}\n" for entry in self.lists) + "```\n"

    @staticmethod
    def _in_cell(text: str) -> str:
        """Returns a meaning in one line, with its values as code."""
        choices = re.match(r"[\w -]+(?:\|[\w -]+)+(?=: )", text)
        text, values = ranges.values_in(text, choices[0].split("|") if choices else [])
        parts = [prose(text)] if text else []
        for value, condition, meaning in values:
            parts.append(
                f"{value if value == 'Empty' else code(value)}{escaped(condition)}: {prose(meaning)}"
            )
        return " ".join(parts)

    def _list_page(self, entry: dict[str, str]) -> str:
        page = (
            f"# {entry['name'].capitalize()}\n\n{prose(entry['meaning'][:1].upper() + entry['meaning'][1:])}."
        )
        page += f" `billet --list {entry['name']}` prints this list.\n\n"
        for kind in json.loads(self._ask("--list", "--json", entry["name"])):
            meaning = kind["meaning"].rstrip(".")
            page += f"## {escaped(kind['name'])}\n\n{prose(meaning[:1].upper() + meaning[1:])}.\n\n"
            if kind.get("use"):
                page += "```prm\n" + "\n".join(kind["use"].split("; ")) + "\n```\n\n"
            parameters = kind.get("parameters", [])
            if parameters:
                has_defaults = any(parameter.get("default") for parameter in parameters)
                head = ("name", "default", "meaning") if has_defaults else ("name", "meaning")
                rows = []
                for parameter in parameters:
                    row = [code(parameter["name"]), self._in_cell(parameter["meaning"])]
                    if has_defaults:
                        row.insert(1, code(parameter["default"]) if parameter["default"] else "–")
                    rows.append(row)
                page += table(head, rows)
            others = [key for key in kind if key not in ("name", "meaning", "use", "parameters")]
            for key in others:
                if kind[key] and isinstance(kind[key], list) and isinstance(kind[key][0], dict):
                    heads = list(kind[key][0])
                    lines = [[prose(str(line.get(head, ""))) for head in heads] for line in kind[key]]
                    page += f"{key.capitalize()}:\n\n" + table(heads, lines)
        return page
