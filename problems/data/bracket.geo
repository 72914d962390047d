// A bracket with two holes, 0.5 long, thinner towards the tip. Mesh with: gmsh -2 bracket.geo
h = 0.012;
h_hole = 0.006;

Point(1) = {0, 0, 0, h};
Point(2) = {0.5, 0.12, 0, h};
Point(3) = {0.5, 0.2, 0, h};
Point(4) = {0, 0.2, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};

Point(5) = {0.12, 0.13, 0};  // centre of the wide hole, radius 0.04
Point(6) = {0.16, 0.13, 0, h_hole};
Point(7) = {0.08, 0.13, 0, h_hole};
Circle(5) = {6, 5, 7};
Circle(6) = {7, 5, 6};
Curve Loop(2) = {5, 6};

Point(8) = {0.3, 0.1525, 0};  // centre of the narrow hole, radius 0.03
Point(9) = {0.33, 0.1525, 0, h_hole};
Point(10) = {0.27, 0.1525, 0, h_hole};
Circle(7) = {9, 8, 10};
Circle(8) = {10, 8, 9};
Curve Loop(3) = {7, 8};

Plane Surface(1) = {1, 2, 3};
Physical Curve("wall") = {4};
Physical Curve("hook") = {2};
Physical Curve("top") = {3};
Physical Curve("bottom") = {1};
Physical Curve("wide_hole") = {5, 6};
Physical Curve("narrow_hole") = {7, 8};
Physical Surface("bracket") = {1};
