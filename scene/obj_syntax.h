#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// What Lambert uses of an OBJ file, checked, and written so that tinyobjloader cannot misread it: one
/// statement per line, only `v`, `f`, `g` and `usemtl`, vertex indices positive and without texture and
/// normal, names replaced by their numbers in the lists below, NaN and infinity by a number that overflows.
struct ObjText {
    std::string statements;
    std::vector<std::string> materials;           //!< `usemtl N` means the N-th
    std::vector<std::string> groups;              //!< `g N` means the N-th
    std::vector<std::string> libraries;           //!< arguments of the `mtllib` statements, unsplit
    std::map<std::size_t, std::size_t> wideFaces; //!< face → vertices, of faces with more than 255
    std::size_t ignoredElements = 0;              //!< points and lines
};

/// Checks the syntax of an OBJ file. Throws InputError with `file`, the line, what was found and what is
/// expected.
ObjText checkObj(const std::string& file, std::string_view text);

/// The same for an MTL file: only `newmtl`, `Kd` and `Ke`, each colour with three numbers.
struct MtlText {
    std::string statements;
    std::set<std::string> diffusePartOnly; //!< materials with a mirror, glass, or more gloss than diffuse reflection
    std::vector<std::string> warnings;     //!< one line each, without the file's name
};
MtlText checkMtl(const std::string& file, std::string_view text);

} // namespace lambert
