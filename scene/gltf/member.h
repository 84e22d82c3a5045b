#pragma once

#include "core/text.h"
#include "scene/gltf/document.h"

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lambert::gltf {

/// A value of a document, and its place there. Everything that reads it throws InputError with file and JSON path where it
/// has another type than what it is read into.
class Member {
public:
    /// Both must outlive it, as all that it is a member of.
    Member(const std::string& file, const nlohmann::json& document) : file_(file), value_(document) {}
    Member(const Member& parent, std::string_view key, const nlohmann::json& value)
        : file_(parent.file_), value_(value), parent_(&parent), key_(key) {}
    Member(const Member& parent, std::size_t index, const nlohmann::json& value)
        : file_(parent.file_), value_(value), parent_(&parent), index_(index) {}

    const nlohmann::json& operator*() const { return value_; }
    const nlohmann::json* operator->() const { return &value_; }

    void require(bool holds, std::string_view allowed) const {
        if (!holds) failAtMember(file_, path(), shortForm(), std::string(allowed));
    }

    /// The member of an object; none where it is missing.
    std::optional<Member> find(const char* name) const {
        require(value_.is_object(), "an object");
        const auto found = value_.find(name);
        return found == value_.end() ? std::nullopt : std::optional<Member>(std::in_place, *this, name, *found);
    }

    /// The extension of an object, itself one; none where it is missing.
    std::optional<Member> extension(const char* name) const {
        const auto extensions = find("extensions");
        auto found = extensions ? extensions->find(name) : std::nullopt;
        if (!found) return std::nullopt;
        found->parent_ = this;
        found->before_ = "extensions/";
        found->require(found->value_.is_object(), "an object");
        return found;
    }

    /// Pairs of a member's name and where it goes, which keeps its value where the object lacks the member.
    template <typename Value, typename... Pairs>
    void read(const char* name, Value& value, Pairs&&... pairs) const {
        if (const auto member = find(name)) take(*member, value);
        if constexpr (sizeof...(pairs) > 0) read(pairs...);
    }
    /// The same of members that must be there.
    template <typename Value, typename... Pairs>
    void need(const char* name, Value& value, Pairs&&... pairs) const {
        static const nlohmann::json kNothing(nlohmann::json::value_t::discarded);
        const auto member = find(name);
        take(member ? *member : Member(*this, name, kNothing), value);
        if constexpr (sizeof...(pairs) > 0) need(pairs...);
    }

    bool isUpTo(std::uint64_t largest) const {
        return value_.is_number_unsigned() && value_.get<std::uint64_t>() <= largest;
    }
    void readNumbers(double* numbers, std::size_t count) const {
        require(value_.is_array() && value_.size() == count &&
                    std::all_of(value_.begin(), value_.end(), [](const auto& element) { return element.is_number(); }),
                fmt::format("{} numbers", count));
        std::copy(value_.begin(), value_.end(), numbers);
    }

private:
    std::string path() const {
        if (parent_ == nullptr) return {};
        return fmt::format("{}/{}{}", parent_->path(), before_, index_ ? std::to_string(*index_) : oneLine(key_, 60));
    }
    std::string shortForm() const {
        if (value_.is_discarded()) return "nothing";
        if (value_.is_array() && value_.size() > 16) return fmt::format("an array of {}", value_.size());
        if (value_.is_object()) return "an object";
        return oneLine(value_.dump(), 60);
    }

    const std::string& file_;
    const nlohmann::json& value_;
    const Member* parent_ = nullptr;
    const char* before_ = ""; //!< the key
    std::string_view key_;
    std::optional<std::size_t> index_;
};

inline void take(const Member& member, bool& value) {
    member.require(member->is_boolean(), "true or false");
    value = member->get<bool>();
}
inline void take(const Member& member, std::string& value) {
    member.require(member->is_string(), "a string");
    value = member->get<std::string>();
}
inline void take(const Member& member, double& value) {
    member.require(member->is_number(), "a number");
    value = member->get<double>();
}
inline void take(const Member& member, int& value) {
    member.require(member.isUpTo(2147483647), "an integer of 0 to 2147483647");
    value = member->get<int>();
}
inline void take(const Member& member, std::size_t& value) {
    member.require(member->is_number_unsigned(), "an integer of at least 0");
    value = member->get<std::size_t>();
}
template <glm::length_t Length>
void take(const Member& member, glm::vec<Length, double>& value) {
    member.readNumbers(glm::value_ptr(value), static_cast<std::size_t>(Length));
}
inline void take(const Member& member, glm::dmat4& value) { member.readNumbers(glm::value_ptr(value), 16); }
inline void take(const Member& member, std::map<std::string, int>& value) {
    member.require(member->is_object(), "an object");
    for (const auto& [key, element] : member->items()) take(Member(member, key, element), value[key]);
}
template <typename Element>
void take(const Member& member, std::vector<Element>& value) {
    member.require(member->is_array(), "an array");
    for (std::size_t k = 0; k < member->size(); ++k) take(Member(member, k, (*member)[k]), value.emplace_back());
}
template <typename Value>
void take(const Member& member, std::optional<Value>& value) {
    take(member, value.emplace());
}

} // namespace lambert::gltf
