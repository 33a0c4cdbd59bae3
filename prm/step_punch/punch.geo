// A punch of radius 10 with a spherical end that touches z = 0: gmsh -0 punch.geo -o punch.step
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 10, 0, 0, 10, 10};
Sphere(2) = {0, 0, 10, 10, -Pi/2, 0};
BooleanUnion{ Volume{1}; Delete; }{ Volume{2}; Delete; }
