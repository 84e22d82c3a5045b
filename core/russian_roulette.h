#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>

namespace lambert {

/// Russian roulette for a quantity of three channels that is about to be multiplied by `factor` (0 to 1 each): it survives
/// with the largest factor as probability, and a survivor's weight is such that the expectation is kept in every channel.
/// J. Arvo, D. Kirk, "Particle transport and image synthesis", SIGGRAPH 1990.
class RussianRoulette {
public:
    explicit RussianRoulette(const glm::vec3& factor)
        : factor_(factor), probability_(std::max({factor.x, factor.y, factor.z, 0.0F})) {}

    float probability() const { return probability_; }
    /// `u` uniform in [0, 1).
    bool survives(float u) const { return u < probability_; }
    /// What a survivor is multiplied by; its largest channel is 1.
    glm::vec3 weight() const { return factor_ / probability_; }

private:
    glm::vec3 factor_;
    float probability_;
};

} // namespace lambert
