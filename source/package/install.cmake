# The files of "cmake --install", and the Debian package that "cpack" makes of them.
include(GNUInstallDirs)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON) # the tests' classes are not installed
set(_data ${CMAKE_INSTALL_DATADIR}/voussoir)
set(_doc ${CMAKE_INSTALL_DATADIR}/doc/voussoir)

# A package has the library once for any processor and once for each faster level;
# the dynamic linker takes the highest level of the processor: ld.so(8),
# glibc-hwcaps.
set(_libraries lib/${CMAKE_LIBRARY_ARCHITECTURE}/voussoir)
set(_rpath "$ORIGIN/../${_libraries}")
if(VOUSSOIR_LEVEL AND NOT VOUSSOIR_LEVEL STREQUAL "x86-64")
  string(APPEND _libraries /glibc-hwcaps/${VOUSSOIR_LEVEL})
endif()
set_target_properties(voussoir PROPERTIES INSTALL_RPATH "${_rpath}")
if(NOT VOUSSOIR_LEVEL) # packages use Debian's libraries alone
  set_target_properties(voussoir voussoir_library PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
endif()
install(TARGETS voussoir_library LIBRARY DESTINATION ${_libraries} COMPONENT library)

install(TARGETS voussoir)
install(PROGRAMS source/voussoir-run source/report/voussoir-report source/report/voussoir-paraview TYPE BIN)
install(DIRECTORY source/report/voussoir_report DESTINATION ${_data} PATTERN __pycache__ EXCLUDE)
install(FILES source/report/voussoir_paraview.py DESTINATION ${_data})
install(DIRECTORY prm DESTINATION ${_data} FILES_MATCHING PATTERN *.prm PATTERN *.txt PATTERN *.msh)
foreach(_program voussoir voussoir-run)
  install(FILES source/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${_program})
endforeach()
# if "bootstrap manual" or "bootstrap package" has made them
install(DIRECTORY ${CMAKE_BINARY_DIR}/manual/html DESTINATION ${_doc} OPTIONAL PATTERN .buildinfo EXCLUDE)
install(FILES ${CMAKE_SOURCE_DIR}/build/vtk.js/package/vtk.js ${CMAKE_SOURCE_DIR}/build/vtk.js/package/LICENSE
  DESTINATION ${_data}/vtk.js OPTIONAL)

set(VOUSSOIR_MAINTAINER "The Voussoir maintainers <maintainers@voussoir.invalid>" CACHE STRING
  "Maintainer of the Debian package, with a mail address")
file(STRINGS /etc/os-release _release REGEX "^VERSION_ID=")
string(REGEX MATCH "[0-9.]+" _release "${_release}")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~deb${_release})
string(TIMESTAMP VOUSSOIR_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(source/package/changelog.in ${CMAKE_BINARY_DIR}/package/changelog.Debian @ONLY)
configure_file(CHANGELOG.md ${CMAKE_BINARY_DIR}/package/changelog COPYONLY)
configure_file(source/package/voussoir.1.in ${CMAKE_BINARY_DIR}/package/voussoir.1 @ONLY)
foreach(_file changelog.Debian changelog voussoir.1)
  execute_process(COMMAND gzip -9nc ${CMAKE_BINARY_DIR}/package/${_file}
    OUTPUT_FILE ${CMAKE_BINARY_DIR}/package/${_file}.gz)
endforeach()
install(FILES ${CMAKE_BINARY_DIR}/package/changelog.Debian.gz ${CMAKE_BINARY_DIR}/package/changelog.gz
  source/package/copyright DESTINATION ${_doc})
foreach(_program voussoir voussoir-run voussoir-report voussoir-paraview)
  install(FILES ${CMAKE_BINARY_DIR}/package/voussoir.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 RENAME ${_program}.1.gz)
endforeach()

# "cpack" packs the libraries of these build folders with its own
set(VOUSSOIR_FASTER_BUILDS "" CACHE STRING "Build folders with a higher VOUSSOIR_LEVEL, for the package")
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};voussoir;ALL;/")
foreach(_folder ${VOUSSOIR_FASTER_BUILDS})
  list(APPEND CPACK_INSTALL_CMAKE_PROJECTS "${_folder};voussoir;library;/")
endforeach()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME voussoir)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${VOUSSOIR_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "seismic response of arch dams
Voussoir computes how an arch dam, its rock and its reservoir respond to an
earthquake: explicit dynamics with contraction joints and slip planes in strict
contact, concrete that cracks, absorbing boundaries and compressible water. A
parameter file describes a case; a report of one page comes out.")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
# mpirun, and the packages of the report
set(CPACK_DEBIAN_PACKAGE_DEPENDS
  "openmpi-bin, python3, python3-numpy, python3-matplotlib, python3-vtk9 | python3-paraview, python3-jinja2, xvfb")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "paraview, weasyprint, bash-completion")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/source/package/prerm)
include(CPack)
