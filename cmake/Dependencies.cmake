# Every library comes from Debian 12; scripts/packages.txt is the list of packages.
find_package(Threads REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(embree 3 CONFIG REQUIRED)
find_package(TinyGLTF CONFIG REQUIRED)
# Debian's libdraco holds a tinygltf of its own, of another layout, and what is first among the libraries of a program is
# what it gets. As a dependency of the real one Draco is always behind it: who needs Draco links TinyGLTF::TinyGLTF.
find_package(draco CONFIG REQUIRED)
set_property(TARGET TinyGLTF::TinyGLTF APPEND PROPERTY INTERFACE_LINK_LIBRARIES draco::draco)
find_package(meshoptimizer CONFIG REQUIRED)
find_package(tinyobjloader CONFIG REQUIRED)
find_package(OpenImageIO CONFIG REQUIRED)
# Debian's OpenImageIO target also names /usr/include/opencv4, which none of its packages brings.
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES "${OpenImageIO_INCLUDE_DIR}")
find_package(OpenMesh CONFIG REQUIRED)  # CONFIG: CGAL ships a FindOpenMesh.cmake that hides it
find_package(TBB CONFIG REQUIRED)
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL REQUIRED)
