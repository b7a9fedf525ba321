#pragma once

#include "server/script/transcript.h"

namespace vat::test {

/// The transcript of the test that runs, in the folder that $VAT_TRANSCRIPT names; null where it
/// names none. What is in that folder is checked against the schemas once the tests have run.
script::Transcript* message_record();

}  // namespace vat::test
