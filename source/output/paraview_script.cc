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

import math
import os
import sys

from paraview import simple

)py";

const std::string body = R"py(
TOOL, EDGE = [0.42, 0.48, 0.57], [0.12, 0.12, 0.12]
TOOL_AT_END, SUPPORT, LOAD = [0.80, 0.55, 0.30], [0.10, 0.45, 0.20], [0.75, 0.10, 0.10]

SIZE = [1200, 800]
# From where to look at a model, and which way is up, by its section.
VIEWS = {
    "solid": ([3.0, -4.0, 2.2], [0.0, 0.0, 1.0]),
    "plane strain": ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
    "axisymmetric": ([0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
}


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


def box_of(part):
    """Returns the lowest and the highest coordinates of a part."""
    bounds = part.GetDataInformation().GetBounds()
    return bounds[0::2], bounds[1::2]


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


def show_tools(part, view, box, colour, opacity):
    """In a section, tools are lines: their surfaces are seen from the side."""
    if SECTION == "solid":
        show_plain(part, view, colour, opacity)
        return
    cut = simple.Slice(registrationName=SECTION + " of tools", Input=part)
    cut.SliceType = "Plane"
    cut.SliceType.Normal = VIEWS[SECTION][0]
    cut.SliceType.Origin = [0.5 * (a + b) for a, b in zip(*box)]
    shown = simple.Show(cut, view)
    shown.ColorArrayName = [None, ""]
    shown.DiffuseColor = shown.AmbientColor = colour
    shown.LineWidth = 3.0
    simple.Hide(part, view)


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


def show_preview(results, view, box):
    """Shows supports in green, loads in red, tools at the end of their motion in orange."""
    tools = extract(results, "Tools at end")
    if tools:
        show_tools(tools, view, box, TOOL_AT_END, 0.2)
    for group, colour in (("Supports", SUPPORT), ("Loads", LOAD)):
        part = extract(results, group)
        if part:
            show_plain(part, view, colour, 1.0)


def show_hidden(part, view, name):
    """Prepares colours for whoever switches a part on."""
    shown = simple.Show(part, view)
    if has_array(part.PointData, name):
        simple.ColorBy(shown, ("POINTS", name))
    elif has_array(part.CellData, name):
        simple.ColorBy(shown, ("CELLS", name))
    shown.SetScalarBarVisibility(view, False)
    simple.Hide(part, view)


def frame(view, box, tools):
    """Shows the bodies in this box, and of the tools, which may be infinite, what is near them."""
    low, high = box
    if tools:
        margin = 0.15 * math.dist(low, high)
        tools_low, tools_high = box_of(tools)
        low, high = (
            [min(a, max(b, a - margin)) for a, b in zip(low, tools_low)],
            [max(a, min(b, a + margin)) for a, b in zip(high, tools_high)],
        )
    centre = [0.5 * (a + b) for a, b in zip(low, high)]
    width, depth, height = (b - a for a, b in zip(low, high))
    direction, view.CameraViewUp = VIEWS[SECTION]
    if SECTION == "plane strain":
        depth, height = height, depth
    radius = 0.5 * math.hypot(width, depth, height)
    distance = radius / math.sin(math.radians(0.5 * view.CameraViewAngle)) / math.hypot(*direction)
    view.CameraFocalPoint = centre
    view.CameraPosition = [a + distance * b for a, b in zip(centre, direction)]
    view.CameraParallelProjection = 0 if SECTION == "solid" else 1
    view.CameraParallelScale = 0.55 * max(height, width * SIZE[1] / SIZE[0])


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
    box = box_of(bodies or outsides)
    if tools:
        show_tools(tools, view, box, TOOL, 0.3)
    if PREVIEW:
        show_preview(results, view, box)
    elif bodies:
        show_bodies(bodies, view)
        simple.SetActiveSource(bodies)
    simple.Render(view)  # the first time it chooses a camera of its own
    frame(view, box, tools)
    simple.Render(view)
    if len(sys.argv) > 1 and sys.argv[1].endswith(".png"):
        view.ViewSize = SIZE
        simple.SaveScreenshot(sys.argv[1], view, ImageResolution=SIZE)


main()
)py";

std::string name_of(const WholeSection::Kind section) {
  switch (section) {
  case WholeSection::Kind::model:
    return "solid";
  case WholeSection::Kind::per_width:
    return "plane strain";
  case WholeSection::Kind::full_circle:
    break;
  }
  return "axisymmetric";
}

} // namespace

std::string paraview_script(const std::string &index, const WholeSection::Kind section,
                            const bool is_preview) {
  return head + "INDEX = \"" + index + "\"\nSECTION = \"" + name_of(section) +
         "\"\nPREVIEW = " + (is_preview ? "True" : "False") + body;
}

} // namespace billet
