#include "core/state_checkpoint.h"

#include "core/checksum.h"
#include "core/whole_file.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace lambert {

namespace {

std::uint64_t checksumOf(std::string_view bytes) {
    Checksum sum;
    sum.add(bytes);
    return sum.value();
}

} // namespace

const std::filesystem::path& StateCheckpoint::check(const CheckpointOptions& options) {
    std::error_code ignored;
    if (std::filesystem::exists(options.path, ignored) && !options.resume)
        throw UsageError(fmt::format("--checkpoint: {} is there already; go on with it by --resume, or remove it",
                                     options.path.string()));
    requireWritable(options.path);
    return options.path;
}

StateCheckpoint::StateCheckpoint(const CheckpointOptions& options, std::string kind, std::string identity)
    : path_(check(options)),
      lock_(path_),
      kind_(std::move(kind)),
      identity_(std::move(identity)),
      interval_(options.seconds),
      next_(options.seconds) {
    std::ifstream file(path_, std::ios::binary);
    if (!file) return;
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (file.bad()) throw SystemError(fmt::format("{}: cannot read the checkpoint", path_.string()));
    const std::string magic = begin().substr(0, begin().size() - identity_.size() - 1);
    if (!bytes.starts_with(magic))
        throw UsageError(fmt::format("--resume: {} is no checkpoint of a {} of this version", path_.string(), kind_));
    const std::string expected = begin();
    if (!bytes.starts_with(expected))
        throw UsageError(
            fmt::format("--resume: {} is of another scene, other options or another version: found \"{}\", "
                        "this run is \"{}\"",
                        path_.string(), bytes.substr(magic.size(), bytes.find('\n') - magic.size()), identity_));
    std::uint64_t stored = 0;
    if (bytes.size() < expected.size() + sizeof stored)
        throw InputError(fmt::format("{}: the checkpoint ends too early; remove it", path_.string()));
    std::memcpy(&stored, bytes.data() + bytes.size() - sizeof stored, sizeof stored);
    bytes.resize(bytes.size() - sizeof stored);
    if (stored != checksumOf(bytes))
        throw InputError(fmt::format("{}: the checkpoint is damaged; remove it", path_.string()));
    restored_ = bytes.substr(expected.size());
}

std::string StateCheckpoint::begin() const { return fmt::format("Lambert {} checkpoint 2: {}\n", kind_, identity_); }

void StateCheckpoint::write(std::string bytes) const {
    const std::uint64_t sum = checksumOf(bytes);
    StateWriter{bytes}(sum);
    writeWholeFile(path_, bytes);
}

void StateCheckpoint::remove() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

} // namespace lambert
