// The parts of reports that are alike for recordings in folders and in bags.
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "inspection/pair_audit.hpp"

namespace stillpoint::inspection {

/// How many, how fast, how they pair. `color`, `depth`: what stands before either, or nothing;
/// `paired_by`: "time stamp", ….
void print_streams(std::ostream& out, const PairAudit& audit, const std::string& color,
                   const std::string& depth, const std::string& paired_by);
/// What the sampled images are, and whether their clocks agree.
void print_images(std::ostream& out, const PairAudit& audit);
/// With a histogram; nothing without depth images.
void print_depth(std::ostream& out, const PairAudit& audit);
void print_warnings(std::ostream& out, const PairAudit& audit);

/// Seconds, metres and shares from 0 to 1 throughout.
nlohmann::ordered_json pair_json(const PairAudit& audit);

}  // namespace stillpoint::inspection
