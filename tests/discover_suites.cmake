# Writes OUTPUT, a file that adds a test of ctest for each suite of the GoogleTest program PROGRAM: PREFIX.SUITE. A
# program starts as slowly as most of its tests run, so that one process a test would take most of the time.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[^ \n][^\n]*" headings "${listing}")
set(script "")
foreach(heading IN LISTS headings)
  if(NOT heading MATCHES "^\n?([^ ]+)[.]( |$)")
    continue() # what a library prints
  endif()
  set(suite ${CMAKE_MATCH_1})
  set(test "[=[${PREFIX}.${suite}]=]")
  string(APPEND script "add_test(${test} [=[${PROGRAM}]=] --gtest_brief=1 [=[--gtest_filter=${suite}.*]=])\n")
  string(APPEND script "set_tests_properties(${test} PROPERTIES LABELS fast TIMEOUT ${TIMEOUT})\n")
endforeach()
file(WRITE ${OUTPUT} "${script}")
