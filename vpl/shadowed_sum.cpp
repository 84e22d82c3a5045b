#include "vpl/shadowed_sum.h"

#include "core/parallel.h"
#include "core/vector_clones.h"
#include "scene/punctual_light.h"
#include "vpl/glossy_sum.h"
#include "vpl/receiver_block.h"
#include "vpl/receiver_order.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace lambert {

namespace {

constexpr std::size_t kLightsPerReport = 1024;
/// G between a light and all receivers of a block.
LAMBERT_VECTOR_CLONES
void geometricTerms(const VirtualPointLight& light, ReceiverBlock& block) {
    const glm::vec3 p = light.position;
    const glm::vec3 n = light.normal;
    const int size = block.size;
#pragma GCC ivdep
    for (int i = 0; i < size; ++i) {
        const float dx = block.x[i] - p.x;
        const float dy = block.y[i] - p.y;
        const float dz = block.z[i] - p.z;
        const float squared = dx * dx + dy * dy + dz * dz;
        const float inverse = 1.0F / std::sqrt(squared > 0.0F ? squared : 1.0F);
        const float atLight = (n.x * dx + n.y * dy + n.z * dz) * inverse;
        const float atReceiver = -(block.normalX[i] * dx + block.normalY[i] * dy + block.normalZ[i] * dz) * inverse;
        const float term = (atLight * inverse) * (atReceiver * inverse);
        block.term[i] = atLight > kGrazing && atReceiver > kGrazing ? term : 0.0F;
    }
}

/// The places in a block at which light may arrive; returns their number.
LAMBERT_VECTOR_CLONES
int findLit(ReceiverBlock& block) {
    int count = 0;
    for (int i = 0; i < block.size; ++i) {
        block.lit[count] = static_cast<std::uint16_t>(i);
        count += block.term[i] > 0.0F ? 1 : 0;
    }
    return count;
}

/// Adds what arrives from a light whose terms are now 0 in the shadow. `share` is Φ/π.
LAMBERT_VECTOR_CLONES
void addLight(const glm::vec3& share, float largest, ReceiverBlock& block) {
    const double r = static_cast<double>(share.x);
    const double g = static_cast<double>(share.y);
    const double b = static_cast<double>(share.z);
    const int size = block.size;
#pragma GCC ivdep
    for (int i = 0; i < size; ++i) {
        const float term = block.term[i] < largest ? block.term[i] : largest;
        const auto bounded = static_cast<double>(term);
        block.red[i] += r * bounded;
        block.green[i] += g * bounded;
        block.blue[i] += b * bounded;
    }
}

/// Adds what the bound takes away. Apart, because it is rare.
void addCut(const glm::vec3& share, float largest, ReceiverBlock& block) {
    for (int i = 0; i < block.size; ++i) {
        if (!(block.term[i] > largest)) continue;
        const double cut = static_cast<double>(block.term[i]) - static_cast<double>(largest);
        block.cutRed[i] += cut * static_cast<double>(share.x);
        block.cutGreen[i] += cut * static_cast<double>(share.y);
        block.cutBlue[i] += cut * static_cast<double>(share.z);
    }
}

LAMBERT_VECTOR_CLONES
float largestTermOf(const ReceiverBlock& block) {
    float largest = 0.0F;
    for (int i = 0; i < block.size; ++i) largest = block.term[i] > largest ? block.term[i] : largest;
    return largest;
}

/// Makes the rays of one kind of light to receivers of a block.
class BundleFrom {
public:
    /// From a point; the same origin for all.
    BundleFrom(const ReceiverBlock& block, const glm::vec3& origin) : block_(block), origin_(origin) {
        std::fill_n(packet.originX, kLanes, origin.x);
        std::fill_n(packet.originY, kLanes, origin.y);
        std::fill_n(packet.originZ, kLanes, origin.z);
        std::fill_n(packet.maxDistance, kLanes, 1.0F);
        std::fill_n(packet.active, kLanes, -1);
    }
    void fill(const std::uint16_t* places, int count) {
        for (int lane = 0; lane < kLanes; ++lane) {
            // Lanes past the end repeat the last ray, inactive.
            const int i = places[lane < count ? lane : count - 1];
            packet.directionX[lane] = block_.endX[i] - origin_.x;
            packet.directionY[lane] = block_.endY[i] - origin_.y;
            packet.directionZ[lane] = block_.endZ[i] - origin_.z;
            packet.active[lane] = lane < count ? -1 : 0;
        }
    }
    ShadowPacket packet;

private:
    const ReceiverBlock& block_;
    glm::vec3 origin_;
};

/// From receivers toward a light without area.
class BundleTo {
public:
    BundleTo(const ReceiverBlock& block, const PunctualLight& light, float length, float endGap)
        : block_(block), light_(light), length_(length), endGap_(endGap) {}
    void fill(const std::uint16_t* places, int count) {
        const bool directional = light_.kind == PunctualLight::Kind::Directional;
        for (int lane = 0; lane < kLanes; ++lane) {
            const int i = places[lane < count ? lane : count - 1];
            const glm::vec3 origin(block_.endX[i], block_.endY[i], block_.endZ[i]);
            const glm::vec3 direction = directional ? -length_ * light_.direction : light_.position - origin;
            const float distance = glm::length(direction);
            packet.set(lane, {origin, direction, directional ? 1.0F : std::max(0.0F, 1.0F - endGap_ / distance)},
                       lane < count && distance > 0.0F);
        }
    }
    ShadowPacket packet;

private:
    const ReceiverBlock& block_;
    const PunctualLight& light_;
    float length_, endGap_; ///< a light in a ceiling's plane is not behind it
};

/// Traces what findLit found and takes the light away from what lies in the shadow. Returns the number of rays.
template <typename Bundle>
int castShadows(const RayCaster& rays, Bundle& bundle, ReceiverBlock& block) {
    const int count = findLit(block);
    for (int first = 0; first < count; first += kLanes) {
        const int lanes = std::min(kLanes, count - first);
        bundle.fill(block.lit + first, lanes);
        rays.occluded(bundle.packet);
        for (int lane = 0; lane < lanes; ++lane)
            if (bundle.packet.occluded[lane]) block.term[block.lit[first + lane]] = 0.0F;
    }
    return count;
}

int addVirtualLight(const RayCaster& rays, const VirtualPointLight& light, float largest, ReceiverBlock& block) {
    geometricTerms(light, block);
    BundleFrom bundle(block, light.position + light.lift * light.normal);
    const int count = light.castsShadows ? castShadows(rays, bundle, block) : 0;
    const glm::vec3 share = light.flux / std::numbers::pi_v<float>;
    addLight(share, largest, block);
    if (largestTermOf(block) > largest) addCut(share, largest, block);
    if (light.lobe || block.gloss) addGlossy(light, largest, block);
    return count;
}

/// E_0 of a light without area: the term takes cosθ/d² times a spot's falloff, in units of the intensity.
int addPunctualLight(const RayCaster& rays, const PunctualLight& light, ReceiverBlock& block) {
    PunctualLight white = light;
    white.intensity = Rgb(1.0F);
    for (int i = 0; i < block.size; ++i) {
        const glm::dvec3 normal(block.normalX[i], block.normalY[i], block.normalZ[i]);
        glm::dvec3 way(light.direction);
        double squared = 1.0;
        if (light.kind != PunctualLight::Kind::Directional) {
            way = glm::dvec3(block.x[i], block.y[i], block.z[i]) - glm::dvec3(light.position);
            squared = glm::dot(way, way);
            if (squared > 0.0) way /= std::sqrt(squared);
        }
        const double cosine = -glm::dot(normal, way);
        block.term[i] = cosine > 0.0 && squared > 0.0
                            ? intensityToward(white, glm::vec3(way)).x * static_cast<float>(cosine / squared)
                            : 0.0F;
    }
    BundleTo bundle(block, light, 2.0F * rays.bounds().diagonal(), rays.originOffset(0.0F));
    const int count = castShadows(rays, bundle, block);
    addLight(light.intensity, std::numeric_limits<float>::infinity(), block);
    if (block.gloss) addGlossy(light, block);
    return count;
}

/// Receivers per block: few enough for all threads to have work, as long as a packet is full.
std::size_t blockSize(std::size_t receivers) {
    const std::size_t wanted = receivers / 64 / kLanes * kLanes;
    return std::clamp(wanted, static_cast<std::size_t>(kLanes), kMostInBlock);
}

} // namespace

