// Names of the user's in messages: no terminal obeys them, and none is longer than a message.
#include "wavetank/common/visible_text.h"

#include <gtest/gtest.h>

#include "wavetank/common/log.h"

namespace wavetank::visible_text_test {
namespace {

TEST(VisibleText, ShowsWhatATerminalWouldObey) {
  EXPECT_EQ(visible_text("\x1b[31mred\x1b]0;owned\x07"), "\\x1b[31mred\\x1b]0;owned\\x07");
  EXPECT_EQ(visible_text("two\nlines\r\tand\x7f"), "two\\nlines\\r\\tand\\x7f");
  EXPECT_EQ(visible_text("\xc2\x9b"
                         "2J"),
            "\\xc2\\x9b2J")
      << "the same as escape [";
  EXPECT_EQ(visible_text("a\xe2\x80\xae"
                         "b"),
            "a\\xe2\\x80\\xaeb")
      << "turns the direction of writing";
  EXPECT_EQ(visible_text("\xff\xc3"), "\\xff\\xc3") << "no UTF-8";
  for (const char* none : {"\xe0\x80\x9b", "\xed\xa0\x80", "\xf0\x80\x80\x9b", "\xf4\x90\x80\x80"})
    EXPECT_EQ(visible_text(none).substr(0, 2), "\\x") << "longer than it must be, half a pair, or beyond the last character";
  EXPECT_EQ(visible_text("\xe0\xa4\x85\xed\x9f\xbf\xf0\x9f\x8c\x8a"), "\xe0\xa4\x85\xed\x9f\xbf\xf0\x9f\x8c\x8a");
  EXPECT_EQ(visible_text("Δx = 0.02 m², “plain”"), "Δx = 0.02 m², “plain”");
  EXPECT_EQ(visible_lines("two\n\tlines\x1b"), "two\n\tlines\\x1b");
}

TEST(VisibleText, CutsWhatIsLongBetweenCharacters) {
  EXPECT_EQ(visible_text(std::string(1000, 'x'), 10), "xxxxxxxxxx…");
  EXPECT_EQ(visible_text("äääää", 5), "ää…");
  EXPECT_EQ(visible_text(std::string(200, 'x')), std::string(200, 'x'));
}

TEST(VisibleText, IsWhatTheLogSays) {
  std::string said;
  set_log_sink([&](LogLevel, const std::string& line) { said = line; });
  log(LogLevel::info, "body '\x1b[2J' sinks\nand rests");
  set_log_sink({});
  EXPECT_EQ(said, "body '\\x1b[2J' sinks\nand rests");
}

}  // namespace
}  // namespace wavetank::visible_text_test
