# cmake --build build --target blender-addon: the add-on for Blender as one zip, to be installed from its preferences.
file(GLOB_RECURSE addon RELATIVE ${PROJECT_SOURCE_DIR}/blender CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/blender/keyhole/*.py)
list(TRANSFORM addon PREPEND ${PROJECT_SOURCE_DIR}/blender/ OUTPUT_VARIABLE addon_files)
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/keyhole-blender.zip
  COMMAND ${CMAKE_COMMAND} -E tar cf ${PROJECT_BINARY_DIR}/keyhole-blender.zip --format=zip ${addon}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}/blender
  DEPENDS ${addon_files}
  COMMENT "Packing keyhole-blender.zip"
  VERBATIM)
add_custom_target(blender-addon DEPENDS ${PROJECT_BINARY_DIR}/keyhole-blender.zip)
