#pragma once

#include "core/error.h"
#include "core/progress.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include <unistd.h>

namespace lambert {

/// A file name of its own for each test, removed at its end.
class CheckpointFile {
public:
    CheckpointFile()
        : path_(std::filesystem::temp_directory_path() /
                (std::string("lambert_solver_") + std::to_string(getpid()) + "_" + std::to_string(++count_))) {}
    ~CheckpointFile() { std::filesystem::remove(path_); }
    CheckpointFile(const CheckpointFile&) = delete;
    CheckpointFile& operator=(const CheckpointFile&) = delete;
    const std::filesystem::path& path() const { return path_; }
    bool exists() const { return std::filesystem::exists(path_); }

private:
    static inline int count_ = 0;
    std::filesystem::path path_;
};

/// Cancels after so many units of the solve.
class CancelAfter : public Progress {
public:
    explicit CancelAfter(std::uint64_t units) : units_(units) {}

private:
    void onAdvance(std::uint64_t done, std::uint64_t /*total*/) override {
        if (done >= units_) cancel();
    }
    std::uint64_t units_;
};

/// Counts the units of a solve.
class Counting : public Progress {
public:
    std::uint64_t units() const { return units_; }

private:
    void onAdvance(std::uint64_t done, std::uint64_t /*total*/) override {
        std::uint64_t before = units_;
        while (done > before && !units_.compare_exchange_weak(before, done)) {
        }
    }
    std::atomic<std::uint64_t> units_{0};
};

/// `resume`, with the file at `path`, throws an error for it cut off or with a bit changed at any of many places; leaves the file
/// changed.
inline void expectDamageIsRefused(const std::filesystem::path& path, const std::function<void()>& resume) {
    std::ifstream source(path, std::ios::binary);
    const std::string sound((std::istreambuf_iterator<char>(source)), std::istreambuf_iterator<char>());
    ASSERT_GT(sound.size(), 1000U);
    const auto expectRefused = [&](const std::string& bytes, const std::string& what) {
        std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
        EXPECT_THROW(resume(), Error) << what;
    };
    for (std::size_t k = 0; k < 16; ++k) {
        const std::size_t at = k * sound.size() / 16 + k;
        expectRefused(sound.substr(0, at), "cut off at " + std::to_string(at));
        std::string changed = sound;
        changed[at] = static_cast<char>(changed[at] ^ (1 << (k % 8)));
        expectRefused(changed, "changed at " + std::to_string(at));
    }
    expectRefused(sound.substr(0, sound.size() - 1), "without its last byte");
    expectRefused(sound + "x", "with another byte");
}

} // namespace lambert
