# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: pvbatch shown_in_paraview.py SCRIPT PICTURE.png [TIME]

Runs the script of results and prints what it shows, a line for each: the time, the range of the colours by
name, the texts, and the box of what is visible.
"""

from __future__ import annotations

import runpy
import sys

from paraview import simple

sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
view = simple.GetActiveView()
print("time", view.ViewTime, sep="\t")
for name in ("von_mises_stress", "equivalent_plastic_strain"):
    points = simple.GetColorTransferFunction(name).RGBPoints
    print("colours", name, points[0], points[-4], sep="\t")
visible = [shown.Input for shown in view.Representations if hasattr(shown, "Input") and shown.Visibility]
for (name, _), source in sorted(simple.GetSources().items()):
    if source not in visible:
        continue
    if name.startswith("label "):
        print("text", source.Text, sep="\t")
    else:
        source.UpdatePipeline(view.ViewTime)
        print("part", name, *source.GetDataInformation().GetBounds(), sep="\t")
