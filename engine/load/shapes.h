// Shapes: <shape> elements to scene.shapes with their material and light, and the readers of the shape plugins.
#pragma once

#include "engine/load/plugins.h"

namespace wavecrest {

// Adds a <shape> to the scene. A group's shapes are added with its first instance.
void addShape(LoadContext& context, const XmlElement& shape);

Geometry readRectangle(LoadContext&, Parameters&, const Matrix4& toWorld);
Geometry readCube(LoadContext&, Parameters&, const Matrix4& toWorld);
Geometry readSphere(LoadContext&, Parameters&, const Matrix4& toWorld);
Geometry readDisk(LoadContext&, Parameters&, const Matrix4& toWorld);
Geometry readCylinder(LoadContext&, Parameters&, const Matrix4& toWorld);
Geometry readPlyShape(LoadContext&, Parameters&, const Matrix4& toWorld);
Geometry readObjShape(LoadContext&, Parameters&, const Matrix4& toWorld);
Geometry readSerializedShape(LoadContext&, Parameters&, const Matrix4& toWorld);

// What these shapes become in world space. Pure functions of their parameters, so that a writer can find parameters.
Rectangle placeRectangle(const Matrix4& toWorld, bool flipNormals);
Cylinder placeCylinder(const Matrix4& toWorld, const Double3& p0, const Double3& p1, double radius, bool flipNormals);

// Surface area of a shape in world space; not finite if its numbers overflow.
double surfaceArea(const Geometry& geometry);

}  // namespace wavecrest
