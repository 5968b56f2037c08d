# Libraries, all from Debian 12. scripts/install_dependencies.sh has their packages.
find_package(embree 3.13 CONFIG REQUIRED)
find_package(nanoflann 1.4 CONFIG REQUIRED)
find_package(OpenEXR 3.1 CONFIG REQUIRED)
find_package(yaml-cpp 0.7 CONFIG REQUIRED)
find_package(TBB 2021 CONFIG REQUIRED COMPONENTS tbb)
find_package(fmt 9 CONFIG REQUIRED)
find_package(CLI11 2 CONFIG REQUIRED)
find_package(nlohmann_json 3 CONFIG REQUIRED)
find_package(assimp 5 CONFIG REQUIRED)
find_package(PNG REQUIRED)
# OpenImageIO's own CMake files want parts that Debian's package lacks.
find_library(OPENIMAGEIO_LIBRARY OpenImageIO REQUIRED)
find_library(OPENIMAGEIO_UTIL_LIBRARY OpenImageIO_Util REQUIRED)
