# Writes FILE with the commit of the repository SOURCE, if the commit has changed.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(CONFIGURE OUTPUT ${FILE} CONTENT [[
namespace vat {
extern const char* const kCommit;
const char* const kCommit = "@commit@";
}  // namespace vat
]] @ONLY)
