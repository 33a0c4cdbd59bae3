# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the comparisons with CalculiX share: billet's mesh from its own output."""

import base64
import os
import re
import struct
import zlib

CCX_ENVIRONMENT = {**os.environ, "OMP_NUM_THREADS": "1", "CCX_NPROC_EQUATION_SOLVER": "1",
                   "CCX_NPROC_RESULTS": "1", "NUMBER_OF_CPUS": "1"}
FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))  # S1 ... S6


def data_array(text, name, form):
    """The values of a DataArray as deal.II writes it: base64 of (blocks, size, last size, packed sizes), then zlib."""
    pattern = r'<DataArray[^>]*Name="' + name + r'"[^>]*>' if name else r"<Points>\s*<DataArray[^>]*>"
    encoded = re.search(pattern + r"\s*(\S+)\s*</DataArray>", text).group(1)
    n_blocks = struct.unpack("<I", base64.b64decode(encoded[:8])[:4])[0]
    head_length = 4 * ((4 * (3 + n_blocks) + 2) // 3)
    packed_sizes = struct.unpack(f"<{3 + n_blocks}I", base64.b64decode(encoded[:head_length])[:4 * (3 + n_blocks)])[3:]
    packed, values, start = base64.b64decode(encoded[head_length:]), b"", 0
    for size in packed_sizes:
        values += zlib.decompress(packed[start:start + size])
        start += size
    return [value for value, in struct.iter_unpack("<" + form, values)]


def read_bricks(text, digits):
    """Nodes and bricks (in VTK's order, which is Abaqus', too) of the fields that billet writes at time 0. Corners that
    agree to so many decimals are one node."""
    flat = data_array(text, "", "f")
    points = list(zip(flat[0::3], flat[1::3], flat[2::3]))
    corners = data_array(text, "connectivity", "i")
    index, nodes, of_point = {}, [], []
    for point in points:  # deal.II writes each brick's own corners
        key = tuple(round(x, digits) for x in point)
        if key not in index:
            index[key] = len(nodes)
            nodes.append(key)
        of_point.append(index[key])
    bricks = [[of_point[corner] for corner in corners[i:i + 8]] for i in range(0, len(corners), 8)]
    return nodes, bricks
