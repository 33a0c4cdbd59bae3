# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: pvpython picture.py SCENE.pvd PICTURE.png [TIME...]

The last state of a quarter or an eighth of a body, mirrored to all of it but one quarter, so that its inside
is seen: equivalent plastic strain, element edges, the tools half transparent, and the body's outline at time
0. It is an eighth where scene.prm beside the scene has a symmetry plane z = 0. Scenes without symmetry planes
x = 0 and y = 0 are shown as they are, without tools, at the times given, side by side; scenes that are flat
along y are seen along it, one time below the other, whole where they have a symmetry plane x = 0. Scenes that
are flat along z are seen along it. What does not yield shows the von Mises stress.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, Sequence
from xml.etree import ElementTree

from paraview.simple import (
    AppendDatasets,
    CellDatatoPointData,
    CleantoGrid,
    Clip,
    ColorBy,
    CreateView,
    ExtractBlock,
    ExtractSurface,
    FeatureEdges,
    GetColorTransferFunction,
    GetScalarBar,
    MergeBlocks,
    Reflect,
    SaveScreenshot,
    Show,
    XMLMultiBlockDataReader,
)

Proxy = Any  # of ParaView's, which has no types
STRAIN = ("equivalent_plastic_strain", "Equivalent plastic strain")
STRESS = ("von_mises_stress", "Von Mises stress")
scene_file, picture_file = Path(sys.argv[1]), sys.argv[2]
planes = "".join(
    line
    for line in (scene_file.parent / "scene.prm").read_text().splitlines()
    if line.strip().startswith("set Symmetry planes")
)
is_quarter = "x = 0" in planes and "y = 0" in planes
is_eighth = any(
    line.strip().startswith("set Symmetry planes") and "z = 0" in line
    for line in (scene_file.parent / "scene.prm").read_text().splitlines()
)


def entries() -> list[ElementTree.Element]:
    """The snapshots, by time."""
    return list(ElementTree.parse(scene_file).iter("DataSet"))


def files() -> list[str]:
    return [str(scene_file.parent / entry.attrib["file"]) for entry in entries()]


def file_at(time: float) -> str:
    """Returns the file of the time nearest to this."""
    nearest = min(entries(), key=lambda entry: abs(float(entry.attrib["timestep"]) - time))
    return str(scene_file.parent / nearest.attrib["file"])


def blocks_at(file: str, group: str) -> Proxy:
    """Returns all blocks of a group as one grid."""
    part = ExtractBlock(Input=XMLMultiBlockDataReader(FileName=[file]))
    part.Selectors = ["/Root/" + group]
    return MergeBlocks(Input=part, MergePoints=0)


def smoothed(source: Proxy) -> Proxy:
    return CellDatatoPointData(Input=source)


def mirrored(source: Proxy, plane: str) -> Proxy:
    return Reflect(Input=source, Plane=plane, Center=0.0, CopyInput=1)


def image(source: Proxy, plane: str) -> Proxy:
    return Reflect(Input=source, Plane=plane, Center=0.0, CopyInput=0)


def merged(source: Proxy) -> Proxy:
    """Returns the grid with coincident nodes merged; images have nodes of their own."""
    return CleantoGrid(Input=source, ToleranceIsAbsolute=0, Tolerance=1e-6)


def all_around(quarter: Proxy) -> Proxy:
    return merged(mirrored(mirrored(quarter, "X"), "Y"))


def three_quarters(quarter: Proxy) -> Proxy:
    """Returns the body around the axis without the quarter x > 0, y < 0."""
    left = image(quarter, "X")
    return merged(AppendDatasets(Input=[quarter, left, image(left, "Y")]))


def box(source: Proxy) -> tuple[list[float], list[float]]:
    source.UpdatePipeline()
    bounds = source.GetDataInformation().GetBounds()
    return [0.5 * (bounds[2 * k] + bounds[2 * k + 1]) for k in range(3)], [
        bounds[2 * k + 1] - bounds[2 * k] for k in range(3)
    ]


def body_at(file: str) -> Proxy:
    body = blocks_at(file, "Bodies")
    return three_quarters(mirrored(body, "Z") if is_eighth else body)


