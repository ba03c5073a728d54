// Uses one room alone, with the library behind it (Embree) linked in silence.
#include "mien/geometry/surface_query.h"

int main() {
  mien::PointsD positions(3, 3);
  positions << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  mien::Triangles triangles(1, 3);
  triangles << 0, 1, 2;
  const mien::SurfaceQuery query(positions, triangles);
  return query.closest({0.25, 0.25, 2}).distance == 2 ? 0 : 1;
}
