// ALHAZEN_shapes: what each kind of shape reads as, and what is said of each mistake.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace alhazen {
namespace {

const std::string kShapes = "/extensions/ALHAZEN_shapes/shapes";

json with_shapes(json shapes) {
  GltfBuilder b;
  b.root["extensionsUsed"] = {"ALHAZEN_shapes"};
  b.root["extensions"]["ALHAZEN_shapes"]["shapes"] = std::move(shapes);
  b.root["nodes"] = {{{"extensions", {{"ALHAZEN_shapes", {{"shape", 0}}}}}}};
  return b.document();
}

/// What is said of a lone shape, after the pointer to it.
std::string error(json shape) {
  const std::string what = error_of(with_shapes(json::array({std::move(shape)})));
  const std::string at = kShapes + "/0";
  return what.starts_with(at) ? what.substr(at.size()) : what;
}

Shape read(json shape) { return load_json(with_shapes(json::array({std::move(shape)}))).scene().geometry.shapes.at(0); }

json body(const char* key, json fields = json::object()) { return {{key, std::move(fields)}}; }

const json kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
const json kEllipsoid = {1, 2, 3, 0, 0, 0, 0, 0, 0, -1};
const json kBounds = {{"min", {-1, -1, -1}}, {"max", {1, 1, 1}}};

TEST(GltfShapes, HaveTheStatedDefaults) {
  EXPECT_EQ(std::get<Sphere>(read(body("sphere"))).radius, 1);
  const auto cylinder = std::get<Cylinder>(read(body("cylinder")));
  EXPECT_EQ(cylinder.height, 1);
  EXPECT_EQ(cylinder.radius_bottom, 0.5);
  EXPECT_EQ(cylinder.radius_top, 0.5);
  EXPECT_TRUE(cylinder.caps);
  const auto disk = std::get<Disk>(read(body("disk")));
  EXPECT_EQ(disk.radius, 1);
  EXPECT_EQ(disk.inner_radius, 0);
  EXPECT_EQ(std::get<Box>(read(body("box"))).size, (Vec3d{1, 1, 1}));
  EXPECT_FALSE(std::get<Quadric>(read(body("quadric", {{"coefficients", kEllipsoid}, {"bounds", kBounds}}))).solid);
}

TEST(GltfShapes, KeepTheirNumbersInDouble) {
  EXPECT_EQ(std::get<Sphere>(read(body("sphere", {{"radius", 0.1}}))).radius, 0.1);
  EXPECT_EQ(std::get<Box>(read(body("box", {{"size", {0.1, 0.2, 0.3}}}))).size, (Vec3d{0.1, 0.2, 0.3}));
}

TEST(GltfShapes, CylindersHaveRadiiOfWhichOneMayBeZero) {
  EXPECT_EQ(error(body("cylinder", {{"radiusTop", 0}})), "");
  EXPECT_EQ(error(body("cylinder", {{"radiusBottom", 0}})), "");
  EXPECT_EQ(error(body("cylinder", {{"radiusTop", 0}, {"radiusBottom", 0}})),
            "/cylinder: radiusBottom and radiusTop are both 0, expected at most one to be");
  EXPECT_EQ(error(body("cylinder", {{"radiusTop", -1}})),
            "/cylinder/radiusTop: expected a finite number >= 0, found -1");
  EXPECT_EQ(error(body("cylinder", {{"height", 0}})), "/cylinder/height: expected a finite number > 0, found 0");
  EXPECT_EQ(error(body("cylinder", {{"caps", 1}})), "/cylinder/caps: expected true or false, found 1");
  EXPECT_EQ(error(body("cylinder", {{"radius", 1}})),
            "/cylinder/radius: unknown key, expected one of height, radiusBottom, radiusTop, caps");
}

TEST(GltfShapes, DisksHaveAnInnerRadiusBelowTheOuter) {
  EXPECT_EQ(error(body("disk", {{"radius", 2}, {"innerRadius", 1.5}})), "");
  EXPECT_EQ(error(body("disk", {{"innerRadius", 1}})),
            "/disk/innerRadius: expected a number less than the radius, found 1");
  EXPECT_EQ(error(body("disk", {{"innerRadius", -0.1}})),
            "/disk/innerRadius: expected a finite number >= 0, found -0.1");
}

TEST(GltfShapes, BoxesHaveThreeSizesAboveZero) {
  EXPECT_EQ(error(body("box", {{"size", {1, 2}}})), "/box/size: expected an array of 3 numbers, found [1,2]");
  EXPECT_EQ(error(body("box", {{"size", {1, 0, 2}}})), "/box/size/1: expected a finite number > 0, found 0");
  EXPECT_EQ(error(body("box", {{"size", {1, nullptr, 2}}})), "/box/size/1: expected a finite number, found null");
}

TEST(GltfShapes, PolygonsNameTheLoopThatIsNone) {
  const json square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(error(body("polygon", {{"loops", {square}}})), "");
  EXPECT_EQ(error(body("polygon")), "/polygon: `loops` is missing");
  EXPECT_EQ(error(body("polygon", {{"loops", json::array()}})),
            "/polygon/loops: expected an array of 1 or more, found []");
  EXPECT_EQ(error(body("polygon", {{"loops", {{{0, 0, 0}, {1, 0, 0}}}}})),
            "/polygon/loops/0: expected an array of 3 or more, found [[0,0,0],[1,0,0]]");
  EXPECT_EQ(error(body("polygon", {{"loops", {{{0, 0, 0}, {1, 0}, {1, 1, 0}}}}})),
            "/polygon/loops/0/1: expected an array of 3 numbers, found [1,0]");
  const auto at_loop = [&](const json& loop) {
    return error(body("polygon", {{"loops", json::array({square, loop})}})).starts_with("/polygon/loops/1: ");
  };
  EXPECT_TRUE(at_loop({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}));
  EXPECT_TRUE(at_loop({{0, 0, 0}, {1, 1, 0}, {0, 0, 0}}));
  EXPECT_TRUE(at_loop({{0, 0, 0.1}, {1, 0, 0}, {0, 1, 0}}));
  const json eight = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};  // two triangles of opposite turn
  EXPECT_TRUE(error(body("polygon", {{"loops", json::array({eight})}})).starts_with("/polygon/loops/0: "));
}

