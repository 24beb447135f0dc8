# Runs the tests in test/unit with pytest, as a part of `catkin_make run_tests`.
function(rumba_add_unit_tests)
  # catkin takes the environment of the tests when it configures the first package. In a workspace that was never
  # built before, the Python folder of the devel space is not there yet: take the environment again.
  safe_execute_process(COMMAND ${GENERATE_ENVIRONMENT_CACHE_COMMAND})
  set(results ${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}/pytest.xml)
  # The quotes are for workspaces with spaces in their path.
  catkin_run_tests_target(pytest unit pytest.xml
    COMMAND "'${PYTHON_EXECUTABLE}' -m pytest '--junitxml=${results}' test/unit"
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
endfunction()

# Compiles what numba compiles, by running a module of this package, when the package is built or installed: otherwise
# the first start of a node takes some seconds longer. The other arguments are the source files that are compiled.
# With -DRUMBA_WARM_UP=OFF nothing is compiled: for packages that go to other machines.
function(rumba_warm_up module)
  if(DEFINED RUMBA_WARM_UP AND NOT RUMBA_WARM_UP)
    return()
  endif()
  safe_execute_process(COMMAND ${GENERATE_ENVIRONMENT_CACHE_COMMAND})  # as above
  set(done ${CMAKE_CURRENT_BINARY_DIR}/warm_up.done)
  add_custom_command(
    OUTPUT ${done}
    COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} -m ${module}
    COMMAND ${CMAKE_COMMAND} -E touch ${done}
    DEPENDS ${ARGN}
    COMMENT "Compiling the Python functions of ${PROJECT_NAME}")
  add_custom_target(${PROJECT_NAME}_warm_up ALL DEPENDS ${done})
  configure_file(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/warm_up_installed.cmake.in
                 ${CMAKE_CURRENT_BINARY_DIR}/warm_up_installed.cmake @ONLY)
  # What was compiled of the sources is as good for their copies; what is missing is compiled then.
  install(DIRECTORY src/${PROJECT_NAME} DESTINATION ${CATKIN_GLOBAL_PYTHON_DESTINATION}
    FILES_MATCHING PATTERN "*.nb[ci]")
  install(SCRIPT ${CMAKE_CURRENT_BINARY_DIR}/warm_up_installed.cmake)
endfunction()
