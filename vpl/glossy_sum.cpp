#include "vpl/glossy_sum.h"

#include "scene/punctual_light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lambert {

namespace {

/// What a receiver sends to its eye of the irradiance `e` that arrives from direction ω, of unit length.
void reflectToEye(ReceiverBlockGloss& gloss, std::size_t i, const glm::dvec3& omega, const glm::dvec3& e) {
    if (gloss.scale[i] == glm::dvec3(0.0)) return;
    gloss.radiance[i] += gloss.scale[i] * phongDensity(gloss.exponent[i], glm::dot(gloss.axis[i], omega)) * e;
}

glm::dvec3 pointOf(const ReceiverBlock& block, std::size_t i) { return {block.x[i], block.y[i], block.z[i]}; }

} // namespace

bool anyGlossy(std::span<const Receiver> receivers) {
    return std::any_of(receivers.begin(), receivers.end(),
                       [](const Receiver& receiver) { return static_cast<bool>(receiver.gloss.lobe); });
}

glm::dvec3 glossyScale(const Receiver& receiver) {
    const ReceiverGloss& gloss = receiver.gloss;
    if (!gloss.lobe) return glm::dvec3(0.0);
    const double cosine = glm::dot(glm::dvec3(receiver.normal), glm::dvec3(gloss.toEye));
    return cosine > static_cast<double>(kGrazing) ? glm::dvec3(gloss.lobe.reflectance) / cosine : glm::dvec3(0.0);
}

std::unique_ptr<ReceiverBlockGloss> ReceiverBlockGloss::of(std::span<const Receiver> receivers,
                                                           std::span<const std::uint32_t> indices) {
    const auto glossy = [&](std::uint32_t i) { return static_cast<bool>(receivers[i].gloss.lobe); };
    if (std::none_of(indices.begin(), indices.end(), glossy)) return nullptr;
    auto result = std::make_unique<ReceiverBlockGloss>();
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const Receiver& receiver = receivers[indices[i]];
        result->scale[i] = glossyScale(receiver);
        if (result->scale[i] == glm::dvec3(0.0)) continue;
        result->axis[i] = glm::dvec3(mirrored(-receiver.gloss.toEye, receiver.normal));
        result->exponent[i] = static_cast<double>(receiver.gloss.lobe.exponent);
    }
    return result;
}

void addGlossy(const VirtualPointLight& light, float largest, ReceiverBlock& block) {
    const glm::dvec3 diffuse = glm::dvec3(light.flux) / std::numbers::pi;
    const glm::dvec3 glossy = glm::dvec3(light.lobe.flux) / std::numbers::pi;
    const glm::dvec3 axis(light.lobe.axis);
    const auto most = static_cast<double>(largest);
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.size); ++i) {
        if (!(block.term[i] > 0.0F)) continue;
        const glm::dvec3 way = pointOf(block, i) - glm::dvec3(light.position);
        const double squared = glm::dot(way, way);
        const glm::dvec3 omega = way / std::sqrt(squared);
        glm::dvec3 e = std::min(static_cast<double>(block.term[i]), most) * diffuse;
        if (light.lobe) {
            const double cosine = -glm::dot(glm::dvec3(block.normalX[i], block.normalY[i], block.normalZ[i]), omega);
            const double term = std::numbers::pi * cosine / squared *
                                phongDensity(static_cast<double>(light.lobe.exponent), glm::dot(axis, omega));
            const glm::dvec3 given = std::min(term, most) * glossy;
            const glm::dvec3 cut = std::max(0.0, term - most) * glossy;
            e += given;
            block.red[i] += given.x;
            block.green[i] += given.y;
            block.blue[i] += given.z;
            block.cutRed[i] += cut.x;
            block.cutGreen[i] += cut.y;
            block.cutBlue[i] += cut.z;
        }
        if (block.gloss) reflectToEye(*block.gloss, i, -omega, e);
    }
}

void addGlossy(const PunctualLight& light, ReceiverBlock& block) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.size); ++i) {
        if (!(block.term[i] > 0.0F)) continue;
        glm::dvec3 omega = -glm::dvec3(light.direction);
        if (light.kind != PunctualLight::Kind::Directional) omega = glm::dvec3(light.position) - pointOf(block, i);
        reflectToEye(*block.gloss, i, glm::normalize(omega),
                     static_cast<double>(block.term[i]) * glm::dvec3(light.intensity));
    }
}

} // namespace lambert
