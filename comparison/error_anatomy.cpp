#include "comparison/error_anatomy.h"

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lambert {

namespace {

using Field = std::vector<RgbSum>;

/// Sums over pairs of runs that statistics are made of, some runs left out.
class Pairs {
public:
    /// (a of run s, b of run t), #runs × #runs.
    using Table = std::vector<std::vector<double>>;

    Pairs(std::size_t runs, std::size_t without) : runs_(runs), without_(without) {}

    /// Mean over the runs of (a, b).
    double same(const Table& table) const {
        double sum = 0.0;
        for (std::size_t s = 0; s < runs_; ++s)
            if (s != without_) sum += table[s][s];
        return sum / count();
    }
    /// Mean over pairs of different runs; of a single run the same as above.
    double different(const Table& table) const {
        if (count() < 2.0) return same(table);
        double sum = 0.0;
        for (std::size_t s = 0; s < runs_; ++s)
            for (std::size_t t = 0; t < runs_; ++t)
                if (s != t && s != without_ && t != without_) sum += table[s][t];
        return sum / (count() * (count() - 1.0));
    }
    double mean(const std::vector<double>& values) const {
        double sum = 0.0;
        for (std::size_t s = 0; s < runs_; ++s)
            if (s != without_) sum += values[s];
        return sum / count();
    }

private:
    double count() const { return static_cast<double>(runs_) - (without_ < runs_ ? 1.0 : 0.0); }
    std::size_t runs_, without_;
};

/// A part in all runs, with its products.
struct PartTables {
    Pairs::Table withError; ///< (error of run s, part of run t)
    Pairs::Table withItself;
    std::vector<double> mean; ///< #runs, over receivers and channels
};

class Products {
public:
    explicit Products(std::span<const double> weight) : weight_(weight) {
        for (const double w : weight) total_ += 3.0 * w;
    }
    double of(const Field& a, const Field& b) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i)
            sum += weight_[i] * (a[i].x * b[i].x + a[i].y * b[i].y + a[i].z * b[i].z);
        return sum / total_;
    }
    double mean(const Field& a) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += weight_[i] * (a[i].x + a[i].y + a[i].z);
        return sum / total_;
    }
    Pairs::Table table(const std::vector<Field>& a, const std::vector<Field>& b) const {
        Pairs::Table result(a.size(), std::vector<double>(b.size()));
        for (std::size_t s = 0; s < a.size(); ++s)
            for (std::size_t t = 0; t < b.size(); ++t) result[s][t] = of(a[s], b[t]);
        return result;
    }
    PartTables part(const std::vector<Field>& error, const std::vector<Field>& part) const {
        PartTables result{table(error, part), table(part, part), {}};
        for (const Field& field : part) result.mean.push_back(mean(field));
        return result;
    }

private:
    std::span<const double> weight_;
    double total_ = 0.0;
};

std::vector<Field> differences(std::span<const std::vector<Field>> runs, std::size_t first,
                               const std::vector<Field>& minus) {
    std::vector<Field> result;
    for (std::size_t s = 0; s < runs.size(); ++s) {
        Field field = runs[s][first];
        for (std::size_t i = 0; i < field.size(); ++i) field[i] -= minus[s][i];
        result.push_back(std::move(field));
    }
    return result;
}

/// What the parts amount to without one of the runs, or (without >= #runs) with all.
struct Figures {
    double rms = 0.0;
    std::vector<double> share, size, bias, without;
};

Figures figures(const Pairs::Table& error, const std::vector<PartTables>& parts, std::size_t leftOut) {
    const Pairs pairs(error.size(), leftOut);
    Figures result;
    const double squared = pairs.same(error);
    const double systematic = pairs.different(error);
    result.rms = std::sqrt(squared);
    const auto add = [&](double product, double size, double bias) {
        result.share.push_back(squared > 0.0 ? product / squared : 0.0);
        result.size.push_back(std::sqrt(std::max(0.0, size)));
        result.bias.push_back(bias);
        result.without.push_back(std::sqrt(std::max(0.0, squared - 2.0 * product + size)));
    };
    add(squared - systematic, squared - systematic, 0.0);
    for (const PartTables& part : parts)
        add(pairs.different(part.withError), pairs.different(part.withItself), pairs.mean(part.mean));
    return result;
}

