// Morph targets and skins against closed forms.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "gltf_builder.h"
#include "loaders/deform.h"
#include "core/transform.h"

namespace alhazen {
namespace {

std::mt19937 g_random(5);
float uniform(float low = -1, float high = 1) { return std::uniform_real_distribution<float>(low, high)(g_random); }
Vec3f random_vector() { return {uniform(), uniform(), uniform()}; }
Vec3f random_direction() { return Vec3f(normalize(Vec3d(random_vector()))); }

Affine3d random_rigid() {
  Affine3d m = rotate_scale({double(uniform()), double(uniform()), double(uniform()), double(uniform())}, {1, 1, 1});
  m.origin = Vec3d(random_vector());
  return m;
}

TriangleMesh random_part(size_t triangles) {
  TriangleMesh part;
  for (uint32_t i = 0; i < 3 * triangles; ++i) {
    part.positions.push_back(random_vector()), part.normals.push_back(random_direction());
    const Vec3f t = random_direction();
    part.tangents.push_back({t.x, t.y, t.z, 1});
    part.colors.push_back({0.5f, 0.5f, 0.5f, 1});
  }
  part.uvs = {std::vector<Vec2f>(part.positions.size())};
  for (uint32_t i = 0; i < triangles; ++i) part.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  return part;
}

SkinWeights random_weights(size_t vertices, uint32_t joints, size_t per_vertex) {
  SkinWeights s{per_vertex, {}, {}};
  for (size_t v = 0; v < vertices; ++v) {
    float sum = 0;
    for (size_t k = 0; k < per_vertex; ++k) {
      s.joints.push_back(uint32_t(uniform(0, float(joints) - 0.01f)));
      s.weights.push_back(uniform(0, 1)), sum += s.weights.back();
    }
    for (size_t k = v * per_vertex; k < (v + 1) * per_vertex; ++k) s.weights[k] /= sum;
  }
  return s;
}

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance);
}

TEST(Skin, JointsThatMoveAsOneMoveTheMeshRigidly) {
  for (int i = 0; i < 20; ++i) {
    const TriangleMesh rest = random_part(50);
    const Affine3d m = random_rigid();
    TriangleMesh part = rest;
    skin(part, random_weights(rest.positions.size(), 5, 8), std::vector<Affine3d>(5, m));
    for (size_t v = 0; v < rest.positions.size(); ++v) {
      expect_near(part.positions[v], Vec3f(transform_point(m, Vec3d(rest.positions[v]))), 2e-6f);
      expect_near(part.normals[v], Vec3f(transform_vector(m, Vec3d(rest.normals[v]))), 2e-6f);
      const Vec4f t = part.tangents[v], r = rest.tangents[v];
      expect_near({t.x, t.y, t.z}, Vec3f(transform_vector(m, Vec3d(r.x, r.y, r.z))), 2e-6f);
      EXPECT_EQ(t.w, 1);
    }
    EXPECT_EQ(part.triangles, rest.triangles);
  }
}

TEST(Skin, PositionsAreLinearInTheJointsMaps) {
  const TriangleMesh rest = random_part(100);
  const std::vector<Affine3d> joints{random_rigid(), random_rigid(), random_rigid()};
  const SkinWeights weights = random_weights(rest.positions.size(), 3, 4);
  TriangleMesh part = rest;
  skin(part, weights, joints);
  for (size_t v = 0; v < rest.positions.size(); ++v) {
    Vec3d expected{};
    for (size_t k = 4 * v; k < 4 * v + 4; ++k)
      expected += transform_point(joints[weights.joints[k]], Vec3d(rest.positions[v])) * double(weights.weights[k]);
    expect_near(part.positions[v], Vec3f(expected), 2e-6f);
  }
}

