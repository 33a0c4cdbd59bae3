# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes of others: beams of divided tetrahedra, and the decks that CalculiX is tested with."""

from __future__ import annotations

import gzip
import json
import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import NamedTuple, Optional

import meshio
import numpy
from billet_runs import PROGRAM, ROOT, Run, arguments, publish, table

options = arguments("meshes")
DECKS = Path("/usr/share/doc/calculix-ccx-test/examples/test")
USERS = ROOT / "tests/mesh/users"
ELEMENTS = ("assumed strain", "mean dilatation")
RATIOS = ("0.3", "0.49")
GRIDS = (2, 4, 6)  # bricks through the thickness; the last one is the reference
LENGTHS = ("1", "0.7") if options.quick else ("1", "0.7", "0.5")

BEAM = """subsection Bodies
  subsection beam
    subsection Mesh
MESH
    end
    subsection Material
      set Young modulus = 1000
    end
    subsection Supports
      subsection clamp
        set Boundary ids = CLAMP
      end
    end
    subsection Loads
      subsection end
        set Type         = dead traction
        set Boundary ids = END
        set Traction     = 0 ; 0 ; -1e-3*t
      end
    end
  end
end
subsection Time stepping
  set Initial step = 1
  set Maximum step = 1
end
subsection Solver
  set Force tolerance = 1e-8
end
"""
DECK = """subsection Bodies
  subsection body
    subsection Mesh
      set Source = file
      set File   = NAME
    end
    subsection Material
      set Young modulus = 1
      set Density       = 1
    end
  end
end
subsection Time stepping
  set Scheme   = explicit
  set End time = 1e-9
end
"""
# Messages of the program on a deck, and the words of the page for them.
REASONS = (
    (r"elements of second order", "elements of second order"),
    (r"elements have the type", "plane, shell or fluid elements, or dashpots, which no mesh of bricks has"),
    (r"no hexahedra, nor", "no bricks"),
    (r"no hexahedra but", "quadrilaterals only"),
    (r"wedges beside", "wedges"),
    (r"its set ", "sets that name nodes which the deck does not have"),
    (r"element \d+ has 10 nodes", "bricks with ten nodes"),
    (r"of its nodes are doubled", "doubled nodes, which `Merge nodes within` joins"),
    (r"in none of these formats", "no deck"),
)


def energy(folder: Path, mesh: str, clamp: str, end: str, element: str, ratio: str) -> tuple[int, float]:
    """Returns the number of bricks of a beam, and its elastic energy."""
    scene = folder / "beam.prm"
    scene.write_text(BEAM.replace("MESH", mesh).replace("CLAMP", clamp).replace("END", end))
    changes = {"Bodies/beam/Element": element, "Bodies/beam/Material/Poisson ratio": ratio}
    run = Run({**changes, "Output/Verbosity": "steps"}, scene=scene, tool="beam.support clamp")
    found = re.search(r"^(\d+) elements", run.said, re.MULTILINE)
    if not found:
        sys.exit(f"meshes: no number of elements in '{run.said}'")
    return int(found[1]), float(run.rows[-1]["elastic_energy"])


def divided(folder: Path, length: str) -> Path:
    """Makes a mesh of tetrahedra that Gmsh divides."""
    file = folder / f"divided_{length}.msh"
    geometry = folder / "beam.geo"
    geometry.write_text(
        'SetFactory("OpenCASCADE"); Box(1) = {0, 0, 0, 10, 1, 1};\n'
        'Physical Surface("clamp", 1) = {1}; Physical Surface("end", 2) = {2};\n'
        'Physical Volume("beam", 1) = {1};\n'
        f"Mesh.CharacteristicLengthMax = {length}; Mesh.SubdivisionAlgorithm = 2;\n"
    )
    subprocess.run(["gmsh", "-3", "-format", "msh41", "-o", file, geometry], check=True, capture_output=True)
    return file


def beams(folder: Path) -> tuple[str, str]:
    """Returns the table of beams, and what it shows."""
    meshes = []
    for n in GRIDS:
        numbers = f"{10 * n}, {n}, {n} : 0, 0, 0 : 10, 1, 1"
        text = f"set Primitive = subdivided_hyper_rectangle\nset Arguments = {numbers}"
        name = f"grid, {n} through the thickness" if n == GRIDS[0] else f"grid, {n}"
        meshes.append((name, text, "0", "1"))
    for length in LENGTHS:
        text = f"set Source = file\nset File = {divided(folder, length)}"
        meshes.append((f"divided, length {length}", text, "clamp", "end"))
    cases = [(element, ratio) for ratio in RATIOS for element in ELEMENTS]
    found = {(mesh[0], *case): energy(folder, *mesh[1:], *case) for mesh in meshes for case in cases}
    best = meshes[len(GRIDS) - 1][0]

    def off(name: str, element: str, ratio: str) -> float:
        return found[name, element, ratio][1] / found[best, ELEMENTS[0], ratio][1] - 1

    rows = []
    for name, *_ in meshes:
        errors = [f"{100 * off(name, *case):.1f} %" for case in cases]
        if name == best:
            errors = ["reference" if case[0] == ELEMENTS[0] else said for case, said in zip(cases, errors)]
        rows.append([name, found[name, *cases[0]][0], *errors])
    coarse, fine = meshes[0][0], meshes[-1][0]
    ratios = sorted(off(fine, *case) / off(coarse, *case) for case in cases)
    n_times = found[fine, *cases[0]][0] / found[coarse, *cases[0]][0]
    head = ["mesh", "hexahedra", *(f"{element}, ν = {ratio}" for element, ratio in cases)]
    shown = (
        f"The finest divided mesh has {n_times:.0f} times as many elements as the coarse grid, and is"
        f" {ratios[0]:.1f} to {ratios[-1]:.1f} times as far off."
    )
    return table(head, rows), shown


