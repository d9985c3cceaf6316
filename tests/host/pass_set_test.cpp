// Sets of passes: what they hold, lack and have in common.
#include "host/image/pass_set.h"

#include <doctest/doctest.h>

#include <random>
#include <set>

using namespace etendue;

TEST_CASE("a set of passes joins its ranges and knows what is missing") {
    PassSet set;
    CHECK(set.empty());
    CHECK(to_text(set.missing(0, 4)) == "0:4");
    set.add(PassRange{8, 16});
    set.add(PassRange{32, 33});
    set.add(PassRange{0, 8});
    CHECK(to_text(set.ranges()) == "0:16, 32:33");
    CHECK(to_text(set.missing(0, 40)) == "16:32, 33:40");
    CHECK(to_text(set.missing(4, 12)) == "");
    CHECK(to_text(set.next_missing(3, 100)) == "16:32");
    CHECK(to_text(set.next_missing(20, 4)) == "20:24");
    CHECK(to_text(set.next_missing(32, 4)) == "33:37");
    CHECK(!set.overlap(PassSet(16, 32)));
    CHECK(set.overlap(PassSet(12, 40)) == PassRange{12, 16});
    CHECK(passes_from_json(to_json(set)) == set);
}

TEST_CASE("any ranges that are apart make the set of their passes") {
    std::mt19937 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        PassSet set;
        std::set<uint64_t> expected;
        for (int i = 0; i < 30; ++i) {
            const uint64_t first = random() % 100, end = first + random() % 9;
            if (set.overlap(PassSet(first, end))) continue;
            set.add(PassRange{first, end});
            for (uint64_t pass = first; pass < end; ++pass) expected.insert(pass);
        }
        uint64_t even = 0, missing = 0;
        for (const uint64_t pass : expected) even += pass % 2 == 0;
        for (const PassRange& range : set.missing(0, 110)) missing += range.count();
        CHECK(set.count() == expected.size());
        CHECK(set.even() == even);
        CHECK(missing == 110 - expected.size());
        for (const PassRange& range : set.ranges())
            for (uint64_t pass = range.first; pass < range.end; ++pass) CHECK(expected.count(pass) == 1);
    }
}
