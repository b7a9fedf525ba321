# cmake -DPROGRAM=vat_bench -DFOLDER=BUILD_FOLDER -P: writes a ctest entry for each case.
execute_process(COMMAND ${PROGRAM} validate --list
  OUTPUT_VARIABLE names OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" names "${names}")
set(entries "")
foreach(name IN LISTS names)
  string(APPEND entries
    "add_test(\"validation/${name}\" \"${PROGRAM}\" validate --quick --case \"${name}\""
    " --output \"${FOLDER}/results/${name}\")\n"
    "set_tests_properties(\"validation/${name}\" PROPERTIES LABELS validation)\n")
endforeach()
file(WRITE ${FOLDER}/validation_tests.cmake "${entries}")
