# SPDX-License-Identifier: LGPL-2.1-or-later
"""Usage: pvbatch contents_in_paraview.py FILE...

Opens results by ParaView's readers, at their last time, and prints a line for each array: the file,
the path of names of its block, point or cell, its name, and its numbers of components and of
tuples. Of a picture it prints the number of colours.
"""

from __future__ import annotations

import sys
from typing import Any

from paraview.servermanager import Fetch
from paraview.simple import PVDReader, XDMFReader
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def show(file: str, block: Any, path: list[str]) -> None:
    """Prints the arrays of a block and of those in it."""
    if block is None:
        return
    if block.IsA("vtkMultiBlockDataSet"):
        for i in range(block.GetNumberOfBlocks()):
            name = block.GetMetaData(i).Get(block.NAME()) if block.HasMetaData(i) else None
            show(file, block.GetBlock(i), path + [name or "unnamed"])
        return
    for kind, data in (("point", block.GetPointData()), ("cell", block.GetCellData())):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetArray(i)
            if array is not None:
                fields = file, "/".join(path), kind, array.GetName()
                print(
                    "\t".join([*fields, str(array.GetNumberOfComponents()), str(array.GetNumberOfTuples())])
                )


for name in sys.argv[1:]:
    if name.endswith(".png"):
        picture = vtkPNGReader()
        picture.SetFileName(name)
        picture.Update()
        colours = vtk_to_numpy(picture.GetOutput().GetPointData().GetScalars())
        print("\t".join([name, "colours", str(len({tuple(colour) for colour in colours}))]))
        continue
    reader = PVDReader(FileName=name) if name.endswith(".pvd") else XDMFReader(FileNames=[name])
    reader.UpdatePipelineInformation()
    times = reader.TimestepValues
    reader.UpdatePipeline(times[-1] if hasattr(times, "__len__") else times)
    show(name, Fetch(reader), [])
