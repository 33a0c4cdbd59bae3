#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: prose.py [--program BILLET] [FILE...]
       prose.py --self-check

Checks the prose of the pages beside README.md, in .github/ and in doc/: no line has more than 100 columns, no
sentence more than 25 words, no paragraph more than five sentences. Tables, code and formulas may be wider.
Lines of manual pages (.1) have as few columns.

The same holds for the comments of scenes and of their parts in prm/, materials/ and examples/. An empty
comment ends a paragraph there; a comment at the end of a line is one. Lines without a comment may be wider.

It also holds for the comments of C++ in include/ and source/. Formulas and tables have more indent there
than the text above them, and operators or columns. Such a line counts as one word, with the sign at its end,
but is no wider, either. Symbols that operators join within a line count as one word. An item of a list is a
paragraph. Directives for tools such as clang-tidy are no comments.

Words are what stands between blanks, per cent and words of code within a line among them, but no operators. A
formula counts as one word. A sentence that goes on below a formula, or in the next item of a list, counts as
one. Tables have a head. A row of one is no prose and may be wide, but the sentences of its cells, also in
lists, are as short. A semicolon ends no sentence. What a program printed stands in blocks of code.

FILE checks some pages (.md), scenes (.prm) or sources (.h, .cc) only, among them pages that scripts make for
the site. --program checks what a program says of its parameters, messages and lists, too.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, Iterator, NamedTuple

ROOT = Path(__file__).resolve().parents[1]
MAX_COLUMNS = 100
MAX_WORDS = 25
MAX_SENTENCES = 5
LEFT_OUT = ("doc/site/",)
SCENES = ("examples", "materials", "prm")
SOURCES = ("include/**/*.h", "source/**/*.h", "source/**/*.cc")

FENCE = re.compile(r"\s*(`{3,}|~{3,}|\$\$)")
ITEM = re.compile(r"(\s*)(?:[-*+]|\d+[.)])\s+(.*)")
SKIPPED = re.compile(r"\s*(?:#|\||<!--|:::|\(\S+\)=$|\[\S+\]: |-{3,}$)")
RULE = re.compile(r"\s*\|(?:\s*:?-+:?\s*\|)+\s*$")
ABBREVIATION = re.compile(
    r"\b(?:e\.g|i\.e|cf|ch|vol|no|pp?|eds?|eqs?|figs?|sec|vs|al|st|approx)\.$", re.IGNORECASE
)
BLANK_IN_CODE = "\ue000"
END = re.compile(r"[.!?][)\"'»”*_]*(?=\s+[^a-zµ]|\s*$)")
# Tokens of C++: comments, and strings and the like, in which two slashes begin no comment.
TOKEN = re.compile(
    r'R"([^()\\\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])*\'|/\*.*?\*/'
    r"|(//[/!]?<?)([^\n]*)",
    re.DOTALL,
)
DIRECTIVE = re.compile(r"\s*(?:NOLINT|clang-format o|SPDX-)")
OPERATOR = re.compile(r"[-=+−*/·×⊗:≈≤≥<>→←∈]|[<>]=|<<|>>")
FUNCTION = re.compile(r"\W*(?:exp|ln|log|sin|cos|tan|tr|dev|sym|det|max|min)\b")
ITEM_OF_CODE = re.compile(r"\s*- +\S")
COLUMNS = re.compile(r"\S {2,}\S")
END_OF_FORMULA = re.compile(r"([.,;:])\s*(?:\([A-Z]?\d+[a-z]?\))*$")  # before its number


class Paragraph(NamedTuple):
    """Text between blank lines, or an item of a list."""

    line: int
    text: str
    is_item: bool


class Fault(NamedTuple):
    """Something that breaks a rule."""

    line: int
    what: str


def code_as_word(match: re.Match[str]) -> str:
    """Returns code within a line as one word without an end of a sentence, which n_words() takes apart."""
    words = re.sub(r"[.!?|<>\[\]()*_$]", "", match[2]).split()
    return "C" + "".join(BLANK_IN_CODE + word for word in words[1:])


