#pragma once

#include <string>
#include <vector>

namespace lambert {

/// The log of one scene's bake: shown on stderr as it grows, and kept for a file. The file holds no times, so that the same
/// bake gives the same bytes.
class SceneLog {
public:
    /// `place` ("[3/12] " or empty) and `scene` stand before every line on stderr. `quiet`: only warnings and errors there.
    SceneLog(bool quiet, std::string place, std::string scene);

    /// `timing` is shown, not kept.
    void line(const std::string& text, const std::string& timing = {});
    void warning(const std::string& text);
    void error(const std::string& text);

    const std::vector<std::string>& warnings() const { return warnings_; }
    const std::string& text() const { return text_; } //!< what was kept, whole lines

private:
    /// The text after the scene's name, unless it begins with that.
    std::string named(const std::string& text) const;

    bool quiet_;
    std::string place_, scene_, text_;
    std::vector<std::string> warnings_;
};

} // namespace lambert
