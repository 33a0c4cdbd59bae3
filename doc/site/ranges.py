# SPDX-License-Identifier: LGPL-2.1-or-later
"""Values that parameters allow, if neither the program's schema nor the start of a description gives them."""

from __future__ import annotations

import re
from typing import Any, Sequence

VECTOR = "a vector `x, y, z` other than 0"
POINT = "a point `x, y, z`"
FILE = "a file of comma-separated values, or empty"
COLUMNS = "two whole numbers from 1, separated by a comma"
OF_TIME = "of the time `t` and the names of amplitudes"
THREE_OF_TIME = f"three expressions {OF_TIME}, separated by semicolons"
FACES = "ids and names of boundaries, separated by commas"
POINTS = "points `x : y`, separated by commas, or empty"
SECONDS = "a number > 0, or empty"
ANY_NUMBERS = "numbers, separated by commas"

# By name, or by the last subsection and the name where another parameter of this name differs.
RANGES = {
    "Title": "any text",
    "Libraries": "names of files, separated by semicolons, or empty",
    "Target error": "a number > 0 and < 1, a percentage such as `1 %`, or empty",
    "Times": "numbers that increase strictly, separated by commas",
    "Amplitudes/Values": f"{ANY_NUMBERS}, as many as times",
    "Amplitudes/File": FILE,
    "File columns": COLUMNS,
    "Thickness direction": "three expressions of `x`, `y`, `z`, separated by semicolons, or empty",
    "Refinement times": "up to five numbers that increase strictly, separated by commas, or empty",
    "Initial velocity": "three expressions of `x`, `y`, `z`, separated by semicolons",
    "Symmetry planes": "planes `x = d` or `a, b, c = d`, separated by semicolons, or empty",
    "Primitive": "a name of the [list of primitives](../types/primitives.md)",
    "Arguments": "arguments of the [list of primitives](../types/primitives.md), separated by `:`",
    "Mesh/File": "a mesh file: `.msh`, `.vtk`, `.inp` or `.ucd`",
    "Volumes": "names and numbers of volumes, separated by commas, or empty",
    "Merge nodes within": "a number >= 0, or empty",
    "Positions": "three expressions of `x`, `y`, `z`, separated by commas or semicolons, or empty",
    "Section area": "a number >= 0; 0 leaves the area as it is",
    "Wedge angle": "a number > 0 and <= 30",
    "Height": "a number > 0",
    "Layers": "whole numbers from 1",
    "Rotation angle": f"an expression {OF_TIME}",
    "Mesh/Rotation angle": "any number",
    "Rotation axis": VECTOR,
    "Mesh/Translation": "a vector `x, y, z`",
    "Mesh/Boundary ids": "entries `id : condition`, separated by semicolons, or empty",
    "Library": "a shared library",
    "Constants": f"{ANY_NUMBERS}, or empty",
    "State variable names": "names, separated by commas, or empty",
    "Initial state variables": f"{ANY_NUMBERS}, one for each state variable, or empty",
    "Material name": "a text of at most 80 characters",
    "C10": "any number",
    "C01": "any number",
    "C20": "any number",
    "C30": "any number",
    "Prony moduli": "numbers > 0 with a sum < 1, separated by commas, or empty",
    "Prony times": "numbers > 0, as many as Prony moduli, separated by commas, or empty",
    "Ogden moduli": f"{ANY_NUMBERS}",
    "Ogden exponents": "numbers other than 0, as many as Ogden moduli, separated by commas",
    "Density": "a number >= 0",
    "Temperature": f"an expression {OF_TIME}, or empty",
    "Reference temperature": "any number",
    "Table": POINTS,
    "Table file": FILE,
    "Table columns": COLUMNS,
    "Rate table": POINTS,
    "Rate table file": FILE,
    "Rate table columns": COLUMNS,
    "Thermal table": POINTS,
    "Thermal table file": FILE,
    "Thermal table columns": COLUMNS,
    "Curve rates": "two or more numbers > 0 that increase strictly, separated by commas",
    "Curves file": FILE,
    "Curves columns": "whole numbers from 1, one more than rates, separated by commas",
    "Curve temperatures": "two or more numbers that increase strictly, separated by commas",
    "Thermal curves file": FILE,
    "Thermal curves columns": "whole numbers from 1, one more than temperatures, separated by commas",
    "r-values": "three numbers > 0, separated by commas, or empty",
    "Stress ratios": "six numbers > 0, separated by commas, or empty",
    "First axis": f"{VECTOR}, or empty",
    "Second axis": f"{VECTOR} that is not parallel to the first axis, or empty",
    "Axis point": f"{POINT}, or empty",
    "Axis direction": f"{VECTOR}, or empty",
    "Backstress moduli": "numbers >= 0, separated by commas, or empty",
    "Backstress rates": "numbers >= 0, as many as backstress moduli, separated by commas, or empty",
    "Forming limit": POINTS,
    "Forming limit file": FILE,
    "Forming limit columns": COLUMNS,
    "Boundary ids": f"{FACES}, or empty",
    "Contact pairs/Boundary ids": f"{FACES}, or `all`",
    "Nodes": "entries `at x, y, z`, `on line x, y, z : x, y, z` or `set NAME`, with semicolons between",
    "Components": "one to three of `x`, `y`, `z`, separated by commas",
    "Displacement": "three expressions of `x`, `y`, `z`, the time `t` and the names of amplitudes",
    "Until": "a number above 'From', or empty",
    "Fade time": "a number >= 0, or empty",
    "Acceleration": THREE_OF_TIME,
    "Pressure": "an expression of `x`, `y`, `z`, the time `t` and the names of amplitudes",
    "Loads/Direction": f"`all`, `normal` or {VECTOR}",
    "Traction": "three expressions of `x`, `y`, `z`, the time `t` and the names of amplitudes",
    "Body force": THREE_OF_TIME,
    "Loads/Force": THREE_OF_TIME,
    "Point": f"{POINT}, or empty",
    "Loads/Moment": THREE_OF_TIME,
    "Motion/Translation": THREE_OF_TIME,
    "Centre": POINT,
    "Motion/Force": f"an expression {OF_TIME}, or empty",
    "Force direction": f"{VECTOR}, or empty",
    "Motion/Moment": f"an expression {OF_TIME}, or empty",
    "Initial speed": "any number",
    "Stop force": f"an expression {OF_TIME}, or empty",
    "Removal time": SECONDS,
    "Exclusions": "one or two names of bodies and tools, `A` or `A : B`, separated by semicolons, or empty",
    "Tangential penalty": SECONDS,
    "Penetration tolerance": "a number >= 0, `automatic`, or empty",
    "Initial gap": "`open`, or `close within D` with a number D > 0",
    "Contact pairs/Body": "a name of a body",
    "Tool": "a name of a tool, or empty",
    "Second body": "a name of a body, or empty",
    "Second boundary ids": f"{FACES}, `all`, or empty",
    "Surface correction": "`none`, `cylinder : x, y, z ; a, b, c` or `sphere : x, y, z`",
    "Probes/Body": "a name of a body, or empty",
    "Quantities": "names of quantities, separated by commas",
    "Start": POINT,
    "End": POINT,
    "Probes/Values": "some of `least`, `largest`, `mean`, `sum` and `each`, separated by commas",
    "Opposite boundary ids": f"{FACES}",
    "Normal": VECTOR,
    "Probes/Direction": f"{VECTOR}, or empty",
    "Console": "names of columns, separated by commas, `all`, or empty",
    "Stops": "numbers > 0, not above the end time, separated by commas, or empty",
    "Initial step": "a number > 0, not above the end time, or `automatic`",
    "Minimum step": "a number > 0, not above the initial step, or `automatic`",
    "Maximum step": "a number > 0, not below the initial step, or `automatic`",
    "Time stepping/Error tolerance": "a number >= 0 and < 1",
    "Mass scaling step": "a number >= 0",
    "Implicit dynamics/Error tolerance": "a number >= 0",
    "Reference displacement": "a number >= 0",
    "Implicit dynamics/Maximum energy drift": "a number >= 0",
    "Force tolerance": "a number > 0 and < 1",
    "Energy tolerance": "a number > 0",
    "Displacement tolerance": "a number > 0",
    "Maximum augmentations": "whole numbers from 1",
    "Maximum linear iterations": "whole numbers from 1",
    "Interval": "a number >= 0",
    "History interval": "a number >= 0",
    "Restart/Release time": "a number >= 0",
    "Folder": "a name of a folder, or empty",
    "Output/State fields": "names of state fields, separated by commas, or empty",
    "Restart/File": "a checkpoint, or empty",
}

