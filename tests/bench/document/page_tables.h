#pragma once

#include <map>
#include <string>

#include "protocol/json/json_reader.h"
#include "tests/bench/report/table.h"

/// The tables of core/ACCURACY.md, from the rows that the other commands write as JSON. They throw
/// nlohmann::json::exception where a row lacks a column.
namespace vat::bench {

/// One row a case: of its metrics the one that uses most of its tolerance, and the number of all;
/// of cases without tolerances the first one. `titles` are the cases' by name.
Table cases_table(const Json& validation, const std::map<std::string, std::string>& titles);
/// The README's selection of these cases, without the number of metrics.
Table summary_table(const Json& validation, const std::map<std::string, std::string>& titles);
/// The metrics that the method cannot reach, and why.
Table limits_table(const Json& validation);

/// One row a problem: for each error the method with the fewest evaluations.
Table methods_table(const Json& cheapest);
/// One row for each problem and error that fixed steps can reach.
Table steps_table(const Json& control);

/// One row for each problem and law: for each error the method with the least time, and the time.
Table laws_table(const Json& laws);

/// Everything but the seconds and hashes.
Table solvers_table(const Json& solvers);
/// Density error and iterations by tolerance. Times are in the plot only.
Table tolerances_table(const Json& tolerances);

/// Everything but the seconds.
Table counts_table(const Json& stability);

/// One row for each race: times of both programs, their ratio, and the machine.
Table race_table(const Json& race);

}  // namespace vat::bench
