#include "host/image/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "host/error.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

// A temporary file that is removed again unless `place` put it where it belongs.
struct TemporaryFile {
    fs::path path;
    int descriptor = -1;

    ~TemporaryFile() {
        if (descriptor >= 0) close(descriptor);
        if (!path.empty()) unlink(path.c_str());
    }
};

[[noreturn]] void fail_writing(const fs::path& path, int error) {
    fail_input("{}: cannot be written: {}", path.string(), std::strerror(error));
}

// What `path` leads to through symbolic links, so that renaming replaces the file and not the link to it.
fs::path destination(const fs::path& path) {
    std::error_code error;
    fs::path target = path;
    for (int links = 0; links < 40 && fs::is_symlink(fs::symlink_status(target, error)); ++links) {
        fs::path next = fs::read_symlink(target, error);
        if (error) break;
        target = next.is_absolute() ? next : target.parent_path() / next;
    }
    return target;
}

void open_beside(TemporaryFile& file, const fs::path& target, const fs::path& shown) {
    fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    for (int attempt = 0; attempt < 1000; ++attempt) {
        fs::path name =
            folder / fmt::format(".{}-{}-{}", target.filename().string().substr(0, 200), getpid(), attempt);
        file.descriptor = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file.descriptor >= 0) {
            file.path = name;
            return;
        }
        if (errno == EEXIST) continue;
        if (errno == ENOENT)
            fail_input("{}: cannot be written: there is no folder {}", shown.string(), folder.string());
        fail_writing(shown, errno);
    }
    fail_writing(shown, EEXIST);
}

void write_all(int descriptor, std::span<const std::byte> bytes, const fs::path& shown) {
    while (!bytes.empty()) {
        ssize_t written = write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail_writing(shown, written < 0 ? errno : EIO);
        bytes = bytes.subspan(size_t(written));
    }
}

// The status of what stands at `target`: st_mode is 0 where nothing does.
struct stat status_of(const fs::path& target, const fs::path& shown) {
    struct stat status {};
    if (stat(target.c_str(), &status) != 0) {
        if (errno != ENOENT) fail_writing(shown, errno);
        status.st_mode = 0;
    }
    return status;
}

bool is_special(const struct stat& status) { return status.st_mode != 0 && !S_ISREG(status.st_mode); }

}  // namespace

void check_writable(const fs::path& path) {
    if (path.empty() || path.filename().empty()) fail_input("'{}': no file name", path.string());
    fs::path target = destination(path);
    struct stat status = status_of(target, path);
    if (S_ISDIR(status.st_mode)) fail_input("{}: cannot be written: it is a folder", path.string());
    if (status.st_mode != 0 && access(target.c_str(), W_OK) != 0) fail_writing(path, errno);
    if (is_special(status)) return;
    TemporaryFile probe;
    open_beside(probe, target, path);
}

void prepare_output_folder(const fs::path& folder, const char* mark, const char* work) {
    std::error_code error;
    if (fs::exists(folder) && !fs::is_directory(folder))
        fail_input("--output {}: is no folder", folder.string());
    if (fs::exists(folder) && !fs::is_empty(folder) && !fs::exists(folder / mark))
        fail_input("--output {}: holds other files; name a new or an empty folder, or that of an earlier {}",
                   folder.string(), work);
    fs::create_directories(folder, error);
    if (error) fail_input("--output {}: cannot be made: {}", folder.string(), error.message());
    check_writable(folder / mark);
}

void write_atomically(const fs::path& path, std::span<const std::byte> bytes) {
    write_atomically(path, std::vector{bytes});
}

void write_atomically(const fs::path& path, std::string_view text) {
    write_atomically(path, std::as_bytes(std::span(text)));
}

void write_atomically(const fs::path& path, const std::vector<std::span<const std::byte>>& pieces) {
    fs::path target = destination(path);
    struct stat status = status_of(target, path);
    if (S_ISDIR(status.st_mode)) fail_input("{}: cannot be written: it is a folder", path.string());
    if (is_special(status)) {
        TemporaryFile device{.path = {}, .descriptor = open(target.c_str(), O_WRONLY | O_CLOEXEC)};
        if (device.descriptor < 0) fail_writing(path, errno);
        for (const auto& piece : pieces) write_all(device.descriptor, piece, path);
        return;
    }
    TemporaryFile file;
    open_beside(file, target, path);
    if (status.st_mode != 0 && fchmod(file.descriptor, status.st_mode & 07777) != 0)
        fail_writing(path, errno);
    for (const auto& piece : pieces) write_all(file.descriptor, piece, path);
    // Some file systems report a full disk only here.
    if (fsync(file.descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) fail_writing(path, errno);
    if (close(std::exchange(file.descriptor, -1)) != 0) fail_writing(path, errno);
    if (rename(file.path.c_str(), target.c_str()) != 0) fail_writing(path, errno);
    file.path.clear();
}

std::vector<std::byte> read_whole_file(const fs::path& path) {
    TemporaryFile file{.path = {}, .descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC)};
    if (file.descriptor < 0) fail_input("{}: cannot be read: {}", path.string(), std::strerror(errno));
    struct stat status {};
    fstat(file.descriptor, &status);
    if (S_ISDIR(status.st_mode)) fail_input("{}: cannot be read: it is a folder", path.string());
    std::vector<std::byte> bytes(S_ISREG(status.st_mode) ? size_t(status.st_size) : 0);
    size_t filled = 0;
    for (;;) {
        if (filled == bytes.size()) bytes.resize(filled + 65536);
        ssize_t got = read(file.descriptor, bytes.data() + filled, bytes.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_input("{}: cannot be read: {}", path.string(), std::strerror(errno));
        if (got == 0) break;
        filled += size_t(got);
    }
    bytes.resize(filled);
    return bytes;
}

}  // namespace etendue
