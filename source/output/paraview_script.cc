// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/paraview_script.h"

#include <map>

namespace billet {

namespace {

const std::string head =
    R"py("""Opens the results beside this file in ParaView: bodies in colour, tools translucent.

In ParaView:      paraview --script=show_in_paraview.py
                  or Tools > Python Shell > Run Script; Macros > Import new macro keeps it as a button
Without display:  pvbatch show_in_paraview.py PICTURE.png [TIME]

The colours begin at zero. Of the visible surface, 2 % are above the last one at the time of the largest values.
Contact surfaces and the bodies' outsides with their boundary ids are loaded, too, but hidden: the eye in the
Pipeline Browser shows them.
"""

import math
import os
import sys
import time

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

)py";

const std::string body = R"py(
# Time to show, or None: that at which the visible surface is loaded most; the last one where it yields.
TIME = None

TOOL, EDGE = [0.42, 0.48, 0.57], [0.12, 0.12, 0.12]
TOOL_AT_END, SUPPORT = [0.80, 0.55, 0.30], [0.10, 0.45, 0.20]
LOADS = [[0.75, 0.10, 0.10], [0.55, 0.15, 0.65], [0.85, 0.40, 0.00], [0.10, 0.30, 0.75], [0.45, 0.30, 0.15]]
FACES = [
    [0.65, 0.81, 0.89],
    [0.99, 0.80, 0.55],
    [0.74, 0.88, 0.63],
    [0.98, 0.71, 0.71],
    [0.80, 0.75, 0.88],
    [0.98, 0.95, 0.65],
    [0.70, 0.88, 0.85],
    [0.88, 0.78, 0.70],
    [0.93, 0.78, 0.90],
    [0.80, 0.80, 0.80],
]

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


def times_of(results):
    times = results.TimestepValues
    return list(times) if hasattr(times, "__len__") else [times]


def has_array(arrays, name):
    return any(arrays.GetArray(i).Name == name for i in range(arrays.GetNumberOfArrays()))


def is_zero(arrays, name):
    return not has_array(arrays, name) or arrays[name].GetRange()[1] <= 0.0


def choose_field(part):
    """Returns where the field of the bodies' colours is, its name, a title. `part`: at the last time."""
    if not is_zero(part.CellData, "equivalent_plastic_strain"):
        return "CELLS", "equivalent_plastic_strain", "Equivalent plastic strain"
    if has_array(part.CellData, "von_mises_stress"):
        return "CELLS", "von_mises_stress", "Von Mises stress"
    return "POINTS", "displacement", "Displacement"


def extract(results, group, block=None):
    """Returns a group of blocks, or one of them, as a part of its own; nothing if the scene has none."""
    part = simple.ExtractBlock(registrationName=block or group, Input=results)
    path = ["Root", group] + ([block] if block else [])
    part.Selectors = ["/" + "/".join("".join(c for c in name if c not in " ()=,;") for name in path)]
    part.UpdatePipeline(simple.GetAnimationScene().AnimationTime)
    if part.GetDataInformation().GetNumberOfPoints() > 0:
        return part
    simple.Delete(part)
    return None


def blocks_of(data, name=""):
    """Yields the blocks of a part with their names."""
    if data is None:
        return
    if not data.IsA("vtkMultiBlockDataSet"):
        if data.GetNumberOfPoints() > 0:
            yield name, data
        return
    for i in range(data.GetNumberOfBlocks()):
        known = data.HasMetaData(i) and data.GetMetaData(i).Get(data.NAME())
        yield from blocks_of(data.GetBlock(i), known or name)


def extract_each(results, group):
    """Returns the blocks of a group as parts with their names; all as one if they cannot be told apart."""
    part = extract(results, group)
    if not part:
        return []
    names = [name for name, _ in blocks_of(servermanager.Fetch(part))]
    parts = [(name, extract(results, group, name)) for name in names] if len(set(names)) == len(names) else []
    if not parts or not all(block for _, block in parts):
        return [(group, part)]
    simple.Delete(part)
    return parts


def box_of(part):
    """Returns the lowest and the highest coordinates of a part."""
    bounds = part.GetDataInformation().GetBounds()
    return bounds[0::2], bounds[1::2]


def unite(boxes):
    lows, highs = zip(*boxes)
    return [min(values) for values in zip(*lows)], [max(values) for values in zip(*highs)]


def towards_viewer():
    """Returns a unit vector."""
    direction = VIEWS[SECTION][0]
    return [a / math.hypot(*direction) for a in direction]


class Faces:
    """Faces of one block of a surface: areas, middles, and which of them may be seen from the viewer."""

