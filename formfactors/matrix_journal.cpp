#include "formfactors/matrix_journal.h"

#include "core/checksum.h"
#include "core/error.h"
#include "core/state_checkpoint.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

namespace lambert {

namespace {

constexpr std::string_view kMagic = "Lambert checkpoint 1: ";
constexpr std::size_t kLongestHeader = 4096;
constexpr std::size_t kBlock = 4 << 20;

/// Before each row.
struct RecordHeader {
    std::uint32_t patch, bytes;
    std::uint64_t checksum; ///< of both and the row
};

std::uint64_t checksumOf(std::uint32_t patch, std::span<const std::byte> row) {
    Checksum sum;
    sum.add(std::uint64_t{patch});
    sum.add(row);
    return sum.value();
}

/// Whether all could be read from that place.
bool readAt(int file, void* target, std::size_t bytes, std::uint64_t place) {
    auto* at = static_cast<char*>(target);
    while (bytes > 0) {
        const ssize_t got = ::pread(file, at, bytes, static_cast<off_t>(place));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        bytes -= static_cast<std::size_t>(got);
        place += static_cast<std::uint64_t>(got);
    }
    return true;
}

} // namespace

MatrixJournal::MatrixJournal(const CheckpointOptions& options, const std::string& identity)
    : path_(StateCheckpoint::check(options)),
      interval_(options.seconds),
      file_(path_, path_),
      nextWrite_(options.seconds) {
    struct stat status {};
    if (::fstat(file_.descriptor(), &status) != 0) fail(errno);
    if (status.st_size == 0)
        writeHeader(identity);
    else
        readHeader(identity);
}

void MatrixJournal::fail(int error) const {
    throw SystemError(fmt::format("{}: cannot write the checkpoint: {}", path_.string(), std::strerror(error)));
}

void MatrixJournal::writeHeader(const std::string& identity) {
    const std::string header = fmt::format("{}{}\n", kMagic, identity);
    const auto bytes = std::as_bytes(std::span(header));
    writeAll({bytes.begin(), bytes.end()});
    firstRow_ = header.size();
}

void MatrixJournal::readHeader(const std::string& identity) {
    std::string header(kLongestHeader, '\0');
    const ssize_t got = ::pread(file_.descriptor(), header.data(), header.size(), 0);
    if (got < 0) fail(errno);
    header.resize(static_cast<std::size_t>(got));
    const std::string expected = fmt::format("{}{}\n", kMagic, identity);
    if (expected.starts_with(header)) { // the process died while it wrote this
        if (::ftruncate(file_.descriptor(), 0) != 0) fail(errno);
        writeHeader(identity);
        return;
    }
    if (!header.starts_with(kMagic))
        throw UsageError(fmt::format("--checkpoint: {} is no checkpoint of this version", path_.string()));
    if (!header.starts_with(expected)) {
        const std::string found = header.substr(kMagic.size(), header.find('\n') - kMagic.size());
        throw UsageError(
            fmt::format("--resume: {} is of another scene, other options or another version: found \"{}\", "
                        "this run is \"{}\"",
                        path_.string(), found, identity));
    }
    firstRow_ = expected.size();
}

std::vector<bool> MatrixJournal::restore(FormFactorMatrix& matrix) {
    std::vector<bool> restored(matrix.size(), false);
    std::vector<std::byte> row;
    std::uint64_t place = firstRow_;
    for (RecordHeader header{}; readAt(file_.descriptor(), &header, sizeof header, place);) {
        if (header.patch >= matrix.size() || header.bytes > 16 * matrix.size() + 64) break;
        row.resize(header.bytes);
        if (!readAt(file_.descriptor(), row.data(), row.size(), place + sizeof header)) break;
        if (header.checksum != checksumOf(header.patch, row) || !matrix.setBytes(header.patch, row)) break;
        if (!restored[header.patch]) ++restored_;
        restored[header.patch] = true;
        place += sizeof header + row.size();
    }
    if (::ftruncate(file_.descriptor(), static_cast<off_t>(place)) != 0 || ::lseek(file_.descriptor(), 0, SEEK_END) < 0)
        fail(errno);
    return restored;
}

void MatrixJournal::add(const FormFactorMatrix& matrix, std::size_t patch) {
    {
        const std::lock_guard lock(pendingMutex_);
        pending_.push_back(static_cast<std::uint32_t>(patch));
    }
    const double now = watch_.seconds();
    double due = nextWrite_.load();
    // Whoever moves the time writes; the others go on.
    if (now >= due && nextWrite_.compare_exchange_strong(due, now + interval_)) flush(matrix);
}

void MatrixJournal::flush(const FormFactorMatrix& matrix) {
    const std::lock_guard fileLock(fileMutex_);
    std::vector<std::uint32_t> rows;
    {
        const std::lock_guard lock(pendingMutex_);
        rows.swap(pending_);
    }
    std::vector<std::byte> block;
    for (const std::uint32_t patch : rows) {
        const std::size_t start = block.size();
        block.resize(start + sizeof(RecordHeader));
        matrix.appendBytes(patch, block);
        const std::span row = std::span(block).subspan(start + sizeof(RecordHeader));
        const RecordHeader header{patch, static_cast<std::uint32_t>(row.size()), checksumOf(patch, row)};
        std::memcpy(block.data() + start, &header, sizeof header);
        if (block.size() >= kBlock) {
            writeAll(block);
            block.clear();
        }
    }
    writeAll(block);
    if (::fdatasync(file_.descriptor()) != 0) fail(errno);
}

void MatrixJournal::writeAll(const std::vector<std::byte>& bytes) {
    const std::byte* at = bytes.data();
    for (std::size_t left = bytes.size(); left > 0;) {
        const ssize_t written = ::write(file_.descriptor(), at, left);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail(written < 0 ? errno : EIO);
        at += written;
        left -= static_cast<std::size_t>(written);
    }
}

} // namespace lambert
