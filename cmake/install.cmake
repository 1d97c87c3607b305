# cmake --install: the program, libwavecrest with its headers and wavecrestConfig.cmake, the built-in scenes
# (scenes/CMakeLists.txt), the man page and completions, which the program prints itself.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(described ${PROJECT_BINARY_DIR}/described)
set(described_files "")
foreach(file IN ITEMS man:wavecrest.1 bash:wavecrest zsh:_wavecrest fish:wavecrest.fish)
  string(REPLACE ":" ";" file ${file})
  list(GET file 0 format)
  list(GET file 1 name)
  add_custom_command(
    OUTPUT ${described}/${format}/${name}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${described}/${format}
    COMMAND wavecrest describe ${format} > ${described}/${format}/${name}
    DEPENDS wavecrest VERBATIM)
  list(APPEND described_files ${described}/${format}/${name})
endforeach()
add_custom_target(wavecrest_described ALL DEPENDS ${described_files})
install(FILES ${described}/man/wavecrest.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${described}/bash/wavecrest DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${described}/zsh/_wavecrest DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${described}/fish/wavecrest.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

install(TARGETS wavecrest)
install(DIRECTORY bench/score/machines DESTINATION ${CMAKE_INSTALL_DATADIR}/wavecrest)
install(FILES LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(NOT WAVECREST_SHARED)
  return()
endif()

install(TARGETS wavecrest_shared EXPORT wavecrest)
install(DIRECTORY include/wavecrest DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/wavecrest)
install(EXPORT wavecrest NAMESPACE wavecrest:: FILE wavecrestConfig.cmake DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/wavecrestConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/wavecrestConfigVersion.cmake DESTINATION ${package_folder})
