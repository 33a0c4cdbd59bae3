#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the meshes of users/ with Gmsh, and what must be read from them (users/expected.txt) with meshio.

Needs the Debian packages gmsh and python3-meshio. The test users_meshes needs neither: it reads what is kept.
Decks of CalculiX are written by hand in users/decks; only what must be read from them is made here.
"""

from __future__ import annotations

import pathlib
import re
import subprocess
import sys
import tempfile
from collections import Counter
from typing import Dict, Tuple

import meshio
import numpy

FOLDER = pathlib.Path(__file__).parent / "users"
FACES = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
Expected = Tuple[int, int, float, Dict[str, float]]

LINES = "Transfinite Line {1, 3, -2, -4} = 3; Transfinite Surface {1}; Recombine Surface {1};\n"
SQUARE = (
    'SetFactory("Built-in");\n'
    "Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {0, 1, 0};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
    "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
)
BLOCK = SQUARE + LINES + "out[] = Extrude {0, 0, 3} { Surface{1}; Layers{2}; Recombine; };\n"
NAMES = (
    'Physical Surface("bottom", 11) = {1}; Physical Surface("top face", 12) = {out[0]};\n'
    'Physical Surface("sides", 4) = {out[2], out[3], out[4], out[5]};\n'
    'Physical Surface("bottom and top", 13) = {1, out[0]};\n'
    'Physical Volume("block", 1) = {out[1]};\n'
)
# A quarter of a tube, swept about an axis.
TUBE = (
    'SetFactory("Built-in");\n'
    "Point(1) = {1, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {1, 1, 0};\n"
    "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};\n"
    "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
    + LINES
    + "out[] = Extrude {{0, 1, 0}, {0, 0, 0}, Pi/2} { Surface{1}; Layers{4}; Recombine; };\n"
    'Physical Surface("start", 1) = {1}; Physical Surface("end", 2) = {out[0]};\n'
    'Physical Surface("inside", 3) = {out[5]}; Physical Volume("tube", 7) = {out[1]};\n'
)
# A plate with a hole, by free quadrilaterals, drawn out.
PLATE = (
    'SetFactory("OpenCASCADE");\nRectangle(1) = {0, 0, 0, 4, 3}; Disk(2) = {2, 1.5, 0, 0.7};\n'
    "BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };\n"
    "Mesh.CharacteristicLengthMin = 1; Mesh.CharacteristicLengthMax = 1;\n"
    "Mesh.RecombinationAlgorithm = 1; Recombine Surface {3};\n"
    "out[] = Extrude {0, 0, 1} { Surface{3}; Layers{2}; Recombine; };\n"
    'Physical Surface("underside", 20) = {3}; Physical Surface("upper side", 21) = {out[0]};\n'
    'Physical Volume("plate", 1) = {out[1]};\n'
)
# Tetrahedra, each divided into four hexahedra.
DIVIDED = (
    'SetFactory("OpenCASCADE");\nSphere(1) = {0, 0, 0, 1};\n'
    "Mesh.CharacteristicLengthMin = 1.5; Mesh.CharacteristicLengthMax = 1.5; Mesh.SubdivisionAlgorithm = 2;\n"
    'Physical Surface("skin", 5) = {1}; Physical Volume("ball", 6) = {1};\n'
)
# Two volumes on each other that share a named surface; it is inside.
STACK = BLOCK + (
    "up[] = Extrude {0, 0, 1} { Surface{out[0]}; Layers{1}; Recombine; };\n"
    'Physical Surface("between", 30) = {out[0]}; Physical Surface("lid", 31) = {up[0]};\n'
    'Physical Volume("lower", 1) = {out[1]}; Physical Volume("upper", 2) = {up[1]};\n'
)
BOXES = (
    'SetFactory("OpenCASCADE");\nBox(1) = {{0, 0, 0, 2, 1, 1}}; Box(2) = {{0, 0, {height}, 2, 1, 1}};\n'
    "Transfinite Curve {{:}} = 3; Transfinite Surface {{:}};\n"
    "Recombine Surface {{:}}; Transfinite Volume {{:}};\n"
)
# Two blocks that share no node, and two that should share some.
APART = BOXES.format(height=5) + (
    'Physical Surface("feet", 1) = {5, 11}; Physical Volume("all", 1) = {1, 2};\n'
)
DOUBLED = BOXES.format(height=1)
# Two-dimensional: a plate with a notch, by free quadrilaterals, with named edges, and one with triangles.
SECTION = (
    'SetFactory("OpenCASCADE");\nRectangle(1) = {0, 0, 0, 4, 3}; Disk(2) = {4, 3, 0, 1};\n'
    "BooleanDifference(3) = { Surface{1}; Delete; }{ Surface{2}; Delete; };\n"
    "Mesh.CharacteristicLengthMin = 1; Mesh.CharacteristicLengthMax = 1; Mesh.RecombinationAlgorithm = 1;\n"
    'Physical Curve("axis", 11) = Curve In BoundingBox {-0.1, -0.1, -0.1, 0.1, 3.1, 0.1};\n'
    'Physical Curve("notch", 12) = Curve In BoundingBox {2.9, 1.9, -0.1, 4.1, 3.1, 0.1};\n'
    'Physical Surface("section", 1) = {3};\n'
)
QUADRILATERALS = SECTION + "Recombine Surface {3};\n"
MIXED = BLOCK + ("up[] = Extrude {0, 0, 1} { Surface{out[0]}; };\nPhysical Volume(1) = {out[1], up[1]};\n")

ALL: dict[str, tuple[str, str, list[str]]] = {
    "msh1": ("msh1", "msh", []),
    "msh22": ("msh22", "msh", []),
    "msh22_binary": ("msh22", "msh", ["-bin"]),
    "msh40": ("msh40", "msh", []),
    "msh41": ("msh41", "msh", []),
    "msh41_binary": ("msh41", "msh", ["-bin"]),
    "vtk": ("vtk", "vtk", []),
    "vtk_binary": ("vtk", "vtk", ["-bin"]),
    "inp": ("inp", "inp", []),
}
#: name of the geometry: geometry and formats
READ: dict[str, tuple[str, list[str], list[str]]] = {
    "block": (BLOCK + NAMES, list(ALL), []),
    "unnamed": (BLOCK, list(ALL), []),
    "tube": (TUBE, ["msh22", "msh22_binary", "msh41", "msh41_binary", "vtk", "inp"], []),
    "plate": (PLATE, ["msh1", "msh22", "msh40", "msh41", "msh41_binary", "inp"], []),
    "ball": (DIVIDED, ["msh22_binary", "msh40", "msh41_binary", "vtk_binary", "inp"], []),
    "stack": (STACK, ["msh22", "msh40", "msh41", "vtk", "inp"], []),
    "apart": (APART, ["msh41"], []),
    # what Gmsh adds on request
    "all_saved": (BLOCK + NAMES, ["msh22", "msh41", "inp"], ["-save_all"]),
    "parametric": (BLOCK + NAMES, ["msh40", "msh41_binary"], ["-save_parametric"]),
    "parted": (BLOCK + NAMES, ["msh22"], ["-part", "2"]),
    "node_groups": (BLOCK + NAMES, ["inp"], ["-setnumber", "Mesh.SaveGroupsOfNodes", "1"]),
    "scaled": (BLOCK + NAMES, ["msh41"], ["-setnumber", "Mesh.ScalingFactor", "1e-3"]),
}
#: name: geometry, format, further arguments, part of the message
REFUSED: dict[str, tuple[str, str, list[str], str]] = {
    "tetrahedra": (SQUARE + "Extrude {0, 0, 3} { Surface{1}; }\n", "msh41", [], "SubdivisionAlgorithm = 2"),
    "wedges": (SQUARE + "Extrude {0, 0, 3} { Surface{1}; Layers{2}; Recombine; }\n", "msh22", [], "wedges"),
    "mixed": (MIXED, "msh41", [], "tetrahedra"),
    "second_order": (BLOCK, "msh41", ["-order", "2"], "second order"),
    "surface_only": (SQUARE + LINES, "msh41", [], "it has no hexahedra but"),
    "doubled": (DOUBLED, "msh41", [], "same place"),
    "parted_msh41": (BLOCK, "msh41", ["-part", "2"], "UnpartitionMesh"),
    "parted_binary": (BLOCK, "msh41", ["-part", "2", "-bin"], "UnpartitionMesh"),
    "unv": (BLOCK, "unv", [], "in none of these formats"),
    "nastran": (BLOCK, "bdf", [], "in none of these formats"),
    "medit": (BLOCK, "mesh", [], "in none of these formats"),
    "su2": (BLOCK, "su2", [], "in none of these formats"),
    "lsdyna": (BLOCK, "key", [], "in none of these formats"),
}

#: two-dimensional meshes
SECTIONS = ["msh1", "msh22", "msh22_binary", "msh40", "msh41", "msh41_binary", "vtk", "inp"]
SECTIONS_REFUSED: dict[str, tuple[str, str]] = {
    "triangles": (SECTION, "triangles; Gmsh joins them"),
    "solid": (BLOCK, "it has 8 hexahedra; allowed are quadrilaterals in a plane"),
    "tilted": (
        SECTION + "Rotate {{1, 0, 0}, {0, 0, 0}, 0.1} { Surface{3}; }\nRecombine Surface {3};\n",
        "reach from z = ",
    ),
}

#: decks: a beam of 4 x 1.5 x 2 of three elements, with areas by names, or part of the message
DECKS: dict[str, dict[str, float] | str] = {
    "plain": {"LEFT": 3, "RIGHT": 3, "NALL": 34},
    "generated": {"left": 3, "right": 3},
    "sides": {"LEFT": 3, "RIGHT": 3, "TOP": 6},
    "node_surface": {"LEFT": 3, "RIGHT": 3, "ENDS": 3},
    "included": {"LEFT": 3, "NALL": 34},
    "continued": {"the left": 3},
    "sets_of_sets": {"LEFT": 3, "TOPS OF ENDS": 4},
    "sparse": {"LEFT": 3},
    "with_shells": {"SKIN": 6},
    "cae": {"Left": 3, "Top": 6},
    "quadratic": "second order",
    "missing_node": "names node 99, which is missing",
}


def gmsh(geometry: str, kind: str, arguments: list[str], output: pathlib.Path) -> None:
    """Meshes a geometry."""
    with tempfile.TemporaryDirectory() as folder:
        geo = pathlib.Path(folder) / "part.geo"
        geo.write_text(geometry)
        dimension = "-3" if any(word in geometry for word in ("Extrude", "Sphere", "Box")) else "-2"
        command = [
            "gmsh",
            dimension,
            "-nt",
            "1",
            "-v",
            "2",
            *arguments,
            "-format",
            kind,
            "-o",
            str(output),
            str(geo),
        ]
        subprocess.run(command, check=True)
        if kind in ("inp", "key"):  # their heads name the file with its folder
            output.write_text(output.read_text().replace(str(output), output.name))


def cross_volume(points: numpy.ndarray, cells: numpy.ndarray) -> float:
    """Volume of trilinear hexahedra: two Gauss points along each axis are exact."""
    signs = numpy.array([[i, j, k] for k in (-1, 1) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    volume = 0.0
    for gauss in signs / 3**0.5:
        along = 1 + signs * gauss
        gradient = numpy.stack(
            [signs[:, a] * along[:, (a + 1) % 3] * along[:, (a + 2) % 3] / 8 for a in range(3)], axis=1
        )
        volume += numpy.linalg.det(numpy.einsum("cni,nj->cij", points[cells], gradient)).sum()
    return abs(volume)


def area(points: numpy.ndarray, faces: numpy.ndarray, exterior: set[tuple[int, ...]]) -> float:
    """Sum of the areas that the diagonals span, of exterior faces, each once."""
    chosen = {tuple(sorted(face)): face for face in faces.tolist() if tuple(sorted(face)) in exterior}
    if not chosen:
        return 0.0
    x = points[numpy.array(list(chosen.values()))]
    return float(0.5 * numpy.linalg.norm(numpy.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), axis=1).sum())


def exterior_faces(cells: numpy.ndarray) -> set[tuple[int, ...]]:
    count: Counter[tuple[int, ...]] = Counter()
    for cell in cells.tolist():
        count.update(tuple(sorted(cell[i] for i in face)) for face in FACES)
    return {face for face, n in count.items() if n == 1}


def hexahedra(mesh: meshio.Mesh) -> numpy.ndarray:
    blocks = [block.data for block in mesh.cells if block.type == "hexahedron"]
    # Formats before 4 repeat what is in several groups.
    cells = numpy.concatenate(blocks)
    return cells[sorted(numpy.unique(numpy.sort(cells, axis=1), axis=0, return_index=True)[1])]


def oracle(file: pathlib.Path) -> Expected:
    """Returns the areas that meshio reads, by names and by numbers of physical groups, or of sets of
    elements."""
    mesh = meshio.read(file)
    cells = hexahedra(mesh)
    exterior = exterior_faces(cells)
    faces: dict[str, list[numpy.ndarray]] = {}
    names = {int(v[0]): name for name, v in mesh.field_data.items() if v[1] == 2}
    physical = mesh.cell_data.get("gmsh:physical", [])
    for block, numbers in zip(mesh.cells, physical):
        if block.type == "quad":
            for number in set(numbers.tolist()):
                chosen = block.data[numbers == number]
                for name in [str(number)] + ([names[number]] if number in names else []):
                    faces.setdefault(name, []).append(chosen)
    areas = {name: area(mesh.points, numpy.concatenate(parts), exterior) for name, parts in faces.items()}
    n_nodes = len(numpy.unique(cells))
    return (
        len(cells),
        n_nodes,
        cross_volume(mesh.points, cells),
        {n: a for n, a in areas.items() if a > 0 and n != "0"},
    )


def line(name: str, expected: Expected) -> str:
    n_cells, n_nodes, volume, areas = expected
    text = f"{name} {n_cells} {n_nodes} {volume:.12g}"
    return text + "".join(f"\n  {areas[group]:.12g} {group}" for group in sorted(areas)) + "\n"


#: arguments that add to a file, and do not change the mesh
BESIDE = ["-part", "2", "-save_parametric", "-save_all"]


def expected_of(form: str, base: Expected) -> Expected:
    """Returns the groups that a format keeps."""
    n_cells, n_nodes, volume, areas = base
    if form.startswith("vtk"):
        areas = {}
    elif form == "msh1":
        areas = {name: a for name, a in areas.items() if name.isdigit()}
    elif form == "inp":
        areas = {name.replace(" ", "_"): a for name, a in areas.items() if not name.isdigit()}
    return n_cells, n_nodes, volume, areas


def compare(name: str, file: pathlib.Path, expected: Expected) -> None:
    """Holds what is expected against meshio's reading of the file itself, where it can read it."""
    try:
        mesh = meshio.read(file)
    except (Exception, SystemExit) as error:
        print(f"{name}: meshio does not read it ({error})")
        return
    cells = hexahedra(mesh)
    volume = cross_volume(mesh.points, cells)
    if len(cells) != expected[0] or abs(volume / expected[2] - 1) > 1e-6:
        sys.exit(f"{name}: meshio reads {len(cells)} elements, {volume}, not {expected[:3]}")


