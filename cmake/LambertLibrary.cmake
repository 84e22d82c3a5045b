# Flags of Lambert's own targets, and a short form for "one static library per folder".
add_library(lambert_options INTERFACE)
target_include_directories(lambert_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(lambert_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow
  # It takes every temporary that a function gets for what its result refers to.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference>)
target_compile_definitions(lambert_options INTERFACE GLM_FORCE_XYZW_ONLY GLM_FORCE_EXPLICIT_CTOR)
target_link_libraries(lambert_options INTERFACE glm::glm)
if(LAMBERT_SANITIZE)
  add_compile_options(-fsanitize=${LAMBERT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${LAMBERT_SANITIZE})
endif()

# lambert_library(<folder> SOURCES ... PUBLIC ... PRIVATE ...)
function(lambert_library folder)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(lambert_${folder} STATIC ${arg_SOURCES})
  # They are parts of a shared library too (see library/), which shows none of their names.
  set_target_properties(lambert_${folder} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_libraries(lambert_${folder} PUBLIC lambert_options ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
endfunction()