class Mesh(NamedTuple):
    """Mesh that a program reads from a deck."""

    n_elements: int
    n_nodes: int
    volume: float


def read_by_meshio(deck: Path) -> Optional[Mesh]:
    """Returns what meshio reads from a deck, by volumes of bricks with straight edges; none if it cannot."""
    try:
        mesh = meshio.read(deck)
    except BaseException:  # meshio ends the program on some errors
        return None
    bricks = [block.data for block in mesh.cells if block.type == "hexahedron"]
    if not bricks:
        return None
    nodes = numpy.concatenate(bricks)
    points = 0.5 * (1 + numpy.array([[-1, 1]]) / numpy.sqrt(3))[0]
    corners = numpy.array(
        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    )
    volume = 0.0
    for at in numpy.array(numpy.meshgrid(points, points, points)).reshape(3, -1).T:
        factors = numpy.where(corners == 1, at, 1 - at)
        signs = numpy.where(corners == 1, 1, -1)
        slopes = numpy.stack(
            [signs[:, k] * numpy.prod(numpy.delete(factors, k, axis=1), axis=1) for k in range(3)], axis=1
        )
        volume += numpy.linalg.det(numpy.einsum("enx,nk->exk", mesh.points[nodes], slopes)).sum() / 8
    return Mesh(len(nodes), len(numpy.unique(nodes)), volume)


def decks(folder: Path) -> str:
    """Returns what the program reads of CalculiX's decks."""
    names = []
    for file in sorted(DECKS.glob("*.inp*")):
        name = file.name.split(".")[0]
        data = file.read_bytes()
        (folder / f"{name}.inp").write_bytes(gzip.decompress(data) if file.suffix == ".gz" else data)
        (folder / f"{name}.prm").write_text(DECK.replace("NAME", f"{name}.inp"))
        names.append(name)
    if not names:
        sys.exit(f"meshes: no decks in {DECKS}")
    scenes = [f"{name}.prm" for name in names]
    said = subprocess.run(
        [PROGRAM, "--check", "--json", *scenes], cwd=folder, capture_output=True, text=True, check=False
    )
    lines = said.stdout.splitlines()
    if len(lines) != len(names):
        sys.exit(f"meshes: {len(lines)} reports of {len(names)} decks: {said.stderr}")
    refused: Counter[str] = Counter()
    n_read = n_alike = n_by_meshio = 0
    for name, line in zip(names, lines):
        report = json.loads(line)
        if not report["valid"]:
            message = next(part["message"] for part in report["diagnostics"] if part["severity"] == "error")
            refused[next((words for pattern, words in REASONS if re.search(pattern, message)), message)] += 1
            continue
        n_read += 1
        body = report["report"]["bodies"][0]
        other = read_by_meshio(folder / f"{name}.inp")
        if other:
            n_by_meshio += 1
            near = abs(other.volume / body["volume"] - 1) < 1e-6
            n_alike += near and (other.n_elements, other.n_nodes) == (body["elements"], body["nodes"])
    version = subprocess.run(
        ["dpkg-query", "--show", "--showformat=${Version}", "calculix-ccx-test"],
        capture_output=True,
        text=True,
    ).stdout.split("-")[0]
    rows = [(n, words) for words, n in refused.most_common()]
    return (
        f"The Debian package calculix-ccx-test ({version}) has {len(names)} decks. Of these, {n_read} are"
        f" read, and {sum(refused.values())} are refused with the reason. Python's meshio"
        f" ({meshio.__version__}) reads {n_by_meshio} of the {n_read}, of which {n_alike} have the same"
        " elements, nodes and volume.\n\n" + table(["refused decks", "reason"], rows)
    )


def kept_meshes() -> str:
    """Returns how many meshes the tests have."""
    n_decks = len(list((USERS / "decks").glob("*.inp")))
    n_meshes = sum(1 for file in USERS.iterdir() if file.suffix not in ("", ".txt"))
    return (
        f"`tests/mesh/users` has {n_meshes} meshes of Gmsh, in all formats that it writes, and {n_decks}"
        " decks. They are read alike, or refused. `tests/mesh/make_users_meshes.py` makes them, and the"
        " expected results, with meshio."
    )


with tempfile.TemporaryDirectory() as temporary:
    beam_table, beam_words = beams(Path(temporary))
    deck_words = decks(Path(temporary))

publish(
    "meshes",
    "Meshes of others",
    options,
    "This page shows how well the program reads and uses meshes that other programs write.",
    "## Tetrahedra that Gmsh divides into hexahedra",
    (
        f"A divided mesh is too stiff in bending. {beam_words} If the part can be swept (in Gmsh: `Recombine"
        " Surface` and `Extrude ... Recombine`), sweep it. If not, use assumed strains, and expect a divided"
        " mesh to be a few percent too stiff in bending."
    ),
    (
        "A cantilever of 10 x 1 x 1 (Young's modulus 1000) is clamped at one end. A traction of 1e-3 acts"
        " across the other; deflections are small. The elastic energy is proportional to the deflection of"
        " the end, so that its error is that of the deflection."
    ),
    (
        "The reference is the finest grid with assumed strains, for each ν. Divided meshes have"
        " `Mesh.SubdivisionAlgorithm = 2` with `Mesh.CharacteristicLengthMax` as given. Hexahedra have about"
        " half of that as edges."
    ),
    beam_table,
    "## Decks of CalculiX",
    deck_words,
    kept_meshes(),
    "## Damaged files",
    (
        "[Damaged files](damaged-files.md) has what the readers make of meshes, CAD files and others with"
        " damage."
    ),
)