TEST(GltfShapes, QuadricsNeedBoundsUnlessTheyAreEllipsoids) {
  EXPECT_EQ(error(body("quadric", {{"coefficients", kEllipsoid}})), "");
  EXPECT_EQ(error(body("quadric", {{"coefficients", {-1, -1, -1, 0, 0, 0, 0, 0, 0, 1}}})), "");
  EXPECT_EQ(error(body("quadric", {{"coefficients", {1, 1, 1, 0, 0, 0, 0, 0, 0, 1}}})), "");  // empty, never hit
  EXPECT_EQ(error(body("quadric", {{"coefficients", {1, 0, 1, 0, 0, 0, 0, 0, 0, -1}}})),
            "/quadric: `bounds` is missing, and only ellipsoids (A ... F definite) can do without");
  EXPECT_EQ(error(body("quadric", {{"coefficients", {1, 1, 1, 1, 0, 0, 0, 0, 0, -1}}})),  // semidefinite
            "/quadric: `bounds` is missing, and only ellipsoids (A ... F definite) can do without");
  EXPECT_EQ(error(body("quadric", {{"coefficients", {-1, -1, -1, 0, 0, 0, 0, 0, 0, 1}}, {"solid", true}})),
            "/quadric: `bounds` is missing, and f < 0 outside of the ellipsoid: expected `bounds` or the other sign");
}

TEST(GltfShapes, QuadricsNeedTenCoefficientsNotAllZero) {
  EXPECT_EQ(error(body("quadric", {{"coefficients", {1, 2}}})),
            "/quadric/coefficients: expected an array of 10 numbers, found [1,2]");
  EXPECT_EQ(error(body("quadric", {{"coefficients", json(std::vector<int>(10, 0))}, {"bounds", kBounds}})),
            "/quadric/coefficients: all are 0, expected one that is not");
  EXPECT_EQ(error(body("quadric")), "/quadric: `coefficients` is missing");
  json bounds = kBounds;
  bounds["max"][1] = -1;
  EXPECT_EQ(error(body("quadric", {{"coefficients", kEllipsoid}, {"bounds", bounds}})),
            "/quadric/bounds/max/1: expected a number greater than -1, found -1");
  EXPECT_EQ(error(body("quadric", {{"coefficients", kEllipsoid}, {"bounds", {{"min", {0, 0, 0}}}}})),
            "/quadric/bounds: `max` is missing");
}

