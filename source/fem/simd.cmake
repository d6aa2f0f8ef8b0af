# Debian's deal.II is compiled for every x86-64 machine and fixes its
# vectorisation width at zero bits, whatever flags an application uses. Where the
# compiler flags allow more, write a copy of its config.h with that width into the
# build folder, to be found before the packaged one by every target, and set
# VOUSSOIR_SIMD_WIDENED so that source/fem/simd_*.cc instantiate the matrix-free
# classes at that width. All that depends on the version of deal.II and on how it
# was packaged is here and in those two files.
set(VOUSSOIR_SIMD_WIDENED 0)
set(VOUSSOIR_SIMD_INCLUDE)

file(READ ${DEAL_II_PATH}/${DEAL_II_INCLUDE_RELDIR}/deal.II/base/config.h _config)
string(REGEX MATCH "DEAL_II_VECTORIZATION_WIDTH_IN_BITS ([0-9]+)" _ "${_config}")
set(_packaged_width ${CMAKE_MATCH_1})

set(_flags ${VOUSSOIR_FLAGS})
separate_arguments(_user_flags UNIX_COMMAND "${CMAKE_CXX_FLAGS}")
execute_process(
  COMMAND ${CMAKE_CXX_COMPILER} ${_user_flags} ${_flags} -dM -E -x c++ /dev/null
  OUTPUT_VARIABLE _macros ERROR_QUIET)
set(_width 0)
if(_macros MATCHES "__AVX512F__")
  set(_width 512)
elseif(_macros MATCHES "__AVX__")
  set(_width 256)
elseif(_macros MATCHES "__SSE2__")
  set(_width 128)
endif()

if(VOUSSOIR_SIMD AND _width GREATER _packaged_width)
  set(VOUSSOIR_SIMD_WIDENED 1)
  set(VOUSSOIR_SIMD_INCLUDE ${CMAKE_BINARY_DIR}/simd)
  string(REGEX REPLACE
    "DEAL_II_VECTORIZATION_WIDTH_IN_BITS [0-9]+"
    "DEAL_II_VECTORIZATION_WIDTH_IN_BITS ${_width}" _config "${_config}")
  file(CONFIGURE OUTPUT ${VOUSSOIR_SIMD_INCLUDE}/deal.II/base/config.h CONTENT "${_config}" @ONLY)
  message(STATUS "SIMD: deal.II packaged at ${_packaged_width} bits, widened to ${_width}")
else()
  message(STATUS "SIMD: deal.II as packaged, ${_packaged_width} bits")
endif()
