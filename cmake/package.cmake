# cpack -G DEB, by scripts/package.sh: the program, its scenes and its documentation.
set(CPACK_PACKAGE_NAME keyhole)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Keyhole authors <maintainers@users.noreply.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renderer by photon mapping, for interiors whose light is hard to find")
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME keyhole)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"Renders still pictures of scenes with global illumination, by photon mapping
with final gather, to multi-layer OpenEXR files. Photons are sampled where the
picture needs them: by Markov chains over whole light paths, or by light paths
that importance guides. Reads pbrt-v4, YAML and glTF 2.0.")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# What a package of Debian has beside what `cmake --install` puts into place.
string(TIMESTAMP date "%a, %d %b %Y 00:00:00 +0000" UTC)
file(CONFIGURE OUTPUT package/changelog.Debian CONTENT
"keyhole (@PROJECT_VERSION@-1) stable; urgency=medium

  * See CHANGELOG.md.

 -- @CPACK_PACKAGE_CONTACT@  @date@
")
foreach(text ${PROJECT_BINARY_DIR}/package/changelog.Debian ${PROJECT_SOURCE_DIR}/cmake/package/keyhole.1)
  cmake_path(GET text FILENAME name)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${text})
  file(ARCHIVE_CREATE OUTPUT ${PROJECT_BINARY_DIR}/package/${name}.gz PATHS ${text} FORMAT raw COMPRESSION GZip
    COMPRESSION_LEVEL 9)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/package/keyhole.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/package/changelog.Debian.gz cmake/package/copyright
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES cmake/package/keyhole.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME keyhole
  COMPONENT program)
include(CPack)
