// Quarter of a square plate with a circular hole: [0,1]^2 without r < a. Mesh with: gmsh -2 plate_hole.geo
a = 0.2;
h_hole = a * (Pi / 2) / 20;  // 20 elements on the arc
h_far = 0.06;

Point(1) = {0, 0, 0};  // centre of the hole
Point(2) = {a, 0, 0, h_hole};
Point(3) = {1, 0, 0, h_far};
Point(4) = {1, 1, 0, h_far};
Point(5) = {0, 1, 0, h_far};
Point(6) = {0, a, 0, h_hole};

Line(1) = {2, 3};
Line(2) = {3, 4};
Line(3) = {4, 5};
Line(4) = {5, 6};
Circle(5) = {6, 1, 2};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};

Physical Curve("hole") = {5};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
Physical Surface("plate") = {1};
