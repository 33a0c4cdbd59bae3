# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: pvpython animation.py SCENE.pvd ANIMATION.webp

Animates the bodies of a run, each snapshot once: equivalent plastic strain, or the von Mises stress of what
does not yield, with element edges. Flat scenes are seen along their thin direction.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from paraview.simple import (
    CellDatatoPointData,
    ColorBy,
    CreateView,
    Delete,
    ExtractBlock,
    GetColorTransferFunction,
    MergeBlocks,
    SaveScreenshot,
    Show,
    XMLMultiBlockDataReader,
)
from PIL import Image

Proxy = Any  # of ParaView's, which has no types
STRAIN, STRESS = "equivalent_plastic_strain", "von_mises_stress"
MAX_FRAMES = 40
MILLISECONDS = 120

scene, animation = Path(sys.argv[1]), Path(sys.argv[2])
files = [str(scene.parent / entry.attrib["file"]) for entry in ElementTree.parse(scene).iter("DataSet")]
files = files[:: max(1, -(-len(files) // MAX_FRAMES))] + files[-1:] * (len(files) > MAX_FRAMES)


def bodies_at(file: str) -> Proxy:
    part = ExtractBlock(Input=XMLMultiBlockDataReader(FileName=[file]))
    part.Selectors = ["/Root/Bodies"]
    source = CellDatatoPointData(Input=MergeBlocks(Input=part, MergePoints=0))
    source.UpdatePipeline()
    return source


bodies = [bodies_at(file) for file in files]
bounds = [body.GetDataInformation().GetBounds() for body in bodies]
low = [min(bound[2 * k] for bound in bounds) for k in range(3)]
high = [max(bound[2 * k + 1] for bound in bounds) for k in range(3)]
centre = [0.5 * (a + b) for a, b in zip(low, high)]
size = [b - a for a, b in zip(low, high)]


def largest(name: str) -> float:
    return max(body.PointData[name].GetRange()[1] if body.PointData[name] else 0.0 for body in bodies)


field = STRAIN if largest(STRAIN) > 0.0 else STRESS
colours = GetColorTransferFunction(field)
colours.ApplyPreset("Viridis (matplotlib)", True)

view = CreateView("RenderView")
view.UseColorPaletteForBackground = 0
view.Background = [1.0, 1.0, 1.0]
view.OrientationAxesVisibility = 0
view.CameraParallelProjection = 1
view.CameraFocalPoint = centre
distance = 10.0 * max(size)
if size[1] < 0.2 * min(size[0], size[2]):
    direction, up, width, height = (0.0, -1.0, 0.0), [0.0, 0.0, 1.0], size[0], size[2]
elif size[2] < 0.2 * min(size[0], size[1]):
    direction, up, width, height = (0.0, 0.0, 1.0), [0.0, 1.0, 0.0], size[0], size[1]
else:
    direction, up = (0.62, -0.68, 0.4), [0.0, 0.0, 1.0]
    width, height = 0.8 * (size[0] + size[1]), 0.9 * size[2] + 0.35 * (size[0] + size[1])
view.CameraPosition = [c + distance * d for c, d in zip(centre, direction)]
view.CameraViewUp = up
pixels = 640
view.ViewSize = [pixels, min(pixels, max(160, int(pixels * 1.08 * height / (1.08 * width))))]
view.CameraParallelScale = 0.54 * max(height, width * view.ViewSize[1] / pixels)

frames = []
with tempfile.TemporaryDirectory() as folder:
    for i, body in enumerate(bodies):
        shown = Show(body, view)
        shown.Representation = "Surface With Edges"
        shown.EdgeColor = [0.12, 0.12, 0.12]
        shown.Ambient, shown.Diffuse = 0.52, 0.56
        ColorBy(shown, ("POINTS", field))
        colours.RescaleTransferFunction(0.0, largest(field))  # ColorBy took the range of this snapshot
        shown.SetScalarBarVisibility(view, False)
        picture = f"{folder}/{i}.png"
        SaveScreenshot(picture, view, ImageResolution=view.ViewSize)
        frames.append(Image.open(picture).convert("RGB"))
        Delete(shown)
frames[0].save(
    animation,
    save_all=True,
    append_images=frames[1:],
    duration=[MILLISECONDS] * (len(frames) - 1) + [10 * MILLISECONDS],
    loop=0,
    quality=60,
    method=4,
)
