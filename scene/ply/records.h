#pragma once

#include "scene/ply/header.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// Goes through the records of a PLY file, one at a time, in the order of the header. A copy goes its own way.
class PlyRecords {
public:
    /// `content` is the whole file and must outlive this, as must `header`.
    PlyRecords(std::string file, std::string_view content, const PlyHeader& header);

    /// Reads the next record, which must be one of `element`; `index` stands in messages. Throws InputError with the place
    /// if the file ends before it does or a word is not a number.
    void read(const PlyElement& element, std::uint64_t index);
    /// Passes over all records of `element`.
    void skip(const PlyElement& element);

    /// Of the record last read: the number of the property `k`, or the length of the list.
    double number(std::size_t k) const { return numbers_[k]; }
    /// Of the record last read: the list of the property `k`; empty if it is none.
    const std::vector<double>& list(std::size_t k) const { return lists_[k]; }

    /// Throws InputError at the record last read.
    [[noreturn]] void fail(const std::string& found, const std::string& expected) const;

private:
    double value(PlyType type);
    double textValue();
    std::size_t listLength(const PlyProperty& property, double length) const;
    std::size_t remaining() const { return content_.size() - at_; }

    std::string file_;
    std::string_view content_;
    PlyFormat format_;
    std::size_t at_;   //!< of the next byte
    std::size_t line_; //!< in text, from 1

    const PlyElement* element_ = nullptr;
    std::uint64_t index_ = 0;
    std::vector<double> numbers_;
    std::vector<std::vector<double>> lists_;
};

} // namespace lambert
