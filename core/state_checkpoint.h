#pragma once

#include "core/checkpoint.h"
#include "core/error.h"
#include "core/locked_file.h"
#include "core/stopwatch.h"

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lambert {

/// Appends numbers and arrays of numbers to bytes.
class StateWriter {
public:
    explicit StateWriter(std::string& bytes) : bytes_(&bytes) {}

    template <typename Value>
    requires std::is_trivially_copyable_v<Value>
    void operator()(const Value& value) { append(&value, sizeof value); }
    template <typename Element>
    requires std::is_trivially_copyable_v<Element>
    void operator()(const std::vector<Element>& elements) {
        (*this)(elements.size());
        append(elements.data(), elements.size() * sizeof(Element));
    }
    template <typename Element>
    void operator()(const std::vector<std::vector<Element>>& lists) {
        (*this)(lists.size());
        for (const auto& list : lists) (*this)(list);
    }

private:
    void append(const void* from, std::size_t bytes) { bytes_->append(static_cast<const char*>(from), bytes); }
    std::string* bytes_;
};

/// Takes them out again, in the same order. Throws InputError where there are fewer bytes than that needs.
class StateReader {
public:
    StateReader(std::string_view bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}

    template <typename Value>
    requires std::is_trivially_copyable_v<Value>
    void operator()(Value& value) { take(&value, sizeof value); }
    template <typename Element>
    requires std::is_trivially_copyable_v<Element>
    void operator()(std::vector<Element>& elements) {
        elements.resize(count(sizeof(Element)));
        take(elements.data(), elements.size() * sizeof(Element));
    }
    template <typename Element>
    void operator()(std::vector<std::vector<Element>>& lists) {
        lists.resize(count(sizeof(std::size_t)));
        for (auto& list : lists) (*this)(list);
    }
    bool atEnd() const { return bytes_.empty(); }

private:
    /// How many elements follow, of at least `size` bytes.
    std::size_t count(std::size_t size) {
        std::size_t result = 0;
        (*this)(result);
        if (result > bytes_.size() / size) fail();
        return result;
    }
    void take(void* target, std::size_t bytes) {
        if (bytes > bytes_.size()) fail();
        if (bytes > 0) std::memcpy(target, bytes_.data(), bytes);
        bytes_.remove_prefix(bytes);
    }
    [[noreturn]] void fail() const { throw InputError(file_ + ": the checkpoint ends too early; remove it"); }

    std::string_view bytes_;
    std::string file_;
};

/// The state of unfinished work in a file, replaced as a whole now and then: what was written stays valid whatever
/// happens to the process. It is that of the machine it was written on (order of bytes, layout of numbers). While it is in
/// use, a file beside it, of its name and ".lock", is there and locked.
///
/// A state is a function that passes all that is needed to go on, in a fixed order, to what it is called with: a
/// StateWriter or a StateReader.
class StateCheckpoint {
public:
    /// `kind` names the work, as "solver"; `identity`, one line, all that it depends on. Throws UsageError if the file is there without
    /// `resume`, in use by another run or another work's, InputError if it is damaged, SystemError if it cannot be written.
    StateCheckpoint(const CheckpointOptions& options, std::string kind, std::string identity);

    /// The part of the above that needs neither identity nor lock: to be called before hours of work. Returns the path.
    static const std::filesystem::path& check(const CheckpointOptions& options);

    /// Whether there was a state, which then is set.
    template <typename State>
    bool restore(const State& state) {
        if (restored_.empty()) return false;
        StateReader reader(restored_, path_.string());
        state(reader);
        if (!reader.atEnd()) throw InputError(path_.string() + ": the checkpoint goes on after its end; remove it");
        restored_ = {};
        return true;
    }

    /// Writes the state if it is time to. Throws SystemError.
    template <typename State>
    void offer(const State& state) {
        if (watch_.seconds() >= next_) keep(state);
    }

    /// Writes the state. Throws SystemError.
    template <typename State>
    void keep(const State& state) {
        std::string bytes = begin();
        StateWriter writer(bytes);
        state(writer);
        write(std::move(bytes));
        next_ = watch_.seconds() + interval_;
    }

    /// Removes the file: the result is on the disk.
    void remove();

private:
    /// Of the file beside, as the one with the state is replaced time and again.
    struct Lock : LockedFile {
        explicit Lock(const std::filesystem::path& path) : LockedFile(path.string() + ".lock", path) {}
        ~Lock() { remove(); }
    };

    std::string begin() const;
    void write(std::string bytes) const;

    std::filesystem::path path_;
    Lock lock_;
    std::string kind_, identity_;
    double interval_, next_;
    std::string restored_; ///< empty: none, or taken
    Stopwatch watch_;
};

} // namespace lambert
