#pragma once

#include <map>
#include <string>

#include "protocol/json/json_reader.h"
#include "tests/bench/report/table.h"

/// The tables of core/ACCURACY.md, core/device/DEVICE.md and server/RELIABILITY.md, from the JSON
/// results of the other commands. The functions throw nlohmann::json::exception if a row lacks a
/// column.
namespace vat::bench {

/// Returns one row per case: the metric that uses most of its tolerance, and the number of all
/// metrics. For cases without tolerances, it is the first metric. `titles` contains the cases'
/// titles by name.
Table cases_table(const Json& validation, const std::map<std::string, std::string>& titles);
/// Returns the README's selection of these cases, without the number of metrics.
Table summary_table(const Json& validation, const std::map<std::string, std::string>& titles);
/// Returns the metrics that the method cannot reach, with the reason.
Table limits_table(const Json& validation);

/// Returns one row per problem: the method with the fewest evaluations for each error.
Table methods_table(const Json& cheapest);
/// Returns one row for each problem and error that fixed steps can reach.
Table steps_table(const Json& control);

/// Returns one row per problem and law: the fastest method and its time for each error.
Table laws_table(const Json& laws);

/// Returns all columns except seconds and hashes.
Table solvers_table(const Json& solvers);
/// Density error and iterations by tolerance. Times are in the plot only.
Table tolerances_table(const Json& tolerances);
/// The rows of `vat_bench accuracy --case accuracies`.
Table accuracies_rows_table(const Json& accuracies);
/// Iterations of the solves of a step against the size of the problem.
Table growth_rows_table(const Json& growth);
/// Error and time of the scenes of the catalogue.
Table catalogue_rows_table(const Json& catalogue);

/// Returns all columns except the seconds.
Table counts_table(const Json& stability);

/// Returns one row per race: times of both programs, their ratio, and the machine.
Table race_table(const Json& race);

/// Returns one row for each case of the validation on a device, with the errors of the metric
/// closest to its tolerance, and the reasons why rows are not on the device.
Table device_cases_table(const Json& rows);
/// Returns one row for each case on a device, with the times on most threads of the CPU.
Table devices_table(const Json& speed);

/// Work of the kernels of devices.
Table kernels_table(const Json& kernels);
/// Changes of conserved quantities by rounding errors, from rows of `vat bench rounding`.
Table rounding_table(const Json& rounding);
/// Predicted times of kernels on GPUs.
Table times_table(const Json& times);

/// Returns all columns except the commit, with the machine in one column.
Table durability_table(const Json& durability);
Table recovery_table(const Json& recovery);
Table faults_table(const Json& faults);

}  // namespace vat::bench
