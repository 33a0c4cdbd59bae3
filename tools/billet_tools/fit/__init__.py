# SPDX-License-Identifier: LGPL-2.1-or-later
"""billet-fit: constants of laws of rubber from tests of the material.

data      measured points of uniaxial, equibiaxial and planar tension
laws      nominal stresses of the laws, their stability, and lines for a scene
fitting   least squares
picture   points and curves
options   the command line, which needs no packages
command   the program
"""
