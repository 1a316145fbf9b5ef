// What is packed comes out again, and no more than that.
#include "wavetank/parallel/packed.h"

#include <gtest/gtest.h>

#include <limits>

#include "../common/error_of.h"

namespace wavetank::parallel::packed_test {
namespace {

TEST(Packed, ComesOutAsItWentIn) {
  const double odd = -std::numeric_limits<double>::denorm_min();
  const Bytes bytes = Packed().value(odd).text("a case\n").values(std::vector<int>{}).values(std::vector<int>{3, -1}).value('x').take();
  Unpacked from(bytes);
  EXPECT_EQ(from.value<double>(), odd);
  EXPECT_EQ(from.text(), "a case\n");
  EXPECT_TRUE(from.values<int>().empty());
  EXPECT_EQ(from.values<int>(), (std::vector<int>{3, -1}));
  EXPECT_EQ(from.value<char>(), 'x');
}

TEST(Packed, IsNotReadBeyondItsEnd) {
  const std::string why = "a message between parts of the water is shorter than it must be";
  Bytes bytes = Packed().values(std::vector<double>{1, 2, 3}).take();
  bytes.pop_back();
  EXPECT_EQ(error_of([&] { Unpacked(bytes).values<double>(); }), why);
  const Bytes endless = Packed().value(std::numeric_limits<std::size_t>::max()).take();
  EXPECT_EQ(error_of([&] { Unpacked(endless).values<double>(); }), why);
  const Bytes nothing;
  EXPECT_EQ(error_of([&] { Unpacked(nothing).value<int>(); }), why);
}

}  // namespace
}  // namespace wavetank::parallel::packed_test
