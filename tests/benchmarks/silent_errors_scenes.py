# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes of the benchmark silent-errors, by families, each with its references."""

import math

from silent_errors_runs import OF_THE_MESH, Case, Reference, force_curve, impulse

# Of references: as good as exact, in small steps.
EXACT = {"Force tolerance": 1e-5, "Energy tolerance": 1e-9, "Displacement tolerance": 1e-3, "Contact tangent": "exact"}


def box(counts, low, high, **more):
    corners = " : ".join(", ".join(f"{x:.12g}" for x in corner) for corner in (low, high))
    return {"Primitive": "subdivided_hyper_rectangle", "Arguments": f"{', '.join(map(str, counts))} : {corners} : true", **more}


def elastic(young, poisson=0.3, **more):
    return {"Law": "elastic", "Young modulus": young, "Poisson ratio": poisson, **more}


def stepping(end, initial=None, largest=None, **more):
    return {"End time": f"{end:.12g}", "Initial step": initial and f"{initial:.12g}", "Largest step": largest and f"{largest:.12g}", **more}


QUIET = {"Folder": "results", "Format": "none", "Verbosity": "quiet"}
ONE_PICTURE = {"Folder": "results", "Every steps": 0, "Verbosity": "quiet"}


# --- bending: a strip between a roll that supports it and one that presses it down ---------------------------------

def strip(along, through, element, law, radius, penalty=None, tangent=None, search=None, initial=None, largest=None, travel=8.0,
          solver=None):
    material = elastic(200000)
    if law == "plastic":
        material = {**material, "Law": "elastoplastic", "Yield stress": 400, "Hardening modulus": 2000}
    pair = {"Body": "strip", "Normal penalty": penalty}
    return {
        "Bodies": {"strip": {"Element": element, "Symmetry planes": "x = 0 ; y = 0 ; y = 1",
                             "Mesh": box((along, 1, through), (0, 0, -0.5), (60, 1, 0.5)), "Material": material}},
        "Tools": {"support": {"Surfaces": {"roll": {"Shape": "cylinder", "Point": f"50, 0, {-0.5 - radius:g}", "Axis": "0, 1, 0", "Radius": radius}}},
                  "punch": {"Surfaces": {"roll": {"Shape": "cylinder", "Point": f"0, 0, {0.5 + radius:g}", "Axis": "0, 1, 0", "Radius": radius}},
                            "Motion": {"Translation": f"0 ; 0 ; -{travel:g}*t"}}},
        "Contact pairs": {"on support": {**pair, "Boundary ids": 4, "Tool": "support"},
                          "under punch": {**pair, "Boundary ids": 5, "Tool": "punch"}},
        "Time stepping": stepping(1, initial, largest),
        "Solver": {"Contact tangent": tangent, "Line search": search, **(solver or {})},
        "Output": QUIET}


BENDING_NUMERICS = {
    "default": {}, "no line search": {"search": "none"},
    "steps of 1": {"initial": 1, "largest": 1}, "steps of 0.3": {"initial": 0.3, "largest": 0.3},
    "penalty 0.1": {"penalty": 0.1}, "penalty 1": {"penalty": 1}, "penalty 100": {"penalty": 100},
    "exact": {"tangent": "exact"}, "consistent": {"tangent": "consistent"}, "continuum": {"tangent": "continuum"},
    "upper": {"tangent": "symmetrised upper"}, "lower": {"tangent": "symmetrised lower", "search": "none"},
    "mean": {"tangent": "symmetrised mean", "largest": 1}}