TEST(Skin, NormalsStayPerpendicularToTangentPlanes) {
  for (int i = 0; i < 100; ++i) {
    TriangleMesh part = random_part(1);
    const Vec3f n(
        normalize(cross(Vec3d(part.positions[1] - part.positions[0]), Vec3d(part.positions[2] - part.positions[0]))));
    part.normals.assign(3, n);
    Affine3d m = random_rigid();
    m.x = m.x * 3.0, m.y = m.y + m.z * 0.7;  // scale and shear
    skin(part, m);
    const Vec3f e1 = part.positions[1] - part.positions[0], e2 = part.positions[2] - part.positions[0];
    EXPECT_NEAR(dot(part.normals[0], e1), 0, 1e-5f);
    EXPECT_NEAR(dot(part.normals[0], e2), 0, 1e-5f);
    EXPECT_GT(dot(part.normals[0], cross(e1, e2)), 0);  // outside stays outside
    EXPECT_NEAR(dot(part.normals[0], part.normals[0]), 1, 1e-5f);
  }
}

TEST(Skin, MirrorsChangeWindingAndHandedness) {
  TriangleMesh part = random_part(1);
  const Vec3f n(
      normalize(cross(Vec3d(part.positions[1] - part.positions[0]), Vec3d(part.positions[2] - part.positions[0]))));
  part.normals.assign(3, n);
  skin(part, Affine3d{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}});
  const auto& t = part.triangles[0];
  const Vec3f e1 = part.positions[t[1]] - part.positions[t[0]], e2 = part.positions[t[2]] - part.positions[t[0]];
  EXPECT_GT(dot(part.normals[0], cross(e1, e2)), 0);
  EXPECT_EQ(part.tangents[0].w, -1);
}

MorphTarget random_target(size_t vertices, size_t touched) {
  MorphTarget target;
  for (uint32_t i = 0; i < touched; ++i) {
    const auto v = uint32_t(size_t(i) * vertices / touched);
    target.positions.vertices.push_back(v), target.positions.values.push_back(random_vector());
    target.normals.vertices.push_back(v), target.normals.values.push_back(random_vector());
    target.tangents.vertices.push_back(v), target.tangents.values.push_back(random_vector());
  }
  target.uvs = {{{0}, {{0.5f, -0.25f}}}};
  target.colors = {{0}, {{1, -1, 0.25f, 0}}};
  return target;
}

TEST(Morph, IsLinearInTheWeights) {
  const TriangleMesh rest = random_part(40);
  const size_t n = rest.positions.size();
  const std::vector<MorphTarget> targets{random_target(n, n), random_target(n, 7)};
  const auto morphed = [&](double a, double b) {
    TriangleMesh part = rest;
    morph(part, targets, std::vector{a, b});
    return part;
  };
  const TriangleMesh first = morphed(1, 0), second = morphed(0, 1);
  for (int i = 0; i < 20; ++i) {
    const float a = uniform(-2, 2), b = uniform(-2, 2);
    const TriangleMesh both = morphed(double(a), double(b));
    for (size_t v = 0; v < n; ++v) {
      const auto mixed = [&](const Vec3f& r, const Vec3f& x, const Vec3f& y) { return r + (x - r) * a + (y - r) * b; };
      expect_near(both.positions[v], mixed(rest.positions[v], first.positions[v], second.positions[v]), 1e-5f);
      expect_near(both.normals[v], mixed(rest.normals[v], first.normals[v], second.normals[v]), 1e-5f);
    }
  }
  EXPECT_EQ(morphed(0, 0).positions, rest.positions);
  EXPECT_EQ(first.uvs[0][0], (Vec2f{0.5f, -0.25f}));
  EXPECT_EQ(first.colors[0], (Vec4f{1, 0, 0.75f, 1}));  // brought back to [0, 1]
}

// ---- In files ----

/// A triangle held by one joint, node 1.
GltfBuilder skinned_triangle() {
  GltfBuilder b;
  b.mesh({{"attributes",
           {{"POSITION", b.vec3(kTriangle)},
            {"JOINTS_0", b.accessor(std::vector<uint8_t>(12, 0), "VEC4", 5121, 3)},
            {"WEIGHTS_0", b.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 5126, 3)}}}});
  b.add("nodes", {{"translation", {5, 0, 0}}});
  b.root["nodes"][0]["skin"] = 0;
  b.add("skins", {{"joints", {1}}});
  return b;
}

