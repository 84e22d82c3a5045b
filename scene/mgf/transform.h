#pragma once

#include "scene/mgf/file.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <vector>

namespace lambert {

/// The transform arguments of an `xf` or `i` entity: -t, -rx, -ry, -rz, -s, -mx, -my, -mz, applied in their order;
/// `-i N` repeats what follows it, `-a N` makes N instances, with what follows applied 0 to N - 1 times.
class MgfTransform {
public:
    /// Reads the arguments from `first` on. Throws InputError.
    MgfTransform(const MgfEntity& entity, std::size_t first);

    /// The product of all arrays' sizes, 1 without arrays; at most kMaxInstances.
    std::uint64_t instances() const { return instances_; }
    bool isArray() const { return isArray_; }
    /// Of one instance; the last array's number changes fastest.
    glm::dmat4 matrix(std::uint64_t instance) const;

    static constexpr std::uint64_t kMaxInstances = 1'000'000;

private:
    struct Step {
        glm::dmat4 matrix{1.0};
        std::uint64_t count = 1; //!< applications, or the size of an array
        bool isArray = false;
    };
    std::vector<Step> steps_{Step{}};
    std::uint64_t instances_ = 1;
    bool isArray_ = false;
};

} // namespace lambert
