// The unit cube in Delaunay tetrahedra: gmsh -3 box_delaunay.geo -o box_delaunay.msh (gmsh 4.8.4)
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Mesh.CharacteristicLengthMin = 0.13;
Mesh.CharacteristicLengthMax = 0.13;
Mesh.Algorithm3D = 1;
Mesh.MshFileVersion = 4.1;
Physical Volume("box") = {1};
