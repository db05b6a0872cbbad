#include "html/json.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/page.hpp"

namespace hybrid_sphere::testing::json_test {
namespace {

std::string inside(const std::string& quoted) { return quoted.substr(1, quoted.size() - 2); }

TEST(Json, AStringEndsNoScriptAndReadsBackAsItself) {
  for (const std::string text :
       {"</script><b>", "<!--", "a \"quoted\" \\name", "\xc3\xa9\xe2\x86\x92", "&amp;'"}) {
    const std::string quoted = html::quoted(text);
    EXPECT_EQ(quoted.find_first_of("<>&"), std::string::npos) << quoted;
    EXPECT_EQ(YAML::Load(quoted).as<std::string>(), text);
  }
  EXPECT_EQ(html::quoted("\n\xff"), "\"?\\u005cxff\"");
}

TEST(Json, TextInHtmlIsNoMarkup) {
  EXPECT_EQ(html::html_text("</title><b a='\"'>&"), "&#60;/title&#62;&#60;b a=&#39;&#34;&#39;&#62;&#38;");
}

TEST(Json, Base64IsThatOfRfc4648) {
  EXPECT_EQ(html::packed(std::vector<std::uint8_t>{}), "\"\"");
  EXPECT_EQ(html::packed(std::vector<std::uint8_t>{'f'}), "\"Zg==\"");
  EXPECT_EQ(html::packed(std::vector<std::uint8_t>{'f', 'o'}), "\"Zm8=\"");
  EXPECT_EQ(html::packed(std::vector<std::uint8_t>{'f', 'o', 'o'}), "\"Zm9v\"");
  EXPECT_EQ(html::packed(std::vector<std::uint8_t>{'f', 'o', 'o', 'b'}), "\"Zm9vYg==\"");
}

TEST(Json, NumbersReadBack) {
  const std::vector<double> times{0, 0.1, 1e6 / 3, 1e-300, -7};
  EXPECT_EQ(numbers_of<double>(inside(html::packed(times))), times);
  EXPECT_EQ(html::number(0.1), "0.1");
  EXPECT_EQ(html::number(HUGE_VAL), "null");
}

TEST(Json, FloatsHaveAnyMagnitude) {
  constexpr double half_ulp = std::numeric_limits<float>::epsilon() / 2;
  for (const double size : {1e-300, 1e-60, 1.0, 1e100, 1e300}) {
    const std::vector<double> values{size, -size / 3, 0, size * 1e-20};
    const std::vector<double> back = floats_of(YAML::Load(html::packed_floats(values)));
    ASSERT_EQ(back.size(), values.size());
    // The scale is a power of two; of 1e-320 binary64 has fewer digits than binary32.
    for (std::size_t i = 0; i < values.size(); ++i) {
      EXPECT_NEAR(back[i], values[i], half_ulp * std::abs(values[i]) + 5e-324) << size;
    }
  }
  EXPECT_EQ(floats_of(YAML::Load(html::packed_floats({HUGE_VAL, NAN, 2}))), (std::vector<double>{0, 0, 2}));
}

TEST(Json, FractionsAreStepsOfOneIn32767) {
  const std::vector<std::int16_t> back =
      numbers_of<std::int16_t>(inside(html::packed_fractions({1, -1, 0.5, 1.0000001, NAN})));
  EXPECT_EQ(back, (std::vector<std::int16_t>{32767, -32767, 16384, 32767, 0}));
}

}  // namespace
}  // namespace hybrid_sphere::testing::json_test
