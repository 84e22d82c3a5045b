#include "scene/mgf/transform.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <iterator>

namespace lambert {

namespace {

using Read = glm::dmat4 (*)(const MgfEntity&, std::size_t);

glm::dmat4 rotation(const MgfEntity& entity, std::size_t k, const glm::dvec3& axis) {
    return glm::rotate(glm::dmat4(1.0), glm::radians(entity.number(k)), axis);
}

struct Flag {
    std::string_view name;
    std::size_t arguments;
    Read read;
};

constexpr Flag kFlags[] = {
    {"-t", 3,
     [](const MgfEntity& e, std::size_t k) {
         return glm::translate(glm::dmat4(1.0), glm::dvec3(e.number(k), e.number(k + 1), e.number(k + 2)));
     }},
    {"-rx", 1,
     [](const MgfEntity& e, std::size_t k) {
         return rotation(e, k, {1, 0, 0});
     }},
    {"-ry", 1,
     [](const MgfEntity& e, std::size_t k) {
         return rotation(e, k, {0, 1, 0});
     }},
    {"-rz", 1,
     [](const MgfEntity& e, std::size_t k) {
         return rotation(e, k, {0, 0, 1});
     }},
    {"-s", 1,
     [](const MgfEntity& e, std::size_t k) {
         const double scale = e.number(k);
         if (scale == 0.0) e.fail(e.argument(k), "a scale other than 0");
         return glm::scale(glm::dmat4(1.0), glm::dvec3(scale));
     }},
    {"-mx", 0, [](const MgfEntity&, std::size_t) { return glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1)); }},
    {"-my", 0, [](const MgfEntity&, std::size_t) { return glm::scale(glm::dmat4(1.0), glm::dvec3(1, -1, 1)); }},
    {"-mz", 0, [](const MgfEntity&, std::size_t) { return glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1)); }},
};

glm::dmat4 power(glm::dmat4 base, std::uint64_t exponent) {
    glm::dmat4 result(1.0);
    for (; exponent > 0; exponent /= 2) {
        if (exponent % 2 == 1) result = base * result;
        base = base * base;
    }
    return result;
}

} // namespace

MgfTransform::MgfTransform(const MgfEntity& entity, std::size_t first) {
    const auto requireMore = [&](std::size_t k, std::size_t count) {
        if (k + count >= entity.argumentCount())
            entity.fail(fmt::format("{} after {}", count == 1 ? "a number" : "3 numbers", entity.argument(k)));
    };
    for (std::size_t k = first; k < entity.argumentCount(); ++k) {
        const std::string_view name = entity.argument(k);
        if (name == "-i" || name == "-a") {
            requireMore(k, 1);
            const bool isArray = name == "-a";
            const auto count = static_cast<std::uint64_t>(
                entity.integer(++k, isArray ? 1 : 0, static_cast<std::int64_t>(kMaxInstances)));
            if (isArray) {
                isArray_ = true;
                instances_ *= count;
                if (instances_ > kMaxInstances) entity.fail(fmt::format("at most {} instances", kMaxInstances));
            }
            steps_.push_back({glm::dmat4(1.0), count, isArray});
            continue;
        }
        const Flag* flag =
            std::find_if(std::begin(kFlags), std::end(kFlags), [&](const Flag& f) { return f.name == name; });
        if (flag == std::end(kFlags)) entity.fail(name, "one of -t, -rx, -ry, -rz, -s, -mx, -my, -mz, -i and -a");
        if (flag->arguments > 0) requireMore(k, flag->arguments);
        steps_.back().matrix = flag->read(entity, k + 1) * steps_.back().matrix;
        k += flag->arguments;
    }
}

glm::dmat4 MgfTransform::matrix(std::uint64_t instance) const {
    std::vector<std::uint64_t> counts(steps_.size());
    for (std::size_t k = steps_.size(); k-- > 0;) {
        counts[k] = steps_[k].isArray ? instance % steps_[k].count : steps_[k].count;
        if (steps_[k].isArray) instance /= steps_[k].count;
    }
    glm::dmat4 result(1.0);
    for (std::size_t k = 0; k < steps_.size(); ++k) result = power(steps_[k].matrix, counts[k]) * result;
    return result;
}

} // namespace lambert