    def __init__(self, data):
        self.data = data
        points = vtk_to_numpy(data.GetPoints().GetData())
        if data.IsA("vtkPolyData"):
            cells = data.GetPolys()
        else:
            cells = data.GetCells()
        begins = vtk_to_numpy(cells.GetOffsetsArray())[:-1]
        corners = vtk_to_numpy(cells.GetConnectivityArray())
        # Faces have three or four corners.
        sizes = numpy.diff(vtk_to_numpy(cells.GetOffsetsArray()))
        nodes = numpy.stack([corners[begins + numpy.minimum(k, sizes - 1)] for k in range(4)], axis=1)
        diagonals = points[nodes[:, 2]] - points[nodes[:, 0]], points[nodes[:, 3]] - points[nodes[:, 1]]
        normals = 0.5 * numpy.cross(*diagonals)
        self.areas = numpy.linalg.norm(normals, axis=1)
        self.corners = points[nodes]
        self.middles = self.corners.mean(axis=1)
        self.nodes = nodes
        # Not quite from the side: from there nothing of a face is seen.
        self.is_seen = normals @ numpy.array(towards_viewer()) > 0.1 * self.areas

    def values(self, where, name):
        """Returns the sizes of a field on the faces; nothing without it."""
        data = self.data.GetCellData() if where == "CELLS" else self.data.GetPointData()
        array = data.GetArray(name)
        if array is None:
            return None
        values = vtk_to_numpy(array)
        values = numpy.linalg.norm(values, axis=1) if values.ndim > 1 else values
        return values if where == "CELLS" else values[self.nodes].mean(axis=1)


def depth_of(points):
    """Returns places on the screen and depths, positive towards the viewer, of an array of points."""
    right, up = screen_axes()
    return points @ numpy.array(right), points @ numpy.array(up), points @ numpy.array(towards_viewer())


def samples_of(corners, spacing):
    """Returns points on faces, no farther from each other than this."""
    edges = numpy.linalg.norm(corners - numpy.roll(corners, 1, axis=1), axis=2).max(axis=1)
    parts = numpy.ceil(numpy.log2(numpy.maximum(1.0, edges / spacing))).astype(int)
    for level in set(parts):
        a = (numpy.arange(2**level) + 0.5) / 2**level
        xi, eta = (x.ravel()[None, :, None] for x in numpy.meshgrid(a, a))
        c = corners[parts == level][:, :, None, :]
        yield (
            (1 - eta) * ((1 - xi) * c[:, 0] + xi * c[:, 1]) + eta * ((1 - xi) * c[:, 3] + xi * c[:, 2])
        ).reshape(-1, 3)


def drop_hidden(blocks):
    """Takes faces behind others from those that are seen, by the depths of pixels."""
    corners = numpy.concatenate([faces.corners for faces in blocks])
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    pixel = numpy.linalg.norm(high - low) / 150
    n = 152
    x_low, y_low, _ = (numpy.min(a) for a in depth_of(corners))

    def pixels(x, y):
        return ((x - x_low) / pixel).astype(int) * n + ((y - y_low) / pixel).astype(int)