/// A composite of one operation over the shapes after it.
std::string composite_error(json composite, std::vector<json> others) {
  json shapes = json::array({{{"composite", std::move(composite)}}});
  for (json& other : others) shapes.push_back(std::move(other));
  const std::string what = error_of(with_shapes(shapes));
  return what.starts_with(kShapes) ? what.substr(kShapes.size()) : what;
}

json lens(const json& matrix = kIdentity) {
  return {{"operation", "intersection"}, {"operands", {{{"shape", 1}}, {{"shape", 1}, {"matrix", matrix}}}}};
}

TEST(GltfShapes, CompositesAreMadeOfClosedBodies) {
  for (const json& closed :
       {body("sphere"), body("box"), body("cylinder"), body("quadric", {{"coefficients", kEllipsoid}}),
        body("quadric", {{"coefficients", kEllipsoid}, {"bounds", kBounds}, {"solid", true}})})
    EXPECT_EQ(composite_error(lens(), {closed}), "") << closed;
  for (const json& open : {body("disk"), body("cylinder", {{"caps", false}}),
                           body("quadric", {{"coefficients", kEllipsoid}, {"bounds", kBounds}}),
                           body("quadric", {{"coefficients", {-1, -1, -1, 0, 0, 0, 0, 0, 0, 1}}}),
                           body("polygon", {{"loops", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}}})})
    EXPECT_TRUE(composite_error(lens(), {open})
                    .starts_with("/0/composite/operands/0/shape: shape 1 is not a closed body, expected a sphere"))
        << open;
}

TEST(GltfShapes, CompositesHaveOperationsOperandsAndMatrices) {
  const std::vector<json> sphere{body("sphere")};
  json composite = lens();
  composite["operation"] = "xor";
  EXPECT_EQ(composite_error(composite, sphere),
            "/0/composite/operation: expected one of union, intersection, difference, found \"xor\"");
  composite = lens();
  composite["operands"] = json::array();
  EXPECT_EQ(composite_error(composite, sphere), "/0/composite/operands: expected an array of 1 or more, found []");
  composite = lens();
  composite["operands"][0]["shape"] = 2;
  EXPECT_EQ(composite_error(composite, sphere),
            "/0/composite/operands/0/shape: index 2 out of range, " + kShapes + " has 2");
  json matrix = kIdentity;
  matrix[0] = 0;
  EXPECT_EQ(composite_error(lens(matrix), sphere),
            "/0/composite/operands/1/matrix: expected a matrix that can be inverted");
  matrix = kIdentity;
  matrix[3] = 1;
  EXPECT_EQ(composite_error(lens(matrix), sphere),
            "/0/composite/operands/1/matrix: expected the last row to be 0, 0, 0, 1");
}

TEST(GltfShapes, CompositesHaveNoCyclesAndDoNotExplode) {
  json self = lens();
  self["operands"][0]["shape"] = 0;
  EXPECT_EQ(composite_error(self, {body("sphere")}), "/0/composite/operands/0/shape: shape 0 is an operand of itself");
  // Each level unites the next with itself: 2^30 bodies from 31 shapes, too much for the memory that so small a file
  // may ask for.
  json bomb = json::array();
  for (int k = 0; k < 30; ++k)
    bomb.push_back({{"composite", {{"operation", "union"}, {"operands", {{{"shape", k + 1}}, {{"shape", k + 1}}}}}}});
  bomb.push_back(body("sphere"));
  EXPECT_TRUE(error_of(with_shapes(bomb)).ends_with("--max-memory raises the limit"));
  json chain = json::array();
  for (int k = 0; k < 1000; ++k)
    chain.push_back({{"composite", {{"operation", "union"}, {"operands", {{{"shape", k + 1}}}}}}});
  chain.push_back(body("sphere"));
  EXPECT_TRUE(error_of(with_shapes(chain)).ends_with("composites are nested more than 128 deep"));
}

TEST(GltfShapes, MayBeNone) {
  json document = with_shapes(json::array());
  document.erase("nodes");
  EXPECT_TRUE(load_json(document).scene().geometry.shapes.empty());
  document["extensions"]["ALHAZEN_shapes"] = json::object();
  EXPECT_TRUE(load_json(document).scene().geometry.shapes.empty());
}

TEST(GltfShapes, ArePlacedByInvertibleMatricesOnly) {
  json document = with_shapes(json::array({body("box")}));
  document["nodes"][0]["scale"] = {1, 0, 1};
  EXPECT_EQ(error_of(document), "/nodes/0: places a shape by a global matrix that cannot be inverted");
}

}  // namespace
}  // namespace alhazen
