#include "materials/byte_tables.h"

namespace alhazen {
namespace {

template <class Decode>
std::array<float, 256> table_of(const Decode& decode) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) table[size_t(i)] = decode(float(i) / 255);
  return table;
}

}  // namespace

const std::array<std::array<float, 256>, 2> kLightOfByte = {table_of([](float x) { return x; }),
                                                            table_of(linear_from_srgb)};

}  // namespace alhazen