    depths = numpy.full(n * n, -numpy.inf)
    for points in samples_of(corners, 0.7 * pixel):
        x, y, depth = depth_of(points)
        numpy.maximum.at(depths, pixels(x, y), depth)
    for faces in blocks:
        x, y, depth = depth_of(faces.middles)
        faces.is_seen &= depth > depths[pixels(x, y)] - 4 * pixel


def top_of(surface, time, field):
    """Returns the value that a field exceeds on 2 % of the visible surface."""
    surface.UpdatePipeline(time)
    values, areas = [], []
    blocks = [Faces(data) for _, data in blocks_of(servermanager.Fetch(surface))]
    if blocks:
        drop_hidden(blocks)
    for faces in blocks:
        of_block = faces.values(*field)
        if of_block is not None:
            values.append(of_block[faces.is_seen])
            areas.append(faces.areas[faces.is_seen])
    if not values or not sum(map(len, values)):
        return 0.0
    values, areas = numpy.concatenate(values), numpy.concatenate(areas)
    order = numpy.argsort(values)
    share = numpy.cumsum(areas[order])
    return float(values[order][min(len(order) - 1, numpy.searchsorted(share, 0.98 * share[-1]))])


def survey(bodies, times, field):
    """Returns top_of() for times from coarse to fine, as many as there is patience for."""
    surface = simple.ExtractSurface(registrationName="surface", Input=bodies)
    tops, start, stride = {}, time.monotonic(), len(times)
    while stride >= 1 and len(tops) < 60:
        for at in times[::-1][::stride]:
            if at not in tops and (not tops or time.monotonic() - start < 20.0):
                tops[at] = top_of(surface, at, field)
        stride //= 2
    simple.Delete(surface)
    return tops


def choose_time(times, tops, field):
    """Returns the time to show. Plastic strains grow until the end; stresses may be gone there."""
    if TIME is not None:
        return min(times, key=lambda at: abs(at - float(TIME)))
    if field[1] == "equivalent_plastic_strain" or not max(tops.values()) > 0.0:
        return times[-1]
    return max(at for at, top in tops.items() if top >= 0.98 * max(tops.values()))


def show_bodies(part, view, field, top):
    """Shows the bodies in colours from zero to a value that less than 2 % of what is seen exceed."""
    where, name, title = field
    shown = simple.Show(part, view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = EDGE
    shown.Ambient, shown.Diffuse = 0.45, 0.60
    simple.ColorBy(shown, (where, name))
    colours = simple.GetColorTransferFunction(name)
    colours.ApplyPreset("Viridis (matplotlib)", True)
    colours.AutomaticRescaleRangeMode = "Never"
    colours.RescaleTransferFunction(0.0, top if top > 0.0 else 1.0)
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = EDGE
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.3g", "%.3g"
    shown.SetScalarBarVisibility(view, True)


def show_plain(part, view, colour, opacity, size=0.0):
    """Shows a part in one colour, this distance nearer to the viewer: so it hides no face that it lies in."""
    shown = simple.Show(part, view)
    shown.Representation = "Surface"
    shown.ColorArrayName = [None, ""]
    shown.DiffuseColor = shown.AmbientColor = colour
    shown.Opacity = opacity
    shown.Position = [size * a for a in towards_viewer()]


def trim(part, name, box):
    """Cuts off what large tools, which may be infinite, have beyond the bodies in this box."""
    low, high = box_of(part)
    size = math.dist(*box)
    margin, finite = 0.12 * size, 0.7 * size
    for axis in range(3):
        first, last = box[0][axis] - margin, box[1][axis] + margin
        if high[axis] - low[axis] <= finite or low[axis] > last or high[axis] < first:
            continue
        for sign, place in ((1.0, first), (-1.0, last)):
            whole, normal = part, [0.0, 0.0, 0.0]
            normal[axis] = sign
            part = simple.Clip(registrationName=name, Input=whole, ClipType="Plane", Invert=0)
            part.ClipType.Normal = normal
            part.ClipType.Origin = [place if k == axis else 0.0 for k in range(3)]
            simple.Hide(whole)
    part.UpdatePipeline(simple.GetAnimationScene().AnimationTime)
    return part


def show_tool(part, view, name, box, colour, opacity):
    """Returns what is shown of a tool. In a section it is a line: its surface is seen from the side."""
    part = trim(part, name, box)
    if SECTION == "solid":
        show_plain(part, view, colour, opacity, 0.003 * math.dist(*box))
        return part
    cut = simple.Slice(registrationName=SECTION + " of " + name, Input=part)
    cut.SliceType = "Plane"
    cut.SliceType.Normal = VIEWS[SECTION][0]
    cut.SliceType.Origin = [0.5 * (a + b) for a, b in zip(*box)]
    shown = simple.Show(cut, view)
    shown.ColorArrayName = [None, ""]
    shown.DiffuseColor = shown.AmbientColor = colour
    shown.LineWidth = 3.0
    simple.Hide(part, view)
    return cut


class Labels:
    """Texts at places of the model, in front of everything."""

    def __init__(self):
        self.labels = []

    def add(self, text, place, colour, alignment="Center"):
        self.labels.append((text, numpy.array(place, dtype=float), colour, alignment))

    def add_apart(self, text, places, colour):
        """Adds a text at that of several places which is farthest from the other texts."""
        depths = places @ numpy.array(towards_viewer())
        near_ones = places[depths >= numpy.median(depths)]
        if self.labels:
            x, y, _ = depth_of(near_ones)
            other_x, other_y, _ = depth_of(numpy.array([place for _, place, *_ in self.labels]))
            # Texts are wider than high.
            distances = numpy.hypot((x[:, None] - other_x) / 5, y[:, None] - other_y).min(axis=1)
            self.add(text, near_ones[distances.argmax()], colour)
        else:
            self.add(text, near_ones[0], colour)

    def show(self, view, size):
        """Moves them towards the viewer, whose place must be known. `size`: that of the model."""
        for text, place, colour, alignment in self.labels:
            if view.CameraParallelProjection:
                place = place + size * numpy.array(towards_viewer())
            else:
                place = 0.5 * (place + numpy.array(view.CameraPosition))
            label = simple.Text(registrationName="label " + text, Text=text)
            shown = simple.Show(label, view, "TextSourceRepresentation")
            shown.TextPropMode = "Billboard 3D Text"
            shown.BillboardPosition = [float(a) for a in place]
            shown.Color, shown.FontSize, shown.Bold, shown.Justification = colour, 16, 1, alignment


def show_title(results, view):
    """Shows the title and the time, which an animation changes; a preview has no time."""
    version = simple.GetParaViewVersion()
    uses_braces = (version.major, version.minor) >= (5, 10)
    place = os.path.dirname(folder()) if PREVIEW else folder()
    title = TITLE or os.path.basename(place)
    if uses_braces:
        text = title.replace("{", "{{").replace("}", "}}") + ("\npreview" if PREVIEW else "\ntime {time:.5g}")
    else:
        text = title.replace("%", "%%") + ("\npreview" if PREVIEW else "\ntime %.5g")
    stamp = simple.AnnotateTimeFilter(registrationName="title and time", Input=results, Format=text)
    shown = simple.Show(stamp, view)
    shown.Color, shown.FontSize, shown.WindowLocation = EDGE, 18, "Upper Left Corner"
    shown.Justification = "Left"


def label_bodies(part, labels):
    """Writes the names of the bodies beside them, if there are several."""
    blocks = list(blocks_of(servermanager.Fetch(part)))
    if not 1 < len(blocks) <= 12:
        return
    right = numpy.array(screen_axes()[0])
    bodies = [vtk_to_numpy(data.GetPoints().GetData()) for _, data in blocks]
    screens = [depth_of(points)[:2] for points in bodies]
    low, high = min(x.min() for x, _ in screens), max(x.max() for x, _ in screens)
    for (name, _), points, (x, y) in zip(blocks, bodies, screens):
        is_left = x.max() - low < high - x.min() - 0.01 * (high - low)
        place = points[x.argmin() if is_left else x.argmax()]
        beside, height = (x.min(), y[x.argmin()]) if is_left else (x.max(), y[x.argmax()])
        for other_x, other_y in screens:  # a body in front or around
            if other_y.min() < height < other_y.max() and other_x.min() < beside < other_x.max():
                place = place + ((low if is_left else high) - beside) * right
                break
        offset = (-0.03 if is_left else 0.03) * (high - low)
        labels.add(name, place + offset * right, EDGE, "Right" if is_left else "Left")


def face_text(number, names):
    return str(number) + (" " + names[number] if names.get(number) else "")


def show_boundaries(part, view, labels):
    """Shows boundary ids as colours, and with their names on the faces."""
    found, texts = [], {}
    blocks = [(body, Faces(data)) for body, data in blocks_of(servermanager.Fetch(part))]
    drop_hidden([faces for _, faces in blocks])
    for body, faces in blocks:
        ids = faces.values("CELLS", "boundary_id")
        for number in sorted(set(ids.astype(int))):
            text = face_text(number, BOUNDARIES.get(body, {}))
            texts.setdefault(number, set()).add(text)
            seen = (ids == number) & faces.is_seen
            if not seen.any():
                continue
            areas, middles = faces.areas[seen], faces.middles[seen]
            middle = (areas[:, None] * middles).sum(axis=0) / areas.sum()
            nearest = middles[numpy.linalg.norm(middles - middle, axis=1).argmin()]
            found.append((areas.sum(), text, nearest))
    shown = simple.Show(part, view)
    shown.Representation = "Surface With Edges"
    shown.EdgeColor = [0.45, 0.45, 0.45]
    shown.Ambient, shown.Diffuse = 0.45, 0.60
    simple.ColorBy(shown, ("CELLS", "boundary_id"))
    colours = simple.GetColorTransferFunction("boundary_id")
    colours.InterpretValuesAsCategories = 1
    numbers = sorted(texts)
    colours.Annotations = [a for n in numbers for a in (str(n), " / ".join(sorted(texts[n])))]
    colours.IndexedColors = [a for i in range(len(numbers)) for a in FACES[i % len(FACES)]]
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = "Boundary ids", ""
    bar.TitleColor = bar.LabelColor = EDGE
    shown.SetScalarBarVisibility(view, True)
    for _, text, place in sorted(found, key=lambda of_face: -of_face[0])[:24]:
        labels.add(text, place, EDGE)


def show_preview(results, view, box, labels):
    """Shows supports in green, loads in colours of their own, and tools at the end of their motion in orange.

    Returns the boxes of these.
    """
    boxes = []
    for name, tool in extract_each(results, "Tools at end"):
        simple.RenameSource(name + " at the end", tool)
        boxes.append(box_of(show_tool(tool, view, name + " at the end", box, TOOL_AT_END, 0.2)))
    supports = extract(results, "Supports")
    if supports:
        show_plain(supports, view, SUPPORT, 1.0)
        boxes.append(box_of(supports))
    for i, (name, load) in enumerate(extract_each(results, "Loads")):
        colour = LOADS[i % len(LOADS)]
        show_plain(load, view, colour, 1.0)
        boxes.append(box_of(load))
        for _, data in blocks_of(servermanager.Fetch(load)):
            tails = vtk_to_numpy(data.GetPoints().GetData())[::13]  # the first point of each arrow
            labels.add_apart(name, tails, colour)
    return boxes


def show_hidden(part, view, name):
    """Prepares colours for whoever switches a part on."""
    shown = simple.Show(part, view)
    if has_array(part.PointData, name):
        simple.ColorBy(shown, ("POINTS", name))
    elif has_array(part.CellData, name):
        simple.ColorBy(shown, ("CELLS", name))
    shown.SetScalarBarVisibility(view, False)
    simple.Hide(part, view)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def screen_axes():
    """Returns unit vectors to the right and upwards on the screen."""
    right = cross(VIEWS[SECTION][1], towards_viewer())
    right = [a / math.hypot(*right) for a in right]
    return right, cross(towards_viewer(), right)


def frame(view, box):
    """Fits a box into the picture, beside the colour bar at the right and below the title."""
    back, (right, up) = towards_viewer(), screen_axes()
    corners = [[box[(i >> k) & 1][k] for k in range(3)] for i in range(8)]
    places = [(dot(c, right), dot(c, up), dot(c, back)) for c in corners]
    middle = [0.5 * (min(values) + max(values)) for values in zip(*places)]
    # Half the picture, without the margins at the sides, above and below.
    half_height = math.tan(math.radians(0.5 * view.CameraViewAngle))
    half_width = half_height * SIZE[0] / SIZE[1]
    room_width, room_height = 0.72 * half_width, 0.82 * half_height
    distance = max(
        z - middle[2] + max(abs(x - middle[0]) / room_width, abs(y - middle[1]) / room_height)
        for x, y, z in places
    )
    scale = max(
        max(abs(y - middle[1]) for _, y, _ in places) / 0.82,
        max(abs(x - middle[0]) for x, _, _ in places) * SIZE[1] / SIZE[0] / 0.72,
    )
    is_solid = SECTION == "solid"
    height = distance * half_height if is_solid else scale
    middle[0] += 0.10 * height * SIZE[0] / SIZE[1]  # the bar is at the right
    middle[1] += 0.06 * height
    centre = [sum(m * axis[k] for m, axis in zip(middle, (right, up, back))) for k in range(3)]
    view.CameraViewUp = VIEWS[SECTION][1]
    view.CameraFocalPoint = centre
    view.CameraPosition = [a + distance * b for a, b in zip(centre, back)]
    view.CameraParallelProjection = 0 if is_solid else 1
    view.CameraParallelScale = scale


def near(box, other, margin):
    """Returns the part of another box that is within this distance of a box."""
    return (
        [min(a, max(b, a - margin)) for a, b in zip(box[0], other[0])],
        [max(a, min(b, a + margin)) for a, b in zip(box[1], other[1])],
    )


def set_time(view, at):
    simple.GetAnimationScene().AnimationTime = at
    view.ViewTime = at


def main():
    global TIME
    arguments = [a for a in sys.argv[1:] if a.endswith(".png")] + [a for a in sys.argv[1:] if a[:1].isdigit()]
    picture = next((a for a in arguments if a.endswith(".png")), None)
    TIME = next((a for a in arguments if not a.endswith(".png")), TIME)
    view = simple.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesLabelColor = EDGE
    results = open_results()
    times = times_of(results)
    simple.GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
    set_time(view, times[-1])
    simple.Hide(results, view)
    bodies, outsides = extract(results, "Bodies"), extract(results, "Boundaries")
    if bodies and not PREVIEW:
        field = choose_field(bodies)
        tops = survey(bodies, times, field[:2])
        set_time(view, choose_time(times, tops, field))
        for part in (bodies, outsides):
            part.UpdatePipeline(view.ViewTime)
    labels = Labels()
    surfaces = extract(results, "Contact surfaces")
    if surfaces:
        show_hidden(surfaces, view, "contact_pressure")
    if outsides and PREVIEW:
        show_boundaries(outsides, view, labels)
    elif outsides:
        show_hidden(outsides, view, "boundary_id")
    box = box_of(bodies or outsides)
    boxes = []
    for name, tool in extract_each(results, "Tools"):
        shown = show_tool(tool, view, name, box, TOOL, 0.2)
        if PREVIEW:
            low, high = box_of(shown)
            if low[0] <= high[0]:  # else a section does not meet it
                labels.add(name, [0.5 * (a + b) for a, b in zip(low, high)], TOOL)
        boxes.append(box_of(shown))
    if PREVIEW:
        boxes += show_preview(results, view, box, labels)
    elif bodies:
        show_bodies(bodies, view, field, max(tops.values()))
        simple.SetActiveSource(bodies)
    if bodies:
        label_bodies(bodies, labels)
    show_title(results, view)
    simple.Render(view)  # the first time it chooses a camera of its own
    if not PREVIEW:  # tools that have left are not worth a small picture
        boxes = [near(box, other, 0.15 * math.dist(*box)) for other in boxes]
    whole = unite([box, *boxes])
    frame(view, whole)
    labels.show(view, math.dist(*whole))
    simple.Render(view)
    if picture:
        view.ViewSize = SIZE
        simple.SaveScreenshot(picture, view, ImageResolution=SIZE)


main()
)py";

std::string name_of(const WholeSection &section) {
  switch (section.kind) {
  case WholeSection::Kind::model:
    return section.is_layer ? "plane strain" : "solid";
  case WholeSection::Kind::per_width:
    return "plane strain";
  case WholeSection::Kind::full_circle:
    break;
  }
  return "axisymmetric";
}

/// Returns a string of Python.
std::string quoted(const std::string &text) {
  std::string result = "\"";
  for (const char c : text)
    result += c == '\\' || c == '"' ? std::string("\\") + c : c == '\n' ? "\\n" : std::string(1, c);
  return result + "\"";
}

/// Returns a dictionary of Python: of each body, the names of its boundary ids.
std::string boundary_names(const Scene &scene) {
  std::string result;
  for (const Body &body : scene.bodies()) {
    std::map<unsigned int, std::string> names;
    for (const auto &[name, ids] : body.boundary_names.ids_of_name)
      for (const unsigned int id : ids)
        names[id] += (names[id].empty() ? "" : ", ") + name;
    std::string entries;
    for (const auto &[id, name] : names)
      entries += (entries.empty() ? "" : ", ") + std::to_string(id) + ": " + quoted(name);
    result += (result.empty() ? "" : ", ") + quoted(body.name) + ": {" + entries + "}";
  }
  return "{" + result + "}";
}

} // namespace

std::string paraview_script(const std::string &index, const Scene &scene, const bool is_preview) {
  return head + "INDEX = " + quoted(index) + "\nSECTION = " + quoted(name_of(scene.whole_section())) +
         "\nPREVIEW = " + (is_preview ? "True" : "False") + "\nTITLE = " + quoted(scene.parameters().title) +
         "\nBOUNDARIES = " + boundary_names(scene) + "\n" + body;
}

} // namespace billet