def bending():
    meshes = [(6, 1), (6, 2), (12, 1), (12, 2), (20, 4), (30, 2), (60, 1), (60, 2), (60, 4)]
    elements, radii = ("mean dilatation", "one point", "full"), (5, 1, 20, 50, 2, 10)
    cases = []
    for i, (along, through) in enumerate(meshes):
        for j, law in enumerate(("elastic", "plastic")):
            element, radius = elements[(i + j) % 3], radii[(2 * i + 3 * j + i // 3) % 6]
            knobs = dict(along=along, through=through, element=element, law=law, radius=radius)
            near = Reference(strip(**knobs, penalty=300, initial=0.01, largest=0.02, solver=EXACT),
                             strip(**knobs, penalty=1000, initial=0.005, largest=0.01, solver=EXACT), frozenset(OF_THE_MESH),
                             force_curve(["under punch"]))
            fine = dict(along=120, through=4, element="one point", law=law, radius=radius, penalty=50)
            far = Reference(strip(**fine, initial=0.01, largest=0.02, solver=EXACT), None, frozenset(),
                            force_curve(["under punch"]), name="fine mesh")
            cases += [Case("bending", f"{along} x {through} bricks, {element}, {law}, radius {radius}, {name}",
                           strip(**knobs, **numerics), (near, far)) for name, numerics in BENDING_NUMERICS.items()]
    return cases


# --- blocks pressed into each other -----------------------------------------------------------------------------------

def blocks(lower, upper, gap, slave, friction, press, initial=None, largest=None, penalty=None, end=1.0, solver=None, spread=0.5):
    sides = {"lower": ("lower", 5), "upper": ("upper", 4)}
    first, second = sides[slave], sides["upper" if slave == "lower" else "lower"]
    return {
        "Bodies": {"lower": {"Mesh": box((lower,) * 3, (-1, -1, -2), (1, 1, 0)), "Supports": {"base": {"Boundary ids": 4}}, "Material": elastic(100)},
                   "upper": {"Mesh": box((upper,) * 3, (-spread, -spread, gap), (spread, spread, gap + 1)), "Material": elastic(1000),
                             "Supports": {"top": {"Boundary ids": 5, "Displacement": f"0 ; 0 ; -{(gap + press) / end:.12g}*t"}}}},
        "Contact pairs": {"face": {"Body": first[0], "Boundary ids": first[1], "Second body": second[0], "Second boundary ids": second[1],
                                   "Friction coefficient": friction or None, "Normal penalty": penalty}},
        "Time stepping": stepping(end, initial, largest), "Solver": solver or {}, "Output": QUIET}


BLOCK_NUMERICS = {
    "default": {}, "steps of 1": {"initial": 1, "largest": 1}, "steps of 0.1 to 1": {"initial": 0.1, "largest": 1},
    "steps of 0.3": {"initial": 0.3, "largest": 0.3}, "steps of 0.01 to 0.5": {"initial": 0.01, "largest": 0.5},
    "steps of 0.03": {"initial": 0.03, "largest": 0.03}, "penalty 1": {"penalty": 1}, "penalty 30": {"penalty": 30},
    "penalty 100": {"penalty": 100}}


def pressed_blocks():
    meshes, gaps, presses, frictions = [(4, 3), (4, 2), (3, 4), (5, 5)], (0, 0.1, 1, 3, 10), (0.1, 0.3, 0.5, 0.8), (0, 0.1, 0.3, 0.5)
    cases = []
    for i in range(24):
        knobs = dict(lower=meshes[i % 4][0], upper=meshes[i % 4][1], slave=("upper", "lower")[(i // 2) % 2],
                     friction=frictions[(i + i // 4) % 4], press=presses[(i // 3 + i) % 4])
        gap = gaps[i % 5]

        def clock(time, gap=gap, press=knobs["press"]):
            return ((gap + press) * time - gap) / press

        near = Reference(blocks(**knobs, gap=0, penalty=1000, initial=0.01, largest=0.02, solver=EXACT),
                         blocks(**knobs, gap=0, penalty=3000, initial=0.005, largest=0.01, solver=EXACT), frozenset(OF_THE_MESH),
                         force_curve(["face"], clock))
        said = ", ".join(f"{key} {value}" for key, value in knobs.items())
        cases += [Case("blocks", f"{said}, gap {gap}, {name}", blocks(**knobs, gap=gap, **numerics), (near,))
                  for name, numerics in BLOCK_NUMERICS.items()]
    return cases


# --- flights in implicit dynamics ----------------------------------------------------------------------------------------

TARGETS = {"held plate of 0.2": ((3, 3, 1), (3, 3, 0.2), True), "free plate of 0.2": ((3, 3, 1), (1.5, 1.5, 0.2), False),
           "free block of 1": ((2, 2, 2), (1, 1, 1), False), "held sheet of 0.05": ((6, 6, 1), (1.5, 1.5, 0.05), True)}
FLIERS = {"cube of 0.5": ((2, 2, 2), (0.5, 0.5, 0.5)), "tile of 0.05": ((2, 2, 1), (0.5, 0.5, 0.05))}
FLIGHT_NUMERICS = {"default": {}, "steps up to the end": {"largest": 1.0}, "first step of the whole flight": {"initial": 1.0, "largest": 1.0},
                   "by iterations alone, steps up to 0.3": {"largest": 0.3, "tolerance": 0}}


def flight(target, flier, speed, oblique, spin, distance, after, slave, tilt=0.0, initial=None, largest=None, tolerance=None, fixed=None):
    """The flier comes from above. `tilt`: its angle about y when it would touch the undeformed target; `spin`: in radians over a
    flight of its own size; `initial` and `largest` are parts of the run."""
    counts, size, is_held = TARGETS[target]
    f_counts, f_size = FLIERS[flier]
    reach = 0.5 * (f_size[0] * abs(math.sin(math.radians(tilt))) + f_size[2] * abs(math.cos(math.radians(tilt))))
    time, rate = distance / speed, spin * speed / f_size[0]
    centre = (-oblique * distance, 0.0, reach + distance)
    end = time + after
    angle = tilt - math.degrees(rate * time)
    half, f_half = [0.5 * x for x in size], [0.5 * x for x in f_size]
    velocity = f"{oblique * speed:.12g}" + (f" + {rate:.12g}*(z - {centre[2]:.12g})" if rate else "")
    fall = f"{-speed:.12g}" + (f" - {rate:.12g}*(x - {centre[0]:.12g})" if rate else "")
    solid = elastic(1000, 0.3, Density=1e-3)
    bodies = {"target": {"Mesh": box(counts, (-half[0], -half[1], -size[2]), (half[0], half[1], 0)), "Material": solid,
                         "Supports": {"rim": {"Boundary ids": "0, 1, 2, 3"}} if is_held else {}},
              "flier": {"Mesh": box(f_counts, [-x for x in f_half], f_half, **{"Rotation axis": "0, 1, 0", "Rotation angle": f"{angle:.12g}",
                                    "Translation": ", ".join(f"{x:.12g}" for x in centre)}),
                        "Material": solid, "Initial velocity": f"{velocity} ; 0 ; {fall}"}}
    names = ("flier", "target") if slave == "flier" else ("target", "flier")
    every = "0, 1, 2, 3, 4, 5"
    steps = stepping(end, initial and initial * end, largest and largest * end) if not fixed else \
        {"End time": f"{end:.12g}", "Step control": "fixed", "Initial step": f"{fixed:.12g}"}
    return {"Bodies": bodies,
            "Contact pairs": {"face": {"Body": names[0], "Boundary ids": every, "Second body": names[1], "Second boundary ids": every}},
            "Time stepping": {"Scheme": "implicit dynamics", **steps}, "Implicit dynamics": {"Error tolerance": tolerance}, "Output": ONE_PICTURE}


def flights():
    cases = []
    for i in range(28):
        target, flier = list(TARGETS)[i % 4], list(FLIERS)[(i // 4) % 2]
        thickness = min(TARGETS[target][1][2], FLIERS[flier][1][2])
        knobs = dict(target=target, flier=flier, speed=(10, 1, 30)[i % 3], oblique=(0, 0.5, 0, 1)[(i // 2) % 4], spin=(0, 0, 1)[(i // 3) % 3],
                     tilt=(0, 20, 0, 45, 10)[i % 5], slave=("flier", "target")[(i // 2) % 2])
        far, near, after = 100 * thickness, 0.004 * knobs["speed"] ** 0.5, 0.03
        step = 2e-5 if knobs["speed"] > 1 else 4e-5
        start = [knobs["oblique"] * knobs["speed"], 0, -knobs["speed"]]
        reference = Reference(flight(**knobs, distance=near, after=after, fixed=step),
                              flight(**knobs, distance=near, after=after, fixed=step / 2), frozenset(OF_THE_MESH), impulse("1", start))
        said = ", ".join(f"{key} {value}" for key, value in knobs.items())
        cases += [Case("flights", f"{said}, {name}", flight(**knobs, distance=far, after=after, **numerics), (reference,))
                  for name, numerics in FLIGHT_NUMERICS.items()]
    return cases


FAMILIES = {"bending": bending, "flights": flights, "blocks": pressed_blocks}
