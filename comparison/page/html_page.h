#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// A cell's text, and whether it is to stand out.
struct HtmlCell {
    std::string text;
    bool strong = false;
    HtmlCell(std::string t = {}, bool s = false) : text(std::move(t)), strong(s) {}
};

/// Texts are plain and escaped by the page. The first column holds names, the others figures.
struct HtmlTable {
    std::string caption;
    std::vector<std::string> head;           //!< #columns
    std::vector<std::vector<HtmlCell>> rows; //!< #columns each; an empty row is a rule
    bool dense = false;                      //!< smaller, for many columns
    std::size_t words = 0;                   //!< so many columns at the end hold words, too

    void add(const std::string& name, const std::string& value) { rows.push_back({name, value}); }
};

/// Something to look at.
struct HtmlFigure {
    std::string title;   //!< above it, plain text; or empty
    std::string content; //!< markup: an `<svg>` or `<img>` element
    std::string caption; //!< below it, plain text; or empty
};

/// A page that is one file: no script but for sliders, no link to anything outside, light or dark as the reader's system is, fit for a window of
/// 1280 pixels and for paper. Its parts follow one another in the order of the calls. Names are escaped.
class HtmlPage {
public:
    HtmlPage(std::string_view title, std::string_view subtitle);

    void section(std::string_view heading);
    void paragraph(std::string_view text);
    void table(const HtmlTable& table);
    void figures(const std::vector<HtmlFigure>& figures, int columns);
    /// A figure on the left, a table beside it.
    void figureAndTable(const HtmlFigure& figure, const HtmlTable& table);
    /// Two pictures of one size in one place, of which a slider shows the left part of one and the right part of the other. `left` and
    /// `right` have `<img>` elements as content; their titles label the two sides. The page's address may end in #slider=0.3, which puts all
    /// sliders there.
    void slider(const HtmlFigure& left, const HtmlFigure& right, std::string_view caption);
    /// A term and what it means, each.
    struct Definition {
        std::string term, meaning;
    };
    void definitions(const std::vector<Definition>& definitions);

    std::string text() const; //!< the whole file, UTF-8

private:
    std::string title_, body_;
    bool slides_ = false;
};

/// An `<img>` element with the PNG inside. `alternative` is for who cannot see it.
std::string htmlPng(std::string_view png, int width, int height, std::string_view alternative);

} // namespace lambert