/// Standard error of a figure by the jackknife.
template <typename Of>
double standardError(const std::vector<Figures>& leaveOneOut, Of of) {
    const auto count = static_cast<double>(leaveOneOut.size());
    if (count < 3.0) return 0.0;
    double mean = 0.0;
    double squares = 0.0;
    for (const Figures& f : leaveOneOut) mean += of(f) / count;
    for (const Figures& f : leaveOneOut) squares += (of(f) - mean) * (of(f) - mean);
    return std::sqrt((count - 1.0) / count * squares);
}

float sizeOf(const RgbSum& value) { return static_cast<float>(std::sqrt(glm::dot(value, value) / 3.0)); }

} // namespace

std::vector<std::vector<float>> partSizes(std::span<const RgbSum> reference,
                                          std::span<const std::vector<std::vector<RgbSum>>> runs) {
    const auto count = static_cast<double>(runs.size());
    const std::size_t steps = runs.front().size();
    std::vector<std::vector<float>> sizes(steps + 1, std::vector<float>(reference.size()));
    for (std::size_t i = 0; i < reference.size(); ++i) {
        std::vector<RgbSum> mean(steps, RgbSum(0.0));
        for (const auto& run : runs)
            for (std::size_t k = 0; k < steps; ++k) mean[k] += run[k][i] / count;
        RgbSum squares(0.0);
        for (const auto& run : runs) squares += (run[0][i] - mean[0]) * (run[0][i] - mean[0]);
        sizes[0][i] = sizeOf(glm::sqrt(squares / std::max(1.0, count - 1.0)));
        for (std::size_t k = 0; k + 1 < steps; ++k) sizes[k + 1][i] = sizeOf(mean[k] - mean[k + 1]);
        sizes[steps][i] = sizeOf(mean.back() - reference[i]);
    }
    return sizes;
}

ErrorAnatomy errorAnatomy(std::span<const double> weight, std::span<const RgbSum> reference, double ownError,
                          std::span<const std::vector<std::vector<RgbSum>>> runs,
                          std::span<const Approximation> approximations, const Approximation& sampling) {
    const Products products(weight);
    const std::vector<Field> same(runs.size(), Field(reference.begin(), reference.end()));
    const std::vector<Field> error = differences(runs, 0, same);
    const Pairs::Table errors = products.table(error, error);
    std::vector<PartTables> parts;
    for (std::size_t k = 0; k < approximations.size(); ++k) {
        std::vector<Field> next;
        for (const auto& run : runs) next.push_back(run[k + 1]);
        parts.push_back(products.part(error, differences(runs, k, next)));
    }
    parts.push_back(products.part(error, differences(runs, approximations.size(), same)));

    const Figures all = figures(errors, parts, runs.size());
    std::vector<Figures> leaveOneOut;
    for (std::size_t s = 0; s < runs.size() && runs.size() > 2; ++s) leaveOneOut.push_back(figures(errors, parts, s));

    ErrorAnatomy anatomy;
    anatomy.rms = all.rms;
    anatomy.rmsError = standardError(leaveOneOut, [](const Figures& f) { return f.rms; });
    const auto part = [&](std::size_t k, const Approximation& approximation) {
        return ErrorPart{
            approximation, all.share[k], standardError(leaveOneOut, [k](const Figures& f) { return f.share[k]; }),
            all.size[k],   all.bias[k],  standardError(leaveOneOut, [k](const Figures& f) { return f.bias[k]; }),
            all.without[k]};
    };
    anatomy.parts.push_back(part(0, sampling));
    for (std::size_t k = 0; k < approximations.size(); ++k) anatomy.parts.push_back(part(k + 1, approximations[k]));
    ErrorPart& left = anatomy.parts.emplace_back(part(approximations.size() + 1, {"unexplained", "", ""}));
    // |(e, δ)| / |e|² is at most |δ| / |e|.
    if (anatomy.rms > 0.0) left.shareError = std::hypot(left.shareError, ownError / anatomy.rms);
    return anatomy;
}

} // namespace lambert
