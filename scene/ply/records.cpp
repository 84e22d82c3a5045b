#include "scene/ply/records.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace lambert {

namespace {

template <typename T>
double decode(const char* bytes, bool bigEndian) {
    std::array<char, sizeof(T)> copy;
    std::memcpy(copy.data(), bytes, sizeof(T));
    if (bigEndian) std::reverse(copy.begin(), copy.end()); // our machines are little-endian
    T value;
    std::memcpy(&value, copy.data(), sizeof(T));
    return static_cast<double>(value);
}

double decode(PlyType type, const char* bytes, bool bigEndian) {
    switch (type) {
    case PlyType::Int8:
        return decode<std::int8_t>(bytes, bigEndian);
    case PlyType::Uint8:
        return decode<std::uint8_t>(bytes, bigEndian);
    case PlyType::Int16:
        return decode<std::int16_t>(bytes, bigEndian);
    case PlyType::Uint16:
        return decode<std::uint16_t>(bytes, bigEndian);
    case PlyType::Int32:
        return decode<std::int32_t>(bytes, bigEndian);
    case PlyType::Uint32:
        return decode<std::uint32_t>(bytes, bigEndian);
    case PlyType::Float32:
        return decode<float>(bytes, bigEndian);
    case PlyType::Float64:
        break;
    }
    return decode<double>(bytes, bigEndian);
}

bool isSpace(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

} // namespace

PlyRecords::PlyRecords(std::string file, std::string_view content, const PlyHeader& header)
    : file_(std::move(file)), content_(content), format_(header.format), at_(header.bytes), line_(header.lines + 1) {}

void PlyRecords::read(const PlyElement& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
    numbers_.resize(element.properties.size());
    lists_.resize(element.properties.size());
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        numbers_[k] = value(property.countType.value_or(property.type));
        lists_[k].clear();
        if (!property.countType) continue;
        lists_[k].resize(listLength(property, numbers_[k]));
        for (double& entry : lists_[k]) entry = value(property.type);
    }
}

void PlyRecords::skip(const PlyElement& element) {
    const auto& properties = element.properties;
    if (properties.empty()) return; // records without a byte, however many
    const bool sameSize = std::none_of(properties.begin(), properties.end(),
                                       [](const PlyProperty& p) { return p.countType.has_value(); });
    if (format_ != PlyFormat::Ascii && sameSize) {
        std::uint64_t size = 0;
        for (const PlyProperty& property : properties) size += sizeInBytes(property.type);
        const std::uint64_t present = std::min<std::uint64_t>(element.count, remaining() / size);
        at_ += present * size;
        if (present < element.count) read(element, present); // fails
        return;
    }
    for (std::uint64_t k = 0; k < element.count; ++k) read(element, k);
}

double PlyRecords::value(PlyType type) {
    if (format_ == PlyFormat::Ascii) return textValue();
    const std::size_t size = sizeInBytes(type);
    if (remaining() < size) fail("the end of the file", fmt::format("{} more bytes", size - remaining()));
    const double result = decode(type, content_.data() + at_, format_ == PlyFormat::BinaryBigEndian);
    at_ += size;
    return result;
}

double PlyRecords::textValue() {
    for (; at_ < content_.size() && isSpace(content_[at_]); ++at_) {
        const bool endsLine =
            content_[at_] == '\n' || (content_[at_] == '\r' && !content_.substr(at_).starts_with("\r\n"));
        if (endsLine) ++line_;
    }
    const std::size_t begin = at_;
    while (at_ < content_.size() && !isSpace(content_[at_])) ++at_;
    if (begin == at_) fail("the end of the file", "a number");
    const std::string_view word = content_.substr(begin, at_ - begin);
    const std::optional<double> result = parseNumber(word);
    if (!result) fail(inQuotes(word), "a number");
    return *result;
}

/// Checked before anything is allocated for the list.
std::size_t PlyRecords::listLength(const PlyProperty& property, double length) const {
    // In text an entry takes a space and a digit.
    const std::size_t most = remaining() / (format_ == PlyFormat::Ascii ? 2 : sizeInBytes(property.type));
    if (!(length >= 0.0 && length <= static_cast<double>(most)) || length != std::floor(length))
        fail(fmt::format("{:g} as the length of {}", length, property.name),
             fmt::format("a whole number up to {}, what the file has room for", most));
    return static_cast<std::size_t>(length);
}

void PlyRecords::fail(const std::string& found, const std::string& expected) const {
    const std::string line = format_ == PlyFormat::Ascii ? fmt::format("{}:", line_) : std::string();
    throw InputError(fmt::format("{}:{} {} {}: found {}, expected {}", file_, line, oneLine(element_->name, 40), index_,
                                 found, expected));
}

} // namespace lambert