/// Where the mesh's first vertex is seen.
Vec3d first_vertex(const Scene& scene) {
  const MeshInstance instance = scene.geometry.mesh_instances[0];
  return transform_point(instance.world_from_object,
                         Vec3d(scene.geometry.meshes[instance.mesh].parts.at(0).positions[0]));
}

TEST(GltfSkin, TheMeshFollowsItsJointsAndNotItsNode) {
  GltfBuilder b = skinned_triangle();
  b.root["nodes"][0]["translation"] = {100, 0, 0};
  EXPECT_EQ(first_vertex(load(b).scene()), (Vec3d{5, 0, 0}));
  std::vector<float> bind(16, 0.0f);
  bind[0] = bind[5] = bind[10] = bind[15] = 1, bind[13] = 2;
  b.root["skins"][0]["inverseBindMatrices"] = b.accessor(bind, "MAT4", 5126, 1);
  EXPECT_EQ(first_vertex(load(b).scene()), (Vec3d{5, 2, 0}));
}

TEST(GltfSkin, WeightsAreMadeToSumToOne) {
  GltfBuilder b = skinned_triangle();
  b.root["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
      b.accessor(std::vector<float>{0.5f, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0}, "VEC4", 5126, 3);
  const auto positions = load(b).part().positions;
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(positions[i].x, kTriangle[3 * i] + 5);
}

TEST(GltfSkin, NodesThatShareAMeshAreHeldByTheirOwnSkins) {
  GltfBuilder b = skinned_triangle();
  b.add("nodes", {{"translation", {0, 7, 0}}});
  b.add("skins", {{"joints", {2}}});
  b.add("nodes", {{"mesh", 0}, {"skin", 1}});
  b.add("nodes", {{"mesh", 0}});
  const Loaded loaded = load(b);
  const Geometry& g = loaded.scene().geometry;
  ASSERT_EQ(g.mesh_instances.size(), 3u);
  EXPECT_EQ(g.meshes[g.mesh_instances[0].mesh].parts[0].positions[0], (Vec3f{5, 0, 0}));
  EXPECT_EQ(g.meshes[g.mesh_instances[1].mesh].parts[0].positions[0], (Vec3f{0, 7, 0}));
  EXPECT_EQ(g.meshes[g.mesh_instances[2].mesh].parts[0].positions[0], (Vec3f{0, 0, 0}));
}

TEST(GltfSkin, SecondSetsOfJointsCount) {
  GltfBuilder b = skinned_triangle();
  json& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] = b.accessor(std::vector<uint16_t>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 5123, 3);
  attributes["WEIGHTS_1"] = b.accessor(std::vector<float>{3, 0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0}, "VEC4", 5126, 3);
  b.add("nodes", {{"translation", {1, 0, 0}}});
  b.root["skins"][0]["joints"] = {1, 2};
  EXPECT_EQ(first_vertex(load(b).scene()), (Vec3d{0.25 * 5 + 0.75 * 1, 0, 0}));
}