def tool_at(file: str) -> Proxy:
    """The part of the tools that the modelled quarter sees."""
    tool = blocks_at(file, "Tools")
    for normal in ([1, 0, 0], [0, 1, 0]):
        tool = Clip(Input=tool, ClipType="Plane", Invert=0)
        tool.ClipType.Origin, tool.ClipType.Normal = [0, 0, 0], normal
    return tool


def show_plain(source: Proxy, colour: list[float], opacity: float, width: float = 1.0) -> Proxy:
    shown = Show(source, view)
    shown.ColorArrayName = [None, ""]
    shown.DiffuseColor = shown.AmbientColor = colour
    shown.Opacity = opacity
    shown.LineWidth = width
    return shown


def make_view(width: int) -> Proxy:
    view = CreateView("RenderView")
    view.ViewSize = [width, 720]
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    return view


def show_field(body: Proxy, view: Proxy, largest: float | None = None, with_bar: bool = True) -> Proxy:
    """The body with its elements; its field smoothed from them to the nodes."""
    name, title = FIELD
    shown = Show(body, view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = [0.12, 0.12, 0.12]
    shown.LineWidth = 1.3
    ColorBy(shown, ("POINTS", name))
    shown.Ambient, shown.Diffuse = 0.52, 0.56
    body.UpdatePipeline()
    colours = GetColorTransferFunction(name)
    colours.ApplyPreset("Viridis (matplotlib)", True)
    low, high = body.PointData[name].GetRange()
    colours.RescaleTransferFunction(low if largest is None else 0.0, largest or high)
    if with_bar:
        bar = GetScalarBar(colours, view)
        bar.Title, bar.ComponentTitle = title, ""
        bar.Orientation, bar.WindowLocation, bar.Position = "Horizontal", "Any Location", [0.03, 0.03]
        bar.ScalarBarLength, bar.ScalarBarThickness = 0.28, 16
        bar.TitleColor = bar.LabelColor = [0.1, 0.1, 0.1]
        bar.TitleFontSize, bar.LabelFontSize = 19, 17
        digits = "%.0f" if high > 10 else "%.1f" if high > 0.5 else "%.2f"
        bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, digits, digits
        shown.SetScalarBarVisibility(view, True)
    return shown


def draw_flat(bodies: Sequence[Proxy], largest: float) -> None:
    """Draws bodies seen along y, from top to bottom."""
    centres, sizes = zip(*[box(body) for body in bodies])
    width, gap = max(size[0] for size in sizes), 0.3 * sizes[0][2]
    height = sum(size[2] + gap for size in sizes) + 0.08 * width  # the bar below
    view = make_view(1200)
    view.ViewSize = [1200, int(1200 * height / (1.06 * width))]
    view.CameraParallelProjection, view.CameraParallelScale = 1, 0.5 * height
    top = 0.5 * height - 0.01 * width
    for i, (body, centre, size) in enumerate(zip(bodies, centres, sizes)):
        show_field(body, view, largest, i == 0).Position = [-centre[0], 0.0, top - 0.5 * size[2] - centre[2]]
        top -= size[2] + gap
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [0, 0, 0], [0, -10 * width, 0], [0, 0, 1]
    SaveScreenshot(picture_file, view, ImageResolution=view.ViewSize, CompressionLevel="9")


def draw_along_z(bodies: Sequence[Proxy], largest: float) -> None:
    """Draws bodies from left to right, above the bar of colours."""
    centre, size = box(bodies[0])
    width, height = 1.1 * size[0] * len(bodies), 1.25 * size[1]
    view = make_view(1200)
    view.ViewSize = [1200, max(360, int(1200 * height / width))]
    view.CameraParallelProjection = 1
    view.CameraParallelScale = 0.5 * max(height, width * view.ViewSize[1] / 1200)
    for i, body in enumerate(bodies):
        at = 1.1 * size[0] * (i - 0.5 * (len(bodies) - 1)) - centre[0]
        show_field(body, view, largest, i == 0).Position = [at, 0.08 * height - centre[1], 0.0]
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = [0, 0, 0], [0, 0, 10 * width], [0, 1, 0]
    SaveScreenshot(picture_file, view, ImageResolution=view.ViewSize, CompressionLevel="9")


def draw_as_it_is(bodies: Sequence[Proxy], largest: float) -> None:
    """Draws bodies from left to right, seen along y."""
    view = make_view(800 * len(bodies))
    centre, sizes = box(bodies[0])
    size = max(sizes)
    for i, body in enumerate(bodies):
        show_field(body, view, largest, i == 0).Position = [
            0.0,
            1.25 * size * (0.5 * (len(bodies) - 1) - i),
            0.0,
        ]
    view.CameraFocalPoint = centre
    view.CameraPosition = [c + size * d for c, d in zip(centre, (-3.0, -0.35, 0.75))]
    view.CameraViewUp = [0.0, 0.0, 1.0]
    view.CameraViewAngle = 27
    SaveScreenshot(picture_file, view, ImageResolution=view.ViewSize, CompressionLevel="9")


def largest_of(sources: Sequence[Proxy], name: str) -> float:
    """0 where there is no such field: elastic scenes have no plastic strain."""
    for source in sources:
        source.UpdatePipeline()
    return max(source.PointData[name].GetRange()[1] if source.PointData[name] else 0.0 for source in sources)


last = max(float(entry.attrib["timestep"]) for entry in entries())
shown_times = [float(time) for time in sys.argv[3:]] or [last]
plain = [smoothed(blocks_at(file_at(time), "Bodies")) for time in shown_times]
extent = box(plain[0])[1]
is_flat = extent[1] < 0.2 * min(extent[0], extent[2])
is_flat_along_z = extent[2] < 0.2 * min(extent[0], extent[1])
FIELD = STRAIN if largest_of(plain, STRAIN[0]) > 0.0 else STRESS
if is_flat:
    plain = [mirrored(body, "X") for body in plain] if "x = 0" in planes else plain
if is_flat_along_z:
    draw_along_z(plain, largest_of(plain, FIELD[0]))
    sys.exit()
if is_flat or not is_quarter:
    plain = [merged(body) for body in plain]
    (draw_flat if is_flat else draw_as_it_is)(plain, largest_of(plain, FIELD[0]))
    sys.exit()

view = make_view(1200)
show_field(CellDatatoPointData(Input=body_at(files()[-1]), CellDataArraytoprocess=[FIELD[0]]), view)

# The body at time 0.
start = ExtractSurface(Input=body_at(files()[0]))
show_plain(start, [0.5, 0.55, 0.6], 0.10)
show_plain(FeatureEdges(Input=start, FeatureAngle=50), [0.5, 0.54, 0.6], 1.0, 1.6)

start.UpdatePipeline()
bounds = start.GetDataInformation().GetBounds()
size = bounds[5] if is_eighth else 0.6 * bounds[1]

# The tools, a hair's breadth off the body, which their penalty lets in a little.
tool = tool_at(files()[-1])
plates = (
    ((three_quarters(tool), 1), (all_around(image(tool, "Z")), -1))
    if is_eighth
    else ((three_quarters(tool), 0),)
)
for plate, side in plates:
    border = FeatureEdges(Input=ExtractSurface(Input=plate), FeatureEdges=0, NonManifoldEdges=0)
    for source, opacity in ((plate, 0.18), (border, 1.0)):
        show_plain(source, [0.42, 0.48, 0.57], opacity, 1.6).Position = [0.0, 0.0, 0.007 * size * side]

view.CameraFocalPoint = [0.0, 0.0, -0.16 * size if is_eighth else -0.25 * size]
view.CameraPosition = [x * size for x in ((3.3, -4.15, 2.35) if is_eighth else (3.0, -3.8, 1.7))]
view.CameraViewUp = [0.0, 0.0, 1.0]
view.CameraViewAngle = 27
if not is_eighth and extent[2] > 0.8 * max(extent[:2]):  # taller than a drawn sheet
    view.ResetCamera(True)
SaveScreenshot(picture_file, view, ImageResolution=view.ViewSize, CompressionLevel="9")
