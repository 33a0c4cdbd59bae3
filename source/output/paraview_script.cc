// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/paraview_script.h"

namespace billet {

namespace {

const std::string head =
    R"py("""Opens the results beside this file in ParaView: bodies in colour, tools translucent.

In ParaView:      paraview --script=show_in_paraview.py
                  or Tools > Python Shell > Run Script; Macros > Import new macro keeps it as a button
Without display:  pvbatch show_in_paraview.py PICTURE.png

Contact surfaces and the bodies' outsides with their boundary ids are loaded, too, but hidden: the eye in the
Pipeline Browser shows them.
"""

import os
import sys

from paraview import simple

)py";

const std::string body = R"py(
TOOL, EDGE = [0.42, 0.48, 0.57], [0.12, 0.12, 0.12]
TOOL_AT_END, SUPPORT, LOAD = [0.80, 0.55, 0.30], [0.10, 0.45, 0.20], [0.75, 0.10, 0.10]


def folder():
    """Returns the folder of this file, in which the results are."""
    for name in (globals().get("__file__"), *sys.argv[:1]):
        if name and os.path.exists(os.path.join(os.path.dirname(os.path.abspath(name)), INDEX)):
            return os.path.dirname(os.path.abspath(name))
    if os.path.exists(INDEX):
        return os.getcwd()
    raise SystemExit("Run this script in the folder of the results, or from its own place there")


def open_results():
    file = os.path.join(folder(), INDEX)
    if INDEX.endswith(".pvd"):
        return simple.PVDReader(registrationName="scene", FileName=file)
    # ParaView has several readers of XDMF. This one keeps the names of blocks.
    return simple.XDMFReader(registrationName="scene", FileNames=[file])


def has_array(arrays, name):
    return any(arrays.GetArray(i).Name == name for i in range(arrays.GetNumberOfArrays()))


def is_zero(arrays, name):
    return not has_array(arrays, name) or arrays[name].GetRange()[1] <= 0.0


def choose_field(part):
    """Returns where the field of the bodies' colours is, its name, and a title; nothing without fields."""
    if not is_zero(part.CellData, "equivalent_plastic_strain"):
        return "CELLS", "equivalent_plastic_strain", "Equivalent plastic strain"
    if has_array(part.CellData, "von_mises_stress"):
        return "CELLS", "von_mises_stress", "Von Mises stress"
    return "POINTS", "displacement", "Displacement"


def extract(results, group):
    """Returns a group of blocks as a part of its own; nothing if the scene has none."""
    part = simple.ExtractBlock(registrationName=group, Input=results)
    part.Selectors = ["/Root/" + group.replace(" ", "")]
    part.UpdatePipeline(simple.GetAnimationScene().AnimationTime)
    if part.GetDataInformation().GetNumberOfPoints() > 0:
        return part
    simple.Delete(part)
    return None


def show_bodies(part, view):
    shown = simple.Show(part, view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = EDGE
    where, name, title = choose_field(part)
    simple.ColorBy(shown, (where, name))
    shown.RescaleTransferFunctionToDataRange(False, True)
    colours = simple.GetColorTransferFunction(name)
    colours.ApplyPreset("Viridis (matplotlib)", True)
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = EDGE
    shown.SetScalarBarVisibility(view, True)


def show_plain(part, view, colour, opacity):
    shown = simple.Show(part, view)
    shown.Representation = "Surface"
    shown.ColorArrayName = [None, ""]
    shown.DiffuseColor = shown.AmbientColor = colour
    shown.Opacity = opacity


def show_boundaries(part, view):
    shown = simple.Show(part, view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = EDGE
    simple.ColorBy(shown, ("CELLS", "boundary_id"))
    shown.RescaleTransferFunctionToDataRange(False, True)
    bar = simple.GetScalarBar(simple.GetColorTransferFunction("boundary_id"), view)
    bar.Title, bar.ComponentTitle = "Boundary id", ""
    bar.TitleColor = bar.LabelColor = EDGE
    shown.SetScalarBarVisibility(view, True)


def show_preview(results, view):
    """Shows supports in green, loads in red, tools at the end of their motion in orange."""
    for group, colour, opacity in (
        ("Tools at end", TOOL_AT_END, 0.2),
        ("Supports", SUPPORT, 1.0),
        ("Loads", LOAD, 1.0),
    ):
        part = extract(results, group)
        if part:
            show_plain(part, view, colour, opacity)


def show_hidden(part, view, name):
    """Prepares colours for whoever switches a part on."""
    shown = simple.Show(part, view)
    if has_array(part.PointData, name):
        simple.ColorBy(shown, ("POINTS", name))
    elif has_array(part.CellData, name):
        simple.ColorBy(shown, ("CELLS", name))
    shown.SetScalarBarVisibility(view, False)
    simple.Hide(part, view)


def main():
    view = simple.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesLabelColor = EDGE
    results = open_results()
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    simple.GetAnimationScene().AnimationTime = max(results.TimestepValues)
    view.ViewTime = simple.GetAnimationScene().AnimationTime
    simple.Hide(results, view)
    bodies, tools = extract(results, "Bodies"), extract(results, "Tools")
    surfaces, outsides = extract(results, "Contact surfaces"), extract(results, "Boundaries")
    if surfaces:
        show_hidden(surfaces, view, "contact_pressure")
    if outsides and PREVIEW:
        show_boundaries(outsides, view)
    elif outsides:
        show_hidden(outsides, view, "boundary_id")
    if tools:
        show_plain(tools, view, TOOL, 0.3)
    if PREVIEW:
        show_preview(results, view)
    elif bodies:
        show_bodies(bodies, view)
        simple.SetActiveSource(bodies)
    view.CameraPosition, view.CameraFocalPoint = [3.0, -4.0, 2.2], [0.0, 0.0, 0.0]
    view.CameraViewUp = [0.0, 0.0, 1.0]
    simple.ResetCamera(view)
    simple.Render(view)
    if len(sys.argv) > 1 and sys.argv[1].endswith(".png"):
        view.ViewSize = [1200, 800]
        simple.SaveScreenshot(sys.argv[1], view, ImageResolution=[1200, 800])


main()
)py";

} // namespace

std::string paraview_script(const std::string &index, const bool is_preview) {
  return head + "INDEX = \"" + index + "\"\nPREVIEW = " + (is_preview ? "True" : "False") + body;
}

} // namespace billet