def plain(text: str) -> str:
    """Returns Markdown without what is no word: formulas count as one word, links as their text."""
    text = re.sub(r"<!--.*?-->", " ", text)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", " ", text)
    text = re.sub(r"\{[\w:.-]+\}`[^`]*`", "R", text)
    text = re.sub(r"(`+)([^`].*?)\1", code_as_word, text)
    text = re.sub(r"\$[^$]+\$", "F", text)
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"<[^>]+>", " ", text)


def sentences_of(text: str) -> list[str]:
    """Returns the sentences of a paragraph."""
    text = " ".join(plain(text).split())
    sentences = []
    begin = 0
    for match in END.finditer(text):
        if ABBREVIATION.search(text[begin : match.start() + 1]) and match.end() < len(text):
            continue
        sentences.append(text[begin : match.end()].strip())
        begin = match.end()
    rest = text[begin:].strip()
    return [sentence for sentence in [*sentences, rest] if n_words(sentence)]


def n_words(sentence: str) -> int:
    """Returns the number of words, without signs and operators that stand alone, but for per cent."""
    return sum(1 for word in re.split(rf"[\s{BLANK_IN_CODE}]+", sentence) if re.search(r"[\w%]", word))


def prose_lines(text: str) -> Iterator[tuple[int, str]]:
    """Returns the lines that are prose, with their numbers; an empty one where anything else stands."""
    fence = ""
    was_blank = True
    in_list = False
    in_code = False
    for number, line in enumerate(text.splitlines(), 1):
        opened = FENCE.match(line)
        if fence:
            if opened and opened[1].startswith(fence):
                fence = ""
            yield number, ""
            continue
        if opened and not (opened[1] == "$$" and line.count("$$") > 1):
            fence = opened[1]
            yield number, ""
            continue
        if not line.strip():
            was_blank = True
            yield number, ""
            continue
        indent = len(line) - len(line.lstrip())
        if indent == 0:
            in_list = bool(ITEM.match(line)) or (in_list and not was_blank)
        in_code = indent >= 4 and not in_list and (was_blank or in_code)
        was_blank = False
        yield number, "" if in_code or SKIPPED.match(line) or line.count("$$") > 1 else line


def paragraphs_of(text: str) -> list[Paragraph]:
    """Returns the paragraphs of a page."""
    found: list[Paragraph] = []
    lines: list[str] = []
    begin = 0
    is_item = False

    def close() -> None:
        if lines:
            found.append(Paragraph(begin, " ".join(lines), is_item))
        lines.clear()

    for number, line in prose_lines(text):
        item = ITEM.match(line)
        if lines and not is_item and re.match(r"\d", line) and not line.startswith("1."):
            item = None  # a number at the start of a line
        if not line or item:
            close()
        if line:
            if not lines:
                begin = number
                is_item = bool(item)
            lines.append(item[2] if item else line.strip().lstrip("> "))
    close()
    return found


def faults_of_tables(text: str) -> list[Fault]:
    """Returns tables without a head, and sentences of cells with too many words."""
    faults = []
    fence = ""
    was_row = False
    lines = [*text.splitlines(), ""]
    for number, line in enumerate(lines[:-1], 1):
        opened = FENCE.match(line)
        if opened and (not fence or opened[1].startswith(fence)):
            fence = "" if fence else opened[1]
        is_row = not fence and line.lstrip().startswith("|")
        if is_row and not was_row and not RULE.match(lines[number]):
            faults.append(Fault(number, "a table without a head, which no site shows as one"))
        was_row = is_row
        if not is_row:
            continue
        for cell in plain(line).split("|"):
            faults += [
                Fault(number, f"{n_words(sentence)} words in a cell: {sentence[:60]}...")
                for sentence in sentences_of(cell)
                if n_words(sentence) > MAX_WORDS
            ]
    return faults


def faults_of_sentences(line: int, sentences: list[str]) -> list[Fault]:
    """Returns what breaks the rules in the sentences of a paragraph."""
    faults = [
        Fault(line, f"{n_words(sentence)} words: {sentence[:60]}...")
        for sentence in sentences
        if n_words(sentence) > MAX_WORDS
    ]
    if len(sentences) > MAX_SENTENCES:
        faults.append(Fault(line, f"{len(sentences)} sentences in a paragraph"))
    return faults


