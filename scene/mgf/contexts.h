#pragma once

#include "scene/mgf/colorimetry.h"
#include "scene/mgf/file.h"

#include <glm/vec3.hpp>

#include <string>
#include <unordered_map>
#include <utility>

namespace lambert {

/// What MGF calls a named context: values that entities set, kept under names.
template <typename Value>
class MgfContext {
public:
    /// `kind`: what a message calls it.
    explicit MgfContext(std::string kind) : kind_(std::move(kind)) {}
    MgfContext(const MgfContext&) = delete;
    MgfContext& operator=(const MgfContext&) = delete;

    /// Carries out `c`, `m` or `v`: alone (the unnamed context with its defaults), NAME, NAME =, or NAME = TEMPLATE.
    void select(const MgfEntity& entity);

    const std::string& name() const { return name_; } //!< empty: the unnamed context
    Value& current() { return *current_; }
    /// The value with the name that is argument `k`. Throws InputError if there is none.
    const Value& find(const MgfEntity& entity, std::size_t k) const;

private:
    std::string kind_;
    std::unordered_map<std::string, Value> named_;
    Value unnamed_{};
    Value* current_ = &unnamed_;
    std::string name_;
};

struct MgfColour {
    Xyz xyz = kEqualEnergyWhite; //!< of luminance 1
};

struct MgfMaterial {
    bool twoSided = true;
    double diffuseReflectance = 0.0; //!< luminous, under equal-energy white
    Xyz reflectanceColour = kEqualEnergyWhite;
    double emittance = 0.0; //!< lm/m²
    Xyz emissionColour = kEqualEnergyWhite;
    double diffuseTransmittance = 0.0;
    double specularReflectance = 0.0;
    double specularTransmittance = 0.0;
    std::uint32_t index = kNone; //!< into the scene's materials; none until a surface uses it as it is

    bool isDiffuse() const {
        return diffuseTransmittance == 0.0 && specularReflectance == 0.0 && specularTransmittance == 0.0;
    }
};

struct MgfVertex {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0}; //!< unit length, or 0: none
};

/// The current colour, material and vertex, and those with names.
class MgfContexts {
public:
    /// Carries out an entity that concerns them: false if it is another. Throws InputError.
    bool execute(const MgfEntity& entity);

    MgfMaterial& material() { return materials_.current(); }
    const std::string& materialName() const { return materials_.name(); }
    /// The vertex that argument `k` names. Throws InputError.
    const MgfVertex& vertex(const MgfEntity& entity, std::size_t k) const { return vertices_.find(entity, k); }

private:
    bool executeColour(const MgfEntity& entity);
    bool executeMaterial(const MgfEntity& entity);
    bool executeVertex(const MgfEntity& entity);
    Xyz mixture(const MgfEntity& entity) const;

    MgfContext<MgfColour> colours_{"colour"};
    MgfContext<MgfMaterial> materials_{"material"};
    MgfContext<MgfVertex> vertices_{"vertex"};
};

} // namespace lambert