def make_read(texts: list[str]) -> None:
    for geometry_name, (geometry, forms, arguments) in READ.items():
        with tempfile.TemporaryDirectory() as folder:
            twin = pathlib.Path(folder) / "twin.msh"
            # Additional data does not matter to meshio's reading, or it cannot read it.
            gmsh(geometry, "msh22", [a for a in arguments if a not in BESIDE], twin)
            base = oracle(twin)
        for form in forms:
            kind, suffix, binary = ALL[form]
            name = f"{geometry_name}_{form}.{suffix}"
            gmsh(geometry, kind, binary + arguments, FOLDER / name)
            # Formats before 4 have no groups of Gmsh's then.
            loses = "-save_all" in arguments and form.startswith("msh2")
            texts.append(line(name, expected_of("vtk" if loses else form, base)))
            compare(name, FOLDER / name, base)


def make_refused(texts: list[str]) -> None:
    for name, (geometry, kind, arguments, message) in REFUSED.items():
        suffix = "msh" if kind.startswith("msh") else kind
        gmsh(geometry, kind, arguments, FOLDER / f"{name}.{suffix}")
        texts.append(f"{name}.{suffix} refused {message}\n")
    # One is wrong: an element whose top and bottom are exchanged.
    text = (FOLDER / "block_msh22.msh").read_text()
    wrong = re.sub(
        r"^(\d+ 5 2 \d+ \d+) (\d+ \d+ \d+ \d+) (\d+ \d+ \d+ \d+)$", r"\1 \3 \2", text, count=1, flags=re.M
    )
    assert wrong != text
    (FOLDER / "wrong.msh").write_text(wrong)
    texts.append("wrong.msh refused inverted\n")


