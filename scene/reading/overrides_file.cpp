#include "scene/reading/overrides_file.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace lambert {

namespace {

using Json = nlohmann::ordered_json; // of two patterns that meet the same material the later one counts

constexpr double kLargestRadiance = 1e30;
constexpr double kLargestReflectance = 0.99;
constexpr std::size_t kDeepest = 100;

/// A value with the path that leads to it.
class Member {
public:
    Member(const std::string& file, const Json& value, Json::json_pointer path)
        : file_(file), value_(value), path_(std::move(path)) {}

    OverrideSource source() const { return {fmt::format("{}: {}", file_, path_.to_string()), true}; }

    [[noreturn]] void fail(const std::string& allowed) const {
        const std::string found = value_.dump(-1, ' ', false, Json::error_handler_t::replace);
        failAtMember(file_, path_.to_string(), inQuotes(found), allowed);
    }

    bool boolean() const {
        if (!value_.is_boolean()) fail("true or false");
        return value_.get<bool>();
    }

    double length() const {
        constexpr const char* kAllowed = "a number of metres above 0";
        if (!value_.is_number()) fail(kAllowed);
        const auto number = value_.get<double>();
        if (!(number > 0.0) || !std::isfinite(number)) fail(kAllowed);
        return number;
    }

    Rgb colour(double largest) const {
        const std::string allowed = fmt::format("[r, g, b], three numbers from 0 to {:g}", largest);
        if (!value_.is_array() || value_.size() != 3) fail(allowed);
        Rgb result(0.0F);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!value_[k].is_number()) fail(allowed);
            const auto number = value_[k].get<double>();
            if (!(number >= 0.0 && number <= largest)) fail(allowed);
            result[static_cast<int>(k)] = static_cast<float>(number);
        }
        return result;
    }

    std::string text() const {
        if (!value_.is_string()) fail("a name");
        return value_.get<std::string>();
    }

    /// Calls `use` with the key and the member for each member of an object.
    template <typename Use>
    void forEachMember(Use&& use) const {
        if (!value_.is_object()) fail("an object { ... }");
        for (const auto& [key, value] : value_.items()) use(key, Member(file_, value, path_ / key));
    }

    /// The same for the elements of a list.
    template <typename Use>
    void forEachElement(Use&& use) const {
        if (!value_.is_array()) fail("a list of names [ ... ]");
        for (std::size_t k = 0; k < value_.size(); ++k) use(Member(file_, value_[k], path_ / k));
    }

    [[noreturn]] void failAsUnknownKey(const std::string& allowed) const {
        throw InputError(fmt::format("{}: {}: not known here, allowed are {}", file_, path_.to_string(), allowed));
    }

private:
    const std::string& file_;
    const Json& value_;
    Json::json_pointer path_;
};

MaterialOverride readMaterial(const std::string& name, const Member& member) {
    MaterialOverride change;
    change.name = name;
    change.source = member.source();
    member.forEachMember([&](const std::string& key, const Member& value) {
        if (key == "emit")
            change.emittedRadiance = value.colour(kLargestRadiance);
        else if (key == "reflectance")
            change.reflectance = value.colour(kLargestReflectance);
        else if (key == "two_sided")
            change.twoSided = value.boolean();
        else
            value.failAsUnknownKey("emit, reflectance and two_sided");
    });
    return change;
}

void readNodes(const Member& list, NodeOverride::Treatment treatment, SceneOverrides& overrides) {
    list.forEachElement([&](const Member& name) {
        overrides.nodes.push_back({name.text(), name.source(), treatment});
    });
}

/// The parsed file. Nesting is bounded: no key of ours needs it, and every level costs the parser memory.
Json parse(const std::string& file, const std::string& text) {
    try {
        return Json::parse(text, [&](int depth, Json::parse_event_t, Json&) {
            if (depth > static_cast<int>(kDeepest)) throw InputError(file + ": nested too deeply");
            return true;
        });
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: not valid JSON: {}", file, oneLine(error.what())));
    }
}

} // namespace

OverridesFile readOverridesFile(const std::filesystem::path& path) {
    using Treatment = NodeOverride::Treatment;
    const std::string file = path.string();
    const Json document = parse(file, readInputFile(path));
    OverridesFile result;
    Member(file, document, Json::json_pointer()).forEachMember([&](const std::string& key, const Member& value) {
        if (key == "unit")
            result.metresPerUnit = value.length();
        else if (key == "two_sided")
            result.twoSided = value.boolean();
        else if (key == "materials")
            value.forEachMember([&](const std::string& name, const Member& material) {
                result.overrides.materials.push_back(readMaterial(name, material));
            });
        else if (key == "exclude")
            readNodes(value, Treatment::Exclude, result.overrides);
        else if (key == "occlude_only")
            readNodes(value, Treatment::OccludeOnly, result.overrides);
        else
            value.failAsUnknownKey("unit, two_sided, materials, exclude and occlude_only");
    });
    // Whatever their order in the file: what is excluded is not there.
    std::stable_sort(result.overrides.nodes.begin(), result.overrides.nodes.end(),
                     [](const NodeOverride& a, const NodeOverride& b) {
                         return a.treatment == Treatment::OccludeOnly && b.treatment == Treatment::Exclude;
                     });
    return result;
}

std::filesystem::path overridesFileBeside(const std::filesystem::path& scene) {
    std::filesystem::path result = scene;
    return result.replace_extension(".lambert.json");
}

} // namespace lambert
