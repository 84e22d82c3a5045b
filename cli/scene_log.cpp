#include "cli/scene_log.h"
#include "cli/terminal_text.h"

#include <utility>

namespace lambert {

SceneLog::SceneLog(bool quiet, std::string place, std::string scene)
    : quiet_(quiet), place_(std::move(place)), scene_(printable(std::move(scene))), text_(scene_ + "\n") {}

std::string SceneLog::named(const std::string& text) const {
    return text.starts_with(scene_) ? text : scene_ + ": " + text;
}

void SceneLog::line(const std::string& text, const std::string& timing) {
    const std::string whole = printable(text);
    text_ += whole + "\n";
    if (!quiet_) writeLog(place_ + named(whole) + timing + "\n");
}

void SceneLog::warning(const std::string& text) {
    const std::string whole = printable(text);
    warnings_.push_back(whole);
    text_ += "warning: " + whole + "\n";
    writeLog("warning: " + named(whole) + "\n");
}

void SceneLog::error(const std::string& text) {
    const std::string whole = printable(text);
    text_ += "error: " + whole + "\n";
    writeLog("lambert: " + named(whole) + "\n");
}

} // namespace lambert
