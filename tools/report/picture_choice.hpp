// Which of a run's pictures a report shows.
#pragma once

#include "report/report_data.hpp"

namespace stillpoint::report {

/// Of the folder `images`: some at even distances, those beside the worst moments (lost, largest
/// error, most excluded) with the reason. By rising frame.
void choose_pictures(RunData& run);

}  // namespace stillpoint::report
