// Tangents against hand-computed cases and the properties that they must have on any mesh.
#include "loaders/tangents.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace alhazen {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3d xyz(const Vec4f& t) { return {t.x, t.y, t.z}; }

void expect_tangent(const Vec4f& found, const Vec3d& direction, float sign) {
  const Vec3d t = normalize(direction);
  EXPECT_NEAR(found.x, t.x, 1e-6);
  EXPECT_NEAR(found.y, t.y, 1e-6);
  EXPECT_NEAR(found.z, t.z, 1e-6);
  EXPECT_EQ(found.w, sign);
}

/// The square [0, 1]² in z = 0, seen from +z; its image upright, v down as in glTF.
TriangleMesh upright_square() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

struct RandomMesh {
  std::mt19937 rng;
  explicit RandomMesh(uint32_t seed) : rng(seed) {}
  float uniform() { return std::uniform_real_distribution<float>(-1, 1)(rng); }
  uint32_t index(uint32_t count) { return std::uniform_int_distribution<uint32_t>(0, count - 1)(rng); }
  Vec3f direction() {
    std::normal_distribution<double> g;
    return Vec3f(normalize(Vec3d{g(rng), g(rng), g(rng)}));
  }
  /// Triangles between random vertices, some without area in space or UV, with unrelated normals.
  TriangleMesh operator()(uint32_t vertices, uint32_t triangles) {
    TriangleMesh mesh;
    mesh.uvs.resize(2);
    for (uint32_t i = 0; i < vertices; ++i) {
      mesh.positions.push_back({uniform(), uniform(), uniform()});
      mesh.normals.push_back(direction());
      mesh.uvs[0].push_back({0, 0});
      mesh.uvs[1].push_back({uniform(), uniform()});
      mesh.colors.push_back({uniform(), uniform(), uniform(), 1});
    }
    for (uint32_t i = 0; i < triangles; ++i) {
      mesh.triangles.push_back({index(vertices), index(vertices), index(vertices)});
      if (i % 7 == 0) mesh.uvs[1][mesh.triangles[i][1]] = mesh.uvs[1][mesh.triangles[i][0]];
    }
    return mesh;
  }
};

/// Each corner its own vertex.
TriangleMesh unindexed(const TriangleMesh& mesh) {
  TriangleMesh out;
  out.uvs.resize(mesh.uvs.size());
  for (const auto& t : mesh.triangles) {
    const auto first = uint32_t(out.positions.size());
    out.triangles.push_back({first, first + 1, first + 2});
    for (const uint32_t v : t) {
      out.positions.push_back(mesh.positions[v]);
      out.normals.push_back(mesh.normals[v]);
      for (size_t k = 0; k < mesh.uvs.size(); ++k) out.uvs[k].push_back(mesh.uvs[k][v]);
    }
  }
  return out;
}

TEST(Tangents, FollowUOnAnUprightSquare) {
  TriangleMesh mesh = upright_square();
  generate_tangents(mesh, 0);
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (const Vec4f& t : mesh.tangents) expect_tangent(t, {1, 0, 0}, 1);
}

TEST(Tangents, TurnWithTheImage) {
  // The image turned by a quarter, counter-clockwise: u grows along +y.
  TriangleMesh mesh = upright_square();
  mesh.uvs[0] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  generate_tangents(mesh, 0);
  for (const Vec4f& t : mesh.tangents) expect_tangent(t, {0, 1, 0}, 1);
}

TEST(Tangents, OfAMirroredImageHaveTheOtherSign) {
  TriangleMesh mesh = upright_square();
  for (Vec2f& uv : mesh.uvs[0]) uv.x = 1 - uv.x;
  generate_tangents(mesh, 0);
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (const Vec4f& t : mesh.tangents) expect_tangent(t, {-1, 0, 0}, -1);
  mesh = upright_square();
  for (Vec2f& uv : mesh.uvs[0]) uv.y = 1 - uv.y;
  generate_tangents(mesh, 0);
  for (const Vec4f& t : mesh.tangents) expect_tangent(t, {1, 0, 0}, -1);
}

