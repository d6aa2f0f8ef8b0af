# deal_ii_pickup_tests() with five corrections: tests called long_* run only with
# VOUSSOIR_ALL_TESTS; labels that ctest knows (deal.II 9.4 sets LABEL, which ctest
# ignores); an edited parameter file, or page of doc/, runs its test again; a check that
# finds something wrong, or a case that is refused, is run by a script, since the
# harness shows no difference when a program fails; and a test takes as many processors
# as it has ranks (deal.II 9.4 counts half of them: ranks that wait for each other then
# share a core, five times as slow).
macro(voussoir_pickup_tests)
  set(_program ${TEST_TARGET})
  set(TEST_TARGET ${_program}_script)
  deal_ii_pickup_tests()
  get_filename_component(_subject ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  get_directory_property(_tests TESTS)
  # the harness of deal.II 9.6 counts the building of a program as a test
  list(FILTER _tests EXCLUDE REGEX "^test_dependency/")
  string(TOLOWER "${CMAKE_BUILD_TYPE}" _build)
  foreach(_test IN LISTS _tests)
    string(REGEX REPLACE "^[^/]*/([^.]*).*" "\\1" _name "${_test}")
    set_tests_properties(${_test} PROPERTIES LABELS "${_subject}")
    if(_name MATCHES "^long_" AND NOT VOUSSOIR_ALL_TESTS)
      set_tests_properties(${_test} PROPERTIES DISABLED ON)
    endif()
    set(_folder "${CMAKE_CURRENT_BINARY_DIR}/${_name}.${_build}")
    if(_test MATCHES "mpirun=([0-9]+)")
      set_tests_properties(${_test} PROPERTIES PROCESSORS ${CMAKE_MATCH_1})
      string(APPEND _folder "/mpirun=${CMAKE_MATCH_1}")
    elseif(IS_DIRECTORY ${_folder}/serial) # made by the harness of deal.II 9.6
      string(APPEND _folder "/serial")
    endif()
    foreach(_input ${CMAKE_CURRENT_SOURCE_DIR}/${_name}.prm ${CMAKE_SOURCE_DIR}/doc/${_name}.md)
      if(EXISTS ${_input})
        add_custom_command(OUTPUT ${_folder}/output APPEND DEPENDS ${_input})
      endif()
    endforeach()
    if(_program STREQUAL "voussoir_refusal")
      set(_program voussoir)
    endif()
    add_custom_command(OUTPUT ${_folder}/output APPEND DEPENDS ${_program})
  endforeach()
endmacro()