def faults_of(text: str) -> list[Fault]:
    """Returns what breaks the rules in a page."""
    faults = [
        Fault(number, f"{len(line)} columns")
        for number, line in prose_lines(text)
        if len(line) > MAX_COLUMNS and " " in re.sub(r"\]\([^)]*\)|`[^`]*`", "]", line.strip())
    ]
    before = ""
    for paragraph in paragraphs_of(text):
        sentences = sentences_of(paragraph.text)
        is_next = paragraph.is_item and before.endswith((";", ","))
        goes_on = bool(before and (is_next or not paragraph.is_item and re.match("[a-z]", paragraph.text)))
        if goes_on and sentences:
            sentences[0] = f"{before} {sentences[0]}"
        before = ""
        end = r"[^;,]$" if paragraph.is_item else r"[.!?]\W*$"
        if sentences and not re.search(end, sentences[-1]):
            before = sentences[-1]
        faults += faults_of_sentences(paragraph.line, sentences)
    return sorted(faults)


def comments_of(scene: str) -> list[Paragraph]:
    """Returns the paragraphs of the comments of a scene."""
    found: list[Paragraph] = []
    lines: list[str] = []
    begin = 0
    for number, line in enumerate([*scene.splitlines(), ""], 1):
        statement, _, comment = line.partition("#")
        comment = comment.replace("<", "=").strip()  # which begins no tag here
        comment = re.sub(r"(?<=[,.] )([A-Z])\.(?= )", r"\1", comment)  # initials of authors end no sentence
        is_whole_line = not statement.strip()
        if lines and not (is_whole_line and comment):
            found.append(Paragraph(begin, " ".join(lines), False))
            lines.clear()
        if comment and is_whole_line:
            begin = begin if lines else number
            lines.append(comment)
        elif comment:
            found.append(Paragraph(number, comment, False))
    return found


def faults_of_scene(scene: str) -> list[Fault]:
    """Returns what breaks the rules in the comments of a scene."""
    faults = [
        Fault(number, f"{len(line)} columns")
        for number, line in enumerate(scene.splitlines(), 1)
        if len(line) > MAX_COLUMNS and "#" in line
    ]
    for paragraph in comments_of(scene):
        faults += faults_of_sentences(paragraph.line, sentences_of(paragraph.text))
    return sorted(faults)


class Comment(NamedTuple):
    """A comment of C++ in one line."""

    line: int
    column: int
    mark: str
    text: str
    is_whole_line: bool


def cpp_comments(code: str) -> list[Comment]:
    """Returns the comments of C++, without those for tools."""
    comments = []
    for token in TOKEN.finditer(code):
        if token[2] and not DIRECTIVE.match(token[3]):
            begin = code.rfind("\n", 0, token.start()) + 1
            before = code[begin : token.start()]
            line = code.count("\n", 0, begin) + 1
            comments.append(Comment(line, len(before), token[2], token[3], not before.strip()))
    return comments


def continues(before: Comment, comment: Comment) -> bool:
    """Returns whether a comment may be of the paragraph of that in the line before."""
    is_below = before.is_whole_line or comment.mark == "///<" or comment.column == before.column
    return comment.line == before.line + 1 and comment.mark == before.mark and is_below


def is_symbol(word: str) -> bool:
    """Returns whether a word may be part of a formula: no word of ordinary letters but a function's name."""
    return bool(FUNCTION.match(word)) or not re.search(r"(?<![\w\\])[A-Za-z][a-z'-]+(?![\w(])", word)


def is_layout(line: str) -> bool:
    """Returns whether a line that is set apart is a formula or a row of a table."""
    return bool(COLUMNS.search(line)) or any(OPERATOR.fullmatch(word) for word in line.split())


