// Which Mueller matrices are physical.
#include "host/measured/mueller_matrix.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace etendue;

TEST_CASE("matrices of sheets that exist are physical") {
    CHECK(flaw_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}).empty());
    CHECK(flaw_of({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty());          // a depolarizer
    CHECK(flaw_of({0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty());  // a polarizer
    CHECK(flaw_of({0.5, 0, 0, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5}).empty());  // a circular one
    CHECK(flaw_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0}).empty());         // a quarter-wave plate
    CHECK(flaw_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1}).empty());        // a mirror
    CHECK(flaw_of({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty());
}

TEST_CASE("others are not, though they look so") {
    // The transposition of a Jones vector's field alone: an inversion of S2. All vectors stay vectors, and
    // yet no sheet does it.
    CHECK(!flaw_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}).empty());
    CHECK(!flaw_of({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1}).empty());
    CHECK(!flaw_of({0.6, 0.6, 0, 0, 0.6, 0.6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty());  // makes light
    CHECK(!flaw_of({0.5, 0, 0, 0, 0, 0.6, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty());
    CHECK(!flaw_of({-0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty());
    CHECK(!flaw_of({0, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}).empty());
}

TEST_CASE("what is unphysical loses its negative eigenvalues, what is physical stays") {
    const MuellerMatrix polarizer = {0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    CHECK(without_excess(polarizer) == polarizer);
    // The inversion of S2 has the eigenvalues 1/2, 1/2, 1/2, -1/2.
    const MuellerMatrix inverted = without_excess({3, 0, 0, 0, 0, 3, 0, 0, 0, 0, -3, 0, 0, 0, 0, 3});
    const MuellerMatrix expected = {3, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    for (size_t k = 0; k < 16; ++k)
        CHECK(inverted[k] == doctest::Approx(expected[k]).scale(1).epsilon(1e-12));
    // Elements of every kind: near to what they were, and physical.
    MuellerMatrix m = {0.5, 0.2, 0.1, -0.3, 0.1, 0.3, 0.2, 0.1, -0.2, 0.1, 0.2, 0.4, 0.3, 0, -0.2, 0.1};
    CHECK(!flaw_of(m).empty());
    const MuellerMatrix kept = without_excess(m);
    CHECK(kept[0] == doctest::Approx(0.5));
    CHECK(flaw_of([&] {
              MuellerMatrix dimmed = kept;
              for (double& x : dimmed) x *= 0.5;
              return dimmed;
          }()) == "");
    for (size_t k = 0; k < 16; ++k) CHECK(std::fabs(kept[k] - m[k]) < 0.25);
}