ShadowedSum sumLights(const RayCaster& rays, const ShadowedLights& lights, std::span<const Receiver> receivers,
                      double largestTerm, Progress& progress) {
    ShadowedSum sum;
    sum.irradiance.resize(receivers.size());
    sum.cut.resize(receivers.size());
    if (anyGlossy(receivers)) sum.glossyRadiance.resize(receivers.size());
    const std::vector<std::uint32_t> order = receiverOrder(receivers);
    const std::size_t perBlock = blockSize(receivers.size());
    const auto largest = static_cast<float>(largestTerm);
    std::atomic<std::uint64_t> rayCount{0};
    parallelFor((receivers.size() + perBlock - 1) / perBlock, 1, [&](std::size_t begin, std::size_t end, int) {
        const auto block = std::make_unique<ReceiverBlock>();
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t first = b * perBlock;
            const auto indices = std::span(order).subspan(first, std::min(perBlock, order.size() - first));
            block->load(receivers, indices);
            std::uint64_t count = 0;
            for (const PunctualLight& light : lights.punctual)
                count += static_cast<std::uint64_t>(addPunctualLight(rays, light, *block));
            const auto& points = lights.virtualLights;
            for (std::size_t from = 0; from < points.size(); from += kLightsPerReport) {
                const auto some = points.subspan(from, std::min(kLightsPerReport, points.size() - from));
                for (const VirtualPointLight& light : some)
                    count += static_cast<std::uint64_t>(addVirtualLight(rays, light, largest, *block));
                progress.advance(some.size() * indices.size());
            }
            for (std::size_t i = 0; i < indices.size(); ++i) {
                sum.irradiance[indices[i]] = {block->red[i], block->green[i], block->blue[i]};
                sum.cut[indices[i]] = {block->cutRed[i], block->cutGreen[i], block->cutBlue[i]};
                if (block->gloss) sum.glossyRadiance[indices[i]] = block->gloss->radiance[i];
            }
            rayCount += count;
        }
    });
    sum.rays = rayCount;
    return sum;
}

} // namespace lambert
