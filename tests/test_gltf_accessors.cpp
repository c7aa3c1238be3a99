// Accessors: what the bytes of a buffer mean.
#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <random>

#include "gltf_builder.h"
#include "loaders/gltf_accessor.h"

namespace alhazen {
namespace {

struct Type {
  const char* name;
  size_t rows, columns;
};
constexpr Type kTypes[] = {{"SCALAR", 1, 1}, {"VEC2", 2, 1}, {"VEC3", 3, 1}, {"VEC4", 4, 1},
                           {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};

/// The values of accessor 0 as floats.
std::vector<float> read_all(const json& document) {
  const TemporaryFolder folder;
  const GltfSource source = read_gltf_source(folder.write("scene.gltf", document.dump()), {});
  const GltfBuffers buffers(source);
  std::vector<uint32_t> all(buffers.accessor(0).count);
  std::iota(all.begin(), all.end(), 0u);
  return floats(buffers.accessor(0), all);
}

template <class T>
struct Component {
  static constexpr int id = std::is_same_v<T, int8_t>     ? 5120
                            : std::is_same_v<T, uint8_t>  ? 5121
                            : std::is_same_v<T, int16_t>  ? 5122
                            : std::is_same_v<T, uint16_t> ? 5123
                            : std::is_same_v<T, uint32_t> ? 5125
                                                          : 5126;
  /// The specification's section 3.11.
  static double meaning(T v, bool normalized) {
    if (!normalized || std::is_same_v<T, float>) return double(v);
    return std::max(double(v) / double(std::numeric_limits<T>::max()), -1.0);
  }
};

/// Random elements laid out by the specification's section 3.6.2.4: columns of matrices at multiples of 4 bytes.
template <class T>
struct Elements {
  std::string bytes;
  std::vector<double> meaning;

  Elements(const Type& type, size_t count, size_t gap, bool normalized, std::mt19937& rng) {
    const size_t tight = type.rows * sizeof(T), column = type.columns == 1 ? tight : (tight + 3) / 4 * 4;
    for (size_t i = 0; i < count; ++i) {
      for (size_t c = 0; c < type.columns; ++c) {
        std::vector<T> values(type.rows);
        for (T& v : values) v = T(std::is_same_v<T, float> ? double(rng()) / 1e6 - 2000 : double(T(rng())));
        if (i == 0) values[0] = std::numeric_limits<T>::lowest();
        for (const T v : values) meaning.push_back(Component<T>::meaning(v, normalized));
        bytes += raw_bytes(values) + std::string(column - tight, '\xAA');
      }
      bytes += std::string(gap, '\xBB');
    }
  }
};

template <class T>
class GltfAccessorOf : public testing::Test {};
using ComponentTypes = testing::Types<int8_t, uint8_t, int16_t, uint16_t, uint32_t, float>;
TYPED_TEST_SUITE(GltfAccessorOf, ComponentTypes);

TYPED_TEST(GltfAccessorOf, EveryShapeIsReadAsTheSpecificationSays) {
  using T = TypeParam;
  std::mt19937 rng(1);
  for (const Type& type : kTypes)
    for (const bool normalized : {false, true})
      for (const bool interleaved : {false, true}) {
        const size_t size = Elements<T>(type, 1, 0, false, rng).bytes.size();
        const size_t gap = interleaved ? 8 - size % 4 : 0;
        const Elements<T> elements(type, 7, gap, normalized, rng);
        GltfBuilder b;
        b.bytes = "12345678";
        const int view = b.view("abcd" + elements.bytes, interleaved ? int(size + gap) : 0);
        b.add("accessors", {{"bufferView", view},
                            {"byteOffset", 4},
                            {"type", type.name},
                            {"count", 7},
                            {"componentType", Component<T>::id},
                            {"normalized", normalized}});
        const std::vector<float> found = read_all(b.document());
        ASSERT_EQ(found.size(), elements.meaning.size());
        for (size_t i = 0; i < found.size(); ++i)
          ASSERT_EQ(found[i], float(elements.meaning[i])) << type.name << " component " << i;
      }
}

TYPED_TEST(GltfAccessorOf, SparseValuesReplaceThoseUnderneath) {
  using T = TypeParam;
  std::mt19937 rng(2);
  for (const Type& type : kTypes)
    for (const bool with_view : {false, true})
      for (const int index_type : {5121, 5123, 5125}) {
        const size_t n = type.rows * type.columns;
        const Elements<T> base(type, 9, 0, false, rng), replacing(type, 3, 0, false, rng);
        const std::vector<uint32_t> where{0, 4, 8};
        GltfBuilder b;
        json accessor = {{"type", type.name}, {"count", 9}, {"componentType", Component<T>::id}};
        if (with_view) accessor["bufferView"] = b.view(base.bytes);
        const std::string indices = index_type == 5121   ? raw_bytes(std::vector<uint8_t>(where.begin(), where.end()))
                                    : index_type == 5123 ? raw_bytes(std::vector<uint16_t>(where.begin(), where.end()))
                                                         : raw_bytes(where);
        accessor["sparse"] = {{"count", 3},
                              {"indices", {{"bufferView", b.view(indices)}, {"componentType", index_type}}},
                              {"values", {{"bufferView", b.view(replacing.bytes)}}}};
        b.add("accessors", accessor);
        std::vector<double> expected(9 * n);
        if (with_view) expected = base.meaning;
        for (size_t i = 0; i < where.size(); ++i)
          std::copy_n(replacing.meaning.begin() + ptrdiff_t(i * n), n, expected.begin() + ptrdiff_t(where[i] * n));
        const std::vector<float> found = read_all(b.document());
        ASSERT_EQ(found.size(), expected.size());
        for (size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], float(expected[i])) << type.name << " " << i;
      }
}

TEST(GltfAccessor, WithoutBufferViewIsZeros) {
  GltfBuilder b;
  b.add("accessors", {{"type", "VEC3"}, {"count", 4}, {"componentType", 5126}});
  EXPECT_EQ(read_all(b.document()), std::vector<float>(12, 0.0f));
}

TEST(GltfAccessor, ThatDoesNotFitItsBufferViewIsAnErrorWhateverOverflows) {
  // A view of 40 bytes: three VEC3 of floats and 4 bytes.
  const auto error = [](json patch, json view_patch = json::object()) {
    GltfBuilder b;
    b.view(std::string(40, '\0'));
    b.root["bufferViews"][0].update(view_patch);
    json a = {{"bufferView", 0}, {"type", "VEC3"}, {"count", 3}, {"componentType", 5126}};
    a.update(patch);
    b.add("accessors", a);
    return error_of(b.document());
  };
  EXPECT_EQ(error(json::object()), "");
  EXPECT_EQ(error({{"byteOffset", 4}}), "");
  EXPECT_EQ(error({{"count", 4}}),
            "/accessors/0: 4 elements, 12 bytes apart from byte 0 on, exceed the buffer view's 40 bytes");
  EXPECT_EQ(error({{"byteOffset", 8}}),
            "/accessors/0: 3 elements, 12 bytes apart from byte 8 on, exceed the buffer view's 40 bytes");
  EXPECT_TRUE(error({{"byteOffset", 9007199254740992}}).starts_with("/accessors/0: "));
  EXPECT_TRUE(error({{"count", 4294967294}}).starts_with("/accessors/0: "));
  EXPECT_TRUE(error({{"count", 4294967295}}).starts_with("/accessors/0/count: "));
  EXPECT_TRUE(error({{"count", 0}}).starts_with("/accessors/0/count: "));
  EXPECT_EQ(error(json::object(), {{"byteStride", 8}}),
            "/accessors/0: elements of 12 bytes overlap, the buffer view's byteStride is 8");
  EXPECT_EQ(error(json::object(), {{"byteStride", 16}}),
            "/accessors/0: 3 elements, 16 bytes apart from byte 0 on, exceed the buffer view's 40 bytes");
  EXPECT_EQ(error(json::object(), {{"byteOffset", 8}}),
            "/bufferViews/0: 40 bytes from byte 8 on exceed the buffer's 40 bytes");
  EXPECT_TRUE(error(json::object(), {{"byteLength", 9007199254740992}}).starts_with("/bufferViews/0: "));
  EXPECT_TRUE(error(json::object(), {{"byteOffset", 9007199254740992}}).starts_with("/bufferViews/0: "));
}

TEST(GltfAccessor, OfZerosCannotBeHuge) {
  GltfBuilder b;
  b.add("accessors", {{"type", "VEC3"}, {"count", 4000000000u}, {"componentType", 5126}});
  EXPECT_TRUE(error_of(b.document()).starts_with("/accessors/0/count: expected at most"));
}

TEST(GltfAccessor, SparseIndicesIncreaseAndStayInRange) {
  const auto error = [](const std::vector<uint8_t>& where, int count = 2) {
    GltfBuilder b;
    b.add("accessors", {{"type", "SCALAR"},
                        {"count", 5},
                        {"componentType", 5126},
                        {"sparse",
                         {{"count", count},
                          {"indices", {{"bufferView", b.view(raw_bytes(where))}, {"componentType", 5121}}},
                          {"values", {{"bufferView", b.view(std::string(8, '\0'))}}}}}});
    return error_of(b.document());
  };
  EXPECT_EQ(error({1, 4}), "");
  EXPECT_EQ(error({1, 5}), "/accessors/0/sparse/indices: index 5 out of range, the accessor has 5 elements");
  EXPECT_EQ(error({3, 3}), "/accessors/0/sparse/indices: expected increasing indices, found 3 before 3");
  EXPECT_TRUE(error({1, 4}, 6).starts_with("/accessors/0/sparse/count: expected at most"));
  EXPECT_TRUE(error({1, 4}, 3).starts_with("/accessors/0/sparse/indices: 3 elements"));
  EXPECT_TRUE(error({1, 2, 4}, 3).starts_with("/accessors/0/sparse/values: 3 elements"));
}

}  // namespace
}  // namespace alhazen