def formulas_as_words(text: str) -> str:
    """Returns a text in which symbols that operators join are one word."""
    found: list[str] = []
    formula: list[str] = []

    def close() -> None:
        if any(OPERATOR.fullmatch(word) for word in formula[1:-1]):
            end = re.search(r"[.,;:!?)]*$", formula[-1])
            found.append("Formula" + (end[0] if end else ""))
        else:
            found.extend(formula)
        formula.clear()

    for word in text.split():
        if not is_symbol(word):
            close()
            found.append(word)
            continue
        formula.append(word)
        if re.search(r"[^.][.,;:!?]$", word):
            close()
    close()
    return " ".join(found)


def paragraphs_of_code(code: str) -> list[Paragraph]:
    """Returns the paragraphs of the comments of C++; what is set apart is one word of the text around it."""
    found: list[Paragraph] = []
    lines: list[str] = []
    first = last = Comment(0, 0, "", "", False)
    in_item = False

    def close() -> None:
        if lines:
            text = " ".join(lines).replace("<", "=")  # which begins no tag here
            text = re.sub(r"(?<=[,.] )([A-Z])\.(?= )", r"\1", text)  # initials of authors end no sentence
            found.append(Paragraph(first.line, formulas_as_words(text), False))
        lines.clear()

    for comment in cpp_comments(code):
        is_next = comment.is_whole_line and continues(last, comment)
        indent = len(comment.text) - len(comment.text.lstrip())
        is_apart = is_next and last.is_whole_line and indent >= (6 if in_item else 3)
        is_item = not is_apart and bool(ITEM_OF_CODE.match(comment.text))
        if not is_next or is_item or not comment.text.strip():
            close()
            in_item = is_item
        first = first if lines else comment
        last = comment
        if is_apart and is_layout(comment.text):
            end = END_OF_FORMULA.search(comment.text)
            lines.append("Formula" + (end[1] if end else ""))
        elif comment.text.strip(" -"):
            lines.append(comment.text.strip())
    close()
    return found


def faults_of_code(code: str) -> list[Fault]:
    """Returns what breaks the rules in the comments of C++."""
    widths = [len(line) for line in code.splitlines()]
    faults = [
        Fault(comment.line, f"{widths[comment.line - 1]} columns")
        for comment in cpp_comments(code)
        if widths[comment.line - 1] > MAX_COLUMNS
    ]
    for paragraph in paragraphs_of_code(code):
        faults += faults_of_sentences(paragraph.line, sentences_of(paragraph.text))
    return sorted(faults)


def descriptions_of(program: str) -> Iterator[tuple[str, str]]:
    """Returns what a program says of its parameters, messages and lists."""

    def ask(*options: str) -> object:
        command = [program, *options, "--json"]
        return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)

    def walk(schema: dict[str, Any], path: str) -> Iterator[tuple[str, str]]:
        for name, entry in schema.get("properties", {}).items():
            yield f"{path}{name}", entry.get("description", "")
            yield from walk(entry, f"{path}{name}/")
        if isinstance(schema.get("additionalProperties"), dict):
            yield from walk(schema["additionalProperties"], f"{path}NAME/")

    schema = ask("--print-parameters")
    assert isinstance(schema, dict)
    yield from walk(schema, "")
    messages = ask("--print-diagnostics")
    assert isinstance(messages, list)
    for message in messages:
        yield f"message {message['key']}", message["meaning"]
        yield f"message {message['key']}", message["remedy"]
    lists = ask("--list")
    assert isinstance(lists, list)
    for entry in lists:
        types = ask("--list", entry["name"])
        assert isinstance(types, list)
        for kind in types:
            yield f"{entry['name']}/{kind['name']}", kind["meaning"]
            for parameter in kind.get("parameters", []):
                yield f"{entry['name']}/{kind['name']}/{parameter['name']}", parameter["meaning"]


def faults_of_description(text: str) -> list[str]:
    """Returns the sentences of a description that are too long. What it quotes counts as code."""
    text = re.sub(r"(?<!\w)'([^'\n]+?)'(?!\w)", r"`\1`", text)
    # The meaning of a value begins with its name, which may be in small letters: "none: no friction".
    text = re.sub(r"\. (?=[a-z][\w |-]*(?:, [\w >.]+)*:)", ". The ", text)
    return [sentence for sentence in sentences_of(text) if n_words(sentence) > MAX_WORDS]


