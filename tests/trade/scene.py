# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes: reading, looking up, variants."""

from __future__ import annotations

import unittest
from pathlib import Path
from tempfile import TemporaryDirectory

from modules import ROOT
from billet_tools.scene import Scene, entries, read_scene, variant

TEXT = """set Title = a # remark
subsection Bodies
  subsection  the   body
    set Arguments = 1, 2 : \\
                    3
    set Height    = 1   # of the body
  end
end
subsection Output
  set Folder = here
end
subsection Bodies
  subsection the body
    set Height = 2
  end
end
"""


class TestScene(unittest.TestCase):
    def test_entries(self) -> None:
        self.assertEqual(
            entries(TEXT),
            {
                "Title": "a",
                "Bodies/the body/Arguments": "1, 2 : 3",
                "Bodies/the body/Height": "2",
                "Output/Folder": "here",
            },
        )

    def test_variant(self) -> None:
        new = variant(
            TEXT,
            {
                "Bodies/the body/Height": 7,
                "Bodies/the body/Arguments": "4",
                "Output/Folder": None,
                "Solver/Predictor": "tangent",
            },
        )
        self.assertEqual(
            entries(new),
            {
                "Title": "a",
                "Bodies/the body/Arguments": "4",
                "Bodies/the body/Height": "7",
                "Solver/Predictor": "tangent",
            },
        )
        self.assertNotIn("                    3", new)  # the line that went on goes, too
        self.assertEqual(new.count("set Height = 7"), 2)  # wherever it stands

    def test_variant_of_a_path(self) -> None:
        text = "set Time stepping/End time = 2\nsubsection Bodies\nset block/Element = one point\nend\n"
        new = variant(text, {"Time stepping/End time": 5, "Bodies/block/Element": "assumed strain"})
        self.assertEqual(new, text.replace("2", "5").replace("one point", "assumed strain"))

    def test_unchanged(self) -> None:
        self.assertEqual(variant(TEXT, {}), TEXT)
        for file in sorted((ROOT / "prm").glob("*.prm")):
            text = read_scene(file)
            self.assertEqual(
                entries(variant(text, {"Output/New": 1})), {**entries(text), "Output/New": "1"}, file
            )

    def test_includes_and_files(self) -> None:
        with TemporaryDirectory() as temporary:
            folder = Path(temporary)
            (folder / "sub").mkdir()
            (folder / "part.stl").write_text("solid")
            (folder / "sub/b.prm").write_text("set File = part.stl\n")
            (folder / "a.prm").write_text("subsection Tools\n  include sub/b.prm\nend\n")
            scene = Scene(read_scene(folder / "a.prm"))
            self.assertEqual(scene.files(folder), {"Tools/File": (folder / "part.stl").resolve()})

    def test_materials_of_the_program(self) -> None:
        with TemporaryDirectory() as temporary:
            folder = Path(temporary)
            (folder / "a.prm").write_text("include materials/steel.prm # at 293\n")
            self.assertEqual(read_scene(folder / "a.prm"), "include materials/steel.prm # at 293")
            (folder / "materials").mkdir()
            (folder / "materials/steel.prm").write_text("set Density = 7.8e-9\n")
            self.assertEqual(read_scene(folder / "a.prm"), "set Density = 7.8e-9")

    def test_defaults(self) -> None:
        scene = Scene(
            "subsection Bodies\n subsection x\n  set A = 1\n end\nend\n",
            "subsection Bodies\n subsection (name of a body)\n  set A = 5\n  set B = 6\n end\nend\n",
        )
        self.assertEqual([scene.get(f"Bodies/x/{name}") for name in "ABC"], ["1", "6", ""])
        self.assertEqual([scene.knows(f"Bodies/x/{name}") for name in "ABC"], [True, True, False])
        self.assertEqual(scene.names("Bodies"), ["x"])


unittest.main()
