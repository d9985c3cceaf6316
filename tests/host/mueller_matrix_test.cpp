// Which Mueller matrices are physical.
#include "host/scene/mueller_matrix.h"

#include <doctest/doctest.h>

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
