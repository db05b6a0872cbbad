// Against numbers computed with 60 digits, and the equation that the responses solve.

#include "motion/phi.hpp"

#include <gtest/gtest.h>

#include <cfloat>

namespace hybrid_sphere::testing::phi_test {
namespace {

struct PhiCase {
  Complex z, first, second;
};

const PhiCase phi_cases[] = {
    {{0, 0}, {1, 0}, {0.5, 0}},
    {{1e-300, 0}, {1, 0}, {0.5, 0}},
    {{1e-08, 1e-09},
     {1.0000000050000000165, 5.0000000333333337693e-10},
     {0.50000000166666667079, 1.6666666750000001287e-10}},
    {{-0.7, 0.6},
     {0.68393084302210500039, 0.18566478804122356077},
     {0.3913497443638360621, 0.070207226538682958457}},
    {{0.999, 0.02},
     {1.7171386468754520192, 0.019984889377447023827},
     {0.71796923882901310026, 0.0056311357366033648928}},
    {{-1.0, 0.5},
     {0.61227265372998637103, 0.12976552763996123816},
     {0.36208808807199539844, 0.051278516396036461062}},
    {{0, 50},
     {-0.0052474970740785757183, 0.00070067943015773451862},
     {0.000014013588603154690372, 0.020104949941481571514}},
    {{-30, 0}, {0.033333333333330214126, 0}, {0.032222222222222326196, 0}},
    {{-3, 1000},
     {0.000044083513848270277154, 0.00097186854393851378713},
     {3.971700548092036148e-6, 0.00099994400138450745361}},
};

TEST(Phi, IsGoodToAFewUlp) {
  for (const PhiCase& c : phi_cases) {
    // The exponential, a difference and a quotient, on numbers that do not cancel.
    EXPECT_LE(std::abs(phi1(c.z) - c.first), 4 * DBL_EPSILON * std::abs(c.first)) << c.z;
    EXPECT_LE(std::abs(phi2(c.z) - c.second), 6 * DBL_EPSILON * std::abs(c.second)) << c.z;
  }
}

struct ResponseCase {
  Complex beta, gamma;
  double time;
  Complex rate, impulse, step;
};

const ResponseCase response_cases[] = {
    {{-0.3, 0},
     {-4, 0},
     2,
     {-0.44876170765798749847, 0},
     {-0.2783651723903310519, 0},
     {0.38306781484377170274, 0}},
    {{-2, 0},
     {-1, 0},
     1.5,
     {-0.11156508007421491447, 0},
     {0.3346952402226447434, 0},
     {0.44217459962892542767, 0}},
    {{-2, 0},
     {-1.000000001, 0},
     1.5,
     {-0.1115650801997256399, 0},
     {0.33469524009713401795, 0},
     {0.44217459956328296786, 0}},
    {{-2, 0},
     {-1.000000001, 0},
     0.25,
     {0.58410058728124425191, 0},
     {0.19470019576582308985, 0},
     {0.026499021160610545032, 0}},
    {{-200, 0},
     {-3, 0},
     5,
     {-0.000069596029523418679942, 0},
     {0.0046393872953112016539, 0},
     {0.024064045655761029299, 0}},
    {{-1e-9, 1e-8},
     {-1e-20, 1e-21},
     3,
     {0.99999999699999955446, 2.9999999910004496262e-8},
     {2.9999999954999995545, 4.4999999910004497667e-8},
     {4.4999999954999996658, 4.4999999932503373977e-8}},
    {{-0.1, 2},
     {-0.5, 0.3},
     0.2,
     {0.89180899657116254493, 0.38479195023006320567},
     {0.19207910871292990562, 0.039204135785441212125},
     {0.019569571788691983643, 0.0026334503077201580139}},
    {{-0.1, 2},
     {-0.5, 0.3},
     7,
     {-1.1460712888565751331, 0.042029158088446714802},
     {0.19042391804419763539, 0.51490182843273688264},
     {1.36004138690099516, 1.3906818224539467955}},
    {{-1, 0}, {-1e-30, 0}, 40, {4.2483542552905889953e-18, 0}, {0.99999999999999999575, 0}, {39, 0}},
    {{-1e-3, 500},
     {-1e-6, 0},
     10,
     {0.15312944939161124551, -0.97813600538434284023},
     {-0.0019562685832708331258, 0.0016937450137470886549},
     {3.4276978525407663406e-6, 0.020003912530230728978}},
};

TEST(LinearResponse, IsGoodForRootsThatAreApartCloseOrTiny) {
  for (const ResponseCase& c : response_cases) {
    const LinearResponse response(c.beta, c.gamma);
    const Response now = response.at(c.time);
    // The arguments of the exponentials are rounded: an error of an ulp of their size.
    const double tolerance = 4 * DBL_EPSILON * (1 + std::abs(response.larger_root()) * c.time);
    EXPECT_LE(std::abs(now.rate - c.rate), tolerance * std::abs(c.rate)) << c.beta << c.gamma;
    EXPECT_LE(std::abs(now.impulse - c.impulse), tolerance * std::abs(c.impulse)) << c.beta << c.gamma;
    EXPECT_LE(std::abs(now.step - c.step), tolerance * std::abs(c.step)) << c.beta << c.gamma;
  }
}

TEST(LinearResponse, IsRealWhereItsEquationIs) {
  for (const ResponseCase& c : response_cases) {
    if (c.beta.imag() != 0 || c.gamma.imag() != 0) continue;
    for (const double time : {1.0, 10.0, 100.0, 1000.0}) {
      const Response now = LinearResponse(c.beta, c.gamma).at(time);
      EXPECT_EQ(now.rate.imag(), 0) << c.beta << c.gamma << time;
      EXPECT_EQ(now.impulse.imag(), 0) << c.beta << c.gamma << time;
      EXPECT_EQ(now.step.imag(), 0) << c.beta << c.gamma << time;
    }
  }
}

TEST(LinearResponse, HasTheRootsOfItsEquation) {
  for (const ResponseCase& c : response_cases) {
    const LinearResponse response(c.beta, c.gamma);
    const Complex sum = response.larger_root() + response.smaller_root();
    const Complex product = response.larger_root() * response.smaller_root();
    EXPECT_LE(std::abs(sum - c.beta), 4 * DBL_EPSILON * std::abs(response.larger_root()));
    EXPECT_LE(std::abs(product + c.gamma), 4 * DBL_EPSILON * std::abs(c.gamma));
  }
}

TEST(LinearResponse, IsAParabolaWithoutBetaAndGamma) {
  const Response now = LinearResponse(0, 0).at(3);
  EXPECT_EQ(now.rate, Complex(1));
  EXPECT_EQ(now.impulse, Complex(3));
  EXPECT_EQ(now.step, Complex(4.5));
}

}  // namespace
}  // namespace hybrid_sphere::testing::phi_test