def check_program(program: str) -> int:
    """Prints sentences that are too long; returns their number."""
    faults = {
        f"{name}: {n_words(sentence)} words: {sentence.replace(BLANK_IN_CODE, ' ')}": None
        for name, text in descriptions_of(program)
        for sentence in faults_of_description(text)
    }
    for fault in faults:
        print(fault)
    return len(faults)


def pages() -> list[str]:
    files = [*sorted(ROOT.glob("*.md")), *sorted((ROOT / ".github").rglob("*.md"))]
    files += [*sorted((ROOT / "doc").rglob("*.md")), *sorted((ROOT / "doc").glob("*.1"))]
    names = [file.relative_to(ROOT).as_posix() for file in files if file.exists()]
    return [name for name in names if not name.startswith(LEFT_OUT)]


def scenes() -> list[str]:
    """Returns the scenes whose comments users read, and their parts."""
    files = [file for folder in SCENES for file in sorted((ROOT / folder).rglob("*.prm"))]
    return [file.relative_to(ROOT).as_posix() for file in files]


def sources() -> list[str]:
    """Returns the files of C++ whose comments are checked."""
    return sorted(file.relative_to(ROOT).as_posix() for files in SOURCES for file in ROOT.glob(files))


def check_files(names: list[str]) -> int:
    """Prints what is wrong; returns the number of errors."""
    n_errors = 0
    for name in names:
        text = (ROOT / name).read_text(encoding="utf-8")
        if name.endswith(".prm"):
            faults = faults_of_scene(text)
        elif name.endswith((".h", ".cc")):
            faults = faults_of_code(text)
        elif name.endswith(".1"):
            lines = enumerate(text.splitlines(), 1)
            faults = [Fault(i, f"{len(line)} columns") for i, line in lines if len(line) > MAX_COLUMNS]
        else:
            faults = faults_of(text) + faults_of_tables(text)
        for fault in sorted(faults):
            print(f"{name}:{fault.line}: {fault.what}")
            n_errors += 1
    return n_errors


