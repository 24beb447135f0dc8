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
