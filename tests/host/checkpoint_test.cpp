// Checkpoints: bit for bit there and back, and one line for each way they can be wrong.
#include "host/image/checkpoint.h"

#include <doctest/doctest.h>

#include "host/error.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

Checkpoint example() {
    Checkpoint checkpoint;
    checkpoint.identity = {{"scene", "0123456789abcdef"}, {"size", "64x48"}, {"seed", 7}};
    checkpoint.passes = PassSet(4, 16);
    checkpoint.about = {{"rays", 18446744073709551615u}, {"seconds", 0.1}};
    checkpoint.arrays = {{"mean", std::vector<std::byte>(1000, std::byte{42})}, {"empty", {}}};
    return checkpoint;
}

std::string message_of(const std::filesystem::path& path, const nlohmann::json& identity) {
    try {
        require_identity(path, read_checkpoint(path).identity, identity, "now");
    } catch (const Error& e) {
        CHECK(e.code == ExitCode::bad_input);
        return e.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("a checkpoint comes back bit for bit") {
    TemporaryFolder folder;
    Checkpoint checkpoint = example();
    write_checkpoint(folder / "c", checkpoint);
    Checkpoint back = read_checkpoint(folder / "c");
    CHECK(back.identity == checkpoint.identity);
    CHECK(back.passes == checkpoint.passes);
    CHECK(back.about == checkpoint.about);
    REQUIRE(back.arrays.size() == 2);
    CHECK(checkpoint_array(back, folder / "c", "mean", 1000) == checkpoint.arrays[0].bytes);
    CHECK(checkpoint_array(back, folder / "c", "empty", 0).empty());
    CHECK_THROWS_AS(checkpoint_array(back, folder / "c", "mean", 999), Error);
}

TEST_CASE("a checkpoint of another render is refused with the setting that differs") {
    TemporaryFolder folder;
    write_checkpoint(folder / "c", example());
    nlohmann::json other = example().identity;
    other["seed"] = 8;
    CHECK(message_of(folder / "c", other) ==
          (folder / "c").string() + ": this checkpoint is of another render: its seed is 7, now 8");
    other = example().identity;
    other.erase("size");
    CHECK(message_of(folder / "c", other).ends_with("its size is \"64x48\", now none"));
}

TEST_CASE("a damaged checkpoint is refused wherever it is cut or altered") {
    TemporaryFolder folder;
    write_checkpoint(folder / "c", example());
    std::string whole = read_text(folder / "c");
    for (size_t length = 0; length < whole.size(); length += 11) {
        write_text(folder / "cut", whole.substr(0, length));
        CHECK(message_of(folder / "cut", example().identity) != "no error");
    }
    for (size_t at = 0; at < whole.size(); ++at) {
        std::string altered = whole;
        altered[at] = char(altered[at] ^ 1);
        write_text(folder / "altered", altered);
        CHECK(message_of(folder / "altered", example().identity) != "no error");
    }
    CHECK(message_of(folder / "none", {}).find("cannot be read: No such file") != std::string::npos);
    write_text(folder / "text", "not at all");
    CHECK(message_of(folder / "text", {}).ends_with("not a checkpoint of étendue"));
    whole[8] = 1;  // the version
    write_text(folder / "old", whole);
    CHECK(message_of(folder / "old", {}).ends_with("checkpoint format 1, only 2 can be read"));
}

TEST_CASE("the hash depends on every bit, on the length and on what came before") {
    std::vector<std::byte> bytes(37);
    uint64_t plain = hash_bytes(bytes);
    for (size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        auto changed = bytes;
        changed[bit / 8] ^= std::byte(1 << bit % 8);
        CHECK(hash_bytes(changed) != plain);
    }
    CHECK(hash_bytes(std::span(bytes).first(36)) != plain);
    CHECK(hash_bytes(bytes, 1) != plain);
}