SAMPLES: tuple[tuple[str, list[str]], ...] = (
    ("A short sentence.\n", []),
    ("word " * 26 + "\n", ["130 columns", "26 words"]),
    ("One. Two. Three. Four. Five. Six.\n", ["6 sentences"]),
    ("One, e.g. two. Three `a. B` four. See ch. 5. Five. Six.\n", []),
    ("| " + "wide " * 40 + "|\n", []),
    ("    " + "code " * 40 + "\n", []),
    ("```\n" + "code " * 40 + "\n```\n", []),
    ("- " + "item " * 15 + "\n- " + "item " * 15 + "\n", []),
    ("[link](" + "x" * 120 + ")\n", []),
    ("`" + "code " * 24 + "`,\n", []),
    ("`" + "code " * 24 + "` and\n", ["126 columns"]),
    ("Formula\n\n$$\n" + "a " * 60 + "\n$$\n", []),
    ("- one\n\n    " + "text " * 26 + "\n", ["134 columns", "26 words"]),
    ("The law " + "is " * 14 + "to\n10. " + "Word " * 12 + "\n", []),
    ("The law " + "is " * 19 + "from 1 to\n10 or\n20. It ends.\n", ["27 words"]),
    ("With\n\n$$\na\n$$\n\n" + "word " * 13 + "\n\n$$\nb\n$$\n\n" + "word " * 13 + "\n", ["27 words"]),
    ("It is so.\n\n$$\na\n$$\n\n" + "word " * 25 + "\n", ["125 columns"]),
    ("- " + "item " * 13 + "\n- " + "item " * 13 + "\n", []),
    ("- " + "item " * 13 + ";\n- " + "item " * 13 + ";\n", ["26 words"]),
    ("It is `" + "code " * 13 + "`\nand 2 % = " + "word " * 9 + "\n", ["27 words"]),
    ("It is `code. code` of 2 %. Then it is `a | b`.\n", []),
)
TABLES: tuple[tuple[str, int], ...] = (
    ("- item\n\n  | a | b |\n  |---|:-:|\n  | a | " + "word " * 26 + "|\n", 1),
    ("| `" + "code " * 14 + "` " + "word " * 12 + "|\n|---|\n", 1),
    ("| a | b |\n| --- | --- |\n| a | " + "word " * 26 + "|\n", 1),
    ("| " + "word " * 20 + "| " + "word " * 20 + "|\n|---|---|\n", 0),
    ("| " + "word " * 20 + "one; two " + "word " * 20 + "|\n|---|\n", 1),
    ("| " + "word " * 20 + "one. Two " + "word " * 20 + "|\n|---|\n", 0),
    ("```\n| " + "word " * 26 + "|\n```\n", 0),
    ("| a |\n|---|\n| b |\n\n| c |\n", 1),
    ("| a |\n| b |\n", 1),
)
DESCRIPTIONS: tuple[tuple[str, int], ...] = (
    ("Law. one: " + "word " * 20 + "end. two: " + "word " * 20 + "end.", 0),
    ("Law. one: " + "word " * 20 + "end; two: " + "word " * 20 + "end.", 1),
    ("Law. shift, in explicit scenes: " + "word " * 15 + "end. one point: " + "word " * 20 + "end.", 0),
    ("word " * 24 + "'of code'.", 1),
    ("word " * 24 + "'code'.", 0),
    ("Of bodies' nodes, " + "word " * 15 + "of the bodies' ends and " + "word " * 5 + ".", 1),
)
SCENE_SAMPLES: tuple[tuple[str, list[str]], ...] = (
    ("# A short sentence.\nset A = 1   # and another\n", []),
    ("set A = " + "x " * 60 + "\n", []),
    ("set A = " + "x " * 40 + "# a comment at the end\n", ["110 columns"]),
    ("#" + " word" * 20 + "\n", ["101 columns"]),
    ("# One" + " word" * 12 + "\n  # and" + " word" * 12 + "\n", ["26 words"]),
    ("# One" + " word" * 12 + "\n#\n# And" + " word" * 12 + "\n", []),
    ("# One" + " word" * 12 + "\n\n# And" + " word" * 12 + "\n", []),
    ("# One" + " word" * 12 + "\nset A = 1   #" + " word" * 13 + "\n# And" + " word" * 12 + "\n", []),
    ("set A = 1 #" + " a" * 26 + "\n", ["26 words"]),
    ("# -1 < x < 1" + " a" * 22 + " > b\n", ["26 words"]),
    ("# By One, A. B. & Two, C. D., 2001. Three. Four. Five. Six.\n", []),
    ("# One. Two. Three.\n# Four. Five. Six.\n", ["6 sentences"]),
    ("# One. Two. Three.\n#\n# Four. Five. Six.\n", []),
    ("  # One. Two. Three.\n  # Four. Five. Six.", ["6 sentences"]),
)
CODE_SAMPLES: tuple[tuple[str, list[str]], ...] = (
    ("/// A short sentence.\nint i = 1; ///< another\n", []),
    ("int i = " + "1 + " * 40 + "1;\n", []),
    ("int i = " + "1 + " * 20 + "1; // a comment at its end\n", ["114 columns"]),
    ('f("' + "x" * 60 + '"); // NOLINT(' + "x" * 40 + ")\n", []),
    ("///" + " word" * 20 + "\n", ["103 columns"]),
    ("  /// One" + " word" * 12 + "\n  /// and" + " word" * 12 + "\n", ["26 words"]),
    ("// One" + " word" * 12 + "\n//\n// And" + " word" * 12 + "\n", []),
    ("// One" + " word" * 12 + "\nint i;\n// And" + " word" * 12 + "\n", []),
    ("// One" + " word" * 12 + "\n/// And" + " word" * 12 + "\n", []),
    ("int i; ///< One" + " word" * 12 + "\n    ///< and" + " word" * 12 + "\n", ["26 words"]),
    ("int i; // One" + " word" * 12 + "\n       // and" + " word" * 12 + "\n", ["26 words"]),
    ("int i; // One" + " word" * 12 + "\n// And" + " word" * 12 + "\n", []),
    ("/// One" + " word" * 12 + ":\n/// - item" + " word" * 12 + "\n", []),
    ("/// - item" + " word" * 12 + "\n///   and" + " word" * 12 + "\n", ["26 words"]),
    ("/// One" + " word" * 11 + ":\n///   a b c" + " = a" * 15 + ",\n/// where" + " word" * 11 + "\n", []),
    ("/// One" + " word" * 11 + ":\n///   a = b,\n/// where" + " word" * 12 + "\n", ["26 words"]),
    ("/// One" + " word" * 11 + ":\n///   name   " + "word " * 14 + "\n/// where" + " word" * 11 + "\n", []),
    ("/// One" + " word" * 12 + "\n///   and" + " word" * 12 + "\n", ["26 words"]),
    ("/// It has a_n = Σ b_i (c + d)/e² < 1" + " word" * 11 + "\n///" + " word" * 11 + "\n", []),
    ("/// It has it = the" + " word" * 11 + " x" * 11 + "\n", ["26 words"]),
    ("/// It has a = ln b · tr c" + " word" * 11 + "\n///" + " word" * 11 + "\n", []),
    ("/// - item" + " word" * 12 + "\n///   and a = b" + " word" * 12 + "\n", ["27 words"]),
    ("/// One" + " word" * 11 + ":\n///   force = mass times rate\n/// where" + " word" * 11 + "\n", []),
    ("/// One" + " word" * 12 + ":\n///   a = b.   (C1)\n/// Then" + " word" * 12 + "\n", []),
    ("/// By One, A. B. & Two, C. D., 2001. Three. Four. Five. Six.\n", []),
    ("/// It is <a" + " so" * 24 + ">\n", ["27 words"]),
    ("/// In a = 1. Two. Three. Four. Five. Six.\n", ["6 sentences"]),
    ("/// One. Two. Three.\n///\n/// Four. Five. Six.\n", []),
    ('f("// One. Two. Three. Four. Five. Six."); // Seven.\n', []),
    ('f(R"(\n// One. Two. Three. Four. Five. Six.\n)"); // Seven.\n', []),
    ("const int n = 1'000; // it's one. Two. Three. Four. Five. Six.\n", ["6 sentences"]),
)