TEST(GltfSkin, NamesThePlaceOfWhatIsWrong) {
  const auto error = [](const auto& spoil) {
    GltfBuilder b = skinned_triangle();
    spoil(b, b.root["meshes"][0]["primitives"][0]["attributes"]);
    return error_of(b.document());
  };
  const std::string attributes = "/meshes/0/primitives/0/attributes/";
  EXPECT_EQ(
      error([](GltfBuilder& b, json& a) { a["JOINTS_0"] = b.accessor(std::vector<uint8_t>(12, 1), "VEC4", 5121, 3); }),
      attributes + "JOINTS_0: joint 1 out of range, skin 0 has 1");
  EXPECT_EQ(error([](GltfBuilder&, json& a) { a.erase("WEIGHTS_0"); }),
            attributes + "JOINTS_0: `WEIGHTS_0` is missing");
  EXPECT_EQ(
      error([](GltfBuilder& b, json& a) { a["WEIGHTS_0"] = b.accessor(std::vector<float>(12, -1), "VEC4", 5126, 3); }),
      attributes + "WEIGHTS_0: expected weights >= 0, found others at vertex 0");
  EXPECT_TRUE(error([](GltfBuilder& b, json&) {
                b.root["skins"][0]["joints"] = {9};
              }).starts_with("/skins/0/joints/0: index 9 out of range"));
  EXPECT_TRUE(error([](GltfBuilder& b, json&) {
                b.root["skins"][0]["joints"] = json::array();
              }).starts_with("/skins/0/joints: expected an array of 1 or more"));
  EXPECT_TRUE(error([](GltfBuilder& b, json&) {
                b.root["skins"][0]["joints"] = {1, 0};
                b.root["skins"][0]["inverseBindMatrices"] = b.accessor(std::vector<float>(16, 1), "MAT4", 5126, 1);
              }).starts_with("/skins/0/inverseBindMatrices: expected a matrix for each of 2 joints"));
  EXPECT_TRUE(
      error([](GltfBuilder& b, json&) { b.root["nodes"][0]["skin"] = 3; }).starts_with("/nodes/0/skin: index 3"));
}

/// A triangle with a target that lifts its second vertex, sparse.
GltfBuilder morphing_triangle() {
  GltfBuilder b;
  const int index = b.view(raw_bytes(std::vector<uint16_t>{1})),
            values = b.view(raw_bytes(std::vector<float>{0, 0, 4}));
  const int sparse = b.add("accessors", {{"type", "VEC3"},
                                         {"componentType", 5126},
                                         {"count", 3},
                                         {"sparse",
                                          {{"count", 1},
                                           {"indices", {{"bufferView", index}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", values}}}}}});
  b.mesh({{"attributes", {{"POSITION", b.vec3(kTriangle)}}}, {"targets", {{{"POSITION", sparse}}}}});
  return b;
}

float lift(const GltfBuilder& b, size_t instance = 0) {
  const Scene scene = load(b).scene();
  return scene.geometry.meshes[scene.geometry.mesh_instances.mesh_of(instance)].parts.at(0).positions[1].z;
}

TEST(GltfMorph, TheNodesWeightsStandBeforeTheMeshs) {
  GltfBuilder b = morphing_triangle();
  EXPECT_EQ(lift(b), 0);
  b.root["meshes"][0]["weights"] = {0.5};
  EXPECT_EQ(lift(b), 2);
  b.root["nodes"][0]["weights"] = {0.25};
  EXPECT_EQ(lift(b), 1);
  b.add("nodes", {{"mesh", 0}});
  EXPECT_EQ(lift(b, 0), 1);
  EXPECT_EQ(lift(b, 1), 2);
}

TEST(GltfMorph, FlatNormalsAreThoseOfTheMorphedFaces) {
  GltfBuilder b = morphing_triangle();
  b.root["meshes"][0]["weights"] = {1};
  EXPECT_TRUE(load(b).part().normals.empty());  // the faces' own, wherever they lie
}

TEST(GltfMorph, AsManyWeightsAsTargetsAreExpected) {
  GltfBuilder b = morphing_triangle();
  b.root["nodes"][0]["weights"] = {1, 2};
  EXPECT_EQ(error_of(b.document()), "/nodes/0/weights: expected 1 numbers, one for each morph target, found [1,2]");
  b = morphing_triangle();
  b.root["meshes"][0]["weights"] = {1};
  json bare = b.root["meshes"][0]["primitives"][0];
  bare.erase("targets");
  b.root["meshes"][0]["primitives"].push_back(bare);
  EXPECT_EQ(error_of(b.document()),
            "/meshes/0/primitives/1: expected 1 morph targets as the mesh's first primitive has, found 0");
  b = morphing_triangle();
  b.root["meshes"][0]["weights"] = {1};
  b.root["accessors"][0]["count"] = 4;
  EXPECT_EQ(error_of(b.document()),
            "/meshes/0/primitives/0/targets/0/POSITION: expected an accessor of 3 elements as POSITION has, it has 4");
}

}  // namespace
}  // namespace alhazen
