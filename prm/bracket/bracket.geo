// An angle bracket of 6 mm with a fillet, bent from a foot to an arm: gmsh -3 bracket.geo
SetFactory("OpenCASCADE");
t = 6; foot = 40; arm = 50; r = 4; width = 40;
Point(1) = {0, 0, 0};             Point(2) = {foot, 0, 0};     Point(3) = {foot, 0, t};
Point(4) = {t + r, 0, t};         Point(5) = {t + r, 0, t + r}; Point(6) = {t, 0, t + r};
Point(7) = {t, 0, arm};           Point(8) = {0, 0, arm};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Circle(4) = {4, 5, 6};
Line(5) = {6, 7}; Line(6) = {7, 8}; Line(7) = {8, 1};
Curve Loop(1) = {1 ... 7};
Plane Surface(1) = {1};
Mesh.MeshSizeMax = 3; Mesh.Algorithm = 6; Mesh.RecombineAll = 1; Mesh.SubdivisionAlgorithm = 1;
all[] = Extrude {0, width, 0} { Surface{1}; Layers{12}; Recombine; };
Physical Volume("bracket") = {1};
Physical Surface("bolted") = {2};   // underside of the foot
Physical Surface("loaded") = {7};   // top of the arm