def self_check() -> int:
    """Tests the test; returns the number of errors."""
    n_errors = 0
    samples = [(text, faults_of(text), expected) for text, expected in SAMPLES]
    samples += [(text, faults_of_scene(text), expected) for text, expected in SCENE_SAMPLES]
    samples += [(text, faults_of_code(text), expected) for text, expected in CODE_SAMPLES]
    for text, found, expected in samples:
        faults = [fault.what for fault in found]
        if len(faults) != len(expected) or not all(f.startswith(e) for f, e in zip(faults, sorted(expected))):
            print(f"{text[:40]!r}: found {faults}, expected {expected}")
            n_errors += 1
    for text, n_expected in TABLES:
        if len(faults_of_tables(text)) != n_expected:
            print(f"{text[:40]!r}: found {faults_of_tables(text)}, expected {n_expected}")
            n_errors += 1
    for text, n_expected in DESCRIPTIONS:
        if len(faults_of_description(text)) != n_expected:
            print(f"{text[:40]!r}: found {faults_of_description(text)}, expected {n_expected}")
            n_errors += 1
    print(f"{len(samples) + len(TABLES) + len(DESCRIPTIONS)} samples, {n_errors} errors")
    return n_errors


def main() -> int:
    """Returns the exit code."""
    arguments = sys.argv[1:]
    n_errors = 0
    if "--self-check" in arguments:
        return 1 if self_check() else 0
    if "--program" in arguments:
        at = arguments.index("--program")
        n_errors += check_program(arguments[at + 1])
        del arguments[at : at + 2]
    files = [argument for argument in arguments if not argument.startswith("--")]
    n_errors += check_files(files or pages() + scenes() + sources())
    if not files:
        counts = f"{len(pages())} pages, {len(scenes())} scenes and parts, {len(sources())} files of C++"
        print(f"{counts}, {n_errors} errors")
    return 1 if n_errors else 0


if __name__ == "__main__":
    sys.exit(main())
