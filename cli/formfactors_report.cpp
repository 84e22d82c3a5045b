#include "cli/formfactors_report.h"
#include "cli/terminal_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace lambert {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kWidest = 16; ///< characters of a name at the head of a column
constexpr std::size_t kMostColumns = 12;

std::size_t widthOf(const std::string& text) { // UTF-8
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, widthOf(text)), ' ');
}

std::string shortened(const std::string& name) {
    const std::string text = printable(name);
    if (widthOf(text) <= kWidest) return text;
    std::size_t end = kWidest - 1; // not inside a character
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return text.substr(0, end) + "…";
}

std::string quoted(const std::string& name) {
    const std::string text = printable(name);
    if (text.find_first_of(",\"#") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

std::string kelvinText(const Temperatures& temperatures, const HeatFlow& heat, std::size_t group) {
    return fmt::format("{:.6g}{}", heat.kelvin[group], temperatures.surfaces[group].kelvin ? "" : "*");
}

std::string heatTable(const GroupReport& r, std::size_t nameWidth) {
    const HeatFlow& heat = *r.heat;
    std::string text = fmt::format("\n{} {:>11} {:>11} {:>14} {:>14}\n", padded("heat given off", nameWidth), "K",
                                   "emissivity", "W", "W/m²");
    bool adiabatic = false;
    for (std::size_t g = 0; g < r.factors.groups; ++g) {
        const ThermalSurface& surface = r.temperatures->surfaces[g];
        adiabatic = adiabatic || !surface.kelvin;
        text += fmt::format("{} {:>11} {:>11} {:>14.7g} {:>14.7g}\n", padded(printable(r.groups.names[g]), nameWidth),
                            kelvinText(*r.temperatures, heat, g),
                            surface.kelvin ? fmt::format("{:g}", surface.emissivity) : "-", heat.flow[g],
                            r.factors.mean(heat.flow[g], g));
    }
    text += fmt::format("{} {:>11.6g} {:>11} {:>14.7g}\n", padded("(environment)", nameWidth),
                        r.temperatures->environment, "1", heat.environmentFlow);
    text += fmt::format("{} {:>11} {:>11} {:>14.7g}\n", padded("(black backs)", nameWidth), "0", "1", heat.backFlow);
    text += fmt::format("{} {:>11} {:>11} {:>14.3g}\n", padded("sum", nameWidth), "", "", heat.imbalance());
    text +=
        fmt::format("{} {:>11} {:>11} {:>14.3g}\n", padded("before repair", nameWidth), "", "", *r.heatLostByFactors);
    if (adiabatic) text += "* adiabatic: the temperature of its mean radiosity\n";
    return text;
}

/// How far the factors of both directions are apart.
std::string reciprocityText(const GroupReport& r, const GroupReciprocity& reciprocity) {
    const double worst = r.factors.reciprocityError(reciprocity.a, reciprocity.b);
    std::string text =
        fmt::format("reciprocity: A F of both directions differ by {:.2g} % RMS", 100.0 * reciprocity.rms);
    if (worst > 0.0)
        text += fmt::format(", at most by {:.2g} % between {} and {}", 100.0 * worst,
                            printable(r.groups.names[reciprocity.a]), printable(r.groups.names[reciprocity.b]));
    return text + "\n";
}

} // namespace

std::string groupTable(const GroupReport& r) {
    const GroupFactors& f = r.factors;
    std::size_t nameWidth = 14;
    for (const std::string& name : r.groups.names) nameWidth = std::max(nameWidth, widthOf(printable(name)));
    const std::size_t columns = std::min(f.groups, kMostColumns);
    const auto table = [&](const char* title, const char* last, auto cell, auto back, auto out, auto check) {
        std::string text = fmt::format("{} {:>10}", padded(title, nameWidth), "area m²");
        for (std::size_t j = 0; j < columns; ++j) {
            const std::string name = shortened(r.groups.names[j]);
            text += "  " + std::string(std::max<std::size_t>(10, widthOf(name)) - widthOf(name), ' ') + name;
        }
        if (columns < f.groups) text += fmt::format("  … {} more", f.groups - columns);
        text += fmt::format("       (back)      (out) {:>12}\n", last);
        for (std::size_t i = 0; i < f.groups; ++i) {
            text += fmt::format("{} {:>10.5g}", padded(printable(r.groups.names[i]), nameWidth), f.area[i]);
            for (std::size_t j = 0; j < columns; ++j)
                text += fmt::format("  {:>{}.5g}", cell(i, j),
                                    std::max<std::size_t>(10, widthOf(shortened(r.groups.names[j]))));
            text += fmt::format("  {:>11.5g}{:>11.5g} {:>12}\n", back(i), out(i), check(i));
        }
        return text;
    };
    const GroupReciprocity reciprocity = groupReciprocity(f);
    std::string text = table(
        "F from \\ to", "(sum)", [&](auto i, auto j) { return f.factor(i, j); },
        [&](auto i) { return f.backFactor(i); }, [&](auto i) { return f.outFactor(i); },
        [&](auto i) { return fmt::format("{:.6f}", f.rowSum(i)); });
    text += "\n" + table(
                       "A F, m²", "(asymmetry)", [&](auto i, auto j) { return f.exchangeArea(i, j); },
                       [&](auto i) { return f.back[i]; }, [&](auto i) { return f.out[i]; },
                       [&](auto i) { return fmt::format("{:.2g} %", 100.0 * reciprocity.largest[i]); });
    text += reciprocityText(r, reciprocity);
    if (columns < f.groups) text += "all columns are in the file (-o) and in the JSON report\n";
    if (r.heat) text += heatTable(r, nameWidth);
    return text;
}

std::string groupCsv(const GroupReport& r, const std::string& comment) {
    const GroupFactors& f = r.factors;
    const GroupReciprocity reciprocity = groupReciprocity(f);
    std::string text = fmt::format("# {}\n", printable(comment));
    text += "group,area";
    for (const std::string& name : r.groups.names) text += "," + quoted("F to " + name);
    text += ",F_back,F_out";
    for (const std::string& name : r.groups.names) text += "," + quoted("AF to " + name);
    text += ",row_sum,reciprocity_error";
    if (r.heat) text += ",kelvin,emissivity,watts";
    text += "\n";
    for (std::size_t i = 0; i < f.groups; ++i) {
        text += fmt::format("{},{:.9g}", quoted(r.groups.names[i]), f.area[i]);
        for (std::size_t j = 0; j < f.groups; ++j) text += fmt::format(",{:.9g}", f.factor(i, j));
        text += fmt::format(",{:.9g},{:.9g}", f.backFactor(i), f.outFactor(i));
        for (std::size_t j = 0; j < f.groups; ++j) text += fmt::format(",{:.9g}", f.exchangeArea(i, j));
        text += fmt::format(",{:.9g},{:.3g}", f.rowSum(i), reciprocity.largest[i]);
        if (r.heat) {
            const ThermalSurface& surface = r.temperatures->surfaces[i];
            text +=
                fmt::format(",{:.9g},{},{:.9g}", r.heat->kelvin[i],
                            surface.kelvin ? fmt::format("{:.9g}", surface.emissivity) : "adiabatic", r.heat->flow[i]);
        }
        text += "\n";
    }
    return text;
}

Json groupJson(const GroupReport& r) {
    const GroupFactors& f = r.factors;
    const GroupReciprocity reciprocity = groupReciprocity(f);
    Json groups = Json::array();
    for (std::size_t i = 0; i < f.groups; ++i) {
        Json factors = Json::array(), exchange = Json::array();
        for (std::size_t j = 0; j < f.groups; ++j) {
            factors.push_back(f.factor(i, j));
            exchange.push_back(f.exchangeArea(i, j));
        }
        Json group{{"name", r.groups.names[i]}, {"area", f.area[i]},
                   {"factors", factors},        {"exchange_areas", exchange},
                   {"back", f.backFactor(i)},   {"out", f.outFactor(i)},
                   {"row_sum", f.rowSum(i)},    {"reciprocity_error", reciprocity.largest[i]}};
        if (r.heat) {
            const ThermalSurface& surface = r.temperatures->surfaces[i];
            group["adiabatic"] = !surface.kelvin.has_value();
            group["kelvin"] = r.heat->kelvin[i];
            group["emissivity"] = surface.kelvin ? Json(surface.emissivity) : Json(nullptr);
            group["watts"] = r.heat->flow[i];
        }
        groups.push_back(group);
    }
    Json json{{"groups", groups}, {"group_reciprocity", {{"rms_error", reciprocity.rms}}}};
    if (f.groups > 0) {
        json["group_reciprocity"]["worst_error"] = f.reciprocityError(reciprocity.a, reciprocity.b);
        json["group_reciprocity"]["worst_pair"] = {r.groups.names[reciprocity.a], r.groups.names[reciprocity.b]};
    }
    if (r.heat)
        json["heat_flow"] = {{"environment_kelvin", r.temperatures->environment},
                             {"environment_watts", r.heat->environmentFlow},
                             {"back_watts", r.heat->backFlow},
                             {"sum_watts", r.heat->imbalance()},
                             {"sum_watts_before_repair", *r.heatLostByFactors},
                             {"iterations", r.heat->iterations},
                             {"residual", r.heat->residual}};
    return json;
}

Json qualityJson(const MatrixQuality& q) {
    return {
        {"entries", q.entries},
        {"bytes", q.bytes},
        {"row_sums", {{"rms_error", q.closureRms}, {"worst_error", q.closureWorst}, {"worst_row", q.worstRow}}},
        {"reciprocity",
         {{"rms_error", q.reciprocityRms}, {"worst_error", q.reciprocityWorst}, {"compared_rows", q.comparedRows}}},
        {"row_error", q.largestError > 0.0 ? Json{{"mean", q.meanError}, {"largest", q.largestError}} : Json(nullptr)},
        {"back", q.back},
        {"out", q.out},
        {"covered_area", q.coveredArea}};
}

} // namespace lambert
