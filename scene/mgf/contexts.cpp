#include "scene/mgf/contexts.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lambert {

namespace {

double numberFrom(const MgfEntity& entity, std::size_t k, double lowest, double highest, const std::string& expected) {
    const double value = entity.number(k);
    if (value < lowest || value > highest) entity.fail(entity.argument(k), expected);
    return value;
}

double share(const MgfEntity& entity, std::size_t k) { return numberFrom(entity, k, 0.0, 1.0, "a number from 0 to 1"); }

/// With luminance 1; fails if it is no colour.
Xyz normalized(const MgfEntity& entity, const Xyz& xyz) {
    constexpr double kRounding = 1e-9;
    const Xyz result = xyz / xyz.y;
    const double sum = result.x + result.z;
    if (!(xyz.y > 0.0) || !std::isfinite(sum) || result.x < -kRounding || result.z < -kRounding)
        entity.fail("a colour: visible light, none of its X, Y and Z below 0");
    return result;
}

Xyz chromaticity(const MgfEntity& entity) {
    entity.requireArguments(2, 2, "cxy x y");
    constexpr double kLeastY = 1e-3; // below the visible colours, the least of which has 0.005
    constexpr double kRounding = 1e-9;
    const double x = entity.number(0);
    const double y = entity.number(1);
    if (x < 0.0 || y < kLeastY || x + y > 1.0 + kRounding)
        entity.fail(fmt::format("cxy with x of at least 0, y of at least {}, x + y of at most 1", kLeastY));
    return xyzOfChromaticity(x, y);
}

Xyz spectrum(const MgfEntity& entity) {
    if (entity.argumentCount() < 4) entity.fail("cspec with two wavelengths and at least two values");
    const double shortest = entity.number(0);
    const double longest = entity.number(1);
    if (!(shortest > 0.0 && shortest < longest))
        entity.fail("cspec with the shortest and the longest wavelength in nm, above 0");
    std::vector<double> values;
    double largest = 0.0;
    for (std::size_t k = 2; k < entity.argumentCount(); ++k) {
        values.push_back(entity.number(k));
        largest = std::max(largest, std::abs(values.back()));
    }
    for (double& value : values) value /= largest; // its scale has no meaning, but could overflow
    return xyzOfSpectrum(shortest, longest, values);
}

} // namespace

template <typename Value>
void MgfContext<Value>::select(const MgfEntity& entity) {
    const std::size_t count = entity.argumentCount();
    if (count == 0) {
        unnamed_ = Value{};
        current_ = &unnamed_;
        name_.clear();
        return;
    }
    if (count > 3 || (count > 1 && entity.argument(1) != "="))
        entity.fail(fmt::format("{0}, {0} NAME, {0} NAME = or {0} NAME = TEMPLATE", entity.keyword()));
    Value value{};
    if (count != 2) value = find(entity, count - 1);
    name_ = entity.argument(0);
    current_ = &named_[name_];
    if (count > 1) *current_ = std::move(value);
}

template <typename Value>
const Value& MgfContext<Value>::find(const MgfEntity& entity, std::size_t k) const {
    const auto found = named_.find(std::string(entity.argument(k)));
    if (found == named_.end()) entity.fail(entity.argument(k), fmt::format("a {} that is defined before", kind_));
    return found->second;
}

bool MgfContexts::execute(const MgfEntity& entity) {
    return executeVertex(entity) || executeColour(entity) || executeMaterial(entity);
}

bool MgfContexts::executeColour(const MgfEntity& entity) {
    const std::string_view keyword = entity.keyword();
    Xyz& xyz = colours_.current().xyz;
    if (keyword == "c") {
        colours_.select(entity);
    } else if (keyword == "cxy") {
        xyz = normalized(entity, chromaticity(entity));
    } else if (keyword == "cspec") {
        xyz = normalized(entity, spectrum(entity));
    } else if (keyword == "cct") {
        entity.requireArguments(1, 1, "cct KELVIN");
        xyz = normalized(entity, xyzOfBlackBody(numberFrom(entity, 0, 100.0, 1e9, "100 to 1e9 kelvin")));
    } else if (keyword == "cmix") {
        xyz = normalized(entity, mixture(entity));
    } else {
        return false;
    }
    return true;
}

/// The weights are luminances, so that the colours themselves add up.
Xyz MgfContexts::mixture(const MgfEntity& entity) const {
    const std::size_t count = entity.argumentCount();
    if (count < 2 || count % 2 != 0) entity.fail("cmix with pairs of a weight and a colour");
    Xyz sum(0.0);
    for (std::size_t k = 0; k < count; k += 2) {
        const double weight = numberFrom(entity, k, 0.0, 1e100, "a weight of 0 or more");
        sum += weight * colours_.find(entity, k + 1).xyz;
    }
    return sum;
}

bool MgfContexts::executeMaterial(const MgfEntity& entity) {
    const std::string_view keyword = entity.keyword();
    MgfMaterial& material = materials_.current();
    if (keyword == "m") {
        materials_.select(entity);
    } else if (keyword == "sides") {
        entity.requireArguments(1, 1, "sides 1 or sides 2");
        material.twoSided = entity.integer(0, 1, 2) == 2;
    } else if (keyword == "rd") {
        entity.requireArguments(1, 1, "rd REFLECTANCE");
        material.diffuseReflectance = share(entity, 0);
        material.reflectanceColour = colours_.current().xyz;
    } else if (keyword == "ed") {
        entity.requireArguments(1, 1, "ed EMITTANCE");
        material.emittance = numberFrom(entity, 0, 0.0, 1e30, "lm/m² from 0 to 1e30");
        material.emissionColour = colours_.current().xyz;
    } else if (keyword == "td") {
        entity.requireArguments(1, 1, "td TRANSMITTANCE");
        material.diffuseTransmittance = share(entity, 0);
    } else if (keyword == "rs" || keyword == "ts") {
        entity.requireArguments(2, 2, fmt::format("{} SHARE ROUGHNESS", keyword));
        (keyword == "rs" ? material.specularReflectance : material.specularTransmittance) = share(entity, 0);
        numberFrom(entity, 1, 0.0, 1e30, "a roughness of 0 or more");
    } else if (keyword == "ir") { // of mirrors and glass
        entity.requireArguments(2, 2, "ir REAL IMAGINARY");
        entity.number(0);
        entity.number(1);
    } else {
        return false;
    }
    if (keyword != "m" || entity.argumentCount() > 1) materials_.current().index = kNone;
    return true;
}

bool MgfContexts::executeVertex(const MgfEntity& entity) {
    const std::string_view keyword = entity.keyword();
    if (keyword == "v") {
        vertices_.select(entity);
    } else if (keyword == "p" || keyword == "n") {
        entity.requireArguments(3, 3, fmt::format("{} x y z", keyword));
        const glm::dvec3 value(entity.number(0), entity.number(1), entity.number(2));
        if (keyword == "p") {
            vertices_.current().point = value;
        } else {
            const double largest = std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)});
            vertices_.current().normal = largest > 0.0 ? glm::normalize(value / largest) : glm::dvec3(0.0);
        }
    } else {
        return false;
    }
    return true;
}

template class MgfContext<MgfColour>;
template class MgfContext<MgfMaterial>;
template class MgfContext<MgfVertex>;

} // namespace lambert
