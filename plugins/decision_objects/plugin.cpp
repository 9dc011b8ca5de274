#include "stillpoint/plugin.hpp"
#include "decision_objects/bayes.hpp"
#include "decision_objects/geometry_only.hpp"
#include "decision_objects/object_vote.hpp"
#include "decision_objects/semantic_only.hpp"

using namespace stillpoint::decision_objects;

STILLPOINT_PLUGIN(decision_objects, "0.1.0",
                  stillpoint::provide<stillpoint::Decision, ObjectVote>(
                      "object_vote", "an object with enough moving points moves (DS-SLAM III-D)"),
                  stillpoint::provide<stillpoint::Decision, SemanticOnly>(
                      "semantic_only", "whatever belongs to the listed classes moves"),
                  stillpoint::provide<stillpoint::Decision, GeometryOnly>(
                      "geometry_only",
                      "moving points and the surfaces around them, without labels"),
                  stillpoint::provide<stillpoint::Decision, Bayes>(
                      "bayes",
                      "probability of moving per object and surface over time, soft weights"));