def section_oracle(file: pathlib.Path) -> Expected:
    """Returns the area of a two-dimensional mesh by meshio, and lengths by names and numbers of groups."""
    mesh = meshio.read(file)
    cells = numpy.concatenate([block.data for block in mesh.cells if block.type == "quad"])
    x = mesh.points[cells]
    total = 0.5 * numpy.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])[:, 2].sum()
    names = {int(v[0]): name for name, v in mesh.field_data.items() if v[1] == 1}
    lengths: dict[str, float] = {}
    for block, numbers in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        if block.type == "line":
            for (a, b), number in zip(block.data, numbers):
                for name in (str(number), names[int(number)]):
                    length = float(numpy.linalg.norm(mesh.points[b] - mesh.points[a]))
                    lengths[name] = lengths.get(name, 0.0) + length
    return len(cells), len(numpy.unique(cells)), abs(float(total)), lengths


def make_sections(texts: list[str]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        twin = pathlib.Path(folder) / "twin.msh"
        gmsh(QUADRILATERALS, "msh22", [], twin)
        base = section_oracle(twin)
    for form in SECTIONS:
        kind, suffix, binary = ALL[form]
        name = f"section_{form}.{suffix}"
        gmsh(QUADRILATERALS, kind, binary, FOLDER / name)
        texts.append(line(name, expected_of(form, base)))
    for name, (geometry, message) in SECTIONS_REFUSED.items():
        gmsh(geometry, "msh41", [], FOLDER / f"section_{name}.msh")
        texts.append(f"section_{name}.msh refused {message}\n")


def add_decks(texts: list[str]) -> None:
    for name, wanted in DECKS.items():
        if isinstance(wanted, str):
            texts.append(f"decks/{name}.inp refused {wanted}\n")
        else:
            expected = 3, 16, 12.0, wanted
            texts.append(line(f"decks/{name}.inp", expected))
            compare(name, FOLDER / "decks" / f"{name}.inp", expected)


def main() -> None:
    for old in FOLDER.glob("*.*"):
        old.unlink()
    texts: list[str] = []
    make_read(texts)
    make_refused(texts)
    make_sections(texts)
    add_decks(texts)
    (FOLDER / "expected.txt").write_text("".join(texts))
    print(f"{len(texts)} meshes")


if __name__ == "__main__":
    main()
