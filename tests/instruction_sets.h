#pragma once

#include "scene/rays/packet_width.h"

#include <array>
#include <cstdlib>
#include <optional>
#include <string>

namespace lambert {

/// What Embree has kernels for, as it calls them. What a processor lacks, Embree takes the best one below for.
inline constexpr std::array kInstructionSets{"sse2", "avx", "avx2", "avx512"};

/// While it lives, what casters are made traces with the kernels of an instruction set.
class InstructionSet {
public:
    explicit InstructionSet(const char* name) {
        if (const char* before = std::getenv(kEmbreeVariable); before != nullptr) before_ = before;
        setenv(kEmbreeVariable, (std::string("isa=") + name).c_str(), 1);
    }
    ~InstructionSet() {
        if (before_)
            setenv(kEmbreeVariable, before_->c_str(), 1);
        else
            unsetenv(kEmbreeVariable);
    }
    InstructionSet(const InstructionSet&) = delete;
    InstructionSet& operator=(const InstructionSet&) = delete;

private:
    std::optional<std::string> before_;
};

/// What `make()` returns under an instruction set.
template <typename Make>
auto with(const char* set, Make make) {
    const InstructionSet guard(set);
    return make();
}

} // namespace lambert