# "Voce, Ludwik: ", the types that use a parameter.
TYPES = r"(?:[A-Za-z][\w -]*(?:, [A-Za-z][\w -]*)*: )?"
NUMBER = r"-?[\w/']+(?:\.\d+)?"
COMPARED = (
    rf"(?:\w+(?:, \w+)* |{NUMBER} )??(?:[<>]=?|to) ?{NUMBER}(?: (?:and|<=?) (?:[<>]=? )?{NUMBER}| / \w+)?"
)
REMARK = r"(?:, | with )[^.:]{1,32}"
BEGINNING = re.compile(rf"^({TYPES})((?:{COMPARED}|\w+, not 0)(?:{REMARK})?)[.:] ")


def beginning_of(text: str) -> tuple[str, str]:
    """Returns the range with which a description begins, or nothing, and the description without it."""
    begins = BEGINNING.match(text + " ")
    if not begins:
        return "", text
    rest = text[begins.end() :].strip()
    return begins[2], f"{begins[1]}{rest[:1].upper()}{rest[1:]}" if rest else text


def key_of(path: Sequence[str], name: str) -> str:
    """Returns the entry of the table for a parameter, or nothing."""
    folders = [part for part in path if part != "NAME"]
    keys = [f"{folders[-1]}/{name}"] if folders else []
    return next((key for key in (*keys, name) if key in RANGES), "")


