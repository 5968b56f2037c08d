# cmake --install: the program, the scenes, and the library with its headers. Headers name each other from the root of
# src, so that a client adds both include and include/keyhole to its include path.
include(GNUInstallDirs)

install(TARGETS keyhole COMPONENT program)
if(TARGET keyhole-mpi)
  install(TARGETS keyhole-mpi)
endif()
install(TARGETS keyhole_lib ARCHIVE)
install(TARGETS keyhole_oiio LIBRARY DESTINATION lib/keyhole COMPONENT program) # where the program looks: ../lib/keyhole
install(DIRECTORY src/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/keyhole
  FILES_MATCHING PATTERN "*.h" PATTERN "cli" EXCLUDE PATTERN "mpi" EXCLUDE)
install(DIRECTORY scenes userpaths DESTINATION ${CMAKE_INSTALL_DATADIR}/keyhole COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT program)