TEST(Tangents, AtAMirrorSeamSplitItsVertices) {
  // Two squares that share the edge x = 1, u running towards it from both sides.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0, 1}, {0, 0}}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  generate_tangents(mesh, 0);
  ASSERT_EQ(mesh.positions.size(), 8u);
  ASSERT_EQ(mesh.tangents.size(), 8u);
  for (size_t i = 0; i < 4; ++i)
    for (const uint32_t v : mesh.triangles[i])
      expect_tangent(mesh.tangents[v], {i < 2 ? 1.0 : -1.0, 0, 0}, i < 2 ? 1.0f : -1.0f);
}

TEST(Tangents, AreWeightedByTheAngleOfTheCorner) {
  // Two triangles meet at the origin: a right angle with u along x, half of one with u along (1, 1)/√2.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, -1, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  mesh.normals.assign(5, {0, 0, 1});
  const float h = std::sqrt(0.5f);
  mesh.uvs = {{{0, 0}, {0, 1}, {1, 0}, {h, h}, {2 * h, 0}}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  generate_tangents(mesh, 0);
  const Vec3d a{1, 0, 0}, b = normalize(Vec3d{1, 1, 0});
  expect_tangent(mesh.tangents[0], a * (kPi / 2) + b * (kPi / 4), 1);
  expect_tangent(mesh.tangents[1], a, 1);
  expect_tangent(mesh.tangents[4], b, 1);
}

TEST(Tangents, OfTrianglesWithoutAreaAreTheirNeighboursOrAnyPerpendicular) {
  TriangleMesh mesh = upright_square();
  mesh.triangles.push_back({0, 2, 2});
  generate_tangents(mesh, 0);
  EXPECT_EQ(mesh.positions.size(), 4u);
  for (const Vec4f& t : mesh.tangents) expect_tangent(t, {1, 0, 0}, 1);

  mesh = upright_square();
  mesh.uvs[0].assign(4, {0.5f, 0.5f});
  generate_tangents(mesh, 0);
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (const Vec4f& t : mesh.tangents) {
    EXPECT_NEAR(length(xyz(t)), 1, 1e-6);
    EXPECT_NEAR(t.z, 0, 1e-6);
  }
}

TEST(Tangents, OfAMeshWithoutNormalsComeWithFlatOnes) {
  TriangleMesh mesh = upright_square();
  mesh.normals.clear();
  mesh.positions[2] = {1, 1, 1};
  generate_tangents(mesh, 0);
  ASSERT_EQ(mesh.positions.size(), 6u);
  ASSERT_EQ(mesh.normals.size(), 6u);
  for (const auto& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    for (const uint32_t v : t) EXPECT_NEAR(length(Vec3d(mesh.normals[v]) - normalize(cross(b - a, c - a))), 0, 1e-6);
  }
}

TEST(Tangents, NeedTheirUvSet) {
  TriangleMesh mesh = upright_square();
  generate_tangents(mesh, 1);
  EXPECT_TRUE(mesh.tangents.empty());
}

TEST(Tangents, OfOneTriangleAreTheDerivativeOfPositionByU) {
  // p(u, v) = o + a u + b v with random a, b; 10,000 cases, seed 11.
  RandomMesh random(11);
  for (int i = 0; i < 10000; ++i) {
    const Vec3d a(random.direction()), b(random.direction());
    if (length(cross(a, b)) < 0.1) continue;
    TriangleMesh mesh;
    mesh.uvs.resize(1);
    for (int k = 0; k < 3; ++k) {
      const Vec2f uv{random.uniform(), random.uniform()};
      mesh.uvs[0].push_back(uv);
      mesh.positions.push_back(Vec3f(a * double(uv.x) + b * double(uv.y)));
    }
    const auto& uv = mesh.uvs[0];
    if (std::abs((uv[1].x - uv[0].x) * (uv[2].y - uv[0].y) - (uv[2].x - uv[0].x) * (uv[1].y - uv[0].y)) < 0.05f)
      continue;
    mesh.triangles = {{0, 1, 2}};
    generate_tangents(mesh, 0);
    for (size_t k = 0; k < 3; ++k) {
      const Vec3d t = xyz(mesh.tangents[k]), n(mesh.normals[k]);
      ASSERT_NEAR(dot(t, a), 1, 1e-5);
      // The bitangent points up the image, against v.
      ASSERT_LT(dot(cross(n, t) * double(mesh.tangents[k].w), b), 0);
    }
  }
}

TEST(Tangents, AreUnitPerpendicularAndLeaveEveryCornerAsItWas) {
  RandomMesh random(5);
  for (int i = 0; i < 300; ++i) {
    const TriangleMesh before = random(3 + uint32_t(i) % 40, 1 + uint32_t(i) % 60);
    TriangleMesh mesh = before;
    generate_tangents(mesh, 1);
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    ASSERT_LE(mesh.positions.size(), 2 * before.positions.size());
    for (size_t v = 0; v < mesh.tangents.size(); ++v) {
      ASSERT_NEAR(length(xyz(mesh.tangents[v])), 1, 1e-6);
      ASSERT_NEAR(dot(xyz(mesh.tangents[v]), Vec3d(mesh.normals[v])), 0, 1e-6);
      ASSERT_EQ(std::abs(mesh.tangents[v].w), 1);
    }
    ASSERT_EQ(mesh.triangles.size(), before.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = mesh.triangles[t][k], w = before.triangles[t][k];
        ASSERT_EQ(mesh.positions[v], before.positions[w]);
        ASSERT_EQ(mesh.normals[v], before.normals[w]);
        ASSERT_EQ(mesh.colors[v], before.colors[w]);
        ASSERT_EQ(mesh.uvs[1][v], before.uvs[1][w]);
      }
  }
}

TEST(Tangents, DoNotDependOnHowVerticesAreShared) {
  RandomMesh random(6);
  for (int i = 0; i < 100; ++i) {
    TriangleMesh shared = random(12, 20);
    TriangleMesh apart = unindexed(shared);
    generate_tangents(shared, 1);
    generate_tangents(apart, 1);
    for (size_t t = 0; t < shared.triangles.size(); ++t)
      for (size_t k = 0; k < 3; ++k) {
        const Vec4f &a = shared.tangents[shared.triangles[t][k]], &b = apart.tangents[apart.triangles[t][k]];
        if (shared.uvs[1][shared.triangles[t][0]] == shared.uvs[1][shared.triangles[t][1]]) continue;  // no say
        ASSERT_NEAR(length(xyz(a) - xyz(b)), 0, 1e-6);
      }
  }
}

TEST(Tangents, TurnWithTheMesh) {
  // A rotation about (1, 1, 1) that permutes the axes is exact.
  const auto turned = [](const Vec3f& p) { return Vec3f{p.z, p.x, p.y}; };
  RandomMesh random(7);
  for (int i = 0; i < 100; ++i) {
    TriangleMesh mesh = random(12, 20), rotated = mesh;
    for (Vec3f& p : rotated.positions) p = turned(p) * 8.0f;
    for (Vec3f& n : rotated.normals) n = turned(n);
    generate_tangents(mesh, 1);
    generate_tangents(rotated, 1);
    ASSERT_EQ(mesh.tangents.size(), rotated.tangents.size());
    for (const auto& t : mesh.triangles) {
      if (mesh.uvs[1][t[0]] == mesh.uvs[1][t[1]]) continue;  // "any perpendicular" knows the axes
      for (const uint32_t v : t) {
        const Vec4f &a = mesh.tangents[v], &b = rotated.tangents[v];
        ASSERT_NEAR(length(Vec3d(turned({a.x, a.y, a.z})) - xyz(b)), 0, 1e-5);
        ASSERT_EQ(a.w, b.w);
      }
    }
  }
}

}  // namespace
}  // namespace alhazen