def range_of_number(schema: dict[str, Any]) -> str:
    """Returns the range of a number that the schema bounds, or nothing."""
    low, high = schema.get("minimum"), schema.get("maximum")
    if low is None:
        return ""
    has_high = high is not None and abs(high) < 2e9
    kind = "whole numbers" if schema["type"] == "integer" else "numbers"
    return f"{kind} from {low:g} to {high:g}" if has_high else f"{kind} from {low:g}"


def values_in(text: str, choices: Sequence[str] = ()) -> tuple[str, list[tuple[str, str, str]]]:
    """Returns a description up to the meanings of values, and these: value, condition, meaning.

    Without choices, values are the words with which sentences of other parameters begin.
    """
    text = re.sub(r"(?:^|(?<=: ))\w[\w -]*(?:\|[\w -]+)+: ", "", text)  # "open|flat: ", the choices
    names = "|".join(map(re.escape, sorted(choices, key=len, reverse=True))) if choices else SPECIAL
    starts = list(re.finditer(rf"(?:^|(?<=[.:] ))({names})((?:, [^.:;]+?)?): ", text))
    if not choices and len(starts) < 2 and not any(start[1][0].islower() for start in starts):
        return text, []
    values = []
    for start, end in zip(starts, [*(start.start() for start in starts[1:]), len(text)]):
        values.append((start[1], start[2], text[start.end() : end].strip().rstrip(".") + "."))
    return text[: starts[0].start()].strip() if starts else text, values


# Values that have a meaning of their own beside numbers, vectors and names.
SPECIAL = (
    r"automatic|Empty|open|none|all|close within D|cylinder : x, y, z ; a, b, c|sphere : x, y, z|-?[\d./]+"
)
