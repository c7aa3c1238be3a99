#include "loaders/gltf_polygons.h"

#include <span>

#include "accel/face_triangulation.h"

namespace alhazen {
namespace {

using IndexedTriangle = std::array<uint32_t, 3>;

bool is_fan(std::span<const IndexedTriangle> triangles) {
  for (size_t i = 1; i < triangles.size(); ++i)
    if (triangles[i][1] != triangles[i - 1][2]) return false;
  return true;
}

/// The vertices around a fan.
std::vector<uint32_t> outline(std::span<const IndexedTriangle> fan) {
  std::vector<uint32_t> vertices{fan[0][0], fan[0][1]};
  for (const IndexedTriangle& t : fan) vertices.push_back(t[2]);
  return vertices;
}

/// Where the fan is not the polygon that it stands for, puts the polygon's triangles in its place.
void straighten(std::span<IndexedTriangle> fan, const std::vector<Vec3f>& positions) {
  const std::vector<uint32_t> vertices = outline(fan);
  std::vector<Vec3f> corners;
  for (const uint32_t v : vertices) corners.push_back(positions[v]);
  if (is_proper_fan(corners)) return;
  const std::vector<IndexedTriangle> triangles = triangulate(corners);
  for (size_t i = 0; i < triangles.size(); ++i)
    fan[i] = {vertices[triangles[i][0]], vertices[triangles[i][1]], vertices[triangles[i][2]]};
}

Vec3f unit_normal(std::span<const IndexedTriangle> polygon, const std::vector<Vec3f>& positions) {
  Vec3d normal{};
  for (const IndexedTriangle& t : polygon)
    normal += newell_normal(std::array{positions[t[0]], positions[t[1]], positions[t[2]]});
  return Vec3f(normalize(normal));
}

}  // namespace

void join_polygons(TriangleMesh& part) {
  const std::span<IndexedTriangle> triangles(part.triangles);
  part.polygon_of_triangle.reserve(triangles.size());
  uint32_t polygon = 0;
  for (size_t first = 0, end = 0; first < triangles.size(); first = end, ++polygon) {
    while (end < triangles.size() && triangles[end][0] == triangles[first][0]) ++end;
    const auto run = triangles.subspan(first, end - first);
    part.polygon_of_triangle.insert(part.polygon_of_triangle.end(), run.size(), polygon);
    if (part.normals.empty()) part.polygon_normals.push_back(unit_normal(run, part.positions));
    if (run.size() > 1 && is_fan(run)) straighten(run, part.positions);
  }
  if (polygon == triangles.size()) part.polygon_of_triangle = {}, part.polygon_normals = {};
}

}  // namespace alhazen
